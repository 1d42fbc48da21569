#!/usr/bin/env python3
"""The Markdown pages: a forge shows them as they are, MkDocs makes a site of them.

    pages.py check         fails, naming file and line, where a link, picture, table, list or code block is broken
    pages.py site FOLDER   writes MkDocs' input into FOLDER: mkdocs.yml, and in pages/ the pages and what they link to
    pages.py built FOLDER  fails if the site in FOLDER has links to nowhere or loads anything from elsewhere

To be run at the top of the repository. The site has the paths of the repository; a linked source is files/PATH.txt, so
that a browser shows it. Its navigation is the lists of docs/README.md. MkDocs calls this file, too (on_...).
"""

import html.parser
import json
import os
import re
import shutil
import sys
from collections import Counter

LINK = re.compile(r"(!?)\[([^][]*)\]\(([^)\s]+)\)")
HEADING = re.compile(r"^(#+ )(.*)$", re.MULTILINE)
CODE = re.compile(r"^[ ]*```.*?^[ ]*```[^\n]*$", re.MULTILINE | re.DOTALL)
ITEM = re.compile(r" *([-*+]|\d+[.)]) ")
SHOWN = (".md", ".png", ".svg")  # what a browser shows; other files become text


def pages():
    """All Markdown pages below the current folder, except those that tests have to be broken."""
    for folder, folders, files in os.walk("."):
        folders[:] = sorted(f for f in folders if not re.match(r"\.|build|broken$", f))
        yield from (os.path.normpath(os.path.join(folder, f)) for f in sorted(files) if f.endswith(".md"))


def is_off_site(page):
    """Is the page only in the repository? So are the notebook, and decisions that are superseded."""
    return page.startswith("docs/notebook/") or (
        page.startswith("docs/decisions/") and "\nStatus: superseded" in read(page))


def read(page):
    with open(page, encoding="utf-8") as file:
        return file.read()


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def blanked(text):
    """The text with its code replaced by blank lines, so that places in it stay."""
    return CODE.sub(lambda code: re.sub(r"[^\n]", " ", code[0]), text)


def slugs(text):
    """The part of a link after # that a forge gives each heading. Repeated ones are numbered."""
    seen = Counter()
    for match in HEADING.finditer(blanked(text)):
        slug = re.sub(r"[^\w\- ]", "", LINK.sub(r"\2", match[2]).lower().strip()).replace(" ", "-")
        yield f"{slug}-{seen[slug]}" if seen[slug] else slug
        seen[slug] += 1


def target_of(page, link):
    """(path, part after #) of a relative link, None of any other. A folder is its README, if it has one."""
    if re.match(r"[a-z]+:", link):
        return None
    path, _, part = link.partition("#")
    path = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
    readme = os.path.join(path, "README.md")
    return (readme if os.path.isfile(readme) else path), part


# ---- Faults of the pages ----


def link_faults(page, text):
    for match in LINK.finditer(text):
        found = target_of(page, match[3])
        if not found:
            continue
        path, part = found
        line = text.count("\n", 0, match.start(3)) + 1
        if not os.path.exists(path):
            yield line, f"there is no {path}"
        elif part and not (path.endswith(".md") and part in slugs(read(path))):
            yield line, f"{path} has no heading #{part}"


def table_faults(lines):
    """Faults of the rows that begin at lines[0]; a row's cells are what a forge takes for them."""
    counts = [len(re.findall(r"(?<!\\)\|", line.strip())) - 1 for line in lines]
    if len(lines) < 2 or not re.fullmatch(r"[|: -]+", lines[1]) or "-" not in lines[1]:
        yield 0, "this table has no line |---| below its header"
    for at, (line, count) in enumerate(zip(lines, counts)):
        if not line.strip().endswith("|"):
            yield at, "this row of a table does not end in |"
        elif count != counts[0]:
            yield at, f"this row has {count} cells, but the header of its table has {counts[0]}"


def block_faults(lines):
    """Faults of a block, which is lines between empty ones: (line in the block, fault)."""
    rows = [line.lstrip().startswith("|") for line in lines]
    if rows and all(rows):
        yield from table_faults(lines)
    elif any(rows):
        yield rows.index(True), "a table needs an empty line before and after it"
    for at, line in enumerate(lines):
        if not ITEM.match(line):
            continue
        if (len(line) - len(line.lstrip())) % 4:
            yield at, "a list inside a list is indented by 4"
        elif not ITEM.match(lines[0]) and not lines[0].startswith(" "):
            yield at, "a list needs an empty line before it"


def layout_faults(text):
    if any(fence.lstrip().startswith("```") for fence in blanked(text).split("\n")):
        last = [i for i, line in enumerate(text.split("\n"), 1) if line.lstrip().startswith("```")][-1]
        yield last, "this code block, or one before it, is not closed"
        return
    for match in CODE.finditer(text):
        if (len(match[0]) - len(match[0].lstrip(" "))) % 4:
            yield text.count("\n", 0, match.start()) + 1, "a code block inside a list is indented by 4"
    begin, block = 1, []
    for number, line in enumerate([*blanked(text).split("\n"), ""], 1):
        if line.strip():
            block = block or []
            begin = begin if block else number
            block.append(line)
        else:
            yield from ((begin + at, fault) for at, fault in block_faults(block))
            block = []


def check():
    """Prints the faults of all pages; how many there are."""
    bad = 0
    for page in pages():
        text = read(page)
        for line, fault in sorted([*link_faults(page, blanked(text)), *layout_faults(text)]):
            bad += 1
            print(f"{page}:{line}: {fault}", file=sys.stderr)
    return bad


# ---- The site ----


def for_site(page, linked):
    """The text of a page with a forge's names of headings. Adds the files that it links to to `linked`."""

    def relinked(match):
        picture, text, link = match.groups()
        found = target_of(page, link)
        if not found:
            return match[0]
        path, part = found
        if os.path.isdir(path) or (path.endswith(".md") and is_off_site(path)):
            return text
        linked.add(path)
        place = os.path.relpath(path if path.endswith(SHOWN) else f"files/{path}.txt", os.path.dirname(page) or ".")
        return f"{picture}[{text}]({place}{'#' + part if part else ''})"

    text = read(page)
    names = slugs(text)
    done = []
    for prose, code in zip(CODE.split(text), [*CODE.findall(text), ""], strict=True):
        prose = HEADING.sub(lambda heading: f"{heading[0]} {{#{next(names)}}}", prose)
        done += [LINK.sub(relinked, prose), code]
    return "".join(done)


def navigation():
    """The sections of docs/README.md with the pages that their items link to, as MkDocs wants them."""
    sections = [{"Ductile": "README.md"}]
    for title, items in re.findall(r"^\*\*(.*?)\*\*\n\n((?:[- ] ?.*\n)+)", read("docs/README.md"), re.MULTILINE):
        found = [(text[:1].upper() + text[1:], target_of("docs/README.md", link)[0]) for _, text, link in
                 LINK.findall(items)]
        sections.append({title: [{text: path} for text, path in found
                                 if path.endswith(".md") and not is_off_site(path)]})
    return sections


def site(folder):
    linked = set()
    for page in pages():
        if not is_off_site(page):
            write(os.path.join(folder, "pages", page), for_site(page, linked))
    for path in linked:
        if not path.endswith(".md"):
            place = os.path.join(folder, "pages", path if path.endswith(SHOWN) else f"files/{path}.txt")
            os.makedirs(os.path.dirname(place), exist_ok=True)
            shutil.copy(path, place)
    here = os.path.dirname(os.path.abspath(__file__))
    shutil.copy(os.path.join(here, "style.css"), os.path.join(folder, "pages"))
    version = re.search(r"^project\(ductile VERSION ([0-9.]*)", read("CMakeLists.txt"), re.MULTILINE)[1]
    config = read(os.path.join(here, "mkdocs.yml")).replace("@HERE@", here).replace("@VERSION@", version)
    write(os.path.join(folder, "mkdocs.yml"), f"{config}\nnav: {json.dumps(navigation())}\n")


def on_nav(nav, **_):
    """Called by MkDocs: the API reference, which Doxygen makes, comes last in the navigation."""
    from mkdocs.structure.nav import Link
    nav.items.append(Link("API reference", "api/index.html"))


def on_post_build(config, **_):
    """Called by MkDocs: a page opened as a file may not fetch the index of the search, but may run a script."""
    index = os.path.join(config["site_dir"], "search", "search_index.json")
    write(index[:-len("on")], f"__search_index({read(index)})")


class Loads(html.parser.HTMLParser):
    """The links of a page, and what it loads."""

    def __init__(self, page):
        super().__init__()
        self.links, self.loads = [], []
        self.feed(read(page))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if value and name in ("href", "src") and (tag, dict(attributes).get("rel")) != ("link", "canonical"):
                (self.links if tag == "a" else self.loads).append(value)


def built(folder):
    """Prints the faults of the pages of the site, and of the reference what it loads from elsewhere."""
    bad = 0
    for path in (os.path.join(at, name) for at, _, names in os.walk(folder) for name in names):
        if path.endswith(".css"):
            links, loads = [], re.findall(r"url\([\"']?((?:https?:)?//[^)]*)", read(path))
        elif path.endswith(".html") and os.path.basename(path) != "404.html":
            page = Loads(path)
            links, loads = page.links, page.loads
        else:
            continue
        in_reference = os.path.relpath(path, folder).startswith("api" + os.sep)
        for link in loads + ([] if in_reference else links):
            target = os.path.join(os.path.dirname(path), re.split("[?#]", link)[0])
            if re.match("(https?:)?//", link):
                fault = f"loads {link}" if link in loads else None
            else:
                local = not re.match("[a-z]+:", link) and not os.path.exists(target)
                fault = f"there is no {link}" if local else None
            if fault:
                bad += 1
                print(f"{path}: {fault}", file=sys.stderr)
    return bad


def main():
    match sys.argv[1:]:
        case ["check"]:
            return 1 if check() else 0
        case ["site", folder]:
            return site(folder)
        case ["built", folder]:
            return 1 if built(folder) else 0
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main())
