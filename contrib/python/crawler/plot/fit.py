#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws the output folder of crawler fit: the data and the run that fits best, the residuals, and the variables; of a comparison
of scenes, which of them the data prefer, and how far each is from the data over time.

    contrib/python/crawler/plot/fit.py OUTPUT_FOLDER [--output PICTURE]

Left dots are data and lines the run (of many places some); in the middle the residuals over place and time, or over time; right
each variable in its range: its value, thick its interval of 68 %, thin that of 95 %. The picture is fit.png (comparison.png) in the
folder, unless --output names another one. Needs numpy and matplotlib.
"""
from plotting import (COLOURS, INK, LINES, NAMES, InputError, colour_limits, existing, need, number, parser, read_rows, read_summary,
                      run_script, save)

need("numpy", "matplotlib")
import matplotlib.pyplot as plt
import numpy as np

MOST_LINES = 7
LABELS = {"markers": "place $x$ of markers [length]", "strain": NAMES["strain"], "centre": "centre of mass $x$ [length]",
          "speed": "speed [length/time]"}


def draw_data(axes, t, place, data, model, kind):
    """Draws data as dots, the run as lines."""
    places = np.unique(place)
    for k, at in enumerate(places[np.unique(np.linspace(0, len(places) - 1, MOST_LINES).round().astype(int))]):
        here = place == at
        colour = COLOURS[k % len(COLOURS)]
        axes.plot(t[here], data[here], ".", color=colour, markersize=4, alpha=0.6, markeredgewidth=0)
        axes.plot(t[here], model[here], color=colour, linewidth=1)
        if len(places) > 1:
            axes.annotate(f"$s$ = {at:.3g}", (t[here][-1], model[here][-1]), xytext=(4, 0), textcoords="offset points", fontsize=8,
                          va="center", color=colour)
    axes.set(xlabel=NAMES["t"], ylabel=LABELS[kind], title="dots: data, lines: the best run")
    axes.set_xlim(right=t[-1] + 0.2 * (t[-1] - t[0]))


def draw_residuals(axes, t, place, residuals):
    """Draws the residuals over place and time."""
    places, times = np.unique(place), np.unique(t)
    axes.set_title("residuals: data less run")
    if len(places) == 1:
        axes.axhline(0, color=INK, linewidth=0.6)
        axes.plot(t, residuals, ".", color=COLOURS[0], markersize=3)
        axes.set(xlabel=NAMES["t"], ylabel="residual")
        return
    grid = np.full((len(times), len(places)), np.nan)
    grid[np.searchsorted(times, t), np.searchsorted(places, place)] = residuals
    axes.set_facecolor("0.75")
    mesh = axes.pcolormesh(places, times, np.ma.masked_invalid(grid), shading="nearest", rasterized=True,
                           **colour_limits(residuals, "displacement"))
    axes.set(xlabel=NAMES["s"], ylabel=NAMES["t"])
    axes.figure.colorbar(mesh, ax=axes, label="residual")


def draw_variables(axes, variables):
    """Draws each variable in its range."""
    for row, (name, one) in enumerate(reversed(variables.items())):
        low, width = one["from"], one["to"] - one["from"]
        axes.plot([0, 1], [row, row], color="0.8", linewidth=6, solid_capstyle="butt")
        if one["determined"] is False:
            text = "not determined by the data"
        elif one["determined"] is None:
            text = f"{one['value']:.5g} so far"
        else:
            for level, thickness in (("interval_95", 1.5), ("interval_68", 4)):
                ends = [edge if end is None else (end - low) / width for end, edge in zip(one[level], (0, 1))]
                axes.plot(ends, [row, row], color=COLOURS[0], linewidth=thickness, solid_capstyle="butt")
            text = f"{one['value']:.5g}" + (" at the limit" if one["deviation"] is None else f" $\\pm$ {one['deviation']:.2g}")
        if one["value"] is not None:
            axes.plot((one["value"] - low) / width, row, "|", color=COLOURS[1], markersize=14, markeredgewidth=1.5)
        axes.text(0.5, row + 0.22, f"{name.split('/')[-1]}: {text}", ha="center", fontsize=9)
        axes.text(0, row - 0.32, f"{one['from']:g}", fontsize=8, ha="left", color="0.4")
        axes.text(1, row - 0.32, f"{one['to']:g}", fontsize=8, ha="right", color="0.4")
    axes.set(ylim=(-0.6, len(variables) - 0.3), xlim=(-0.02, 1.02), title="variables in their ranges")
    axes.axis("off")


def data_of(folder, *names):
    """Columns of residuals.csv: {kind of the data: columns}."""
    rows = read_rows(existing(folder / "residuals.csv", "the output folder of crawler fit"))
    kinds = dict.fromkeys(row["kind"] for row in rows)
    return {kind: [np.array([number(row[name]) for row in rows if row["kind"] == kind]) for name in names] for kind in kinds}


def comparison_of(folder, rows):
    """Draws on the left bars of the criteria of Akaike and Bayes, minus the least; on the right the residuals of each
    scene over time."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 2.6 + 0.5 * len(rows)), layout="constrained")
    for k, key in enumerate(("aic", "bic")):
        bars = left.barh(np.arange(len(rows)) + 0.36 * k - 0.18, [row[f"{key}_less_least"] for row in rows], 0.36, color=COLOURS[k], label=key.upper())
        left.bar_label(bars, [f"{row[f'{key}_less_least']:.4g}" for row in rows], fontsize=8, padding=2)
    left.axvline(10, color=INK, linewidth=0.8, linestyle=":")
    left.set_xscale("symlog", linthresh=10)
    left.set(xlim=(0, 5 * max(10, *(row[f"{key}_less_least"] for row in rows for key in ("aic", "bic")))), ylim=(len(rows) - 0.5, -0.5),
             yticks=range(len(rows)), yticklabels=[row["scene"] for row in rows], xlabel="criterion less the least (dotted: 10, strong evidence)",
             title="which scene the data prefer")
    left.legend(frameon=False)
    for k, row in enumerate(rows):
        series = read_summary(folder / row["folder"], "the output folder of crawler fit")["goodness"]["series"]
        units = {one["kind"]: one["deviation"] if len(series) > 1 else 1 for one in series}
        data = data_of(folder / row["folder"], "t", "residual")
        t, residuals = np.concatenate([one[0] for one in data.values()]), np.concatenate([one[1] / units[kind] for kind, one in data.items()])
        times, where = np.unique(t, return_inverse=True)
        right.plot(times, np.sqrt(np.bincount(where, residuals ** 2) / np.bincount(where)), LINES[k % len(LINES)], color=COLOURS[k % len(COLOURS)], label=row["scene"])
    right.set(xlabel=NAMES["t"], ylabel=f"residuals (root mean square{', in deviations' if len(series) > 1 else ''})", title="how far each is from the data", ylim=(0, None))
    right.legend(frameon=False)
    return figure


def main():
    """Command line."""
    options = parser(__doc__, "fit.png (of a comparison comparison.png)").parse_args()
    summary = read_summary(options.folder, "the output folder of crawler fit")
    if summary.get("comparison"):
        figure = comparison_of(options.folder, summary["comparison"])
        save(figure, options.output or options.folder / "comparison.png", dpi=110, few_colours=True)
        return
    if not summary.get("variables"):
        raise InputError(f"{options.folder} has no values to draw: {summary.get('message')}")
    found = data_of(options.folder, "t", "place", "data", "model", "residual")
    figure = plt.figure(figsize=(13, 1 + 3.2 * len(found)), layout="constrained")
    grid = figure.add_gridspec(len(found), 3)
    for row, (kind, (t, place, data, model, residuals)) in enumerate(found.items()):
        left, middle = (figure.add_subplot(grid[row, column]) for column in (0, 1))
        draw_data(left, t, np.nan_to_num(place), data, model, kind)
        draw_residuals(middle, t, np.nan_to_num(place), residuals)
    draw_variables(figure.add_subplot(grid[:, 2]), summary["variables"])
    save(figure, options.output or options.folder / "fit.png", dpi=110, few_colours=True)


if __name__ == "__main__":
    run_script(main)
