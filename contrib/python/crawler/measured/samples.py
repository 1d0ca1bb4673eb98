# SPDX-License-Identifier: LGPL-2.1-or-later
"""Samples on a grid over body and time, from sheets, tracks and HDF5 files, in the wanted units."""
import dataclasses
import math
import os
import pathlib

import numpy as np

from scipy.interpolate import CubicSpline

from ..arguments import checked
from ..needs import FileError, InputError
from .formats import WITH_ANIMALS, Tracks, read_hdf5, tracks_of
from .paths import factors_of_path, path_in
from .sheet import read_sheet
from .units import number_of, unit_factor, unit_of

LEAST, MOST_GAPS = 4, 20  # least number of places and times of a spline; most points of the grid per sample
HEADS, TAILS = ("head", "nose", "snout", "anterior"), ("tail", "posterior")  # names of markers at the ends
LARGEST = 1e100  # largest number, so that its square is finite
QUANTITIES = ("m", "strain", "stretch", "markers")
# Names of columns that are understood, the best first.
ROLES = {"s": ("s", "arc length"), "t": ("t", "time", "position_t", "timestamp", "frame", "slice n°", "slice"),
         "m": ("m", "stress", "force", "active stress", "active_stress"), "strain": ("strain",), "stretch": ("stretch",),
         "marker": ("marker", "track_id", "track n°", "track", "id"), "x": ("x", "position", "position_x", "coord_x"),
         "y": ("y", "position_y", "coord_y")}
FRAMES = ("frame", "timestamp", "slice", "slice n°")


@dataclasses.dataclass
class Samples:
    """Measurements at all points of a grid; a gap is NaN.

    quantity: "m" (active stress [force]), "strain" [1], "x" (the places of markers [length], from tail to head), "centre" (the path of the
    centre of mass [length]) or "speed" (of that [length/time]); s: places [length], or the numbers of the markers, increasing, one
    number for centre and speed; t: times [time], increasing; values: array [time, place];
    names: of the markers. notes: sentences on markers and times in another order in the file. deviation: the standard
    deviation of each value, an array [time, place], in the unit of the values; None if it is unknown.
    """
    quantity: str
    s: np.ndarray
    t: np.ndarray
    values: np.ndarray
    names: list = dataclasses.field(default_factory=list)
    notes: list = dataclasses.field(default_factory=list)
    deviation: np.ndarray = None

    def point(self, j, i):
        """Words for the point of values[j, i]; markers have the names of the file."""
        place = f"marker {self.names[i] if self.names else i + 1}, " if self.quantity == "x" else f"s = {self.s[i]:g}, " if len(self.s) > 1 else ""
        return f"{place}t = {self.t[j]:g}"


@checked
def read_samples(path: str | os.PathLike, *, quantity: str = "", columns: str = "", unit_of_s: str | float = "", unit_of_t: str | float = "",
                 unit_of_m: str | float = "", shift_s: str | float = "", shift_t: str | float = "", animal: str = "", head: str = "",
                 confidence: float = 0.0, decimal: str = "", words: list[str] | None = None) -> Samples:
    """Reads the Samples of a file, in the wanted units.

    path: a table as text, or HDF5 of SLEAP, DeepLabCut, Tierpsy or with t and x, or s, t and m or strain. quantity: "m", "strain", "stretch" or
    "markers" (default: by the names). columns: other names, "t=Frame time, x=X". unit_of_s, unit_of_t, unit_of_m: a
    factor (1/30), as a number or text, or a unit. shift_s, shift_t: a number, or "first". animal: name of the one that
    is read. head: the marker at the head. confidence: markers with less are gaps. decimal: "comma" or "point", where a
    comma may be both. words: a list that receives reports in sentences. Raises InputError and FileError.
    """
    words, notes = [] if words is None else words, []
    unit_of_s, unit_of_t, unit_of_m, shift_s, shift_t = (str(one) for one in (unit_of_s, unit_of_t, unit_of_m, shift_s, shift_t))
    if quantity and quantity not in QUANTITIES:
        raise InputError(f'"--quantity" is "{quantity}", but "m", "strain", "stretch" or "markers" is expected')
    path = pathlib.Path(path)
    data = bytes_of(path)
    if data.startswith(b"\x89HDF"):
        found, units = read_hdf5(path, animal), ("", "", "")
    else:
        sheet = read_sheet(data, str(path), decimal)
        is_renamed = any(not part.strip().startswith("t=") for part in columns.split(",") if part)
        found = None if is_renamed or quantity not in ("", "markers") else tracks_of(sheet, animal)
        if not found and not quantity and not columns and (path_found := path_in(sheet)):
            return _samples_of_path(path_found, sheet, unit_of_s, unit_of_t, shift_t, words, {
                "unit-of-m": unit_of_m, "shift-s": shift_s, "animal": animal, "head": head, "confidence": confidence})
        found, units = (found, _units_of(sheet, found)) if found else _generic(sheet, quantity, columns)
        words += sheet.words
        notes += sheet.notes
        if columns and isinstance(found, Tracks) and found.format not in ("wide", "long"):
            raise InputError(f'"--columns" is "{columns}", but "{path}" has {found.format}, whose columns are known')
    if animal and not (isinstance(found, Tracks) and found.format in WITH_ANIMALS):
        raise InputError(f'"--animal" is "{animal}", but "{path}" does not tell animals apart')
    factor_s, factor_t = (unit_factor(unit, wanted, option) if wanted else 1.0 for unit, wanted, option in
                          ((units[0], unit_of_s, "--unit-of-s"), (units[1], unit_of_t, "--unit-of-t")))
    if isinstance(found, Tracks):
        if unit_of_m or quantity not in ("", "markers"):
            raise InputError(f'"{path}" has tracks of markers, but {"--unit-of-m" if unit_of_m else "--quantity " + quantity} is for '
                             "samples of stress or strain")
        samples = _along_body(found, head, confidence, str(path), words, notes)
    else:
        s, t, values, column = found
        if head or confidence:
            raise InputError('"--head" and "--confidence" are for markers, which this file does not have')
        samples = Samples("m" if column == "m" else "strain", s, t, values)
        _require_increasing(samples, str(path))
    samples.notes = notes
    words += notes
    words.append(f"{len(samples.s)} {'markers' if samples.quantity == 'x' else 'places'} x {len(samples.t)} times, "
                 f"{np.isnan(samples.values).sum()} gaps")
    samples.t = _converted(samples.t, "t", factor_t, shift_t, words)
    if samples.quantity == "x":
        if shift_s:
            raise InputError('"--shift-s" is for places, but markers have a "--first-marker"')
        samples.values = _converted(samples.values, "x", factor_s, "", words)
    else:
        samples.s = _converted(samples.s, "s", factor_s, shift_s, words)
        samples.values = _converted(samples.values, column, _factor_of_values(column, units[2], unit_of_m, str(path)), "", words)
        if column == "stretch":
            samples.values = samples.values - 1
            words.append("the stretch minus 1 is the strain")
    _require_possible(samples, str(path))
    if factor_s < 0 or factor_t < 0:
        raise InputError("a unit is negative, but only that of m may be")
    if isinstance(found, Tracks) and found.counts_frames and not unit_of_t:
        words.append('t counts frames; "--unit-of-t 1/30" converts those of a film of 30 frames a second into seconds')
    return samples


def _samples_of_path(found, sheet, unit_of_s, unit_of_t, shift_t, words, others):
    """Samples of a result of path_in(). others: {option: value} that only samples along a body have."""
    kind, t, values, deviation, unit, unit_t = found
    for option, value in others.items():
        if value:
            raise InputError(f'"--{option}" is for samples along a body, but "{sheet.name}" has the {"path" if kind == "centre" else kind} of its centre of mass')
    factor, factor_t = factors_of_path(kind, unit, unit_t, unit_of_s, unit_of_t)
    words += [*sheet.words, f"{kind} at {len(t)} times, {np.isnan(values).sum()} gaps"]
    samples = Samples(kind, np.zeros(1), _converted(t, "t", factor_t, shift_t, words), _converted(values, kind, factor, "", words),
                      deviation=None if deviation is None else deviation * factor)
    _require_possible(samples, sheet.name)
    if factor < 0 or factor_t < 0:
        raise InputError("a unit is negative, but only that of m may be")
    return samples


def bytes_of(path):
    """Bytes of a file. Raises FileError."""
    if path.exists() and not path.is_file():
        raise FileError(f'"{path}" is {"a folder" if path.is_dir() else "a device"}, but a file is expected')
    try:
        return path.read_bytes()
    except OSError as error:
        raise FileError(f'cannot read "{path}": {error.strerror}') from None


def _factor_of_values(column, unit, wanted, name):
    """Factor of the values. Strain and stretch have the unit 1, to which per cent are converted."""
    if column == "m" or number_of(wanted) is not None:
        return unit_factor(unit, wanted, "--unit-of-m") if wanted else 1.0
    base, size = unit_of(unit or "1") or ("", 0)
    if base != "1" or wanted not in ("", "1", "-"):
        raise InputError(f'the {column} of "{name}" is wanted in "{wanted or unit}", but its unit is 1; "--unit-of-m" with a number '
                         "converts it")
    return size


def _require_possible(samples, name):
    """Raises InputError for numbers that no body can have."""
    low, what = (-1, "a strain above -1") if samples.quantity == "strain" else (-LARGEST, f"a number between -{LARGEST:g} and {LARGEST:g}")
    with np.errstate(invalid="ignore"):
        wrong = (samples.values <= low) | (samples.values >= LARGEST)
    if np.any(wrong):
        j, i = np.argwhere(wrong)[0]
        see = '"--unit-of-m" and "--quantity"' if samples.quantity in ("m", "strain") else '"--unit-of-s"'
        raise InputError(f'"{name}" has {samples.quantity} = {samples.values[j, i]:g} at {samples.point(j, i)}, but {what} is expected; see {see}')


def _converted(values, name, factor, shift, words):
    """Values multiplied and shifted, without the last digits: these are round-off of large or single-precision
    numbers."""
    if factor != 1:
        words.append(f"{name} multiplied by {factor:g}")
    result = values * factor
    if not shift:
        return result
    first = -result.flat[0] if shift == "first" else number_of(shift)
    if first is None or not math.isfinite(first):
        raise InputError(f'"--shift-{name}" is "{shift}", but a number or "first" is expected')
    digits = math.floor(-math.log10(max(4e-16 * np.max(np.abs(result)), 1e-300)))
    result = np.round(result + first, min(digits, 15))
    words.append(f"{name} shifted by {first:g}; it goes from {result.min():g} to {result.max():g}")
    return result


def _units_of(sheet, tracks):
    """Units of places and times, as far as the names contain them."""
    if tracks.format != "pairs of x and y":
        return "", "", ""
    return sheet.units[-1], sheet.units[0], ""


def _generic(sheet, quantity, renamed):
    """Tracks, or (s, t, values, column), of a table with a column for each quantity, or with one for each place, time
    or marker; and the units of s (or x), t and values."""
    if not sheet.head:
        raise InputError(f'"{sheet.name}" has no line of {len(sheet.rows[0])} names above its numbers, but one is expected, as '
                         "t;s;m or t;0;0.25;0.5 or t;x1;x2;x3")
    roles = _roles(sheet, renamed)
    units = sheet.units
    found = [role for role in ("m", "strain", "stretch") if role in roles]
    if {"t", "s"} <= set(roles) and found:
        if (quantity or len(found) > 1) and quantity not in found:
            raise InputError(f'"{sheet.name}" has the column{"s" if len(found) > 1 else ""} {", ".join(found)}, but "--quantity" '
                             f'{f"is {quantity}" if quantity else "does not say which"}; one of them is expected ("--columns" renames)')
        value = quantity or found[0]
        s, t, values = _on_grid(sheet, sheet.column(roles["s"]), sheet.times(roles["t"]), sheet.column(roles[value]), sheet.lines, "s")
        return (s, t, values, value), (units[roles["s"]], units[roles["t"]], units[roles[value]])
    if {"t", "marker", "x"} <= set(roles):
        return _long_tracks(sheet, roles), (units[roles["x"]], units[roles["t"]], "")
    if roles.get("t") == 0 or roles.get("s") == 0:
        first = "s" if roles.get("t") != 0 else "t"
        if idle := [part.strip() for part in renamed.split(",") if part.strip() and part.partition("=")[0].strip() != first]:
            raise InputError(f'"--columns" has "{idle[0]}", but "{sheet.name}" has a column for each {"time" if first == "s" else "place or marker"} beside '
                             f'{sheet.names[0]}, of which all are read; only {first} is expected there')
        return _wide(sheet, quantity, first)
    raise InputError(f'"{sheet.name}" has the columns {", ".join(sheet.names)}, but s, t and m (or strain, stretch) are expected; '
                     'or t, marker and x; or t and a column for each s or marker ("--columns" gives them other names)')


def _roles(sheet, renamed):
    """Roles of the columns: {"t": 0, ...}."""
    names, roles = sheet.names, {}
    lower = [name.lower() for name in names]
    for role, known in ROLES.items():
        name = next((name for name in known if name in lower), None)
        if name is None:
            continue
        places = [i for i, other in enumerate(lower) if other == name]
        if len(places) > 1:
            more = "; a row of names of markers above is expected, as Tracker writes it" if role in "xy" else ""
            raise InputError(f'"{sheet.name}" has {len(places)} columns "{names[places[0]]}", but one is expected{more}; '
                             f'"--columns {role}=NAME" chooses')
        roles[role] = places[0]
    for part in filter(None, renamed.split(",")):
        role, equals, name = (text.strip() for text in part.partition("="))
        if not equals or role not in ROLES:
            raise InputError(f'"--columns" has "{part.strip()}", but NAME=COLUMN is expected, NAME being s, t, m, strain, stretch, '
                             "marker, x or y")
        if name not in names:
            raise InputError(f'"--columns" has the column "{name}", but "{sheet.name}" has {", ".join(names)}')
        roles[role] = names.index(name)
        roles = {other: i for other, i in roles.items() if other == role or i != roles[role]}
    return roles


def _wide(sheet, quantity, first):
    """Reads a column for each place or marker (first is "t"), or for each time (first is "s")."""
    names, units = sheet.names, sheet.units
    columns = list(range(1, len(names)))
    is_tracked = quantity == "markers" or (not quantity and first == "t" and names[1].lower().startswith(("x", "marker")))
    along = sheet.times(0) if first == "t" else sheet.column(0)
    if np.any(np.isnan(along)):
        raise InputError(f'row {sheet.lines[int(np.argmax(np.isnan(along)))]} of "{sheet.name}" has no {names[0]}, but only what is '
                         "measured may have gaps")
    if is_tracked:
        if names[1].lower().startswith(("x", "marker")):
            columns = [i for i in columns if names[i].lower().startswith(("x", "marker")) or names[i].lower() in HEADS + TAILS]
        if others := [name for i, name in enumerate(names) if i and i not in columns]:
            sheet.words.append(f"beside the columns of markers left out: {', '.join(others)}")
        names = [names[i] for i in (0, *columns)]
        across = np.arange(1.0, len(names))
        if len(set(names[1:])) < len(names) - 1:
            twice = next(name for name in names if names.count(name) > 1)
            raise InputError(f'"{sheet.name}" has {names.count(twice)} columns "{twice}", but a column for each marker with a name '
                             "of its own is expected")
    else:
        across = np.array([_place(sheet, i, first) for i in range(1, len(names))])
    values = np.array([sheet.column(i) for i in columns]).T
    repeated = [np.repeat(along, len(across)), np.tile(across, len(along))]
    s, t = repeated if first == "s" else repeated[::-1]
    s, t, values = _on_grid(sheet, s, t, values.ravel(), np.repeat(sheet.lines, len(across)), *(("marker", names[1:]) if is_tracked else ("s",)))
    wide_units = (units[1] if is_tracked else "", units[0], units[1]) if first == "t" else (units[0], "", units[1])
    if is_tracked:
        counted = names[0].lower() in FRAMES
        return Tracks(names[1:], t, values, None, None, "wide", counts_frames=counted), wide_units
    return (s, t, values, quantity or "m"), wide_units


def _place(sheet, i, first):
    number = sheet.number(sheet.names[i])
    if number is None:
        number = number_of(sheet.names[i].replace(",", "."))
    if number is None or not math.isfinite(number):
        raise InputError(f'column {i + 1} of "{sheet.name}" is "{sheet.names[i]}", but the {"time" if first == "s" else "place s"} of its '
                         "samples is expected as its name (or names as x1, x2, ... if they are markers)")
    return number


def _long_tracks(sheet, roles):
    """Reads a row for each marker and time."""
    keys = [row[roles["marker"]] for row in sheet.rows]
    numbers = [sheet.number(key) for key in keys]
    is_numbered = all(number is not None and not np.isnan(number) for number in numbers)
    names = sorted(set(keys), key=(lambda key: sheet.number(key)) if is_numbered else None)
    order = {name: float(i) for i, name in enumerate(names)}
    marker, t = np.array([order[key] for key in keys]), sheet.times(roles["t"])
    arrays = {quantity: _on_grid(sheet, marker, t, sheet.column(roles[quantity]), sheet.lines, "marker", names)
              for quantity in ("x", "y") if quantity in roles}
    return Tracks(names, arrays["x"][1], arrays["x"][2], arrays["y"][2] if "y" in arrays else None, None, "long",
                  counts_frames=sheet.names[roles["t"]].lower() in FRAMES)


def _on_grid(sheet, s, t, values, lines, kind, names=None):
    """Different places and times, sorted, and the values [time, place]. Differences by round-off do not count."""
    lines = np.asarray(lines)
    for name, axis in ((kind, s), ("t", t)):
        if np.any(missing := np.isnan(axis)):
            raise InputError(f'row {lines[int(np.argmax(missing))]} of "{sheet.name}" has no {name}, but only what is measured may have '
                             "gaps")
    in_file, (s, i), (t, j) = t, _distinct(s), _distinct(t)
    of = "markers" if kind == "marker" else "places s"
    if len(s) * len(t) > MOST_GAPS * len(values):
        raise InputError(f'"{sheet.name}" has {len(values)} samples at {len(s)} different {of} and {len(t)} different times, but most '
                         "of them with each other are expected (all places sampled at the same times)")
    point = j * len(s) + i
    order = np.argsort(point, kind="stable")
    again = order[1:][np.diff(point[order]) == 0]
    if len(again):
        second = again[np.argmin(lines[again])]
        before = lines[np.flatnonzero(point == point[second])[0]]
        name = names[i[second]] if names else f"{s[i[second]]:g}"
        more = len(set(lines[again])) - 1
        rows = "row does" if more == 1 else "rows do"
        raise InputError(f'row {lines[second]} of "{sheet.name}" gives {kind} = {name}, t = {t[j[second]]:g} a second time, after row '
                         f'{before}{f", as {more} more {rows}" if more else ""}')
    by_place = np.argsort(i, kind="stable")  # the times of each place as the file has them
    falls = (np.diff(j[by_place]) < 0) & (np.diff(i[by_place]) == 0)
    note_fallen_times(in_file[by_place], falls, sheet.notes, lines[by_place])
    grid = np.full(len(s) * len(t), np.nan)
    grid[point] = values
    return s, t, grid.reshape(len(t), len(s))


def note_fallen_times(t, falls, notes, lines=None):
    """Adds a sentence to the notes if times in the file decrease. falls: [time - 1], where; lines: of the file."""
    if not np.any(falls):
        return
    t_before, t_here = t[:-1][falls], t[1:][falls]
    k = int(np.argmax(t_before - t_here))
    n = len(set(t_here))
    where = "" if lines is None or len(set(lines[:-1][falls]) & set(lines[1:][falls])) else f" in row {lines[1:][falls][k]}"
    note = (f"times do not increase in the file: t = {t_here[k]:g}{where} comes after {t_before[k]:g}"
            f"{f', and {n - 1} more like it' if n > 1 else ''}; they are sorted")
    if note not in notes:
        notes.append(note)


def _distinct(values):
    """Different numbers, sorted, and the index of each value among them."""
    order = np.argsort(values, kind="stable")
    steps = np.diff(values[order]) > 1e-9 * (values.max() - values.min())
    index = np.empty(len(values), dtype=int)
    index[order] = np.concatenate([[0], np.cumsum(steps)])
    return values[order][np.concatenate([[True], steps])], index


def _require_increasing(samples, name):
    for axis, values in (("s", samples.s), ("t", samples.t)):
        if not np.all(np.diff(values) > 0):
            raise InputError(f'"{axis}" of "{name}" does not increase, but increasing numbers are expected')


def _along_body(tracks, head, confidence, name, words, notes):
    """Samples of markers from tail to head: places along the body, the largest at the head. notes: receives changes of
    order."""
    x, y, names = tracks.x.copy(), tracks.y, list(tracks.names)
    if tracks.format not in ("wide", "long"):
        words.append(f"{tracks.format}: {len(names)} markers, {', '.join(names[:12])}{', ...' if len(names) > 12 else ''}")
    if head and head not in names:
        raise InputError(f'"--head" is "{head}", but the markers are {", ".join(names)}')
    if not 0 <= confidence <= 1:
        raise InputError(f'"--confidence" is {confidence:g}, but a number from 0 to 1 is expected')
    if tracks.confidence is not None:
        low = tracks.confidence < confidence
        x[low] = np.nan
        words.append(f"{low.sum()} places with a confidence below {confidence:g} left out" if confidence else
                     f'the smallest confidence of a place is {np.nanmin(tracks.confidence):.3g}; "--confidence 0.6" leaves out what is '
                     "less certain")
    elif confidence:
        raise InputError(f'"--confidence" is {confidence:g}, but "{name}" has none')
    if np.any(nowhere := np.all(np.isnan(x), axis=0)):
        raise InputError(f'the marker {names[int(np.argmax(nowhere))]} of "{name}" has no place at any time')
    order = np.argsort(tracks.t, kind="stable")
    note_fallen_times(tracks.t, np.diff(tracks.t) < 0, notes)
    t = tracks.t[order]
    if np.any(np.diff(t) <= 0) or np.any(np.isnan(t)):
        raise InputError(f'"{name}" has the time {t[int(np.argmax(np.diff(t) <= 0))]:g} a second time, but different times are expected')
    x = x[order]
    if y is not None:
        gaps = np.isnan(x) | np.isnan(y[order])
        x, y = np.where(gaps, np.nan, x), np.where(gaps, np.nan, y[order])
        if (chain := _shorter_chain(x, y)) is not None:
            x, y, names = x[:, chain], y[:, chain], [names[i] for i in chain]
            notes.append(f"the markers put in order along the body: {', '.join(names)}")
        x = _arc_lengths(t, x, y, words, notes)
    x, names = _from_tail_to_head(x, names, head, words, notes)
    return Samples("x", np.arange(1.0, len(names) + 1), t, x, names)


def _shorter_chain(x, y):
    """Order of the markers along the longest axis of all, if the chain in their own order is much longer: numbers of
    tracks need not follow the body. None if their own order is good."""
    mean = np.array([np.nanmean(x, axis=0), np.nanmean(y, axis=0)])
    middle = mean - mean.mean(axis=1, keepdims=True)
    order = np.argsort(np.linalg.svd(middle, full_matrices=False)[0][:, 0] @ middle, kind="stable")
    own, other = (np.sum(np.hypot(*np.diff(one, axis=1))) for one in (mean, mean[:, order]))
    if not own > 1.5 * other:
        return None
    return order if mean[0, order[0]] <= mean[0, order[-1]] else order[::-1]


def _between_times(t, x):
    """Fills gaps between measured times by splines, x [time, marker]: only as a reference for the other markers."""
    x = x.copy()
    for column in x.T:
        there = np.flatnonzero(~np.isnan(column))
        inside = np.flatnonzero(np.isnan(column))
        inside = inside[(inside > there[0]) & (inside < there[-1])]
        if len(inside) and len(there) >= LEAST:
            column[inside] = CubicSpline(t[there], column[there])(t[inside])
    return x


def _between_markers(x):
    """Fills what is left of gaps between markers by straight lines, x [time, marker]: a reference for the others."""
    x, numbers = x.copy(), np.arange(x.shape[1])
    for j in np.flatnonzero(np.any(np.isnan(x), axis=1)):
        there = ~np.isnan(x[j])
        if there.any():
            x[j] = np.interp(numbers, numbers[there], x[j, there], left=np.nan, right=np.nan)
    return x


def _largest_bend(sines):
    """Amplitude in degrees of the angle between a segment and the axis, of the segment that turns most, from sines
    [time, segment]. Noise, as second differences in time tell it, does not count."""
    squares = np.nanmean(sines**2, axis=0)
    noise = np.nanmean(np.diff(sines, 2, axis=0)**2, axis=0) / 6 if len(sines) >= LEAST else 0
    return np.degrees(np.arcsin(np.clip(np.sqrt(2 * np.nanmax(np.maximum(squares - noise, 0))), 0, 1)))


def _arc_lengths(t, x, y, words, notes):
    """Places along a body that may bend: distances between neighbours, beside the mean place along the mean axis."""
    gaps = np.isnan(x)
    x, y = (_between_markers(_between_times(t, one)) for one in (x, y))
    with np.errstate(invalid="ignore"):
        axis = np.array([np.nanmean(x[:, -1] - x[:, 0]), np.nanmean(y[:, -1] - y[:, 0])])
        axis /= np.hypot(*axis)
        steps = np.hypot(np.diff(x, axis=1), np.diff(y, axis=1))
        straight = np.diff(x, axis=1) * axis[0] + np.diff(y, axis=1) * axis[1]
        bend = _largest_bend((np.diff(y, axis=1) * axis[0] - np.diff(x, axis=1) * axis[1]) / steps)
    along = x * axis[0] + y * axis[1]
    if bend < 5:
        words.append("x and y lie on a straight line; places are along it")
        return np.where(gaps, np.nan, along if axis[0] >= 0 else -along)
    filled = np.where(np.isnan(steps), np.nanmean(steps, axis=0), steps)
    arc = np.concatenate([np.zeros((len(x), 1)), np.cumsum(filled, axis=1)], axis=1)
    notes.append(f"the body bends, by {bend:.0f} degrees from the axis: positions are distances along it, of x and y")
    rest = along - arc
    if np.any(whole := ~np.any(np.isnan(rest), axis=1)):  # the mean over some markers is then that over all
        rest = rest - np.mean(rest[whole] - rest[whole].mean(axis=1, keepdims=True), axis=0)
    return np.where(gaps, np.nan, arc + np.nanmean(rest, axis=1)[:, np.newaxis])


def _from_tail_to_head(x, names, head, words, notes):
    """Markers in the order of their places; with the head at the largest x."""
    together = ~np.any(np.isnan(x), axis=1)
    order = np.argsort(np.nanmean(x[together] if together.any() else x, axis=0), kind="stable")
    if not np.array_equal(order, np.arange(len(names))):
        turned = np.array_equal(order[::-1], np.arange(len(names)))
        notes.append("the last marker lies at the smallest x, so it is the first from the tail: the order is reversed" if turned
                     else f"the markers put in order along the body: {', '.join(names[i] for i in order)}")
    x, names = x[:, order], [names[i] for i in order]
    if not head and names[0].lower() in HEADS or names[-1].lower() in TAILS:
        head = head or names[0]
        words.append(f"{head} is the head, as its name says")
    if head and names[-1] != head:
        if names[0] != head:
            raise InputError(f'"--head" is "{head}", which lies between {names[0]} and {names[-1]}, but one of these two is expected')
        x, names = -x[:, ::-1], names[::-1]
        notes.append(f"the head {head} lies at the smallest x: x is reversed, so that it points from tail to head")
    words.append(f"the head is marker {names[-1]}" + ("" if head else f', as its x is the largest; "--head {names[0]}" would be the other'))
    return x, names
