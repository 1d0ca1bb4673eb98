#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws the table of crawler sweep: a heat map over two axes, or lines over one.

    python3 sweep.py OUTPUT_FOLDER [--x ENTRY] [--y ENTRY] [--value COLUMN] [--log] [--fit] [--output PICTURE]

Reads results.h5 of the folder and writes results.png and results.svg there (or PICTURE). ENTRY is an axis of the sweep,
as "Body/Length", or its last words; without --x and --y the last axis is x and the one before it y. COLUMN is any column
of numbers. Lines: --y "" or a sweep with one axis; further axes give a line each. --log: logarithmic axes. --fit: the
power law through the points of each line, in its label. Needs numpy, h5py and matplotlib (Debian: python3-h5py,
python3-matplotlib). Colours are safe for colour-blind readers.
"""
import argparse
import pathlib
import sys

UNKNOWN = "0.85"
LINES = (("#0072B2", "o", "-"), ("#D55E00", "s", "--"), ("#009E73", "^", "-."), ("#CC79A7", "D", ":"),
         ("#E69F00", "v", "-"), ("#56B4E9", "P", "--"), ("#000000", "X", "-."))


class Problem(Exception):
    """What to tell the user."""


class Sweep:
    """The columns of results.h5."""

    def __init__(self, folder):
        import h5py
        path = folder / "results.h5"
        if not path.is_file():
            raise Problem(f"{path} does not exist; the output folder of crawler sweep is expected")
        self.columns, self.units, self.axes = {}, {}, []
        with h5py.File(path, "r") as file:
            for dataset in file["results"].values():
                name = dataset.attrs["name"]
                name = name.decode() if isinstance(name, bytes) else name
                text = dataset.dtype.kind == "S"
                self.columns[name] = dataset.asstr()[:] if text else dataset[:]
                self.units[name] = as_text(dataset.attrs["unit"])
                if as_text(dataset.attrs["description"]) == "axis of the sweep":
                    self.axes.append(name)

    def find(self, name, among, what):
        """The one column whose name is or ends with this."""
        if name in among:
            return name
        found = [column for column in among if column.lower().endswith(name.lower())]
        if len(found) != 1:
            raise Problem(f'"{name}" names {"several" if found else "no"} {what}; one of {", ".join(among)} is expected')
        return found[0]

    def numbers(self):
        """The columns that may be drawn."""
        return [name for name, values in self.columns.items() if values.dtype.kind == "f"]

    def label(self, name):
        """A column with its unit."""
        unit = self.units[name]
        short = name.split("/")[-1].replace("_", " ")
        return f"{short} [{unit}]" if unit not in ("", "1") else short


def as_text(value):
    """Attributes are bytes in older versions of h5py."""
    return value.decode() if isinstance(value, bytes) else str(value)


def is_logarithmic(values):
    """Whether the ratios of neighbours are alike, and not their differences."""
    if len(values) < 3 or values[0] <= 0:
        return False
    ratios = [b / a for a, b in zip(values, values[1:])]
    return max(ratios) / min(ratios) < 1.05 and max(ratios) > 1.1


def heat_map(axes, figure, sweep, x, y, value, log):
    """Every point a cell; grey where the value is not known. Values of further axes are averaged away: refused."""
    import numpy as np
    from matplotlib.colors import LogNorm

    xs, ys = np.unique(sweep.columns[x]), np.unique(sweep.columns[y])
    grid = np.full((len(ys), len(xs)), np.nan)
    i, j = np.searchsorted(ys, sweep.columns[y]), np.searchsorted(xs, sweep.columns[x])
    if len(set(zip(i, j))) < len(i):
        raise Problem(f'several points have the same "{x}" and "{y}"; a sweep over these two is expected, or --y ""')
    if len(i) < grid.size / 2:
        raise Problem('the points are no grid; --y "" draws them as lines')
    grid[i, j] = sweep.columns[value]
    axes.set_facecolor(UNKNOWN)
    positive = grid[np.isfinite(grid)]
    norm = LogNorm() if log and len(positive) and positive.min() > 0 else None
    mesh = axes.pcolormesh(xs, ys, grid, shading="nearest", cmap="cividis", norm=norm, rasterized=True)
    figure.colorbar(mesh, ax=axes, label=sweep.label(value))
    for name, values, scale in ((x, xs, axes.set_xscale), (y, ys, axes.set_yscale)):
        if is_logarithmic(list(values)):
            scale("log")
    axes.set_xlabel(sweep.label(x))
    axes.set_ylabel(sweep.label(y))
    if np.isnan(grid).any():
        axes.set_title("grey: not known (see column status)", fontsize=9)


def lines(axes, sweep, x, value, log, fit):
    """A line over x for each combination of the other axes."""
    import numpy as np

    others = [axis for axis in sweep.axes if axis != x]
    keys = list(zip(*(sweep.columns[axis] for axis in others))) or [()] * len(sweep.columns[x])
    different = sorted(set(keys))
    if len(different) > 40:
        raise Problem(f"{len(different)} lines are too many to tell apart; a sweep over fewer axes is expected")
    for number, key in enumerate(different):
        mine = np.array([other == key for other in keys])
        order = np.argsort(sweep.columns[x][mine])
        xs, values = sweep.columns[x][mine][order], sweep.columns[value][mine][order]
        colour, marker, style = LINES[number % len(LINES)]
        label = ", ".join(f"{axis.split('/')[-1].lower()} = {one:g}" if isinstance(one, float) else f"{one}"
                          for axis, one in zip(others, key))
        known = np.isfinite(values)
        if fit:
            power, shift = np.polyfit(np.log(xs[known]), np.log(np.abs(values[known])), 1)
            label += ("; " if label else "") + f"{np.exp(shift):.3g} x^{power:.4f}"
            print(f"{value} = {np.exp(shift):.6g} * {x}^{power:.6f}{' for ' + str(key) if key else ''}")
        axes.plot(xs, values, color=colour, marker=marker if len(xs) <= 60 else "", linestyle=style, markersize=4,
                  linewidth=1.2, label=label)
    if log or is_logarithmic(sorted(set(sweep.columns[x]))):
        axes.set_xscale("log")
    if log:
        axes.set_yscale("log")
    if different != [()] or fit:
        axes.legend(fontsize=8)
    axes.set_xlabel(sweep.label(x))
    axes.set_ylabel(sweep.label(value))
    axes.grid(alpha=0.3)


def main():
    """Reads the arguments, draws and writes."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--x")
    parser.add_argument("--y")
    parser.add_argument("--value", default="displacement")
    parser.add_argument("--log", action="store_true")
    parser.add_argument("--fit", action="store_true")
    parser.add_argument("--output", type=pathlib.Path)
    arguments = parser.parse_args()
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    sweep = Sweep(arguments.folder)
    value = sweep.find(arguments.value, sweep.numbers(), "column of numbers")
    drawable = [axis for axis in sweep.axes if axis in sweep.numbers()]
    x = sweep.find(arguments.x, drawable + sweep.numbers(), "axis") if arguments.x else drawable[-1]
    rest = [axis for axis in drawable if axis != x]
    y = arguments.y if arguments.y is not None else (rest[-1] if len(rest) == 1 and len(sweep.axes) == 2 else "")
    y = sweep.find(y, drawable, "axis") if y else ""
    figure, axes = plt.subplots(figsize=(6.4, 4.6), constrained_layout=True)
    if y and not arguments.fit:
        heat_map(axes, figure, sweep, x, y, value, arguments.log)
    else:
        lines(axes, sweep, x, value, arguments.log, arguments.fit)
    pictures = [arguments.output] if arguments.output else [arguments.folder / name for name in ("results.png", "results.svg")]
    for picture in pictures:
        figure.savefig(picture, dpi=160)
        print(f"wrote {picture}")


if __name__ == "__main__":
    try:
        main()
    except Problem as problem:
        sys.exit(f"sweep.py: {problem}")
