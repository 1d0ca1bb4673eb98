# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of studies, read and compared by scripts of the tests."""
import csv
import json
import math
import pathlib
import re

import h5py

# Keys and columns that tell how a result was made, which may be different for the same result.
COST = re.compile("second|cost_|speedup|command_line|memory|versions|ranks|checksum")


def json_of(file):
    return json.loads(pathlib.Path(file).read_text(encoding="utf-8"))


def summary_of(folder):
    return json_of(pathlib.Path(folder, "summary.json"))


def number_at(summary, key):
    """Number under a key with dots."""
    for word in key.split("."):
        summary = summary[word]
    return summary


def csv_rows(file):
    """Rows of a CSV file, by the names of its columns."""
    with open(file, newline="", encoding="utf-8") as lines:
        return list(csv.DictReader(lines))


def without_columns(text, *words):
    """Rows of a CSV text, without columns whose names have one of these words in them."""
    rows = list(csv.reader(text.splitlines()))
    kept = [i for i, name in enumerate(rows[0]) if not any(word in name for word in words)]
    return [[row[i] for i in kept if i < len(row)] for row in rows]


def answer_in(folder, *but):
    """What a command has computed: contents of all files of a folder, by their names, without COST. Not of files whose
    names end so."""
    return {str(file.relative_to(folder)): _answer(file) for file in sorted(pathlib.Path(folder).rglob("*"))
            if file.is_file() and not file.name.endswith(but)}


def _answer(file):
    if file.suffix == ".json":
        return _without_cost(json_of(file))
    if file.suffix == ".csv":
        return without_columns(file.read_text(encoding="utf-8"), *COST.pattern.split("|"))
    if file.suffix != ".h5":
        return file.read_bytes()
    found = {}

    def note(name, item):
        title = bytes(item.attrs["name"]).decode() if "name" in item.attrs else name
        if isinstance(item, h5py.Dataset) and not COST.search(title) and not COST.search(name):
            found[name] = item[()].tobytes() if item.dtype.kind != "O" else repr(item[()])
    with h5py.File(file, "r") as whole:
        whole.visititems(note)
    return found


def _without_cost(value):
    if isinstance(value, dict):
        return {key: _without_cost(one) for key, one in value.items() if not COST.search(key)}
    return [_without_cost(one) for one in value] if isinstance(value, list) else value


def h5_columns(file, group):
    """Columns of a table in HDF5, by their names: arrays of numbers, lists of texts."""
    with h5py.File(file, "r") as whole:
        return {bytes(data.attrs["name"]).decode(): list(data.asstr()[:]) if data.dtype.kind == "S" else data[:]
                for data in whole[group].values()}


def number(text):
    """Converts a text to a number; unknown values are empty in CSV and NaN in HDF5."""
    return float(text) if text else math.nan


def same_values(column, other):
    """Returns True if two columns are equal bit for bit."""
    return column == other if isinstance(column, list) else column.tobytes() == other.tobytes()


def same_columns(one, other, but="seconds"):
    """Returns True if two tables are equal bit for bit, except for columns whose name ends so (or with one of
    these)."""
    return one.keys() == other.keys() and all(same_values(one[name], other[name]) for name in one
                                              if not (but and name.endswith(but)))


def same_as_csv(columns, rows):
    """Returns True if a table in HDF5 has the columns, texts and numbers of one in CSV."""
    def same(column, texts):
        if isinstance(column, list):
            return column == texts
        return len(column) == len(texts) and all(a == b or (math.isnan(a) and math.isnan(b))
                                                 for a, b in zip(column, map(number, texts)))
    return set(columns) == set(rows[0]) and all(same(column, [row[name] for row in rows]) for name, column in columns.items())
