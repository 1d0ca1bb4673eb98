# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measured data as a fit compares them with a run."""
import dataclasses
import math
import os

import numpy as np

from ..measured.samples import Samples, read_samples
from ..needs import FileError, InputError

SHRUNK, STRETCHED = 0.2, 3.0  # mean stretches between the outermost markers that no body has
LARGEST_PLACE_DEVIATION = 0.25  # of markers, relative to the length of the body; places anywhere on it have 0.29
SHORT = 0.02  # duration of the data, relative to the run, that may be one in other units
CLOSE = 0.02  # distance of the outermost markers from the ends of the body that counts as none, relative to its length
KINDS = {"x": "markers", "strain": "strain", "centre": "centre", "speed": "speed"}  # kinds by the quantity of Samples
COUNTED = ("markers", "centre")  # kinds that are measured from an origin
WORDS = {"markers": "tracks of markers", "strain": "samples of strain", "centre": "the path of the centre of mass", "speed": "its speed"}


@dataclasses.dataclass
class Series:
    """Numbers of one kind over time, and perhaps places; a gap is NaN.

    kind: "markers", the x of markers [length]; "strain" [1]; "centre", the x of the centre of mass [length]; or
    "speed", its velocity [length/time]. t: times of the run [time], increasing; places: on the body [length], of
    markers and strain, else empty; values: array [time, place]. deviation: the standard deviation of a number, None if
    it is unknown; relative: that of each number over this one, [time, place], 1 where all have the same. names: of the
    places. notes: sentences on a different order in the file.
    """
    kind: str
    t: np.ndarray
    places: np.ndarray
    values: np.ndarray
    deviation: float = None
    names: list = dataclasses.field(default_factory=list)
    notes: list = dataclasses.field(default_factory=list)
    relative: np.ndarray = None

    def __post_init__(self):
        self.relative = np.ones(self.values.shape) if self.relative is None else self.relative

    @property
    def is_there(self):
        """[time, place]: True where there is a measurement."""
        return ~np.isnan(self.values)


class Data:
    """Measured data, a Series for each kind, and the free constants besides the variables. Arrays of all numbers in
    sequence are [datum]."""

    def __init__(self, series, has_origin=True, place_deviation=0.0):
        """has_origin: True if x of the run has the origin of the data; place_deviation: of the places of markers
        [length]; 0: they are known, inf: they are free."""
        self.series, self.has_origin, self.place_deviation = series, has_origin, place_deviation
        self.said_places = np.array(self.places)  # before the fit moves them
        self.n = int(sum(one.is_there.sum() for one in series))
        self.values, self.relative = (self.flat([getattr(one, name) for one in series]) for name in ("values", "relative"))
        self.notes = [note for one in series for note in one.notes]

    def flat(self, arrays):
        """Values [datum] of an array [time, place] for each series."""
        return np.concatenate([np.broadcast_to(array, one.values.shape)[one.is_there] for one, array in zip(self.series, arrays)])

    def grids(self, numbers):
        """Arrays [time, place] for each series, of numbers [datum]; gaps are NaN."""
        parts = np.split(numbers, np.cumsum([one.is_there.sum() for one in self.series])[:-1])
        grids = [np.full(one.values.shape, np.nan) for one in self.series]
        for grid, one, part in zip(grids, self.series, parts):
            grid[one.is_there] = part
        return grids

    @property
    def is_weighed(self):
        """True if the deviation of each number is known."""
        return all(one.deviation for one in self.series)

    @property
    def places(self):
        """Places of the markers; empty if there are none."""
        return next((one.places for one in self.series if one.kind == "markers"), np.empty(0))

    @places.setter
    def places(self, places):
        for one in self.series:
            if one.kind == "markers":
                one.places = places

    @property
    def n_constants(self):
        """Number of free constants besides the variables: the origin, and places."""
        return (not self.has_origin) + (len(self.places) if self.place_deviation == math.inf else 0)

    def nuisance(self, stretch):
        """Derivatives of the data [datum] by the origin and the place of each marker, as columns; and the rows that
        hold places. A marker at s + d instead of s is at x + w d, with stretch w [time, marker]."""
        columns = []
        if not self.has_origin:
            columns.append(self.flat([float(one.kind in COUNTED) for one in self.series]))
        if self.place_deviation > 0:
            for i in range(len(self.places)):
                here = np.arange(len(self.places)) == i
                columns.append(self.flat([stretch * here if one.kind == "markers" else 0.0 for one in self.series]))
        matrix = np.array(columns).T.reshape(self.n, len(columns))
        if not 0 < self.place_deviation < math.inf:
            return matrix, np.zeros((0, len(columns)))
        return matrix, np.eye(len(self.places), len(columns), k=len(columns) - len(self.places)) / self.place_deviation


def read_data(data, parameters, **reading):
    """Data of files or of Samples, according to section Fit of a scene.

    data: a name, or Samples; for several kinds of data a list of them, or names separated by semicolons. parameters:
    all entries of the scene. reading: options of measured.read_samples(). Raises InputError, also for a file that
    cannot be read, as for those of other entries.
    """
    parts = [one.strip() for one in data.split(";") if one.strip()] if isinstance(data, str) else list(data) if isinstance(data, (list, tuple)) else [data]
    read, kinds = [], {}
    for number, part in enumerate(parts, 1):
        if not isinstance(part, (str, os.PathLike, Samples)):
            raise InputError(f"the data are of the type {type(part).__name__}, but the name of a file or measured.Samples(quantity, s, t, values) is expected")
        samples = part if isinstance(part, Samples) else _read_file(part, reading, len(parts) > 1)
        name = f'"{part}"' if not isinstance(part, Samples) else "the data" if len(parts) == 1 else f"number {number} of the data"
        _require_sound(samples, name)
        if len(parts) > 1 and np.all(np.isnan(samples.values)):
            raise InputError(f"{name} has no numbers, but some are expected of each kind of data")
        kind = KINDS.get(samples.quantity)
        if kind is None:
            raise InputError(f"{name} has samples of {samples.quantity}, but markers, strain, or columns t and centre or speed are expected")
        if (other := kinds.setdefault(kind, name)) is not name:
            raise InputError(f"{other} and {name} both have {WORDS[kind]}, but one file of each kind is expected; several recordings are fitted one "
                             "by one")
        read.append((samples, kind, name))
    shift, deviations = _shift_of(read, parameters["Fit/First time"]), _deviations_of(read, str(parameters["Fit/Standard deviation"]))
    free, series = 0.0, []
    for (samples, kind, name), (deviation, relative) in zip(read, deviations):
        places, of_places = _places_of(samples, kind, parameters, name)
        free = max(free, of_places)
        if 0 < of_places < math.inf and deviation is None:
            raise InputError('"Fit/Place deviation" is set, but not "Fit/Standard deviation", without which the two cannot be weighed; it is expected')
        series.append(Series(kind, _times_of_run(samples.t + shift, parameters["Time/End time"], name), places, samples.values, deviation,
                             list(samples.names), list(samples.notes), relative))
    series[0].notes.extend([*_idle_entries(series, parameters), *_short_data(series, parameters["Time/End time"])])
    return Data(series, not any(one.kind in COUNTED for one in series) or parameters["Fit/Origin"] != "unknown", free)


def _idle_entries(series, parameters):
    """Sentences on entries of section Fit that have no effect for lack of such data."""
    kinds = {one.kind for one in series}
    for entry, usual, wanted in (("Markers at", "first", ("markers",)), ("Place deviation", "automatic", ("markers",)), ("Origin", "unknown", COUNTED)):
        if str(parameters[f"Fit/{entry}"]).strip() != usual and kinds.isdisjoint(wanted):
            yield f'"Fit/{entry}" has no effect: none of the data are {" or ".join(WORDS[kind] for kind in wanted)}'


def _read_file(name, reading, is_one_of_several):
    """Samples of a file. If there are other files, options for markers are ignored for a path. Raises InputError."""
    try:
        return read_samples(name, **reading)
    except FileError as error:
        raise InputError(str(error)) from None
    except InputError:
        common = {option: value for option, value in reading.items() if option in ("unit_of_s", "unit_of_t", "shift_t")}
        if is_one_of_several and common != reading and (samples := read_samples(name, **common)).quantity in ("centre", "speed"):
            return samples
        raise


def _shift_of(read, first):
    """Shift from times in the data to times of the run; all data have one clock."""
    return 0.0 if first == "automatic" else float(first) - min(samples.t[0] for samples, _, _ in read)


def _times_of_run(t, end, name):
    """Raises InputError for times beyond the run."""
    if t[0] < -1e-9 * end or t[-1] > end * (1 + 1e-9):
        raise InputError(f"{name} has times from {t[0]:g} to {t[-1]:g} of the run, but from 0 to Time/End time = {end:g} are expected; see "
                         "Fit/First time and \"--unit-of-t\"")
    return np.clip(t, 0, end)


def _places_of(samples, kind, parameters, name):
    """Places of samples on the body and, for markers, their standard deviation [length]. Raises InputError."""
    length = parameters["Body/Length"]
    if kind == "markers":
        places, free = _places_of_markers(samples, parameters, length, name)
        if LARGEST_PLACE_DEVIATION * length <= free < math.inf:
            raise InputError(f'"Fit/Place deviation" is {free:g}, but less than {LARGEST_PLACE_DEVIATION * length:g}, {LARGEST_PLACE_DEVIATION:g} of Body/Length, '
                             "is expected: a marker anywhere on the body has hardly more")
        _require_unit_of_markers(samples, places, name)
        return np.clip(places, 0, length), free
    if kind != "strain":
        return np.empty(0), 0.0
    places = np.array(samples.s, dtype=float)
    if places[0] < 0 or places[-1] > length * (1 + 1e-9):
        raise InputError(f"{name} has strain from s = {places[0]:g} to {places[-1]:g}, but places from 0 to Body/Length = {length:g} are "
                         "expected; see \"--unit-of-s\" and \"--shift-s\"")
    return np.clip(places, 0, length), 0.0


def _require_unit_of_markers(samples, places, name):
    """Raises InputError if the outermost markers are in most frames so far apart, or so near, that no body can be."""
    ends = samples.values[:, -1] - samples.values[:, 0]
    if len(places) < 2 or np.all(np.isnan(ends)):
        return
    span, on_body = np.nanmedian(ends), places[-1] - places[0]
    if not SHRUNK < span / on_body < STRETCHED:
        times = f"{span / on_body:.4g} times" if span / on_body > 1 else f"1/{on_body / span:.4g} of" if span > 0 else "not in the order of"
        raise InputError(f'the outermost markers of {name} are {span:g} apart, {times} their distance on the body, {on_body:g}; the same unit of length is '
                         'expected in data and scene, see "--unit-of-s" (and "--unit-of-t")')


def _short_data(series, end):
    """Sentence on data that last only a small part of the run, as times in other units do."""
    lasts = max(one.t[-1] for one in series) - min(one.t[0] for one in series)
    if lasts < SHORT * end and max(len(one.t) for one in series) > 1:
        yield f'the data last {lasts:g}, 1/{end / lasts:.4g} of the run (Time/End time is {end:g}): see "--unit-of-t" if that is not meant'


def _deviations_of(read, text):
    """(Common deviation, relative deviation of each number) for each of the data, (None, None) if unknown. text: of the
    entry, with a number or "automatic" for each. Raises InputError, also where several kinds of data cannot be
    weighed."""
    words, names = [word.strip() for word in text.split(",")], [name for _, _, name in read]
    if words == ["automatic"]:
        words *= len(read)
    if len(words) != len(read):
        raise InputError(f'"Fit/Standard deviation" is {text}, but {f"{len(read)} of them are" if len(read) > 1 else "one is"} expected, '
                         f'separated by commas, for {", ".join(names)}')
    deviations = [_deviation_of(samples, word, name) for (samples, _, name), word in zip(read, words)]
    unknown = [name for name, (deviation, _) in zip(names, deviations) if deviation is None]
    if unknown and len(read) > 1:
        raise InputError(f"the standard deviation of {unknown[0]} is not known, without which it cannot be weighed against {next(one for one in names if one != unknown[0])}; "
                         'a column "deviation" there, or "Fit/Standard deviation" with a number for each, is expected')
    return deviations


def _deviation_of(samples, wanted, name):
    """Common deviation and, [time, place], the relative one of each number; (None, None) if unknown. wanted: a number
    or "automatic"."""
    try:
        given = None if wanted == "automatic" else float(wanted)
    except ValueError:
        given = math.nan
    if given is not None and not 0 < given < math.inf:
        raise InputError(f'"Fit/Standard deviation" has "{wanted}" for {name}, but a positive number or the word "automatic" is expected')
    if samples.deviation is None:
        return given, None
    if given is not None:
        raise InputError(f'"Fit/Standard deviation" is {given:g}, but {name} have a deviation for each number; one of the two is expected')
    each, there = np.asarray(samples.deviation, dtype=float), ~np.isnan(samples.values)
    if each.shape != samples.values.shape:
        raise InputError(f"{name} have deviations of the shape {each.shape}, but {samples.values.shape}, that of the values, is expected")
    wrong = there & ~((each > 0) & np.isfinite(each))
    if np.any(wrong):
        j, i = np.argwhere(wrong)[0]
        raise InputError(f"{name} have the deviation {each[j, i]:g} at t = {samples.t[j]:g}, but a number above 0 is expected for each that was measured")
    common = float(np.mean(each[there] ** -2.0) ** -0.5) if np.any(there) else 1.0
    return common, np.where(there, each / common, 1.0)


def _require_sound(samples, name):
    """Raises InputError for Samples whose shapes, times or numbers cannot be those of data."""
    t, values = np.asarray(samples.t, dtype=float), np.asarray(samples.values, dtype=float)
    if t.ndim != 1 or values.shape != (len(t), len(samples.s)):
        raise InputError(f"{name} have values of the shape {values.shape}, but {(np.size(t), len(samples.s))}, [time, place], is expected")
    falls = np.flatnonzero(~(np.diff(t) > 0))
    if not np.all(np.isfinite(t)) or len(falls):
        where = f"{t[falls[0] + 1]:g} after {t[falls[0]]:g}" if len(falls) else f"{t[~np.isfinite(t)][0]:g}"
        raise InputError(f"{name} have the time {where}, but increasing times are expected")
    if np.any(np.isinf(values)):
        j, i = np.argwhere(np.isinf(values))[0]
        raise InputError(f"{name} have {values[j, i]:g} at {samples.point(j, i)}, but finite numbers, or NaN for a gap, are expected")


def _places_of_markers(samples, parameters, length, name):
    """Places of the markers on the body, and their standard deviation [length]."""
    wanted, x, free = str(parameters["Fit/Markers at"]).strip(), samples.values, parameters["Fit/Place deviation"]
    if wanted == "first":
        whole = ~np.isnan(x[0])
        if not np.all(whole):
            raise InputError(f'marker {samples.names[int(np.argmin(whole))] if samples.names else int(np.argmin(whole)) + 1} of {name} is '
                             "missing in the first frame, but Fit/Markers at = first needs all; a list of places is expected")
        span = x[0, -1] - x[0, 0]
        if abs(span / length - 1) > CLOSE:
            raise InputError(f"the outermost markers of {name} are {span:g} apart in the first frame, but Fit/Markers at = first expects them "
                             f"at the ends of the body, whose Body/Length is {length:g}; a list of places, or \"--unit-of-s\", is expected")
        return (x[0] - x[0, 0]) * length / span, math.inf if free == "automatic" else float(free)
    places = []
    for word in wanted.split(","):
        try:
            places.append(float(word))
        except ValueError:
            raise InputError(f'"Fit/Markers at" is "{wanted}", but "first" or a list of numbers is expected') from None
    if len(places) != x.shape[1]:
        raise InputError(f'"Fit/Markers at" has {len(places)} places, but {name} has {x.shape[1]} marker{"s" * (x.shape[1] != 1)}')
    if any(not math.isfinite(one) or not 0 <= one <= length for one in places) or any(np.diff(places) <= 0):
        raise InputError(f'"Fit/Markers at" is "{wanted}", but increasing places from 0 to Body/Length = {length:g} are expected')
    return np.array(places), 0.0 if free == "automatic" else float(free)
