#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs all parameter files of a folder and draws them on one sheet: the body on the ground, coloured by its stretch.

    contrib/plot/gallery.py PATH_TO_CRAWLER [--examples prm/examples] [--output doc/images/gallery.png]

Of an installed program (share/crawler/plot/gallery.py) the examples beside it, to gallery.png in the current folder.
Needs matplotlib (Debian: python3-matplotlib). Each panel has its own colours, from the smallest stretch (dark) to the
largest (bright), which stand in its title with the displacement.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

from kymograph import Problem, read_kymograph, read_number

COLUMNS = 4


def run(program, parameters, folder):
    """The output folder of one example."""
    output = folder / parameters.stem
    result = subprocess.run([program, "run", parameters, "--output", output, "--quiet"], capture_output=True, text=True,
                            check=False)
    if result.returncode != 0:
        raise Problem(f"{parameters}: {result.stderr.strip()}")
    return output


def draw_body(axes, name, folder):
    """The body on the ground over time, with five of its points."""
    parameters = (folder / "parameters.prm").read_text(encoding="utf-8")
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    length, duration = read_number(parameters, "Length"), read_number(parameters, "End time")
    s, t, stretch, displacement = read_kymograph(folder / "kymograph.vts", ("stretch", "displacement"))
    position = [[length * x + u for x, u in zip(s, row)] for row in displacement]
    times = [duration * y for y in t]
    axes.pcolormesh(position, [[time] * len(s) for time in times], stretch, cmap="cividis", shading="gouraud",
                    rasterized=True)
    for quarter in range(5):
        i = quarter * (len(s) - 1) // 4
        axes.plot([row[i] for row in position], times, color="black", linewidth=0.9 if quarter in (0, 4) else 0.4)
    low, high = min(map(min, stretch)), max(map(max, stretch))
    axes.set_title(f"{name}\nD = {summary['displacement']:.3g}, stretch {low:.2g} to {high:.2g}", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.set_ylim(0, duration)


def main():
    """Command line."""
    here = pathlib.Path(__file__).resolve()
    root = next((folder for folder in here.parents if (folder / "prm" / "examples").is_dir()), here.parents[2])
    pictures = root / "doc" / "images"
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path, help="the program crawler")
    parser.add_argument("--examples", type=pathlib.Path, default=root / "prm" / "examples")
    parser.add_argument("--output", type=pathlib.Path, default=(pictures if pictures.is_dir() else pathlib.Path()) / "gallery.png")
    options = parser.parse_args()
    try:
        import matplotlib
    except ImportError:
        raise Problem("matplotlib is missing; install it (Debian: apt install python3-matplotlib)") from None
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    files = sorted(options.examples.glob("*.prm"))
    if not files:
        raise Problem(f"{options.examples} has no parameter files")
    rows = -(-len(files) // COLUMNS)
    figure, panels = plt.subplots(rows, COLUMNS, figsize=(2.6 * COLUMNS, 2.4 * rows), layout="constrained", squeeze=False)
    with tempfile.TemporaryDirectory() as name:
        for panel, parameters in zip(panels.flat, files):
            draw_body(panel, parameters.stem.replace("_", " "), run(options.program.resolve(), parameters, pathlib.Path(name)))
            print(parameters.stem, flush=True)
    for panel in panels.flat[len(files):]:
        panel.axis("off")
    figure.supxlabel("position on the ground", fontsize=9)
    figure.supylabel("time", fontsize=9)
    figure.savefig(options.output, dpi=130)
    from PIL import Image  # comes with matplotlib; 256 colours: less than half the size
    Image.open(options.output).convert("RGB").quantize(256, dither=Image.Dither.NONE).save(options.output, optimize=True)
    print(f"wrote {options.output}")


if __name__ == "__main__":
    try:
        main()
    except (Problem, OSError) as problem:
        sys.exit(f"gallery.py: {problem}")
