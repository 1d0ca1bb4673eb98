#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws an atlas of crawler: the outcome of every point, and how the measured error compares with the reported one.

    contrib/python/crawler/plot/atlas.py OUTPUT_FOLDER [--output PICTURE]

Reads atlas.csv and parameters.prm of the folder and writes atlas.png and atlas.svg there (or PICTURE); needs numpy and
matplotlib.
"""
import csv
import math

from plotting import INK, SIZES, Parameters, InputError, existing, label, need, number, parser, run_script, save

need("numpy", "matplotlib")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib import colormaps
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

WAVE = "Active stress/Optimal wave/"
CHI, P = WAVE + "Perturbation parameter", "Body/Anchoring exponent"
WRONG = "silent wrong answer"
COLOURS = {"finished": "#A6D0EC", "inverted inside": "#E69F00", "inverted at end": "#8C510A", "refused": "#D9D9D9",
           "not computed": "#FFFFFF", WRONG: "#D40000"}
FAILURES = ("#CC79A7", "#7F7F7F", "#009E73", "#0072B2", "#F0E442", "#B3A2D4", "#333333")  # the most frequent first


class Atlas:
    """The columns of atlas.csv as grids: row i is the i-th value of the second axis, column j that of the first."""

    def __init__(self, folder):
        path = existing(folder / "atlas.csv", "the output folder of crawler atlas")
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            self.rows = list(reader)
        self.entries = reader.fieldnames[1:3]
        if not self.rows or "outcome" not in reader.fieldnames:
            raise InputError(f"{path} has no points")
        self.x, self.y = (sorted({float(row[name]) for row in self.rows}) for name in self.entries)
        self.outcome = np.full((len(self.y), len(self.x)), "not computed", dtype=object)
        self.ratio, self.error = (np.full(self.outcome.shape, math.nan) for _ in range(2))
        for row in self.rows:
            i, j = self.y.index(float(row[self.entries[1]])), self.x.index(float(row[self.entries[0]]))
            self.outcome[i, j] = row["outcome"] or "not computed"
            measured, promised = number(row["run measured error"]), (number(row["run promised error"])
                                                                     + number(row["refined promised error"]))
            self.error[i, j] = measured
            self.ratio[i, j] = measured / promised if promised > 0 else math.nan
        text = folder / "parameters.prm"
        self.parameters = Parameters(text) if text.is_file() else None

    def entry(self, name):
        """The value of an entry of the optimal wave, body or time; empty if it is not known."""
        return self.parameters.values.get(name, "") if self.parameters else ""

    def label(self, axis):
        """The name of the first or second axis."""
        entry = self.entries[axis]
        return label(entry, self.parameters.units.get(entry, "") if self.parameters else "")


def is_logarithmic(values):
    """Whether the ratios of neighbours are alike, and not their differences."""
    if len(values) < 3 or values[0] <= 0:
        return False
    ratios = [b / a for a, b in zip(values, values[1:])]
    return max(ratios) / min(ratios) < 1.05 and max(ratios) > 1.1


def edges(values):
    """The borders of cells around the values."""
    if is_logarithmic(values):
        return [math.exp(edge) for edge in edges([math.log(value) for value in values])]
    middle = [(a + b) / 2 for a, b in zip(values, values[1:])]
    if not middle:
        return [values[0] - 0.5, values[0] + 0.5]
    return [2 * values[0] - middle[0], *middle, 2 * values[-1] - middle[-1]]


def end_inversion(atlas):
    """The chi from which on an end inverts, 1 + (chi a_1/c) sin(2 pi c t/L) <= 0 at some t <= T; None if not known."""
    try:
        c, length, duration, a_1 = (float(atlas.entry(name)) for name in (
            WAVE + "Wave speed", "Body/Length", "Time/End time", WAVE + "Sine coefficients"))
    except ValueError:
        return None
    if (atlas.entry("Active stress/Generator") != "optimal wave" or atlas.entry(WAVE + "Choose wave by") != "wave speed"
            or atlas.entry(WAVE + "Cosine coefficients") != "0"):
        return None
    steps = [a_1 / c * math.sin(2 * math.pi * c * duration / length * i / 1000) for i in range(1001)]
    return -1 / min(steps) if min(steps) < 0 else None


def draw_theory(axes, atlas):
    """What is known without a run, if the axes are chi and p; returns the handles of the legend."""
    handles = []
    if atlas.entries != [CHI, P]:
        return handles
    (left, right), (low, high) = ((edges(values)[0], edges(values)[-1]) for values in (atlas.x, atlas.y))
    if low < 2 < high:
        axes.axhspan(2, high, facecolor="none", edgecolor=INK, alpha=0.3, hatch="////", linewidth=0)
        axes.axhline(2, color=INK, linewidth=0.9)
        handles.append(Patch(facecolor="none", edgecolor="0.6", hatch="////", linewidth=0.5,
                             label=r"theory: cannot invert inside ($p\geq2$)"))
    if low < 1 < high:
        axes.axhline(1, color=INK, linewidth=0.9, linestyle=(0, (4, 3)))
        handles.append(Line2D([], [], color=INK, linewidth=0.9, linestyle=(0, (4, 3)), label="theory: stays in place"))
    chi = end_inversion(atlas)
    if chi is not None and left < chi < right:
        axes.axvline(chi, color=INK, linewidth=1.2, linestyle="-.")
        handles.append(Line2D([], [], color=INK, linewidth=1.2, linestyle="-.", label="theory: an end inverts"))
    return handles


def grid_lines(atlas):
    """White lines between the cells, if these are large enough for them."""
    few = max(len(atlas.x), len(atlas.y)) <= 30
    return dict(edgecolors="white", linewidth=0.3) if few else dict(edgecolors="face", linewidth=0.1)


def mark_wrong(axes, atlas):
    """A cross on each silent wrong answer, as large as the cells allow."""
    places = [(atlas.x[j], atlas.y[i]) for i in range(len(atlas.y)) for j in range(len(atlas.x))
              if atlas.outcome[i, j] == WRONG]
    if places:
        size = min(5.0, 110 / max(len(atlas.x), len(atlas.y)))  # points
        axes.scatter(*zip(*places), marker="x", s=size**2, color="black", linewidths=0.12 * size, zorder=5)


def draw_outcomes(axes, legend, atlas):
    """Left panel: named colours, and their legend in axes of its own."""
    present = {str(name) for name in atlas.outcome.flat}
    names = [name for name in COLOURS if name in present]
    failures = sorted(present - set(COLOURS), key=lambda name: -(atlas.outcome == name).sum())
    colours = dict(COLOURS, **{name: FAILURES[i % len(FAILURES)] for i, name in enumerate(failures)})
    names = [*names[:-1], *failures, names[-1]] if WRONG in names else [*names, *failures]
    values = np.vectorize(names.index)(atlas.outcome)
    axes.pcolormesh(edges(atlas.x), edges(atlas.y), values, cmap=ListedColormap([colours[name] for name in names]),
                    vmin=-0.5, vmax=len(names) - 0.5, **grid_lines(atlas))
    theory = draw_theory(axes, atlas)
    mark_wrong(axes, atlas)
    handles = [Patch(facecolor=colours[name], edgecolor="0.4", linewidth=0.5,
                     label=name if name == "not computed" else f"{name} ({(atlas.outcome == name).sum()})")
               for name in names]
    if WRONG not in present:
        handles.append(Patch(facecolor=colours[WRONG], edgecolor="0.4", linewidth=0.5, label=f"{WRONG} (0)"))
    legend.axis("off")
    legend.legend(handles=handles + theory, loc="center", ncols=3, fontsize=8, frameon=False, borderpad=0, borderaxespad=0)
    axes.set_title(f"outcome of {len(atlas.rows)} points")


def draw_errors(figure, axes, atlas):
    """Right panel: the measured error over the reported one, or the measured error if none was reported."""
    relative = bool(np.isfinite(atlas.ratio).any())
    values = atlas.ratio if relative else atlas.error
    known = values[np.isfinite(values) & (values > 0)]
    if known.size == 0:
        axes.text(0.5, 0.5, "no error could be measured", transform=axes.transAxes, ha="center", va="center")
        return
    lowest = 1e-3 if relative else max(known.min(), 1e-16)
    norm = LogNorm(lowest, 1 if relative else max(known.max(), 10 * lowest), clip=False)
    colours = colormaps[SIZES].with_extremes(over=COLOURS[WRONG], bad="0.93")
    shown = np.where(np.isfinite(values), np.maximum(values, lowest), np.nan)
    mesh = axes.pcolormesh(edges(atlas.x), edges(atlas.y), shown, cmap=colours, norm=norm,
                           **grid_lines(atlas))
    axes.set_facecolor("0.93")  # where nothing is known
    mark_wrong(axes, atlas)
    bar = figure.colorbar(mesh, ax=axes, extend="both" if relative else "neither", pad=0.03)
    bar.set_label("measured error / reported error [1]" if relative else "measured error [length]")
    axes.set_title("error of the displacement")


def draw(folder):
    """Reads the files and makes the figure."""
    atlas = Atlas(folder)
    figure = plt.figure(figsize=(7.5, 4.5), layout="constrained")
    left, right, legend = figure.subplot_mosaic("oe;ll", width_ratios=(1, 1.15), height_ratios=(1, 0.18)).values()
    draw_outcomes(left, legend, atlas)
    draw_errors(figure, right, atlas)
    left.set_ylabel(atlas.label(1))
    for axes in left, right:
        axes.set_xlabel(atlas.label(0))
        axes.set(xlim=(edges(atlas.x)[0], edges(atlas.x)[-1]), ylim=(edges(atlas.y)[0], edges(atlas.y)[-1]))
        for name, values in ("x", atlas.x), ("y", atlas.y):
            if is_logarithmic(values):
                axes.set(**{f"{name}scale": "log"})
                if len(values) <= 8:
                    axes.set(**{f"{name}ticks": values, f"{name}ticklabels": [f"{value:.3g}" for value in values]})
                    axes.tick_params(axis=name, which="minor", length=0)
            else:
                axes.locator_params(axis=name, steps=(1, 2, 5, 10), nbins=6)
    return figure


def main():
    """Command line."""
    options = parser(__doc__, "atlas.png, atlas.svg").parse_args()
    pictures = [options.output] if options.output else [options.folder / name for name in ("atlas.png", "atlas.svg")]
    try:
        save(draw(options.folder), *pictures, study=options.folder, dpi=200)
    except (KeyError, ValueError) as error:
        raise InputError(f"{options.folder / 'atlas.csv'} is not a table of crawler atlas ({error})") from None


if __name__ == "__main__":
    run_script(main)
