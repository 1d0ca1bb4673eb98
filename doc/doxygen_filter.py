#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What Doxygen reads instead of a file.  doxygen_filter.py FILE

Markdown: headings get the anchors that links of the repository use (file name and heading: Doxygen's anchors are global),
links to headings become references to them, formulas ($...$, blocks marked math) get Doxygen's marks. C++: formulas
of block comments (a paragraph indented by two) are indented far enough for Doxygen to print them as they are. No line
is added or removed, so warnings name the right one.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]


def anchor(path, heading):
    """The name of a heading (of a page, if there is none), as Doxygen takes it: letters, digits, _ and -."""
    place = "_".join(path.relative_to(ROOT).with_suffix("").parts)
    slug = re.sub(r"[^\w\- ]", "", heading.lstrip("#").strip().lower()).replace(" ", "-")
    return f"{place}--{slug}" if slug else place


def formulas(line):
    """A line whose formulas have Doxygen's marks."""
    if line.startswith("    "):
        return line
    parts = re.split(r"(`[^`]*`)", line)  # every second one is code
    parts[::2] = (re.sub(r"\$([^$\s](?:[^$]*[^$\s])?)\$", r"@f$\1@f$", re.sub(r"\$\$(.+?)\$\$", r"@f[\1@f]", part))
                  for part in parts[::2])
    return "".join(parts)


def markdown(path, text):
    """Headings with anchors, links with references."""

    def link(match):
        words, target = match.groups()
        file, _, heading = target.partition("#")
        other = (path.parent / file).resolve() if file else path
        if re.match(r"[a-z]+:", target) or other.suffix != ".md" or not heading:
            return match.group(0)
        return f"[{words}](@ref {anchor(other, heading)})"

    parts = re.split(r"(^```.*?^```$)", text, flags=re.DOTALL | re.MULTILINE)  # every second one is a fenced block
    seen = set()
    for i in range(0, len(parts), 2):
        lines = parts[i].split("\n")
        for n, line in enumerate(lines):
            if re.match(r"##+ ", line):
                name = anchor(path, line)
                while name in seen:
                    name += "-1"
                seen.add(name)
                lines[n] += f" {{#{name}}}"
        parts[i] = re.sub(r"\[([^\]]*)\]\(([^)\s]+)\)", link, "\n".join(map(formulas, lines)))
    for i in range(1, len(parts), 2):
        parts[i] = re.sub(r"^```math\n(.*)```$", r"@f[\n\1@f]", parts[i], flags=re.DOTALL)
    return "".join(parts)


def cpp(text):
    """Formulas of block comments, indented."""
    lines, formula, blank = [], False, False
    for line in text.splitlines():
        match = re.match(r"( *\* )  ( *\S.*)", line)
        formula = bool(match) and (blank or formula)
        blank = line.strip() == "*"
        lines.append(f"{match.group(1)}    {match.group(2)}" if formula else line)
    return "\n".join(lines)


if __name__ == "__main__":
    FILE = pathlib.Path(sys.argv[1]).resolve()
    CONTENT = FILE.read_text(encoding="utf-8")
    print(markdown(FILE, CONTENT) if FILE.suffix == ".md" else cpp(CONTENT))
