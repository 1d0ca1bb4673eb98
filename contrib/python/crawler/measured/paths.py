# SPDX-License-Identifier: LGPL-2.1-or-later
"""Path or speed of the centre of mass, a column beside t: data of crawler fit besides samples along the body."""
import numpy as np

from ..needs import InputError
from .units import unit_factor

PATHS = {"centre": ("centre", "center", "centre of mass", "center of mass"), "speed": ("speed", "velocity")}  # names of columns
DEVIATIONS = ("deviation", "standard deviation", "sigma")
TIMES, ALONG = ("t", "time"), ("s", "marker", "track_id", "track n°", "track", "id", "x1")  # names of columns; the latter exclude a path


def path_in(sheet):
    """Returns (kind, t, values [time, 1], their deviations or None, unit of values, unit of t) of a sheet; None if it
    has no such column. Raises InputError if its times do not increase."""
    names = [one.lower() for one in sheet.names]
    found = [(kind, i) for kind, known in PATHS.items() for i, one in enumerate(names) if one in known]
    if not found or len(names) < 2 or set(names) & set(ALONG):
        return None
    kind, column = found[0]
    time = next((i for i, one in enumerate(names) if one in TIMES), None)
    if time is None:
        raise InputError(f'"{sheet.name}" has the columns {", ".join(sheet.names)}, but t is expected in addition to {sheet.names[column]}')
    t = sheet.times(time)
    if np.any(np.isnan(t)) or np.any(np.diff(t) <= 0):
        k = int(np.argmax(np.isnan(t))) if np.any(np.isnan(t)) else int(np.argmax(np.diff(t) <= 0)) + 1
        raise InputError(f'"{sheet.name}" has times that are missing or do not increase (row {sheet.lines[k]}), but increasing times are expected')
    deviation = next((sheet.column(i)[:, None] for i, one in enumerate(names) if one in DEVIATIONS), None)
    return kind, t, sheet.column(column)[:, None], deviation, sheet.units[column], sheet.units[time]


def factors_of_path(kind, unit, unit_t, unit_of_s, unit_of_t):
    """Factors of values and times. unit: of the values, of a speed e.g. mm/s; unit_of_s, unit_of_t: the wanted units,
    or ""."""
    length, _, time = unit.partition("/")
    factor_s = unit_factor(length.strip(), unit_of_s, "--unit-of-s") if unit_of_s else 1.0
    if not unit_of_t:
        return factor_s, 1.0
    per = unit_factor(time.strip() or unit_t, unit_of_t, "--unit-of-t") if kind == "speed" else 1.0
    return factor_s / per, unit_factor(unit_t, unit_of_t, "--unit-of-t")
