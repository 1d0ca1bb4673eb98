# SPDX-License-Identifier: LGPL-2.1-or-later
"""Preparation of full tables from samples with gaps and noise: gaps filled, noise smoothed, cycles averaged, tracks
turned into strain."""
import dataclasses
import math

import numpy as np
from scipy.optimize import minimize_scalar

from ..arguments import checked
from ..needs import InputError
from .samples import LEAST, Samples
from .settings import Settings
from .splines import SmoothingSpline, periodic_spline
from .units import number_of

MOST_POINTS = 20000000  # points of a table
MUCH_OF_NOISE, MUCH_SCATTER, LEAST_CYCLES, LEAST_PHASES, LEAST_REMAINDERS, USUAL_PLACES, MOST_LAGS = 5, 1.5, 1.25, 8, 8, 33, 65536


@dataclasses.dataclass
class Table:
    """Table for a scene: quantity "m" or "strain", places s, times t, full values [time, place]; the period (or None),
    of which the last samples are the first ones; the noise of a sample; and the changes in words."""
    quantity: str
    s: np.ndarray
    t: np.ndarray
    values: np.ndarray
    period: float
    noise: float
    words: list


@dataclasses.dataclass
class _Filled:
    """Record of filled values, and of the part that the smoothing has removed."""
    n: int = 0
    longest: int = 0
    along_body: np.ndarray = 0  # number at each place, filled from the places beside
    largest: float = 0.0        # largest of the samples
    square: float = 0.0
    n_samples: int = 0

    def count(self, runs):
        self.n += sum(runs)
        self.longest = max([self.longest, *runs])

    def see_change(self, samples, curves):
        """Records the change of samples by the smoothing; NaN where there are none."""
        there = ~np.isnan(samples) & ~np.isnan(curves)
        self.square += np.sum((samples - curves)[there]**2)
        self.n_samples += there.sum()
        self.largest = max(self.largest, np.max(np.abs(samples[there]), initial=0))


@checked
def estimated_noise(samples: Samples) -> float:
    """Standard deviation of the noise of samples, from the residuals of polynomials through neighbours in time. Smooth
    waves leave less residual with more neighbours, but noise the same: the smallest of orders 3 to 8 is taken."""
    found = []
    for order in range(3, 9):
        if found and (len(samples.t) - order) * len(samples.s) < LEAST_REMAINDERS:
            break
        t = np.lib.stride_tricks.sliding_window_view(samples.t, order + 1)
        gaps = t[:, :, None] - t[:, None, :] + np.eye(order + 1)
        weights = 1 / np.prod(gaps / np.mean(np.diff(t, axis=1), axis=1)[:, None, None], axis=2)  # divided differences
        weights /= np.sqrt(np.sum(weights**2, axis=1, keepdims=True))
        values = np.lib.stride_tricks.sliding_window_view(samples.values, order + 1, axis=0)
        rest = np.einsum("jik,jk->ji", values, weights)
        if not found or np.sum(~np.isnan(rest)) >= LEAST_REMAINDERS:
            found.append(np.sqrt(np.nanmean(rest**2)) if np.any(~np.isnan(rest)) else 0.0)
    return float(min(found))


@checked
def prepare(samples: Samples, settings: Settings, period: float | None = None) -> Table:
    """Makes the Table of Samples. @p period: one that is known already. Raises InputError where a gap is too large,
    where there is no period, and where its ends differ by more than the noise."""
    samples = _on_a_grid(samples)
    settings, is_known = settings.in_words(period), period is not None
    if samples.quantity not in ("m", "strain", "x", "centre", "speed"):
        raise InputError(f'the quantity of the samples is "{samples.quantity}", but "m", "strain", "x", "centre" or "speed" is expected')
    if samples.quantity in ("centre", "speed"):
        raise InputError(f'the samples are the {"path" if samples.quantity == "centre" else samples.quantity} of the centre of mass, which "crawler fit" reads, '
                         "but samples of m or strain, or markers, are expected for a table")
    if len(samples.s) < LEAST or len(samples.t) < LEAST:
        raise InputError(f'there are {len(samples.s)} different {"markers" if samples.quantity == "x" else "places s"} and {len(samples.t)} '
                         f"different times, but at least {LEAST} of each are expected for a table")
    if samples.quantity != "x":
        settings.require_for_markers()
    words, filled = [], _Filled()
    _require_steps(samples.t, settings.gap)
    measured, is_tracks = samples, samples.quantity == "x"
    if is_tracks:
        tracks = _filled_in_time(measured, 0, settings.gap, _Filled(), is_smoothed=False)
        frames = _frames_without_ragged_ends(tracks, settings.gap, words)
        tracks = dataclasses.replace(tracks, t=tracks.t[frames], values=tracks.values[frames])
        tracks = _filled_along_body(tracks, measured, settings.gap, _Filled())
        samples = strain_of_tracks(tracks, settings, words)
        for marker in measured.values[frames].T:
            filled.count([end - begin for begin, end in _gaps_in(~np.isnan(marker))])
    spread = estimated_noise(samples) if is_tracks or settings.noise is None else settings.noise
    noise = settings.noise if settings.noise is not None else estimated_noise(measured)
    if settings.period:
        full = _without_gaps(samples, settings.smooth_t, settings.gap, _Filled()) if settings.period == "find" else samples
        period = _period_of(full, settings.period, words)
        if is_tracks:
            words.append(_motion(tracks, period))
        table = _one_period(samples, settings, period, spread, words, filled, is_known)
    else:
        table = _without_gaps(samples, settings.smooth_t, settings.gap, filled)
    points_t = 0 if settings.period else settings.points_t
    points_s, smooth_s = (0, 0) if is_tracks else (settings.points_s, settings.smooth_s)
    table = _resampled(table, smooth_s, points_s, points_t)
    if is_tracks and np.any(table.values <= -1):
        j, i = np.argwhere(table.values <= -1)[0]
        raise InputError(f"the tracks give the strain {table.values[j, i]:g} at s = {table.s[i]:g}, t = {table.t[j]:g}, where the body would have no "
                         'length; other smoothing ("--smooth-s", "--smooth-t") is needed, or markers are misplaced ("--confidence") or mixed up')
    if is_tracks and settings.markers_at == "first" and not settings.period:
        # Zero strain is the shape in the first frame, after the smoothing, too.
        table.values = (1 + table.values) / (1 + table.values[0]) - 1
    if settings.period:
        n = len(table.t) - 1
        if n * settings.cycles * len(table.s) > MOST_POINTS:
            raise InputError(f"{settings.cycles} cycles are {n * settings.cycles} times at {len(table.s)} places, but at most {MOST_POINTS} "
                             "points of a table are expected; a table may be periodic (Outside = periodic)")
        table.t = np.concatenate([table.t[:1], *(table.t[1:] + k * (table.t[-1] - table.t[0]) for k in range(settings.cycles))])
        table.values = np.concatenate([table.values[:1], *[table.values[1:]] * settings.cycles])
    _say_what_changed(settings, filled, spread, samples.s, words)
    if table.quantity == "strain" and table.t[0] != 0:
        words.append(f"t shifted by {-table.t[0]:g}, since a prescribed strain begins at t = 0")
        table.t = table.t - table.t[0]
    return Table(table.quantity, table.s, table.t, table.values, period, noise, words)


def _motion(tracks, period):
    """Describes how far the middle of the markers moves in a period: the slope of the line through all times."""
    slope = np.polyfit(tracks.t - tracks.t[0], tracks.values.mean(axis=1), 1)[0]
    return f"the mean of the markers moves by {slope * period:.4g} a period (towards the head: positive)"


def _on_a_grid(samples):
    """Samples with arrays s [place], t [time] and values [time, place]. Raises InputError for others."""
    try:
        samples = dataclasses.replace(samples, **{name: np.asarray(getattr(samples, name), dtype=float) for name in ("s", "t", "values")})
    except (TypeError, ValueError):
        raise InputError("the samples have s, t or values that are no arrays of numbers, but those are expected") from None
    shapes = [one.shape for one in (samples.s, samples.t, samples.values)]
    if shapes[2] != shapes[1] + shapes[0] or len(shapes[0]) != 1 or len(shapes[1]) != 1:
        raise InputError(f"the samples have s, t and values of the shapes {', '.join(map(str, shapes))}, but (place,), (time,) and (time, place) are expected")
    if not (np.all(np.isfinite(samples.s)) and np.all(np.isfinite(samples.t)) and not np.any(np.isinf(samples.values))):
        raise InputError("the samples have places, times or values that are not finite, but only gaps of values (NaN) may be there")
    if np.any(np.diff(samples.s) <= 0) or np.any(np.diff(samples.t) <= 0):
        raise InputError("the samples have places s or times t that do not increase, but increasing ones are expected")
    return samples


def strain_of_tracks(tracks: Samples, settings: Settings, words: list[str]) -> Samples:
    """Strain dx/ds - 1 of tracks x_i(t) without gaps, at equally spaced places over the body, by a spline over the
    material coordinates of the markers for each time. Raises InputError."""
    s = _material_coordinates(tracks, settings)
    wrong = np.flatnonzero(np.diff(s) <= 0)
    if len(wrong):
        raise InputError(f"the marker {tracks.names[wrong[0]]} lies at s = {s[wrong[0]]:g} and the next one at s = {s[wrong[0] + 1]:g}, "
                         "but markers that follow each other along the body are expected")
    length = s[-1] if settings.length is None else settings.length
    if s[0] < 0 or s[0] >= length or s[-1] > length * (1 + 1e-9):
        raise InputError(f'the markers lie from s = {s[0]:g} to {s[-1]:g}, but the body from 0 to {length:g}; see "--first-marker" and '
                         '"--length"')
    places = np.linspace(0, length, settings.points_s or USUAL_PLACES)
    inside = np.clip(places, s[0], s[-1])
    curves = SmoothingSpline(s, (tracks.values - s).T, settings.smooth_s)
    strain = curves(inside, 1).T
    if settings.ends == "linear":
        strain += (places - inside) * curves(np.where(places < inside, s[0], s[-1]), 2).T
    deformed = "; in a film of cycles it may be deformed, see \"--markers-at mean\"" if settings.period else ""
    how = {"first": f"from the first frame, which is taken as a body without strain{deformed}", "mean": "from the mean of frames"}.get(
        settings.markers_at, "as given")
    words.append(f"strain of {len(s)} markers at s = {s[0]:g} to {s[-1]:g} ({how}), at {len(places)} places of a body of length "
                 f"{length:.10g}")
    if s[0] > 0 or s[-1] < length * (1 - 1e-9):
        words.append(f"beyond the outermost markers, over {s[0]:g} at the tail and {max(0, length - s[-1]):g} at the head, the strain "
                     f"{'is held' if settings.ends == 'hold' else 'continues linearly'}")
    return Samples("strain", places, tracks.t, strain)


def _material_coordinates(tracks, settings):
    if settings.markers_at in ("first", "mean"):
        n = 1 if settings.markers_at == "first" else _whole_cycles(tracks, settings.period)
        s = tracks.values[:n].mean(axis=0)
        return s - s[0] + settings.first_marker
    numbers = [number if number is not None and math.isfinite(number) else None for number in map(number_of, settings.markers_at.split(","))]
    if None in numbers:
        wrong = settings.markers_at.split(",")[numbers.index(None)]
        raise InputError(f'"--markers-at" has "{wrong}", but "first", "mean" or a list of {len(tracks.s)} numbers is expected')
    if len(numbers) != len(tracks.s):
        raise InputError(f'"--markers-at" has {len(numbers)} numbers, but there are {len(tracks.s)} markers, and one for each is '
                         "expected")
    return np.array(numbers)


def _whole_cycles(tracks, wanted):
    """Number of frames in the largest number of whole cycles; all frames if there is no period."""
    shape = dataclasses.replace(tracks, values=tracks.values - tracks.values.mean(axis=1, keepdims=True))
    duration = tracks.t[-1] - tracks.t[0]
    period = duration if wanted == "whole" else find_period(shape) if wanted == "find" else number_of(wanted)
    if not period or not 0 < period <= duration:
        return len(tracks.t)
    return int(np.searchsorted(tracks.t, tracks.t[0] + period * (math.floor(duration / period + 1e-9) - 1e-6)))


def _require_steps(t, most):
    steps = np.diff(t)
    usual = np.median(steps)
    j = int(np.argmax(steps))
    if steps[j] > (most + 1.5) * usual:
        raise InputError(f"from t = {t[j]:.10g} to {t[j + 1]:.10g} there are no samples, {steps[j] / usual:.3g} times the usual step, "
                         f'but at most {most} missing samples are filled ("--gap")')


def _gaps_in(is_there):
    """Runs of missing samples: pairs of the first one and that behind the last."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], ~is_there, [0]])))
    return list(zip(edges[::2], edges[1::2]))


class _Series:
    """Place over time (or all places at a time): a spline through the samples that exist, NaN in gaps that are too
    large to be filled."""

    def __init__(self, t, y, width, most, filled):
        is_there = ~np.isnan(y)
        self.holes, runs, near = [], [], 0.05 * np.median(np.diff(t))
        for begin, end in _gaps_in(is_there):
            if begin == 0 or end == len(t) or end - begin > most:
                self.holes.append((t[begin - 1] + near if begin else -math.inf, t[end] - near if end < len(t) else math.inf))
            else:
                runs.append(end - begin)
        self.curve = None
        if is_there.sum() >= LEAST:
            filled.count(runs)
            knots, values = t[is_there], y[is_there]
            self.curve = SmoothingSpline(knots, values, width)
            filled.see_change(values, self.curve(knots))

    def __call__(self, t):
        t = np.asarray(t, dtype=float)
        y = self.curve(t) if self.curve else np.full(t.shape, np.nan)
        for begin, end in self.holes:
            y = np.where((t > begin) & (t < end), np.nan, y)
        return y


def _without_gaps(samples, width, most, filled):
    """Samples with all gaps filled, those in time first, and smoothed with the width."""
    return _filled_along_body(_filled_in_time(samples, width, most, filled), samples, most, filled)


def _filled_in_time(samples, width, most, filled, is_smoothed=True):
    """Samples with gaps filled from the times before and after; smoothed with the width if requested."""
    values = samples.values.copy()
    whole = ~np.any(np.isnan(values), axis=0)
    if whole.any() and is_smoothed:
        values[:, whole] = SmoothingSpline(samples.t, samples.values[:, whole], width)(samples.t)
        filled.see_change(samples.values[:, whole], values[:, whole])
    for i in np.flatnonzero(~whole):
        found = _Series(samples.t, samples.values[:, i], width, most, filled)(samples.t)
        values[:, i] = np.where(~np.isnan(found) & (is_smoothed | np.isnan(values[:, i])), found, values[:, i])
    return dataclasses.replace(samples, values=values)


def _filled_along_body(samples, measured, most, filled):
    """Samples with the remaining gaps filled from the places beside. Raises InputError if these do not suffice."""
    values = samples.values.copy()
    filled.along_body = filled.along_body + np.isnan(values).sum(axis=0)
    for j in np.flatnonzero(np.any(np.isnan(values), axis=1)):
        if samples.quantity != "x":
            values[j] = np.where(np.isnan(values[j]), _Series(samples.s, values[j], 0, most, filled)(samples.s), values[j])
        if np.any(np.isnan(values[j])):
            _refuse_gap(measured, int(np.argmax(np.isnan(values[j]))), samples.t[j], most)
    return dataclasses.replace(samples, values=values)


def _refuse_gap(samples, i, t, most):
    """Raises InputError with the place of a gap that cannot be filled: the one in the measured samples next to the time
    t."""
    gaps = _gaps_in(~np.isnan(samples.values[:, i]))
    begin, end = min(gaps, key=lambda gap: np.abs(samples.t[gap[0]:gap[1]] - t).min())
    is_marker = samples.quantity == "x"
    where = (f"{samples.quantity} is missing at {f'marker {samples.names[i]}' if is_marker else f's = {samples.s[i]:g}'} "
             f"from t = {samples.t[begin]:g} to {samples.t[end - 1]:g}")
    if begin == 0 or end == len(samples.t):
        raise InputError(f"{where}, the {'beginning' if begin == 0 else 'end'} of the samples, but only what lies between measured ones "
                         "is filled; without these times, or without this place, the rest can be read")
    raise InputError(f"{where}, {end - begin} sample{'s' if end - begin > 1 else ''} in a row, but at most {most} between measured ones "
                     'are filled ("--gap"), in time or else along the body')


def _frames_without_ragged_ends(tracks, most, words):
    """Frames from the first to the last one with all markers, as a slice; it leaves out at most @p most at an end."""
    complete = ~np.any(np.isnan(tracks.values), axis=1)
    begin, end = 0, len(tracks.t)
    while begin + LEAST < end and begin < most and not complete[begin]:
        begin += 1
    while begin + LEAST < end and len(tracks.t) - end < most and not complete[end - 1]:
        end -= 1
    n = len(tracks.t) - (end - begin)
    if n:
        words.append(f"{n} frame{'s' if n > 1 else ''} at the beginning or end left out, in which markers are missing")
    return slice(begin, end)


@checked
def find_period(samples: Samples) -> float | None:
    """Shortest time after which samples without gaps repeat, by the mean square difference of the samples and later
    ones; the duration must be at least 1.25 times as long. None if nothing repeats."""
    samples = _on_a_grid(samples)
    if np.any(np.isnan(samples.values)):
        raise InputError("the samples have gaps, but a period is found in samples without them")
    begin, duration = samples.t[0], samples.t[-1] - samples.t[0]
    curves = SmoothingSpline(samples.t, samples.values, 0)
    n = min(4 * (len(samples.t) - 1), MOST_LAGS)
    y = curves(np.linspace(begin, samples.t[-1], n + 1))
    y = y - y.mean(axis=0)
    variance = np.mean(y**2, axis=0).sum()
    if not variance > 0:
        return None

    def difference(lag):
        t = begin + (duration - lag) * np.linspace(0, 1, min(n, 2048) + 1)
        return np.sum(np.mean((curves(t + lag) - curves(t))**2, axis=0)) / (2 * variance)

    lags = duration / n * np.arange(min(int(n / LEAST_CYCLES) + 2, n))
    squares = np.concatenate([[0], np.cumsum(np.sum(y**2, axis=1))])
    transformed = np.fft.rfft(y, 2 * (n + 1), axis=0)
    products = np.fft.irfft(np.sum(np.abs(transformed)**2, axis=1))[:len(lags)]  # sums of y(t) y(t + lag)
    found = (squares[n + 1] - squares[:len(lags)] + squares[n + 1 - np.arange(len(lags))] - 2 * products) / (
        2 * variance * (n + 1 - np.arange(len(lags))))
    minima = [j for j in range(LEAST, len(lags) - 1) if found[j] <= found[j - 1] and found[j] < found[j + 1]]
    least = min(found[minima], default=math.inf)
    if not least < 0.25:
        return None
    for j in minima:
        best = minimize_scalar(difference, bounds=(lags[j - 1], lags[j + 1]), method="bounded", options={"xatol": 1e-9 * duration})
        if best.fun <= 1.5 * least + 1e-4:
            return _refined_period(float(best.x), difference, float(best.fun), lags[-1], duration)
    return None


def _refined_period(period, difference, least, longest, duration):
    """Refines a period by differences over 2, 4, ... periods, whose error is divided by that number, while they are as small."""
    n = 2
    while (n + 0.25) * period <= longest:
        best = minimize_scalar(difference, bounds=((n - 0.25) * period, (n + 0.25) * period), method="bounded", options={"xatol": 1e-9 * duration})
        if not best.fun <= 1.5 * least + 1e-4:
            break
        period, n = float(best.x) / n, 2 * n
    return period


def _period_of(full, wanted, words):
    """Period from the settings, or the one found."""
    begin, end = full.t[0], full.t[-1]
    if wanted == "whole":
        return end - begin
    if wanted == "find":
        period = find_period(full)
        if period is None:
            raise InputError(f"no period was found from t = {begin:g} to {end:g}, but at least {LEAST_CYCLES} cycles of a motion that "
                             'repeats itself are expected; "--period whole" takes all of it as one cycle')
        words.append(f"period {period:.6g} found, {(end - begin) / period:.3g} cycles")
        return period
    number = number_of(wanted)
    if number is None or not 0 < number < math.inf:
        raise InputError(f'"--period" is "{wanted}", but "find", "whole" or a positive number is expected')
    if number > (end - begin) * (1 + 1e-9):
        raise InputError(f'"--period" is {number:.10g}, but the samples last from t = {begin:g} to {end:g} only, {end - begin:.10g} in all')
    return min(number, end - begin)


def _one_period(samples, settings, period, noise, words, filled, is_known):
    """Averages all cycles at equal phases to one period. is_known: it need not show in these samples."""
    begin, end = samples.t[0], samples.t[-1]
    n = settings.points_t - 1 if settings.points_t else max(LEAST_PHASES, round(period / np.median(np.diff(samples.t))))
    phases = begin + period * np.arange(n) / n
    t = phases + period * np.arange(math.floor((end - begin) / period + 1e-9) + 1)[:, np.newaxis]
    t = np.where(t <= end + 1e-9 * period, np.minimum(t, end), np.nan)
    cycles = np.full((*t.shape, len(samples.s)), np.nan)  # [cycle, phase, place]
    for i in range(len(samples.s)):
        cycles[:, :, i] = np.where(np.isnan(t), np.nan, _Series(samples.t, samples.values[:, i], 0, 0, _Filled())(np.nan_to_num(t)))
    counts = np.sum(~np.isnan(cycles), axis=0)
    means = np.where(counts > 0, np.nansum(cycles, axis=0) / np.maximum(counts, 1), np.nan)
    if not is_known:
        _require_agreement(samples, cycles - means, counts, period, noise, words)
    values = np.full((n + 1, len(samples.s)), np.nan)
    table_t = np.append(phases, begin + period)
    for i in range(len(samples.s)):
        curve = _periodic_series(phases, period, means[:, i], counts[:, i], settings, filled)
        values[:, i] = curve(table_t)
        filled.see_change(samples.values[:, i], curve(samples.t))
    table = _filled_along_body(Samples(samples.quantity, samples.s, table_t[:-1], values[:-1]), samples, settings.gap, filled)
    return Samples(samples.quantity, samples.s, table_t, np.concatenate([table.values, table.values[:1]]))


def _periodic_series(phases, period, means, counts, settings, filled):
    """Periodic spline through the means of a place, NaN in gaps that are too large to be filled."""
    is_there = ~np.isnan(means)
    if is_there.sum() < LEAST:
        return lambda t: np.full(np.shape(t), np.nan)
    n, first = len(phases), int(np.argmax(is_there))
    turned = np.roll(is_there, -first)
    gaps = _gaps_in(turned)
    filled.count([end - begin for begin, end in gaps if end - begin <= settings.gap])
    start = phases[first]
    knots = np.concatenate([start + period / n * np.flatnonzero(turned), [start + period]])
    holes = [(start + period / n * (begin - 1), start + period / n * end) for begin, end in gaps if end - begin > settings.gap]
    values, weights = (np.append(one[turned], one[turned][0]) for one in (np.roll(means, -first), np.roll(counts, -first)))
    spline = periodic_spline(knots, values, settings.smooth_t, weights / np.mean(weights[:-1]))

    def value(t):
        t = start + np.mod(np.asarray(t) - start, period)
        y = spline(t)
        for begin, end in holes:
            y = np.where((t > begin + 1e-9 * period) & (t < end - 1e-9 * period), np.nan, y)
        return y
    return value


def _require_agreement(samples, rest, counts, period, noise, words):
    """Requires cycles to agree within the noise if there is little more than one, and roughly if there are more."""
    n = np.sum(np.maximum(counts - 1, 0))
    scatter = math.sqrt(np.nansum(np.where(counts > 1, rest, 0)**2) / n) if n else 0.0
    spread, largest = np.nanstd(samples.values), np.nanmax(np.abs(samples.values))
    duration = samples.t[-1] - samples.t[0]
    if duration < LEAST_CYCLES * period and scatter > max(MUCH_OF_NOISE * noise, 1e-9 * largest):
        raise InputError(f"{samples.quantity} at the beginning and the end of the period {period:g} differs by {scatter:.3g} (as a standard "
                         f"deviation), which is more than {MUCH_OF_NOISE} times the noise of {noise:.3g}; another \"--period\", or a "
                         'larger "--noise", is expected')
    if duration >= LEAST_CYCLES * period and scatter > 0.7 * spread:
        raise InputError(f"the cycles of the period {period:g} differ from each other by {scatter:.3g}, nearly as much as all samples "
                         f'({spread:.3g}), so that this is not a period; "--period find" looks for one')
    words.append(f"period {period:.6g} closed: where cycles meet or repeat, {samples.quantity} differs by {scatter:.3g} (its noise "
                 f"is {noise:.3g}), and the mean is taken")
    if n >= LEAST_REMAINDERS and scatter > MUCH_SCATTER * noise:
        words.append("cycles differ by more than this noise does: what differs is not independent from time to time, or the animal changes, "
                     'and an uncertainty from the noise is too small ("--noise" sets a larger one)')


def _resampled(samples, smooth_s, n_s, n_t):
    """Smooths and resamples: equal steps along the body and in time."""
    s = np.linspace(samples.s[0], samples.s[-1], n_s) if n_s else samples.s
    t = np.linspace(samples.t[0], samples.t[-1], n_t) if n_t else samples.t
    values = samples.values
    if n_t:
        values = SmoothingSpline(samples.t, values, 0)(t)
    if n_s or smooth_s > 0:
        values = SmoothingSpline(samples.s, values.T, smooth_s)(s).T
    return Samples(samples.quantity, s, t, values)


def _say_what_changed(settings, filled, noise, places, words):
    if filled.n:
        words.append(f"{filled.n} gap{'s' if filled.n > 1 else ''} filled, up to {filled.longest} in a row")
    along = np.atleast_1d(filled.along_body)
    if along.sum():
        i = int(np.argmax(along))
        words.append(f"of these {along.sum()} along the body, from the places beside them, "
                     f"{'all' if along[i] == along.sum() else along[i]} at s = {places[i]:g}: what was there is a guess")
    widths = [f"{width:g} over {name}" for name, width in (("t", settings.smooth_t), ("s", settings.smooth_s)) if width > 0]
    if widths:
        words.append(f"smoothed by splines with the width {' and '.join(widths)}; waves of this length are halved, those twice as "
                     "long keep 94 %")
    change = math.sqrt(filled.square / filled.n_samples) if filled.n_samples else 0
    if change > 1e-12 * filled.largest:
        words.append(f"samples and table differ in time by {change:.3g} (root mean square), its noise is {noise:.3g}"
                     f"{': more than noise was smoothed away' if change > 2 * noise else ''}")
