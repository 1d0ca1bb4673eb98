#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws the scaling of speed and cost of transport from a sweep over prm/studies/scaling.prm, and prints the exponents.

    python3 scaling.py OUTPUT_FOLDER SCALING_CSV [--output scaling.png]

Needs numpy and matplotlib (Debian: python3-matplotlib).
"""
import argparse
import csv
import pathlib
import sys


def read(path):
    """The rows of a CSV file."""
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def main():
    """Reads, fits, draws."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("--output", type=pathlib.Path)
    arguments = parser.parse_args()
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np

    worms, results = read(arguments.table), read(arguments.folder / "results.csv")
    if len(worms) != len(results) or any(row["status"] != "finished" for row in results):
        sys.exit("scaling.py: a finished sweep over all rows of the table is expected")
    column = {name: np.array([float(row[name]) for row in worms]) for name in ("mass", "frequency", "end_time", "length")}
    displacement, work = (np.array([float(row[name]) for row in results]) for name in ("displacement", "stress_power"))
    speed = displacement / column["end_time"]
    body_speed, cost = speed / column["length"], work / (column["mass"] * displacement)
    by_mass = np.array([row["family"] == "mass" for row in worms])

    figure, panels = plt.subplots(1, 3, figsize=(10, 3.4), layout="constrained")
    for panel, x, y, mask, names, unit, exponent in (
            (panels[0], column["mass"], speed, by_mass, ("mass $M$", "speed"), ("g", "mm/s"), 1 / 3),
            (panels[1], column["frequency"], body_speed, ~by_mass, (r"stride frequency $\nu$", "speed $U$"), ("1/s", "body lengths/s"), 1),
            (panels[2], column["frequency"], cost, ~by_mass, (r"stride frequency $\nu$", "cost of transport"), ("1/s", "mN/g"), 1)):
        x, y = x[mask], y[mask]
        power, shift = np.polyfit(np.log(x), np.log(y), 1)
        print(f"{names[1].replace('$', '')} ~ {names[0].split('$')[1]}^{power:.5f} (theory {exponent:.5f}, off by {100 * abs(power / exponent - 1):.3f} %)")
        panel.loglog(x, y, "o", color="#0072B2", markersize=5, label="sweep")
        panel.loglog(x, np.exp(shift) * x**power, "-", color="#0072B2", linewidth=1, label=f"fit: exponent {power:.4f}")
        if panel is panels[0]:
            panel.loglog(x, 3.8 * x**0.33, "--", color="#D55E00", linewidth=1.2, label="paper's fit to earthworms, 3.8 $M^{0.33}$")
        panel.set(xlabel=f"{names[0]} [{unit[0]}]", ylabel=f"{names[1]} [{unit[1]}]")
        panel.legend(fontsize=7)
        panel.grid(alpha=0.3, which="both")
    output = arguments.output or arguments.folder / "scaling.png"
    figure.savefig(output, dpi=150)
    print(f"wrote {output}")


if __name__ == "__main__":
    main()
