#!/usr/bin/env python3
"""Takes rules of the code away, one at a time, and sees whether a test fails.

The rules are listed in rules.toml beside this. All of them go into one copy of the sources, each as a
choice between what stands there and what takes its place; DUCTILE_MUTANT picks one when a test starts.
So everything is compiled once (mutant schemata: Untch, Offutt and Harrold, ISSTA 1993).
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import time
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = ROOT / "tests" / "mutants"
COPIED = ["CMakeLists.txt", "CMakePresets.json", "cmake", "include", "runtime", "meshadapt", "tests", "docs"]


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
                    "-D", "DUCTILE_UNITE_SOURCES=ON", "-D", "DUCTILE_PROCESSOR_LEVELS=OFF"],
                   check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", folder / "build", "-j", str(jobs)], check=True, stdout=subprocess.DEVNULL)


def fails(folder, number, tests, jobs, seconds):
    """Does one of these tests fail without this rule? Tests that take far too long do."""
    environment = dict(os.environ, DUCTILE_MUTANT=str(number), OMP_WAIT_POLICY="passive")
    command = ["ctest", "--test-dir", folder / "build", "-j", str(jobs), "--stop-on-failure",
               "--timeout", str(seconds), "--no-tests=error", "-R", tests]
    result = subprocess.run(command, env=environment, capture_output=True, text=True)
    if "No tests were found" in result.stdout + result.stderr:
        sys.exit(f"rules.toml: no test matches {tests}")
    failed = re.findall(r"\d+ - (\S+) \((?:Failed|Timeout|SEGFAULT|Subprocess aborted|[^)]*)\)", result.stdout)
    return failed[0] if failed else "a test" if result.returncode else None


def try_rule(folder, rule, options):
    """First the tests that the rule names, then all."""
    for tests in [rule["tests"]] + ([] if options.quick else ["."]):
        by = fails(folder, rule["number"], tests, options.jobs, options.seconds)
        if by:
            return by
    return None


def chosen(rules, options):
    if options.only:
        rules = [rule for rule in rules if re.search(options.only, rule["name"])]
    if options.some:
        step = max(1, len(rules) // options.some)
        first = options.seed % step
        rules = rules[first::step][:options.some]
    return rules


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", metavar="REGEX", help="the rules whose names match")
    parser.add_argument("--some", type=int, metavar="N", help="N of them, evenly spaced")
    parser.add_argument("--seed", type=int, default=0, help="which N")
    parser.add_argument("--quick", action="store_true", help="run the tests that a rule names, not all after them")
    parser.add_argument("--list", action="store_true", help="print the rules and check where they stand")
    parser.add_argument("--jobs", type=int, default=int(os.environ.get("DUCTILE_JOBS", os.cpu_count())),
                        help="compilers, or tests, side by side")
    parser.add_argument("--seconds", type=int, default=120, help="after which a test counts as failed")
    options = parser.parse_args()

    rules = read_rules()
    folder = ROOT / "build" / "mutants"
    if options.list:
        print_list(rules)
    copy_sources(folder / "source", rules)
    build(folder, options.jobs)
    wanted = chosen(rules, options)
    tests = "|".join(sorted({rule["tests"] for rule in wanted}))
    if broken := fails(folder, 0, tests, options.jobs, options.seconds):
        sys.exit(f"{broken} fails although no rule is taken away")
    kept = []
    for rule in wanted:
        begin = time.monotonic()
        by = try_rule(folder, rule, options)
        print(f"{rule['number']:3}  {'fails: ' + by if by else 'NO TEST FAILS'}  {rule['name']}  "
              f"({time.monotonic() - begin:.0f} s)", flush=True)
        if not by:
            kept.append(rule)
    print(f"{len(wanted) - len(kept)} of {len(wanted)} rules are held by a test")
    for rule in kept:
        print(f"  not held: {rule['name']} ({rule['file']}: {rule['find']})")
    sys.exit(1 if kept else 0)


if __name__ == "__main__":
    main()
