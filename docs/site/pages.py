#!/usr/bin/env python3
"""Links among the Markdown pages, which a forge shows as they are and Doxygen makes a site of.

    pages.py check          fails, naming file and line, where a relative link leads nowhere
    pages.py filter FILE    prints a page as Doxygen wants it, headings and links by labels, or a header
    pages.py linked         prints the other files of the repository that pages of the site link to
    pages.py off-site       prints the pages that the site leaves out

To be run at the top of the repository. On the site a linked file is files/PATH.txt, so that a browser shows its text.
"""

import os
import re
import sys
from collections import Counter

LINK = re.compile(r"(!?)\[([^][]*)\]\(([^)\s]+)\)")
HEADING = re.compile(r"^(#+ )(.*)$", re.MULTILINE)
CODE = re.compile(r"^[ ]*```.*?^[ ]*```[^\n]*$", re.MULTILINE | re.DOTALL)


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


def blanked(text):
    """The text with its code replaced by blank lines, so that places in it stay."""
    return CODE.sub(lambda code: re.sub(r"[^\n]", " ", code[0]), text)


def slugs(text):
    """What a forge makes of each heading: the part of a link after #. Repeated ones are numbered."""
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


def links():
    """(page, line, target, part) of every relative link."""
    for page in pages():
        text = blanked(read(page))
        for match in LINK.finditer(text):
            if found := target_of(page, match[3]):
                yield page, text.count("\n", 0, match.start()) + 1, *found


def check():
    """Prints the links that lead nowhere; how many there are."""
    bad = 0
    for page, number, path, part in links():
        if not os.path.exists(path):
            why = f"there is no {path}"
        elif part and not (path.endswith(".md") and part in slugs(read(path))):
            why = f"{path} has no heading #{part}"
        else:
            continue
        bad += 1
        print(f"{page}:{number}: {why}", file=sys.stderr)
    return bad


def label(page, part=""):
    """Doxygen's label of a page, or of the part of it that a link names."""
    name = "index" if page == "README.md" else re.sub(r"[^a-z0-9]+", "-", page[:-len(".md")].lower())
    return name + ("--" + part if part else "")


def is_below(page, other):
    """Whether another page belongs below this one, the README of its folder or of the folder above."""
    folder, name = os.path.split(other)
    owner = os.path.dirname(folder) if name == "README.md" else folder
    return folder != "" and name.endswith(".md") and page == os.path.join(owner, "README.md") != "README.md"


def header_for_doxygen(header):
    """The text of a header without its explicit instantiations, which repeat what is declared above them."""
    return re.sub(r"^extern template[^;]*;", lambda lines: "\n" * lines[0].count("\n"), read(header), flags=re.M)


def for_doxygen(page):
    """The text of a page with labels at its headings and in its links."""
    seen = set()

    def linked(match):
        picture, text, link = match.groups()
        found = target_of(page, link)
        if not found or picture:
            return match[0]
        text = " ".join(text.split())  # Doxygen wants it in one line
        if found[0].endswith(".md") and is_off_site(found[0]):
            return text
        if not found[1] and is_below(page, found[0]) and found not in seen:
            seen.add(found)
            return f'@subpage {label(*found)} "{text}"'
        if found[0].endswith(".md"):
            return f"[{text}](@ref {label(*found)})"
        return f'<a href="files/{found[0]}.txt">{text.replace("`", "")}</a>' if os.path.isfile(found[0]) else text

    text = read(page)
    names = (label(page, part if i else "") for i, part in enumerate(slugs(text)))
    labels = ("" if name == "index" else f" {{#{name}}}" for name in names)
    done = []
    for prose, code in zip(CODE.split(text), [*CODE.findall(text), ""], strict=True):
        prose = HEADING.sub(lambda heading: heading[0] + next(labels), prose)
        done += [LINK.sub(linked, prose), code]
    return "".join(done)


def main():
    command = sys.argv[1] if len(sys.argv) > 1 else ""
    if command == "check":
        return 1 if check() else 0
    if command == "filter":
        path = os.path.relpath(sys.argv[2])
        print((for_doxygen if path.endswith(".md") else header_for_doxygen)(path), end="")
    elif command == "linked":
        found = {path for page, _, path, _ in links() if not is_off_site(page) and os.path.isfile(path)}
        print("\n".join(sorted(path for path in found if not path.endswith((".md", ".png", ".svg")))))
    elif command == "off-site":
        print("\n".join(page for page in pages() if is_off_site(page)))
    else:
        print(__doc__, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
