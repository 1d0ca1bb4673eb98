#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws an optimisation of crawler: how the gaits became better, the best gait, and the best ones of all cases.

    contrib/plot/optimize.py OUTPUT_FOLDER [--optimum N] [--output picture.png]

The picture is optimize.png in the folder, unless --output names another one. Its panels:
- the objective of all evaluations, as dots, grey beyond a limit, and the best so far of each start as a line. With
  several cases (section Sweep) a colour is a case, otherwise a start; stars are the results;
- strain and active stress of the best gait over s and t; with several cases of case N (--optimum; the last one);
- with several cases the objective of the best gaits over what varies (over their work if that is its limit), and the
  bound that no gait with the same work and extreme strains exceeds (doc/theory.md, "Gait efficiency").

Reads results.csv, summary.json, parameters.prm and best/kymograph.vts (best-N/kymograph.vts) of the folder; needs
matplotlib (Debian: python3-matplotlib). Colours are safe for colour-blind readers.
"""
import argparse
import collections
import csv
import json
import math
import pathlib
import re
import sys

from kymograph import Problem, read_kymograph

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
UNITS = {"displacement": "length", "speed": "length/time", "cost of transport": "force", "merit": "1"}
ADMISSIBLE = 1e-5  # violation of a limit, relative to it
MOST_NAMES = 7     # in a legend


def number(value):
    """What is not known is not a number."""
    return float(value) if value not in ("", None) else math.nan


def existing(path, what):
    """A file that must exist."""
    if not path.is_file():
        raise Problem(f"{path} does not exist; {what} is expected")
    return path


def read_summary(path):
    """As a dictionary."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise Problem(f"{path} is not a summary of crawler ({error})") from None


class Optimisation:
    """What is in the output folder."""

    def __init__(self, folder):
        expected = "the output folder of crawler optimize"
        self.folder = folder
        with open(existing(folder / "results.csv", expected), newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        summary = read_summary(existing(folder / "summary.json", expected))
        text = existing(folder / "parameters.prm", expected).read_text(encoding="utf-8")
        if "optimize" not in summary or (rows and "violation" not in rows[0]):
            raise Problem(f"{folder} has no optimisation; {expected} is expected")
        self.optima = summary["optimize"]["optima"]
        self.objective = summary["optimize"]["objective"]
        direction = re.search(r"^subsection Optimize\n(?:.*\n)*?\s+set Direction\s*=\s*(\w+)", text, re.MULTILINE)
        self.sign = -1 if direction and direction[1] == "backward" else 1
        # Of (case, start): (evaluation, objective), and the number of evaluations.
        self.starts, self.excessive, self.lengths = (collections.defaultdict(kind) for kind in (list, list, int))
        for row in rows:
            key = int(float(row["case"])), int(float(row["start"]))
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

    def cases(self):
        """Their numbers, in order, of those that have a gait."""
        return [one["number"] for one in self.optima]

    def words(self, optimum):
        """What distinguishes the case: the values of the axes."""
        values = (f"{value:.4g}" if isinstance(value, float) else str(value) for value in optimum["case"].values())
        names = (name.rsplit("/", 1)[-1] for name in optimum["case"])
        return ", ".join(f"{name} {value}" for name, value in zip(names, values))

    def gait(self, optimum):
        """Kymograph of an optimum: s/L, t/T, strain, active stress."""
        name = f"best-{optimum['number']}" if optimum["case"] else "best"
        path = existing(self.folder / name / "kymograph.vts", "a run with Output/Kymograph = true and snapshots")
        s, t, stretch, stress = read_kymograph(path, ("stretch", "active_stress"))
        return s, t, [[value - 1 for value in row] for row in stretch], stress


def draw_progress(axes, optimisation):
    """Dots and the best so far."""
    cases = optimisation.cases()
    several, names = len(cases) > 1, 0
    values = []  # of the lines
    for points in optimisation.excessive.values():
        axes.plot(*zip(*points), ".", color="0.75", markersize=2.5, markeredgewidth=0, zorder=1, rasterized=True)
    for key, points in sorted(optimisation.starts.items()):
        case, start = key
        which = cases.index(case) if several and case in cases else start
        colour = COLOURS[which % len(COLOURS)]
        line = []
        for evaluation, value in points:
            is_better = not line or optimisation.quality(value) > optimisation.quality(line[-1][1])
            line.append((evaluation, value if is_better else line[-1][1]))
        line.append((optimisation.lengths[key], line[-1][1]))
        values += [line[0][1], line[-1][1]]
        is_first = not several or start == min(own for of, own in optimisation.starts if of == case)
        is_named = is_first and len(optimisation.starts) > 1 and names < MOST_NAMES
        names += is_named
        name = f"start {start}"
        if several:
            name = next((optimisation.words(one) for one in optimisation.optima if one["number"] == case), f"case {case}")
        axes.plot(*zip(*points), ".", color=colour, markersize=5, alpha=0.6, markeredgewidth=0, zorder=3,
                  rasterized=True)
        axes.plot(*zip(*line), drawstyle="steps-post", color=colour, linewidth=1.2, zorder=2,
                  label=name if is_named else None)
    for one in optimisation.optima:
        which = cases.index(one["number"]) if several else one["start"]
        last = optimisation.lengths[one["number"], one["start"]]
        if last and one["objective"] is not None:
            axes.plot(last, one["objective"], marker="*", markersize=11, color=COLOURS[which % len(COLOURS)],
                      markeredgecolor="black", markeredgewidth=0.6, linestyle="none", clip_on=False, zorder=5)
    # Dots far off the lines would hide how these rise.
    low, high = min(values), max(values)
    margin = 0.1 * (high - low) or 0.1 * abs(high) or 1
    axes.set(xscale="log", xlim=(0.9, 1.3 * max(10, *optimisation.lengths.values())),
             ylim=(low - margin, high + margin))
    axes.set(title="evaluations (grey: beyond a limit), best so far", xlabel="number of the evaluation in its start",
             ylabel=f"{optimisation.objective} [{UNITS.get(optimisation.objective, '1')}]")
    axes.grid(color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    if names:
        hidden = len(cases if several else optimisation.starts) - names
        axes.legend(frameon=True, framealpha=0.8, edgecolor="none", fontsize=8,
                    title=f"and {hidden} more" if hidden > 0 else None, title_fontsize=8)


def draw_gait(figure, panels, gait, title):
    """Strain and active stress."""
    from matplotlib.ticker import MaxNLocator

    s, t, *fields = gait
    for axes, field, name in zip(panels, fields, ("strain [1]", "active stress [force]")):
        largest = max(max(map(abs, row)) for row in field) or 1
        mesh = axes.pcolormesh(s, t, field, cmap="PuOr_r", shading="gouraud", vmin=-largest, vmax=largest,
                               rasterized=True)
        axes.set(title=f"{name.split(' [')[0]} {title}", xlabel="$s/L$", ylabel="$t/T$")
        figure.colorbar(mesh, ax=axes, location="bottom", aspect=30, label=name, ticks=MaxNLocator(5))


def axis_of_cases(optima):
    """What the cases are drawn over: name, values, whether logarithmic; the first number that differs, else numbers."""
    for name in optima[0]["case"]:
        values = [one["case"][name] for one in optima]
        if name == "Optimize/Work":
            return "work [force length]", [one["stress_power"] for one in optima], True
        if all(isinstance(value, (int, float)) for value in values) and len(set(values)) > 1:
            return name.rsplit("/", 1)[-1], values, min(values) > 0 and max(values) >= 8 * min(values)
    return "number of the case", [one["number"] for one in optima], False


def draw_cases(axes, optimisation, shown):
    """The best gaits, and the bound."""
    from matplotlib.ticker import LogLocator, NullFormatter

    optima = optimisation.optima
    name, places, is_logarithmic = axis_of_cases(optima)
    known = [(x, i, one) for i, (x, one) in enumerate(zip(places, optima)) if x is not None and one.get("objective")]
    if not known:
        raise Problem("no best gait moves the body, so there is nothing to draw over the cases")
    if optimisation.objective in ("displacement", "merit"):
        bounds = sorted((x, abs(one["objective"] / one["efficiency"])) for x, _, one in known if one.get("efficiency"))
        axes.plot(*zip(*bounds), "--" if len(set(places)) == len(places) else "", color="0.35", linewidth=1, marker="_",
                  markersize=9, label="no gait with its work\nand its strains\ngoes further") if bounds else None
    if len(set(places)) == len(places):
        axes.plot(*zip(*sorted((x, abs(one["objective"])) for x, _, one in known)), color="black", linewidth=0.9,
                  zorder=2)
    for x, i, one in known:
        axes.plot(x, abs(one["objective"]), marker="*" if one["is_admissible"] else "x", zorder=3,
                  color=COLOURS[i % len(COLOURS)], markersize=12, linestyle="none",
                  markeredgecolor="black" if one["is_admissible"] else None, markeredgewidth=0.6,
                  label="shown on the left" if one is shown else None if one["is_admissible"] else "exceeds a limit")
    values = [abs(one["objective"]) for _, _, one in known]
    scales = ["log" if is_logarithmic else "linear", "log" if max(values) >= 8 * min(values) else "linear"]
    axes.set(title="best gaits", xlabel=name, xscale=scales[0], yscale=scales[1],
             ylabel=f"size of the {optimisation.objective} [{UNITS.get(optimisation.objective, '1')}]")
    for direction, scale in zip((axes.xaxis, axes.yaxis), scales):
        if scale == "log":
            low, high = direction.get_view_interval()
            direction.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 1000 * low else (1,)))
            direction.set_major_formatter("{x:g}")
            direction.set_minor_formatter(NullFormatter())
    axes.grid(color="0.9", linewidth=0.6, which="both")
    axes.set_axisbelow(True)
    axes.legend(frameon=False, fontsize=8)


def draw(folder, picture, optimum):
    """Reads the files and writes the picture."""
    try:
        import matplotlib
    except ImportError:
        raise Problem("matplotlib is missing; install it (Debian: apt install python3-matplotlib)") from None
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    optimisation = Optimisation(folder)
    numbers = optimisation.cases()
    number = numbers[-1] if optimum is None else optimum
    if number not in numbers:
        raise Problem(f"found --optimum {number}, but the number of a case is expected: {', '.join(map(str, numbers))}")
    shown = optimisation.optima[numbers.index(number)]
    gait = optimisation.gait(shown)
    several = len(numbers) > 1

    plt.rcParams.update({"font.size": 10, "axes.titlesize": 10, "axes.labelsize": 10, "xtick.labelsize": 9,
                         "ytick.labelsize": 9, "axes.linewidth": 0.7})
    figure, panels = plt.subplots(1, 4 if several else 3, figsize=(13.5 if several else 10.5, 4), layout="constrained",
                                  width_ratios=(1.45, 1, 1, 1.25) if several else (1.45, 1, 1))
    draw_progress(panels[0], optimisation)
    draw_gait(figure, panels[1:3], gait, f"(case {number})" if several else "of the best")
    if several:
        draw_cases(panels[3], optimisation, shown)
    try:
        figure.savefig(picture, dpi=100)
        if picture.suffix == ".png":  # 256 colours: less than half the size
            from PIL import Image  # comes with matplotlib
            Image.open(picture).convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE, kmeans=1,
                                                         dither=Image.Dither.NONE).save(picture, optimize=True)
    except (OSError, ValueError) as error:
        raise Problem(f"cannot write {picture}: {error}") from None


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path, help="output folder of crawler optimize")
    parser.add_argument("--optimum", type=int, metavar="N",
                        help="with several cases: the one whose gait is drawn, from 1 (default: the last)")
    parser.add_argument("--output", type=pathlib.Path,
                        help="the picture (.png, .pdf, .svg); optimize.png in the folder if it is not given")
    options = parser.parse_args()
    picture = options.output or options.folder / "optimize.png"
    try:
        if not options.folder.is_dir():
            raise Problem(f"{options.folder} is not a folder; the output folder of crawler optimize is expected")
        draw(options.folder, picture, options.optimum)
    except (Problem, OSError, ValueError, KeyError) as problem:
        sys.exit(f"optimize.py: {problem}")
    print(f"wrote {picture}")


if __name__ == "__main__":
    main()
