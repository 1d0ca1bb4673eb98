# SPDX-License-Identifier: LGPL-2.1-or-later
"""Output folder of a fit: its lock, the data kept for --resume, and the files at the end."""
import fcntl
import hashlib
import json
import math
import os
import pathlib
import subprocess
import sys

import numpy as np

from .. import to_prm
from ..measured.options import words_of
from ..needs import FileError, InputError, write_whole
from ..results import parameters_of
from . import earlier

PICTURE = pathlib.Path(__file__).absolute().parents[1] / "plot" / "fit.py"
LOCK, INPUTS = "study.lock", "inputs.json"  # the latter: inputs of the answer besides parameters.prm
EARLY = ("original.prm", "parameters.prm")  # written before INPUTS
OWN = (*EARLY, INPUTS, "fitted.prm", "residuals.csv", "summary.json", "fit.png", "report.html", "starts")
FREE = ("Fit/Starts", "Fit/Data")  # entries that --resume does not compare; of data only the numbers count


def require_usable(path, kind, marks, resume, overwrite):
    """Raises InputError if a folder is not free, not that of a fit or comparison (kind), or not to be replaced. marks:
    the file that identifies it, and others written before that one."""
    if path.exists() and not path.is_dir():
        raise FileError(f'"{path}" is a file, but a folder is expected')
    names = {file.name for file in path.iterdir()} - {LOCK} if path.exists() else set()
    is_own = any((path / place / marks[0]).exists() for place in (".", *earlier.NAMES)) or names <= {*earlier.NAMES, *marks[1:], *(f"{name}.part" for name in marks)}
    if resume and not is_own:
        raise InputError(f'"{path}" has no {kind} that can be resumed; another folder is expected for --output, or --overwrite')
    if overwrite and not is_own:
        raise InputError(f'"{path}" is not the folder of a {kind}, so "--overwrite" replaces nothing in it; another folder is expected')
    if names and not resume and not overwrite:
        if is_own and not is_finished(path):
            raise InputError(f'the output folder "{path}" has a {kind} that was interrupted; the same command with --resume continues it '
                             "(--overwrite starts over, --output gives another folder)")
        raise InputError(f'the output folder "{path}" is not empty; give another one with --output, or --overwrite to replace the '
                         "results in it")


def is_finished(path):
    """Returns True if the work in a folder has come to its end."""
    try:
        return json.loads((path / "summary.json").read_text(encoding="utf-8"))["status"] != "stopped"
    except (OSError, LookupError, TypeError, ValueError):
        return False


class Folder:
    """Folder of a fit."""

    def __init__(self, path, resume, overwrite, comparison=None):
        """Constructor; writes nothing yet. comparison: that of which the fit is a part. Raises InputError if the folder
        has content that must not be replaced or resumed."""
        self.path, self.resume, self.overwrite, self.comparison, self.lock = pathlib.Path(path), resume, overwrite, comparison, None
        self.earlier = earlier.Earlier(self.path, OWN)
        self.require_usable()

    def require_usable(self):
        """Raises InputError if the folder is not free, not that of a fit, or not to be replaced."""
        links = [name for name in (LOCK, *earlier.NAMES, *OWN) if (self.path / name).is_symlink()]
        if links:
            raise FileError(f'"{self.path / links[0]}" is a link, but one of the program\'s own is expected')
        require_usable(self.path, "fit", (INPUTS, *EARLY), self.resume, self.overwrite)

    def begin(self, name, model):
        """Makes and locks the folder; returns the starts that are kept there. name: of the parameter file. Raises
        InputError if the fit in it has another scene or other data."""
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            self.lock = _locked(self.path / LOCK)
            self.earlier.recover()
            self.require_usable()  # the previous owner of the lock may have written
            inputs = {"data": _digest(model.data), "files": _files_of(model.parameters)}
            if self.resume and (self.path / INPUTS).exists():
                self.require_same(model, inputs)
            else:
                self.start_over(name, model, inputs)
            return Starts(self.path / "starts", len(model.names), len(model.data.places))
        except (OSError, InputError) as error:
            self.leave()
            if isinstance(error, (FileError, InputError)):
                raise
            raise FileError(f'cannot write to "{self.path}": {error.strerror or error}') from None

    def start_over(self, name, model, inputs):
        """Writes the files that identify a fit. What was there stays if that is impossible or interrupted."""
        try:
            self.earlier.move_aside(self.comparison.was_finished if self.comparison else is_finished(self.path))
            write_whole(self.path / "original.prm", pathlib.Path(name).read_bytes())
            write_whole(self.path / "parameters.prm", model.effective.encode())
            write_whole(self.path / INPUTS, bytes_of(inputs))
        except BaseException:
            self.earlier.move_back()
            raise

    def require_same(self, model, inputs):
        """Raises InputError if the scene or the data differ from those of the fit in the folder."""
        try:
            effective = (self.path / "parameters.prm").read_text(encoding="utf-8")
            kept = json.loads((self.path / INPUTS).read_text(encoding="utf-8"))
            files = kept["files"]
            other_data = kept["data"] != inputs["data"]
        except (OSError, LookupError, TypeError, ValueError):
            raise InputError(f'the fit in "{self.path}" is damaged: {INPUTS} or parameters.prm cannot be read; --overwrite starts over') from None
        before = parameters_of(effective)
        changes = [f"{entry} was {_text(before.get(entry))} and is {_text(model.parameters.get(entry))}" for entry in sorted({*before, *model.parameters})
                   if before.get(entry) != model.parameters.get(entry) and entry not in FREE]
        changes += [f'the file "{file}" has changed' for file in sorted({*files, *inputs["files"]}) if files.get(file) != inputs["files"].get(file)]
        if changes:
            raise InputError(f'the fit in "{self.path}" was made with other parameters: {", ".join(changes)}; it can only be resumed '
                             "with the same ones (except for Fit/Starts)")
        if other_data:
            raise InputError(f'the fit in "{self.path}" was made with other data; it can only be resumed with the same ones')
        write_whole(self.path / "parameters.prm", model.effective.encode())

    def leave(self):
        """Releases the folder; removes it if it is empty."""
        if self.lock is None:
            return
        (self.path / LOCK).unlink(missing_ok=True)
        os.close(self.lock)
        self.lock = None
        if self.path.is_dir() and not any(self.path.iterdir()):
            self.path.rmdir()

    def write(self, found, settings, name):
        """Writes the files of a fit. settings: ["Body/Length=2", ...], of the parameter file name."""
        again = " ".join(["crawler fit fitted.prm", *words_of(found["measured"]["reading"])])
        entries = {**dict(one.split("=", 1) for one in settings), **found.settings, "Fit/Data": "; ".join(found["measured"]["files"])}
        text = f"# The scene with the values that a fit found; to repeat the fit: {again}\ninclude {os.path.abspath(name)}\n{to_prm(entries)}"
        write_whole(self.path / "fitted.prm", text.encode())
        rows = ["kind,t,place,data,model,residual"]
        for one, model, residuals in zip(found.data.series, *(of if isinstance(of, list) else [of] for of in (found.model, found.residuals))):
            places = one.places if len(one.places) else np.full(1, np.nan)
            rows += [f"{one.kind},{one.t[i]:.12g},{places[j]:.12g},{one.values[i, j]:.12g},{model[i, j]:.12g},{residuals[i, j]:.6g}"
                     for i, j in np.argwhere(one.is_there)]
        write_whole(self.path / "residuals.csv", ("\n".join(rows) + "\n").encode())
        self.write_summary(found)

    def write_summary(self, found):
        """Writes summary.json."""
        write_whole(self.path / "summary.json", bytes_of(found))


def drawn(path):
    """Draws the picture of a folder; returns an error message if there is none."""
    ended = subprocess.run([sys.executable, PICTURE, path], capture_output=True, text=True, check=False)
    return "" if ended.returncode == 0 else f"No picture was drawn: {ended.stderr.strip()}. Draw it later with: crawler plot {path}"


class Starts(dict):
    """Finished starts by their numbers, each in a file; damaged ones are searched again."""

    def __init__(self, folder, n_variables, n_places):
        super().__init__()
        self.folder = folder
        folder.mkdir(exist_ok=True)
        for file in folder.glob("*.json"):
            try:
                one = json.loads(file.read_text(encoding="utf-8"))
                one["squares"] = math.inf if one["squares"] is None else float(one["squares"])
                is_whole = (f'{one["start"]}.json' == file.name and len(one["z"]) == n_variables and len(one["places"]) == n_places
                            and {"reason", "n_runs", "n_cut"} <= one.keys() and np.all(np.isfinite([*one["z"], *one["places"]])))
            except (OSError, LookupError, TypeError, ValueError):
                continue
            if is_whole:
                super().__setitem__(one["start"], one)

    def __setitem__(self, number, one):
        write_whole(self.folder / f"{number}.json", bytes_of({**one, "squares": one["squares"] if math.isfinite(one["squares"]) else None}))
        super().__setitem__(number, one)


def bytes_of(content):
    """Bytes of a JSON file."""
    return (json.dumps(content, indent=2) + "\n").encode()


def _text(value):
    return f"{value:g}" if isinstance(value, (int, float)) else f'"{value}"' if value is not None else "not there"


def _digest(data):
    """Digest of all measured numbers, their places, and their deviations."""
    digest = hashlib.sha256()
    for one in data.series:
        digest.update(one.kind.encode())
        for values in (one.t, one.places, one.values, one.relative * (one.deviation or 0)):
            digest.update(np.ascontiguousarray(values, dtype=float).tobytes())
    return digest.hexdigest()


def _files_of(parameters):
    """Digests of the files that a scene reads."""
    names = [value for entry, value in parameters.items() if entry not in FREE and isinstance(value, str)
             and value.lower().endswith((".csv", ".h5", ".hdf5")) and os.path.isfile(value)]
    return {name: hashlib.sha256(pathlib.Path(name).read_bytes()).hexdigest() for name in names}


def _locked(path):
    """Locks a folder, in which one study writes at a time; returns a descriptor. Raises InputError if it is locked
    already."""
    while True:
        lock = os.open(path, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o666)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(lock)
            raise InputError(f'a run or study is writing to "{path.parent}"; wait for it to end, or give another folder with --output') from None
        except OSError:
            return lock  # a file system without locks
        if path.exists() and os.path.samestat(os.fstat(lock), os.stat(path)):
            return lock
        os.close(lock)  # removed by the other owner meanwhile
