# SPDX-License-Identifier: LGPL-2.1-or-later
"""Content of the files of a folder for a page: dicts and lists for JSON, None for what is missing. All functions raise
FileError if a file is damaged."""
import json
import math
import os
import re

os.environ.setdefault("HDF5_USE_FILE_LOCKING", "FALSE")  # keeps a study in progress readable
import h5py
import numpy as np

from ..needs import FileError, InputError
from ..results import parameters_of, read_columns, read_kymograph
from .numbers import DIGITS, Column, fields_of, plain, some

MOST_STEPS, MOST_ROWS, MOST_BYTES = 2000, 100000, 9000000  # limits of a run; of a table: page < 10 MB


def text_of(path):
    """Text of a file; None if there is none."""
    return path.read_text(encoding="utf-8", errors="replace") if path.is_file() else None


def summary_in(folder):
    """summary.json."""
    text = text_of(folder / "summary.json")
    try:
        return None if text is None else {"status": json.loads(text)["status"], **json.loads(text)}
    except (LookupError, TypeError, ValueError):
        raise FileError(f'"{folder / "summary.json"}" is damaged: a JSON object with the key "status" is expected') from None


def differ(one, other):
    """True if two texts are not the same, nor the same number (1e-6, 1e-06)."""
    try:
        return float(one) != float(other)
    except ValueError:
        return one != other


def parameters_in(folder, effective, entries):
    """Entries that are not at their defaults, {entry, value, default, unit, meaning}, and the texts of the files, that
    of parameters.prm, @p effective, without comments."""
    bare = "".join(line + "\n" for line in effective.splitlines() if line.strip() and not line.strip().startswith("#"))
    return {"entries": [{"entry": name, **entry} for name, entry in entries.items() if differ(entry["value"], entry["default"])],
            "original": text_of(folder / "original.prm"), "effective": bare or None}


def units_of(entries):
    """Names of the user for the units: {length, time, force, energy}."""
    names = {word: entries.get(f"Units/{word.title()}", {"value": word})["value"] for word in ("length", "time", "force")}
    energy = f"{names['force']} {names['length']}"
    return {**names, "energy": energy if any(word != name for word, name in names.items()) else "energy"}


def curves_in(path):
    """Columns of a CSV file with numbers over time or body, a selection if there are many rows; None if there is no
    such file."""
    if not path.is_file():
        return None
    columns = []
    for heading, values in read_columns(path).items():
        name, unit = re.fullmatch(r"(.*?)(?: \[([^]]*)\])?", heading.strip()).groups()
        columns.append(Column(name, unit or "", "", np.asarray(values)[some(len(values), MOST_STEPS)], DIGITS).json())
    return columns


def run_in(folder, title, most_times):
    """Data of a run: summary, body, statistics, kymograph (of about @p most_times times), ground, sensitivities along
    the body."""
    values = parameters_of(text_of(folder / "parameters.prm") or "")
    run = {"title": title, "summary": summary_in(folder),
           "length": values.get("Body/Length", 1), "end_time": values.get("Time/End time", 1),
           "statistics": curves_in(folder / "statistics.csv"), "along_body": curves_in(folder / "sensitivity_body.csv"),
           "kymograph": None, "ground": None}
    path = folder / "kymograph.vts"
    if path.is_file():
        try:
            kymograph = read_kymograph(path)
        except FileError:
            raise FileError(f'"{path}" is damaged: an intact kymograph that crawler wrote is expected') from None
        run["kymograph"] = fields_of(kymograph, most_times)
        if "ground_factor" in kymograph:
            run["ground"] = {name: plain(kymograph[f"ground_{name}"], DIGITS) for name in ("x", "factor")}
    return run


def data_of_fit(path):
    """Tables of measured data, as in table_in(), one for each kind of data: time, place, data, the best run, and the
    residuals."""
    columns = read_columns(path)
    if list(columns) != ["kind", "t", "place", "data", "model", "residual"] or not all(isinstance(columns[name], np.ndarray) for name in columns if name != "kind"):
        raise FileError(f'"{path}" is damaged: the columns kind, t, place, data, model and residual are expected')
    kinds, tables = np.array(columns.pop("kind")), []
    for kind in dict.fromkeys(kinds.tolist()):
        unit, here = {"strain": "1", "speed": "length/time"}.get(kind, "length"), np.flatnonzero(kinds == kind)
        meanings = {"t": ("time", "time of the run"), "place": ("length", "where on the undeformed body"), "data": (unit, "what was measured"),
                    "model": (unit, "the best run"), "residual": (unit, "data less run, without what origin and places can take up")}
        rows = here[some(len(here), MOST_ROWS)]
        digits = None if len(rows) <= MOST_STEPS else DIGITS
        tables.append({"kind": kind, "all_rows": len(here), "rows": len(rows), "left_out": [],
                       "columns": [Column(name, *meanings[name], column[rows], digits).json() for name, column in columns.items() if np.any(np.isfinite(column[here]))]})
    return tables


def fits_within(folder, summary):
    """Results of each fit in a comparison: {its folder: status, variables and notes of its summary.json}; none if that
    is missing."""
    folders = [row["folder"] for row in summary.get("comparison", [])]
    return {name: {key: value for key, value in (summary_in(folder / name) or {}).items() if key in ("status", "variables", "notes")}
            for name in folders}


def runs_within(folder, inner):
    """Runs within a study, e.g. "points/5" or "best-2": its optima, or in the folder @p inner the points whose fields
    were kept, by their numbers."""
    pattern, found = r"()(\d{1,8})" if inner else r"best(-(\d{1,8}))?", []
    for path in (folder / inner).glob("*/summary.json"):
        match = re.fullmatch(pattern, path.parent.name)
        if match:
            found.append((int(match[2] or 0), path.parent.relative_to(folder).as_posix()))
    return [name for _, name in sorted(found)]


def rank_of(name, meaning, is_text, names):
    """Rank of a column for tables too large for all: first varied entries and status; then the displacement and other
    numbers with error bounds; the rest; the bounds of these, and messages."""
    if meaning.startswith("axis of the ") or meaning == "variable":
        return 0
    if name in ("message", "explanation") or name.startswith(("errors.", "sensitivities.")):
        return 4
    if is_text or name in ("index", "displacement", "displacement_error.total"):
        return 1
    return 2 if f"errors.{name.removesuffix('.value')}" in names else 3


def table_in(path, group):
    """Table of a study: its columns (those whose meaning begins with "axis" or is "variable" were varied), and the
    names of those left out because they would make the page too large; of very many rows an even selection."""
    try:
        with h5py.File(path, "r") as file:
            columns = [(*(data.attrs[word].decode() for word in ("name", "unit", "description")), data)
                       for data in file[group].values()]
            names = {name for name, *_ in columns}
            columns.sort(key=lambda one: rank_of(one[0], one[2], one[3].dtype.kind == "S", names))
            n = len(columns[0][3])
            stride = -(-n // MOST_ROWS) or 1
            # Strides coprime to the number of rows do not take the same value of an axis each time.
            while stride > 1 and math.gcd(stride, n) != 1:
                stride += 1
            table, free = {"all_rows": n, "rows": -(-n // stride), "columns": [], "left_out": []}, MOST_BYTES
            for name, unit, meaning, data in columns:
                is_varied = rank_of(name, meaning, False, names) == 0
                digits = None if table["rows"] <= MOST_STEPS else 10 if is_varied else DIGITS
                column = Column(name, unit, meaning, data[:][::stride], digits)
                if column.size > free:
                    table["left_out"].append(name)
                elif (one := column.json())["values"] != [None]:
                    table["columns"].append(one)
                    free -= column.size
            return table
    except (OSError, LookupError, ValueError, RuntimeError, AttributeError, TypeError):
        raise FileError(f'"{path}" is damaged: an intact table that crawler wrote is expected') from None
