#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws the study of error bounds: the error that runs reported over their true error.

    contrib/python/crawler/plot/calibration.py TABLE.csv [--output PICTURE]

TABLE.csv is the table of build/tests/calibration, or a folder with calibration.csv. The picture is calibration.png
beside it, unless --output names another one. Each accuracy has a colour and a marker of its own. Needs numpy and
matplotlib.
"""
from plotting import COLOURS, DOTS, INK, InputError, existing, need, parser, read_rows, run_script, save

need("numpy", "matplotlib")
import matplotlib.pyplot as plt
import numpy as np


def read(path):
    """Runs with a reported error and a reference that is accurate enough to judge it."""
    rows = read_rows(existing(path, "the table of build/tests/calibration"))
    if not rows or "reported_error" not in rows[0]:
        raise InputError(f"{path} is not a table of build/tests/calibration")
    judged = []
    for row in rows:
        reported, wanted = float(row["reported_error"]), float(row["wanted_error"])
        if reported == reported and float(row["reference_bar"]) <= 0.05 * reported and wanted > 0:
            judged.append((float(row["accuracy"]), float(row["true_error"]), reported, wanted))
    if not judged:
        raise InputError(f"{path} has no run that can be judged")
    return len(rows), judged


def draw(table):
    """Draws on the left the reported over the true error, both relative to the displacement; on the right the
    distribution of their ratio."""
    n_runs, judged = read(table)
    accuracies = sorted({row[0] for row in judged}, reverse=True)
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.5, 4.4), layout="constrained", width_ratios=(1.15, 1))
    for i, accuracy in enumerate(accuracies):
        colour, marker = COLOURS[i % len(COLOURS)], DOTS[i % len(DOTS)]
        rows = np.array([row[1:] for row in judged if row[0] == accuracy])
        size = rows[:, 2] / accuracy
        true, reported = np.maximum(rows[:, 0] / size, 1e-16), rows[:, 1] / size
        left.scatter(true, reported, s=14, marker=marker, facecolors="none", edgecolors=colour, linewidths=0.8)
        ratio = np.sort(reported / true)
        right.step(ratio, np.arange(1, len(ratio) + 1) / len(ratio), where="post", color=colour, linewidth=1.4,
                   linestyle=("-", "--", ":", "-.")[i % 4],
                   label=f"Accuracy {accuracy:g}: median {np.median(ratio):.1f}, "
                         f"{100 * np.mean(ratio >= 1):.1f} % $\\geq$ 1")
        left.scatter([], [], s=20, marker=marker, facecolors="none", edgecolors=colour, label=f"Accuracy {accuracy:g}")
    low = min(min(row[1] / (row[3] / row[0]) for row in judged), 1e-12)
    low = max(low, 1e-14)
    line = np.array([low, 1e-1])
    left.plot(line, line, color=INK, linewidth=0.9, label="reported = true")
    left.plot(line, 10 * line, color=INK, linewidth=0.7, linestyle=(0, (4, 3)), label="reported = 10 true")
    left.set(xscale="log", yscale="log", xlim=(low, 1e-2), ylim=(1e-10, 1e-2),
             xlabel="true error / displacement $D$ [1]", ylabel="reported error / displacement $D$ [1]",
             title=f"{len(judged)} of {n_runs} runs (the reference can judge them)")
    below = dict(fontsize=8, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.17), borderaxespad=0)
    left.legend(ncols=2, columnspacing=1, **below)
    right.axvline(1, color=INK, linewidth=0.9)
    right.axvline(10, color=INK, linewidth=0.7, linestyle=(0, (4, 3)))
    right.set(xscale="log", xlim=(0.3, 1e3), ylim=(0, 1), xlabel="reported error / true error [1]",
              ylabel="share of the runs below [1]", title="how sharp the reported error is")
    right.legend(**below)
    return figure


def main():
    """Command line."""
    options = parser(__doc__, "calibration.png").parse_args()
    table = options.folder / "calibration.csv" if options.folder.is_dir() else options.folder
    save(draw(table), options.output or table.parent / "calibration.png", dpi=200)


if __name__ == "__main__":
    run_script(main)
