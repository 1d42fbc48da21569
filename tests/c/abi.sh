#!/usr/bin/env bash
# Whether what ductile.h declares is still what doors/c/ductile.abi says that it was, by abidiff: a change
# breaks programs that are not compiled anew, so it is to be meant. Functions' types, which hold all
# other types, and the values of constants are looked at as those of variables.
#   abi.sh SOURCE_FOLDER WORK_FOLDER C_COMPILER [--update]
# --update writes doors/c/ductile.abi. Exit status 77 where abidiff is missing, or on another processor than
# that of doors/c/ductile.abi.
set -euo pipefail

source=$1 work=$2 cc=$3 update=${4:-}
command -v abidiff >/dev/null && command -v abidw >/dev/null || { echo "no abidiff"; exit 77; }
[ "$(uname -m)" = x86_64 ] || { echo "not x86_64"; exit 77; }
mkdir -p "$work"
cd "$work"
header=$source/doors/c/ductile.h
{
  echo '#include "ductile.h"'
  sed -n 's/^ *\(ductile_[a-z_0-9]*\);$/__typeof__(\&\1) api_of_\1;/p' "$source/doors/c/ductile.map"
  grep -o 'DUCTILE_[A-Z_]* = ' "$header" | sed 's/ = //; s/.*/char value_of_&[1 + &];/'
} >api.c
"$cc" -std=gnu99 -g -shared -fPIC -I "$source/doors/c" api.c -o libductile_api.so
abidw --no-corpus-path --no-comp-dir-path --no-show-locs libductile_api.so |
  sed "s| path='[^']*'||" >now.abi
if [ "$update" = --update ]; then
  cp now.abi "$source/doors/c/ductile.abi"
  exit
fi
if ! abidiff "$source/doors/c/ductile.abi" now.abi; then
  echo "what ductile.h declares has changed; if that is meant: tests/c/abi.sh ... --update"
  exit 1
fi
echo "as it was"
