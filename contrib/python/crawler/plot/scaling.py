#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws the scaling of speed and cost of transport from a sweep over prm/studies/scaling.prm, and prints the exponents.

    contrib/python/crawler/plot/scaling.py OUTPUT_FOLDER [SCALING_CSV] [--output PICTURE] [--require PERCENT]

Reads results.csv of the folder and the table of the worms (prm/studies/scaling.csv, unless another one is named). The
picture is scaling.png in the folder, unless --output names another one. --require: exit code 1 if an exponent is off
theory by more. The band around the paper's fit is the scatter of the measured worms, as far as the paper tells it: with
r^2 = 0.66, slope 0.33 and masses spread evenly over the range, two thirds of the worms lie in it. Needs numpy and
matplotlib.
"""
import pathlib
import sys

from plotting import COLOURS, InputError, need, parser, read_rows, root_folder, run_script, save, script

need("numpy", "matplotlib")
import matplotlib.pyplot as plt
import numpy as np

# Family of the table, x, y, exponent in theory.
LAWS = (("mass", "mass", "speed", 1 / 3), ("material", "mass", "speed", 1 / 3), ("frequency", "frequency", "U", 1),
        ("similar", "frequency", "U", 1), ("frequency", "frequency", "COT", 1), ("similar", "frequency", "COT", 1))
LABELS = {"mass": "mass $M$ [g]", "frequency": r"stride frequency $\nu$ [1/s]", "speed": "speed $U L$ [mm/s]",
          "U": "speed $U$ [body lengths/s]", "COT": "cost of transport\n$W/(M D)$ [mN/g = J/(kg m)]"}
LOOKS = {"mass": (COLOURS[0], "o", r"$k \propto M$"), "material": (COLOURS[1], "x", r"$k \propto M^{2/3}$, same material"),
         "frequency": (COLOURS[0], "o", "same $k$"), "similar": (COLOURS[1], "x", r"$k \propto \nu$")}


TABLE = root_folder() / "prm" / "studies" / "scaling.csv"


def draw_measured(panel):
    """Draws the paper's fit to measured earthworms, and the scatter that corresponds to its r^2."""
    masses, slope, r_squared = np.array([0.012, 8.5]), 0.33, 0.66
    scatter = np.exp(slope * np.log(masses[1] / masses[0]) / np.sqrt(12) * np.sqrt(1 / r_squared - 1))
    speeds = 3.8 * masses**slope
    panel.fill_between(masses, speeds / scatter, speeds * scatter, color=COLOURS[4], alpha=0.2, linewidth=0,
                       label="scatter of the worms ($r^2 = 0.66$)")
    panel.loglog(masses, speeds, "-", color=COLOURS[4], linewidth=5, alpha=0.6,
                 label="paper's fit to earthworms, $3.8\\, M^{0.33}$")


def draw(options):
    """Reads, fits and draws; returns the figure and the laws: for (family, y) factor, exponent and its deviation from
    theory in per cent."""
    worms, results = read_rows(options.table), read_rows(options.folder / "results.csv")
    if not worms or len(worms) != len(results) or any(row.get("status") != "finished" for row in results):
        raise InputError("a finished sweep over all rows of the table is expected")
    column = {name: np.array([float(row[name]) for row in worms]) for name in ("mass", "frequency", "end_time", "length")}
    displacement, work = (np.array([float(row[name]) for row in results]) for name in ("displacement", "stress_power"))
    column["speed"] = displacement / column["end_time"]
    column["U"] = column["speed"] / column["length"]
    column["COT"] = work / (column["mass"] * displacement)
    family = np.array([row["family"] for row in worms])

    figure, panels = plt.subplots(1, 3, figsize=(11, 4.3), layout="constrained")
    panel_of = dict(zip(("speed", "U", "COT"), panels))
    draw_measured(panel_of["speed"])
    laws = {}
    for name, x_name, y_name, exponent in LAWS:
        x, y = column[x_name][family == name], column[y_name][family == name]
        power, shift = np.polyfit(np.log(x), np.log(y), 1)
        off = 100 * abs(power / exponent - 1)
        laws[name, y_name] = np.exp(shift), power, off
        print(f"{name}: {y_name} = {np.exp(shift):.5g} * {x_name}^{power:.6f} (theory {exponent:.6f}, off by {off:.6f} %)")
        colour, marker, label = LOOKS[name]
        panel = panel_of[y_name]
        panel.loglog(x, y, marker, color=colour, markersize=5, label=f"{label}: exponent {power:.4f}",
                     markerfacecolor="none")
        panel.loglog(x, np.exp(shift) * x**power, "-" if marker == "o" else ":", color=colour, linewidth=1)
        panel.set(xlabel=LABELS[x_name], ylabel=LABELS[y_name])
    for panel in panels:
        panel.legend(fontsize=8, loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False)  # covers no points
        panel.grid(alpha=0.3, which="both")
    return figure, laws


def main():
    """Command line."""
    own = parser(__doc__, "scaling.png")
    own.add_argument("table", type=pathlib.Path, nargs="?", default=TABLE, metavar="SCALING_CSV")
    own.add_argument("--require", type=float, metavar="PERCENT")
    options = own.parse_args()
    try:
        figure, laws = draw(options)
    except (KeyError, ValueError) as error:
        raise InputError(f"{options.folder} is not a sweep over {options.table} ({error})") from None
    save(figure, options.output or options.folder / "scaling.png", dpi=150, few_colours=True)
    worst = max(off for _, _, off in laws.values())
    if options.require is not None and not worst <= options.require:
        sys.exit(f"{script()}: an exponent is off by {worst:.3f} %, but at most {options.require:g} % are expected")


if __name__ == "__main__":
    run_script(main)
