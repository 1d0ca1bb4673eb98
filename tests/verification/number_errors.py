#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Are the error bounds of works, stretches and gait numbers larger than the errors? (doc/numerics.md, "Error bounds")

    python3 number_errors.py PATH_TO_CRAWLER [POINTS] [SEED]

Random sweeps over five kinds of crawlers, POINTS of each, at three accuracies, against the same sweep with many cells and
Accuracy 1e-9. Prints a table; fails if a number is above its bar in more points than 1 % of these can be expected to
give by chance (in one of 100 samples).
"""
import pathlib
import sys

from scipy.stats import binom

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect, sets  # noqa: E402
from tables import csv_rows  # noqa: E402

BODY = "Body/Anchoring exponent : uniform(1.5, 4); Body/Elastic modulus : "
WAVE = "Active stress/Optimal wave/"
SEGMENTS = "Active stress/Segments/"
SCENES = {  # settings, axes
    "a stride of the optimal wave": ([WAVE + "Choose wave by=wave speed"],
                                     BODY + f"loguniform(0.9, 1.1); {WAVE}Perturbation parameter : uniform(0.05, 0.45)"),
    "optimal waves of any duration": ([WAVE + "Choose wave by=wave speed"],
                                      BODY + f"loguniform(0.3, 30); {WAVE}Perturbation parameter : uniform(0.05, 0.45);"
                                      " Time/End time : uniform(0.5, 4)"),
    "travelling waves with a ramp": (["Active stress/Generator=travelling wave", "Time/End time=3",
                                      "Active stress/Travelling wave/Ramp duration=1"],
                                     BODY + "loguniform(0.7, 10); Active stress/Travelling wave/Amplitude : uniform(0.05, 0.4)"),
    "segments with and without gaps": (["Active stress/Generator=segments", SEGMENTS + "Rate limit=1.5",
                                        SEGMENTS + "Ramp duration=0.5", "Time/End time=3"],
                                       BODY + f"loguniform(0.7, 10); {SEGMENTS}Amplitude : uniform(0.05, 0.3); "
                                       f"{SEGMENTS}Gap : uniform(0, 0.5); {SEGMENTS}Phase lag : uniform(0.06, 0.4)"),
    "pulses": (["Active stress/Generator=pulse", "Time/End time=2"], BODY + "loguniform(0.7, 10)"),
}
ACCURACIES = ("1e-3", "1e-4", "1e-6")


def sweep(program, folder, settings, axes, points, seed, accuracy, more=()):
    text = (f"set Accuracy = {accuracy}\nsubsection Sweep\n  set Design = latin hypercube\n  set Number of points = {points}\n"
            f"  set Seed = {seed}\n  set Axes = {axes}\nend\n")
    (folder / "sweep.prm").write_text(text, encoding="utf-8")
    done = call([program, "sweep", "sweep.prm", "--output", "out", "--overwrite", "--quiet", *sets([*settings, *more])], folder)
    expect(done.returncode == 0, f"the sweep over {axes}: {done.stderr}")
    return csv_rows(folder / "out" / "results.csv")


def judge(rows, reference, judged):
    """Adds (accuracy, bar, error) of each number."""
    for row, exact in zip(rows, reference):
        if row["status"] != "finished" or exact["status"] != "finished":
            continue
        for key in row:
            name = "displacement" if key == "displacement_error.total" else key.removeprefix("errors.")
            if name == key or not row[key]:
                continue
            column = name + ".value" if name.endswith("_stretch") else name
            judged.setdefault(name, []).append((float(row[key]), abs(float(row[column]) - float(exact[column])),
                                                abs(float(exact[column]))))


def main(folder):
    program = str(pathlib.Path(sys.argv[1]).resolve())
    points, seed = (int(sys.argv[i]) if len(sys.argv) > i else default for i, default in ((2, 6), (3, 1)))
    judged = {}
    for settings, axes in SCENES.values():
        reference = sweep(program, folder, settings, axes, points, seed, "1e-9", ["Discretization/Number of cells=24"])
        for accuracy in ACCURACIES:
            judge(sweep(program, folder, settings, axes, points, seed, accuracy), reference, judged)
    print(f"{'number':40s} {'judged':>7s} {'covered':>9s} {'bar/error':>10s} {'worst':>8s} {'largest relative error':>23s}")
    for number, rows in judged.items():
        ratios = sorted(bar / max(error, 1e-300) for bar, error, _ in rows)
        covered = sum(ratio >= 1 for ratio in ratios) / len(ratios)
        largest = max(error / size for _, error, size in rows if size > 0)
        print(f"{number:40s} {len(rows):7d} {100 * covered:7.2f} % {ratios[len(ratios) // 2]:10.3g} {ratios[0]:8.2g} {largest:23.1e}")
        expect(sum(ratio < 1 for ratio in ratios) <= binom.ppf(0.99, len(rows), 0.01), f"{number}: 99 % are wanted")
        expect(len(rows) >= points, f"{number}: {len(rows)} were judged")
    expect(len(judged) >= 17, f"{len(judged)} numbers have error bounds, 17 are expected")


checks.run((main,))
