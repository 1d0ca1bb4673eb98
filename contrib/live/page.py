#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes the live page, one file: page.html with the compiled core, the styles and scripts that `crawler report` has, and
those of this folder.

    page.py CORE.js PAGE.html
"""
import json
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
REPORT = HERE.parent / "python/crawler/report"
sys.path.insert(0, str(REPORT.parent))
from needs import chart_library  # noqa: E402


def text_of(*paths):
    """The texts of files, one after the other."""
    return "".join(path.read_text(encoding="utf-8") for path in paths)


def templates():
    """The templates of crawler init that describe a run, not a study or a table from a file, by name."""
    found = {path.stem: path.read_text(encoding="utf-8") for path in sorted((HERE.parents[1] / "prm/templates").glob("*.prm"))}
    return {name: re.sub("# (Expect|Next):.*\n", "", text) for name, text in found.items()
            if not re.search(r"subsection (Sweep|Fit|Optimize|Table)", text)}


def main():
    core, page = map(pathlib.Path, sys.argv[1:])
    parts = {"styles": text_of(REPORT / "page.css", HERE / "live.css"),
             "core": text_of(core), "library": chart_library(),
             "scripts": text_of(*(REPORT / name for name in ("base.js", "plot.js", "body.js", "run.js")), HERE / "live.js")}
    parts["templates"] = json.dumps(templates()).replace("<", "\\u003c")
    text = text_of(HERE / "page.html")
    for name, part in parts.items():
        if "</script" in part:
            sys.exit(f"{name}: \"</script\" would end the script of the page")
        text = text.replace("{{" + name + "}}", part)
    page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
