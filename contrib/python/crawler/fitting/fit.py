# SPDX-License-Identifier: LGPL-2.1-or-later
"""Search for the best values of the variables of a scene."""
import math

import numpy as np
from scipy.optimize import least_squares

from ..needs import Failed, InputError
from .progress import Progress
from .result import NEAR, SHARE, Best, described, unfinished
from .starts import best_of_starts, table_of_starts
from .uncertainty import covariance, undetermined_directions
from .units import require_units

LARGEST_ACCURACY, LEAST_ACCURACY = 1e-4, 3e-11  # accuracies of runs whose differences are derivatives
MOST_REFINEMENTS = 4
MOST_DESCENTS = 10    # most searches from lower values of chi-square that its profiles have
LOWER = 0.1           # fall of chi-square, or of its mean for a scene that does not fit, beside a minimum that is none of round-off
MOST_STEPS = 1000     # most steps of a search, which takes some hundred along a curved valley
CHANGE = 1e-3         # change of chi-square, with data of known deviation, that ends a search
MOST_MOVES, FAR_PLACE = 6, 1e-3  # for unknown places of markers; the latter in lengths of the body
LEAST_NOISE = 1e-10   # relative to the variation of the data; for data without noise


class Problem:
    """Residuals in scaled variables: 0 to 1 over the ranges, with the deviation of the data, where known, scaled to
    1."""

    def __init__(self, model, data, say=lambda text: None):
        self.model, self.data, self.progress = model, data, Progress(say)
        model.ran = lambda: self.progress.ran(1, self.so_far)
        self.width = model.high - model.low
        units = [one.deviation or float(np.nanstd(one.values - np.nanmean(one.values, axis=0))) or 1.0 for one in data.series]
        self.scales = data.relative * data.flat(units)  # [datum]
        self.scale = units[0] if len(units) == 1 else 1.0  # of reported residuals; in deviations for several kinds
        self.n_rows = len(data.places) if 0 < data.place_deviation < math.inf else 0  # rows that hold places
        self.last = None  # scaled variables, values of the last run, and the basis of the nuisance
        self.least = (math.inf, None, data.places)  # least sum of squares so far, with its scaled variables and places

    def root_mean_square(self, squares):
        """Size of residuals with this sum of squares, in the unit of the data or, for several kinds, in deviations."""
        return math.sqrt(squares / self.data.n) * self.scale

    def so_far(self, squares=None):
        """Least residuals so far, or those of this sum of squares, in words."""
        squares = self.least[0] if squares is None else squares
        return f", residuals {self.root_mean_square(squares):.6g} so far" if squares < math.inf else ""

    def run(self, z):
        """Values of the scene [datum], and an orthonormal basis of the effects of origin and places."""
        if self.last is None or not np.array_equal(self.last[0], z):
            values, stretch = self.model(self.real(z))
            basis = None
            if np.all(np.isfinite(values)):
                matrix, rows = self.data.nuisance(stretch)
                if matrix.shape[1]:
                    basis, sizes, _ = np.linalg.svd(np.vstack([matrix / self.scales[:, None], rows]), full_matrices=False)
                    basis = basis[:, sizes > 1e-9 * sizes[0]]
            self.last = (np.array(z), values, basis)
        return self.last[1:]

    def real(self, z):
        """Values of the variables."""
        return np.clip(self.model.low + np.asarray(z) * self.width, self.model.low, self.model.high)

    def scaled(self, values, basis):
        """Differences [datum] as residuals, without the part that origin and places can absorb; followed by those of
        the places."""
        return self.absorbed(np.concatenate([values / self.scales, np.zeros(self.n_rows)]), basis)

    @staticmethod
    def absorbed(rest, basis):
        """Residuals without the part that origin and places can absorb."""
        return rest if basis is None else rest - basis @ (basis.T @ rest)

    def of_places(self):
        """Residuals of the places that are held: their distances from where they were said to be, in deviations."""
        return (self.data.places - self.data.said_places)[:self.n_rows] / (self.data.place_deviation or 1.0)

    def residuals(self, z):
        """Residuals, one for each datum, and for each place that is held."""
        values, basis = self.run(z)
        residuals = self.absorbed(np.concatenate([(values - self.data.values) / self.scales, self.of_places()]), basis)
        self.see(float(residuals @ residuals), z)
        return residuals

    def see(self, squares, z):
        """Records the least sum of squares."""
        if squares < self.least[0]:
            self.least = (squares, np.array(z), self.data.places)

    def go_to_least(self):
        """Restores the places of the least sum of squares so far; returns True if there is one."""
        self.data.places, self.last = self.least[2], None
        return self.least[0] < math.inf

    def jacobian(self, z, both_sides=False):
        """Jacobian [residual, variable], with origin and places fixed (Kaufman, BIT 15, 49, 1975)."""
        values, basis = self.run(z)
        columns = self.model.jacobian(self.real(z), None if both_sides else values) * self.width
        return np.stack([self.scaled(one, basis) for one in np.moveaxis(columns, -1, 0)], axis=-1)

    def search(self, z):
        """Least sum of squares from here: (sum, scaled variables, "" or why the search did not end in order)."""
        for _ in range(MOST_MOVES):
            try:
                if not np.all(np.isfinite(self.residuals(z))):
                    raise Failed(self.model.problem)
                found = least_squares(self.residuals, np.clip(z, 1e-9, 1 - 1e-9), self.jacobian, bounds=(0, 1), x_scale="jac",
                                      ftol=CHANGE / self.data.n, xtol=1e-8, gtol=1e-12, max_nfev=MOST_STEPS)
            except Failed as error:
                squares, least, self.data.places = self.least
                return squares, z if least is None else least, str(error)
            z = found.x
            if self.data.place_deviation == 0 or not self.move_places(z):
                break
        return 2 * found.cost, z, "" if found.status > 0 else f"the search did not end within {MOST_STEPS} steps"

    def improved(self, z, jacobian):
        """Improves z by one more step, with central differences, of the variables that are not at a limit; returns the
        step, too."""
        free, step, residuals = (z > NEAR) & (z < 1 - NEAR), np.zeros(len(z)), self.residuals(z)
        step[free] = np.linalg.lstsq(jacobian[:, free], residuals, rcond=1e-6)[0]
        after = np.clip(z - step, 0, 1)
        return after if np.sum(self.residuals(after) ** 2) <= np.sum(residuals ** 2) else z, after - z

    def move_places(self, z):
        """Moves places that are free, or held within their deviation, to their best fit, about which they are linear;
        returns True if any moved far."""
        data, length = self.data, self.model.parameters["Body/Length"]
        values, stretch = self.model(self.real(z))
        matrix, rows = data.nuisance(stretch)
        rest = np.concatenate([(data.values - values) / self.scales, -self.of_places()])
        shifts = np.linalg.lstsq(np.vstack([matrix / self.scales[:, None], rows]), rest, rcond=1e-9)[0][-len(data.places):]
        before, data.places = data.places, np.clip(data.places + shifts, 0, length)
        data.places = np.maximum.accumulate(data.places + 1e-9 * length * np.arange(len(shifts)))  # keeps their order
        data.places = np.minimum(data.places, length * (1 - 1e-9 * np.arange(len(shifts))[::-1]))
        self.last = None
        return np.max(np.abs(data.places - before)) > FAR_PLACE * length


class Interrupted(KeyboardInterrupt):
    """Exception: a fit was interrupted. so_far: a Fit with the best values so far, without deviations; None before
    there are any."""

    def __init__(self, so_far):
        super().__init__()
        self.so_far = so_far


def find(model, progress=lambda text: None, kept=None, workers=1):
    """Finds the Fit of a Model to its data.

    progress: called with messages; kept: a dict of finished starts, which are not searched again, and to which others
    are added; workers: number of processes that share the starts. Raises InputError if no start can be run,
    Interrupted, and Stopped if one of several processes is killed.
    """
    if workers < 1:
        raise InputError(f'"workers" is {workers}, but a number of processes from 1 is expected')
    problem, kept = Problem(model, model.data, progress), {} if kept is None else kept
    progress = problem.progress
    model.accuracy = min(max(float(model.parameters["Accuracy"]), LEAST_ACCURACY), LARGEST_ACCURACY)
    try:
        progress.begin("first runs")
        model.limit_steps()
        model.far_units = require_units(model)
        for note in model.far_units:
            progress(note)
        z, why = best_of_starts(problem, kept, workers)
        for descent in range(MOST_DESCENTS + 1):
            best, why = (None, why) if why else _refined(problem, z)
            if why:
                problem.go_to_least()
                return unfinished(problem, table_of_starts(problem, kept), why)
            problem.least = (math.inf, None, problem.data.places)
            residuals = problem.residuals(best.z)  # the least so far
            found = described(problem, best, table_of_starts(problem, kept), descent)
            if residuals @ residuals - problem.least[0] < LOWER * max(best.deviation ** 2, residuals @ residuals / len(residuals)):
                return found
            progress("a lower minimum beside the profiles of chi-square: the search goes on there")
            progress.begin("search from there")
            problem.go_to_least()
            _, z, why = problem.search(problem.least[1])
            why = why or ("chi-square falls again and again beside its profiles" if descent == MOST_DESCENTS - 1 else "")
    except KeyboardInterrupt:
        starts = table_of_starts(problem, kept)
        raise Interrupted(unfinished(problem, starts) if problem.go_to_least() else None) from None


def _refined(problem, z):
    """(Best of a search from its end, "") with runs so accurate that the statistical error is larger than theirs; (None,
    why) if the search does not end in order."""
    model = problem.model
    for refinement in range(MOST_REFINEMENTS + 1):
        problem.progress.begin("derivatives at the best values")
        try:
            best = _looked_at(problem, z)
        except Failed as error:
            return None, str(error)
        if best.worst <= SHARE or refinement == MOST_REFINEMENTS or model.accuracy <= LEAST_ACCURACY:
            return best, ""
        model.accuracy = max(model.accuracy * min(0.3, 0.3 * SHARE / best.worst), LEAST_ACCURACY)
        problem.progress(f"accuracy {model.accuracy:.1g}, so that the numerical error is small compared with the statistical one")
        problem.progress.begin("search with this accuracy")
        problem.last = None
        _, z, why = problem.search(z)
        if why:
            return None, why
    return None, why


def _looked_at(problem, z):
    """Best of a search from its end, with one more step."""
    data, jacobian = problem.data, problem.jacobian(z, both_sides=True)
    z, step = problem.improved(z, jacobian)
    residual = problem.residuals(z)
    freedom = data.n - len(z) - data.n_constants
    deviation = 1.0 if data.is_weighed else max(math.sqrt(float(residual @ residual) / freedom), LEAST_NOISE)
    jacobian = jacobian / deviation
    loose, members = undetermined_directions(jacobian)
    return Best(z, jacobian, deviation, np.abs(step) + _error_of_runs(problem, z, jacobian, deviation), loose, members)


def _error_of_runs(problem, z, jacobian, deviation):
    """Change of the variables by the numerical error of the runs: from a run with a thirtieth of the error, and from a
    displacement that is wrong by its bound at the end, and before in proportion to time. jacobian: of residuals in
    deviations."""
    model, data = problem.model, problem.data
    values, basis = problem.run(z)
    rate = model.bound(problem.real(z)) / max(one.t[-1] for one in data.series) if any(one.t[-1] > 0 for one in data.series) else 0.0
    drift = data.flat([{"speed": rate, "strain": 0.0}.get(one.kind, rate * one.t[:, None]) for one in data.series])
    finer, _ = model(problem.real(z), model.accuracy / 30)
    if not np.all(np.isfinite(finer)):
        return np.full(len(z), math.nan)
    changes = np.stack([problem.scaled(values - finer, basis), problem.scaled(drift, basis)], axis=1) / deviation
    return np.abs(covariance(jacobian) @ (jacobian.T @ changes)).sum(axis=1)
