#!/usr/bin/env bash
# Installs the C library into a folder and builds its examples as a user does, by pkg-config; looks at
# what the library shows of itself.
#   use_installed.sh BUILD_FOLDER SOURCE_FOLDER WORK_FOLDER C_COMPILER [FORTRAN_COMPILER]
set -euo pipefail

build=$1 source=$2 work=$3 cc=$4 fc=${5:-}
rm -rf "$work"
mkdir -p "$work"
# The prefix is another one than that of the build, and is moved afterwards: ductile.pc goes along.
cmake --install "$build" --component c --prefix "$work/first" >"$work/install.log"
mv "$work/first" "$work/prefix"
pc=$(find "$work/prefix" -name ductile.pc)
library=$(find "$work/prefix" -name libductile.so)
export PKG_CONFIG_PATH=${pc%/*} LD_LIBRARY_PATH=${library%/*}
run() { echo "$*"; "$@"; }

# shellcheck disable=SC2046
run "$cc" -std=c99 -Wall -Wextra -Wpedantic -Werror $(pkg-config --cflags ductile) \
  "$source/doors/c/examples/adapt.c" -o "$work/adapt_c" $(pkg-config --libs ductile)
"$work/adapt_c"
if [ -n "$fc" ]; then
  cd "$work"  # where modules go
  # shellcheck disable=SC2046
  run "$fc" -Wall -Werror "$work/prefix/include/ductile.f90" "$source/doors/c/examples/adapt.f90" \
    -o adapt_f $(pkg-config --libs ductile)
  ./adapt_f
fi

# All that can be seen is what the map names, and the other way round.
sed -n 's/^ *\(ductile_[a-z_0-9]*\);$/\1/p' "$source/doors/c/ductile.map" | sort >"$work/named"
nm -D --defined-only "$library" | sed -n 's/.* T \([a-z_0-9]*\)@@.*/\1/p' | sort >"$work/seen"
diff "$work/named" "$work/seen"
nm -D --defined-only "$library" | grep -v ' T \| A ' && { echo "more is seen than functions"; exit 1; }
grep -o '\bductile_[a-z_0-9]*(' "$source/doors/c/ductile.h" | tr -d '(' | sort -u | diff "$work/named" - \
  >"$work/undeclared" || { cat "$work/undeclared"; exit 1; }
readelf -d "$library" | grep SONAME
