#!/usr/bin/env bash
# Whether a browser draws the pages of `ductile view`: all triangles of a flat mesh, the surface of a
# solid, and more of it where it is cut.
#   page.sh PROGRAM CHROMIUM FOLDER_OF_EXAMPLES
set -euo pipefail

program=$1 chromium=$2 examples=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# triangles_drawn PAGE: a browser on a busy machine may end before it has drawn, so it has three tries.
triangles_drawn() {
  local drawn try
  for try in 1 2 3; do
    drawn=$(HOME=$work timeout 120 "$chromium" --headless --no-sandbox --use-gl=angle --use-angle=swiftshader \
      --enable-unsafe-swiftshader --virtual-time-budget=20000 --dump-dom "file://$1" 2>"$work/log" |
      sed -n 's/.*data-drawn="\([0-9]*\)".*/\1/p')
    [ -z "$drawn" ] || break
  done
  echo "$drawn"
}

# expect WHAT WANTED FOUND
expect() {
  [ "$2" = "$3" ] || { echo "$1: expected $2 triangles, found '$3'"; tail -n 5 "$work/log"; exit 1; }
}

count() { "$program" info "$examples/$1" | sed -n 's/^  triangles *\([0-9,]*\) .*/\1/p' | tr -d ,; }

"$program" view "$examples/waves2d.mesh" -o "$work/flat.html"
expect "a flat mesh" "$(count waves2d.mesh)" "$(triangles_drawn "$work/flat.html")"
"$program" view "$examples/waves3d.mesh" -o "$work/solid.html"
surface=$(count waves3d.mesh)
expect "the surface of a solid" "$surface" "$(triangles_drawn "$work/solid.html")"
cut=$(triangles_drawn "$work/solid.html#cut=0.5")
[ -n "$cut" ] && [ "$cut" -gt $((surface / 2)) ] && [ "$cut" -lt $((surface + 2000)) ] ||
  { echo "a cut solid: $surface triangles, cut $cut"; exit 1; }
