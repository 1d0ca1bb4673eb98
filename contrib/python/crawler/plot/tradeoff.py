#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws a tradeoff of crawler: the error of every setting over its processor time, and the Pareto fronts.

    contrib/python/crawler/plot/tradeoff.py OUTPUT_FOLDER [--output PICTURE]

Reads tradeoff.csv and summary.json of the folder and writes tradeoff.png and tradeoff.svg there (or PICTURE), and before
that, where they are missing, the recommendations: into summary.json and recommendations.prm. Needs numpy and matplotlib.
Colours are formulation, mesh and engine; integrators differ by their markers.
"""
import collections

from plotting import INK, InputError, need, parser, results, run_script, save

need("numpy", "matplotlib")
results()  # adds the folder of the package to the path
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, NullLocator

from crawler.tradeoff import complete, number, pareto_front, read_rows

# Colour of each way to compute. Names are (formulation, mesh, engine) of the table.
WAYS = {("position", "uniform", "fused"): ("position, fused engine", "#0072B2"),
        ("position", "uniform", "batch"): ("position, batch of 8, per body", "#009E73"),
        ("position", "uniform", "petsc"): ("position, PETSc", "#E69F00"),
        ("position", "adaptive", "petsc"): ("position, adaptive mesh, PETSc", "#CC79A7"),
        ("stretch", "uniform", "fused"): ("stretch, fused engine", "#D55E00")}
# Rungs of the model that need no mesh: name, colour, marker.
RUNGS = {"perturbation": ("perturbation, closed form", "#000000", "*"),
         "kinematic": ("kinematic, quadrature", "#7F7F7F", "X")}
MARKERS = ("o", "s", "^", "D", "v", "P", "<", ">")  # marker of each integrator


class Tradeoff:
    """Rows of tradeoff.csv, and the summary."""

    def __init__(self, folder):
        self.rows, self.summary = read_rows(folder), complete(folder)
        self.finished = [row for row in self.rows if row["status"] == "finished"]
        if not self.finished:
            raise InputError(f"{folder / 'tradeoff.csv'} has no setting that finished")
        self.integrators = list(dict.fromkeys(row["integrator"] for row in self.finished if row["integrator"]))

    def gaps(self):
        """Settings that did not finish, counted by their reason."""
        return collections.Counter(row["reason"].replace("_", " ") for row in self.rows if row["status"] not in ("finished", ""))

    def front(self, batch):
        """Times and errors on the Pareto front of single runs or batches, the cheapest first."""
        rows = [self.rows[i] for i in self.summary.get("pareto", [])]
        return sorted((number(row["seconds"]), number(row["shown error"])) for row in rows if (row["engine"] == "batch") == batch)


def envelope(points):
    """Points (time, error) that no other one dominates, the cheapest first."""
    return [points[i] for i in pareto_front(*zip(*points))]


def way_of(row):
    """Name and colour of the way that computed a row."""
    if row["model"] in RUNGS:
        return RUNGS[row["model"]][:2]
    name = (row["formulation"], row["mesh"], row["engine"])
    return WAYS.get(name, (", ".join(name), INK))


def draw_ways(axes, tradeoff):
    """Draws all settings as dots, and for each integrator of each way the best of them with a marker; returns the
    handles for the ways and for the integrators."""
    groups = collections.defaultdict(list)
    for row in tradeoff.finished:
        groups[way_of(row), row["integrator"]].append((number(row["seconds"]), number(row["shown error"])))
    order = [name for name, *_ in [*WAYS.values(), *RUNGS.values()]]
    rung_markers = {name: marker for name, _, marker in RUNGS.values()}
    ways = sorted({way for way, _ in groups}, key=lambda way: order.index(way[0]) if way[0] in order else len(order))
    for (way, integrator), points in groups.items():
        axes.plot(*zip(*points), ".", color=way[1], markersize=1.8, alpha=0.35, zorder=2, rasterized=True)
        marker = (MARKERS[tradeoff.integrators.index(integrator) % len(MARKERS)] if integrator
                  else rung_markers.get(way[0], "h"))
        axes.plot(*zip(*envelope(points)), marker=marker, color=way[1], linewidth=0.6, markersize=4.2 if integrator else 8,
                  markeredgecolor="white", markeredgewidth=0.4, zorder=4)
    handles = [Line2D([], [], color=colour, linewidth=3, label=name) if name not in rung_markers else
               Line2D([], [], color=colour, linestyle="none", marker=rung_markers[name], markersize=7, label=name)
               for name, colour in ways]
    return handles, [Line2D([], [], color="0.35", linestyle="none", marker=MARKERS[i % len(MARKERS)], markersize=5, label=name)
                     for i, name in enumerate(tradeoff.integrators)]


def draw_fronts(axes, tradeoff):
    """Draws the fronts as steps: the error for a budget of time. Returns the handles of the legend."""
    handles = []
    for batch, style, name in ((False, "-", "Pareto front of single runs"), (True, (0, (4, 2)), "... of batches")):
        points = tradeoff.front(batch)
        if points:
            axes.plot(*zip(*points), drawstyle="steps-post", color="black", linewidth=1.3, linestyle=style, zorder=3)
            handles.append(Line2D([], [], color="black", linewidth=1.3, linestyle=style, label=name))
    return handles


def draw_bar(axes, tradeoff):
    """Draws the errors that cannot be told from 0."""
    bar = (tradeoff.summary.get("reference") or {}).get("relative_bar")
    if not bar:
        return []
    low = min(bar / 3, min(number(row["shown error"]) for row in tradeoff.finished) / 2)
    axes.axhspan(low, bar, facecolor="0.85", edgecolor="0.6", hatch="////", linewidth=0, zorder=1)
    axes.set_ylim(bottom=low)
    return [Patch(facecolor="0.85", edgecolor="0.6", hatch="////", linewidth=0.5, label=f"bar of the reference, {bar:.0e}")]


def draw(folder):
    """Reads the files and makes the figure."""
    tradeoff = Tradeoff(folder)
    figure = plt.figure(figsize=(7.5, 5.8), layout="constrained")
    axes, legend = figure.subplot_mosaic("p;l", height_ratios=(1, 0.21)).values()
    axes.set(xscale="log", yscale="log", xlabel="processor time of a run [s]",
             ylabel="relative error of the displacement $D$ [1]")
    ways, integrators = draw_ways(axes, tradeoff)
    handles = ways + draw_fronts(axes, tradeoff) + integrators + draw_bar(axes, tradeoff)
    axes.yaxis.set_major_locator(LogLocator(numticks=20))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.grid(True, which="major", color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    gaps = tradeoff.gaps()
    note = f"{len(tradeoff.finished)} settings" + (
        f"; gaps: {', '.join(f'{n} {reason}' for reason, n in gaps.most_common())}" if gaps else ", no gaps")
    if tradeoff.summary.get("status") == "stopped":
        note += " (stopped early)"
    axes.set_title(note)
    legend.axis("off")
    legend.legend(handles=handles, loc="center", ncols=3, fontsize=8, frameon=False, borderpad=0, borderaxespad=0)
    return figure


def main():
    """Command line."""
    options = parser(__doc__, "tradeoff.png, tradeoff.svg").parse_args()
    pictures = [options.output] if options.output else [options.folder / name for name in ("tradeoff.png", "tradeoff.svg")]
    save(draw(options.folder), *pictures, study=options.folder, dpi=200)


if __name__ == "__main__":
    run_script(main)
