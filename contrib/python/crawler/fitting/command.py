# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler fit: numbers of scenes from measured data, with their uncertainty; of several scenes, which the data prefer."""
import contextlib
import os
import pathlib
import shlex
import signal
import sys
import time

from .. import _compiled
from ..measured.options import add_reading_options, reading_of
from ..needs import Failed, InputError, Parser, Stopped, end_with_program
from . import Interrupted, find, prepared
from .comparison import Comparison, require_comparable
from .folder import Folder, drawn
from .result import ONE_START, value_in_words

DESCRIPTION = """Finds numbers of a parameter file, with their uncertainty, from measured data (section Fit; doc/fit.md). With several
files all are fitted to the same data, and a table says which of them the data prefer."""


def command_line():
    """Parses the options."""
    parser = Parser(prog="crawler fit", description=DESCRIPTION, allow_abbrev=False)
    parser.add_argument("files", metavar="FILE", nargs="+", help="parameter file with a section Fit")
    parser.add_argument("--data", action="append", metavar="FILE", help="measured data (repeatable, one file of each kind; default: Fit/Data)")
    parser.add_argument("--set", action="append", default=[], metavar="ENTRY=VALUE", help="sets an entry (repeatable)")
    parser.add_argument("--output", metavar="DIR", help="output folder (default: output-NAME for NAME.prm; of several "
                        "files output-comparison, with a folder NAME for each)")
    parser.add_argument("--resume", action="store_true", help="resumes a fit that was stopped or killed; starts it if there is nothing yet")
    parser.add_argument("--overwrite", action="store_true", help="replaces the results in the output folder")
    parser.add_argument("--workers", metavar="N", type=int, default=1, help="number of processes that share the starts (Fit/Starts)")
    parser.add_argument("--quiet", action="store_true", help="prints only errors")
    add_reading_options(parser)
    return parser


def path_of(name, options):
    """Output folder of a parameter file."""
    stem = pathlib.Path(name).stem
    if len(options.files) > 1:
        return pathlib.Path(options.output or "output-comparison") / stem
    return pathlib.Path(options.output or f"output-{stem}")


def lines_of(found):
    """Lines for the screen."""
    goodness, width = found.goodness, max(map(len, found.variables))
    for name, one in found.variables.items():
        ends = one["interval_95"] or [None, None]
        interval = "" if not one["determined"] else " 95 %: " + " to ".join("the limit" if end is None else f"{end:.6g}" for end in ends)
        yield f"{name:{width}}  {value_in_words(one)}{interval}"
    if found.status != "finished":
        return
    fits = (f"chi-square {goodness.chi_square:.5g} (degrees of freedom: {goodness.degrees_of_freedom}, probability {goodness.probability:.2g})"
            if goodness.deviation_is_given else f"standard deviation of a datum {goodness.series[0]['deviation']:.3g}, from the residuals")
    yield f"data: {goodness.n_data}, variables: {len(found.variables)}, further unknowns for origin and places: {goodness.n_constants}; {fits}"
    for one in goodness.series if len(goodness.series) > 1 else ():
        yield f"of {one['kind']}: {one['n_data']} data, chi-square {one['chi_square']:.5g}"
    for sentence in [*found.notes, *found.undetermined, *([ONE_START] if len(found.starts) == 1 else [])]:
        yield f"{sentence[0].upper()}{sentence[1:]}."


def origin_of(model, options, start):
    """Entries of every summary.json: the data, the time since start (time.monotonic()) [s], versions, command."""
    measured = options.data if options.data is not None else map(str.strip, model.parameters["Fit/Data"].split(";"))
    return {"measured": {"files": [os.path.abspath(name) for name in measured], "reading": reading_of(options)}, "seconds": time.monotonic() - start,
            "versions": _compiled().versions,
            "command_line": shlex.join(["crawler", *(word for word in sys.argv[1:] if word not in ("--resume", "--overwrite", "--quiet"))])}


class StoppedEarly(Stopped):
    """Stop before there were values."""


def found_and_written(name, folder, model, options, say):
    """Finds the Fit and writes its files to the folder. Raises Stopped when interrupted, after writing the files,
    too."""
    start = time.monotonic()

    def write(found):
        found.update(origin_of(model, options, start))
        folder.write(found, options.set, name)

    kept = folder.begin(name, model)
    try:
        found = find(model, say, kept, options.workers)
        write(found)
        for line in [*lines_of(found), *filter(None, [drawn(folder.path)]), f"Files in {folder.path}/"]:
            say(line)
        return found
    except (Interrupted, Stopped) as stop:
        so_far = getattr(stop, "so_far", None)
        if so_far is None:
            message = f"{str(stop) or 'stopped by a signal before there were values'}; --resume continues"
            folder.write_summary({"status": "stopped", "reason": "signal", "message": message, **origin_of(model, options, start)})
            raise StoppedEarly(message) from None
        write(so_far)
        for line in [*lines_of(so_far), f"Files in {folder.path}/"]:
            say(line)
        raise Stopped(so_far.message + (f'; until then the earlier results are in "{folder.earlier.aside}"' if folder.earlier.are_aside() else "")) from None


@contextlib.contextmanager
def naming(file):
    """Adds the name of the parameter file to error messages."""
    try:
        yield
    except (InputError, Failed) as error:
        raise error if str(file) in str(error) else type(error)(f"{file}: {error}") from None


def prepared_by(name, options):
    """Model of a parameter file and notes on it. Raises InputError and FileError."""
    with naming(name):
        return prepared(name, options.set, options.data, **reading_of(options))


def require_sense(options):
    """Raises InputError where options contradict each other or have no meaning."""
    if options.resume and options.overwrite:
        raise InputError("--resume and --overwrite contradict each other; one of them is expected")
    if options.workers < 1:
        raise InputError(f'"--workers" is {options.workers}, but a number of processes from 1 is expected')
    ranks = max(int(os.environ.get(name, "1")) for name in ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"))
    if ranks > 1:
        raise InputError(f'{ranks} processes of mpirun or srun were started, but a fit starts its own; "crawler fit --workers {ranks}" is expected')
    stems = {}
    for name in options.files:
        if (other := stems.setdefault(pathlib.Path(name).stem, name)) is not name:
            raise InputError(f'"{other}" and "{name}" have the same name, but different names are expected, as their folders are named after them')
        if pathlib.Path(name).suffix in (".csv", ".h5", ".hdf5", ".txt"):
            raise InputError(f'"{name}" is where parameter files are expected; "--data" is expected before each file of data')
    for setting in options.set:
        if "=" not in setting:
            raise InputError(f'"--set" is "{setting}", but "Section/Entry=value" is expected')


class Screen:
    """Prints unless it is quiet. A fit goes on if its output has no reader or no space."""

    def __init__(self, quiet):
        self.quiet, self.problem = quiet, None

    def __call__(self, text):
        try:
            if not self.quiet:
                print(text, flush=True)
        except OSError as error:
            self.problem = error

    def require_written(self):
        """Raises the OSError of a text that was lost."""
        if self.problem is not None:
            raise self.problem


def give_up(folders, name, comparison):
    """Leaves nothing of the fit with this name, and all earlier results as they were."""
    for one, folder in folders.items():
        if one == name or folder.earlier.are_aside():
            folder.earlier.move_back()
    if comparison and comparison.earlier.are_aside():
        comparison.earlier.move_back()


def fitted(models, folders, comparison, options, say):
    """Fits all models and writes their files: {name of a parameter file: Fit}."""
    fits = {}
    try:
        if comparison:
            comparison.begin()
        for name, folder in folders.items():
            model, notes = models[name]
            say("\n  ".join([f"{name}:", *notes]))
            with naming(name):
                fits[name] = found_and_written(name, folder, model, options, lambda text: say(f"  {text}"))
            if comparison:
                comparison.note([one for one, found in fits.items() if found.status == "finished"])
        for folder in folders.values():
            folder.earlier.drop()
        return fits
    except (InputError, Failed):
        give_up(folders, name, comparison)
        raise
    except StoppedEarly:
        if fits or not folders[name].earlier.are_aside():
            raise
        give_up(folders, name, comparison)
        raise Stopped("stopped by a signal before there were values; the earlier results stay") from None
    finally:
        for folder in folders.values():
            folder.leave()
        if comparison:
            comparison.leave()


def main():
    """Fits, writes and reports."""
    start = time.monotonic()
    options = command_line().parse_intermixed_args(sys.argv[2:])
    end_with_program(signal.SIGKILL)  # so that it does not hold its folder any longer; finished starts are kept
    say = Screen(options.quiet)
    require_sense(options)
    comparison = Comparison(path_of(options.files[0], options).parent, options) if len(options.files) > 1 else None
    folders = {name: Folder(path_of(name, options), options.resume, options.overwrite, comparison) for name in options.files}
    models = {name: prepared_by(name, options) for name in folders}
    if comparison:
        require_comparable({name: model for name, (model, _) in models.items()})
    fits = fitted(models, folders, comparison, options, say)
    if comparison:
        for line in comparison.written(fits, origin_of(models[options.files[0]][0], options, start)):
            say(line)
    for name, found in fits.items():
        if found.status != "finished":
            raise Failed(f"{name}: {found.message}")
    say.require_written()
