#!/usr/bin/env python3
"""Takes rules of the code away, one at a time, and sees whether a test fails.

The rules are listed in rules.toml beside this. All of them go into one copy of the sources, each as a
choice between what stands there and what takes its place; DUCTILE_MUTANT picks one when a test starts.
So everything is compiled once (mutant schemata: Untch, Offutt and Harrold, ISSTA 1993). All tests run once
with every rule in place and note which rules they ask; a rule is tried with those that ask it, the quickest first.
"""

import argparse
import json
import os
import random
import re
import signal
import subprocess
import sys
import threading
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = ROOT / "tests" / "mutants"
COPIED = ["CMakeLists.txt", "CMakePresets.json", "cmake", "include", "runtime", "meshadapt", "tests", "docs"]

PROGRAMS = ["runtime_tests", "meshadapt_tests"]


def read_rules():
    """Of rules.toml: each with its number, counted from 1."""
    rules = tomllib.loads((HERE / "rules.toml").read_text())["rule"]
    names = [rule["name"] for rule in rules]
    for name in names:
        if names.count(name) > 1:
            sys.exit(f"rules.toml: two rules are called \"{name}\"")
    return [dict(rule, number=number) for number, rule in enumerate(rules, 1)]


def place_of(text, rule):
    """Where a rule stands in a file, as (begin, end). White space counts for nothing."""
    pattern = r"\s*".join(re.escape(token) for token in re.findall(r"\w+|[^\w\s]", rule["find"]))
    start = 0
    if "after" in rule:
        start = text.find(rule["after"])
        if start < 0:
            raise ValueError(f"\"{rule['name']}\": no \"{rule['after']}\" in {rule['file']}")
    found = [match.span() for match in re.finditer(pattern, text[start:])]
    if not found or ("after" not in rule and len(found) > 1):
        raise ValueError(f"\"{rule['name']}\": expected once in {rule['file']}, found {len(found)} times: "
                         f"{rule['find']}")
    begin, end = found[0]
    return start + begin, start + end


def places_of(text, rules):
    """Where the rules stand in a file: (begin, end, rule) in order, and what is wrong with the list."""
    places, faults = [], []
    for rule in rules:
        try:
            places.append((*place_of(text, rule), rule))
        except ValueError as fault:
            faults.append(str(fault))
    places.sort(key=lambda place: place[:2])
    for (_, end, one), (begin, _, other) in zip(places, places[1:]):
        if begin < end:
            faults.append(f"\"{one['name']}\" and \"{other['name']}\" overlap")
    return places, faults


def with_mutants(text, rules):
    """The text of a file in which each of its rules may be taken away."""
    places, faults = places_of(text, rules)
    if faults:
        sys.exit("rules.toml: " + "\nrules.toml: ".join(faults))
    for begin, end, rule in reversed(places):
        choice = f"(::ductile::is_mutant({rule['number']}) ? ({rule['becomes']}) : ({text[begin:end]}))"
        text = text[:begin] + choice + text[end:]
    return text


def print_list(rules):
    faults = []
    for file in sorted({rule["file"] for rule in rules}):
        faults += places_of((ROOT / file).read_text(), [rule for rule in rules if rule["file"] == file])[1]
    for rule in rules:
        print(f"{rule['number']:3}  {rule['name']}")
    sys.exit("rules.toml: " + "\nrules.toml: ".join(faults) if faults else 0)


def write_if_new(path, data):
    if not path.exists() or path.read_bytes() != data:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


def copy_sources(folder, rules):
    """Copies what has changed since the last time, so that little is compiled again."""
    wanted = set()
    for name in COPIED:
        here = ROOT / name
        for path in [here] if here.is_file() else sorted(p for p in here.rglob("*") if p.is_file()):
            relative = path.relative_to(ROOT)
            wanted.add(relative)
            mine = [rule for rule in rules if rule["file"] == str(relative)]
            data = with_mutants(path.read_text(), mine).encode() if mine else path.read_bytes()
            write_if_new(folder / relative, data)
            (folder / relative).chmod(path.stat().st_mode)
    missing = {rule["file"] for rule in rules} - {str(path) for path in wanted}
    if missing:
        sys.exit("rules.toml: no such file: " + ", ".join(sorted(missing)))
    for path in [p for p in folder.rglob("*") if p.is_file()]:
        if path.relative_to(folder) not in wanted:
            path.unlink()


def build(folder, jobs):
    flags = f"-include {HERE / 'mutant.hpp'} -Wno-error"
    subprocess.run(["cmake", "-S", folder / "source", "-B", folder / "build", "-G", "Ninja",
                    "-D", "CMAKE_BUILD_TYPE=Release", "-D", "DUCTILE_TESTS=library", "-D", f"CMAKE_CXX_FLAGS={flags}",
                    "-D", "DUCTILE_BUILD_BENCH=OFF", "-D", "DUCTILE_BUILD_C=OFF",
                    "-D", "DUCTILE_UNITE_SOURCES=ON"],
                   check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", folder / "build", "-j", str(jobs), "--target", *PROGRAMS],
                   check=True, stdout=subprocess.DEVNULL)


class State:
    """What is known of a build: which rules each test asks, how long it takes, and what became of the rules.

    It is kept in a file, so that a run that was stopped goes on where it was.
    """

    def __init__(self, folder):
        self.file = folder / "state.json"
        self.lock = threading.Lock()
        stamp = max(p.stat().st_mtime for p in (folder / "build").rglob("*")
                    if p.is_file() and os.access(p, os.X_OK) and "CMakeFiles" not in p.parts)
        old = json.loads(self.file.read_text()) if self.file.exists() else {}
        self.data = old if old.get("stamp") == stamp else {"stamp": stamp, "tests": {}, "rules": {}}

    def keep(self, kind, name, value):
        with self.lock:
            self.data[kind][name] = value
            new = self.file.with_suffix(".new")
            new.write_text(json.dumps(self.data, indent=1))
            new.replace(self.file)


def list_tests(folder):
    """Those of the programs that were built, of CTest: name, command, folder and environment of each."""
    shown = subprocess.run(["ctest", "--test-dir", folder / "build", "--show-only=json-v1"],
                           check=True, capture_output=True, text=True)
    tests = []
    for test in json.loads(shown.stdout)["tests"]:
        if Path(test.get("command", [""])[0]).name not in PROGRAMS:
            continue
        of = {one["name"]: one["value"] for one in test.get("properties", [])}
        tests.append({"name": test["name"], "command": test["command"], "folder": of.get("WORKING_DIRECTORY", "."),
                      "environment": dict(one.split("=", 1) for one in of.get("ENVIRONMENT", []))})
    return tests


def passes(test, seconds, **environment):
    """Runs a test; one that takes longer than this is ended, with what it has started, and fails."""
    process = subprocess.Popen(test["command"], cwd=test["folder"], start_new_session=True,
                               stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               env=dict(os.environ, OMP_WAIT_POLICY="passive", **test["environment"], **environment))
    try:
        return process.wait(seconds) == 0
    except subprocess.TimeoutExpired:
        return False
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def survey(test, folder, state):
    """Runs a test with all rules in place, and notes which of them it asks."""
    asked = folder / f"asked-{threading.get_ident()}"
    asked.unlink(missing_ok=True)
    begin = time.monotonic()
    good = passes(test, 600, DUCTILE_REACHED=str(asked))
    seconds = time.monotonic() - begin
    rules = sorted({int(line) for line in asked.read_text().split()}) if asked.exists() else []
    asked.unlink(missing_ok=True)
    state.keep("tests", test["name"], {"seconds": round(seconds, 3), "asks": rules, "good": good})
    if not good:
        print(f"left out, because it fails with all rules in place: {test['name']}", flush=True)


def tests_of(rule, tests, state):
    """Those that ask the rule, the quickest first."""
    known = state.data["tests"]
    mine = [test for test in tests if rule["number"] in known[test["name"]]["asks"] and known[test["name"]]["good"]]
    return sorted(mine, key=lambda test: known[test["name"]]["seconds"])


def try_rule(rule, tests, state, options):
    """Takes a rule away and runs the tests that ask it, until one fails."""
    begin = time.monotonic()
    mine, by = tests_of(rule, tests, state), None
    for test in mine:
        if options.stopped.is_set():
            return
        limit = options.seconds + 5 * state.data["tests"][test["name"]]["seconds"]
        if not passes(test, limit, DUCTILE_MUTANT=str(rule["number"])):
            by = test["name"]
            break
    result = {"by": by, "asked_by": len(mine), "seconds": round(time.monotonic() - begin, 1)}
    state.keep("rules", rule["name"], result)
    print(f"{rule['number']:3}  {'held' if by else 'NOT HELD':8}  {rule['name']}: "
          f"{by or f'{len(mine)} tests pass without it'} ({result['seconds']:.0f} s)", flush=True)


def in_parallel(function, items, options):
    """Calls a function for each item, several at once; an interrupt lets those that run end."""
    with ThreadPoolExecutor(options.jobs) as pool:
        calls = [pool.submit(function, item) for item in items]
        try:
            for call in calls:
                call.result()
        except BaseException:
            options.stopped.set()
            for call in calls:
                call.cancel()
            raise


def print_table(rules, results):
    """A line for each subject, which is what the name of a rule begins with. Returns the rules that are not held."""
    lines = {}
    for rule in rules:
        line = lines.setdefault(rule["name"].split(":")[0], [0, 0, 0, 0])
        held = results[rule["name"]]["by"] is not None
        line[0] += 1
        line[1 if held else 2 if "survives" in rule else 3] += 1
    lines["all"] = [sum(column) for column in zip(*lines.values())]
    print(f"\n{'':28}{'rules':>7}{'held':>7}{'explained':>11}{'not held':>10}")
    for subject, line in lines.items():
        print(f"{subject:28}{line[0]:7}{line[1]:7}{line[2]:11}{line[3]:10}")
    free = [rule for rule in rules if results[rule["name"]]["by"] is None]
    for rule in free:
        print(f"{'explained' if 'survives' in rule else 'NOT HELD'}: {rule['name']} "
              f"({rule['file']}): {rule.get('survives', rule['find'])}")
    for rule in rules:
        if "survives" in rule and rule not in free:
            print(f"rules.toml says that no test misses it, but {results[rule['name']]['by']} does: {rule['name']}")
    return [rule for rule in free if "survives" not in rule]


def chosen(rules, options):
    if options.only:
        rules = [rule for rule in rules if re.search(options.only, rule["name"])]
    if options.some:
        rules = sorted(random.Random(options.seed).sample(rules, min(options.some, len(rules))),
                       key=lambda rule: rule["number"])
    return rules


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", metavar="REGEX", help="the rules whose names match")
    parser.add_argument("--some", type=int, metavar="N", help="N of them, drawn by lot")
    parser.add_argument("--seed", type=int, default=0, help="which N")
    parser.add_argument("--again", action="store_true", help="also rules that were tried with this build before")
    parser.add_argument("--list", action="store_true", help="print the rules and check where they stand")
    parser.add_argument("--jobs", type=int, default=int(os.environ.get("DUCTILE_JOBS", os.cpu_count())),
                        help="compilers, or tests, side by side")
    parser.add_argument("--seconds", type=float, default=20, metavar="S",
                        help="a test that takes S seconds more than five times its time hangs, and fails")
    options = parser.parse_args()
    options.stopped = threading.Event()
    return options


def main():
    options = parse_arguments()
    rules = read_rules()
    folder = ROOT / "build" / "mutants"
    if options.list:
        print_list(rules)
    copy_sources(folder / "source", rules)
    build(folder, options.jobs)
    state, tests = State(folder), list_tests(folder)
    new = [test for test in tests if test["name"] not in state.data["tests"]]
    in_parallel(lambda test: survey(test, folder, state), new, options)
    wanted, results = chosen(rules, options), state.data["rules"]
    untried = [rule for rule in wanted if options.again or rule["name"] not in results]
    in_parallel(lambda rule: try_rule(rule, tests, state, options), untried, options)
    sys.exit(1 if print_table(wanted, results) else 0)


if __name__ == "__main__":
    main()
