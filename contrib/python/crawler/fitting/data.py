# SPDX-License-Identifier: LGPL-2.1-or-later
"""What was measured, as a fit compares it with a run."""
import dataclasses
import math
import os

import numpy as np

from ..measured.samples import Samples, read_samples
from ..needs import FileError, InputError

CLOSE = 0.02  # outermost markers are at the ends of the body, but for this part of its length


@dataclasses.dataclass
class Data:
    """Numbers over time, and perhaps places; a gap is NaN.

    kind: "markers", the x of markers [length]; "strain" [1]; "centre", the x of the centre of mass [length]; or "speed", of
    that [length/time]. t: times of the run [time], increasing; places: on the body [length], of markers and strain, else empty;
    values: array [time, place]. deviation: the standard deviation of a number, None if it is not known; relative: that of each number over
    this one, [time, place], 1 where all have the same. has_origin: is x of the
    run known where the data count it from? place_deviation: of the places of markers [length]; 0: they are known, inf: they are
    free. names: of the places. notes: sentences on what a file has in another order.
    """
    kind: str
    t: np.ndarray
    places: np.ndarray
    values: np.ndarray
    deviation: float = None
    has_origin: bool = True
    place_deviation: float = 0.0
    names: list = dataclasses.field(default_factory=list)
    notes: list = dataclasses.field(default_factory=list)
    relative: np.ndarray = None

    def __post_init__(self):
        self.relative = np.ones(self.values.shape) if self.relative is None else self.relative

    @property
    def is_there(self):
        """[time, place]: was something measured?"""
        return ~np.isnan(self.values)

    @property
    def n_constants(self):
        """How many numbers are free besides the variables: the origin, and places."""
        return (not self.has_origin) + (len(self.places) if self.place_deviation == math.inf else 0)

    def nuisance(self, stretch):
        """How data [datum] change with the origin and the place of each marker, columns; and the rows that hold places fast.
        A marker at s + d instead of s is at x + w d."""
        columns = []
        if not self.has_origin:
            columns.append(np.ones(self.values.shape))
        if self.place_deviation > 0:
            for i in range(len(self.places)):
                one = np.zeros(self.values.shape)
                one[:, i] = stretch[:, i]
                columns.append(one)
        matrix = np.array([one[self.is_there] for one in columns]).T.reshape(int(self.is_there.sum()), len(columns))
        if not 0 < self.place_deviation < math.inf:
            return matrix, np.zeros((0, len(columns)))
        return matrix, np.eye(len(self.places), len(columns), k=len(columns) - len(self.places)) / self.place_deviation


def read_data(data, parameters, **reading):
    """The Data of a file or of Samples, as section Fit of a scene says.

    data: a name, or Samples. parameters: all entries of the scene. reading: options
    of measured.read_samples(). Raises InputError, also for a file that cannot be read, as for those of other entries.
    """
    if not isinstance(data, (str, os.PathLike, Samples)):
        raise InputError(f"the data are of the type {type(data).__name__}, but the name of a file or measured.Samples(quantity, s, t, values) is expected")
    try:
        samples = data if isinstance(data, Samples) else read_samples(data, **reading)
    except FileError as error:
        raise InputError(str(error)) from None
    kind = {"x": "markers", "strain": "strain", "centre": "centre", "speed": "speed"}.get(samples.quantity)
    name = "the data" if isinstance(data, Samples) else f'"{data}"'
    _require_sound(samples, name)
    if kind is None:
        raise InputError(f"{name} has samples of {samples.quantity}, but markers, strain, or columns t and centre or speed are expected")
    length, end = parameters["Body/Length"], parameters["Time/End time"]
    places, free = np.array(samples.s, dtype=float), 0.0
    if kind == "markers":
        places, free = _places_of_markers(samples, parameters, length, name)
    elif kind in ("centre", "speed"):
        places = np.empty(0)
    elif places[0] < 0 or places[-1] > length * (1 + 1e-9):
        raise InputError(f"{name} has strain from s = {places[0]:g} to {places[-1]:g}, but places from 0 to Body/Length = {length:g} are "
                         "expected; see \"--unit-of-s\" and \"--shift-s\"")
    first = parameters["Fit/First time"]
    t = samples.t if first == "automatic" else samples.t - samples.t[0] + float(first)
    if t[0] < -1e-9 * end or t[-1] > end * (1 + 1e-9):
        raise InputError(f"{name} has times from {t[0]:g} to {t[-1]:g} of the run, but from 0 to Time/End time = {end:g} are expected; see "
                         "Fit/First time and \"--unit-of-t\"")
    deviation, relative = _deviation_of(samples, parameters["Fit/Standard deviation"], name)
    if 0 < free < math.inf and deviation is None:
        raise InputError('"Fit/Place deviation" is set, but not "Fit/Standard deviation", without which the two cannot be weighed; it is expected')
    return Data(kind, np.clip(t, 0, end), np.clip(places, 0, length), samples.values, deviation,
                kind not in ("markers", "centre") or parameters["Fit/Origin"] != "unknown", free, list(samples.names), list(samples.notes), relative)


def _deviation_of(samples, wanted, name):
    """That of all numbers and, [time, place], that of each over it; (None, None) if it is not known. wanted: Fit/Standard deviation."""
    if samples.deviation is None:
        return (None if wanted == "automatic" else float(wanted)), None
    if wanted != "automatic":
        raise InputError(f'"Fit/Standard deviation" is {wanted:g}, but {name} have a deviation for each number; one of the two is expected')
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
        where = f"{t[falls[0] + 1]:g} behind {t[falls[0]]:g}" if len(falls) else f"{t[~np.isfinite(t)][0]:g}"
        raise InputError(f"{name} have the time {where}, but times that ascend are expected")
    if np.any(np.isinf(values)):
        j, i = np.argwhere(np.isinf(values))[0]
        place = f"marker {samples.names[i] if samples.names else i + 1}, " if samples.quantity == "x" else f"s = {samples.s[i]:g}, " if values.shape[1] > 1 else ""
        raise InputError(f"{name} have {values[j, i]:g} at {place}t = {t[j]:g}, but finite numbers, or NaN for a gap, are expected")


def _places_of_markers(samples, parameters, length, name):
    """Where the markers are on the body, and the standard deviation of that [length]."""
    wanted, x, free = str(parameters["Fit/Markers at"]).strip(), samples.values, parameters["Fit/Place deviation"]
    if wanted == "first":
        whole = ~np.isnan(x[0])
        if not np.all(whole):
            raise InputError(f'marker {samples.names[int(np.argmin(whole))] if samples.names else int(np.argmin(whole)) + 1} of {name} is not '
                             "there in the first frame, but Fit/Markers at = first needs all; a list of places is expected")
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
        raise InputError(f'"Fit/Markers at" has {len(places)} places, but {name} has {x.shape[1]} markers')
    if any(not math.isfinite(one) or not 0 <= one <= length for one in places) or any(np.diff(places) <= 0):
        raise InputError(f'"Fit/Markers at" is "{wanted}", but growing places from 0 to Body/Length = {length:g} are expected')
    return np.array(places), 0.0 if free == "automatic" else float(free)
