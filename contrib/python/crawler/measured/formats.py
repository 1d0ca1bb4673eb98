# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tracks of markers in the files of trackers: DeepLabCut and SLEAP (csv, h5), Tracker, FIMTrack, the Multi-Worm Tracker
(.spine), Tierpsy (hdf5). Files with a column for each quantity (TrackMate, ImageJ, Tierpsy's csv) are read by samples.py.
"""
import dataclasses
import io
import itertools
import pickle
import re

import numpy as np

from ..needs import InputError


WITH_ANIMALS = ("DeepLabCut", "SLEAP", "FIMTrack", "Multi-Worm Tracker", "Tierpsy")


@dataclasses.dataclass
class Tracks:
    """Places of markers: arrays [time, marker] with NaN for gaps; y and confidence may be None."""
    names: list
    t: np.ndarray
    x: np.ndarray
    y: np.ndarray
    confidence: np.ndarray
    format: str
    counts_frames: bool = True


def chosen_animal(names, wanted, name):
    """Name of the animal that is read. Raises InputError if there are several and none is named."""
    names = list(dict.fromkeys(names))
    if wanted and wanted not in names:
        raise InputError(f'"--animal" is "{wanted}", but "{name}" has {", ".join(names)}')
    if not wanted and len(names) > 1:
        raise InputError(f'"{name}" has {len(names)} animals ({", ".join(names[:5])}{", ..." if len(names) > 5 else ""}), but one is '
                         'expected; "--animal NAME" chooses')
    return wanted or names[0]


def tracks_of(sheet, animal):
    """Tracks of a sheet in the format of a tracker, or None if it is in none of these."""
    for read in (_deeplabcut, _sleap, _tracker, _fimtrack, _spine, _pairs):
        tracks = read(sheet, animal)
        if tracks is not None:
            return tracks
    return None


def _by_name(sheet, columns):
    """Tracks from columns (marker, quantity, index)."""
    names = list(dict.fromkeys(marker for marker, _, _ in columns))
    arrays = {}
    for marker, quantity, i in columns:
        array = arrays.setdefault(quantity, np.full((len(sheet.rows), len(names)), np.nan))
        array[:, names.index(marker)] = sheet.column(i)
    if "x" not in arrays:
        raise InputError(f'"{sheet.name}" has y of the markers {", ".join(names[:4])}, but no x; columns of both, like x1 and y1, are expected')
    return names, arrays


def _deeplabcut(sheet, animal):
    head = {row[0].lower(): row for row in sheet.head}
    if "bodyparts" not in head or "coords" not in head:
        return None
    if animal and "individuals" not in head:
        raise InputError(f'"--animal" is "{animal}", but "{sheet.name}" has no row of individuals')
    animals = head.get("individuals", [""] * len(head["coords"]))
    one = chosen_animal([name for name in animals[1:] if name != "single"], animal, sheet.name) if "individuals" in head else ""
    columns = [(head["bodyparts"][i], head["coords"][i].lower(), i) for i in range(1, len(head["coords"]))
               if not one or animals[i] == one]
    names, arrays = _by_name(sheet, [column for column in columns if column[1] in ("x", "y", "likelihood")])
    return Tracks(names, sheet.column(0), arrays["x"], arrays.get("y"), arrays.get("likelihood"), "DeepLabCut")


def _sleap(sheet, animal):
    names = [cell.lower() for cell in sheet.head[-1]] if sheet.head else []
    if "frame_idx" not in names or not any(name.endswith(".x") for name in names):
        return None
    keep = np.ones(len(sheet.rows), dtype=bool)
    if "track" in names:
        tracks = [row[names.index("track")] for row in sheet.rows]
        keep = np.array(tracks) == chosen_animal(tracks, animal, sheet.name)
    columns = [(match[1], match[2], i) for i, name in enumerate(sheet.head[-1])
               if (match := re.fullmatch(r"(.+)\.(x|y|score)", name)) and match[1] != "instance"]
    markers, arrays = _by_name(sheet, columns)
    arrays = {quantity: array[keep] for quantity, array in arrays.items()}
    return Tracks(markers, sheet.column(names.index("frame_idx"))[keep], arrays["x"], arrays.get("y"), arrays.get("score"), "SLEAP")


def _tracker(sheet, _animal):
    """Tracks of Tracker: the names of masses stand above pairs of x and y."""
    if len(sheet.head) < 2 or [cell.lower() for cell in sheet.head[-1][:3]] != ["t", "x", "y"]:
        return None
    masses, names = sheet.head[-2:]
    places = [i for i, name in enumerate(names) if name.lower() == "x"]
    if len(places) < 2 or not all(masses[i] for i in places):
        return None
    columns = [(masses[i], quantity, i + k) for i in places for k, quantity in enumerate("xy") if i + k < len(names)]
    markers, arrays = _by_name(sheet, columns)
    return Tracks(markers, sheet.times(0), arrays["x"], arrays["y"], None, "Tracker", counts_frames=False)


def _fimtrack(sheet, animal):
    """Tracks of FIMTrack: a row for each quantity and frame, a column for each larva; from tail to head."""
    pattern = re.compile(r"(head|tail|spinepoint_\d+)_(x|y)\((\d+)\)")
    found = [(match, r) for r, row in enumerate(sheet.rows) if (match := pattern.fullmatch(row[0]))]
    if not found or not sheet.head:
        return None
    column = sheet.head[-1].index(chosen_animal(sheet.head[-1][1:], animal, sheet.name))
    values = sheet.column(column)
    names = sorted({match[1] for match, _ in found},
                   key=lambda name: {"tail": (2, 0), "head": (0, 0)}.get(name) or (1, int(name.split("_")[1])))[::-1]
    frames = sorted({int(match[3]) for match, _ in found})
    place = {frame: j for j, frame in enumerate(frames)}
    arrays = {quantity: np.full((len(frames), len(names)), np.nan) for quantity in "xy"}
    for match, r in found:
        arrays[match[2]][place[int(match[3])], names.index(match[1])] = values[r]
    return Tracks(names, np.array(frames, dtype=float), arrays["x"], arrays["y"], None, "FIMTrack")


def _spine(sheet, animal):
    """Tracks of Choreography of the Multi-Worm Tracker: date, animal, time and pairs of x and y without names."""
    width = len(sheet.rows[0])
    if sheet.head or width < 3 + 2 * 4 or width % 2 == 0 or not re.fullmatch(r"\d{8}_\d{6}", sheet.rows[0][0]):
        return None
    animals = [row[1] for row in sheet.rows]
    keep = np.array(animals) == chosen_animal(animals, animal, sheet.name)
    values = np.array([sheet.column(i) for i in range(2, width)]).T[keep]
    return Tracks([str(i + 1) for i in range((width - 3) // 2)], values[:, 0], values[:, 1::2], values[:, 2::2], None,
                  "Multi-Worm Tracker", counts_frames=False)


def _pairs(sheet, _animal):
    """Tracks in columns t, x1, y1, x2, y2, ... or head_x, head_y, ..., as in files of WormLab and spreadsheets."""
    if not sheet.head:
        return None
    markers = []
    for i, name in enumerate(sheet.names[1:], 1):
        if match := re.fullmatch(r"([xy])[ _.]?(\d+)", name.lower()):
            markers.append((match[2], match[1], i))
        elif match := re.fullmatch(r"(.+?)[ _.]([xyXY])", name):
            markers.append((match[1], match[2].lower(), i))
    if not any(quantity == "y" for _, quantity, _ in markers) or len({marker for marker, _, _ in markers}) < 4:
        return None
    names, first = [name.lower() for name in sheet.names], markers[0][2]
    column = next((names.index(name) for name in ("t", "time", "timestamp") if name in names[:first]), first - 1)
    columns, arrays = _by_name(sheet, markers)
    return Tracks(columns, sheet.times(column), arrays["x"], arrays["y"], None, "pairs of x and y",
                  counts_frames=names[column].startswith("frame"))


def read_hdf5(path, animal):
    """Tracks of an HDF5 file of SLEAP (tracks, node_names), DeepLabCut (a group with table) or Tierpsy
    (coordinates/skeletons, timeseries_data), or of one with datasets t and x [time, marker]; or (s, t, values, name) of
    one with datasets s, t and m or strain. Raises InputError if it has none of these."""
    try:
        import h5py
    except ImportError:
        raise InputError(f'"{path}" is HDF5, for which this Python has no h5py (on Debian: apt install python3-h5py)') from None
    try:
        with h5py.File(path) as file:
            if "tracks" in file and "node_names" in file:
                return _sleap_hdf5(file, animal, path)
            if "coordinates/skeletons" in file and "timeseries_data" in file:
                rows = file["timeseries_data"][()]
                points = np.asarray(file["coordinates/skeletons"], dtype=float)
                animals = [str(index) for index in rows["worm_index"]]
                keep = np.array(animals) == chosen_animal(animals, animal, path)
                return Tracks([str(i) for i in range(points.shape[1])], rows["timestamp"][keep].astype(float), points[keep, :, 0],
                              points[keep, :, 1], None, "Tierpsy")
            for group in file.values():
                if "non_index_axes" in group.attrs and "table" in group:
                    return _deeplabcut_hdf5(group, animal, path)
            if {"t", "x"} <= set(file):
                return _plain_hdf5(file, path)
            for name in ("m", "strain", "stretch"):
                if {"s", "t", name} <= set(file):
                    s, t, values = (np.asarray(file[key], dtype=float) for key in ("s", "t", name))
                    if values.shape != (len(t), len(s)):
                        turned = " (the order is reversed)" if values.shape == (len(s), len(t)) else ""
                        raise InputError(f'"{name}" of "{path}" has {" x ".join(map(str, values.shape))} numbers, but {len(t)} times x '
                                         f'{len(s)} places are expected{turned}')
                    return s, t, values, name
            found = ", ".join(itertools.islice(file, 8))
    except (OSError, KeyError, ValueError, RuntimeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f'"{path}" cannot be read as HDF5: {error}') from None
    raise InputError(f'"{path}" is HDF5 with {found or "nothing in it"}, but "tracks" of SLEAP, the table of DeepLabCut, '
                     '"coordinates/skeletons" and "timeseries_data" of Tierpsy, t and x of markers, or s, t and m or strain are expected')


def _sleap_hdf5(file, animal, path):
    tracks = np.asarray(file["tracks"], dtype=float)  # [animal, xy, marker, frame]
    names = [name.decode() for name in file["node_names"][()]]
    animals = [name.decode() for name in file["track_names"][()]] if "track_names" in file else []
    animals = animals if len(animals) == len(tracks) else [str(i) for i in range(len(tracks))]
    one = animals.index(chosen_animal(animals, animal, path))
    scores = np.asarray(file["point_scores"], dtype=float)[one].T if "point_scores" in file else None
    return Tracks(names, np.arange(tracks.shape[3], dtype=float), tracks[one, 0].T, tracks[one, 1].T, scores, "SLEAP")


class _PlainUnpickler(pickle.Unpickler):
    """Reader of pickled lists of texts, which refuses everything else: it could run a program."""

    def find_class(self, module, name):
        raise pickle.UnpicklingError(f"{module}.{name}")


def _deeplabcut_hdf5(group, animal, path):
    """Tracks of a table of pandas, whose names of columns are a pickled list in an attribute."""
    try:
        columns = _PlainUnpickler(io.BytesIO(bytes(group.attrs["non_index_axes"]))).load()[0][1]
        columns = [tuple(map(str, column)) for column in columns]
    except (pickle.UnpicklingError, LookupError, TypeError, EOFError, ValueError):
        raise InputError(f'"{path}" is not of DeepLabCut: the names of columns of its table cannot be read') from None
    rows = group["table"][()]
    if "values_block_0" not in (rows.dtype.names or ()) or rows["values_block_0"].shape[1:] != (len(columns),) or len({*map(len, columns)} | {3, 4}) > 2:
        raise InputError(f'"{path}" has {len(columns)} names of columns (scorer, perhaps animal, body part, x, y or likelihood), but one for each column of '
                         "the table is expected")
    if len(columns[0]) == 4:
        one = chosen_animal([column[1] for column in columns if column[1] != "single"], animal, path)
    elif animal:
        raise InputError(f'"--animal" is "{animal}", but "{path}" has no animals with names')
    keep = [i for i, column in enumerate(columns) if len(column) == 3 or column[1] == one]
    names = list(dict.fromkeys(columns[i][-2] for i in keep))
    arrays = {quantity: np.full((len(rows), len(names)), np.nan) for quantity in ("x", "y", "likelihood")}
    for i in keep:
        if columns[i][-1] in arrays:
            arrays[columns[i][-1]][:, names.index(columns[i][-2])] = rows["values_block_0"][:, i]
    return Tracks(names, rows["index"].astype(float), *arrays.values(), "DeepLabCut")


def _plain_hdf5(file, path):
    """Tracks of datasets t, x [time, marker], and perhaps y, whose markers have numbers."""
    t, x = (np.asarray(file[name], dtype=float) for name in ("t", "x"))
    y = np.asarray(file["y"], dtype=float) if "y" in file else None
    for name, values in (("x", x), ("y", x if y is None else y)):
        if t.ndim != 1 or x.ndim != 2 or len(x) != len(t) or values.shape != x.shape:
            turned = " (the order is reversed)" if values.shape[-1:] == t.shape else ""
            raise InputError(f'"{name}" of "{path}" has {" x ".join(map(str, values.shape))} numbers, but {np.size(t)} times x markers are expected{turned}')
    return Tracks([str(i + 1) for i in range(x.shape[1])], t, x, y, None, "datasets t and x", counts_frames=False)
