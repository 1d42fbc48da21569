"""Tests of bench/report on small results that are made here."""

import base64
import contextlib
import html
import importlib
import io
import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

REPORT = Path(__file__).resolve().parents[2] / "bench" / "report"
sys.dont_write_bytecode = True
sys.path.insert(0, str(REPORT))
irregular, many_cores, meshadapt, page, runtime = (
    importlib.import_module(name) for name in ("irregular", "many_cores", "meshadapt", "page", "runtime"))
Sample = runtime.Sample


def run(*words, path=None):
    """The report as a program: status, what it prints, errors."""
    environment = dict(os.environ, **({"PATH": path} if path is not None else {}))
    done = subprocess.run([sys.executable, str(REPORT), *map(str, words)], capture_output=True, text=True,
                          env=environment, check=False)
    return done.returncode, done.stdout, done.stderr


class InFolder(unittest.TestCase):
    def setUp(self):
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        self.folder = Path(held.name)

    def write(self, name, what):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(what if isinstance(what, str) else json.dumps(what), encoding="utf-8")
        return path

    def shown(self):
        return (self.folder / "report.html").read_text(encoding="utf-8")

    def plots(self):
        return [base64.b64decode(data).decode() for data in re.findall(r"svg\+xml;base64,([^\"]*)", self.shown())]


# ---- What all reports are made of ----

class Words(unittest.TestCase):
    def test_times_and_ratios_have_three_digits(self):
        for ns, words in (0.5, "0.50 ns"), (12.34, "12.3 ns"), (999.9, "1.00 us"), \
                (1234567, "1.23 ms"), (2e9, "2.00 s"):
            self.assertEqual(page.time_words(ns), words)
        for ratio, words in ((12345, "12345"), (2.5e6, "2.50 million"), (3e12, "3000 billion"), (0.87, "0.87"),
                             (0.000123, "0.00012")):
            self.assertEqual(page.ratio_words(ratio), words)

    def test_quantiles_are_interpolated(self):
        self.assertEqual(page.quantile([9, 1, 3], 0.5), 3)
        self.assertEqual(page.quantile([4, 1, 2, 9], 0.5), 3)
        self.assertEqual(page.quantile([1, 2], 0.25), 1.25)
        self.assertEqual(page.quantile([7], 0.75), 7)

    def test_tables_are_aligned_and_escaped(self):
        table = page.Table(["case", "s"], [["psi2d", 0.123456]])
        self.assertEqual(table.text(), " case       s\npsi2d  0.1235")
        text = page.Table(["x & y"], [["<b>"]]).html()
        self.assertIn("<th>x &amp; y</th>", text)
        self.assertIn("<td>&lt;b&gt;</td>", text)


class Plots(InFolder):
    def test_no_two_candidates_look_the_same(self):
        """However many libraries there are, of up to eight candidates each."""
        rng = random.Random(38)
        for _ in range(200):
            names = {f"l{rng.randrange(10)}.c{rng.randrange(8)}" for _ in range(rng.randrange(1, 60))}
            style_of = page.styles(names)
            self.assertEqual(len(set(style_of.values())), len(names))
            libraries = {name.split(".")[0]: style_of[name][0] for name in names}
            self.assertTrue(all(style_of[name][0] == libraries[name.split(".")[0]] for name in names))

    def test_gnuplot_draws_whatever_names_and_values_there_are(self):
        if not any((Path(p) / "gnuplot").exists() for p in os.get_exec_path()):
            self.skipTest("there is no gnuplot")
        names = ["a.it's", "b.%s <&>", "c.`echo x`", "d.\"$x\"\nexit", "e.@{x}_^2"]
        rng = random.Random(7)
        for rows in (["one"], ["x%y", "it's", "a_{b}", "`ls`"], [f"case {i}" for i in range(60)]):
            value_of = {name: {row: 10 ** rng.uniform(-9, 9) for row in rows if rng.random() < 0.9} for name in names}
            value_of[names[0]] = {row: 1.0 for row in rows}
            shown = page.Page("x")
            shown.plot(page.dots_script("it's", "a_b", rows, value_of, page.styles(names)), "x")
            shown.plot(page.bars_script("%", rows, {name: [1.0] * len(rows) for name in names}), "x")
            lists = {name: [1.0, 0.5, 0.0] for name in names}
            shown.plot(page.lines_script("it's", [1, 2, 4], lists, lists), "x")
            self.assertFalse(shown.plots_fail, re.sub(r"base64[^\"]*", "", shown.body))
            (self.folder / "report.html").write_text(shown.body, encoding="utf-8")
            drawn = self.plots()
            self.assertEqual(len(drawn), 3)
            for svg, at_least in zip(drawn, (rows, [], names)):
                self.assertTrue(svg.rstrip().endswith("</svg>"))
                text = html.unescape(re.sub(r"<[^>]*>", "", svg))
                for name in at_least:
                    self.assertIn(" ".join(name.split()), text)

    def test_a_report_without_gnuplot_says_so_once(self):
        self.write("results.json", [entry() for _ in range(2)])
        status, _, errors = run("irregular", self.folder, path="/no/such/folder")
        self.assertEqual((status, errors), (0, ""))
        self.assertEqual(self.shown().count("gnuplot is not on the PATH"), 1)
        self.assertEqual(self.plots(), [])


# ---- Microbenchmarks ----

def benchmark(name="loops/rising/gomp.static/threads:2/real_time", **more):
    return {"name": name, "run_name": name, "run_type": "iteration", "repetitions": 1, "threads": 1, "iterations": 10,
            "real_time": 150.0, "cpu_time": 140.0, "time_unit": "us", **more}


def google(*benchmarks):
    """What Google Benchmark 1.7 writes, shortened."""
    return {"context": {"date": "2026-11-21", "host_name": "secret", "num_cpus": 2, "load_avg": [1.5],
                        "extent": "quick", "caches": [{"type": "Data", "level": 1, "size": 32768, "num_sharing": 1}]},
            "benchmarks": list(benchmarks)}


def near(candidate, ns, threads=2, case="case", distance="near"):
    return Sample("subject", case, candidate, threads, ns, distance)


def five(medians, apart=0.01):
    """Five samples of each, one or two times `apart` of the value below and above it."""
    return [Sample(s.subject, s.case, s.candidate, s.threads, s.ns * (1 + apart * i), s.distance, dict(s.counters))
            for s in medians for i in (-2, -1, 0, 1, 2)]


def only_contest(samples):
    sections, _ = runtime.hold_contests(samples)
    (contests,) = sections.values()
    (contest,) = contests
    return contest


class GoogleBenchmark(InFolder):
    def test_names_follow_the_convention(self):
        sample = runtime.sample_from(benchmark("loops/rising_1e5x200ns/gomp.dynamic/threads:12/real_time"))
        self.assertEqual((sample.subject, sample.case, sample.candidate, sample.threads),
                         ("loops", "rising_1e5x200ns", "gomp.dynamic", 12))
        for wrong in ("", "a/b/c", "a/b/threads:2", "a/b/c/d/threads:2", "a/b/c/threads:", "a/b/c/threads:2x",
                      "a/b/c/threads:0", "//c/threads:1"):
            with self.assertRaises(runtime.NoSample, msg=wrong):
                runtime.sample_from(benchmark(wrong))

    def test_samples_failures_and_machine_are_read(self):
        path = self.write("all.json", google(
            benchmark(ping_before_ns=110.0, ping_after_ns=120.0, colours=7.0, label="x"),
            benchmark(run_type="aggregate", aggregate_name="mean"),
            benchmark(error_occurred=True, error_message="items were lost"), benchmark("BM_other"),
            benchmark(real_time=0.0), benchmark(real_time=-3.0), benchmark(real_time=math.nan)))
        samples, failures, machine = runtime.read_samples(path)
        self.assertEqual(samples, [Sample("loops", "rising", "gomp.static", 2, 150000, "near", {"colours": 7})])
        self.assertEqual([why for _, why in failures],
                         ["items were lost", "its name is not SUBJECT/CASE/CANDIDATE/threads:N"] +
                         3 * ["its time is not above zero"])
        self.assertEqual(machine, {"date": "2026-11-21", "num_cpus": 2, "extent": "quick", "caches": "L1 Data 32 KiB"})

    def test_files_that_are_not_whole_are_left_out(self):
        """Files that break off at every fifth byte, and others that may be in a folder."""
        whole = json.dumps(google(benchmark(), benchmark("BM_other")))
        wrong = [whole[:size] for size in range(0, len(whole), 5)]
        wrong += ["[1, 2", "[]", "{}", "7", "null", '{"benchmarks": [], "contexts": 1}',
                  '{"benchmarks": 3, "context": {}}', '{"benchmarks": [7], "context": {}}',
                  '{"benchmarks": [{}], "context": {}}',
                  whole.replace('"us"', '"years"'), whole.replace("150.0", '"x"')]
        for text in wrong:
            with self.assertRaises(page.BadFile, msg=text) as caught:
                runtime.read_samples(self.write("bad.json", text))
            self.assertTrue(str(caught.exception).startswith(str(self.folder / "bad.json")))
            self.assertNotIn("\n", str(caught.exception))

    def test_a_report_names_what_it_leaves_out(self):
        self.write("good.json", google(benchmark()))
        self.write("bad.json", "[1, 2")
        status, said, errors = run("runtime", self.folder)
        self.assertEqual(status, 0)
        self.assertIn("1 samples, 0 failures", said)
        self.assertEqual(errors.count("\n"), 1)
        self.assertIn(f"left out: {self.folder / 'bad.json'}", errors)
        self.assertIn("<b>Left out: ", self.shown())

    def test_a_folder_without_a_file_that_can_be_read_is_an_error(self):
        status, _, errors = run("runtime", self.folder)
        self.assertEqual((status, errors.count("\n")), (1, 1))
        self.write("bad.json", "7")
        self.assertEqual(run("runtime", self.folder)[0], 1)
        self.assertFalse((self.folder / "report.html").exists())


class Contests(unittest.TestCase):
    def test_candidates_are_ordered_by_medians(self):
        contest = only_contest(five([near("c.slow", 300), near("a.fast", 100), near("b.near", 101), near("floor", 50)]))
        fast, second, slow = contest.figures
        self.assertEqual((fast.candidate, fast.median, fast.low), ("a.fast", 100, 99))
        self.assertEqual((fast.over_floor, slow.over_best), (2, 3))
        self.assertEqual([contest.mark(f) for f in (fast, second, slow)], [" ☆", " ☆", ""])

    def test_three_per_cent_are_a_par(self):
        contest = only_contest([near("a.x", 100), near("b.y", 102.9), near("c.z", 103.1)])
        self.assertEqual([f.on_par for f in contest.figures], [True, True, False])

    def test_serial_candidates_take_part_at_every_number_of_threads(self):
        sections, _ = runtime.hold_contests(five([near("a.serial", 100, 1), near("b.team", 150, 1),
                                                  near("b.team", 110, 2), near("floor", 40, 1), near("floor", 60, 2)]))
        self.assertEqual(list(sections), [("subject", 1), ("subject", 2)])
        (two,) = sections["subject", 2]
        self.assertEqual([(f.candidate, f.threads) for f in two.figures], [("a.serial", 1), ("b.team", 2)])
        self.assertEqual(two.floor.median, 40)  # one thread is the faster here
        self.assertEqual(sections["subject", 1][0].figures[1].over_best, 1.5)

    def test_samples_of_threads_that_moved_are_left_out(self):
        samples = five([near("a.x", 100), near("b.y", 200)])
        for sample, distance in zip(samples, ("moved", "one core", "moved")):
            sample.ns, sample.distance = 1, distance
        sections, usual = runtime.hold_contests(samples)
        figure = sections["subject", 2][0].figures[0]
        self.assertEqual(usual, "near")
        self.assertEqual((figure.candidate, figure.samples, figure.left_out, figure.median, figure.mixed),
                         ("a.x", 2, 3, 101.5, False))
        self.assertEqual(figure.samples_words(), "2 of 5")

    def test_all_samples_count_where_none_is_at_the_usual_distance(self):
        samples = five([near("a.x", 100), near("b.y", 200)])
        for sample, distance in zip(samples, 4 * ["moved"] + ["far"]):
            sample.distance = distance
        figure = only_contest(samples).figures[0]
        self.assertTrue(figure.mixed)
        self.assertEqual(figure.samples_words(), "5, distances mixed")

    def test_distances(self):
        for pings, distance in (((None, 9), "unknown"), ((0, 0), "moved"), ((74, 74), "one core"), ((74, 76), "moved"),
                                ((75, 199), "near"), ((200, 999), "far")):
            self.assertEqual(runtime.distance_between(*pings), distance)

    def test_winners_have_samples_enough(self):
        """However samples are left out: who wins alone has three, and no other is on a par."""
        rng, decided = random.Random(38), 0
        for _ in range(300):
            samples = [near(who, 50 + rng.randrange(100), distance="moved" if rng.random() < 0.3 else "near")
                       for who in ("a.x", "a.y", "b.x", "c") for _ in range(rng.randrange(1, 7))]
            contest = only_contest(samples)
            marks = [contest.mark(figure) for figure in contest.figures]
            best = contest.figures[0]
            alone = sum(f.on_par for f in contest.figures) == 1
            self.assertEqual(marks.count(" ★"), int(best.samples >= 3 and not best.mixed and alone))
            self.assertEqual(" ?" in marks, best.samples < 3 or best.mixed)
            self.assertNotIn(" ★", marks[1:])
            decided += marks[0] == " ★"
        self.assertGreater(decided, 10)

    def test_what_is_below_its_floor_is_told(self):
        for ns, apart, wrong in ((80, 0.01, True), (80, 0.3, False), (97, 0.01, True), (99, 0.01, False),
                                 (100, 0, False), (99.9, 0, True), (120, 0.01, False), (0.001, 0.01, True)):
            sections, _ = runtime.hold_contests(five([near("a.x", ns), near("b.y", 105), near("floor", 100)], apart))
            shown = page.Page("x")
            runtime.warn_of_doubts(shown, sections)
            self.assertEqual("<td>subject/case/a.x</td><td>2</td>" in shown.body, wrong, (ns, apart))
            (contests,) = sections.values()
            self.assertEqual(" below!" in runtime.overview(contests).html(), wrong and ns < 105, (ns, apart))

    def test_few_samples_are_told(self):
        for samples, few in ((five([near("a.x", 100)]), False), ([near("a.x", 100)], True)):
            shown = page.Page("x")
            runtime.warn_of_doubts(shown, runtime.hold_contests(samples)[0])
            self.assertEqual("fewer than 3 samples" in shown.body, few)

    def test_overview_has_means_and_libraries_their_best(self):
        samples = five([near("a.x", 300), near("a.z", 100), near("b.y", 200), near("floor", 50),
                        near("a.x", 800, case="other"), near("b.y", 200, case="other"),
                        near("floor", 50, case="other")])
        (contests,) = runtime.hold_contests(samples)[0].values()
        self.assertEqual(runtime.overview(contests).rows,
                         [["case", "3.00", "1.00 ★", "2.00", "2.00"], ["other", "4.00", "", "1.00 ★", "4.00"],
                          ["geometric mean", "3.46", "1.00 (1 of 2 cases)", "1.41", ""]])
        self.assertEqual(runtime.libraries(contests).rows,
                         [["b", 1, 0, 0, 2, "1.41"], ["a", 1, 0, 0, 2, "2.00"]])


class RuntimePage(InFolder):
    def test_shows_every_candidate_escapes_names_and_has_a_plot_for_each_section(self):
        entries = [benchmark(f"s/c/{who}/threads:{n}", real_time=time, colours=3.0)
                   for who, time in (("a.x<y", 1.0), ("b.y", 2.0), ("floor", 0.5)) for n in (1, 2)]
        self.write("one.json", google(*entries, benchmark("BM_<b>")))
        status, said, errors = run("runtime", self.folder)
        self.assertEqual((status, errors), (0, ""))
        self.assertIn("6 samples, 1 failures", said)
        for part in ("a x&lt;y", "BM_&lt;b&gt;", "<td>1.00 us</td>", "s, threads: 2", "<th>colours</th>", "1.00 ?"):
            self.assertIn(part, self.shown())
        self.assertNotIn("x<y", self.shown())
        self.assertEqual(len(self.plots()), 2)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["one.json", "report.html"])


# ---- Mesh adaptation ----

KERNELS = ("coarsen", "refine", "swap", "smooth")


def sample(threads=1, wall=1.0, before="-", after=None, **more):
    parts = {kernel: wall / 5 for kernel in KERNELS}
    parts.update(setup=wall / 10, renumber=0.0, other=wall / 10, total=wall)
    return {"case": "x", "threads": threads, "mode": "tiles", "repetition": 0, "wall_s": wall, "processor_s": wall,
            "parts": parts, "phases": {k: {"looking": 0.1 * wall, "plan": 0.1 * wall} for k in KERNELS},
            "start_elements": 10, "elements": 1000, "peak_bytes": 2**20, "fingerprint": 1 << 63, "cores_before": before,
            "cores_after": before if after is None else after, "in_range": 0.75, "mean_quality": 0.5,
            "least_quality": 0.25, "valid": True, **more}


def results(*samples, **more):
    return {"machine": "a machine", "notes": [], "samples": list(samples), "copies": [], "pairs": [], **more}


class Adaptations(unittest.TestCase):
    def test_samples_whose_cores_moved_are_left_out(self):
        one = meshadapt.summary_of([sample(2, 1, "near"), sample(2, 50, "near", "far"), sample(2, 3, "near")])
        self.assertEqual((one["cores"], one["used"], one["taken"], one["wall_s"]), ("near", 2, 3, 2))
        self.assertAlmostEqual(one["parts"]["swap"], 0.4)
        self.assertAlmostEqual(one["phases"]["swap"]["plan"], 0.2)

    def test_the_usual_distance_counts(self):
        one = meshadapt.summary_of([sample(2, 9, "one core"), sample(2, 1, "far"), sample(2, 3, "far")])
        self.assertEqual((one["cores"], one["wall_s"]), ("far", 2))

    def test_where_all_moved_all_count(self):
        one = meshadapt.summary_of([sample(2, 5, "one core", "near"), sample(2, 7, "near", "far")])
        self.assertEqual((one["cores"], one["used"], one["wall_s"]), ("moving", 2, 6))

    def test_threads_and_modes_are_apart(self):
        all_of = meshadapt.summarise([sample(1, 4), sample(2, 2), sample(1, 6), sample(2, 1, mode="colours")])
        self.assertEqual({key: s["wall_s"] for key, s in all_of.items()},
                         {("x", 1, "tiles"): 5, ("x", 2, "tiles"): 2, ("x", 2, "colours"): 1})

    def test_efficiency_is_against_the_fewest_threads(self):
        table = meshadapt.time_table(meshadapt.summarise([sample(1, 4), sample(2, 2.5), sample(4, 1)]))
        self.assertEqual([row[7] for row in table.rows], [1, 0.8, 1])
        self.assertEqual(table.rows[0][9], "1 of 1")

    def test_a_mesh_that_is_not_valid_or_not_the_same_is_told(self):
        for change, column in ({"valid": False}, 8), ({"fingerprint": (1 << 63) + 1}, 11):
            for which in range(4):
                samples = [sample(n) for n in (1, 1, 2, 2)]
                samples[which].update(change)
                rows = meshadapt.mesh_table(meshadapt.summarise(samples)).rows
                told = [row[column] for row in rows]
                self.assertIn("NO", told, (change, which))
                shown = page.Page("x")
                with contextlib.redirect_stdout(io.StringIO()):
                    meshadapt.show(shown, results(*samples))
                self.assertIn("NOT SOUND", shown.body)
        rows = meshadapt.mesh_table(meshadapt.summarise([sample(1), sample(2)])).rows
        self.assertEqual([row[11] for row in rows], ["yes", "yes"])

    def test_copies_stand_beside_threads(self):
        summaries = meshadapt.summarise([sample(1, 6), sample(2, 4)])
        table = meshadapt.copies_table(summaries, [{"case": "x", "copies": 2, "speed": 1.6},
                                                   {"case": "not measured", "copies": 2, "speed": 1.5}])
        self.assertEqual(table.rows, [["x", 2, 1.6, 1.5, 93.75]])

    def test_growth_is_told_beside_the_case_itself(self):
        table = meshadapt.growth_table(meshadapt.summarise(
            [sample(2, 1), sample(2, 20, case="x@10", elements=10000), sample(2, 20, case="y@10")]))
        self.assertEqual(len(table.rows), 1)
        self.assertAlmostEqual(table.rows[0][-1], 2)

    def test_colours_are_beside_tiles(self):
        table = meshadapt.colours_table(meshadapt.summarise([sample(1, 2), sample(1, 3, mode="colours")]))
        self.assertEqual(table.columns[5:], list(KERNELS))
        for ratio in table.rows[0][4:]:
            self.assertAlmostEqual(ratio, 1.5)

    def test_pairs_are_medians_of_those_that_came_to_their_end(self):
        def program(seconds, status=0):
            return {"status": status, "processor_s": seconds, "wall_s": seconds, "peak_bytes": 2**21, "elements": 7,
                    "in_range": 0.5, "mean_quality": 0.5, "least_quality": 0.1, "valid": True}
        pairs = [{"case": "x", "ductile": program(a), "mmg": program(b, status)}
                 for a, b, status in ((1, 10, 0), (2, 10, 0), (4, 12, 0), (9, 1, 1))]
        (row,) = meshadapt.pair_table(pairs).rows
        self.assertEqual(row[:5], ["x", 3, 2, 10, 5])


class MeshPage(InFolder):
    def test_has_all_tables_and_plots(self):
        samples = [sample(n, 1 / n, case=case, mode=mode) for case in ("x", "y") for n in (1, 2)
                   for mode in ("tiles", "colours")]
        self.write("results.json", results(*samples, sample(2, case="x@10"), notes=["a <note>"],
                                           copies=[{"case": "x", "copies": 2, "speed": 1.5}]))
        status, said, errors = run("meshadapt", self.folder)
        self.assertEqual((status, errors), (0, ""))
        self.assertIn("threads are as fast", said)
        for title in ("Time against threads", "What the machine gives", "Meshes", "Time per element", "a &lt;note&gt;",
                      "The published method", "Kernels and phases"):
            self.assertIn(title, self.shown())
        self.assertNotIn("Beside Mmg", self.shown())
        self.assertEqual(len(self.plots()), 3)  # threads of x and y, shares

    def test_a_file_that_is_not_whole_is_an_error_in_one_line(self):
        whole = json.dumps(results(sample()))
        self.write("report.html", "the last one")
        for text in (whole[:-9], "", "[]", "{}", whole.replace('"wall_s"', '"wall"'), whole.replace("1.0", "null"),
                     whole.replace("1.0", "0")):
            self.write("results.json", text)
            status, _, errors = run("meshadapt", self.folder)
            self.assertEqual((status, errors.count("\n")), (1, 1), text)
            self.assertIn(str(self.folder / "results.json"), errors)
        self.assertEqual(run("meshadapt", self.folder / "none")[0], 1)
        self.assertEqual(self.shown(), "the last one")


# ---- Irregular algorithms, many cores ----

def entry(**more):
    return {"algorithm": "matching", "input": "grid-10", "threads": 1, "seconds": 0.5, "serial_seconds": 0.25, **more}


class Irregular(InFolder):
    def test_has_ratios_and_their_means(self):
        self.write("results.json", [entry(), entry(threads=2, seconds=0.25), entry(input="rmat-10", seconds=2.0)])
        status, said, errors = run("irregular", self.folder)
        self.assertEqual((status, errors), (0, ""))
        self.assertIn("3 measurements", said)
        self.assertEqual(irregular.ratio_table(irregular.by_threads(page.read_json(self.folder / "results.json"))).rows,
                         [["matching, grid-10", 2, 1], ["matching, rmat-10", 8, ""], ["geometric mean", 4, 1]])
        self.assertIn("<th>2 threads</th>", self.shown())
        self.assertEqual(len(self.plots()), 1)

    def test_files_that_are_something_else_are_refused(self):
        for text in ("{", "7", '[{"algorithm": 1}]', json.dumps([entry(serial_seconds=0)])):
            self.write("results.json", text)
            status, _, errors = run("irregular", self.folder)
            self.assertEqual((status, errors.count("\n")), (1, 1), text)

    def test_no_measurement_is_no_error(self):
        self.write("results.json", [])
        self.assertEqual(run("irregular", self.folder)[0], 0)


class ManyCores(InFolder):
    def test_speeds_efficiency_and_serial_times_stand_in_one_table(self):
        self.write("mesh/x/results.json", results(sample(1, 4), sample(1, 6), sample(2, 2.5), sample(4, 2.5),
                                                  sample(1, 8, mode="colours"), sample(1, 5, case="y", valid=False)))
        self.write("matching.json", [entry(), entry(threads=4, seconds=0.25)])
        names = ("ductile.serial/threads:1", "ductile.automatic/threads:1", "ductile.automatic/threads:2")
        self.write("colouring/g.json", google(*(benchmark(f"colouring/g/{name}", real_time=time)
                                                for name, time in zip(names, (3000.0, 4000.0, 1000.0)))))
        self.write("colouring/half.json", '{"context"')
        status, said, errors = run("many_cores", self.folder, "1,2,4")
        self.assertEqual((status, errors), (0, ""))
        lines = said.splitlines()
        self.assertEqual(lines[:2], ["| what | input | serial, s | 1 thread, s | 2 | 4 | efficiency |",
                                     "|---" * 7 + "|"])
        for line in ("| adaptation | x | - | 5 | 2.00 | 2.00 | 0.50 |",
                     "| adaptation by colours | x | - | 8 | - | - | - |",
                     "| adaptation, NOT VALID | y | - | 5 | - | - | - |",
                     "| adaptation, swap | x | - | 1 | 2.00 | 2.00 | 0.50 |",
                     "| matching | grid-10 | 0.25 | 0.5 | - | 2.00 | 0.50 |",
                     "| colouring, automatic | g | 0.003 | 0.004 | 4.00 | - | - |"):
            self.assertIn(line, lines)
        self.assertFalse([line for line in lines if "colouring, serial" in line])

    def test_with_one_number_of_threads_there_is_no_speed(self):
        self.write("matching.json", [entry()])
        self.assertIn("| matching | grid-10 | 0.25 | 0.5 | - |", run("many_cores", self.folder, "1")[1])

    def test_nothing_measured_is_an_empty_table(self):
        status, said, _ = run("many_cores", self.folder, "1,2")
        self.assertEqual((status, len(said.splitlines())), (0, 2))


# ---- The scripts that run suites and their reports ----

class Scripts(InFolder):
    def suite(self, name, program, lines, *words):
        """Runs a suite whose program is played by a shell script; status."""
        fake = self.write(f"programs/{program}", "#!/bin/sh\n" + lines)
        fake.chmod(0o755)
        return subprocess.run([REPORT.parent / name / "run", fake.parent, self.folder / "results", *words],
                              capture_output=True, check=False).returncode

    def has_report(self):
        return (self.folder / "results" / "report.html").exists()

    def test_adaptation_makes_a_page_of_what_was_measured_and_keeps_the_status(self):
        made = self.write("made.json", results(sample()))
        self.assertEqual(self.suite("meshadapt", "adapt_bench", "exit 2"), 2)
        self.assertEqual(self.suite("meshadapt", "adapt_bench", "exit 1"), 1)
        self.assertFalse(self.has_report())
        for status in 0, 1:
            copy = f'[ "$1" = -o ] && mkdir -p "$2" && cp {made} "$2/results.json"; exit {status}'
            self.assertEqual(self.suite("meshadapt", "adapt_bench", copy), status)
            self.assertTrue(self.has_report())
            (self.folder / "results" / "report.html").unlink()
        self.assertEqual(self.suite("meshadapt", "adapt_bench", "exit 2"), 2)
        self.assertEqual(self.suite("meshadapt", "adapt_bench", '[ "$#" = 2 ]', "-o", "elsewhere"), 0)
        self.assertFalse(self.has_report())
        self.write("results/results.json", "{")
        self.assertEqual(self.suite("meshadapt", "adapt_bench", "exit 0"), 1)

    def test_irregular_algorithms_keep_the_last_results_where_a_run_fails(self):
        made = self.write("made.json", [entry()])
        copy = f'[ "$1" = --json ] && cp {made} "$2"; exit '
        self.assertEqual(self.suite("irregular", "irregular_bench", "exit 2"), 2)
        self.assertFalse(self.has_report())
        for status in 0, 1:
            self.assertEqual(self.suite("irregular", "irregular_bench", f"{copy} {status}", "--quick"), status)
            self.assertTrue(self.has_report())
        self.assertEqual(self.suite("irregular", "irregular_bench", "exit 1"), 1)
        self.assertEqual(self.suite("irregular", "irregular_bench", '[ "$*" = "--json x" ]', "--json", "x"), 0)
        self.assertEqual(sorted(p.name for p in (self.folder / "results").iterdir()), ["report.html", "results.json"])


class CommandLine(unittest.TestCase):
    def test_a_wrong_call_is_told_how_to_call(self):
        for words in ((), ("runtime",), ("else", "folder"), ("runtime", "folder", "more"), ("many_cores", "folder")):
            status, _, errors = run(*words)
            self.assertEqual(status, 2)
            self.assertIn("bench/report meshadapt FOLDER", errors)


if __name__ == "__main__":
    unittest.main()
