# SPDX-License-Identifier: LGPL-2.1-or-later
"""Estimation of numbers of a scene from measured data: least squares, uncertainty, and what is undetermined
(doc/fit.md)."""
from .. import _compiled
from ..needs import InputError
from ..results import parameters_of
from .data import Data, read_data
from .fit import Interrupted, find
from .model import Model, Scene
from .result import Fit

__all__ = ["Data", "Fit", "Interrupted", "Model", "find", "prepared", "read_data"]


def prepared(scene, settings, data=None, **reading):
    """Model of a scene (a file, its text or a dict) with its data, and notes on it. settings: ["Body/Length=2", ...];
    data: a name, Samples, a list of them, or None, which stands for Fit/Data; reading: options of
    measured.read_samples(). Raises InputError, FileError."""
    scene = Scene(scene, settings)
    effective, notes, variables = _compiled().variables_of_fit(scene())
    parameters = parameters_of(effective)
    data = data if data is not None else parameters["Fit/Data"]
    if isinstance(data, (str, list, tuple)) and not data:
        raise InputError("Fit/Data is empty, but the name of a file with what was measured is expected (or --data)")
    return Model(scene, effective, variables, read_data(data, parameters, **reading)), notes
