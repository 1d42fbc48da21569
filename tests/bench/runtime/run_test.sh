#!/usr/bin/env bash
# What bench/runtime/run leaves behind: whole results after a whole run, and after any other the last
# ones as they were. Its programs are played by a script, the report is the real one.
#   run_test.sh RUN
set -euo pipefail

run=$1 report=$(dirname "$1")/../report
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
results=$work/results
failures=0

fail() {
  failures=$((failures + 1))
  echo "$*"
}

# Writes a result in two halves. Between them, in the round $BREAK_IN, does what $BREAK says to itself
# and to the script that runs it.
mkdir -p "$work/programs" "$work/broken"
cat >"$work/programs/one_bench" <<'PROGRAM'
#!/usr/bin/env bash
for argument in "$@"; do
  case $argument in --benchmark_out=*) out=${argument#*=} ;; esac
done
echo "{\"context\": {\"date\": \"$DATE\"}, \"benchmarks\": [" >"$out"
case $out in
  *".${BREAK_IN:-none}."*)
    case $BREAK in
      exit) echo "items were lost"; exit 1 ;;
      *) kill -s "$BREAK" $PPID $$; sleep 10 ;;
    esac ;;
esac
echo "{\"name\": \"s/c/a.x/threads:1\", \"run_type\": \"iteration\", \"real_time\": 5, \"time_unit\": \"us\"}" >>"$out"
echo ']}' >>"$out"
PROGRAM
# A filter leaves nothing of this one.
cat >"$work/programs/two_bench" <<'PROGRAM'
#!/usr/bin/env bash
for argument in "$@"; do
  case $argument in --benchmark_out=*) : >"${argument#*=}" ;; esac
done
PROGRAM
chmod +x "$work"/programs/*_bench
ln -s /bin/false "$work/broken/python3"

# Runs into the log; says whether it came to its end. Signals end it even where our caller ignores them.
run_it() { env --default-signal "$run" "$work/programs" "$results" "$@" >"$work/log" 2>&1; }

# ---- A whole run ----
DATE=first run_it --rounds 4 || fail "the first run failed: $(cat "$work/log")"
grep -q "the report is $results/report.html" "$work/log" || fail "the report is not named"
wanted="log.txt one_bench.1.json one_bench.2.json one_bench.3.json one_bench.4.json report.html"
found=$(cd "$results" && echo *)
[ "$found" = "$wanted" ] || fail "after a whole run there is: $found"
[ ! -e "$results.unfinished" ] || fail "a whole run left its unfinished folder"

# ---- Runs that do not come to their end ----
echo mine >"$results/notes.txt"
cp -r "$results" "$work/before"
is_as_before() { diff -r "$work/before" "$results" || fail "$1: the last results changed"; }
for break_in in 1 2; do
  for break in exit INT TERM HUP KILL; do
    ! DATE=second BREAK_IN=$break_in BREAK=$break run_it --rounds 2 || fail "$break: no failure"
    is_as_before "$break"
    case $break in
      exit) grep -q "items were lost" "$work/log" || fail "what went wrong is not said" ;;
    esac
    case $break in
      KILL) ;;
      *) grep -q "^not finished: $results is as it was" "$work/log" ||
        fail "$break: $(cat "$work/log")" ;;
    esac
  done
done
# What was whole by then can be reported; the half is no JSON file.
python3 "$report" runtime "$results.unfinished" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
grep -q "^1 samples, 0 failures" "$work/log" || fail "$(cat "$work/log")"
! PATH=$work/broken:$PATH DATE=second run_it --rounds 1 || fail "no failure without a report"
is_as_before "no report"

# ---- The next whole run takes their place, and leaves what is not its own ----
DATE=third run_it --rounds 1 || fail "the third run failed: $(cat "$work/log")"
found=$(cd "$results" && echo *)
[ "$found" = "log.txt notes.txt one_bench.1.json report.html" ] ||
  fail "after the next run there is: $found"
grep -q third "$results/report.html" || fail "the report is an old one"

# ---- A half file, as runs of before left them, is named in one line and left out ----
head -c 40 "$results/one_bench.1.json" >"$results/half.json"
python3 "$report" runtime "$results" >"$work/log" 2>"$work/errors" || fail "half a file: $(cat "$work/errors")"
grep -q "^1 samples" "$work/log" || fail "half a file: $(cat "$work/log")"
[ "$(wc -l <"$work/errors")" = 1 ] || fail "half a file: $(cat "$work/errors")"
grep -q "left out: $results/half.json: " "$work/errors" || fail "$(cat "$work/errors")"
[ -z "$(find "$work" -name '*.part' -not -path '*.unfinished/*')" ] || fail "a part was left"

[ $failures = 0 ]
