# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings of the conversion of samples into a table."""
import dataclasses
import math
import numbers

import numpy as np

from ..needs import InputError


MOST = 100000  # points of a table in one direction, and cycles
NAMES = {int: "whole number", float: "number", str: "text"}


@dataclasses.dataclass
class Settings:
    """Settings of the conversion of samples into a table; the names are those of the options of crawler table."""
    gap: int = 3                # samples in a row that may be filled
    smooth_s: float = 0.0       # widths of the smoothing [length], [time]
    smooth_t: float = 0.0
    period: str = ""            # none; "find"; "whole": the duration; or a number
    cycles: int = 1             # number of repetitions of a period
    noise: float = None         # standard deviation of a sample
    points_s: int = 0           # equally spaced points of the table; 0: those of the samples
    points_t: int = 0
    markers_at: str = "first"   # places of markers: in the first frame, in the "mean" of all, or a list of numbers
    first_marker: float = 0.0   # place of the first marker, unless there is a list [length]
    length: float = None        # length of the body; else that up to the last marker
    ends: str = "hold"          # strain beyond the outermost markers: "hold" or "linear"

    def require_for_markers(self):
        """Raises InputError where an entry for markers is set and there are none."""
        for name in ("markers_at", "first_marker", "length", "ends"):
            if getattr(self, name) != getattr(Settings, name):
                raise InputError(f'"--{name.replace("_", "-")}" is for markers, which these samples do not have')

    def in_words(self, period=None):
        """Settings with a period and places of markers as texts, as of a command line. Raises InputError for settings that
        can be refused without samples."""
        places = self.markers_at
        if isinstance(places, (list, tuple, np.ndarray)):
            if not all(isinstance(one, numbers.Real) for one in places):
                raise InputError(f'"markers_at" is {places!r}, but "first", "mean" or a list of numbers is expected')
            places = ",".join(f"{float(one):.17g}" for one in places)
        result = dataclasses.replace(self, period=f"{period:.17g}" if period else str(self.period or ""), markers_at=places)
        result.require_sound()
        return result

    def require_sound(self):
        """Raises InputError for settings that can be refused without samples."""
        for field in dataclasses.fields(self):
            value, kind = getattr(self, field.name), {int: numbers.Integral, float: numbers.Real, str: str}[field.type]
            if not isinstance(value, kind) and not (value is None and field.default is None):
                raise InputError(f'"{field.name}" is {value!r}, but a {NAMES[field.type]} is expected')
        for name in ("smooth_s", "smooth_t"):
            if not 0 <= getattr(self, name) < math.inf:
                raise InputError(f'"--{name.replace("_", "-")}" is {getattr(self, name):g}, but a width of 0 or more is expected')
        for name in ("points_s", "points_t"):
            if getattr(self, name) and not 4 <= getattr(self, name) <= MOST:
                raise InputError(f'"--{name.replace("_", "-")}" is {getattr(self, name)}, but 4 to {MOST} points are expected')
        if self.gap < 0:
            raise InputError(f'"--gap" is {self.gap}, but a whole number of 0 or more is expected')
        if self.noise is not None and not 0 <= self.noise < math.inf:
            raise InputError(f'"--noise" is {self.noise:g}, but a standard deviation of 0 or more is expected')
        if self.length is not None and not 0 < self.length < math.inf:
            raise InputError(f'"--length" is {self.length:g}, but a positive length is expected')
        if not math.isfinite(self.first_marker):
            raise InputError(f'"--first-marker" is {self.first_marker:g}, but a place is expected')
        if self.ends not in ("hold", "linear"):
            raise InputError(f'"--ends" is "{self.ends}", but "hold" or "linear" is expected')
        if not 1 <= self.cycles <= MOST or (self.cycles > 1 and not self.period):
            raise InputError(f'"--cycles" is {self.cycles}, but a number of cycles of "--period", up to {MOST}, is expected')
