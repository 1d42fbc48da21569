"""Each fault that docs/site/pages.py looks for is put into every page, at a random place: it is found on its line.

Run at the top of the repository."""

import contextlib
import glob
import io
import os
import random
import re
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.join(os.getcwd(), "docs", "site"))
import pages

TEXTS = {page: pages.read(page) for page in pages.pages()}


def faults(page, text):
    """{line: fault}, as `check` prints them."""
    return dict([*pages.link_faults(page, pages.blanked(text)), *pages.layout_faults(text)])


def lines_of_prose(text):
    """Numbers, from 0, and texts of the lines outside code, of which a page has one more at its end."""
    return list(enumerate([*pages.blanked(text).split("\n"), ""]))


class Faults(unittest.TestCase):
    def put(self, name, places, change):
        """Changes a random one of the places (line from 0, text) of each page; `change` gives the new lines."""
        rng, tried = random.Random(name), 0
        for page, text in TEXTS.items():
            found = places(text)
            if not found:
                continue
            number, line = rng.choice(found)
            new, at = change(line)
            lines = text.split("\n")
            lines[number:number + 1] = new
            with self.subTest(page=page, line=number + 1):
                self.assertIn(number + 1 + at, faults(page, "\n".join(lines)))
            tried += 1
        self.assertGreater(tried, 10)

    def test_pages_have_none(self):
        for page, text in TEXTS.items():
            self.assertEqual(faults(page, text), {}, page)

    def test_row_without_a_cell(self):
        def rows(text):
            lines = lines_of_prose(text)
            return [row for row, above in zip(lines[2:], lines) if row[1].startswith("|") and above[1].startswith("|")]
        self.put("row", rows, lambda row: ([re.sub(r"\|[^|]*\|$", "|", row.rstrip())], 0))

    def test_row_that_is_not_closed(self):
        self.put("end", lambda text: [row for row in lines_of_prose(text) if row[1].startswith("|")],
                 lambda row: ([row.rstrip()[:-1]], 0))

    def test_table_without_its_second_line(self):
        self.put("rule", lambda text: [row for row in lines_of_prose(text) if re.match(r"\|[-:| ]*-[-:| ]*$", row[1])],
                 lambda _: ([], -1))

    def test_table_below_a_paragraph(self):
        def heads(text):
            lines = lines_of_prose(text)
            return [row for row, above in zip(lines[1:], lines) if row[1].startswith("|") and not above[1].strip()]
        self.put("table", heads, lambda row: (["A paragraph.", row], 1))

    def test_list_below_a_paragraph(self):
        def firsts(text):
            lines = lines_of_prose(text)
            return [line for line, above in zip(lines[1:], lines) if line[1].startswith("- ") and not above[1].strip()]
        self.put("list", firsts, lambda line: (["A paragraph.", line], 1))

    def test_list_in_a_list_that_is_not_one(self):
        self.put("nested", lambda text: [line for line in lines_of_prose(text) if line[1].startswith("- ")],
                 lambda line: ([line, "  - inside"], 1))

    def test_code_that_is_not_closed(self):
        for page, text in TEXTS.items():
            fences = [i for i, line in enumerate(text.split("\n")) if line.lstrip().startswith("```")]
            for fence in fences[::2]:
                lines = text.split("\n")
                del lines[fence]
                self.assertTrue(faults(page, "\n".join(lines)), f"{page}:{fence + 1}")

    def test_link_and_picture_to_nowhere(self):
        def links(text):
            return [line for line in lines_of_prose(text) if re.search(r"\]\((?![a-z]+:)[^)\s#]", line[1])]
        self.put("link", links, lambda line: ([re.sub(r"\]\((?![a-z]+:)", "](nowhere/", line)], 0))

    def test_link_to_a_heading_that_is_not_there(self):
        self.put("part", lambda text: [line for line in lines_of_prose(text) if ".md#" in line[1]],
                 lambda line: ([line.replace(".md#", ".md#no-")], 0))


class Excerpts(unittest.TestCase):
    def test_lines_of_excerpts_are_in_the_examples(self):
        """Blocks of `c++` show parts of docs/examples, which are compiled; those of `cpp` are compiled themselves."""

        def plain(line):
            return " ".join(re.sub(r"//.*", "", line).split())

        examples = " ".join(plain(line) for path in glob.glob("docs/examples/*.hpp")
                            for line in pages.read(path).split("\n"))
        examples, found = " ".join(examples.split()), 0
        for page, text in TEXTS.items():
            for block in re.findall(r"^ *```c\+\+\n(.*?)^ *```", text, re.MULTILINE | re.DOTALL):
                for line in filter(None, map(plain, block.splitlines())):
                    self.assertIn(line, examples, page)
                    found += 1
        self.assertGreater(found, 20)


    def test_lines_of_the_loops_with_solvers_are_in_their_scripts(self):
        """Blocks of `py` and `freefem`: the scripts run in doors/python/tests/test_solvers.py."""

        def plain(text):
            return [" ".join(re.sub(r"  #.*", "", line).split()) for line in text.split("\n") if line.strip()]

        scripts = glob.glob("docs/examples/*.py") + glob.glob("docs/examples/*.edp")
        lines, found = {line for path in scripts for line in plain(pages.read(path))}, 0
        for _, block in re.findall(r"^```(py|freefem)\n(.*?)^```", TEXTS["docs/solvers.md"], re.MULTILINE | re.DOTALL):
            for line in plain(block):
                self.assertTrue(line in lines, line)
                found += 1
        self.assertGreater(found, 8)


class Site(unittest.TestCase):
    def test_leaves_out_the_notebook_and_superseded_decisions(self):
        off = [page for page in TEXTS if pages.is_off_site(page)]
        self.assertIn("docs/notebook/README.md", off)
        self.assertIn("docs/decisions/0013-tiles.md", off)
        self.assertFalse([page for page in off if not page.startswith(("docs/notebook/", "docs/decisions/0"))])

    def test_links_only_to_what_it_has(self):
        for page in TEXTS:
            if not pages.is_off_site(page):
                linked = set()
                pages.for_site(page, linked)
                self.assertFalse([path for path in linked if path.endswith(".md") and pages.is_off_site(path)])
                self.assertFalse([path for path in linked if not os.path.isfile(path)])

    def test_what_is_built_has_no_broken_links_and_loads_nothing_from_elsewhere(self):
        for html, faults_of in (('<img src="a.png"><a href="https://a.org/">', 0), ('<img src="none.png">', 1),
                                ('<a href="none.html#part">', 1), ('<a href="a.png#part">', 0),
                                ('<script src="https://a.org/a.js">', 1), ('<link href="//a.org/a.css">', 1),
                                ('<a href="none.html"><img src="none.png">', 2)):
            with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stderr(io.StringIO()):
                pages.write(os.path.join(folder, "a.png"), "")
                pages.write(os.path.join(folder, "page.html"), html)
                self.assertEqual(pages.built(folder), faults_of, html)

    def test_navigation_has_each_page_of_the_guide(self):
        listed = [path for section in pages.navigation() for pages_of in section.values() if isinstance(pages_of, list)
                  for entry in pages_of for path in entry.values()]
        self.assertEqual(len(listed), len(set(listed)))
        missing = [page for page in TEXTS if re.fullmatch(r"docs/[^/]*\.md", page) and page not in listed]
        self.assertEqual(missing, ["docs/README.md"])


if __name__ == "__main__":
    unittest.main()
