#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws the table of crawler sweep: a heat map over two axes, lines over one, points for random designs.

With Sweep/Cross-check and two axes that is the map of outcomes, on which silent wrong answers are red.

    contrib/python/crawler/plot/sweep.py OUTPUT_FOLDER [--x AXIS] [--y AXIS | --lines] [--value COLUMN] [--where AXIS=VALUE ...]
                          [--scale auto|linear|log] [--fit] [--output PICTURE]

Reads results.h5 of the folder and writes results.png and results.svg there (or PICTURE). AXIS is an axis of the sweep,
as "Body/Length", or its last words. Without --x the last axis is x; without --y the one before it is y, the next two
make the columns and rows of small pictures. --lines: x alone, a line for each value of the next axis. --where keeps the
points with this value of an axis. COLUMN is any column of numbers (displacement), or status or outcome: what became of
the points.
--scale is that of the values; auto: logarithmic if they are positive and differ by more than a factor of 1000. Axes whose
values have equal ratios are logarithmic. --fit: the power law through the points of each line, in its label; lines that
change sign are drawn without. Values of points that did not finish are not drawn, but which and why. Needs numpy,
h5py and matplotlib.
"""
import difflib
import os
import pathlib
import re
import textwrap

from plotting import COLOURS, DOTS, LINES, SIGNED, SIZES, InputError, need, parser, run_script, save
from plotting import label as axis_label

os.environ.setdefault("HDF5_USE_FILE_LOCKING", "FALSE")  # keeps a sweep in progress readable
need("numpy", "h5py", "matplotlib")
import h5py
import matplotlib.pyplot as plt
import numpy as np
from matplotlib import colors, patches, ticker
from matplotlib.path import Path

# Styles of points without a value: grey, hatch, marker in line plots.
MARKS = (("0.88", "////", "x"), ("0.72", "....", "+"), ("0.80", "\\\\\\\\", "1"), ("0.60", "xxxx", "2"),
         ("0.94", "++", "3"), ("0.50", "oo", "4"))
STATUS_COLOURS = {"finished": "#FFFFFF", "inverted": "#E69F00", "failed": "#D55E00", "stopped": "#CC79A7",
                  "not": "0.75", "refused": "#56B4E9", "silent": "#D40000"}
WORDS = ("status", "outcome")  # columns with the outcome of the points
MOST_LINES, MOST_PANELS = 60, 4  # lines in a picture; small pictures in a row or column


class Sweep:
    """Table of a sweep; columns are read when they are needed. The points may be narrowed by where()."""

    def __init__(self, folder):
        path = folder / "results.h5"
        if not path.is_file():
            raise InputError(f'there is no "{path}"; the output folder of crawler sweep is expected')
        try:
            file = h5py.File(path, "r")
            self.group = file["results"]
            described = {as_text(data.attrs["name"]): data for data in self.group.values()}
            self.axes = [name for name, data in described.items()
                         if as_text(data.attrs["description"]) == "axis of the sweep"]
            self.units = {name: as_text(data.attrs["unit"]) for name, data in described.items()}
            settings = as_text(self.group.attrs["parameters.prm"])
        except (OSError, KeyError) as error:
            raise InputError(f'"{path}" is not a table of crawler sweep ({error})') from error
        self.data = described
        self.design = re.search(r"subsection Sweep\n(?:.*\n)*?\s+set Design\s*= (\w+)|$", settings)[1] or "grid"
        self.chosen = np.flatnonzero(np.isfinite(described["index"][()]))
        if len(self.chosen) == 0:
            raise InputError(f'"{path}" has no rows')
        self.axes.sort(key=settings[max(settings.find("set Axes"), 0):].find)  # in the order of the file

    def column(self, name):
        """Values of the chosen points; texts as bytes."""
        return self.data[name][()][self.chosen]

    def is_number(self, name):
        """Returns True if a column holds numbers."""
        return self.data[name].dtype.kind == "f"

    def varying(self):
        """Axes with more than one value among the chosen points."""
        return [axis for axis in self.axes if len(np.unique(self.column(axis))) > 1]

    def find(self, name, among, what):
        """Returns the only column whose name is, or ends with, this; a whole name before the end of another, also of
        texts."""
        whole = name if name in self.data else next((own for own in self.data if own.lower() == name.lower()), None)
        if whole in among:
            return whole
        kind = f"{'an' if what == 'axis' else 'a'} {what}"
        if whole and not self.is_number(whole):
            raise InputError(f'the column "{whole}" holds texts, which cannot be drawn; {kind} is expected')
        found = [column for column in among if column.lower().endswith(name.lower())]
        whole = [column for column in found if column.lower()[:-len(name)].endswith(("/", ".", "_"))]
        found = whole if len(whole) == 1 else found
        if len(found) == 1:
            return found[0]
        if found:
            listed = ", ".join(found[:8]) + (f" and {len(found) - 8} others" if len(found) > 8 else "")
            raise InputError(f'"{name}" is the end of several names: {listed}; more of the name that is meant is expected')
        if len(among) <= 8:
            raise InputError(f'"{name}" is not {kind}; one of {", ".join(among)} is expected')
        raise InputError(f'"{name}" is not {kind}; the nearest of {len(among)} names are {", ".join(nearest(name, among))}; '
                      'the first line of results.csv has all')

    def where(self, condition):
        """Keeps the points with AXIS=VALUE."""
        name, equals, text = condition.rpartition("=")
        if not equals:
            raise InputError(f'found --where "{condition}", but AXIS=VALUE is expected')
        axis = self.find(name.strip(), self.axes, "axis")
        values, text = self.column(axis), text.strip()
        if self.is_number(axis):
            try:
                number = float(text)
            except ValueError:
                raise InputError(f'--where "{condition}": found "{text}", but a number is expected') from None
            mine = np.isclose(values, number, rtol=1e-6, atol=0)
            known = sorted(np.unique(values), key=lambda value: abs(value - number))[:3]
            known = ", ".join(f"{value:.7g}" for value in sorted(known))
        else:
            mine = values == text.encode()
            known = ", ".join(dict.fromkeys(value.decode() for value in values[:10000]))
        if not mine.any():
            raise InputError(f'no point has {axis} = {text}; values {"near it " if self.is_number(axis) else ""}are {known}')
        self.chosen = self.chosen[mine]

    def label(self, name, unit=True):
        """Last words of a name, more if an axis has the same ones; with its symbol and unit."""
        parts = name.split("/")
        short = "/".join(parts[-1:])
        for n in range(1, len(parts) + 1):
            short = "/".join(parts[-n:])
            if sum(("/" + axis).endswith("/" + short) for axis in self.axes) < 2:
                break
        short = short.replace("_", " ").replace(".", ", ")
        return axis_label(name, self.units[name], short) if unit else short


class Marks:
    """Outcome of each chosen point that has no value to be drawn: an index into names, or -1."""

    def __init__(self, sweep, values, column):
        self.alone = column in WORDS
        status, reason = sweep.column(column if self.alone else "status"), sweep.column("reason")
        if column == "outcome":  # contains its reason
            reason = np.zeros_like(reason)
        finished = status == b"finished"
        known = np.isfinite(values)
        self.note = ""
        if not (known & finished).any() and known.any():  # e.g. inversion.t
            finished = known
            self.note = "values of points that did not finish"
        self.drawn = finished & known
        names = np.full(len(status), "", dtype=object)
        names[finished & ~known] = "finished, value not known"
        rest = ~finished
        for pair in set(zip(status[rest], reason[rest])):
            word, why = as_text(pair[0]), as_text(pair[1]).replace("_", " ")
            text = "not computed yet" if not word else f"{word} ({why})" if why and why not in word else word
            names[rest & (status == pair[0]) & (reason == pair[1])] = text
        self.names = [name for name in sorted(set(names)) if name]
        self.of = np.full(len(status), -1)
        for i, name in enumerate(self.names):
            self.of[names == name] = i
        self.counts = [np.count_nonzero(self.of == i) for i in range(len(self.names))]

    def face(self, i):
        """Colour of cells."""
        return STATUS_COLOURS.get(self.names[i].split(" ")[0].strip(":"), "white") if self.alone else MARKS[i % len(MARKS)][0]

    def hatch(self, i):
        """Hatch of cells."""
        return "" if self.alone and self.names[i].startswith("finished") else MARKS[i % len(MARKS)][1]

    def ink(self, i):
        """Colour of points."""
        return self.face(i) if self.alone and not self.names[i].startswith("finished") else "0.45"

    def marker(self, i):
        """Marker of points."""
        return "o" if self.alone and self.names[i].startswith("finished") else MARKS[i % len(MARKS)][2]

    def in_words(self):
        """Description for a message."""
        return ", ".join(f"{count} {name}" for count, name in zip(self.counts, self.names))


def as_text(value):
    """Converts a value to text; attributes and texts are bytes."""
    return value.decode(errors="replace") if isinstance(value, bytes) else str(value)


def nearest(name, among):
    """Returns the four names most similar to this one, as a whole or by their last words."""
    def likeness(column):
        ends = [column[match.end():] for match in re.finditer("^|[/._]", column)]
        return max(difflib.SequenceMatcher(None, name.lower(), end.lower()).ratio() for end in ends)
    return sorted(among, key=likeness, reverse=True)[:4]


def is_logarithmic(values):
    """Returns True if these positive numbers, in order, are spread more evenly by their ratios than by their
    differences."""
    if len(values) < 3 or values[0] <= 0 or values[-1] < 3 * values[0]:
        return False
    even = np.linspace(0, 1, len(values))
    logs = np.log(values)
    far = [np.abs((v - v[0]) / (v[-1] - v[0]) - even).max() for v in (logs, values)]
    return bool(far[0] < 0.5 * far[1])


class Axis:
    """Values of an axis and their places in a picture: numbers as they are, words one after the other."""

    def __init__(self, sweep, name):
        self.name, self.label, self.is_number = name, sweep.label(name), sweep.is_number(name)
        self.short = sweep.label(name, False)
        column = sweep.column(name)
        self.values, first, self.index = np.unique(column, return_index=True, return_inverse=True)
        if not self.is_number:  # words in the order of the file
            order = np.argsort(first)
            self.values, self.index = self.values[order], np.argsort(order)[self.index]
        self.log = self.is_number and is_logarithmic(self.values)
        self.at = self.values if self.is_number else np.arange(len(self.values), dtype=float)

    def texts(self):
        """Values as words, without common parts of paths."""
        if self.is_number:
            return [f"{value:.4g}" for value in self.values]
        texts = [as_text(value) for value in self.values]
        short = [pathlib.PurePath(text).name.removesuffix(".prm") for text in texts]
        return short if len(set(short)) == len(texts) and all(text.endswith(".prm") for text in texts) else texts

    def edges(self):
        """Edges of the cells around the values."""
        at = np.log(self.at) if self.log else self.at
        if len(at) == 1:
            half = 0.5 if self.log or at[0] == 0 else 0.1 * abs(at[0])
            edges = np.array([at[0] - half, at[0] + half])
        else:
            middle = 0.5 * (at[1:] + at[:-1])
            edges = np.concatenate(([1.5 * at[0] - 0.5 * at[1]], middle, [1.5 * at[-1] - 0.5 * at[-2]]))
        return np.exp(edges) if self.log else edges

    def draw(self, axes, which, long):
        """Draws scale, ticks and, if long, the label of the "x" or "y" axis of a picture."""
        direction = getattr(axes, which + "axis")
        if self.log:
            getattr(axes, f"set_{which}scale")("log")
            direction.set_minor_formatter(ticker.LogFormatterSciNotation(minor_thresholds=(1.5, 0.6)))
        if not self.is_number or len(self.values) <= 6:
            direction.set_ticks(self.at, self.texts())
            direction.set_ticks([], minor=True)
        if long:
            direction.set_label_text(self.label)


def norm_of(values, scale):
    """Returns colour map and norm."""
    low, high = values.min(), values.max()
    log = scale == "log" or (scale == "auto" and low > 0 and high > 1000 * low)
    if low < 0 < high:
        most = max(-low, high)
        near = max(np.quantile(np.abs(values[values != 0]), 0.1), 1e-12 * most)
        return SIGNED, colors.SymLogNorm(near, vmin=-most, vmax=most) if log else colors.CenteredNorm(halfrange=most)
    if log and low > 0 and high > low:
        return SIZES, colors.LogNorm(low, high)
    if log and high < 0 and high > low:
        return SIZES, colors.SymLogNorm(-high, vmin=low, vmax=high)
    margin = 0 if high > low else 0.01 * abs(high) or 1.
    return SIZES, colors.Normalize(low - margin, high + margin)


def hatch_cells(axes, x_edges, y_edges, mask, face, hatch):
    """Hatches the cells of the mask; cells side by side in a row at once."""
    vertices, codes = [], []
    for row in range(mask.shape[0]):
        steps = np.diff(np.concatenate(([0], mask[row].astype(int), [0])))
        for start, end in zip(np.flatnonzero(steps == 1), np.flatnonzero(steps == -1)):
            left, right, low, high = x_edges[start], x_edges[end], y_edges[row], y_edges[row + 1]
            vertices += [(left, low), (right, low), (right, high), (left, high), (left, low)]
            codes += [Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY]
    if vertices:
        axes.add_patch(patches.PathPatch(Path(vertices, codes), facecolor=face, edgecolor="0.35", hatch=hatch,
                                         linewidth=0, rasterized=len(codes) > 5000))


def heat_map(axes, x, y, mine, values, marks, look):
    """Draws every point as a cell; without a value in grey, with a hatch for the reason."""
    shape = (len(y.values), len(x.values))
    place = y.index[mine] * shape[1] + x.index[mine]
    if len(np.unique(place)) < len(place):
        raise InputError(f'several points have the same "{x.name}" and "{y.name}"; --where AXIS=VALUE chooses among them')
    grid, reasons = np.full(shape, np.nan), np.full(shape, -1)
    drawn = marks.drawn[mine]
    grid.flat[place[drawn]] = values[mine][drawn]
    reasons.flat[place] = marks.of[mine]
    x_edges, y_edges = x.edges(), y.edges()
    mesh = None
    if look is not None:
        mesh = axes.pcolormesh(x_edges, y_edges, grid, cmap=look[0], norm=look[1], rasterized=True)
        if isinstance(look[1], (colors.CenteredNorm, colors.SymLogNorm)) and min(shape) > 2 and look[0] == SIGNED:
            if np.nanmin(grid) < 0 < np.nanmax(grid):
                axes.contour(x.at, y.at, grid, [0.], colors="black", linewidths=1)
    for i in range(len(marks.names)):
        hatch_cells(axes, x_edges, y_edges, reasons == i, marks.face(i), marks.hatch(i))
    axes.set_xlim(x_edges[0], x_edges[-1])
    axes.set_ylim(y_edges[0], y_edges[-1])
    return mesh


def scatter(axes, x, y, mine, values, marks, look):
    """Draws every point as a dot; without a value as a grey mark for the reason."""
    drawn = mine & marks.drawn
    at = (x.at[x.index], y.at[y.index])
    size = float(np.clip(8000 / max(mine.sum(), 1), 1, 30))
    for i in range(len(marks.names)):
        some = mine & (marks.of == i)
        axes.scatter(at[0][some], at[1][some], s=size, c=marks.ink(i), marker=marks.marker(i), linewidths=0.8,
                     rasterized=True)
    if look is None:
        return None
    return axes.scatter(at[0][drawn], at[1][drawn], s=size, c=values[drawn], cmap=look[0], norm=look[1],
                        edgecolors="0.4", linewidths=0.3 if size > 4 else 0, rasterized=True)


def power_law(x, y):
    """Factor and exponent of y = factor * x^exponent; None unless two points or more have positive x and y of one
    sign."""
    if len(x) < 2 or x.min() <= 0 or x.min() == x.max() or not (y.min() > 0 or y.max() < 0):
        return None
    power, shift = np.polyfit(np.log(x), np.log(np.abs(y)), 1)
    return np.exp(shift) * np.sign(y[0]), power


def lines(axes, x, mine, values, errors, has_bars, marks, other, look, options, panel):
    """Draws a line for each value of the axis other (or one), with gaps where points have no value.

    Returns the power laws: the line (other and panel in words), the law or None, the smallest magnitude of its values.
    """
    laws = []
    keys = range(len(other.values)) if other else [None]
    for number, key in enumerate(keys):
        some = np.flatnonzero(mine & (other.index == key) if other else mine)
        some = some[np.argsort(x.at[x.index[some]], kind="stable")]
        at, y = x.at[x.index[some]], np.where(marks.drawn[some], values[some], np.nan)
        colour, marker, style = (some_of[number % len(COLOURS)] for some_of in (COLOURS, DOTS, LINES))
        if not x.is_number:
            style = ""
        if look is not None:
            colour, marker = plt.get_cmap(look[0])(look[1](other.values[key])), "" if style else "o"
            style = style and "-"
        known = np.isfinite(y)
        text = f"{other.short} = {other.texts()[key]}" if other and (look is None or options.fit) else ""
        if options.fit:
            no_sign = np.abs(y) <= errors[some] if errors is not None else np.zeros_like(known)
            law = power_law(at[known], np.where(no_sign, 0., y)[known])
            laws.append((", ".join(([f"{other.name} = {other.texts()[key]}"] if other else []) + panel), law,
                         np.abs(y[known]).min(initial=np.inf)))
            text += ("; " if text else "") + (f"{law[0]:.3g} x^{law[1]:.4f}" if law else "no power law")
        points = len(at) <= 60
        axes.plot(at, y, color=colour, marker=marker if points or options.dots else "",
                  linestyle="" if options.dots else style, markersize=4 if points else 2.5, linewidth=1.2, label=text or None)
        if has_bars and not options.dots:
            bar = np.where(known, errors[some], np.nan)
            if points:
                axes.errorbar(at, y, bar, fmt="none", ecolor=colour, elinewidth=0.8, capsize=2.5)
            else:
                axes.fill_between(at, y - bar, y + bar, color=colour, alpha=0.25, linewidth=0)
    for i in range(len(marks.names)):  # on the lower edge, free of values
        at = np.unique(x.at[x.index[mine & (marks.of == i)]])
        axes.plot(at, np.full(len(at), 0.03 * i), transform=axes.get_xaxis_transform(), linestyle="",
                  marker=marks.marker(i), color="0.35", markersize=5, clip_on=False)
    axes.grid(alpha=0.3)
    return laws


def scale_lines(axes, values, fitted):
    """Sets a logarithmic scale of values; for both signs: linear below the least of the lines with a fit, else of most
    values."""
    if values.min() > 0:
        axes.set_yscale("log")
        return
    sizes = np.abs(values[values != 0])
    least = min(fitted, default=max(np.quantile(sizes, 0.1), 1e-12 * sizes.max()))
    decade = np.floor(np.log10(least))
    axes.set_yscale("symlog", linthresh=1.001 * 10**decade)
    most = np.floor(np.log10(sizes.max()))
    powers = 10 ** np.arange(decade, most + 1)[::int(1 + (most - decade) // 6)]
    axes.yaxis.set_major_locator(ticker.FixedLocator(np.concatenate((-powers[::-1], [0.], powers))))
    axes.yaxis.set_minor_locator(ticker.NullLocator())
    axes.margins(y=0.05)  # margins of this scale


def tell_laws(laws, x, value):
    """Prints the power laws and, in a sentence, the lines that have none."""
    without = [line for line, law, _ in laws if law is None]
    needed = f'two points or more with a positive axis and values "{value}" of one sign, larger than their errors'
    if len(without) == len(laws):
        raise InputError(f"--fit: no line has {needed}, which are expected")
    for line, law, _ in laws:
        if law:
            print(f"{value} = {law[0]:.6g} * ({x.name})^{law[1]:.6f}" + (f" at {line}" if line else ""))
    if without:
        print(f"drawn without a fit, which needs {needed}: {len(without)} of {len(laws)} lines ({'; '.join(without)})")


def spread(axis, most, what):
    """Returns some of the values of an axis, evenly spread, all if they are few."""
    n = len(axis.values)
    if n <= most:
        return list(range(n))
    some = sorted({round(i * (n - 1) / (most - 1)) for i in range(most)})
    print(f"{axis.name}: {len(some)} of {n} values are drawn ({what}); --where chooses others")
    return some


def choose(sweep, options):
    """Chooses the axes x, y (or None) and those of the small pictures, from the command line and the design."""
    varying = sweep.varying()
    if not sweep.axes:
        raise InputError("the table has no axes")
    x = sweep.find(options.x, sweep.axes, "axis") if options.x else (varying or sweep.axes)[-1]
    y = sweep.find(options.y, sweep.axes, "axis") if options.y else None
    if x == y:
        raise InputError(f'"{x}" is both --x and --y; two axes are expected')
    if sweep.design == "grid":
        rest = [axis for axis in varying if axis not in (x, y)]
        y = y or (rest.pop() if rest else None)
        if len(rest) > 2:
            raise InputError(f'{len(rest) + 2} axes are too many for a picture; choose values of {", ".join(rest[:-2])} '
                          'or others by --where AXIS=VALUE')
        return x, y, rest[::-1]
    if sweep.design == "zip" and not y and not options.x:
        x = (varying or sweep.axes)[0]
    elif sweep.design != "zip" and not y and not options.lines:
        others = [axis for axis in varying if axis != x]
        y = others[-1] if others else None
    return x, y, []


def title_of(sweep, options, x, y, marks):
    """Title: values of the axes that do not vary, names of others that do, and the note on marks."""
    words = []
    for axis in sweep.axes:
        values = np.unique(sweep.column(axis))
        if len(values) == 1 and axis not in (x.name, y and y.name):
            value = values[0]
            words.append(f"{sweep.label(axis, False)} = {value:.4g}" if sweep.is_number(axis) else
                         f"{sweep.label(axis, False)} = {as_text(value)}")
    others = [axis for axis in sweep.varying() if axis not in (x.name, y and y.name)]
    if sweep.design != "grid" and others:
        words.append(f"{', '.join(sweep.label(axis, False) for axis in others)} var{'y' if len(others) > 1 else 'ies'}, too")
    if marks.note and options.value not in WORDS:
        words.append(marks.note)
    return "; ".join(words)


def draw(sweep, options, size=None):
    """Draws the whole picture. @p size: width and height [inch], if they are given."""
    if not options.value:
        is_map = "verdict" in sweep.data and len(sweep.varying()) > 1 and not (options.lines or options.fit)
        options.value = "outcome" if is_map else "displacement"
    by_status = options.value in WORDS
    advice = ("--value status shows" if len(sweep.varying()) > 1 else "the column status of results.csv says") + " what became of the points"
    if by_status:
        if options.value not in sweep.data:
            raise InputError(f"only a sweep with Sweep/Cross-check = true has outcomes; {advice}")
        values = np.full(len(sweep.chosen), np.nan)
    else:
        numbers = [name for name in sweep.data if sweep.is_number(name)]
        options.value = sweep.find(options.value, numbers, "column of numbers (or status, outcome)")
        values = sweep.column(options.value)
    marks = Marks(sweep, values, options.value)
    if by_status:
        marks.names = [name.replace("finished, value not known", "finished") for name in marks.names]
    elif not marks.drawn.any():
        raise InputError(f'no point has a {options.value} ({marks.in_words()}); {advice}')
    x, y, rest = choose(sweep, options)
    as_lines = options.lines or options.fit or not y
    if as_lines and sweep.design == "grid" and not by_status:
        if len(rest) > 1:
            raise InputError(f'{len(rest) + 2} axes are too many for lines; choose values of {rest[-1]} by --where AXIS=VALUE')
    elif by_status and as_lines:
        raise InputError(f"--value {options.value} needs two axes")
    elif as_lines:
        y = None
    x, y, rest = Axis(sweep, x), Axis(sweep, y) if y else None, [Axis(sweep, name) for name in rest]
    options.dots = sweep.design not in ("grid", "zip")

    wide = spread(rest[0], MOST_PANELS, "a picture each") if rest else [None]
    high = spread(rest[1], MOST_PANELS, "a row of pictures each") if len(rest) > 1 else [None]
    small = len(wide) * len(high) > 1
    size = size or ((2.4 + 2.3 * len(wide), 1.2 + 2.2 * len(high)) if small else (6.4, 4.8))
    figure, panels = plt.subplots(len(high), len(wide), figsize=size, sharex=True, sharey=True, squeeze=False,
                                  layout="constrained")
    drawn = values[marks.drawn]
    look = None if by_status else norm_of(drawn, options.scale)
    line_look, errors, has_bars = None, None, False
    if as_lines:
        if y and len(y.values) > len(COLOURS):
            if len(y.values) > MOST_LINES or not y.is_number:
                if not y.is_number:
                    raise InputError(f'{len(y.values)} lines are too many to tell apart; choose by --where "{y.name}=VALUE"')
                keep = spread(y, MOST_LINES, "a line each")
                y.values, y.at = y.values[keep], y.at[keep]
                y.index = np.array([keep.index(i) if i in keep else -1 for i in range(y.index.max() + 1)])[y.index]
            line_look = ("viridis", colors.LogNorm(y.values[0], y.values[-1]) if y.log else
                         colors.Normalize(y.values[0], y.values[-1]))
        names = (f"{options.value}_error.total", "errors." + options.value.removesuffix(".value"))
        bars = next((name for name in names if name in sweep.data), None)
        log = isinstance(look[1], (colors.LogNorm, colors.SymLogNorm)) or options.fit
        if bars:
            errors = sweep.column(bars)
            own = errors[marks.drawn]
            has_bars = (own > (0.02 * np.abs(drawn) if log else 0.003 * (drawn.max() - drawn.min()))).any()
    mesh, laws = None, []
    for row, j in enumerate(high):
        for column, i in enumerate(wide):
            axes, mine = panels[row][column], np.ones(len(values), dtype=bool)
            for axis, which in zip(rest, (i, j)):
                mine &= axis.index == which
            if as_lines:
                panel = [f"{axis.name} = {axis.texts()[which]}" for axis, which in zip(rest, (i, j))]
                laws += lines(axes, x, mine, values, errors, has_bars, marks, y, line_look, options, panel)
            elif sweep.design == "grid":
                mesh = heat_map(axes, x, y, mine, values, marks, look)
            else:
                mesh = scatter(axes, x, y, mine, values, marks, look)
            x.log = x.log or (options.fit and x.is_number and x.at.min() > 0)
            x.draw(axes, "x", row == len(high) - 1)
            if not x.is_number and max(map(len, x.texts())) * len(x.values) * len(wide) > 60:
                axes.tick_params(axis="x", labelrotation=30)
            if not as_lines:
                y.draw(axes, "y", column == 0)
            elif column == 0:
                axes.set_ylabel(sweep.label(options.value))
            if rest:
                titles = [f"{axis.short} = {axis.texts()[which]}" for axis, which in zip(rest, (i, j))]
                axes.set_title("\n".join(textwrap.fill(title, 34) for title in titles), fontsize=8)
    if options.fit:
        tell_laws(laws, x, options.value)
    if as_lines and log:
        for axes in panels.flat:
            scale_lines(axes, drawn, [least for _, law, least in laws if law])
    if mesh is not None:
        bar = figure.colorbar(mesh, ax=panels, label=sweep.label(options.value))
        if look[0] == SIGNED and not options.dots:
            bar.ax.axhline(0., color="black", linewidth=1)  # same line as in the map
    elif line_look:
        figure.colorbar(plt.cm.ScalarMappable(line_look[1], line_look[0]), ax=panels, label=y.label)
    n_lines = len(panels[0][0].get_legend_handles_labels()[1]) if as_lines else 0
    if options.fit and 0 < n_lines < 20:  # laws differ between pictures: each has its legend, below
        columns = 1 if small else 2
        size = (size[0], size[1] + 0.16 * -(-n_lines // columns) * len(high))
        figure.set_size_inches(size)
        for axes in panels.flat:
            axes.legend(fontsize=7, loc="upper center", bbox_to_anchor=(0.5, -0.24 if small else -0.12), ncols=columns,
                        frameon=False, handlelength=3)
    elif 0 < n_lines < 20:
        panels[0][0].legend(fontsize=7)
    if marks.names:
        fill = not as_lines and sweep.design == "grid"
        handles = []
        for i, name in enumerate(marks.names):
            text = f"{name}: {marks.counts[i]}"
            handles.append(patches.Patch(facecolor=marks.face(i), edgecolor="0.35", hatch=marks.hatch(i),
                                         linewidth=0.5, label=text) if fill else
                           plt.Line2D([], [], linestyle="", marker=marks.marker(i), color=marks.ink(i), label=text))
        legend_rows = (len(handles) + 1) // 2
        below = 0.264 * legend_rows / size[1]
        figure.get_layout_engine().set(rect=(0, below, 1, 1 - below))
        figure.legend(handles=handles, loc="lower center", ncols=2, fontsize=8, frameon=False, handlelength=2.5)
    if title := title_of(sweep, options, x, y, marks):
        figure.suptitle(title, fontsize=9)
    return figure


def arguments():
    """Parser of the command line."""
    own = parser(__doc__, "results.png, results.svg")
    own.add_argument("--x", metavar="AXIS")
    own.add_argument("--y", metavar="AXIS")
    own.add_argument("--lines", action="store_true")
    own.add_argument("--value", metavar="COLUMN")
    own.add_argument("--where", metavar="AXIS=VALUE", action="append", default=[])
    own.add_argument("--scale", choices=("auto", "linear", "log"), default="auto")
    own.add_argument("--fit", action="store_true")
    return own


def chosen_points(options):
    """Table of the folder, with the points that --where keeps."""
    sweep = Sweep(options.folder)
    for condition in options.where:
        sweep.where(condition)
    return sweep


def main():
    """Reads the arguments, draws and writes."""
    options = arguments().parse_args()
    figure = draw(chosen_points(options), options)
    pictures = [options.output] if options.output else [options.folder / name for name in ("results.png", "results.svg")]
    save(figure, *pictures, study=options.folder)


if __name__ == "__main__":
    run_script(main)
