# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers for a page: lists for JSON with as many digits as it shows, None for unknown ones."""
import numpy as np

DIGITS = 6  # significant digits of curves and of large tables
COLOURS, STEPS = 256, 20000  # number of colours of a picture; of steps of a field, from its least to its largest value
                             # in pictures


def plain(values, digits=None):
    """Rounds numbers to @p digits significant digits (None: all)."""
    values = np.asarray(values, dtype=float)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        if digits is not None:
            scale = 10.0 ** (digits - 1 - np.floor(np.log10(np.abs(values))))
            values = np.where(np.isfinite(scale), np.round(values * scale) / scale, values)
        known = np.isfinite(values)
        if np.all(np.abs(values[known]) < 2**53) and np.all(values[known] == np.floor(values[known])):
            values = np.where(known, values, 0).astype(np.int64)
    return [value if is_known else None for value, is_known in zip(values.tolist(), known)]


def some(n, most):
    """Indices of about @p most of n rows: equally spaced, and the last one."""
    return sorted({*range(0, n, -(-n // most) or 1), *range(n - 1, n)})


class Column:
    """Column of a table: values [row], numbers or texts, of which a page shows @p digits digits (None: all)."""

    def __init__(self, name, unit, meaning, values, digits=None):
        self.head = {"name": name, "unit": unit, "meaning": meaning}
        self.values, self.digits = np.asarray(values), digits
        self.is_text = self.values.dtype.kind in "SU"
        self.different, self.first, self.codes = np.unique(self.values, return_index=True, return_inverse=True)
        n, few = len(self.values), len(self.different)
        self.has_codes = self.is_text or few <= max(1, n / 8)
        self.size = n * (len(str(few)) + 1 if self.has_codes else (digits or 17) + 4)  # approximate size [byte]

    def json(self):
        """Dict {name, unit, meaning, values}; where few values repeat {..., values, codes}: these values in the order
        of their first occurrence, and the index of each row among them."""
        if not self.has_codes:
            return {**self.head, "values": plain(self.values, self.digits)}
        order = np.argsort(self.first)
        values = self.different[order]
        if values.dtype.kind == "S":
            values = np.char.decode(values, "utf-8", "replace")
        values = [text or None for text in values.tolist()] if self.is_text else plain(values)
        return {**self.head, "values": values, "codes": np.argsort(order)[self.codes].tolist()}


def is_line_between(axis, values, shown):
    """Returns True if every other row is, to a colour, the linear interpolation of its neighbours. @p axis [row], @p
    values [row, ...], @p shown: range of values in pictures."""
    part = ((axis[1:-1:2] - axis[:-2:2]) / (axis[2::2] - axis[:-2:2]))[:, None]
    line = (1 - part) * values[:-2:2] + part * values[2::2]
    return np.all(np.abs(np.clip(values[1:-1:2], *shown) - np.clip(line, *shown)) <= (shown[1] - shown[0]) / COLOURS)


def fields_of(kymograph, most_times):
    """Dict {places, times, fields: {name: {shown, step, values}}}, of the arrays of results.read_kymograph(): the range
    in pictures (two numbers), and values [time, place], in sequence, as multiples of step. Times and places that linear
    interpolation of the others reproduces are left out."""
    fields = {name: values for name, values in kymograph.items() if values.ndim == 2 and np.isfinite(values).any()}
    shown = {name: kymograph.get(f"shown_{name}", (np.nanmin(field), np.nanmax(field))) for name, field in fields.items()}
    axes = [kymograph["times"], kymograph["places"]]
    with np.errstate(divide="ignore", invalid="ignore"):
        for i in (0, 1):
            while len(axes[i]) > 64 and len(axes[i]) % 2 and all(
                    is_line_between(axes[i], np.moveaxis(values, i, 0), shown[name]) for name, values in fields.items()):
                axes[i] = axes[i][::2]
                fields = {name: values[::2] if i == 0 else values[:, ::2] for name, values in fields.items()}
    rows = some(len(axes[0]), most_times)
    data = {"places": plain(axes[1]), "times": plain(axes[0][rows]), "fields": {}}
    for name, values in fields.items():
        low, high = map(float, shown[name])
        step = float(f"{(high - low) / STEPS or max(abs(low), 1):.3g}")
        data["fields"][name] = {"shown": [low, high], "step": step, "values": plain(np.round(values[rows].ravel() / step))}
    return data
