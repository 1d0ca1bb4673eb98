# SPDX-License-Identifier: LGPL-2.1-or-later
"""The numbers that a run gives where there are data, and their derivatives."""
import dataclasses
import json
import re

import numpy as np

from .. import _compiled, _source
from ..needs import InputError
from ..results import parameters_of

STEP = 1e-4  # of differences, relative to a value
LENGTH = "Body/Length"


@dataclasses.dataclass
class Scene:
    """A parameter file (or its text, or a dict) with settings, ["Body/Length=2", ...]."""
    scene: object
    settings: list

    def __call__(self, more=()):
        """What the compiled part reads, with more settings."""
        return _source(self.scene, [*self.settings, *more])


class Model:
    """A scene as a function of its variables. It can be sent to another process."""

    def __init__(self, scene, effective, variables, data):
        """scene: a Scene; effective: its parameters.prm; variables: [(entry, from, to, start)]; data: Data."""
        self.scene, self.effective, self.parameters, self.data = scene, effective, parameters_of(effective), data
        self.names = [one[0] for one in variables]
        require_enough(data, self.names)
        self.low, self.high, self.start = np.array([one[1:] for one in variables]).T
        self._require_seen()
        self.accuracy, self.n_runs, self.problem, self.bound = None, 0, "", 0.0

    def _require_seen(self):
        """Raises InputError for variables that data cannot see, or with which a body ends before its data do."""
        if "Time/End time" in self.names:
            raise InputError('"Fit/Variables" has "Time/End time", but the data do not depend on it: all of them are measured before; another '
                             "variable is expected")
        if LENGTH in self.names and len(self.data.places):
            j, last, is_marker = self.names.index(LENGTH), float(self.data.places[-1]), self.data.kind == "markers"
            if self.low[j] < last:
                what = "the outermost marker is" if is_marker else "there is strain"
                advice = (' (with "Fit/Markers at" = first it is where the body of the scene ends: a list of places)' if self.parameters["Fit/Markers at"] == "first"
                          else ' (or other places in "Fit/Markers at")') if is_marker else ""
                raise InputError(f'"Fit/Variables" has "{LENGTH}" from {self.low[j]:g} to {self.high[j]:g}, but {what} at {last:g}, which is then beyond the '
                                 f"body; a range that begins at {last:g} or more is expected{advice}")

    def overrides(self, x):
        """Entries with these values; a list as a whole."""
        lists, others = {}, []
        for name, value in zip(self.names, x):
            match = re.fullmatch(r"(.*)\[(\d+)\]", name)
            if match:
                whole = lists.setdefault(match[1], str(self.parameters[match[1]]).split(","))
                whole += ["0"] * (int(match[2]) - len(whole))  # as the program fills up a list
                whole[int(match[2]) - 1] = repr(float(value))
            else:
                others.append(f"{name}={float(value)!r}")
        return [*others, *(f"{name}={', '.join(map(str.strip, whole))}" for name, whole in lists.items())]

    def _answer(self, x, accuracy, times, places):
        self.n_runs += 1
        settings = [*self.overrides(x), "Output/Number of snapshots=0", "Output/Statistics=false", "Output/Sensitivities=",
                    f"Accuracy={accuracy!r}"]
        return _compiled().run(self.scene(settings), times, places)

    def __call__(self, x, accuracy=None):
        """The numbers [time, place], and the stretch there if places are free; NaN if the run does not finish, for which problem
        has the reason."""
        data = self.data
        places = None if not len(data.places) else data.places.tolist()
        answer = self._answer(np.clip(x, self.low, self.high), accuracy or self.accuracy, data.t.tolist(), places)
        summary = json.loads(answer["summary"])
        if summary["status"] != "finished" or "fields" not in answer:
            self.problem = f"{summary['reason']}: {summary['message']}"
            return np.full(data.values.shape, np.nan), None
        self.bound = (summary.get("displacement_error") or {}).get("total") or 0.0
        fields = answer["fields"]
        if data.kind == "markers":
            return fields["displacement"] + data.places, fields["stretch"]
        if data.kind == "strain":
            return fields["stretch"] - 1, None
        if data.kind == "speed":
            return _mean(fields["velocity"]), None
        return _mean(fields["displacement"]) + (x[self.names.index(LENGTH)] if LENGTH in self.names else self.parameters[LENGTH]) / 2, None

    def jacobian(self, x, value=None):
        """Derivatives [time, place, variable]: differences on both sides, or, if value is the model at x, on one."""
        columns = []
        for j, at in enumerate(x):
            step = min(STEP * max(abs(at), 1e-2 * (self.high[j] - self.low[j])), 0.25 * (self.high[j] - self.low[j]))
            up, down = np.array(x, dtype=float), np.array(x, dtype=float)
            up[j], down[j] = at + step, at - step
            if up[j] > self.high[j]:
                up[j] = at
            elif down[j] < self.low[j] or value is not None:
                down[j] = at
            sides = [(side[j], self(side)[0]) for side in (up, down) if side[j] != at]
            sides = [side for side in sides if np.all(np.isfinite(side[1]))]
            if len(sides) < 2:  # at a limit, or the body inverts on the other side
                sides.append((at, value if value is not None else self(x)[0]))
            columns.append((sides[0][1] - sides[1][1]) / (sides[0][0] - sides[1][0]) if len(sides) == 2 else np.full(self.data.values.shape, np.nan))
        return np.stack(columns, axis=-1)


def _mean(values):
    """Over the body, from equidistant points (Simpson's rule)."""
    weights = np.ones(values.shape[1])
    weights[1:-1:2], weights[2:-1:2] = 4, 2
    return (values @ (weights / weights.sum()))[:, None]


def require_enough(data, variables):
    """Raises InputError if there are fewer data than unknown numbers."""
    n, unknown = int(data.is_there.sum()), len(variables) + data.n_constants
    if n <= unknown:
        raise InputError(f"there are {n} data, but {unknown} numbers are to be found ({len(variables)} variables, {data.n_constants} "
                         "for origin and places of the tracks); more data or fewer variables are expected")
