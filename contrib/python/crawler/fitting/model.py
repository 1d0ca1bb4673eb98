# SPDX-License-Identifier: LGPL-2.1-or-later
"""Values of a run at the data, and their derivatives."""
import dataclasses
import json
import math

import numpy as np

from .. import _compiled, _source, entries
from ..needs import Failed, InputError
from ..results import parameters_of

STEP = 1e-4  # step of differences, relative to a value
LENGTH = "Body/Length"
POINTS = 201  # points on the body for means over it
LEAST_LIMIT, TIMES = 500, 10  # limit of the steps of a run, and in those of the run at the start or in times of the data
STEP_LIMIT = "Time/Maximum number of steps"
FIELDS = {"markers": ("displacement", "stretch"), "strain": ("stretch",), "centre": ("displacement",), "speed": ("velocity",)}


@dataclasses.dataclass
class Scene:
    """Parameter file (or its text, or a dict) with settings, ["Body/Length=2", ...]."""
    scene: object
    settings: list

    def __call__(self, more=()):
        """Input of the compiled part, with more settings."""
        return _source(self.scene, [*self.settings, *more])


class Model:
    """Scene as a function of its variables. It can be sent to another process."""

    def __init__(self, scene, effective, variables, data):
        """scene: a Scene; effective: its parameters.prm; variables: [(entry, from, to, start)]; data: Data."""
        self.scene, self.effective, self.parameters, self.data = scene, effective, parameters_of(effective), data
        self.names = [one[0] for one in variables]
        require_enough(data, self.names)
        self.low, self.high, self.start = np.array([one[1:] for one in variables]).T
        self._require_seen()
        self.accuracy, self.n_runs, self.n_cut, self.problem = None, 0, 0, ""
        self.far_units = []  # sentences on data that may be in other units than the scene
        self.is_refused = False  # the problem is that of a wrong input
        self.n_steps, self.most_steps = 0, self.parameters[STEP_LIMIT]
        self.ran = lambda: None  # called behind each run
        self._runs, self._chosen_at = None, None  # FieldRuns, and the values and Accuracy at which its numerics were chosen

    def __getstate__(self):
        return {**{name: value for name, value in vars(self).items() if name != "ran"}, "_runs": None, "_chosen_at": None}

    def _require_seen(self):
        """Raises InputError for variables that do not affect the data, or with which a body ends before its data do."""
        if "Time/End time" in self.names:
            raise InputError('"Fit/Variables" has "Time/End time", but the data do not depend on it: all of them were measured earlier; another '
                             "variable is expected")
        for one in self.data.series if LENGTH in self.names else ():
            j, last, is_marker = self.names.index(LENGTH), float(one.places[-1]) if len(one.places) else 0.0, one.kind == "markers"
            if self.low[j] < last:
                what = "the outermost marker is" if is_marker else "there is strain"
                advice = (' (with "Fit/Markers at" = first it is where the body of the scene ends: a list of places)' if self.parameters["Fit/Markers at"] == "first"
                          else ' (or other places in "Fit/Markers at")') if is_marker else ""
                raise InputError(f'"Fit/Variables" has "{LENGTH}" from {self.low[j]:g} to {self.high[j]:g}, but {what} at {last:g}, which is then beyond the '
                                 f"body; a range that begins at {last:g} or more is expected{advice}")

    def overrides(self, x):
        """Settings of the entries with these values."""
        return [f"{name}={float(value)!r}" for name, value in zip(self.names, x)]

    def _answer(self, x, accuracy, times, places, is_similar):
        if self._runs is None:
            settings = ["Output/Number of snapshots=0", "Output/Statistics=false", "Output/Sensitivities="]
            self._runs = _compiled().FieldRuns(self.scene([*self.overrides(self.start), *settings]), [*self.names, "Accuracy", STEP_LIMIT])
        self.n_runs += 1
        self.is_refused = False
        if not is_similar:
            self._chosen_at = (tuple(x), accuracy)
        try:
            return self._runs.run([*x, accuracy, self.most_steps], is_similar, times.tolist(), places.tolist())
        except InputError as error:  # e.g. a formula that is no friction with these constants
            self.problem, self.is_refused = str(error), True
            return None
        finally:
            self.ran()

    def __call__(self, x, accuracy=None, is_similar=False):
        """Returns the values [datum], and the stretch [time, marker] if there are markers; NaN if the run does not
        finish, in which case problem has the reason. is_similar: with mesh and tolerance of the last run that had its
        own."""
        x, series = np.clip(x, self.low, self.high), self.data.series
        length = x[self.names.index(LENGTH)] if LENGTH in self.names else self.parameters[LENGTH]
        whole = np.linspace(0, length, POINTS) if any(one.kind in ("centre", "speed") for one in series) else []
        times, places = np.unique(np.concatenate([one.t for one in series])), np.unique(np.concatenate([whole, *(one.places for one in series)]))
        answer = self._answer(x, accuracy or self.accuracy, times, places, is_similar)
        if answer is None:
            return np.full(self.data.n, np.nan), None
        if "fields" not in answer:
            is_cut = answer["reason"] == "step_limit"
            self.n_cut += is_cut
            self.problem = f"{answer['reason']}: " + (f"it needs more than {self.most_steps} steps" if is_cut else answer["message"])
            return np.full(self.data.n, np.nan), None
        self.n_steps = answer["steps"]
        values, stretch = [], None
        for one in series:
            where = np.ix_(np.searchsorted(times, one.t), np.searchsorted(places, one.places if len(one.places) else whole))
            field = {name: answer["fields"][name][where] for name in FIELDS[one.kind]}
            if one.kind == "markers":
                stretch = field["stretch"]
                values.append(field["displacement"] + one.places)
            elif one.kind == "strain":
                values.append(field["stretch"] - 1)
            else:
                values.append(_mean(field["velocity"]) if one.kind == "speed" else _mean(field["displacement"]) + length / 2)
        return self.data.flat(values), stretch

    def choose_at(self, x):
        """Sees to it that similar runs have the mesh and tolerance of a run with these values."""
        if self._chosen_at != (tuple(np.clip(x, self.low, self.high)), self.accuracy):
            self(x)

    def bound(self, x):
        """Bound of the error of the displacement at the end of a run: 0 if the scene wants none, NaN if it is not known."""
        self.n_runs += 1
        settings = [*self.overrides(x), "Output/Number of snapshots=0", "Output/Statistics=false", "Output/Sensitivities=", f"Accuracy={self.accuracy!r}"]
        summary = json.loads(_compiled().run(self.scene(settings), None, None)["summary"])
        self.ran()
        error = (summary.get("displacement_error") or {}).get("total")
        return error if error is not None else math.nan if self.parameters["Error estimate"] else 0.0

    def limit_steps(self):
        """Limits the steps of all runs by those of the run at the start, unless the scene limits them: at absurd values
        runs would not end."""
        if self.most_steps == int(entries()[STEP_LIMIT]["default"]) and np.all(np.isfinite(self(self.start)[0])):
            self.most_steps = max(LEAST_LIMIT, TIMES * self.n_steps, TIMES * max(len(one.t) for one in self.data.series))

    def jacobian(self, x, value=None):
        """Derivatives [datum, variable]: central differences, or, if value is the model at x, one-sided ones. Raises
        Failed where a variable has no run on either side, InputError if both are refused."""
        columns = []
        self.choose_at(x)
        for j, at in enumerate(x):
            step = min(STEP * max(abs(at), 1e-2 * (self.high[j] - self.low[j])), 0.25 * (self.high[j] - self.low[j]))
            sides = [] if value is None else [(at, value)]
            for end in (at + step, at - step):
                if len(sides) < 2 and self.low[j] <= end <= self.high[j]:
                    side = np.array(x, dtype=float)
                    side[j] = end
                    sides.append((end, self(side, is_similar=True)[0]))
                    if not np.all(np.isfinite(sides[-1][1])):
                        sides.pop()
            if value is None and len(sides) == 1:  # at a limit, or inversion of the body on the other side
                sides.append((at, self(x, is_similar=True)[0]))
            if len(sides) < 2:
                raise (InputError if self.is_refused else Failed)(f"beside {self.names[j]} = {at:.6g} there is no run: {self.problem}")
            columns.append((sides[0][1] - sides[1][1]) / (sides[0][0] - sides[1][0]))
        return np.stack(columns, axis=-1)


def _mean(values):
    """Mean over the body, from equidistant points (Simpson's rule)."""
    weights = np.ones(values.shape[1])
    weights[1:-1:2], weights[2:-1:2] = 4, 2
    return (values @ (weights / weights.sum()))[:, None]


def require_enough(data, variables):
    """Raises InputError if there are fewer data than unknown numbers."""
    n, unknown = data.n, len(variables) + data.n_constants
    if n <= unknown:
        raise InputError(f"there are {n} data, but {unknown} numbers are to be found ({len(variables)} variables, {data.n_constants} "
                         "for origin and places of the tracks); more data or fewer variables are expected")
