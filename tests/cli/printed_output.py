#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the user guide prints as output of the program is what the program prints: the files that stand in the guide are
run as the guide says, and each line of output in it is looked for in what comes out.

    python3 printed_output.py [--write] PATH_TO_CRAWLER MPIEXEC...

Of the results no line may be missing. Words must be the same; numbers of many digits to 1e-5 of their size, others to two
units of their last digit, those of two digits to 1e-2, errors and residuals to a factor of two. Times and numbers of
points per second may be any. With --write the lines of the guide that differ become those that the program prints.
"""
import math
import os
import pathlib
import re
import sys
import tempfile

from documentation import ROOT, split_blocks

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call  # noqa: E402

WRITES = sys.argv[1] == "--write"
CRAWLER, *MPIEXEC = sys.argv[2 if WRITES else 1:]
CRAWLER = str(pathlib.Path(CRAWLER).resolve())
GUIDE = ROOT / "doc" / "user_guide.md"
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+\.?\d*(?:e[-+]?\d+)?(?![\w])")
TIMES = re.compile(r"[\d.]+(?:e[-+]\d+)? (s|ms|points/s)(?![\w])")
# How lines of output begin; all others of the guide are commands, files or code.
BEGINNINGS = ("Body L", "Active stress:", "Optimal wave:", "Model ", "Mesh:", "(for Accuracy", "Output:", "Finished at",
              "displacement  ", "corrected  ", "stress work  ", "dissipation  ", "energy residual", "stretch  ", "stride  ", "wave  ",
              "cost of transport", "efficiency  ", "Results are in", "Sweep:", "18 points", "crawler: ", "worm.prm is")
PROGRESS = re.compile(r"\d+ %  t = ")


def section(text, begin, end):
    """The part of the guide between two headings."""
    return text[text.index(f"\n{begin}\n"):text.index(f"\n{end}\n")]


def shown_file(part, beginning):
    """A file that the part shows, in a block marked prm or with all lines indented."""
    for _, language, block in split_blocks(part)[1]:
        if language == "prm" and beginning in block:
            return block
    block = re.search(rf"((?:^    .*\n|^\n)*^    {re.escape(beginning)}.*\n(?:^    .*\n|^\n)*)", part, re.M)
    return re.sub("^    ", "", block.group(1), flags=re.M)


def pattern(line):
    """The words of a line, and its numbers."""
    line = re.sub(r" +", " ", TIMES.sub(r"T \1", line.strip()))
    return NUMBER.sub("#", line), NUMBER.findall(line)


def are_close(text, other):
    """Are these two numbers one, as the document of this program says?"""
    a, b = float(text), float(other)
    size = max(abs(a), abs(b))
    if size < 1e-3:
        return size < 1e-12 or (a * b > 0 and 0.5 <= a / b <= 2)
    digits = len(re.sub(r"e.*|[-+.]", "", text).lstrip("0"))
    last = 10.0 ** (math.floor(math.log10(size)) - digits + 1)
    return abs(a - b) <= (1e-5 * size if digits >= 6 else 2 * last if digits >= 3 else 1e-2 * size)


def likeness(line, other):
    """How much a printed line is like one of the guide: first its words, then its beginning, then its numbers."""
    (words, numbers), (others, values) = pattern(line), pattern(other)
    close = [are_close(a, b) for a, b in zip(numbers, values)]
    return words == others, len(os.path.commonprefix([words, others])), close[:1] == [True], sum(close)


def differences(part, output):
    """Lines of output in a part of the guide that the program does not print, each with that which it prints instead."""
    printed = [pattern(line) for line in output.splitlines()]
    lines = [line for _, line in split_blocks(part)[0] if line.startswith("    ")]
    lines = [line for line in lines if line.strip().startswith(BEGINNINGS) or PROGRESS.match(line.strip())]
    if len(lines) < 10:
        sys.exit(f"only {len(lines)} lines of output were found")
    for line in lines:
        words, numbers = pattern(line)
        if not any(words == other and all(map(are_close, numbers, others)) for other, others in printed):
            yield line, "    " + max(output.splitlines(), key=lambda other: likeness(line, other))
    results = output[output.index("\nFinished at"):output.index("\nResults are in")].splitlines()[1:]
    for before, line in zip(results, results[1:]):
        if not any(pattern(line)[0] == pattern(own)[0] for own in lines):
            own = next((one for one in lines if pattern(one)[0] == pattern(before)[0]), "")
            yield own, f"{own}\n    {line}"


class Place:
    """A folder in which commands are given."""

    def __init__(self, folder):
        self.folder, self.output = pathlib.Path(folder), ""

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def give(self, code, *words, ranks=1):
        """A command, and which exit code it has."""
        command = [*(MPIEXEC + ["-n", str(ranks)] if ranks > 1 else []), CRAWLER, *words]
        done = call(command, self.folder)
        if done.returncode != code:
            sys.exit(f"{' '.join(words)} ends with {done.returncode}: {done.stdout}{done.stderr}")
        self.output += done.stdout + done.stderr


def main():
    guide = GUIDE.read_text(encoding="utf-8")
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        place, part = Place(folder), section(guide, "## Tutorial", "## Install")
        worm = shown_file(part, "A worm of 10 cm")
        place.write("worm.prm", worm.replace("Elastic modulus ", "Elastic modulous "))
        place.give(2, "check", "worm.prm")
        place.write("worm.prm", worm.replace("exp(-5*t/P))", "exp(-5*t/P)"))
        place.give(2, "check", "worm.prm")
        place.write("worm.prm", worm)
        place.give(0, "check", "worm.prm")
        place.give(0, "run", "worm.prm")
        place.output += (place.folder / "output-worm" / "log.txt").read_text(encoding="utf-8")
        place.give(4, "run", "worm.prm", "--overwrite", "--set", "Active stress/Expression/Constants=A = 22, P = 4")
        place.write("worm_sweep.prm", shown_file(part, "include worm.prm"))
        place.give(0, "sweep", "worm_sweep.prm", ranks=2)
        problems += differences(part, place.output)
    for line, instead in problems:
        print(f"the guide has    {line.strip()}\nthe program says {instead.strip()}")
        guide = guide.replace(line + "\n", instead + "\n")
    if WRITES:
        GUIDE.write_text(guide, encoding="utf-8")
    elif not problems:
        print("the guide prints what the program prints")
    return 0 if WRITES else len(problems)


sys.exit(1 if main() else 0)
