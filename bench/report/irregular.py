"""The report of the irregular algorithms: Ductile's time over that of lean serial code."""

import statistics
from collections import defaultdict

from page import Page, Table, dots_script, in_file, read_json, styles


def by_threads(entries):
    """{"2 threads": {"algorithm, input": time over the serial code's}}"""
    ratios = defaultdict(dict)
    for entry in sorted(entries, key=lambda entry: entry["threads"]):
        name = f"{entry['threads']} thread" + ("s" if entry["threads"] > 1 else "")
        ratios[name][f"{entry['algorithm']}, {entry['input']}"] = entry["seconds"] / entry["serial_seconds"]
    return dict(ratios)


def ratio_table(ratios):
    table = Table(["time over that of the serial code", *ratios])
    for row in dict.fromkeys(row for values in ratios.values() for row in values):
        table.rows.append([row, *(values.get(row, "") for values in ratios.values())])
    table.rows.append(["geometric mean", *map(statistics.geometric_mean, map(dict.values, ratios.values()))])
    return table


def time_table(entries):
    table = Table(["algorithm", "input", "threads", "seconds", "serial, seconds", "ratio"])
    table.rows = [[e["algorithm"], e["input"], e["threads"], e["seconds"], e["serial_seconds"],
                   e["seconds"] / e["serial_seconds"]] for e in entries]
    return table


def report_irregular(folder):
    path = folder / "results.json"
    entries = read_json(path)
    page = Page("Irregular algorithms")
    page.add("p", "Ductile beside lean serial code: medians of runs that alternate. Below 1 Ductile is faster.")
    with in_file(path):
        if entries:
            ratios = by_threads(entries)
            rows = list(dict.fromkeys(row for values in ratios.values() for row in values))
            page.plot(dots_script("Irregular algorithms", "time over that of the serial code", rows, ratios,
                                  styles(ratios)), "ratios of all algorithms")
            page.table(ratio_table(ratios))
            page.table(time_table(entries))
    page.write(folder / "report.html")
    print(f"{len(entries)} measurements; the report is {folder / 'report.html'}")
