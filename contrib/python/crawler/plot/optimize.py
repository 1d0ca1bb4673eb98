#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws an optimisation of crawler: how the gaits became better, the best gait, and the best ones of all cases.

    contrib/python/crawler/plot/optimize.py OUTPUT_FOLDER [--optimum N] [--last-stride | --from TIME --to TIME] [--output PICTURE]

The picture is optimize.png in the folder, unless --output names another one. Its panels:
- the objective of all evaluations, as dots, grey beyond a limit, and the best so far of each start as a line. With
  several cases (section Sweep) a colour is a case, otherwise a start; stars are the results;
- strain and active stress of the best gait over s and t; with several cases of case N, without --optimum of the last;
- with several cases the objective of the best gaits over what varies (over their work if that is its limit), and the
  bound that no gait with the same work and extreme strains exceeds (doc/theory.md, "Gait efficiency").

Reads results.csv, summary.json, parameters.prm and best/kymograph.vts (best-N/kymograph.vts) of the folder; needs numpy
and matplotlib.
"""
import collections
import math

from plotting import (COLOURS, NAMES, Kymograph, InputError, draw_field, existing, need, number, parameters, parser,
                      picture_of, read_rows, read_summary, run_script, save)

need("numpy", "matplotlib")
import matplotlib.pyplot as plt
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

UNITS = {"displacement": "length", "speed": "length/time", "cost of transport": "force", "merit": "1",
         "periodic merit": "1"}
OBJECTIVES = {"displacement": "displacement $D$", "speed": "speed $U$"}  # with their symbols
ADMISSIBLE = 1e-5               # admissible violation of a limit, relative to it, unless Tolerance is larger
MOST_NAMES, LONGEST = 7, 32     # names, and characters of a name, in a legend


def short(value):
    """Short text of a value."""
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def varied(optima):
    """Entries in which the cases differ, except variables."""
    return [name for name in optima[0]["case"] if name not in optima[0]["variables"]
            and any(one["case"][name] != optima[0]["case"][name] for one in optima)]


def in_words(one, names):
    """Values of these entries in a case."""
    return ", ".join(f"{name.rsplit('/', 1)[-1]} {short(one['case'][name])}" for name in names)


class Optimisation:
    """Content of the output folder."""

    def __init__(self, folder):
        expected = "the output folder of crawler optimize"
        self.folder = folder
        rows = read_rows(existing(folder / "results.csv", expected))
        summary = read_summary(folder, expected)
        entries = parameters(existing(folder / "parameters.prm", expected))
        if "optimize" not in summary or (rows and "violation" not in rows[0]):
            raise InputError(f"{folder} has no optimisation; {expected} is expected")
        self.optima = summary["optimize"]["optima"]
        self.objective = summary["optimize"]["objective"]
        self.direction = entries.get("Optimize/Direction")
        admissible = max(ADMISSIBLE, number(entries["Optimize/Tolerance"]))
        # Pairs (evaluation, objective) by (case, start), and the number of evaluations.
        self.starts, self.excessive, self.lengths = (collections.defaultdict(kind) for kind in (list, list, int))
        for row in rows:
            key = int(float(row["case"])), int(float(row["start"]))
            value, evaluation = number(row["objective"]), 1 + int(float(row["evaluation"]))
            self.lengths[key] = max(self.lengths[key], evaluation)
            if math.isfinite(value):
                keeps = number(row["violation"]) <= admissible
                (self.starts if keeps else self.excessive)[key].append((evaluation, value))
        if not self.starts or not self.optima:
            raise InputError(f"{folder / 'results.csv'} has no gait within all limits; there is nothing to draw")

    def quality(self, value, case):
        """Quality of an objective: the larger, the better. Costs in the wrong direction are worst."""
        own = next((one["case"] for one in self.optima if one["number"] == case), {})
        sign = -1 if own.get("Optimize/Direction", self.direction) == "backward" else 1
        if self.objective == "cost of transport":
            return sign / value if value else -math.inf
        return sign * value

    def cases(self):
        """Numbers of the cases that have a gait."""
        return [one["number"] for one in self.optima]

    def words(self, case):
        """Description of a case: the entries that differ between the cases and are no variables."""
        own = next((one for one in self.optima if one["number"] == case), None)
        if own is None:
            return f"case {case}"
        differing = [name for name in varied(self.optima) if name not in own["variables"]]
        text = in_words(own, differing)
        if len(text) > LONGEST:
            text = f"case {case}: " + ", ".join(short(own["case"][name]) for name in differing)
        return text if len(text) <= LONGEST else text[:LONGEST - 3].rstrip(" ,") + "..."

    def gait(self, options):
        """Kymograph of the chosen optimum."""
        name = f"best-{options.optimum}" if self.optima[0]["case"] else "best"
        gait = Kymograph(self.folder / name, "stretch", "active_stress")
        gait.keep(options.begin, options.end, options.last_stride)
        return gait


def draw_progress(axes, optimisation):
    """Draws the evaluations as dots, and the best so far."""
    cases = optimisation.cases()
    several, names = len(cases) > 1, 0
    values = []  # values of the lines
    for points in optimisation.excessive.values():
        axes.plot(*zip(*points), ".", color="0.75", markersize=2.5, markeredgewidth=0, zorder=1, rasterized=True)
    for key, points in sorted(optimisation.starts.items()):
        case, start = key
        which = cases.index(case) if several and case in cases else start
        colour = COLOURS[which % len(COLOURS)]
        line = []
        for evaluation, value in points:
            is_better = not line or optimisation.quality(value, case) > optimisation.quality(line[-1][1], case)
            line.append((evaluation, value if is_better else line[-1][1]))
        line.append((optimisation.lengths[key], line[-1][1]))
        values += [line[0][1], line[-1][1]]
        is_first = not several or start == min(own for of, own in optimisation.starts if of == case)
        is_named = is_first and len(optimisation.starts) > 1 and names < MOST_NAMES
        names += is_named
        name = optimisation.words(case) if several else f"start {start}"
        axes.plot(*zip(*points), ".", color=colour, markersize=5, alpha=0.6, markeredgewidth=0, zorder=3,
                  rasterized=True)
        axes.plot(*zip(*line), drawstyle="steps-post", color=colour, linewidth=1.2, zorder=2,
                  label=name if is_named else None)
    for one in optimisation.optima:
        which = cases.index(one["number"]) if several else one["start"]
        last = optimisation.lengths[one["number"], one["start"]]
        values.append(one["objective"] if one["objective"] is not None else values[0])
        if last and one["objective"] is not None:
            axes.plot(last, one["objective"], marker="*", markersize=11, color=COLOURS[which % len(COLOURS)],
                      markeredgecolor="black", markeredgewidth=0.6, linestyle="none", clip_on=False, zorder=5)
    # Dots far off the lines would hide their rise.
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
        hidden = len(cases if several else optimisation.starts) - names
        axes.legend(frameon=True, framealpha=0.8, edgecolor="none", fontsize=8,
                    title=f"and {hidden} more" if hidden > 0 else None, title_fontsize=8)


def draw_gait(figure, panels, gait, title):
    """Draws strain and active stress."""
    for axes, name in zip(panels, ("strain", "active_stress")):
        mesh = draw_field(axes, gait, name)
        axes.set_title(f"{axes.get_title()} {title}")
        figure.colorbar(mesh, ax=axes, location="bottom", aspect=30, label=NAMES[name], ticks=MaxNLocator(5))


def axis_of_cases(optima):
    """Axis over which the cases are drawn: name, values, True if logarithmic, and the curve to which each belongs (no
    name: there are none). The axis is the number with most values, if each case has its own, or if all combinations of
    these and of the other varied entries exist."""
    names = varied(optima)

    def values_of(name):
        values = [one["case"][name] for one in optima]
        return values if all(isinstance(value, (int, float)) for value in values) else []

    name = max(names, key=lambda one: len(set(values_of(one))), default="")
    values = values_of(name) if name else []
    is_own = len(set(values)) == len(optima)
    others = ["" if is_own else in_words(one, [other for other in names if other != name]) for one in optima]
    if len(set(values)) < 2 or len(set(zip(values, others))) < len(optima) or \
            len(set(values)) * len(set(others)) != len(optima):
        return "number of the case", [one["number"] for one in optima], False, None
    if name == "Optimize/Work":
        return NAMES["work"], [one["stress_power"] for one in optima], True, others
    return name.rsplit("/", 1)[-1], values, min(values) > 0 and max(values) >= 4 * min(values), others


def draw_cases(axes, optimisation, shown):
    """Draws the best gaits, the bound, and which part of it they reach."""
    optima = optimisation.optima
    name, places, is_logarithmic, curves = axis_of_cases(optima)
    known = [(x, i, one) for i, (x, one) in enumerate(zip(places, optima)) if x is not None and one.get("objective")]
    if not known:
        raise InputError("no best gait moves the body, so there is nothing to draw over the cases")
    key = "stride_efficiency" if optimisation.objective == "periodic merit" else "efficiency"
    has_bound = optimisation.objective in ("displacement", "merit")
    for which, curve in enumerate(sorted(set(curves or [""]))):
        own = sorted(((x, one) for x, i, one in known if curves is None or curves[i] == curve), key=lambda pair: pair[0])
        bounds = [(x, abs(one["objective"] / one[key])) for x, one in own if one.get(key)]
        if bounds and has_bound:
            axes.plot(*zip(*bounds), linestyle="--" if curves else "none", color="0.35", linewidth=1, marker="_",
                      markersize=9, label="no gait with its work\nand its strains\ngoes further" if which == 0 else None)
        if own and curves:
            axes.plot([x for x, _ in own], [abs(one["objective"]) for _, one in own], color="black", linewidth=0.9,
                      linestyle=("-", "-.", ":")[which % 3], zorder=2, label=curve or None)
    for x, i, one in known:
        axes.plot(x, abs(one["objective"]), marker="*" if one["is_admissible"] else "x", zorder=3,
                  color=COLOURS[i % len(COLOURS)], markersize=12, linestyle="none",
                  markeredgecolor="black" if one["is_admissible"] else None, markeredgewidth=0.6,
                  label="shown on the left" if one is shown else None if one["is_admissible"] else "exceeds a limit")
        if one.get(key):
            axes.annotate(f"{100 * one[key]:.0f} %", (x, abs(one["objective"])), (7, -9), textcoords="offset points",
                          fontsize=8, color="0.35")
    values = [abs(one["objective"]) for _, _, one in known]
    scales = ["log" if is_logarithmic else "linear", "log" if max(values) >= 8 * min(values) else "linear"]
    axes.set(title="best gaits (% of the bound)", xlabel=name, xscale=scales[0], yscale=scales[1],
             ylabel=f"size of the {optimisation.objective} [{UNITS.get(optimisation.objective, '1')}]")
    axes.margins(0.12)
    for direction, scale in zip((axes.xaxis, axes.yaxis), scales):
        if scale == "log":
            low, high = direction.get_view_interval()
            direction.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 1000 * low else (1,)))
            direction.set_major_formatter("{x:g}")
            direction.set_minor_formatter(NullFormatter())
        else:
            direction.set_major_locator(MaxNLocator(6, integer=all(float(x).is_integer() for x in places)
                                                    and direction is axes.xaxis))
    axes.grid(color="0.9", linewidth=0.6, which="both")
    axes.set_axisbelow(True)
    axes.legend(frameon=False, fontsize=8)


def draw(options):
    """Reads the files and makes the figure."""
    optimisation = Optimisation(options.folder)
    cases = optimisation.cases()
    options.optimum = cases[-1] if options.optimum is None else options.optimum
    if options.optimum not in cases:
        raise InputError(f"found --optimum {options.optimum}, but the number of a case is expected: "
                      f"{', '.join(map(str, cases))}")
    gait = optimisation.gait(options)
    several = len(cases) > 1
    figure, panels = plt.subplots(1, 4 if several else 3, figsize=(14.2 if several else 11.2, 4.2), layout="constrained",
                                  width_ratios=(1.45, 1, 1, 1.25) if several else (1.45, 1, 1))
    draw_progress(panels[0], optimisation)
    draw_gait(figure, panels[1:3], gait, f"(case {options.optimum})" if several else "of the best")
    if several:
        draw_cases(panels[3], optimisation, optimisation.optima[cases.index(options.optimum)])
    return figure


def main():
    """Command line."""
    own = parser(__doc__, "optimize.png", time=True)
    own.add_argument("--optimum", type=int, metavar="N",
                     help="with several cases: the one whose gait is drawn, from 1 (default: the last)")
    options = own.parse_args()
    try:
        figure = draw(options)
    except KeyError as missing:
        raise InputError(f"{options.folder} has no {missing}; the output folder of crawler optimize is expected") from None
    save(figure, picture_of(options, "optimize.png"), study=options.folder, dpi=100, few_colours=True)


if __name__ == "__main__":
    run_script(main)
