#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws an optimisation of crawler: how the gaits became better, the best gait, and what a limit of work costs.

    contrib/plot/optimize.py OUTPUT_FOLDER [--optimum N] [--last-stride | --from TIME --to TIME] [--output PICTURE]

The picture is optimize.png in the folder, unless --output names another one. Its panels:
- the objective of all evaluations, as dots, grey beyond a limit, and the best so far of each start as a line. With
  several limits of work a colour is a limit, otherwise a start; stars are the results;
- strain and active stress of the best gait over s and t; with several limits of work of gait N, 1 being that of the
  first limit; without --optimum of the last one;
- with several limits of work the displacement of the best gaits against their work, and the bound that no gait with the
  same work and extreme strains exceeds (doc/theory.md, "Gait efficiency").

Reads results.csv, summary.json, parameters.prm and best/kymograph.vts (best-N/kymograph.vts) of the folder; needs numpy
and matplotlib.
"""
import collections
import math

from plotting import (COLOURS, NAMES, Kymograph, Parameters, Problem, draw_field, existing, need, number, parser, read_rows,
                      read_summary, run_script, save)

need("numpy", "matplotlib")
import matplotlib.pyplot as plt
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

UNITS = {"displacement": "length", "speed": "length/time", "cost of transport": "force", "merit": "1"}
OBJECTIVES = {"displacement": "displacement $D$", "speed": "speed $U$"}  # with their symbols
ADMISSIBLE = 1e-5  # violation of a limit, relative to it
MOST_NAMES = 7     # in a legend


class Optimisation:
    """What is in the output folder."""

    def __init__(self, folder):
        expected = "the output folder of crawler optimize"
        self.folder = folder
        rows = read_rows(existing(folder / "results.csv", expected))
        summary = read_summary(folder, expected)
        parameters = Parameters(existing(folder / "parameters.prm", expected))
        if "optimize" not in summary or (rows and "violation" not in rows[0]):
            raise Problem(f"{folder} has no optimisation; {expected} is expected")
        self.optima = summary["optimize"]["optima"]
        self.objective = summary["optimize"]["objective"]
        self.sign = -1 if parameters.values.get("Optimize/Direction") == "backward" else 1
        # Of (limit of work, start): (evaluation, objective), and the number of evaluations.
        self.starts, self.excessive, self.lengths = (collections.defaultdict(kind) for kind in (list, list, int))
        for row in rows:
            key = number(row["work_limit"]) if row["work_limit"] else None, int(float(row["start"]))
            value, evaluation = number(row["objective"]), 1 + int(float(row["evaluation"]))
            self.lengths[key] = max(self.lengths[key], evaluation)
            if math.isfinite(value):
                keeps = number(row["violation"]) <= ADMISSIBLE
                (self.starts if keeps else self.excessive)[key].append((evaluation, value))
        if not self.starts or not self.optima:
            raise Problem(f"{folder / 'results.csv'} has no gait that keeps to all limits; there is nothing to draw")

    def quality(self, value):
        """The larger, the better. Of costs those in the wrong direction are worst."""
        if self.objective == "cost of transport":
            return self.sign / value if value else -math.inf
        return self.sign * value

    def limits(self):
        """Those of the work, in their order."""
        return [one["work_limit"] for one in self.optima]

    def gait(self, options):
        """Kymograph of the chosen optimum."""
        name = f"best-{options.optimum}" if len(self.optima) > 1 else "best"
        gait = Kymograph(self.folder / name, "stretch", "active_stress")
        gait.keep(options.begin, options.end, options.last_stride)
        return gait


def draw_progress(axes, optimisation):
    """Dots and the best so far."""
    limits = optimisation.limits()
    several, names = len(limits) > 1, 0
    values = []  # of the lines
    for points in optimisation.excessive.values():
        axes.plot(*zip(*points), ".", color="0.75", markersize=2.5, markeredgewidth=0, zorder=1, rasterized=True)
    for key, points in sorted(optimisation.starts.items(), key=lambda item: (item[0][0] or 0, item[0][1])):
        limit, start = key
        which = limits.index(limit) if several and limit in limits else start
        colour = COLOURS[which % len(COLOURS)]
        line = []
        for evaluation, value in points:
            is_better = not line or optimisation.quality(value) > optimisation.quality(line[-1][1])
            line.append((evaluation, value if is_better else line[-1][1]))
        line.append((optimisation.lengths[key], line[-1][1]))
        values += [line[0][1], line[-1][1]]
        is_first = not several or start == min(own for of, own in optimisation.starts if of == limit)
        is_named = is_first and len(optimisation.starts) > 1 and names < MOST_NAMES
        names += is_named
        name = f"work up to {limit:.3g}" if several else f"start {start}"
        axes.plot(*zip(*points), ".", color=colour, markersize=5, alpha=0.6, markeredgewidth=0, zorder=3,
                  rasterized=True)
        axes.plot(*zip(*line), drawstyle="steps-post", color=colour, linewidth=1.2, zorder=2,
                  label=name if is_named else None)
    for one in optimisation.optima:
        which = limits.index(one["work_limit"]) if several else one["start"]
        last = optimisation.lengths[one["work_limit"], one["start"]]
        if last and one["objective"] is not None:
            axes.plot(last, one["objective"], marker="*", markersize=11, color=COLOURS[which % len(COLOURS)],
                      markeredgecolor="black", markeredgewidth=0.6, linestyle="none", clip_on=False, zorder=5)
    # Dots far off the lines would hide how these rise.
    low, high = min(values), max(values)
    margin = 0.1 * (high - low) or 0.1 * abs(high) or 1
    axes.set(xscale="log", xlim=(0.9, 1.3 * max(10, *optimisation.lengths.values())),
             ylim=(low - margin, high + margin))
    axes.set(title="evaluations (grey: beyond a limit), best so far", xlabel="number of the evaluation in its start",
             ylabel=f"{OBJECTIVES.get(optimisation.objective, optimisation.objective)} "
                    f"[{UNITS.get(optimisation.objective, '1')}]")
    axes.grid(color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    if names:
        hidden = len(limits if several else optimisation.starts) - names
        axes.legend(frameon=True, framealpha=0.8, edgecolor="none", fontsize=8,
                    title=f"and {hidden} more" if hidden > 0 else None, title_fontsize=8)


def draw_gait(figure, panels, gait, title):
    """Strain and active stress."""
    for axes, name in zip(panels, ("strain", "active_stress")):
        mesh = draw_field(axes, gait, name)
        axes.set_title(f"{axes.get_title()} {title}")
        figure.colorbar(mesh, ax=axes, location="bottom", aspect=30, label=NAMES[name], ticks=MaxNLocator(5))


def draw_tradeoff(axes, optima, shown):
    """Displacement against work, and the bound."""
    known = [(i, one) for i, one in enumerate(optima) if one.get("displacement") and (one.get("stress_power") or 0) > 0]
    if not known:
        raise Problem("no best gait has a displacement and a positive work, so there is no trade-off to draw; "
                      "gaits that move, and Output/Ledger = true, are expected")
    points = sorted((one["stress_power"], abs(one["displacement"])) for _, one in known)
    bounds = sorted((one["stress_power"], abs(one["displacement"] / one["efficiency"]))
                    for _, one in known if one.get("efficiency"))
    if bounds:
        axes.plot(*zip(*bounds), "--_", color="0.35", linewidth=1, markersize=9,
                  label="no gait with this work\nand these strains\ngoes further")
    axes.plot(*zip(*points), color="black", linewidth=0.9, zorder=2)
    for i, one in known:
        axes.plot(one["stress_power"], abs(one["displacement"]), marker="*" if one["is_admissible"] else "x", zorder=3,
                  color=COLOURS[i % len(COLOURS)], markersize=12, linestyle="none",
                  markeredgecolor="black" if one["is_admissible"] else None, markeredgewidth=0.6,
                  label="shown on the left" if i == shown - 1 else None if one["is_admissible"] else "exceeds a limit")
    axes.set(title="best gaits", xlabel=NAMES["work"], ylabel="distance $|D|$ [length]", xscale="log", yscale="log")
    for direction in axes.xaxis, axes.yaxis:
        low, high = direction.get_view_interval()
        direction.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 1000 * low else (1,)))
        direction.set_major_formatter("{x:g}")
        direction.set_minor_formatter(NullFormatter())
    axes.grid(color="0.9", linewidth=0.6, which="both")
    axes.set_axisbelow(True)
    axes.legend(frameon=False, fontsize=8)


def draw(options):
    """Reads the files and makes the figure."""
    optimisation = Optimisation(options.folder)
    n_optima = len(optimisation.optima)
    options.optimum = n_optima if options.optimum is None else options.optimum
    if not 1 <= options.optimum <= n_optima:
        raise Problem(f"found --optimum {options.optimum}, but a number from 1 to {n_optima} is expected")
    gait = optimisation.gait(options)
    several = n_optima > 1
    figure, panels = plt.subplots(1, 4 if several else 3, figsize=(14.2 if several else 11.2, 4.2), layout="constrained",
                                  width_ratios=(1.45, 1, 1, 1.25) if several else (1.45, 1, 1))
    draw_progress(panels[0], optimisation)
    limit = optimisation.limits()[options.optimum - 1]
    draw_gait(figure, panels[1:3], gait, f"(work {limit:.3g})" if several else "of the best")
    if several:
        draw_tradeoff(panels[3], optimisation.optima, options.optimum)
    return figure


def main():
    """Command line."""
    own = parser(__doc__, "optimize.png", time=True)
    own.add_argument("--optimum", type=int, metavar="N",
                     help="with several limits of work: the one whose gait is drawn, from 1 (default: the last)")
    options = own.parse_args()
    try:
        figure = draw(options)
    except KeyError as missing:
        raise Problem(f"{options.folder} has no {missing}; the output folder of crawler optimize is expected") from None
    save(figure, options.output or options.folder / "optimize.png", dpi=100, few_colours=True)


if __name__ == "__main__":
    run_script(main)
