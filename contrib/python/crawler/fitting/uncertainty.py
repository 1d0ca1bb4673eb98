# SPDX-License-Identifier: LGPL-2.1-or-later
"""Information of the data on each variable: covariance, undetermined combinations, and intervals by profile likelihood.

Seber and Wild, Nonlinear Regression (1989), chapters 3 and 5. Variables are scaled to their ranges here, [0, 1] each, and
residuals by the standard deviation of the data.
"""
import contextlib
import math

import numpy as np
from scipy import stats
from scipy.optimize import least_squares

from ..needs import Failed

WIDE = 0.5          # standard deviation in ranges beyond which a value is undetermined
PART = 0.01         # part of a direction beyond which a variable may belong to it
LEVELS = {"interval_68": 1.0, "interval_95": 1.959963984540054}  # standard deviations of a normal distribution
STEP = 0.5          # step of second differences, in standard deviations
FAR = 2.0           # standard deviations at which the profile is evaluated
ROUGH = 0.25        # relative difference of a profile from a parabola beyond which it is followed further
CURVE = 11          # points on one side of a profile that is nearly a parabola
MOST_LOOKS = 15     # most evaluations on one side of a profile


def undetermined_directions(jacobian):
    """Directions in which the variables may change by more than WIDE of their ranges within one standard deviation:
    [direction, variable], and which variables belong to each: [direction, variable]. A variable belongs to a direction
    that causes most of its deviation; a direction without any, whose variables all belong to looser ones, is left out."""
    _, sizes, directions = np.linalg.svd(jacobian, full_matrices=True)
    sizes = np.maximum(np.concatenate([sizes, np.zeros(directions.shape[0] - len(sizes))]), 1e-9 * sizes.max(initial=1.0))
    deviations = np.abs(directions) / sizes[:, None]  # deviations of variables, by each direction
    members = (np.abs(directions) > PART) & (deviations >= np.minimum(0.5 * np.linalg.norm(deviations, axis=0), deviations.max(axis=0)))
    loose = (sizes < max(1 / WIDE, 1e-8 * sizes.max())) & members.any(axis=1)
    return directions[loose], members[loose]


def covariance(jacobian):
    """Covariance of the variables, by Gauss and Newton. Along an undetermined direction it is that of a range, so that
    the round-off of the direction is none of the deviation of a variable that does not belong to it."""
    _, sizes, directions = np.linalg.svd(jacobian, full_matrices=False)
    return (directions.T / np.maximum(sizes, 1.0) ** 2) @ directions


def curvature_bias(change, jacobian, z):
    """Bias of the best values in the mean, to second order [variable] (Box, J. R. Stat. Soc. B 33, 171, 1971):
    -(J'J)^-1 J'c/2, where c has the second differences of the model along the axes of the covariance. NaN if there is
    no run, a value is at its limit, or some direction is undetermined.

    change(x): change of the model from z to x, as scaled residuals; jacobian: at z.
    """
    inverse, curvature = covariance(jacobian), np.zeros(len(jacobian))
    sizes, axes = np.linalg.eigh(inverse)
    if sizes[-1] > WIDE ** 2:
        return np.full(len(z), math.nan)
    for step in (axes * np.sqrt(np.maximum(sizes, 0))).T:
        part = min(STEP, *(0.9 * np.minimum(z, 1 - z) / np.maximum(np.abs(step), 1e-300)))  # within the ranges
        if part < 0.1 * STEP:
            return np.full(len(z), math.nan)
        curvature += (change(z + part * step) + change(z - part * step)) / part ** 2
    return -0.5 * inverse @ (jacobian.T @ curvature)


def in_words(direction, members, names, values, widths):
    """Describes in a sentence which variables may change together without a change of the data."""
    change = direction * widths
    parts = [(name, dx, value) for name, dx, value, is_part in zip(names, change, values, members) if is_part]
    if len(parts) == 1:
        return f"the data do not determine {parts[0][0]}: they fit as well with any value in its range"
    relative = [dx / value if value else math.inf for _, dx, value in parts]
    if np.all(np.isfinite(relative)) and max(map(abs, relative)) < 1e3 * min(map(abs, relative)):
        first = relative[0]
        changes = [f"{name} by {ratio / first:+.3g} %" for (name, _, _), ratio in zip(parts, relative)]
    else:
        first = parts[0][1]
        changes = [f"{name} by {dx / first:+.3g}" for name, dx, _ in parts]
    if all(abs(ratio / relative[0] - 1) < 0.02 for ratio in relative):
        return f"the data determine {_and([name for name, _, _ in parts])} only up to a common factor: their ratios, but not their sizes"
    return f"the data do not tell {_and([name for name, _, _ in parts])} apart: changed together ({', '.join(changes)}) they fit as well"


def _and(names):
    return f"{', '.join(names[:-1])} and {names[-1]}"


class Profile:
    """Least chi-square with one variable fixed: found by steps of the others with the derivatives at the best values,
    and, where it is no parabola, by searches."""

    def __init__(self, residuals, jacobian, x, slopes):
        """Constructor. residuals(x), jacobian(x): of scaled residuals, NaN where there is no run; x: the best values;
        slopes: the derivatives there."""
        self.residuals, self.jacobian, self.x, self.slopes = residuals, jacobian, x, slopes
        self.least = float(np.sum(residuals(x) ** 2))

    def interval(self, j, deviation):
        """Intervals {name: [low, high]} in scaled variables for LEVELS; an end is None where the range ends before.
        Also the profile itself: pairs of the variable, increasing, and the rise of chi-square."""
        ends, curve = {name: [None, None] for name in LEVELS}, [(self.x[j], 0.0)]
        for side in (-1, 1):
            reach = (self.x[j] if side < 0 else 1 - self.x[j]) / deviation
            found, points = self._ends(j, side * deviation, reach)
            for name, z in found.items():
                ends[name][(side + 1) // 2] = None if z is None else self.x[j] + side * z * deviation
            curve += [(self.x[j] + side * z * deviation, root ** 2) for z, root in points if 0 < z and root < math.inf]
        return ends, sorted(curve)

    def _ends(self, j, unit, reach):
        """Distances in units at which chi-square has risen by the square of each level, and pairs of units and the root
        of the rise."""
        z = min(FAR, reach)
        root = self._root_near(j, unit, z) if z > 0 else 0.0
        if z == 0 or not abs(root / z - 1) <= ROUGH:
            points = [(0.0, 0.0, self.x)]  # units, root of the rise, values of the variables
            ends = {name: self._searched(level, points, j, unit, reach) for name, level in LEVELS.items()}
            return ends, [point[:2] for point in points]
        a, ends = (root / z - 1) / z, {}  # root of the rise = z (1 + a z)
        for name, level in LEVELS.items():
            ends[name] = level if abs(a * level) < 1e-6 else (math.sqrt(max(1 + 4 * a * level, 0.0)) - 1) / (2 * a)
            ends[name] = None if ends[name] > reach else ends[name]
        return ends, [(one, one * (1 + a * one)) for one in np.linspace(0, min(1.25 * FAR, reach), CURVE)]

    def _guess(self, j, at, x):
        """Guess of the variables with number j fixed at this value, and the others best if residuals change as at the
        best values."""
        others = np.arange(len(x)) != j
        x = x.copy()
        x[others] -= np.linalg.lstsq(self.slopes[:, others], self.slopes[:, j] * (at - x[j]), rcond=1e-9)[0]
        x[j] = at
        return np.clip(x, 0, 1), others

    def _root_near(self, j, unit, z):
        """Root of the rise, by a few steps."""
        x, others = self._guess(j, self.x[j] + z * unit, self.x)
        best, residual = math.inf, self.residuals(x)
        for _ in range(3):
            if not np.all(np.isfinite(residual)):
                break
            before, best = best, min(best, float(residual @ residual))
            small = 0.02 * max(best - self.least, 0.1)
            if not others.any() or before - best < small:
                break
            after = x.copy()
            after[others] = np.clip(x[others] - np.linalg.lstsq(self.slopes[:, others], residual, rcond=1e-9)[0], 0, 1)
            linear = residual + self.slopes @ (after - x)
            if best - linear @ linear < small:  # so near that a run would say the same
                best = float(min(best, linear @ linear))
                break
            x, residual = after, self.residuals(after)
        return math.sqrt(max(best - self.least, 0.0))

    def _guess_between(self, points, j, at, z):
        """Best guess of the variables with number j fixed: by the derivatives, by those of the nearest point, or on a line
        through the two nearest points."""
        (z_near, _, near), *further = sorted(points, key=lambda point: abs(point[0] - z))[:2]
        (by_slopes, others), kept = self._guess(j, at, near), near.copy()
        guesses = [by_slopes, kept, *(near + (near - x) * (z - z_near) / (z_near - other) for other, _, x in further)]
        for guess in guesses:
            guess[j] = at
        guesses = [np.clip(guess, 0, 1) for guess in guesses]
        sums = [float(np.sum(self.residuals(guess) ** 2)) for guess in guesses]
        return guesses[int(np.argmin(np.where(np.isfinite(sums), sums, math.inf)))], others

    def _look(self, points, j, unit, z):
        """Evaluates the profile there, from the nearest point, and adds it; returns its root of the rise."""
        x, others = self._guess_between(points, j, self.x[j] + z * unit, z)
        root = math.inf
        if np.all(np.isfinite(self.residuals(x))):
            def whole(y):
                full = x.copy()
                full[others] = y
                return full
            if others.any():
                with contextlib.suppress(Failed):  # no runs beside it
                    x = whole(least_squares(lambda y: self.residuals(whole(y)), np.clip(x[others], 1e-9, 1 - 1e-9),
                                            lambda y: self.jacobian(whole(y))[:, others], bounds=(0, 1), x_scale="jac",
                                            ftol=1e-3 / len(self.slopes), xtol=1e-6, max_nfev=20).x)
            root = math.sqrt(max(float(np.sum(self.residuals(x) ** 2)) - self.least, 0.0))
        points.append((z, root, x))
        points.sort(key=lambda point: point[0])
        return root

    def _searched(self, level, points, j, unit, reach):
        """Distance at which the root of the rise has this size, between known or new points."""
        for _ in range(MOST_LOOKS):
            above = next((point for point in points if point[1] >= level), None)
            below = [point for point in points if point[1] < level and (above is None or point[0] < above[0])][-1]
            if above is None:
                if below[0] >= reach:
                    return None
                self._look(points, j, unit, min(reach, below[0] + max(0.25, min(level / max(below[1], 0.1), 2.0) * below[0] * 0.5)))
                continue
            if above[0] - below[0] < 0.02 * above[0]:
                break
            part = (level - below[1]) / (min(above[1], 2 * level) - below[1]) if above[1] < math.inf else 0.5
            z = below[0] + (above[0] - below[0]) * min(max(part, 0.1), 0.9)
            if abs(self._look(points, j, unit, z) - level) < 0.02 * level:
                return z
        above = next((point for point in points if point[1] >= level), None)
        return None if above is None else above[0]


def correlation_in_time(residuals):
    """Correlation of residuals [time, place] that are neighbours in time."""
    first, second = residuals[:-1], residuals[1:]
    both = ~np.isnan(first) & ~np.isnan(second)
    n, size = int(both.sum()), float(np.nanmean(residuals ** 2))
    return 0.0 if n < 2 or size == 0 else float(np.mean(first[both] * second[both]) / size)


def probability(chi_square, freedom):
    """Probability of a chi-square at least as large, if the scene is right."""
    return float(stats.chi2.sf(chi_square, freedom))
