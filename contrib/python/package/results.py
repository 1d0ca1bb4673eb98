# SPDX-License-Identifier: LGPL-2.1-or-later
"""What runs and studies give, and how it is read from the folders of the program."""
import base64
import csv
import dataclasses
import functools
import json
import pathlib
import re
from xml.etree import ElementTree

import numpy as np


class FileError(OSError):
    """A file or folder cannot be read or written."""


class Numbers(dict):
    """A dict whose values are attributes too; dots lead to inner ones: n["gait.speed"], n["gait"]["speed"], n.gait.speed."""

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
    """The fields over time and body, arrays [time, point]; displacement and position are lengths."""
    t: np.ndarray  # [time]
    s: np.ndarray  # along the undeformed body, 201 equidistant points [length]
    position: np.ndarray
    displacement: np.ndarray
    stretch: np.ndarray
    velocity: np.ndarray
    active_stress: np.ndarray
    friction_force: np.ndarray


class Result(Numbers):
    """One run: the keys of summary.json (doc/user_guide.md, "summary.json"); what is not known is None.

    Besides: parameters, all entries with their values; fields and statistics (a row for each time step and snapshot),
    None if they were not wanted; local_sensitivities, arrays, None without Output/Sensitivities.
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
    """The folder of a sweep, atlas, tradeoff or optimisation: the keys of its summary.json.

    Besides: kind; table, a pandas.DataFrame (without pandas a dict of arrays); parameters; of an optimisation starts,
    a table, and best, the Results of the best gaits.
    """

    def __init__(self, summary=(), kind="", table=None, effective=""):
        super().__init__(summary)
        self.kind, self.table, self.parameters = kind, table, parameters_of(effective)
        self.starts, self.best = None, []

    def __repr__(self):
        return f"<crawler.Study: {self.kind}, {self.status}, columns {', '.join(self.table)}>"


def read(folder):
    """The results in a folder of `crawler run`, sweep, atlas, tradeoff or optimize: a Result or a Study."""
    folder = pathlib.Path(folder)
    summary_file = folder / "summary.json"
    if not summary_file.is_file():
        raise FileError(f'"{summary_file}" does not exist; the folder of a run or a study that has ended is expected')
    summary = json.loads(summary_file.read_text(encoding="utf-8"))
    prm = folder / "parameters.prm"
    effective = prm.read_text(encoding="utf-8") if prm.exists() else ""
    for kind, name in (("atlas", "atlas.csv"), ("tradeoff", "tradeoff.csv"), ("optimize", "starts.csv"),
                       ("sweep", "results.csv")):
        if not (folder / name).exists():
            continue
        study = Study(summary, kind, _read_table(folder / ("results.csv" if kind == "optimize" else name)), effective)
        if kind == "optimize":
            study.starts = _read_table(folder / name)
            study.best = [read(place) for place in sorted(folder.glob("best*")) if (place / "summary.json").exists()]
        return study
    result = Result(summary, effective)
    if (folder / "kymograph.vts").exists():
        result.fields = _read_kymograph(folder / "kymograph.vts", result.parameters)
    if (folder / "statistics.csv").exists():
        result.statistics = _read_table(folder / "statistics.csv")
    return result


def fields_of(t, length, values):
    """Fields of arrays [time, point] by their names."""
    s = np.linspace(0, length, values["displacement"].shape[1])
    return Fields(t=t, s=s, position=s + values["displacement"], **{name: values[name] for name in values})


def parameters_of(effective):
    """The values in a parameters.prm by their full names: numbers where they are numbers."""
    values, sections = {}, []
    for line in effective.splitlines():
        word, _, rest = line.split("#")[0].strip().partition(" ")
        if word == "subsection":
            sections.append(rest.strip())
        elif word == "end":
            sections.pop()
        elif word == "set":
            name, _, text = rest.partition("=")
            try:
                value = float(text)
            except ValueError:
                value = text.strip()
            values["/".join([*sections, name.strip()])] = value
    return values


def table_of(columns):
    """A pandas.DataFrame; without pandas a dict of arrays."""
    try:
        import pandas
    except ImportError:
        return {name: np.asarray(column) for name, column in columns.items()}
    return pandas.DataFrame(dict(columns))


def _read_table(path):
    """A CSV file of the program: numbers where all cells are numbers or empty (NaN); names without their units."""
    with open(path, newline="", encoding="utf-8") as file:
        names, *rows = csv.reader(file)
    columns = {}
    for name, cells in zip(names, zip(*rows) if rows else [()] * len(names)):
        try:
            if name in ("reason", "message") and not any(cells):
                raise ValueError
            values = np.array([float(cell) if cell else np.nan for cell in cells])
        except ValueError:
            values = list(cells)
        columns[re.sub(r" \[[^]]*\]$", "", name) if path.name == "statistics.csv" else name] = values
    return table_of(columns)


def _read_kymograph(path, parameters):
    """kymograph.vts has arrays in base 64, behind the number of their bytes; x is s/L, y is t/T."""
    try:
        piece = ElementTree.parse(path).getroot().find("StructuredGrid/Piece")
        arrays = {array.get("Name"): np.frombuffer(base64.b64decode(array.text)[8:])
                  for array in piece.iter("DataArray")}
        _, last, _, last_row, _, _ = map(int, piece.get("Extent").split())
        shape = (last_row + 1, last + 1)
        points = arrays.pop("Points").reshape(*shape, 3)
        return fields_of(points[:, 0, 1] * parameters["Time/End time"], parameters["Body/Length"],
                         {name: arrays[name].reshape(shape) for name in
                          ("displacement", "stretch", "velocity", "active_stress", "friction_force")})
    except (AttributeError, KeyError, ValueError, ElementTree.ParseError) as error:
        raise FileError(f'"{path}" is not a kymograph of crawler ({error})') from None
