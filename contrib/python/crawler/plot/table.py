#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws what crawler table has made of measured samples: before and after.

    contrib/python/crawler/plot/table.py TABLE.csv [--output PICTURE]

TABLE.csv is the table that crawler table has written; TABLE_before.csv beside it has the samples. Left the samples (of
markers their tracks), with gaps in grey; in the middle the table; right some places over time: dots are samples, lines the
table. The picture is TABLE.png, unless --output names another one. Needs numpy and matplotlib.
"""
from plotting import COLOURS, DOTS, INK, NAMES, InputError, colour_limits, existing, need, parser, read_rows, run_script, save

need("numpy", "matplotlib")
import matplotlib.pyplot as plt
import numpy as np

KINDS = {"m": "active_stress", "strain": "strain"}


def grid(path, first):
    """Columns, and the values over t and s or marker; missing ones are NaN."""
    rows = read_rows(existing(path, "a table of crawler table"))
    names = list(rows[0]) if rows else []
    if len(names) != 3 or names[0] not in first or names[1] != "t":
        raise InputError(f"{path} is not a table of crawler table")
    try:
        columns = [np.array([float(row[name]) for row in rows]) for name in names]
    except (TypeError, ValueError):
        raise InputError(f"{path} has a row that is not three numbers; a table of crawler table is expected") from None
    (s, i), (t, j) = (np.unique(column, return_inverse=True) for column in columns[:2])
    values = np.full((len(t), len(s)), np.nan)
    values[j, i] = columns[2]
    return names, s, t, values


def draw_map(axes, s, t, values, name, limits):
    """Draws a field; missing values stay grey."""
    axes.set_facecolor("0.75")
    mesh = axes.pcolormesh(s, t, np.ma.masked_invalid(values), shading="nearest", rasterized=True, **limits)
    axes.set(xlabel=NAMES["s"], ylabel=NAMES["t"])
    axes.figure.colorbar(mesh, ax=axes, label=NAMES[name])


def draw(path):
    """Draws the three parts of the picture."""
    names, s, t, values = grid(path, ("s",))
    if names[2] not in KINDS:
        raise InputError(f'{path} has the column "{names[2]}", but m or strain is expected')
    name = KINDS[names[2]]
    before = path.with_name(path.stem + "_before.csv")
    raw_names, raw_s, raw_t, raw = grid(before, ("s", "marker"))
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12, 3.9), layout="constrained")
    limits = colour_limits(values, name)
    is_tracked = raw_names[0] == "marker"
    if is_tracked:
        left.plot(raw, raw_t, color=INK, linewidth=0.7)
        left.set(xlabel="place $x$ of the markers [length]", ylabel=NAMES["t"], title=f"before: tracks of {len(raw_s)} markers")
    else:
        draw_map(left, raw_s, raw_t, raw, name, limits)
        left.set_title(f"before: {np.isfinite(raw).sum()} samples, {np.isnan(raw).sum()} gaps")
    draw_map(middle, s, t, values, name, limits)
    middle.set_title(f"after: {len(s)} x {len(t)} samples, no gaps")
    period = t[-1] - t[0]
    for k, part in enumerate((0.1, 0.4, 0.7)):
        i = round(part * (len(s) - 1))
        label = f"$s$ = {s[i]:.3g}"
        if not is_tracked:
            nearest = abs(raw_s - s[i]).argmin()
            again = raw_t if raw_t[-1] <= t[-1] * (1 + 1e-9) else t[0] + (raw_t - t[0]) % period
            right.plot(again, raw[:, nearest], DOTS[k], color=COLOURS[k], markersize=2.5, alpha=0.5, markeredgewidth=0)
        right.plot(t, values[:, i], color=COLOURS[k], linewidth=1.3, label=label)
    right.set(xlabel=NAMES["t"], ylabel=NAMES[name], title="lines: table" if is_tracked else "dots: samples, lines: table")
    right.legend(fontsize=8, frameon=False, loc="lower left", bbox_to_anchor=(1, 0))
    return figure


def main():
    """Command line."""
    options = parser(__doc__, "TABLE.png").parse_args()
    save(draw(options.folder), options.output or options.folder.with_suffix(".png"), dpi=110, few_colours=True)


if __name__ == "__main__":
    run_script(main)
