#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws a run of crawler: the moving body, its stretch over s and t, and its displacement.

    contrib/plot/kymograph.py OUTPUT_FOLDER [--output picture.png] [--stress]

The picture is kymograph.png in the folder, unless --output names another one.
With --stress the active stress over s and t comes first.

Reads kymograph.vts, statistics.csv and parameters.prm of the folder; needs matplotlib (Debian: python3-matplotlib).
"""
import argparse
import array
import base64
import csv
import pathlib
import re
import sys
from xml.etree import ElementTree


class Problem(Exception):
    """What to tell the user."""


def existing(folder, name, entry):
    """The path of a file of the run, which must exist."""
    path = folder / name
    if not path.is_file():
        raise Problem(f"{path} does not exist; the output folder of a finished run with {entry} is expected")
    return path


def numbers(element):
    """Those of a DataArray in base 64, behind the number of their bytes."""
    return array.array("d", base64.b64decode(element.text)[8:]).tolist()


def read_kymograph(path, names):
    """s/L (list), t/T (list) and the wanted fields, each a row of values over s for each time."""
    try:
        piece = ElementTree.parse(path).getroot().find("StructuredGrid/Piece")
        extent = [int(word) for word in piece.get("Extent").split()]
        n_s, n_t = extent[1] - extent[0] + 1, extent[3] - extent[2] + 1
        points = numbers(piece.find("Points/DataArray"))
        fields = []
        for name in names:
            values = numbers(piece.find(f"PointData/DataArray[@Name='{name}']"))
            if len(values) != n_s * n_t or len(points) != 3 * n_s * n_t:
                raise ValueError("wrong number of values")
            fields.append([values[j * n_s:(j + 1) * n_s] for j in range(n_t)])
    except (ElementTree.ParseError, AttributeError, ValueError) as error:
        raise Problem(f"{path} is not a kymograph of crawler ({error})") from None
    return points[0:3 * n_s:3], points[1::3 * n_s], *fields


def read_statistics(path):
    """Time and displacement of every step and snapshot."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    try:
        return tuple([float(row[name]) for row in rows] for name in ("time [time]", "displacement [length]"))
    except (KeyError, TypeError, ValueError) as error:
        raise Problem(f"{path} has no column {error}") from None


def read_number(text, entry):
    """The value of an entry of parameters.prm that has one name only."""
    match = re.search(rf"^\s*set {entry}\s*=\s*([^\s#]+)", text, re.MULTILINE)
    if not match:
        raise Problem(f"parameters.prm has no entry {entry}")
    return float(match[1])


def draw(folder, picture, with_stress):
    """Reads the files and writes the picture."""
    try:
        import matplotlib
    except ImportError:
        raise Problem("matplotlib is missing; install it (Debian: apt install python3-matplotlib)") from None
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    grid = existing(folder, "kymograph.vts", "Output/Kymograph = true and snapshots")
    steps = existing(folder, "statistics.csv", "Output/Statistics = true")
    parameters = existing(folder, "parameters.prm", "its files complete").read_text(encoding="utf-8")
    length, duration = read_number(parameters, "Length"), read_number(parameters, "End time")
    s, t, stretch, displacement, stress = read_kymograph(grid, ("stretch", "displacement", "active_stress"))
    times, travelled = read_statistics(steps)
    position = [[length * x + u for x, u in zip(s, row)] for row in displacement]
    rows_of_t = [[duration * y] * len(s) for y in t]

    plt.rcParams.update({"font.size": 10, "axes.titlesize": 10, "axes.labelsize": 10, "xtick.labelsize": 9,
                         "ytick.labelsize": 9, "axes.linewidth": 0.7})
    figure = plt.figure(figsize=(10.5 if with_stress else 7.5, 5.6), layout="constrained")
    panels = figure.subplot_mosaic("amb;ddd" if with_stress else "bm;dd",
                                   height_ratios=(3, 1.15))
    body, map_, below = panels["b"], panels["m"], panels["d"]
    colours = dict(cmap="cividis", shading="gouraud", rasterized=True)
    bar = {"location": "bottom", "aspect": 30}
    if with_stress:
        largest = max(max(map(abs, row)) for row in stress) or 1
        mesh = panels["a"].pcolormesh(s, t, stress, **(colours | dict(cmap="PuOr_r")), vmin=-largest, vmax=largest)
        panels["a"].set(title="active stress", xlabel="$s/L$", ylabel="$t/T$")
        figure.colorbar(mesh, ax=panels["a"], **bar)
    body.pcolormesh(position, rows_of_t, stretch, **colours)
    for eighth in range(9):  # paths of material points, the ends thicker
        i = eighth * (len(s) - 1) // 8
        at_end = eighth in (0, 8)
        body.plot([row[i] for row in position], [row[0] for row in rows_of_t], color="black",
                  linewidth=1.0 if at_end else 0.5, alpha=1.0 if at_end else 0.5)
    low, high = min(map(min, position)), max(map(max, position))
    margin = 0.03 * (high - low)
    body.set(title="the moving body and nine of its points", xlabel="position", ylabel="time",
             xlim=(low - margin, high + margin), ylim=(0, duration * t[-1]))

    mesh = map_.pcolormesh(s, t, stretch, **colours)
    map_.set(title="stretch of each point", xlabel="$s/L$", ylabel="$t/T$")
    figure.colorbar(mesh, ax=map_, **bar if with_stress else {"label": "stretch"})

    below.plot(times, travelled, color="black", linewidth=1.2)
    below.set(xlabel="time", ylabel="displacement", xlim=(0, times[-1]))
    for axes in body, below:
        axes.locator_params(steps=(1, 2, 5, 10))
    below.grid(color="0.85", linewidth=0.6)
    try:
        figure.savefig(picture, dpi=120 if with_stress else 160)
        if picture.suffix == ".png" and not with_stress:  # 256 colours: less than half the size
            from PIL import Image  # comes with matplotlib
            Image.open(picture).convert("RGB").quantize(256, dither=Image.Dither.NONE).save(picture, optimize=True)
    except (OSError, ValueError) as error:
        raise Problem(f"cannot write {picture}: {error}") from None


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path, help="output folder of crawler run")
    parser.add_argument("--output", type=pathlib.Path,
                        help="the picture (.png, .pdf, .svg); kymograph.png in the folder if it is not given")
    parser.add_argument("--stress", action="store_true", help="draw the active stress as well")
    options = parser.parse_args()
    picture = options.output or options.folder / "kymograph.png"
    try:
        if not options.folder.is_dir():
            raise Problem(f"{options.folder} is not a folder; the output folder of a run is expected")
        draw(options.folder, picture, options.stress)
    except (Problem, OSError) as problem:
        sys.exit(f"kymograph.py: {problem}")
    print(f"wrote {picture}")


if __name__ == "__main__":
    main()
