#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes the figures of Santhosh and Serra, Phys. Rev. E 106, 024610 (2022), anew, and checks the number that each shows.

    contrib/paper/make_figures.py BUILD [OUT]

BUILD is the build folder, or the program crawler itself. Into OUT (default: BUILD/paper) come fig_*.png, movie.gif, the
runs, and numbers.md, the tables that are printed. Ends with 7 if a number is off. Takes about 20 s on 2 cores; needs
numpy and matplotlib. doc/images/paper has the pictures of doc/paper.md:

    contrib/paper/make_figures.py build && cp build/paper/*.png build/paper/movie.gif doc/images/paper/
"""
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "contrib/python/crawler/plot"))
from plotting import Parser, InputError, FileError, need, run_script  # noqa: E402

need("numpy", "matplotlib")
import figures  # noqa: E402

SELF_CHECK = 7
CHI, P, C, T = ("Active stress/Optimal wave/Perturbation parameter", "Body/Anchoring exponent",
                "Active stress/Optimal wave/Wave speed", "Time/End time")
S1_CHI = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5)
FRICTION_P = (-1, 0, 1, 2, 4)
S1 = "paper/fig_s1_chi_0.4.prm"
SCAN = f"{P} : linspace(0, 4, 17)"  # over which the direction changes

# Name: command, file in prm/, entries that differ, exit code.
RUNS = {"fig_2": ("run", "paper/fig_2.prm", {}, 0),
        "fig_2_prograde": ("run", "paper/fig_2_prograde.prm", {}, 0),
        "fig_2_largest": ("run", "paper/fig_2.prm", {"Active stress/Optimal wave/Root": "largest displacement"}, 4),
        "direction": ("sweep", S1, {"Sweep/Axes": SCAN, CHI: 0.3, "Accuracy": 1e-6}, 0),
        "scaling": ("sweep", "studies/scaling.prm", {}, 0),
        **{f"fig_s1_{chi:g}": ("run", f"paper/fig_s1_chi_{chi:g}.prm", {}, 0) for chi in S1_CHI},
        **{f"fig_s1_{-chi:g}": ("run", f"paper/fig_s1_chi_{chi:g}.prm", {CHI: -chi}, 0) for chi in (0.1, 0.4)},
        **{f"friction_{p:g}": ("run", S1, {P: p, CHI: 0.3, C: 1 if p > 1 else -1}, 0) for p in FRICTION_P}}


class Results:
    """The output folders of the runs."""

    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise FileError(f"cannot make the folder {folder}: {error.strerror}") from None
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            list(pool.map(self.run, RUNS))

    def run(self, name):
        """Runs one of RUNS."""
        command, file, entries, code = RUNS[name]
        words = [self.program, command, ROOT / "prm" / file, "--output", self.folder / name, "--overwrite", "--quiet"]
        for entry, value in entries.items():
            words += ["--set", f"{entry}={value}"]
        end = subprocess.run(words, capture_output=True, text=True, check=False, cwd=ROOT)
        if end.returncode != code:
            raise InputError(f"{command} {file} ended with {end.returncode}, but {code} is expected: {end.stderr.strip()}")

    def summary(self, name):
        """The numbers of a run."""
        return json.loads((self.folder / name / "summary.json").read_text(encoding="utf-8"))


class Numbers:
    """What the pictures must show, and whether they do."""

    def __init__(self):
        self.tables, self.wrong = {}, []
        rows = json.loads((ROOT / "contrib" / "reference" / "table.json").read_text(encoding="utf-8"))["rows"]
        self.known = {(row["exponent"], row["chi"], row["speed"], row["end_time"], row["elastic_modulus"]): row["values"]
                      for row in rows}

    def reference(self, a, chi, c, end_time):
        """The numbers of the independent solver, modulus 1."""
        return self.known[a, chi, c, end_time, 1]

    def require(self, picture, what, must, found, tolerance, source, digits=7):
        """One number; the tolerance is absolute."""
        shown = f"0 (within {tolerance:.0e})" if must == 0 and abs(found) <= tolerance else f"{found:.{digits}g}"
        row = f"| {what} | {must:.{digits}g} | {shown} | {source} |"
        self.tables.setdefault(picture, []).append(row)
        if not abs(found - must) <= tolerance:
            self.wrong.append(f"{picture}: {what} is {found:.10g}, but {must:.10g} +- {tolerance:.1g} is expected")

    def text(self):
        """All tables, in Markdown."""
        head = "| number | must be | computed | from |\n|---|---|---|---|\n"
        return "\n".join(f"{picture}\n\n{head}" + "\n".join(rows) + "\n" for picture, rows in self.tables.items())


def program_of(build):
    """The program in a build folder."""
    program = build / "crawler" if build.is_dir() else build
    if not os.access(program, os.X_OK) or program.is_dir():
        raise InputError(f"{program} is not there; the build folder of crawler is expected (contrib/setup.sh makes it)")
    return program.resolve()


def main():
    """Command line."""
    own = Parser(description=__doc__.splitlines()[0])
    own.add_argument("build", type=pathlib.Path, metavar="BUILD")
    own.add_argument("out", type=pathlib.Path, metavar="OUT", nargs="?")
    options = own.parse_args()
    program = program_of(options.build)
    out = (options.out or program.parent / "paper").resolve()
    results, numbers = Results(program, out / "runs"), Numbers()
    for figure in figures.ALL:
        figure(results, numbers, out)
    (out / "numbers.md").write_text(numbers.text(), encoding="utf-8")
    print(numbers.text())
    if numbers.wrong:
        print("\n".join(f"make_figures.py: {line}" for line in numbers.wrong), file=sys.stderr)
        sys.exit(SELF_CHECK)
    print(f"{sum(map(len, numbers.tables.values()))} numbers are right; the pictures are in {out}")


if __name__ == "__main__":
    run_script(main)
