# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results of runs and studies, read from the folders of the program."""
import base64
import contextlib
import csv
import dataclasses
import functools
import json
import os
import pathlib
import re
from xml.etree import ElementTree

import numpy as np

from .arguments import checked
from .needs import FileError, open_table


class Numbers(dict):
    """Dict whose values are attributes too; dots lead to inner ones: n["gait.speed"], n["gait"]["speed"],
    n.gait.speed."""

    def __init__(self, values=()):
        super().__init__({key: Numbers(value) if isinstance(value, dict) else value
                          for key, value in dict(values).items()})

    def __missing__(self, key):
        place = self
        for part in key.split("."):
            if not isinstance(place, dict) or part not in place:
                raise KeyError(key)
            place = dict.__getitem__(place, part)
        return place

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f'there is no "{name}"; there are {", ".join(self)}') from None

    def __dir__(self):
        return [*super().__dir__(), *self]


@dataclasses.dataclass
class Fields:
    """Fields over time and body, arrays [time, point]; displacement and position are lengths."""
    t: np.ndarray  # [time]
    s: np.ndarray  # along the undeformed body, by default 201 equidistant points [length]
    position: np.ndarray
    displacement: np.ndarray
    stretch: np.ndarray
    velocity: np.ndarray
    active_stress: np.ndarray
    friction_force: np.ndarray


class Result(Numbers):
    """Result of a run: the keys of summary.json (doc/user_guide.md, "summary.json"); unknown values are None.

    Further attributes: parameters, all entries with their values; fields and statistics (a row for each time step and
    snapshot), None if they were not requested; local_sensitivities, arrays, None without Output/Sensitivities.
    """

    def __init__(self, summary=(), effective=""):
        super().__init__(summary)
        self._effective = effective
        self.fields = self.statistics = self.local_sensitivities = None

    @functools.cached_property
    def parameters(self):
        return parameters_of(self._effective)

    def __repr__(self):
        error = (self.displacement_error or {}).get("total") if "displacement_error" in self else None
        number = "unknown" if self.displacement is None else f"{self.displacement:.10g}"
        number += "" if error is None else f" +- {error:.2g}"
        why = "" if self.status == "finished" else f" ({self.reason})"
        return f"<crawler.Result: {self.status}{why} at t = {self.end_time:g}, displacement {number}>"


class Study(Numbers):
    """Folder of a sweep, tradeoff, optimisation, fit or comparison of fits: the keys of its summary.json.

    Further attributes: kind; table, a pandas.DataFrame (a dict of arrays without pandas); parameters; for an
    optimisation starts, a table, and best, the Results of the best gaits.
    """

    def __init__(self, summary=(), kind="", table=None, effective=""):
        super().__init__(summary)
        self.kind, self.table, self.parameters = kind, table, parameters_of(effective)
        self.starts, self.best = None, []

    def __repr__(self):
        return f"<crawler.Study: {self.kind}, {self.status}, columns {', '.join(self.table)}>"


@checked
def read(folder: str | os.PathLike) -> "Result | Study":
    """Results in a folder of `crawler run`, sweep, tradeoff, optimize or fit: a Result or a Study."""
    folder = pathlib.Path(folder).expanduser()
    summary_file = folder / "summary.json"
    if not summary_file.is_file():
        raise FileError(f'"{summary_file}" does not exist; the folder of a run or a study that has ended is expected')
    try:
        summary = {**json.loads(summary_file.read_text(encoding="utf-8"))}
    except (TypeError, ValueError):
        raise FileError(f'"{summary_file}" is damaged: a JSON object is expected') from None
    prm = folder / "parameters.prm"
    effective = prm.read_text(encoding="utf-8") if prm.exists() else ""
    for kind, name in (("comparison", "comparison.csv"), ("tradeoff", "tradeoff.csv"), ("optimize", "starts.csv"),
                       ("fit", "residuals.csv"), ("sweep", "results.csv")):
        if not (folder / name).exists():
            continue
        study = Study(summary, kind, _read_table(folder / ("results.csv" if kind == "optimize" else name)), effective)
        if kind == "optimize":
            study.starts = _read_table(folder / name)
            study.best = [read(place) for place in sorted(folder.glob("best*")) if (place / "summary.json").exists()]
        return study
    result = Result(summary, effective)
    if (folder / "kymograph.vts").exists():
        result.fields = _fields_in(folder / "kymograph.vts", result.parameters)
    if (folder / "statistics.csv").exists():
        result.statistics = _read_table(folder / "statistics.csv")
    return result


def fields_of(t, length, values, places=None):
    """Fields of arrays [time, point] by their names; at these places, or at equidistant ones."""
    s = np.linspace(0, length, values["displacement"].shape[1]) if places is None else np.asarray(places, dtype=float)
    return Fields(t=t, s=s, position=s + values["displacement"], **{name: values[name] for name in values})


def entries_of(effective):
    """Entries in a parameters.prm by their full names: dicts of the texts value, default, unit and meaning."""
    entries, sections, comment = {}, [], []
    for line in map(str.strip, effective.splitlines()):
        word, _, rest = line.partition(" ")
        if word == "#":
            comment = [*comment, rest] if rest.strip("-") else []  # the first entry is below a line
            continue
        if word == "subsection":
            sections.append(rest.strip())
        elif word == "end" and sections:
            sections.pop()
        elif word == "set":
            name, _, text = rest.partition("=")
            value, _, remark = (part.strip() for part in text.partition("#"))
            meaning, _, expected = " ".join(comment).rpartition(" Expected: ")
            unit = re.search(r"Unit: ([^.]*)\.$", expected)
            entries["/".join([*sections, name.strip()])] = {
                "value": value, "default": remark[8:].strip() if remark.startswith("default:") else value,
                "unit": unit[1] if unit else "", "meaning": meaning}
        comment = []
    return entries


def parameters_of(effective):
    """Values in a parameters.prm by their full names: numbers where possible, whole ones as int. The dict is a scene
    for crawler.run()."""
    values = {name: entry["value"] for name, entry in entries_of(effective).items()}
    for name, text in values.items():
        with contextlib.suppress(ValueError):
            values[name] = int(text) if text.lstrip("+-").isdecimal() else float(text)
    return values


def table_of(columns):
    """Makes a pandas.DataFrame; a dict of arrays without pandas."""
    try:
        import pandas
    except ImportError:
        return {name: np.asarray(column) for name, column in columns.items()}
    return pandas.DataFrame(dict(columns))


def read_columns(path):
    """Reads a CSV file of the program: {heading: column}, arrays where all cells are numbers or empty (NaN), else lists
    of texts. Incomplete rows, left by an interrupted run, are skipped. Raises what open_table() does."""
    with open_table(path, "replace") as file:
        names, *rows = list(csv.reader(line.replace("\0", "") for line in file)) or [[]]
    rows, columns = [row for row in rows if len(row) == len(names)], {}
    for name, cells in zip(names, zip(*rows) if rows else [()] * len(names)):
        try:
            if name in ("reason", "message") and not any(cells):
                raise ValueError
            columns[name] = np.array([float(cell) if cell else np.nan for cell in cells])
        except ValueError:
            columns[name] = list(cells)
    return columns


def _read_table(path):
    """Reads a CSV file as a table; names without their units."""
    return table_of({re.sub(r" \[[^]]*\]$", "", name) if path.name == "statistics.csv" else name: column
                     for name, column in read_columns(path).items()})


def read_kymograph(path):
    """Reads kymograph.vts: its arrays by name. Those of fields are [time, point]; places [point] and times [time] are
    parts of the length and of the end time; others belong to the whole, e.g. "shown_stretch" [2], the range of a field
    in pictures. Raises FileError if the file is damaged."""
    try:
        grid = ElementTree.parse(path).getroot().find("StructuredGrid")  # base 64: number of bytes, then values
        arrays = {array.get("Name"): np.frombuffer(base64.b64decode(array.text)[8:])
                  for array in grid.iter("DataArray") if array.get("type") == "Float64"}
        _, last, _, last_row, _, _ = map(int, grid.find("Piece").get("Extent").split())
        points = arrays.pop("Points").reshape(last_row + 1, last + 1, 3)
        fields = {array.get("Name") for array in grid.find("Piece/PointData")}
        return {**{name: values.reshape(points.shape[:2]) if name in fields else values for name, values in arrays.items()},
                "places": points[0, :, 0], "times": points[:, 0, 1]}
    except (AttributeError, LookupError, TypeError, ValueError, ElementTree.ParseError) as error:
        raise FileError(f'"{path}" is not a kymograph of crawler ({error})') from None


def _fields_in(path, parameters):
    """Fields of a kymograph.vts."""
    arrays = read_kymograph(path)
    try:
        return fields_of(arrays["times"] * parameters["Time/End time"], parameters["Body/Length"],
                         {name: arrays[name] for name in
                          ("displacement", "stretch", "velocity", "active_stress", "friction_force")})
    except KeyError as error:
        raise FileError(f'"{path}" is not a kymograph of crawler, or its parameters.prm is missing ({error})') from None
