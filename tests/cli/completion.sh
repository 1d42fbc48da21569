#!/usr/bin/env bash
# Whether completion and the manual page have all that the program's help has, and nothing else, and
# whether the guide names it; which words and files are completed.
#   completion.sh PROGRAM SOURCE_FOLDER MAN_PAGE
set -euo pipefail

program=$1 source=$2 page=$3
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
failures=0
# shellcheck source=/dev/null
. "$source/meshadapt/cli/help/ductile.bash"

# expect WHAT WANTED FOUND, of lines.
expect() {
  [ "$2" != "$3" ] || return 0
  failures=$((failures + 1))
  printf '%s:\n' "$1"
  diff <(printf '%s\n' "$2") <(printf '%s\n' "$3") || true
}

# What the last of the words after the program is completed to, sorted.
complete_words() {
  COMP_WORDS=("$program" "$@") COMP_CWORD=$# COMPREPLY=()
  _ductile
  printf '%s\n' "${COMPREPLY[@]}" | sort -u
}

# completes WORDS... -- COMPLETION...
completes() {
  local words=()
  while [ "$1" != -- ]; do words+=("$1"); shift; done
  shift
  expect "completion of: ${words[*]}" "$(printf '%s\n' "$@" | sort -u)" "$(complete_words "${words[@]}")"
}

# ---- Against the help ----

mapfile -t commands < <("$program" help | sed -n 's/^  ductile \([a-z]*\)  *[a-z].*/\1/p')
[ ${#commands[@]} -ge 5 ] || { echo "help lists ${#commands[@]} commands"; exit 1; }
completes "" -- "${commands[@]}" help --version
completes help "" -- "${commands[@]}"
expect "the manual's commands" "$(printf '%s\n' "${commands[@]}")" \
  "$(sed -n 's/^\.SS ductile \([a-z]*\) .*/\1/p' "$page")"
for command in "${commands[@]}"; do
  # Options with their other names and what they take, as in "-sol, -met METRIC".
  lines=$("$program" "$command" --help | sed -n 's/^  \(-[^ ,]*\(, -[^ ]*\)\{0,1\}\( [^ ]\{1,\}\)\{0,1\}\) .*/\1/p')
  all=$(grep -oE '(^|, )-[^ ,]+' <<<"$lines" | sed 's/^, //')
  [ "$(wc -l <<<"$all")" -ge 3 ] || { echo "$command: no options found in its help"; exit 1; }
  # shellcheck disable=SC2001
  expect "options of $command" "$(sort <<<"$all")" "$(complete_words "$command" -)"
  expect "options of $command" "$(sed -E 's/^-{1,2}/--/' <<<"$all" | sort -u)" \
    "$(complete_words "$command" --)"
  if command -v zsh >/dev/null; then
    expect "options of $command in zsh" "$(sort <<<"$all")" "$(zsh -f -c '. "$1"; _ductile_specs "$2" "$3"' zsh \
      "$source/meshadapt/cli/help/_ductile" "$program" "$command" | sed 's/^\*//; s/\[.*//' | sort)"
  fi
  if command -v fish >/dev/null; then
    expect "options of $command in fish" "$(sort <<<"$all")" "$(PATH=$(dirname "$program"):$PATH fish --no-config -c \
      'source $argv[1]; complete -C "ductile $argv[2] -"' "$source/meshadapt/cli/help/ductile.fish" "$command" |
      cut -f 1 | sort)"
  fi
  expect "the manual on $command" "$lines" "$(
    sed -n "/^\.SS ductile $command /,/^\.S[SH] /p" "$page" | sed 's/\\f[BIR]//g; s/\\-/-/g' |
      sed -n '/^\.TP$/{n; /^-/p}')"
  while read -r name; do
    grep -qE "(^|[^a-z-])$name([^a-z-]|$)" "$source/docs/command-line.md" ||
      expect "the guide on $command" "$name" ""
  done < <(grep -oE '^-[^ ,]+' <<<"$lines" | grep -v '^-h$')
  expect "headings of the guide" "## ductile $command" \
    "$(grep -o "^## ductile $command\>" "$source/docs/command-line.md" || true)"
done
expect "the manual's formats" "$("$program" help | sed -n 's/^  \(\.[a-z0-9]*\) .*/\1/p')" \
  "$(sed -n '/^\.SH FILES/,/^\.SH EXIT/p' "$page" | sed -n 's/^\\fB\\&\(\.[a-z0-9]*\)\\fR$/\1/p')"

# ---- Words and files ----

operations=$({ "$program" metric 2>&1 || true; } | sed -n '/expected/{s/.*expected \(.*\), found.*/\1/; s/, / /g; s/ or / /; p}')
# shellcheck disable=SC2086
completes metric "" -- $operations
completes metric sc -- scale
completes metric make a.msh b.sol --recovery "" -- least-squares projection
completes view a.msh --cut "" -- x y z
completes view a.msh --by = re -- reference
completes view a.msh --by= re -- reference
completes view a.msh -threads "" --
completes adapt --it -- --iterations
completes adapt -it -- -iterations
completes adapt a.msh -hm -- -hmin -hmax

cd "$work"
mkdir parts
touch a.mesh "my part.msh" b.sol c.vtu d.stl e.png f.mmg2d g.txt parts/x.mesh
mkdir parts/y.mesh
for words in "adapt" "adapt -sol b.sol" "info" "metric size --near point : 0,0 : .1" "metric implied"; do
  # shellcheck disable=SC2086
  completes $words "" -- a.mesh "my part.msh" c.vtu d.stl parts
done
completes adapt "my\\ p" -- "my part.msh"
completes adapt '"my p' -- "my part.msh"
completes adapt parts/ -- parts/x.mesh parts/y.mesh
completes adapt a.mesh "" --
completes adapt a.mesh -sol "" -- b.sol c.vtu "my part.msh" parts
completes adapt a.mesh --out "" -- a.mesh "my part.msh" c.vtu d.stl parts
completes adapt a.mesh -f "" -- f.mmg2d parts
completes view a.mesh -o = "" -- e.png parts
completes metric intersect a.mesh b.sol "" -- b.sol c.vtu "my part.msh" parts
completes metric implied a.mesh -o "" -- b.sol c.vtu "my part.msh" parts
completes convert a.mesh "" -- a.mesh "my part.msh" b.sol c.vtu d.stl parts
completes nonsense "" --

# ---- The manual as it is shown ----

if command -v man >/dev/null; then
  expect "man's warnings" "" "$(LC_ALL=C.UTF-8 MANWIDTH=80 man -l --warnings "$page" 2>&1 >shown)"
  for heading in NAME SYNOPSIS COMMANDS FILES "EXIT STATUS" ENVIRONMENT EXAMPLES "SEE ALSO"; do
    grep -q "^$heading$" shown || expect "headings of the manual" "$heading" ""
  done
fi
echo "$failures failures"
[ $failures -eq 0 ]
