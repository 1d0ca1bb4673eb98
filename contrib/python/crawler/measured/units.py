# SPDX-License-Identifier: LGPL-2.1-or-later
"""Units behind names of columns, and the conversion factors between them."""
import re

from ..needs import InputError

PREFIXES = {"": 1.0, "n": 1e-9, "u": 1e-6, "µ": 1e-6, "μ": 1e-6, "m": 1e-3, "c": 1e-2, "k": 1e3, "M": 1e6}
OTHERS = {"1": ("1", 1.0), "-": ("1", 1.0), "%": ("1", 0.01), "min": ("s", 60.0), "h": ("s", 3600.0),
          "micron": ("m", 1e-6), "microns": ("m", 1e-6), "sec": ("s", 1.0), "second": ("s", 1.0), "seconds": ("s", 1.0)}


def split_unit(cell):
    """Name and unit of "t [s]", "t (s)" or "t / s"; the unit may be empty."""
    for pattern in (r"(.*?)\s*\[([^\[\]]*)\]", r"(.*?)\s*\(([^()]*)\)", r"([^/]*?)\s*/\s*(.*)"):
        if match := re.fullmatch(pattern, cell):
            return match[1].strip(), match[2].strip()
    return cell, ""


def unit_of(name):
    """Base and size of a unit ("mm": m, 0.001), or None."""
    if name in OTHERS:
        return OTHERS[name]
    match = re.fullmatch(r"(.??)(Pa|m|s|N|g)", name)
    return (match[2], PREFIXES[match[1]]) if match and match[1] in PREFIXES else None


def number_of(text):
    """Number, or a fraction like 1/30; None for anything else, e.g. 1_000, which Python would accept."""
    try:
        parts = [float(part) for part in str(text).replace("_", "x").split("/")]
        return parts[0] if len(parts) == 1 else parts[0] / parts[1] if len(parts) == 2 else None
    except (ValueError, ZeroDivisionError):
        return None


def unit_factor(found, wanted, option):
    """Factor of numbers in the unit @p found: a number wanted (also 1/30), or the conversion factor to the unit wanted.
    Raises InputError for the option."""
    number = number_of(wanted)
    if number is not None:
        if number == 0 or number != number or abs(number) == float("inf"):
            raise InputError(f'"{option}" is {wanted}, but another factor is expected')
        return number
    to = unit_of(wanted)
    if to is None:
        raise InputError(f'"{option}" is "{wanted}", but a number, a fraction like 1/30 or a unit is expected: m, s, min, h, N, '
                         "Pa, g, %, or one of them with n, u, m, c, k or M before it")
    unit = unit_of(found)
    if unit is None or unit[0] != to[0]:
        unit_found = f'the unit "{found}"' if found else "no unit"
        raise InputError(f'"{option}" is "{wanted}", but the file has {unit_found}, which cannot be converted into it; a factor is expected')
    return unit[1] / to[1]
