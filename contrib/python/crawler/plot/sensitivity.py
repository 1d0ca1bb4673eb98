#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws what matters in a run of crawler: by how much its displacement changes with the entries of the parameter file,
with a change of the body at one place, and with a push of the active stress at one place and time.

    contrib/python/crawler/plot/sensitivity.py OUTPUT_FOLDER [--last-stride | --from TIME --to TIME] [--output PICTURE]

The picture is sensitivity.png in the folder, unless --output names another one. The times are those of the last panel.

Reads summary.json, sensitivity_body.csv and sensitivity_stress.csv of the folder, which are there with
Output/Sensitivities; needs numpy and matplotlib.
"""
from plotting import (COLOURS, NAMES, SIGNED, Kymograph, InputError, need, parser, picture_of, read_rows,
                      read_summary, run_script, save)

need("numpy", "matplotlib")
import matplotlib.pyplot as plt
import numpy as np


def read_table(path):
    """Columns of a CSV file, without its header."""
    try:
        return np.array([[float(value) for value in row.values()] for row in read_rows(path)]).T
    except (TypeError, ValueError) as error:
        raise InputError(f"{path} is not a table of crawler ({error})") from None


def draw_pushes(figure, axes, options, n):
    """Draws the sensitivity to the active stress over place and time, on n nodes."""
    places, times, pushes = (np.reshape(column, (-1, n)) for column in read_table(options.folder / "sensitivity_stress.csv"))
    if options.begin is not None or options.end is not None or options.last_stride:
        run = Kymograph(options.folder)
        begin, end = run.keep(options.begin, options.end, options.last_stride)
        some = (times[:, 0] >= begin) & (times[:, 0] <= end)
        if some.sum() < 2:
            raise InputError(f"sensitivity_stress.csv has {some.sum()} times from {begin:g} to {end:g}, but 2 or more are expected")
        places, times, pushes = places[some], times[some], pushes[some]
    largest = np.quantile(np.abs(pushes), 0.995) or 1  # thin layers would hide the rest
    mesh = axes.pcolormesh(places[0], times[:, 0], pushes, shading="gouraud", cmap=SIGNED, rasterized=True, vmin=-largest,
                           vmax=largest)
    axes.set(title="where and when active stress pushes", xlabel=NAMES["s"], ylabel=NAMES["t"])
    figure.colorbar(mesh, ax=axes, extend="both", label=r"$\partial D/\partial m(s,t)$ [1/(force time)]")


def draw(options):
    """Reads the files and makes the figure."""
    folder = options.folder
    entries = read_summary(folder, "the output folder of a run with Output/Sensitivities").get("sensitivities")
    if not entries:
        raise InputError(f"{folder / 'summary.json'} has no sensitivities; the output folder of a finished run with "
                      "Output/Sensitivities is expected")
    if not (folder / "sensitivity_body.csv").is_file():
        reason = next((one["reason"] for one in entries.values() if "reason" in one), "the run did not finish")
        raise InputError(f"no sensitivity is known: {reason}")
    known = [(name, one["elasticity"]) for name, one in entries.items() if one["elasticity"] is not None][:10][::-1]
    s, modulus, friction = read_table(folder / "sensitivity_body.csv")
    with_stress = (folder / "sensitivity_stress.csv").is_file()  # missing for very many steps

    figure, panels = plt.subplots(1, 3 if with_stress else 2, figsize=(13 if with_stress else 8.4, 4.2),
                                  layout="constrained", width_ratios=(1, 1.1, 1.25)[:3 if with_stress else 2])
    panels[0].barh([name.split("/")[-1] for name, _ in known], [value for _, value in known],
                   color=[COLOURS[0] if value > 0 else COLOURS[1] for _, value in known])
    panels[0].axvline(0, color="black", linewidth=0.7)
    panels[0].set(title="what matters", xlabel="change of the displacement $D$ [%]\nfor 1 % more of the entry")
    panels[1].plot(s, modulus, label="elastic modulus $k$", color=COLOURS[0])
    panels[1].plot(s, friction, label=r"friction $\gamma$", color=COLOURS[1], linestyle="--")
    panels[1].axhline(0, color="black", linewidth=0.7)
    panels[1].set(title="where the body matters", xlabel=NAMES["s"], xlim=(s[0], s[-1]),
                  ylabel="displacement $D$ for a relative change\nalong a length [1]")
    panels[1].legend(frameon=False)
    if with_stress:
        draw_pushes(figure, panels[2], options, len(s))
    return figure


def main():
    """Command line."""
    options = parser(__doc__, "sensitivity.png", time=True).parse_args()
    save(draw(options), picture_of(options, "sensitivity.png"), study=options.folder, dpi=100, few_colours=True)


if __name__ == "__main__":
    run_script(main)
