# SPDX-License-Identifier: LGPL-2.1-or-later
"""The best values of the variables of a scene, and how well the data tell them."""
import math

import numpy as np
from scipy.optimize import least_squares

from ..needs import Failed, InputError
from ..results import Numbers
from .uncertainty import LEVELS, Profile, correlation_in_time, covariance, in_words, probability, undetermined_directions

LARGEST_ACCURACY, LEAST_ACCURACY = 1e-4, 3e-11  # of runs, whose differences are to be derivatives
SHARE = 0.1           # largest numerical error, of the statistical one
MOST_REFINEMENTS = 4
CHANGE = 1e-3         # of chi-square, with data of known deviation, at which a search has ended
MOST_STEPS = 60       # of a search
MOST_MOVES, FAR_PLACE = 6, 1e-3  # of free places of markers; the latter in lengths of the body
LEAST_NOISE = 1e-10   # relative to what the data vary; of data without noise
NEAR = 1e-3           # to a limit, in ranges
MUCH = 100            # chi-square per degree of freedom that no noise has
UNLIKELY = 1e-3       # probability of chi-square below which the scene does not fit


class Fit(Numbers):
    """What was found: the keys of summary.json (doc/fit.md). Besides: data; model and residuals, arrays [time, place] like
    data.values; covariance, an array [variable, variable] in units of the entries; settings, the entries of the best scene."""

    def __init__(self, found, data, model, settings, covariance_of_values):
        super().__init__(found)
        self.data, self.model, self.residuals = data, model, data.values - model
        self.settings, self.covariance = settings, covariance_of_values

    def __repr__(self):
        return f"<crawler.Fit: {self.status}, " + ", ".join(f"{name} = {value_in_words(one)}" for name, one in self.variables.items()) + ">"


def value_in_words(one):
    """Of a variable, as in summary.json: value, statistical deviation, numerical error."""
    if not one["determined"]:
        return "not told by the data"
    return f"{one['value']:.6g} +- {one['deviation']:.2g} +- {one['numerical_error']:.1g} (numerical)"


class _Problem:
    """Residuals in scaled variables: 0 to 1 over the ranges, and the deviation of the data, as far as it is known, is 1."""

    def __init__(self, model, data):
        self.model, self.data = model, data
        self.width = model.high - model.low
        self.scale = data.deviation or float(np.nanstd(data.values - np.nanmean(data.values, axis=0))) or 1.0
        self.n_rows = len(data.places) if 0 < data.place_deviation < math.inf else 0  # that hold places fast
        self.last = None  # scaled variables, values of the last run, and what the nuisance cannot change

    def run(self, z):
        """What the scene says [time, place], and an orthonormal basis of what origin and places change."""
        if self.last is None or not np.array_equal(self.last[0], z):
            values, stretch = self.model(self.real(z))
            basis = None
            if np.all(np.isfinite(values)):
                matrix, rows = self.data.nuisance(stretch)
                if matrix.shape[1]:
                    basis, sizes, _ = np.linalg.svd(np.vstack([matrix / self.scale, rows]), full_matrices=False)
                    basis = basis[:, sizes > 1e-9 * sizes[0]]
            self.last = (np.array(z), values, basis)
        return self.last[1:]

    def real(self, z):
        """The values of the variables."""
        return np.clip(self.model.low + np.asarray(z) * self.width, self.model.low, self.model.high)

    def scaled(self, values, basis):
        """Differences [time, place] as residuals, without what origin and places can take up; behind them those of the places."""
        rest = np.concatenate([values[self.data.is_there] / self.scale, np.zeros(self.n_rows)])
        return rest if basis is None else rest - basis @ (basis.T @ rest)

    def residuals(self, z):
        """One for each datum, and for each place that is held."""
        values, basis = self.run(z)
        return self.scaled(values - self.data.values, basis)

    def jacobian(self, z, both_sides=False):
        """[residual, variable], with origin and places where they are (Kaufman, BIT 15, 49, 1975)."""
        values, basis = self.run(z)
        columns = self.model.jacobian(self.real(z), None if both_sides else values) * self.width
        if not np.all(np.isfinite(columns)):
            values = ", ".join(f"{name} = {value:.6g}" for name, value in zip(self.model.names, self.real(z)))
            raise Failed(f"beside {values} there is no run: {self.model.problem}; narrower ranges are expected")
        return np.stack([self.scaled(one, basis) for one in np.moveaxis(columns, -1, 0)], axis=-1)

    def search(self, z):
        """The least sum of squares from here: (sum, scaled variables, did it end in order?)."""
        for _ in range(MOST_MOVES):
            if not np.all(np.isfinite(self.residuals(z))):
                return math.inf, z, False
            found = least_squares(self.residuals, np.clip(z, 1e-9, 1 - 1e-9), self.jacobian, bounds=(0, 1), x_scale="jac",
                                  ftol=CHANGE / self.data.is_there.sum(), xtol=1e-8, gtol=1e-12, max_nfev=MOST_STEPS)
            z = found.x
            if self.data.place_deviation < math.inf or not self.move_places(z):
                break
        return 2 * found.cost, z, found.status > 0

    def improved(self, z, jacobian):
        """One more step, with derivatives by differences on both sides, where no limit is in the way."""
        step = np.linalg.lstsq(jacobian, self.residuals(z), rcond=1e-6)[0]
        if np.any(z < NEAR) or np.any(z > 1 - NEAR) or np.any(z - step < 0) or np.any(z - step > 1):
            return z
        before, after = (np.sum(self.residuals(at) ** 2) for at in (z, z - step))
        return z - step if after <= before else z

    def move_places(self, z):
        """Takes free places to where they fit best; is that far?"""
        data, length = self.data, self.model.parameters["Body/Length"]
        values, stretch = self.model(self.real(z))
        matrix, _ = data.nuisance(stretch)
        shifts = np.linalg.lstsq(matrix, (data.values - values)[data.is_there], rcond=1e-9)[0][-len(data.places):]
        before, data.places = data.places, np.clip(data.places + shifts, 0, length)
        data.places = np.maximum.accumulate(data.places + 1e-9 * length * np.arange(len(shifts)))  # in their order
        data.places = np.minimum(data.places, length * (1 - 1e-9 * np.arange(len(shifts))[::-1]))
        self.last = None
        return np.max(np.abs(data.places - before)) > FAR_PLACE * length


def find(model, progress=lambda text: None):
    """The Fit of a Model to its data. Raises InputError if no start can be run, and Failed where there are no derivatives."""
    data = model.data
    problem = _Problem(model, data)
    model.accuracy = min(max(float(model.parameters["Accuracy"]), LEAST_ACCURACY), LARGEST_ACCURACY)
    starts, best = _starts(problem, int(model.parameters["Fit/Starts"]), int(model.parameters["Fit/Seed"]), progress)
    z, ended = best
    deviation, numerical = 1.0, None
    for refinement in range(MOST_REFINEMENTS + 1):
        jacobian = problem.jacobian(z, both_sides=True)
        z = problem.improved(z, jacobian)
        residual = problem.residuals(z)
        freedom = int(data.is_there.sum()) - len(z) - data.n_constants
        sum_of_squares = float(residual @ residual)
        deviation = 1.0 if data.deviation else max(math.sqrt(sum_of_squares / freedom), LEAST_NOISE)
        loose, members = undetermined_directions(jacobian / deviation)
        involved = members.any(axis=0) if len(loose) else np.zeros(len(z), dtype=bool)
        spread = np.sqrt(np.diag(covariance(jacobian))) * deviation
        numerical = _numerical_error(problem, z, jacobian)
        worst = float(np.max(numerical[~involved] / np.maximum(spread[~involved], 1e-300), initial=0))
        if worst <= SHARE or refinement == MOST_REFINEMENTS or model.accuracy <= LEAST_ACCURACY:
            break
        model.accuracy = max(model.accuracy * min(0.3, 0.3 * SHARE / worst), LEAST_ACCURACY)
        progress(f"accuracy {model.accuracy:.1g}, so that the numerical error is small beside the statistical one")
        problem.last = None
        _, z, ended = problem.search(z)
    return _described(problem, z, jacobian, deviation, numerical, loose, members, starts, ended)


def _starts(problem, n_starts, seed, progress):
    """Searches from all starts: a list of dicts, and the best as (scaled variables, did it end in order?)."""
    model, random = problem.model, np.random.default_rng(seed)
    first = (model.start - model.low) / problem.width
    starts, best = [], (math.inf, first, False)
    for number in range(n_starts):
        z = first if number == 0 else random.random(len(first))
        squares, z, ended = problem.search(z)
        reason = "" if squares < math.inf else model.problem
        starts.append({"start": number, "chi_square": squares if squares < math.inf else None, "reason": reason,
                       "values": dict(zip(model.names, problem.real(z).tolist()))})
        if squares < best[0]:
            best = (squares, z, ended)
        rest = [math.sqrt(one / problem.data.is_there.sum()) * problem.scale for one in (squares, best[0])]
        progress(f"start {number + 1} of {n_starts}: " + (reason or f"residuals {rest[0]:.6g} (root mean square), least so far {rest[1]:.6g}"))
    if best[0] == math.inf:
        raise InputError(f"the scene cannot be run at {'the start' if n_starts == 1 else f'any of {n_starts} starts'}: {starts[0]['reason']}")
    return starts, best[1:]


def _numerical_error(problem, z, jacobian):
    """By how much the numerical error of the runs changes the variables: as a run a thirtieth as wrong tells, and as a
    displacement would that is wrong by its bound at the end, and before in proportion to time."""
    model, data = problem.model, problem.data
    problem.last = None  # so that the bound is that of this run
    values, basis = problem.run(z)
    drift = model.bound / data.t[-1] if data.t[-1] > 0 else 0.0
    drift = {"speed": drift * np.ones(values.shape), "strain": np.zeros(values.shape)}.get(data.kind, drift * data.t[:, None] + 0 * values)
    finer, _ = model(problem.real(z), model.accuracy / 30)
    if not np.all(np.isfinite(finer)):
        return np.full(len(z), math.nan)
    changes = np.stack([problem.scaled(values - finer, basis), problem.scaled(drift, basis)], axis=1)
    return np.abs(np.linalg.lstsq(jacobian, changes, rcond=1e-9)[0]).sum(axis=1)


def _described(problem, z, jacobian, deviation, numerical, loose, members, starts, ended):
    """All numbers of the result."""
    model, data = problem.model, problem.data
    spread = np.sqrt(np.diag(covariance(jacobian))) * deviation
    involved = members.any(axis=0) if len(loose) else np.zeros(len(z), dtype=bool)
    profile = Profile(lambda at: problem.residuals(at) / deviation, lambda at: problem.jacobian(at) / deviation, z)
    values, at_limit = problem.real(z), (z < NEAR) | (z > 1 - NEAR)
    variables, notes = {}, []
    for j, name in enumerate(model.names):
        one = {"value": None if involved[j] else float(values[j]), "used": float(values[j]), "deviation": None, "numerical_error": None, "interval_68": None, "interval_95": None,
               "from": float(model.low[j]), "to": float(model.high[j]), "determined": not involved[j],
               "at_limit": "" if not at_limit[j] else "from" if z[j] < 0.5 else "to"}
        variables[name] = one
        if involved[j]:
            continue
        one["deviation"], one["numerical_error"] = float(spread[j] * problem.width[j]), float(numerical[j] * problem.width[j])
        ends = profile.interval(j, spread[j])
        for level in LEVELS:
            one[level] = [None if end is None else float(model.low[j] + end * problem.width[j]) for end in ends[level]]
        if at_limit[j]:
            notes.append(f"{name} is at its limit, {values[j]:g}: the best value may lie beyond it")
    undetermined = [in_words(*one, model.names, values, problem.width) for one in zip(loose, members)]
    residual = problem.residuals(z)
    chi_square, freedom = float(residual @ residual) / deviation ** 2, int(data.is_there.sum()) - len(z) - data.n_constants
    grid = np.full(data.values.shape, np.nan)
    grid[data.is_there] = residual[:data.is_there.sum()]
    alike, chance = correlation_in_time(grid)
    p_value = probability(chi_square, freedom) if data.deviation else None
    if p_value is not None and p_value < UNLIKELY:
        notes.append(f"the scene does not fit the data: chi-square is {chi_square:.4g} with {freedom} degrees of freedom (probability {p_value:.1g}),"
                     " so the deviations are too small; another scene, or another standard deviation, is expected"
                     + (" (units? see \"--unit-of-s\" and \"--unit-of-t\")" if chi_square > MUCH * freedom else ""))
    if alike > 5 * chance:
        notes.append(f"residuals that are neighbours in time are alike (correlation {alike:.2g}): the scene does not describe all that the data "
                     "have, or their errors are not independent, and the deviations are too small")
    if not ended:
        notes.append(f"the search did not end within {MOST_STEPS} steps")
    worst = np.max(numerical[~involved] / np.maximum(spread[~involved], 1e-300), initial=0)
    if not worst <= SHARE:
        notes.append(f"the numerical error is up to {worst:.2g} of the statistical one")
    n, k = int(data.is_there.sum()), len(z) + data.n_constants
    likelihood = chi_square if data.deviation else n * math.log(max(float(residual @ residual), 1e-300) * problem.scale ** 2 / n)
    k += 0 if data.deviation else 1
    found = {"status": "finished" if ended else "failed", "reason": "converged" if ended else "no_convergence", "message": "",
             "variables": variables, "undetermined": undetermined, "notes": notes,
             "correlation": _correlation(jacobian).tolist(),
             "goodness": {"kind": data.kind, "n_data": n, "n_variables": len(z), "n_constants": data.n_constants, "chi_square": chi_square,
                          "degrees_of_freedom": freedom, "probability": p_value, "deviation_of_data": deviation * problem.scale,
                          "deviation_is_given": data.deviation is not None, "correlation_in_time": alike},
             "information": {"aic": likelihood + 2 * k, "bic": likelihood + k * math.log(n)},
             "accuracy": model.accuracy, "n_runs": model.n_runs, "starts": starts}
    best = data.values + grid * problem.scale  # run, origin and places
    return Fit(found, data, best, dict(one.split("=", 1) for one in model.overrides(values)),
               covariance(jacobian) * deviation ** 2 * np.outer(problem.width, problem.width))


def _correlation(jacobian):
    """Of the variables."""
    matrix = covariance(jacobian)
    spread = np.sqrt(np.diag(matrix))
    return matrix / np.outer(spread, spread)
