#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs all parameter files of a folder and draws them on one sheet: the body on the ground, coloured by its stretch.

    contrib/python/crawler/plot/gallery.py PATH_TO_CRAWLER [--examples prm/examples] [--output doc/images/gallery.png]

Of an installed program (share/crawler/python/crawler/plot/gallery.py) the examples beside it, to gallery.png in the current folder.
Needs numpy and matplotlib. Each panel has colours, units and a scale of its own; its title has the displacement D.
"""
import pathlib
import subprocess
import tempfile

from plotting import Kymograph, Parser, InputError, draw_body, need, read_summary, root_folder, run_script, save

need("numpy", "matplotlib")
import matplotlib.pyplot as plt

COLUMNS = 4


def run(program, parameters, folder):
    """Runs one example; returns its output folder."""
    output = folder / parameters.stem
    result = subprocess.run([program, "run", parameters, "--output", output, "--quiet"], capture_output=True, text=True,
                            check=False)
    if result.returncode != 0:
        raise InputError(f"{parameters}: {result.stderr.strip()}")
    return output


def draw_panel(figure, axes, name, folder):
    """Draws the body on the ground over time, with five of its points."""
    mesh = draw_body(axes, Kymograph(folder, "stretch", "displacement"), parts=4)
    displacement = read_summary(folder, "the output folder of a run")["displacement"]
    axes.set_title(f"{name}\n$D$ = {displacement:.3g}", fontsize=8)
    axes.set(xlabel="", ylabel="")
    axes.tick_params(labelsize=7)
    figure.colorbar(mesh, ax=axes, aspect=25, pad=0.02).ax.tick_params(labelsize=6)


def main():
    """Command line."""
    root = root_folder()
    pictures = root / "doc" / "images"
    parser = Parser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path, help="the program crawler")
    parser.add_argument("--examples", type=pathlib.Path, default=root / "prm" / "examples")
    parser.add_argument("--output", type=pathlib.Path, default=(pictures if pictures.is_dir() else pathlib.Path()) / "gallery.png")
    options = parser.parse_args()
    files = sorted(options.examples.glob("*.prm"))
    if not files:
        raise InputError(f"{options.examples} has no parameter files")
    rows = -(-len(files) // COLUMNS)
    figure, panels = plt.subplots(rows, COLUMNS, figsize=(2.75 * COLUMNS, 2.4 * rows), layout="constrained", squeeze=False)
    with tempfile.TemporaryDirectory() as name:
        for panel, parameters in zip(panels.flat, files):
            output = run(options.program.resolve(), parameters, pathlib.Path(name))
            draw_panel(figure, panel, parameters.stem.replace("_", " "), output)
            print(parameters.stem, flush=True)
    for panel in panels.flat[len(files):]:
        panel.axis("off")
    figure.supxlabel(r"position $\zeta$ on the ground [length]; colours: stretch $w$ [1]", fontsize=9)
    figure.supylabel("time $t$ [time]", fontsize=9)
    save(figure, options.output, dpi=110, few_colours=True)


if __name__ == "__main__":
    run_script(main)
