#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bad input is refused in one sentence, with exit code 2 (6 for files), and nothing is written: rows of bad_input.txt.

    python3 bad_input.py PATH_TO_CRAWLER
"""
import os
import pathlib
import re
import shlex
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, contents, expect  # noqa: E402

CRAWLER = pathlib.Path(sys.argv[1]).resolve()
ROWS = pathlib.Path(__file__).with_suffix(".txt")
FORMULA = ("subsection Active stress\nset Generator = expression\nsubsection Expression\nset Active stress = {}\n"
           "set Constants = {}\nend\nend\n")
TERM = "subsection Active stress\nset Generator = sum\nsubsection Sum\nsubsection Term 1\n{}\nend\nend\nend\n"
# Nothing of libraries and languages below the program is for its users.
DUMPS = ("Error Message", "deal.II", "PETSC ERROR", "terminate called", "MPI_ABORT", "exception")


def in_sections(path, lines):
    """Lines in the sections of a path like Active stress/Expression."""
    names = path.split("/")
    return "".join(f"subsection {name}\n" for name in names) + lines + "\n" + "end\n" * len(names)


def content(text):
    """Content of the parameter file that a row describes."""
    kind, _, rest = text.partition(":")
    rest = rest.removeprefix(" ")
    if kind == "formula":
        return FORMULA.format(*(rest.split(" with ") + [""])[:2])
    if kind == "term":
        return TERM.format(rest)
    if kind == "wave":
        return in_sections("Active stress/Optimal wave", rest)
    if text.startswith("["):
        return "".join(in_sections(path, lines.strip(" ")) for path, lines in re.findall(r"\[(.*?)\] ?([^[]*)", text))
    return "" if text == "(nothing)" else text + "\n"


def fill(folder):
    """Everything else that the rows speak of."""
    for name, text in (("good.prm", "set Accuracy = 1e-3\n"), ("wrong.prm", "subsection Body\n  set Length = x\nend\n"),
                       ("circle.prm", "include bad.prm\n"), ("occupied", "a file\n"),
                       ("zip.csv", "PK\x03\x04"), ("full/summary.json", "older results\n"), ("killed/study.lock", ""),
                       ("odd/solution", "not a folder\n")):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")


def expect_refusal(folder, arguments, code, parts, what):
    before = contents(folder)
    done = call([CRAWLER, *arguments], folder, input="")
    words = done.stderr
    expect(done.returncode == code and words.startswith("crawler: ") and words.count("\n") == 1 and words.endswith("\n")
           and all(part in words for part in parts) and not any(dump in words for dump in DUMPS) and done.stdout == "",
           f"{what}: {parts} expected, exit code {done.returncode}, {words!r}")
    expect(contents(folder) == before, f"{what}: files were changed")


def rows():
    """Input, exit code and parts of the sentence of each row."""
    text = re.sub(r"\n +\|", " |", ROWS.read_text(encoding="utf-8"))
    for line in text.splitlines():
        if line and not line.startswith("#"):
            cells = line.encode("ascii").decode("unicode_escape").split(" | ")
            code = 6 if "exit 6" in cells else 2
            yield cells[0], code, [cell for cell in cells[1:] if cell != "exit 6"]


def test_rows(folder):
    fill(folder)
    for text, code, parts in rows():
        bad, arguments = folder / "bad.prm", ["run", "bad.prm", "--output", "results"]
        bad.unlink(missing_ok=True)
        if text.startswith("$"):
            arguments = shlex.split(text[1:])
        elif text.startswith("UTF-16: "):
            bad.write_text(text, encoding="utf-16")
        else:
            command, _, rest = text.partition(": ")
            if command in ("sweep", "tradeoff"):
                arguments[0], text = command, rest
            bad.write_bytes(content(text).encode())
        expect_refusal(folder, arguments, code, parts, repr(text))


def test_unreadable(folder):
    """A link to itself cannot be read; a file without permissions can be read by root only."""
    bad = folder / "bad.prm"
    bad.symlink_to("bad.prm")
    expect_refusal(folder, ["run", "bad.prm", "--output", "results"], 6, ['cannot read "bad.prm"'], "a link to itself")
    bad.unlink()
    if os.geteuid() != 0:
        bad.write_text("set Accuracy = 1e-3\n", encoding="utf-8")
        bad.chmod(0)
        done = call([CRAWLER, "run", "bad.prm", "--output", "results"], folder)
        expect(done.returncode == 6 and "permission denied" in done.stderr, f"no permission: {done.stderr!r}")


checks.run((test_rows, test_unreadable))
