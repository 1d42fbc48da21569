"""What all reports are made of: tables, plots that gnuplot draws, and pages in HTML."""

import base64
import html
import json
import math
import os
import statistics
import subprocess
from collections import Counter
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path


class BadFile(Exception):
    """A file that cannot be used; says which and why, in one line."""


@contextmanager
def in_file(path):
    """A member that is missing, or of another kind, is told as a fault of the file."""
    try:
        yield
    except (ArithmeticError, AttributeError, IndexError, LookupError, TypeError, ValueError) as error:
        raise BadFile(f"{path}: expected what the benchmark writes: {type(error).__name__} {error}") from error


def read_json(path):
    try:
        return json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise BadFile(f"{path}: {error.strerror}") from error
    except ValueError as error:
        raise BadFile(f"{path}: expected JSON, but it is wrong or breaks off: {error}") from error


# ---- Numbers as people write them ----

def three_digits(value):
    power = math.floor(math.log10(value)) if value > 0 else 0
    return f"{value:.{max(0, 1 - power if power < -1 else 2 - max(0, power))}f}"


def ratio_words(ratio):
    for unit, name in (1e9, " billion"), (1e6, " million"):
        if ratio >= unit:
            return three_digits(ratio / unit) + name
    return three_digits(ratio)


def time_words(ns):
    for unit, name in (1e9, " s"), (1e6, " ms"), (1e3, " us"):
        if ns >= 0.9995 * unit:
            return three_digits(ns / unit) + name
    return three_digits(ns) + " ns"


def cell_text(cell):
    return f"{cell:.4g}" if isinstance(cell, float) else str(cell)


def quantile(values, share):
    """Interpolated linearly between neighbours."""
    values, place = sorted(values), share * (len(values) - 1)
    below = math.floor(place)
    return values[below] + (place - below) * (values[min(below + 1, len(values) - 1)] - values[below])


# ---- Tables, plots, pages ----

@dataclass
class Table:
    columns: list
    rows: list = field(default_factory=list)

    def text(self):
        lines = [[cell_text(cell) for cell in row] for row in [self.columns, *self.rows]]
        widths = [max(map(len, column)) for column in zip(*lines)]
        return "\n".join("  ".join(cell.rjust(width) for cell, width in zip(line, widths)) for line in lines)

    def html(self):
        def line(tag, cells):
            return "<tr>" + "".join(f"<{tag}>{html.escape(cell_text(cell))}</{tag}>" for cell in cells) + "</tr>\n"
        return ("<div class=wide><table>\n" + line("th", self.columns) +
                "".join(line("td", row) for row in self.rows) + "</table></div>\n")


LOOKS = """<style>
body { font: 15px/1.45 sans-serif; max-width: 75em; margin: 2em auto; padding: 0 1em }
table { border-collapse: collapse; margin: 1em 0; font-size: 90% }
th, td { border-bottom: 1px solid #ccc; padding: 0.2em 0.7em; text-align: right; white-space: nowrap }
th { vertical-align: bottom; white-space: normal }
th:first-child, td:first-child { text-align: left }
.wide { overflow-x: auto } summary { cursor: pointer } img { max-width: 100% }
</style>
"""


class Page:
    """A report in HTML, plots included."""

    def __init__(self, title):
        self.body = (f"<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>{html.escape(title)}"
                     f"</title>\n{LOOKS}<h1>{html.escape(title)}</h1>\n")
        self.plots_fail = False

    def add(self, tag, text):
        self.body += f"<{tag}>{html.escape(text)}</{tag}>\n"

    def warn(self, text):
        self.body += f"<p><b>{html.escape(text)}</b></p>\n"

    def table(self, table):
        self.body += table.html()

    def section(self, title, text, table):
        """Nothing, if the table has no rows."""
        if table.rows:
            self.add("h2", title)
            self.add("p", text)
            self.table(table)

    def plot(self, script, what):
        """Runs a script of gnuplot, which writes SVG. The first failure is noted, others are silent."""
        try:
            drawn = subprocess.run(["gnuplot"], input=script.encode(), capture_output=True, check=True).stdout
            self.body += (f"<p><img alt=\"{html.escape(what)}\" src=\"data:image/svg+xml;base64,"
                          f"{base64.b64encode(drawn).decode()}\"></p>\n")
        except (OSError, subprocess.CalledProcessError) as error:
            said = getattr(error, "stderr", b"").decode(errors="replace").split("\n")
            if not self.plots_fail:
                self.warn("Plots are missing, because gnuplot " +
                          ("is not on the PATH." if isinstance(error, OSError) else f"failed: {' '.join(said)}"))
            self.plots_fail = True

    def write(self, path):
        """The file appears whole or not at all."""
        part = Path(f"{path}.part")
        part.write_text(self.body, encoding="utf-8")
        os.replace(part, path)


# P. Tol's bright and vibrant schemes, which most people can tell apart; types of gnuplot's points.
COLOURS = ["#228833", "#4477aa", "#ee6677", "#ccbb44", "#000000", "#ee7733", "#aa3377", "#66ccee", "#009988", "#888888"]
MARKS = [7, 5, 9, 13, 15, 11, 6, 4, 8, 12, 14, 10, 2, 1, 3]


def quoted(text):
    """As gnuplot has it, on one line."""
    return "'" + " ".join(text.split()).replace("'", "''") + "'"


def terminal(width, height):
    return (f"set terminal svg size {width},{height} noenhanced font 'sans,12' background rgb 'white'\n"
            "set grid lt 1 lc rgb '#dddddd'\n")


def styles(names):
    """A colour for what stands before the dot of a name, a mark for the name: no two names share both."""
    groups = sorted({name.split(".")[0] for name in names})
    style_of, members = {}, Counter()
    for name in sorted(names):
        group = groups.index(name.split(".")[0])
        colour = group % len(COLOURS)
        style_of[name] = COLOURS[colour], MARKS[members[colour] % len(MARKS)]
        members[colour] += 1
    return style_of


def block(name, rows):
    """Rows of numbers as data of a script."""
    return f"${name} << EOD\n" + "".join(" ".join(map(str, row)) + "\n" for row in rows) + "EOD\n"


def ticks(names):
    """Names of 0, 1, ... on an axis, whose words are a format."""
    return "(" + ", ".join(f"{quoted(name.replace('%', '%%'))} {i}" for i, name in enumerate(names)) + ")"


def lines_script(title, threads, seconds, efficiency):
    """Seconds and efficiency, lists by name, against threads."""
    def lines(name, values_of):
        return block(name, zip(threads, *values_of.values())), "plot " + ", ".join(
            f"${name} using 1:{column} with linespoints lw 2 pt 7 ps 0.7 lc rgb '{colour}' title {quoted(part)}"
            for column, (part, colour) in enumerate(zip(values_of, COLOURS), 2)) + "\n"
    seconds_data, seconds_plot = lines("seconds", seconds)
    efficiency_data, efficiency_plot = lines("efficiency", efficiency)
    return (terminal(900, 400) + seconds_data + efficiency_data +
            f"set multiplot layout 1,2 title {quoted(title)}\nset key outside below horizontal\n"
            "set xlabel 'threads'\nset logscale x 2\nset xrange [0.9:*]\n"
            f"set logscale y\nset ylabel 'seconds'\n{seconds_plot}"
            f"unset logscale y\nset yrange [0:1.2]\nset ylabel 'parallel efficiency'\n{efficiency_plot}")


def bars_script(axis, rows, values_of):
    """A bar for each row, stacked of values_of[name]."""
    return (terminal(900, 400) + block("bars", zip(*values_of.values())) +
            "set style data histograms\nset style histogram rowstacked\nset style fill solid 0.8\nset boxwidth 0.75\n"
            f"set key outside right top vertical invert\nset ylabel {quoted(axis)}\nset yrange [0:*]\n"
            f"set xtics {ticks(rows)} rotate by 20 right font ',9'\nplot " + ", ".join(
                f"$bars using {column} lc rgb '{colour}' title {quoted(name)}"
                for column, (name, colour) in enumerate(zip(values_of, COLOURS), 1)) + "\n")


def dots_script(title, axis, rows, value_of, style_of):
    """A row for each case and a mark for each value_of[name][case], on a logarithmic axis from a tenth to a
    hundred times the usual best; what is farther out stands at the edge."""
    best = [min(values[row] for values in value_of.values() if row in values) for row in rows]
    usual = statistics.median(best)
    script = terminal(1000, 100 + max(20 * len(rows), 17 * len(value_of)))
    script += (f"set title {quoted(title)}\nset xlabel {quoted(axis)}\nset logscale x\nset key outside right top\n"
               f"set yrange [{len(rows) - 0.5}:-0.5]\nset offsets graph 0.03, graph 0.03, 0, 0\n"
               f"set ytics {ticks(rows)}\n")
    plots = []
    for i, (name, values) in enumerate(value_of.items()):
        script += block(f"d{i}", ((min(max(values[row], usual / 10), usual * 100), y)
                                  for y, row in enumerate(rows) if row in values))
        colour, mark = style_of[name]
        plots.append(f"$d{i} using 1:2 with points pt {mark} ps 0.9 lw 1.4 lc rgb '{colour}' title {quoted(name)}")
    return script + "plot " + ", ".join(plots) + "\n"
