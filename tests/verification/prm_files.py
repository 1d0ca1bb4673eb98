#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Checks and runs every prm/**/*.prm and compares it with what it says about itself.

    python3 prm_files.py PATH_TO_CRAWLER

A file says what to expect of summary.json in a line like
    # Expect: displacement 0.0900725298, stress_power 0.08386012, tolerance 1e-8
with a relative tolerance (an absolute one where the value is 0); a dot leads inside: min_stretch.value.
"""
import math
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect  # noqa: E402
from tables import json_of  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "prm"
GENERATED = FOLDER / "default.prm"  # the listing of all entries; it must run, but expects nothing
FEW_SNAPSHOTS = ("--set", "Output/Number of snapshots=4")
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


class Problem(Exception):
    """Something to put in the last column of the table."""


def expectation(text):
    """The quantities {name: value} and the tolerance of the Expect line of a parameter file."""
    lines = [line for line in text.splitlines() if line.startswith("# Expect:")]
    if len(lines) != 1:
        raise Problem(f"{len(lines)} lines start with \"# Expect:\", one is expected")
    expected = {}
    for item in lines[0].removeprefix("# Expect:").split(","):
        match = re.fullmatch(rf"([a-z_.]+) ({NUMBER})", item.strip())
        if not match or match[1] in expected:
            raise Problem(f"found \"{item.strip()}\" in the Expect line, \"name value\" is expected, each name once")
        expected[match[1]] = float(match[2])
    tolerance = expected.pop("tolerance", None)
    if tolerance is None or not 0 < tolerance < 0.1 or not expected:
        raise Problem("the Expect line needs a quantity and a tolerance between 0 and 0.1")
    return expected, tolerance


def crawler(*arguments):
    done = call(arguments)
    if done.returncode != 0:
        reason = (done.stderr.strip() or done.stdout.strip() or "no message").splitlines()[-1]
        raise Problem(f"{arguments[1]} exits with {done.returncode}: {reason}")


def quantity(summary, name):
    """The number of this name in the summary."""
    for key in name.split("."):
        summary = summary.get(key) if isinstance(summary, dict) else None
    if not isinstance(summary, (int, float)) or isinstance(summary, bool) or not math.isfinite(summary):
        raise Problem(f"summary.json has no number {name}")
    return summary


def check(program, path, folder, row):
    """Prints a table row for each quantity of one file; raises Problem if one is off."""
    expected, tolerance = ({}, 0.0) if path == GENERATED else expectation(path.read_text())
    crawler(program, "check", path)
    crawler(program, "run", path, "--quiet", "--output", folder / "output", "--overwrite", *FEW_SNAPSHOTS)
    summary = json_of(folder / "output/summary.json")
    if summary["status"] != "finished":
        raise Problem(f"status is {summary['status']}")
    seconds, wrong = sum(summary["seconds"].values()), []
    if not expected:
        print(row.format(str(path.relative_to(FOLDER)), *5 * ("",), f"{seconds:.2f}"))
    for name, value in expected.items():
        found = quantity(summary, name)
        error = abs(found - value) / (abs(value) or 1.0)
        if not error <= tolerance:
            wrong.append(name)
        print(row.format(str(path.relative_to(FOLDER)), name, f"{value:.10g}", f"{found:.10g}", f"{error:.1e}",
                         f"{tolerance:g}", f"{seconds:.2f}"))
    if wrong:
        raise Problem("not as expected: " + ", ".join(wrong))


def main(folder):
    files = sorted(FOLDER.rglob("*.prm"))
    row = "{:<%d}  {:<14} {:>15} {:>15} {:>8} {:>10} {:>8}" % max(len(str(f.relative_to(FOLDER))) for f in files)
    print(row.format("file", "quantity", "expected", "found", "error", "tolerance", "seconds"))
    for path in files:
        found = None
        try:
            check(sys.argv[1], path, folder, row)
        except (Problem, OSError, ValueError) as problem:
            found = problem
        expect(found is None, f"{path.relative_to(FOLDER)}: {found}")


checks.run((main,))
