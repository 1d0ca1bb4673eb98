#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws the scaling of speed and cost of transport from a sweep over prm/studies/scaling.prm, and prints the exponents.

    contrib/plot/scaling.py OUTPUT_FOLDER SCALING_CSV [--output scaling.png] [--require PERCENT]

--require: exit code 1 if an exponent is off theory by more. Needs numpy and matplotlib (Debian: python3-matplotlib).
"""
import argparse
import csv
import pathlib
import sys

try:
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np
except ImportError as missing:
    sys.exit(f"scaling.py: {missing}; on Debian: apt install python3-matplotlib")


def read(path):
    """The rows of a CSV file."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))
    except OSError as error:
        sys.exit(f"scaling.py: cannot read {path}: {error.strerror}")


# Family of the table, x, y, exponent in theory.
LAWS = (("mass", "mass", "speed", 1 / 3), ("material", "mass", "speed", 1 / 3), ("frequency", "frequency", "U", 1),
        ("similar", "frequency", "U", 1), ("frequency", "frequency", "COT", 1), ("similar", "frequency", "COT", 1))
LABELS = {"mass": "mass $M$ [g]", "frequency": r"stride frequency $\nu$ [1/s]", "speed": "speed [mm/s]",
          "U": "speed $U$ [body lengths/s]", "COT": "cost of transport [mN/g = J/(kg m)]"}
LOOKS = {"mass": ("#0072B2", "o", r"$k \propto M$"), "material": ("#D55E00", "x", r"$k \propto M^{2/3}$, same material"),
         "frequency": ("#0072B2", "o", "same $k$"), "similar": ("#D55E00", "x", r"$k \propto \nu$")}


def main():
    """Reads, fits, draws."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("--output", type=pathlib.Path)
    parser.add_argument("--require", type=float, metavar="PERCENT")
    arguments = parser.parse_args()
    worms, results = read(arguments.table), read(arguments.folder / "results.csv")
    if not worms or len(worms) != len(results) or any(row["status"] != "finished" for row in results):
        sys.exit("scaling.py: a finished sweep over all rows of the table is expected")
    column = {name: np.array([float(row[name]) for row in worms]) for name in ("mass", "frequency", "end_time", "length")}
    displacement, work = (np.array([float(row[name]) for row in results]) for name in ("displacement", "stress_power"))
    column["speed"] = displacement / column["end_time"]
    column["U"] = column["speed"] / column["length"]
    column["COT"] = work / (column["mass"] * displacement)
    family = np.array([row["family"] for row in worms])

    figure, panels = plt.subplots(1, 3, figsize=(10.5, 4.0), layout="constrained")
    panel_of = dict(zip(("speed", "U", "COT"), panels))
    masses = np.array([0.012, 8.5])
    panel_of["speed"].loglog(masses, 3.8 * masses**0.33, "-", color="#E69F00", linewidth=5, alpha=0.5,
                             label="paper's fit to earthworms, $3.8\\, M^{0.33}$")
    worst = 0.0
    for name, x_name, y_name, exponent in LAWS:
        x, y = column[x_name][family == name], column[y_name][family == name]
        power, shift = np.polyfit(np.log(x), np.log(y), 1)
        off = 100 * abs(power / exponent - 1)
        worst = max(worst, off)
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
    output = arguments.output or arguments.folder / "scaling.png"
    figure.savefig(output, dpi=150)
    print(f"wrote {output}")
    if arguments.require is not None and not worst <= arguments.require:
        sys.exit(f"scaling.py: an exponent is off by {worst:.3f} %, but at most {arguments.require:g} % are expected")


if __name__ == "__main__":
    main()
