#!/bin/bash
# separate_runs.sh COMMAND...: runs it three times; what it prints must be the same lines each time.
set -euo pipefail
first=$("$@" | sort)
[ -n "$first" ] || { echo "nothing was printed" >&2; exit 1; }
for run in 2 3; do
  again=$("$@" | sort)
  [ "$again" = "$first" ] || { printf 'run 1:\n%s\nrun %s:\n%s\n' "$first" "$run" "$again" >&2; exit 1; }
done
