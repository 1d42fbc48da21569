"""The report of the benchmark of mesh adaptation: medians of its samples, threads and modes compared.

A sample counts if the cores of its threads were as far apart before as after; of these, those at the usual distance.
"""

import statistics
from collections import Counter, defaultdict

from page import Page, Table, bars_script, dots_script, in_file, lines_script, read_json, styles

MEDIANS = ("wall_s", "processor_s", "peak_bytes", "parts", "phases")


def median_of(values):
    """Of numbers, or of the numbers under each key."""
    if isinstance(values[0], dict):
        return {key: median_of([value[key] for value in values]) for key in values[0]}
    return statistics.median(values)


def summary_of(group):
    """The samples of one case, mode and number of threads as one."""
    steady = [s for s in group if s["cores_before"] == s["cores_after"]]
    count = Counter(s["cores_before"] for s in steady)
    usual = max(sorted(count), key=count.get) if count else "moving"
    used = [s for s in steady if s["cores_before"] == usual] or group
    return {**used[0], **{key: median_of([s[key] for s in used]) for key in MEDIANS},
            "cores": usual, "taken": len(group), "used": len(used),
            "valid": all(s["valid"] for s in group),
            "bytes": {s["fingerprint"] for s in group}}  # one, if all are the same


def summarise(samples):
    """{(case, threads, mode): summary}, in the order in which they were first measured."""
    groups = defaultdict(list)
    for sample in samples:
        groups[sample["case"], sample["threads"], sample["mode"]].append(sample)
    return {key: summary_of(group) for key, group in groups.items()}


def fewest_threads(summaries, case, mode="tiles"):
    counts = [key[1] for key in summaries if (key[0], key[2]) == (case, mode)]
    return summaries[case, min(counts), mode] if counts else None


def efficiency(alone, many, seconds):
    """Of the seconds that a function gets out of a summary."""
    return seconds(alone) * alone["threads"] / (seconds(many) * many["threads"]) if seconds(many) > 0 else 0.0


def wall(summary):
    return summary["wall_s"]


# ---- Tables ----

def time_table(summaries):
    table = Table(["case", "threads", "mode", "elements", "seconds", "processor seconds", "M elements a second",
                   "efficiency", "cores", "samples"])
    for (case, threads, mode), s in summaries.items():
        table.rows.append([case, threads, mode, s["elements"], s["wall_s"], s["processor_s"],
                           1e-6 * s["elements"] / s["wall_s"],
                           efficiency(fewest_threads(summaries, case, mode), s, wall), s["cores"],
                           f"{s['used']} of {s['taken']}"])
    return table


def copies_table(summaries, copies):
    table = Table(["case", "copies", "get done", "threads are as fast", "of that %"])
    for row in copies:
        alone, many = (summaries.get((row["case"], threads, "tiles")) for threads in (1, row["copies"]))
        if alone and many:
            speed = alone["wall_s"] / many["wall_s"]
            table.rows.append([row["case"], row["copies"], row["speed"], speed, 100 * speed / row["speed"]])
    return table


def mesh_table(summaries):
    table = Table(["case", "threads", "mode", "start", "elements", "in range %", "mean quality", "least quality",
                   "valid", "memory MB", "bytes an element", "same bytes"])
    for (case, threads, mode), s in summaries.items():
        same = len(s["bytes"] | fewest_threads(summaries, case, mode)["bytes"]) == 1
        table.rows.append([case, threads, mode, s["start_elements"], s["elements"], 100.0 * s["in_range"],
                           s["mean_quality"], s["least_quality"], "yes" if s["valid"] else "NO",
                           s["peak_bytes"] / 2**20, s["peak_bytes"] / max(s["elements"], s["start_elements"]),
                           "yes" if same else "NO"])
    return table


def growth_table(summaries):
    table = Table(["case", "threads", "elements", "us an element", "of", "elements there", "us an element there",
                   "ratio"])
    for (case, threads, mode), s in summaries.items():
        base = summaries.get((case.split("@")[0], threads, mode))
        if "@" in case and base:
            here, there = (1e6 * x["wall_s"] / max(x["elements"], x["start_elements"]) for x in (s, base))
            table.rows.append([case, threads, s["elements"], here, base["case"], base["elements"], there, here / there])
    return table


def colours_table(summaries):
    """What the published method, by colours, takes, and each kernel's time over that of ours."""
    table = Table([])
    for (case, threads, mode), ours in summaries.items():
        published = summaries.get((case, threads, "colours"))
        if mode == "tiles" and published:
            table.columns = ["case", "threads", "tiles s", "colours s", "colours over tiles", *ours["phases"]]
            table.rows.append([case, threads, ours["wall_s"], published["wall_s"], published["wall_s"] / ours["wall_s"],
                               *(published["parts"][k] / ours["parts"][k] if ours["parts"][k] > 0 else 0.0
                                 for k in ours["phases"])])
    return table


def part_table(summaries):
    rows = [(key, s["parts"]) for key, s in summaries.items() if key[2] == "tiles"]
    return Table(["case", "threads", *rows[0][1]], [[*key[:2], *parts.values()] for key, parts in rows])


def phase_table(summaries):
    """Of each kernel, on the fewest threads."""
    table = Table([])
    for case in case_names(summaries):
        s = fewest_threads(summaries, case)
        for kernel, phases in s["phases"].items():
            table.columns = ["case", "threads", "kernel", *phases]
            table.rows.append([case, s["threads"], kernel, *phases.values()])
    return table


def pair_table(pairs):
    """Medians of the pairs in which both programs came to their end."""
    table = Table(["case", "pairs", "Ductile s", "Mmg s", "Mmg / Ductile", "elements", "Mmg elements", "in range %",
                   "Mmg %", "mean quality", "Mmg mean", "least quality", "Mmg least", "MB", "Mmg MB"])
    groups = defaultdict(list)
    for pair in pairs:
        if pair["ductile"]["status"] == pair["mmg"]["status"] == 0:
            groups[pair["case"]].append((pair["ductile"], pair["mmg"]))
    for case, group in groups.items():
        ours, theirs = ([run["processor_s"] for run in runs] for runs in zip(*group))
        last = group[-1]
        table.rows.append([
            case, len(group), statistics.median(ours), statistics.median(theirs),
            statistics.median(b / a for a, b in zip(ours, theirs)), *(run["elements"] for run in last),
            *(100.0 * run["in_range"] for run in last), *(run["mean_quality"] for run in last),
            *(run["least_quality"] for run in last), *(run["peak_bytes"] / 2**20 for run in last)])
    return table


# ---- The page ----

def case_names(summaries):
    """Of those that have samples in tiles."""
    return list(dict.fromkeys(case for case, _, mode in summaries if mode == "tiles"))


def plot_threads(page, summaries, case):
    """Seconds and efficiency of kernels against threads, where there is more than one number of them."""
    rows = [s for key, s in summaries.items() if (key[0], key[2]) == (case, "tiles")]
    rows.sort(key=lambda s: s["threads"])
    if len(rows) > 1:
        names = [*rows[0]["phases"], "total"]
        seconds = {n: [s["parts"][n] for s in rows] for n in names}
        shares = {n: [efficiency(rows[0], s, lambda x, n=n: x["parts"][n]) for s in rows] for n in names}
        page.plot(lines_script(case, [s["threads"] for s in rows], seconds, shares), f"{case}: kernels against threads")


def plot_shares(page, summaries):
    alone = {case: fewest_threads(summaries, case)["parts"] for case in case_names(summaries)}
    parts = [part for part in next(iter(alone.values())) if part != "total"]
    page.plot(bars_script("% of the time", list(alone),
                          {part: [100 * a[part] / a["total"] for a in alone.values()] for part in parts}),
              "shares of the kernels in the time")


def plot_pairs(page, table):
    value_of = {name: {row[0]: row[column] for row in table.rows} for name, column in (("Ductile", 2), ("Mmg", 3))}
    page.plot(dots_script("Beside Mmg", "processor seconds", [row[0] for row in table.rows], value_of,
                          styles(value_of)), "processor seconds of both programs")


def show(page, results):
    summaries = summarise(results["samples"])
    page.add("p", results["machine"])
    meshes = mesh_table(summaries)
    if any("NO" in row for row in meshes.rows):
        page.warn("NOT SOUND: a mesh is not valid, or threads made a difference; see the table of meshes.")
    for note in results["notes"]:
        page.add("p", note)
    page.section("Time against threads",
                 "Medians. Efficiency is against the fewest threads. Cores: one core under 75 ns, near under 250.",
                 time_table(summaries))
    for case in case_names(summaries):
        plot_threads(page, summaries, case)
    page.section("What the machine gives", "Copies of one thread each, at once, beside as many threads.",
                 copies_table(summaries, results["copies"]))
    page.section("Meshes", "In range: edges of metric length 1/sqrt 2 to sqrt 2. Quality: mean ratio in the metric.",
                 meshes)
    page.section("Time per element as the mesh grows", "", growth_table(summaries))
    page.section("The published method", "Colours: each kernel's time over that in tiles.", colours_table(summaries))
    if case_names(summaries):
        page.section("Kernels and phases", "Seconds in tiles. Looking: finding the work of a kernel.",
                     part_table(summaries))
        plot_shares(page, summaries)
        page.table(phase_table(summaries))
    pairs = pair_table(results["pairs"])
    page.section("Beside Mmg", "Processor seconds of whole processes on one thread, files included.", pairs)
    if pairs.rows:
        plot_pairs(page, pairs)
    for table in (time_table(summaries), copies_table(summaries, results["copies"]), pairs):
        if table.rows:
            print(f"\n{table.text()}")


def report_meshadapt(folder):
    path = folder / "results.json"
    page, results = Page("Mesh adaptation"), read_json(path)
    with in_file(path):
        show(page, results)
    page.write(folder / "report.html")
    print(f"\nThe report is {folder / 'report.html'}")
