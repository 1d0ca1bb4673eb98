# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler fit: numbers of scenes from measured data, with their uncertainty; of several scenes, which the data prefer."""
import json
import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np

from .. import _source, to_prm
from ..measured.options import add_reading_options, reading_of
from ..needs import Failed, FileError, InputError, Parser, write_whole
from . import find, prepared
from .result import value_in_words

PICTURE = pathlib.Path(__file__).absolute().parents[1] / "plot" / "fit.py"

DESCRIPTION = """Finds numbers of a parameter file, with their uncertainty, from measured data (section Fit; doc/fit.md). With several
files all are fitted to the same data, and a table says which of them the data prefer."""


def command_line():
    """The options."""
    parser = Parser(prog="crawler fit", description=DESCRIPTION, allow_abbrev=False)
    parser.add_argument("files", metavar="FILE", nargs="+", help="parameter file with a section Fit")
    parser.add_argument("--data", metavar="FILE", help="what was measured (default: Fit/Data)")
    parser.add_argument("--set", action="append", default=[], metavar="ENTRY=VALUE", help="sets an entry (repeatable)")
    parser.add_argument("--output", metavar="DIR", help="output folder (default: output-NAME for NAME.prm)")
    parser.add_argument("--overwrite", action="store_true", help="replaces the results in the output folder")
    parser.add_argument("--quiet", action="store_true", help="prints nothing but errors")
    add_reading_options(parser)
    return parser


def folder_of(name, options):
    """The output folder of a parameter file."""
    stem = pathlib.Path(name).stem
    if options.output is None:
        return pathlib.Path(f"output-{stem}")
    return pathlib.Path(options.output) / stem if len(options.files) > 1 else pathlib.Path(options.output)


def require_new(folder, overwrite):
    """Raises InputError if the folder has something that is not to be replaced."""
    if folder.exists() and not folder.is_dir():
        raise InputError(f'"{folder}" is a file, but a folder is expected')
    if folder.exists() and any(folder.iterdir()):
        if not overwrite:
            raise InputError(f'"{folder}" exists and is not empty; another folder or "--overwrite" is expected')
        if not (folder / "residuals.csv").exists():
            raise InputError(f'"{folder}" is not the folder of a fit, so "--overwrite" replaces nothing in it; another folder is expected')


def lines_of(found):
    """What the screen shows."""
    goodness, width = found.goodness, max(map(len, found.variables))
    for name, one in found.variables.items():
        ends = one["interval_95"] or [None, None]
        interval = "" if not one["determined"] else " 95 %: " + " to ".join("the limit" if end is None else f"{end:.6g}" for end in ends)
        yield f"{name:{width}}  {value_in_words(one)}{interval}"
    fits = (f"chi-square {goodness.chi_square:.5g} with {goodness.degrees_of_freedom} degrees of freedom (probability {goodness.probability:.2g})"
            if goodness.deviation_is_given else f"standard deviation of a datum {goodness.deviation_of_data:.3g}, from the residuals")
    yield f"data: {goodness.n_data}, variables: {len(found.variables)}, besides for origin and places: {goodness.n_constants}; {fits}"
    alone = ["1 start: the minimum may be local (Fit/Starts)"] if len(found.starts) == 1 else []
    for sentence in [*found.undetermined, *found.notes, *alone]:
        yield f"{sentence[0].upper()}{sentence[1:]}."


def write(found, name, folder, settings):
    """All files of a fit; a sentence if there is no picture."""
    shutil.copyfile(name, folder / "original.prm")
    text = f"include {os.path.abspath(name)}\n" + to_prm({**dict(one.split("=", 1) for one in settings), **found.settings})
    write_whole(folder / "fitted.prm", text.encode())
    data = found.data
    rows = ["t,place,data,model,residual"]
    places = data.places if len(data.places) else np.full(1, np.nan)
    for i, t in enumerate(data.t):
        rows += [f"{t:.12g},{places[j]:.12g},{data.values[i, j]:.12g},{found.model[i, j]:.12g},{found.residuals[i, j]:.6g}"
                 for j in range(data.values.shape[1]) if data.is_there[i, j]]
    write_whole(folder / "residuals.csv", ("\n".join(rows) + "\n").encode())
    write_whole(folder / "summary.json", (json.dumps(found, indent=2) + "\n").encode())
    drawn = subprocess.run([sys.executable, PICTURE, folder], capture_output=True, text=True, check=False)
    return "" if drawn.returncode == 0 else f"There is no picture: {drawn.stderr.strip()}. Draw it later with: crawler plot {folder}"


def found_and_written(name, folder, model, settings, say):
    """The Fit, whose files are in the folder then, and a sentence if there is no picture."""
    try:
        folder.mkdir(parents=True, exist_ok=True)  # or it is too late to say so
    except OSError as error:
        raise FileError(f'cannot write to "{folder}": {error.strerror}') from None
    try:
        found = find(model, say)
        return found, write(found, name, folder, settings)
    except OSError as error:
        raise error if isinstance(error, FileError) else FileError(f'cannot write to "{folder}": {error.strerror or error}') from None
    finally:
        if not any(folder.iterdir()):
            folder.rmdir()


def table_of(fits):
    """Scenes in the order in which the data prefer them (Akaike), as lines."""
    best = {key: min(found.information[key] for found in fits.values()) for key in ("aic", "bic")}
    width = max(map(len, fits))
    yield f"{'scene':{width}}  variables  chi-square  AIC - least  BIC - least"
    for name, found in sorted(fits.items(), key=lambda one: one[1].information.aic):
        yield (f"{name:{width}}  {len(found.variables):9}  {found.goodness.chi_square:10.5g}  {found.information.aic - best['aic']:11.4g}  "
               f"{found.information.bic - best['bic']:11.4g}")


def main():
    """Fits, writes and tells."""
    options = command_line().parse_args(sys.argv[2:])
    say = (lambda text: None) if options.quiet else (lambda text: print(text, flush=True))
    if len(set(map(lambda name: pathlib.Path(name).stem, options.files))) < len(options.files):
        raise InputError("two of the parameter files have the same name, but names of their own are expected, as their folders have them")
    folders = {name: folder_of(name, options) for name in options.files}
    for folder in folders.values():
        require_new(folder, options.overwrite)
    for setting in options.set:
        if "=" not in setting:
            raise InputError(f'"--set" is "{setting}", but "Section/Entry=value" is expected')
    models = {name: prepared(lambda more, name=name: _source(name, [*options.set, *more]), options.data, **reading_of(options)) for name in folders}
    if len({int(model.data.is_there.sum()) for model, _ in models.values()}) > 1:
        raise InputError("the parameter files do not fit the same data, so they cannot be compared")
    fits = {}
    for name, folder in folders.items():
        model, notes = models[name]
        say("\n  ".join([f"{name}:", *notes]))
        found, problem = found_and_written(name, folder, model, options.set, lambda text: say(f"  {text}"))
        for line in [*lines_of(found), *filter(None, [problem]), f"Files in {folder}/"]:
            say(f"  {line}")
        fits[name] = found
    if len(fits) > 1:
        for line in table_of(fits):
            say(line)
    for name, found in fits.items():
        if found.status != "finished":
            raise Failed(f'the search for "{name}" did not end: the result is not the best one')
