# SPDX-License-Identifier: LGPL-2.1-or-later
"""Units of a path or speed: data that are far from all runs within the ranges of the variables are in other ones."""
import numpy as np

from ..needs import InputError
from .data import WORDS

FAR = 8.0  # ratio of data and runs beyond which the units differ, as no values that were tried come near
CORNERS = 8  # random corners of the ranges that are tried besides the ends of each variable


def require_units(model):
    """Raises InputError if a path or speed is much larger, or much smaller, than in a run at the start, at either end of
    each range, and in corners of them. Returns sentences on those that are far from the one at the start only."""
    notes, paths = [], [i for i, one in enumerate(model.data.series) if one.kind in ("centre", "speed")]
    if not paths:
        return notes
    random = np.random.default_rng(1)
    points = [model.start, *(np.where(np.arange(len(model.names)) == j, end, model.start) for end in (model.low, model.high) for j in range(len(model.names))),
              *(np.where(random.random(len(model.names)) < 0.5, model.low, model.high) for _ in range(CORNERS if len(model.names) > 1 else 0))]
    runs = [model.data.grids(values) for values in (model(point)[0] for point in points)]
    is_whole = [all(np.all(np.isfinite(values[one.is_there])) for values, one in zip(run, model.data.series)) for run in runs]
    runs = [run for run, is_kept in zip(runs, is_whole) if is_kept]
    for i in paths if is_whole[0] else ():
        one = model.data.series[i]
        sizes = [_size(one.kind, run[i], 0) for run in runs]
        noise = _noise(one)
        least, most = (_size(one.kind, one.values, sign * noise) for sign in (1, -1))
        for is_off, size, near in ((least > FAR * max(sizes), least, max(sizes)), (most * FAR < min(sizes), most, min(sizes))):
            if is_off and near > 0 and sizes[0] > 0:
                short = "".join(f"; {note}" for note in model.data.notes if note.startswith("the data last"))
                raise InputError(f"{WORDS[one.kind]} {_verb(one.kind)} {size:.3g} in the data (root mean square), {_times(size / sizes[0])} {sizes[0]:.3g} with the "
                                 f"values of the scene, and no run within the ranges of Fit/Variables comes near (nearest: {near:.3g}); the same units of "
                                 f'length and time are expected in data and scene, see "--unit-of-s" and "--unit-of-t"{short}')
        size = _size(one.kind, one.values, 0)
        if not noise * FAR < size or not sizes[0] > 0 or 1 / FAR < size / sizes[0] < FAR:
            continue
        notes.append(f"{WORDS[one.kind]} {_verb(one.kind)} {size:.3g} in the data (root mean square), {_times(size / sizes[0])} {sizes[0]:.3g} with the values of the "
                     'scene: see "--unit-of-s" and "--unit-of-t" if that is not meant')
    return notes


def _verb(kind):
    return "varies by" if kind == "centre" else "is"


def _size(kind, values, noise):
    """Root mean square of a speed, or of a path about its mean, without the noise; a negative one is added."""
    there = values[~np.isnan(values)]
    squares = np.mean((there - (np.mean(there) if kind == "centre" else 0)) ** 2)
    return float(np.sqrt(max(squares - np.copysign(noise ** 2, noise), 0))) if noise else float(np.sqrt(squares))


def _noise(one):
    """Standard deviation of a datum, from second differences if it is not known."""
    if one.deviation:
        return one.deviation
    values = one.values[~np.isnan(one.values)]
    return float(np.sqrt(np.mean(np.diff(values, 2) ** 2) / 6)) if len(values) > 2 else 0.0


def _times(ratio):
    if ratio > 1:
        return f"about {ratio:.2g} times the"
    return f"about 1/{1 / ratio:.2g} of the" if ratio > 0 else "beside the"
