#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws a run of crawler: the moving body, its stretch over body and time, and its displacement.

    contrib/python/crawler/plot/kymograph.py OUTPUT_FOLDER [--stress] [--last-stride | --from TIME --to TIME] [--output PICTURE]

The picture is kymograph.png in the folder, unless --output names another one. With --stress the active stress over s
and t comes first.

Reads kymograph.vts, statistics.csv, parameters.prm and summary.json of the folder; needs numpy and matplotlib.
"""
from plotting import (NAMES, Kymograph, InputError, draw_body, draw_field, existing, need, parser, picture_of, read_rows,
                      run_script, save)

need("numpy", "matplotlib")
import matplotlib.pyplot as plt
import numpy as np


def read_statistics(folder):
    """Time and displacement of every step and snapshot."""
    path = existing(folder / "statistics.csv", "the output folder of a run with Output/Statistics = true")
    try:
        rows = [{name.split(" [")[0]: cell for name, cell in row.items()} for row in read_rows(path)]
        return np.array([[float(row["time"]), float(row["displacement"])] for row in rows]).T
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"{path} has no column {error}") from None


def draw(options, size=None):
    """Reads the files and makes the figure. @p size: width and height [inch] in a journal."""
    run = Kymograph(options.folder, "stretch", "displacement", "active_stress")
    times, travelled = read_statistics(options.folder)
    if run.t[0] > 0:
        print(f"{options.folder / 'kymograph.vts'} begins at t = {run.t[0]:.6g}: of long runs it has the last strides")
    begin, end = run.keep(options.begin, options.end, options.last_stride)

    stress = options.stress
    figure = plt.figure(figsize=size or (10.5 if stress else 7.8, 5.8), layout="constrained")
    panels = figure.subplot_mosaic("amb;ddd" if stress else "bm;dd", height_ratios=(3, 1.15))
    bar = {"location": "bottom", "aspect": 30} if stress else {}
    if stress:
        figure.colorbar(draw_field(panels["a"], run, "active_stress"), ax=panels["a"], label=NAMES["active_stress"], **bar)
    mesh = draw_body(panels["b"], run)
    panels["b"].set(title="the moving body and nine of its points")
    draw_field(panels["m"], run, "stretch")
    figure.colorbar(mesh, ax=panels["m"], label=NAMES["stretch"], **bar)
    if stress:
        figure.colorbar(mesh, ax=panels["b"], label=NAMES["stretch"], **bar)
    some = (times >= begin - 1e-9 * end) & (times <= end + 1e-9 * end)
    panels["d"].plot(times[some], travelled[some], color="black", linewidth=1.2)
    panels["d"].set(xlabel=NAMES["t"], ylabel="displacement\n$D$ [length]", xlim=(begin, end))
    for axes in panels.values():
        axes.locator_params(steps=(1, 2, 5, 10))
    if size:
        for letter, axes in zip("abcd", panels.values()):
            axes.set_title("")
            axes.set_title(f"({letter})", loc="left")
    panels["d"].grid(color="0.85", linewidth=0.6)
    return figure


def arguments():
    """Parser of the command line."""
    own = parser(__doc__, "kymograph.png", time=True)
    own.add_argument("--stress", action="store_true", help="draws the active stress as well")
    return own


def main():
    """Command line."""
    options = arguments().parse_args()
    save(draw(options), picture_of(options, "kymograph.png"), study=options.folder, dpi=120, few_colours=True)


if __name__ == "__main__":
    run_script(main)
