#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler fit: its files, its picture, the scene it writes, the comparison of scenes, and refusals.

    python3 fit.py PATH_TO_CRAWLER
"""
import csv
import json
import os
import pathlib
import re
import shutil
import sys
import tempfile

import matplotlib.image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import Checks, call  # noqa: E402

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
STUDIES = pathlib.Path(__file__).resolve().parents[2] / "prm/studies"
TRUTH = {"Body/Anchoring exponent": 2.4, "Body/Elastic modulus": 1.3, "Active stress/Travelling wave/Amplitude": 0.25}
# Arguments, exit code, what the one sentence has.
REFUSED = [
    ([], 2, "FILE"), (["nowhere.prm"], 6, "nowhere.prm"), (["fit_worm.prm"], 2, "--overwrite"), (["fit_worm.prm", "--data", "no.csv"], 6, "no.csv"),
    (["fit_worm.prm", "--outptu", "x"], 2, "--output"), (["fit_worm.prm", "--set", "Body/Length"], 2, "Section/Entry=value"),
    (["fit_worm.prm", "--set", "Body/Lenght=3"], 2, "Length"), (["fit_worm.prm", "--set", "Fit/Data="], 2, "Fit/Data is empty"),
    (["fit_worm.prm", "--set", "Fit/Variables="], 2, "Variables is empty"), (["fit_worm.prm", "--unit-of-t", "1000"], 2, "Time/End time"),
    (["fit_worm.prm", "--output", "fit_worm.prm"], 2, "is a file"), (["fit_worm.prm", "--output", "other", "--overwrite"], 2, "not the folder of a fit"),
    (["fit_worm.prm", "--set", "Fit/Markers at=0,1"], 2, "9 markers"), (["fit_worm.prm", "other/fit_worm.prm"], 2, "same name")]
checks = Checks()
check = checks.expect


def crawler(*arguments):
    """Runs the program."""
    return call([PROGRAM, *arguments], os.getcwd())


def refuses():
    """Every mistake is one sentence and a code, and nothing is lost."""
    pathlib.Path("other").mkdir()
    pathlib.Path("other/kept.txt").write_text("mine", encoding="utf-8")
    shutil.copy("fit_worm.prm", "other")
    before = pathlib.Path("output-fit_worm/summary.json").read_bytes()
    for arguments, code, phrase in REFUSED:
        more = [] if "--output" in arguments or code == 2 and "--overwrite" in phrase else ["--output", "new"]
        ended = crawler("fit", *arguments, *more)
        check(ended.returncode == code and phrase in ended.stderr and ended.stderr.count("\n") == 1,
              f"{arguments}: {ended.returncode}, {ended.stderr}")
    check(pathlib.Path("output-fit_worm/summary.json").read_bytes() == before and pathlib.Path("other/kept.txt").exists()
          and not pathlib.Path("new").exists(), "a refusal changes something")


def main():
    """All of it, in a folder of its own."""
    for name in ("fit_worm.prm", "fit_worm.csv"):
        shutil.copy(STUDIES / name, name)
    ended = crawler("fit", "fit_worm.prm")
    check(ended.returncode == 0, f"the example ends with {ended.returncode}: {ended.stderr}")
    summary = json.loads(pathlib.Path("output-fit_worm/summary.json").read_text(encoding="utf-8"))
    for name, value in TRUTH.items():
        one = summary["variables"][name]
        check(abs(one["value"] - value) < 4 * one["deviation"] and one["interval_95"][0] < one["value"] < one["interval_95"][1],
              f"{name} = {one}, but {value} made the data")
        check(f"{name} " in ended.stdout and f"{one['value']:.6g} +- {one['deviation']:.2g}" in ended.stdout, f"{name} is not printed")
    with open("output-fit_worm/residuals.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    squares = sum(float(row["residual"]) ** 2 for row in rows) / 0.01 ** 2
    check(len(rows) == summary["goodness"]["n_data"] and abs(squares / summary["goodness"]["chi_square"] - 1) < 1e-4, "residuals and chi-square differ")
    check(matplotlib.image.imread("output-fit_worm/fit.png").shape[0] > 300, "there is no picture")
    pathlib.Path("output-fit_worm/fit.png").unlink()
    check(crawler("plot", "output-fit_worm").returncode == 0 and pathlib.Path("output-fit_worm/fit.png").exists(), "plot draws no fit")
    ended = crawler("report", "output-fit_worm")
    check(ended.returncode == 2 and "crawler plot" in ended.stderr, f"report of a fit: {ended.stderr}")
    again = crawler("fit", "output-fit_worm/fitted.prm", "--output", "again")  # it starts where the first one ended
    other = json.loads(pathlib.Path("again/summary.json").read_text(encoding="utf-8"))["variables"]
    check(again.returncode == 0 and all(abs(other[name]["value"] - summary["variables"][name]["value"]) < 0.02 * other[name]["deviation"] for name in TRUTH),
          "the scene that was written fits otherwise")
    refuses()
    pathlib.Path("plain.prm").write_text("include fit_worm.prm\nsubsection Body\n  set Anchoring exponent = 0\nend\nsubsection Fit\n"
                                         "  set Variables = Body/Elastic modulus : 0.3 to 4; Active stress/Travelling wave/Amplitude : 0.02 to 0.8\nend\n",
                                         encoding="utf-8")
    both = crawler("fit", "plain.prm", "fit_worm.prm", "--output", "both")
    order = re.findall(r"^(plain|fit_worm)\.prm +\d", both.stdout, re.M)
    check(both.returncode == 0 and order == ["fit_worm", "plain"] and "does not fit" in both.stdout, f"the comparison is {order}: {both.stderr}")
    quiet = crawler("fit", "fit_worm.prm", "--overwrite", "--quiet")
    check(quiet.returncode == 0 and quiet.stdout == "", "--quiet prints")
    ended = crawler("run", "fit_worm.prm", "--output", "run")
    check(ended.returncode == 0 and 'section "Fit" has no effect with "crawler run"' in ended.stdout, f"a run does not note section Fit: {ended.stdout}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        os.chdir(place)
        main()
        os.chdir("/")
    sys.exit(checks.end())
