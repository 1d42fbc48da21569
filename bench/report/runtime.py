"""The report of the microbenchmarks, from what Google Benchmark wrote.

The candidates of one subject, case and number of threads are compared by medians. A benchmark's name,
SUBJECT/CASE/CANDIDATE/threads:N, is all that this knows of it; CANDIDATE is LIBRARY.METHOD, or `floor`, which is
what none can be faster than. docs/benchmarks.md says how to read the report.
"""

import math
import re
import statistics
import sys
from collections import Counter, defaultdict
from dataclasses import dataclass, field

from page import BadFile, Page, Table, dots_script, in_file, quantile, ratio_words, read_json, styles, time_words

NS_OF = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}
NO_COUNTERS = {"family_index", "per_family_instance_index", "repetitions", "repetition_index", "threads",
               "iterations", "real_time", "cpu_time", "items_per_second", "bytes_per_second"}
ENOUGH = 3  # fewer samples have no quartiles that say how far they are spread


class NoSample(Exception):
    """A benchmark that gave no figure, and why."""


@dataclass
class Sample:
    subject: str
    case: str
    candidate: str
    threads: int
    ns: float
    distance: str = "unknown"
    counters: dict = field(default_factory=dict)


def distance_at(round_trip_ns):
    if round_trip_ns <= 0:  # the threads did not run at once
        return "moved"
    return "one core" if round_trip_ns < 75 else "near" if round_trip_ns < 200 else "far"


def distance_between(before, after):
    """How far apart two threads were, by round trips of a cache line before and after a sample."""
    if before is None or after is None:
        return "unknown"
    return distance_at(before) if distance_at(before) == distance_at(after) else "moved"


def sample_from(entry):
    """Of one benchmark; throws NoSample, which says why, if it gives no figure."""
    name = re.match(r"([^/]+)/([^/]+)/([^/]+)/threads:([1-9]\d*)(/|$)", entry.get("run_name", entry["name"]))
    if not name:
        raise NoSample("its name is not SUBJECT/CASE/CANDIDATE/threads:N")
    if entry.get("error_occurred"):
        raise NoSample(entry.get("error_message", "failed"))
    ns = entry["real_time"] * NS_OF[entry["time_unit"]]
    if not 0 < ns < math.inf:
        raise NoSample("its time is not above zero")
    counters = {key: value for key, value in entry.items()
                if key not in NO_COUNTERS and isinstance(value, (int, float)) and not isinstance(value, bool)}
    distance = distance_between(counters.pop("ping_before_ns", None), counters.pop("ping_after_ns", None))
    return Sample(*name.group(1, 2, 3), int(name.group(4)), ns, distance, counters)


def read_samples(path):
    """Samples, (benchmark, why it is none), the machine."""
    whole, samples, failures = read_json(path), [], []
    with in_file(path):
        for entry in whole["benchmarks"]:
            if entry.get("run_type", "iteration") == "iteration":
                try:
                    samples.append(sample_from(entry))
                except NoSample as error:
                    failures.append((entry["name"], str(error)))
        machine = {key: value for key, value in whole["context"].items()
                   if key not in ("host_name", "executable", "load_avg", "caches") and value != ""}
        machine["caches"] = ", ".join(f"L{cache['level']} {cache['type']} {cache['size'] // 1024} KiB"
                                      for cache in whole["context"].get("caches", []))
    return samples, failures, machine


@dataclass
class Figure:
    """One candidate in one contest: medians of those of its samples that count."""
    candidate: str
    threads: int
    median: float
    low: float
    high: float
    samples: int
    left_out: int
    mixed: bool  # none was at the usual distance, so that all count
    counters: dict
    over_best: float = 1.0
    over_floor: float = None
    on_par: bool = False
    below_floor: bool = False

    def sound(self):
        return self.samples >= ENOUGH and not self.mixed

    def samples_words(self):
        of = f" of {self.samples + self.left_out}" if self.left_out else ""
        return f"{self.samples}{of}" + (", distances mixed" if self.mixed else "")


def figure_of(group, usual):
    counted = [sample for sample in group if sample.threads == 1 or sample.distance == usual]
    used = counted or group
    times = [sample.ns for sample in used]
    counters = {key: statistics.median(s.counters[key] for s in used if key in s.counters)
                for key in sorted({key for s in used for key in s.counters})}
    return Figure(group[0].candidate, group[0].threads, *(quantile(times, share) for share in (0.5, 0.25, 0.75)),
                  len(used), len(group) - len(used), not counted, counters)


@dataclass
class Contest:
    """The candidates of one subject, case and number of threads."""
    subject: str
    case: str
    threads: int
    figures: list  # the fastest first
    floor: Figure = None  # the fastest one on at most so many threads

    def judge(self):
        best = self.figures[0]
        for figure in self.figures:
            figure.over_best = figure.median / best.median
            figure.on_par = figure.low <= best.high or figure.over_best <= 1.03
            if self.floor:
                figure.over_floor = figure.median / self.floor.median
                figure.below_floor = figure.high < self.floor.low
        return self

    def mark(self, figure):
        """A filled star: the fastest, alone; a hollow one: on a par; ?: too few samples to say."""
        if not figure.on_par:
            return ""
        if not self.figures[0].sound():
            return " ?"
        return " ☆" if sum(f.on_par for f in self.figures) > 1 else " ★"


def contest_of(subject, case, threads, figures_of):
    """figures_of[candidate][threads]. None if only the floor was measured on so many threads. A candidate
    that was measured on one thread only takes part at every number of threads."""
    figures, floor, anyone = [], None, False
    for candidate, by_threads in figures_of.items():
        if candidate == "floor":
            floors = [figure for count, figure in by_threads.items() if count <= threads]
            floor = min(floors, key=lambda figure: figure.median) if floors else None
        elif threads in by_threads or list(by_threads) == [1]:
            figures.append(Figure(**vars(by_threads.get(threads) or by_threads[1])))
            anyone = anyone or threads in by_threads
    figures.sort(key=lambda figure: figure.median)
    return Contest(subject, case, threads, figures, floor).judge() if anyone else None


def hold_contests(samples):
    """Contests in {(subject, threads): [by case]}, and the usual distance of threads, where samples count."""
    distances = Counter(s.distance for s in samples if s.threads > 1 and s.distance != "moved")
    usual = max(sorted(distances), key=distances.get) if distances else "unknown"
    groups = defaultdict(lambda: defaultdict(lambda: defaultdict(list)))
    for s in samples:
        groups[s.subject, s.case][s.candidate][s.threads].append(s)
    sections = defaultdict(list)
    for (subject, case), candidates in sorted(groups.items()):
        figures_of = {name: {count: figure_of(group, usual) for count, group in by_threads.items()}
                      for name, by_threads in sorted(candidates.items())}
        for threads in sorted({count for by_threads in candidates.values() for count in by_threads}):
            contest = contest_of(subject, case, threads, figures_of)
            if contest:
                sections[subject, threads].append(contest)
    return dict(sorted(sections.items())), usual


def overview(contests):
    """Time over that of the best, a row for each case, and the geometric mean of the cases."""
    names = sorted({figure.candidate for contest in contests for figure in contest.figures})
    table = Table(["case", *(name.replace(".", " ", 1) for name in names), "best over floor"])
    ratios = defaultdict(list)
    for contest in contests:
        row = dict.fromkeys(names, "")
        for figure in contest.figures:
            row[figure.candidate] = ratio_words(figure.over_best) + contest.mark(figure)
            ratios[figure.candidate].append(figure.over_best)
        table.rows.append([contest.case, *row.values(), floor_words(contest.figures[0])])
    means = [ratio_words(statistics.geometric_mean(ratios[name])) +
             (f" ({len(ratios[name])} of {len(contests)} cases)" if len(ratios[name]) < len(contests) else "")
             for name in names]
    table.rows.append(["geometric mean", *means, ""])
    return table


def floor_words(figure):
    if figure.over_floor is None:
        return ""
    return ratio_words(figure.over_floor) + (" below!" if figure.below_floor else "")


def libraries(contests):
    """How often the best candidate of each library won alone, was on a par, or may have won."""
    standing, ratios = defaultdict(Counter), defaultdict(list)
    for contest in contests:
        best = {}
        for figure in contest.figures:
            best.setdefault(figure.candidate.split(".")[0], figure)
        on_par = [name for name, figure in best.items() if figure.on_par]
        for name, figure in best.items():
            ratios[name].append(figure.over_best)
            if figure.on_par:
                standing[name]["few" if not contest.figures[0].sound() else "par" if len(on_par) > 1 else "won"] += 1
    table = Table(["best of a library", "won alone", "on a par", "too few samples to say", "cases", "over the best"])
    for name in sorted(ratios, key=lambda name: (-standing[name]["won"], statistics.geometric_mean(ratios[name]))):
        table.rows.append([name, *(standing[name][key] for key in ("won", "par", "few")), len(ratios[name]),
                           ratio_words(statistics.geometric_mean(ratios[name]))])
    return table


def details(contest):
    keys = sorted({key for figure in contest.figures for key in figure.counters})
    table = Table([contest.case, "median", "quartiles", "over floor", "over best", "samples", *keys])
    for figure in contest.figures + ([contest.floor] if contest.floor else []):
        is_floor = figure is contest.floor
        table.rows.append([
            figure.candidate + (f" ({figure.threads} thread)" if figure.threads != contest.threads else "") +
            ("" if is_floor else contest.mark(figure)),
            time_words(figure.median), f"{time_words(figure.low)} to {time_words(figure.high)}",
            "" if is_floor else floor_words(figure), "" if is_floor else ratio_words(figure.over_best),
            figure.samples_words(), *(float(figure.counters[k]) if k in figure.counters else "" for k in keys)])
    return table


def warn_of_doubts(page, sections):
    contests = [contest for section in sections.values() for contest in section]
    few = [c for c in contests if not all(f.sound() for f in c.figures + ([c.floor] if c.floor else []))]
    below = [[f"{c.subject}/{c.case}/{f.candidate}", c.threads, time_words(f.median), time_words(c.floor.median)]
             for c in contests for f in c.figures if f.below_floor]
    if few:
        page.warn(f"In {len(few)} of {len(contests)} comparisons a candidate has fewer than {ENOUGH} samples that "
                  "count, or samples at mixed distances.")
    if below:
        page.warn("These are below their floor by more than the spread: either the floor or the measurement is wrong.")
        page.table(Table(["below the floor", "threads", "median", "floor"], below))


def show_section(page, subject, threads, contests, style_of):
    title = f"{subject}, threads: {threads}"
    page.add("h2", title)
    value_of = defaultdict(dict)
    over_floor = all(contest.floor for contest in contests)
    for contest in contests:
        for figure in contest.figures:
            value_of[figure.candidate][contest.case] = figure.over_floor if over_floor else figure.over_best
    axis = "time over the floor" if over_floor else "time over that of the best"
    page.plot(dots_script(title, axis, [c.case for c in contests], dict(sorted(value_of.items())), style_of), title)
    page.add("p", "Time over that of the best:")
    page.table(overview(contests))
    page.table(libraries(contests))
    page.body += "<details><summary>Medians, case by case</summary>\n"
    for contest in contests:
        page.table(details(contest))
    page.body += "</details>\n"


def report_runtime(folder):
    samples, failures, machine, unread = [], [], {}, []
    files = sorted(folder.glob("*.json"))
    if not files:
        raise BadFile(f"{folder}: expected JSON files, found none")
    for path in files:
        try:
            more, failed, found = read_samples(path)
            samples, failures, machine = samples + more, failures + failed, {**found, **machine}
        except BadFile as error:
            unread.append(str(error))
            print(f"report: left out: {error}", file=sys.stderr)
    if len(unread) == len(files):
        raise BadFile(f"{folder}: no file can be read")
    sections, usual = hold_contests(samples)
    page = Page("Microbenchmarks")
    for error in unread:
        page.warn(f"Left out: {error}")
    warn_of_doubts(page, sections)
    page.add("p", "★ fastest alone, ☆ on a par with the fastest (at most 3 % slower, or a lower quartile not above "
             "its upper one), ? too few samples to say. Samples on several threads count if the threads' cores "
             f"were at the usual distance, here: {usual}. Marks at the edges of plots are farther out.")
    style_of = styles({figure.candidate for section in sections.values() for c in section for figure in c.figures})
    for (subject, threads), contests in sections.items():
        show_section(page, subject, threads, contests, style_of)
    page.add("h2", "Machine and run")
    page.table(Table(["", "found"], sorted(machine.items())))
    if failures:
        page.add("h2", "Not measured")
        page.table(Table(["benchmark", "why"], failures))
    page.write(folder / "report.html")
    print(f"{len(samples)} samples, {len(failures)} failures; the report is {folder / 'report.html'}")
