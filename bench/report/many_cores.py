"""The table of ./dev bench many_cores: how kernels, irregular algorithms and colourings scale."""

import statistics
from collections import defaultdict

from page import BadFile, read_json
from runtime import read_samples


def mesh_times(results):
    """{(what, input): {threads: [seconds]}} of the whole adaptation and its kernels."""
    times = defaultdict(lambda: defaultdict(list))
    for s in results["samples"]:
        by, wrong = (" by colours" if s["mode"] == "colours" else ""), ("" if s["valid"] else ", NOT VALID")
        shown = {"total": f"adaptation{wrong}{by}"}
        for kernel in s["phases"]:
            if s["mode"] == "tiles" or kernel in ("coarsen", "smooth"):
                shown[kernel] = f"adaptation, {kernel}{by}"
        for part, what in shown.items():
            times[what, s["case"]][s["threads"]].append(s["parts"][part])
    return times


def colouring_samples(folder):
    """Without files that were cut short."""
    samples = []
    for path in sorted(folder.glob("colouring/*.json")):
        try:
            samples += read_samples(path)[0]
        except BadFile:
            continue
    return samples


def all_times(folder):
    """Times as above, and {(what, input): seconds of serial code}, of whatever files are there and whole."""
    times, serial = {}, {}
    for path in sorted(folder.glob("mesh/*/results.json")):
        times.update(mesh_times(read_json(path)))
    for path in sorted(folder.glob("*.json")):
        for e in read_json(path):
            times.setdefault((e["algorithm"], e["input"]), {})[e["threads"]] = [e["seconds"]]
            serial[e["algorithm"], e["input"]] = e["serial_seconds"]
    colourings = colouring_samples(folder)
    serial_of = {s.case: 1e-9 * s.ns for s in colourings if s.candidate.endswith(".serial")}
    for s in colourings:
        what = "colouring, " + s.candidate.split(".")[-1], s.case
        if what[0] != "colouring, serial":
            times.setdefault(what, {}).setdefault(s.threads, []).append(1e-9 * s.ns)
            if s.case in serial_of:
                serial[what] = serial_of[s.case]
    return times, serial


def markdown(times, serial, counts):
    """From two threads on how many times as fast as one thread; efficiency on the most."""
    lines = ["| what | input | serial, s | 1 thread, s |" + "".join(f" {n} |" for n in counts[1:]) + " efficiency |",
             "|---" * (len(counts) + 4) + "|"]
    for key in sorted(times):
        median = {threads: statistics.median(values) for threads, values in times[key].items()}
        speed = {n: median[1] / median[n] for n in counts if 1 in median and n in median}
        last = counts[-1]
        cells = [*key, f"{serial[key]:.3g}" if key in serial else "-", f"{median[1]:.3g}" if 1 in median else "-",
                 *(f"{speed[n]:.2f}" if n in speed else "-" for n in counts[1:]),
                 f"{speed[last] / last:.2f}" if last > 1 and last in speed else "-"]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def report_many_cores(folder, threads):
    times, serial = all_times(folder)
    print(markdown(times, serial, [int(n) for n in threads.split(",")]))
