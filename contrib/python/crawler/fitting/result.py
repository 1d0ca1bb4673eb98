# SPDX-License-Identifier: LGPL-2.1-or-later
"""Report of a fit: values, deviations, intervals, undetermined combinations, and whether the scene fits at all."""
import dataclasses
import math

import numpy as np

from ..results import Numbers
from .uncertainty import LEVELS, Profile, correlation_in_time, covariance, curvature_bias, in_words, probability

BIASED = 0.2          # least bias that is reported, relative to the deviation
SHARE = 0.1           # largest numerical error, relative to the statistical one
NEAR = 1e-3           # distance to a limit that is near, in ranges
UNLIKELY = 1e-3       # probability of chi-square below which the scene does not fit
RULED_OUT = 1e-6       # probability below which undetermined combinations are not reported either
OUTLYING = 1e-4       # probability of a residual as large as the largest
MUCH = 100            # chi-square per degree of freedom beyond any noise
ONE_START = "1 start: the minimum may be local (Fit/Starts)"
UNITS = 'units? see "--unit-of-s" and "--unit-of-t"'
ALIKE = 5             # correlation of residuals in time, in its own deviations, that is not accidental


class Fit(Numbers):
    """Result of a fit: the keys of summary.json (doc/fit.md). Further attributes: data, whose series are the
    measurements; model and residuals, arrays [time, place] like the values of the data, for several kinds of data lists
    of them; covariance, an array [variable, variable] in units of the entries; settings, the entries of the best
    scene."""

    def __init__(self, found, data, residuals, settings, covariance_of_values):
        """Constructor. residuals: [datum], data minus run."""
        super().__init__(found)
        model, residuals = data.grids(data.values - residuals), data.grids(residuals)
        self.data, self.model, self.residuals = data, *((model[0], residuals[0]) if len(model) == 1 else (model, residuals))
        self.settings, self.covariance = settings, covariance_of_values

    def __repr__(self):
        return f"<crawler.Fit: {self.status}, " + ", ".join(f"{name} = {value_in_words(one)}" for name, one in self.variables.items()) + f"{'; ' + ONE_START if len(self.starts) == 1 else ''}>"


def value_in_words(one):
    """Formats a variable of summary.json: value, statistical deviation, numerical error."""
    if one["determined"] is None:
        return f"{one['value']:.6g} (so far)"
    if not one["determined"]:
        return "not determined by the data"
    if one["at_limit"]:
        return f"{one['value']:.6g} at the limit of its range,"
    numerical = "?" if one["numerical_error"] is None else f"{one['numerical_error']:.1g}"
    return f"{one['value']:.6g} +- {one['deviation']:.2g} +- {numerical} (numerical)"


@dataclasses.dataclass
class Best:
    """End of a search, in scaled variables (0 to 1 over the ranges)."""
    z: np.ndarray           # [variable]
    jacobian: np.ndarray    # [residual, variable], of residuals in deviations
    deviation: float        # standard deviation of a residual
    numerical: np.ndarray   # [variable], errors; NaN where unknown
    loose: np.ndarray       # [direction, variable], undetermined directions
    members: np.ndarray     # [direction, variable], variables that belong to it

    @property
    def involved(self):
        """[variable]: True if it belongs to such a direction."""
        return self.members.any(axis=0) if len(self.members) else np.zeros(len(self.z), dtype=bool)

    @property
    def spread(self):
        """Deviations [variable]."""
        return np.sqrt(np.diag(covariance(self.jacobian)))

    @property
    def worst(self):
        """Largest numerical error, relative to the statistical one."""
        told = ~self.involved
        return float(np.max(self.numerical[told] / np.maximum(self.spread[told], 1e-300), initial=0))


def unfinished(problem, starts, why=""):
    """Fit of a search that was interrupted or, for a reason (why), did not end: the least sum of squares found, with
    values and without deviations, since derivatives say nothing of a minimum that was not reached."""
    model, data = problem.model, problem.data
    squares, z, _ = problem.least
    values, residual = problem.real(z), problem.residuals(z)[:data.n]
    variables = {name: {"value": float(value), "used": float(value), "deviation": None, "numerical_error": None, "bias": None,
                        **{level: None for level in LEVELS}, "profile": [], "from": float(low), "to": float(high), "determined": None,
                        "at_limit": ""}
                 for name, value, low, high in zip(model.names, values, model.low, model.high)}
    goodness = {"n_data": data.n, "n_variables": len(z), "n_constants": data.n_constants, "chi_square": None,
                "degrees_of_freedom": data.n - len(z) - data.n_constants, "probability": None, "largest_residual": None, "deviation_is_given": data.is_weighed,
                "series": [{"kind": one.kind, "n_data": int(one.is_there.sum()), "chi_square": None, "deviation": one.deviation,
                            "correlation_in_time": None} for one in data.series]}
    units = f"; {UNITS}" if data.is_weighed and squares > MUCH * data.n else ""
    message = (f"{why}; the values are those so far, and not the best ones, so there are no deviations; a nearer start, narrower ranges or "
               f"fewer variables are expected{units}" if why else
               f"stopped by a signal after {len(starts)} of {int(model.parameters['Fit/Starts'])} starts; --resume continues")
    found = {"status": "failed" if why else "stopped", "reason": "no_convergence" if why else "signal", "message": message,
             "variables": variables, "undetermined": [], "notes": [*data.notes, *model.far_units, *_of_cut_runs(model), *([message] if why else [])],
             "correlation": None, "goodness": goodness, "information": {"aic": None, "bic": None}, "residuals": problem.root_mean_square(squares), "accuracy": model.accuracy,
             "n_runs": model.n_runs, "starts": starts}
    return Fit(found, data, -residual * problem.scales, dict(one.split("=", 1) for one in model.overrides(values)), None)


def described(problem, best, starts, n_left):
    """Fit with all its entries. n_left: number of minima from which profiles of chi-square led to lower ones."""
    model, data = problem.model, problem.data
    values, residual = problem.real(best.z), problem.residuals(best.z)
    variables, goodness = _variables(problem, best, values), _goodness(problem, best, residual)
    n, k = data.n, len(values) + data.n_constants + (0 if data.is_weighed else 1)
    likelihood = goodness["chi_square"] if data.is_weighed else n * math.log(max(float(residual @ residual), 1e-300) * problem.scale ** 2 / n)
    matrix = covariance(best.jacobian)
    found = {"status": "finished", "reason": "converged", "message": "", "variables": variables,
             "undetermined": [] if _is_ruled_out(goodness) else list(_untold(problem, best, variables, values)),
             "notes": [*_notes(best, variables, goodness, data, model), *_of_other_minima(n_left),
                       *_of_rivals(problem, best, variables, starts, goodness["chi_square"])],
             "correlation": (matrix / np.sqrt(np.outer(np.diag(matrix), np.diag(matrix)))).tolist(), "goodness": goodness,
             "information": {"aic": likelihood + 2 * k, "bic": likelihood + k * math.log(n)},
             "accuracy": model.accuracy, "n_runs": model.n_runs, "starts": starts}
    return Fit(found, data, -residual[:data.n] * problem.scales, dict(one.split("=", 1) for one in model.overrides(values)),
               matrix * np.outer(problem.width, problem.width))


def _untold(problem, best, variables, values):
    """Sentences on undetermined combinations."""
    for direction, members in zip(best.loose, best.members):
        yield in_words(direction, members, problem.model.names, values, problem.width)
    for (name, one), is_involved in zip(variables.items(), best.involved):
        if not one["determined"] and not is_involved:
            yield f"the data do not determine {name}: its interval of 95 % reaches both limits of its range"


def _variables(problem, best, values):
    """Entries of each variable."""
    model, spread, width, variables = problem.model, best.spread, problem.width, {}
    profile = Profile(lambda z: problem.residuals(z) / best.deviation, lambda z: problem.jacobian(z) / best.deviation, best.z,
                      best.jacobian)
    at_best, basis = problem.run(best.z)
    model.choose_at(values)
    problem.progress.begin("curvature at the best values")
    bias = curvature_bias(lambda z: problem.scaled(model(problem.real(z), is_similar=True)[0] - at_best, basis) / best.deviation, best.jacobian, best.z)
    for j, name in enumerate(model.names):
        at, is_told = best.z[j], not best.involved[j]
        one = {"value": float(values[j]) if is_told else None, "used": float(values[j]), "deviation": None, "numerical_error": None, "bias": None,
               **{level: None for level in LEVELS}, "profile": [], "from": float(model.low[j]), "to": float(model.high[j]), "determined": is_told,
               "at_limit": ""}
        variables[name] = one
        problem.progress.begin(f"profile of chi-square of {name}")
        ends, curve = profile.interval(j, spread[j]) if is_told else ({"interval_95": [None, None]}, None)
        for side, key, gap in zip(ends["interval_95"], ("from", "to"), (at, 1 - at)):
            if side is None and gap < NEAR:
                one["at_limit"] = key
        if is_told and ends["interval_95"] == [None, None]:  # chi-square rises slower than its curvature
            one.update(value=None, determined=False)
        elif is_told:
            one["deviation"] = float(spread[j] * width[j]) if not one["at_limit"] else None  # chi-square is no parabola about a limit
            one["numerical_error"] = float(best.numerical[j] * width[j]) if math.isfinite(best.numerical[j]) else None
            one["bias"] = float(bias[j] * width[j]) if math.isfinite(bias[j]) else None
            one.update({level: [None if end is None else float(model.low[j] + end * width[j]) for end in ends[level]] for level in LEVELS})
            one["profile"] = [[float(model.low[j] + x * width[j]), float(rise)] for x, rise in curve]
    return variables


def _goodness(problem, best, residual):
    """Goodness of fit of the scene to the data."""
    data, chi_square, grids = problem.data, float(residual @ residual) / best.deviation ** 2, problem.data.grids(residual[:problem.data.n] / best.deviation)
    freedom, units = data.n - len(best.z) - data.n_constants, data.grids(problem.scales / data.relative)
    return {"n_data": data.n, "n_variables": len(best.z), "n_constants": data.n_constants, "chi_square": chi_square,
            "degrees_of_freedom": freedom, "probability": probability(chi_square, freedom) if data.is_weighed else None,
            "largest_residual": max((_largest(one, grid) for one, grid in zip(data.series, grids)), key=lambda one: abs(one["deviations"])),
            "deviation_is_given": data.is_weighed,
            "series": [{"kind": one.kind, "n_data": int(one.is_there.sum()), "chi_square": float(np.nansum(grid ** 2)),
                        "deviation": float(np.nanmax(unit)) * best.deviation, "correlation_in_time": correlation_in_time(grid)}
                       for one, grid, unit in zip(data.series, grids, units)]}


def _largest(series, grid):
    """Largest of the residuals [time, place] in deviations, its time of the run, and the name of the marker or s of its
    place."""
    j, i = np.unravel_index(np.nanargmax(np.abs(grid)), grid.shape)
    place = None if not len(series.places) else series.names[i] if series.kind == "markers" and len(series.names) > i else f"{series.places[i]:.6g}"
    return {"deviations": float(grid[j, i]), "t": float(series.t[j]), "place": place, "kind": series.kind}


def _is_ruled_out(goodness):
    return goodness["probability"] is not None and goodness["probability"] < RULED_OUT


def _does_not_fit(goodness):
    """Sentence about a scene that does not fit the data at all, with the worst residual; None if it may fit."""
    chi_square, freedom, p_value = (goodness[key] for key in ("chi_square", "degrees_of_freedom", "probability"))
    if p_value is not None and p_value < UNLIKELY:
        units = f" ({UNITS})" if chi_square > MUCH * freedom else ""
        yield (f"the scene does not fit the data: chi-square is {chi_square:.4g} (degrees of freedom: {freedom}, probability {p_value:.1g}), so "
               f"the deviations are too small; {_largest_in_words(goodness)}; another scene, or another standard deviation, is expected{units}")
    elif goodness["n_data"] * probability(goodness["largest_residual"]["deviations"] ** 2, 1) < OUTLYING:
        yield f"{_largest_in_words(goodness)}: more than noise gives, perhaps an outlier"


def _largest_in_words(goodness):
    """Largest residual and its place in words."""
    one = goodness["largest_residual"]
    place = {"markers": f"marker {one['place']}, ", "strain": f"s = {one['place']}, "}.get(one["kind"], f"the {one['kind']}, " if len(goodness["series"]) > 1 else "")
    return f"the largest residual is {abs(one['deviations']):.3g} deviations, at {place}t = {one['t']:.6g} of the run"


def _of_cut_runs(model):
    """Sentence on runs that were given up."""
    if model.n_cut:
        yield (f"{model.n_cut} of {model.n_runs} runs needed more than {model.most_steps} steps and count as failed: narrower ranges, or another "
               '"Time/Maximum number of steps", may be better')


def _of_other_minima(n):
    """Sentence on minima that the search has left."""
    if n:
        yield (f"chi-square has {'other minima' if n > 1 else 'another minimum'}, where the search ended first, and from which {'their' if n > 1 else 'its'} "
               "profiles led to the values given here: more starts (Fit/Starts) tell whether there are lower ones")


def _of_rivals(problem, best, variables, starts, chi_square):
    """Sentences on starts that ended at values outside of the intervals with nearly the least chi-square."""
    for one in starts:
        if one["residuals"] is None or one["reason"]:
            continue
        rise = (one["residuals"] / problem.scale / best.deviation) ** 2 * problem.data.n - chi_square
        outside = [f"{name} = {one['values'][name]:.6g}" for name, its in variables.items() if its["determined"] and any(
            end is not None and sign * (one["values"][name] - end) > 0 for sign, end in zip((-1, 1), its["interval_95"]))]
        if rise < LEVELS["interval_95"] ** 2 and outside:
            yield (f"start {one['start'] + 1} ended at another minimum that fits nearly as well (chi-square is larger by {max(rise, 0):.2g}), with {', '.join(outside)}: "
                   "the intervals do not have these values")


def _notes(best, variables, goodness, data, model):
    """Sentences on possible mistakes."""
    parameters = model.parameters
    yield from _does_not_fit(goodness)
    if (goodness["probability"] or 0) < UNLIKELY:
        yield from model.far_units
    missing = [name for name, one in variables.items() if not one["determined"]]
    if missing and _is_ruled_out(goodness):
        yield (f"there is no deviation of {', '.join(missing)}: derivatives of a scene that does not fit cannot tell whether the data determine "
               f"{'it' if len(missing) == 1 else 'them'}")
    if (goodness["probability"] or 0) > 1 - UNLIKELY:
        yield (f"the data are nearer to the scene than their standard deviations allow: chi-square is {goodness['chi_square']:.4g} "
               f"(degrees of freedom: {goodness['degrees_of_freedom']}); the deviations are too large, or the scene has the noise of the data")
    if (parameters["Active stress/Generator"], parameters["Active stress/Prescribed strain/Given by"]) == ("prescribed strain", "table") and data.places.size:
        yield ("the strain of the table is taken as exact: if it was made of these tracks its noise counts as motion, and the deviations of the "
               "variables are too small by a factor of two or more; fits of copies of the tracks with noise added, each with its table, show the scatter")
    yield from data.notes
    yield from _of_cut_runs(model)
    for name, one in variables.items():
        if one["at_limit"] and one["determined"]:
            yield (f"{name} is at the limit of its range, {one[one['at_limit']]:g}: the best value may lie beyond it; its interval is one-sided, to "
                   "where chi-square has risen by 1 (68 %) and 3.84 (95 %) from its value there, and there is no deviation")
        if abs(one["bias"] or 0) > BIASED * (one["deviation"] or math.inf):
            yield (f"over many such data sets the mean of {name} would be about {abs(one['bias']):.2g} too {'large' if one['bias'] > 0 else 'small'}, as the run "
                   "is not linear in it; the interval allows for that")
    for one in goodness["series"]:
        if one["correlation_in_time"] > ALIKE / math.sqrt(one["n_data"]):
            of = f" of the {one['kind']}" if len(goodness["series"]) > 1 else ""
            yield (f"residuals{of} that are neighbours in time are similar (correlation {one['correlation_in_time']:.2g}): the scene does not "
                   "describe everything in the data, or their errors are not independent, and the deviations are too small")
    if not best.worst <= SHARE:
        yield ("the numerical error is not known" if math.isnan(best.worst) else
               f"the numerical error is up to {best.worst:.2g} of the statistical one")
