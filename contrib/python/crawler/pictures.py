# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures, pages and figures of output folders: crawler plot chooses the script of a picture; plot(), report() and
paper() call the commands of these names."""
import os
import pathlib
import signal
import subprocess
import sys

import numpy as np

from .arguments import checked
from .needs import Failed, FileError, InputError, Parser, Stopped

HERE = pathlib.Path(__file__).absolute().parent
# Kinds of pictures, each with the script plot/KIND.py: of what, and the files by any of which a folder is recognised.
# The first that fits is drawn; those without files only if they are named.
KINDS = {"tradeoff": ("a tradeoff", ("tradeoff.csv", "tradeoff.h5")),
         "optimize": ("an optimisation", ("starts.csv", "starts.h5")),
         "fit": ("a fit", ("residuals.csv", "inputs.json", "comparison.csv")),
         "sweep": ("a sweep", ("results.h5",)),
         "calibration": ("a calibration", ("calibration.csv",)),
         "table": ("a table of crawler table", ()),
         "kymograph": ("a run", ("kymograph.vts", "statistics.csv", "solution.pvd", "summary.json")),
         "sensitivity": ("a run with Output/Sensitivities", ()),
         "scaling": ("the sweep of prm/studies/scaling.prm", ())}


def kind_of(name):
    """Kind of the picture of a folder or table. Raises InputError if there is nothing to draw."""
    path = pathlib.Path(name)
    if path.suffix == ".csv" and path.is_file():
        with open(path, encoding="utf-8", errors="replace") as file:
            first = next((line.strip() for line in file if line.strip()), "")
        if first.startswith("s,t,"):
            return "table"
        if "reported_error" in first:
            return "calibration"
        raise InputError(f'"{name}" has {first.count(",") + 1} columns, but s, t and m (or strain) are expected, as "crawler table" writes them, or those '
                         "of a calibration")
    if not path.is_dir():
        raise InputError(f'"{name}" is not a folder; the output folder of a run or study is expected (or the table of a calibration or of crawler table)')
    found = next((kind for kind, (_, files) in KINDS.items() if any((path / file).exists() for file in files)), None)
    if found is None:
        known = ", ".join(f"{of} ({files[0]})" for of, files in KINDS.values() if files)
        raise InputError(f'"{name}" has nothing to draw; the output folder of one of these is expected: {known}')
    return found


def main():
    """crawler plot DIR [--kind KIND] [options of its script]"""
    parser = Parser(prog="crawler plot", allow_abbrev=False, add_help=False)
    parser.add_argument("folder", metavar="DIR", nargs="?")
    parser.add_argument("--kind", default="")
    words = sys.argv[2:]
    options, others = parser.parse_known_args(words)
    if options.folder is None and {"-h", "--help"} & set(others):
        print(f"usage: crawler plot DIR [--kind KIND] [options of its script]\n\nKIND: {', '.join(KINDS)} (default: whichever fits)")
        return
    if options.folder is None:
        raise InputError('the folder is missing; "crawler plot DIR" is expected')
    if others and words.index(others[0]) < words.index(options.folder) and not os.path.exists(options.folder):
        raise InputError(f'"{others[0]}" is before the folder; "crawler plot DIR {others[0]} ..." is expected')
    if options.kind and options.kind not in KINDS:
        raise InputError(f'"--kind" is "{options.kind}", but one of {", ".join(f"{kind!r}" for kind in KINDS)} is expected'.replace("'", '"'))
    kind = options.kind or kind_of(options.folder)
    end = subprocess.run([sys.executable, HERE / "plot" / f"{kind}.py", options.folder, *others], check=False)
    if end.returncode == 0 and not options.kind and "--help" not in others and os.path.exists(os.path.join(options.folder, "sensitivity_body.csv")):
        print(f"Also available: crawler plot {options.folder} --kind sensitivity")
    sys.exit(end.returncode if end.returncode >= 0 else 128 - end.returncode)


def _called(command, path, options):
    """Output of a command in lines. options: True for a flag, False or None for nothing, a list for several values."""
    words = []
    for name, value in options.items():
        for one in value if isinstance(value, (list, tuple, np.ndarray)) else [value]:
            is_flag = isinstance(one, (bool, np.bool_))
            if one is not None and not (is_flag and not one):
                words += [f"--{name.replace('_', '-')}", *([] if is_flag else [os.fspath(one) if isinstance(one, os.PathLike) else str(one)])]
    own = {name: value for name, value in os.environ.items() if name != "CRAWLER_PROGRAM"}  # this process is not the program
    end = subprocess.run([sys.executable, HERE / "__main__.py", command, os.fspath(path), *words], capture_output=True, text=True, check=False, env=own)
    problem = end.stderr.strip() or f"crawler {command} was ended by a signal"
    if end.returncode == -signal.SIGINT:
        raise KeyboardInterrupt
    if end.returncode:
        raise {kind.code: kind for kind in (InputError, FileError, Failed, Stopped)}.get(end.returncode, RuntimeError)(problem)
    return end.stdout.splitlines()


def _written(lines):
    return [pathlib.Path(line.removeprefix("wrote ")) for line in lines if line.startswith("wrote ")]


@checked
def plot(folder: str | os.PathLike, *, kind: str | None = None, output: str | os.PathLike | None = None, **options) -> list[pathlib.Path]:
    """Draws the output folder of a run or study, or a table, as `crawler plot` does, and returns the paths of the pictures.

    kind: the picture, a name of KINDS; None: whichever fits. output: the name of the picture (.png, .svg, .pdf); None: in
    the folder. options: those of the script, e.g. last_stride=True, value="gait.speed" (crawler plot DIR --help).
    Raises InputError, and FileError where the picture cannot be written.
    """
    return _written(_called("plot", folder, {"kind": kind, "output": output, **options}))


@checked
def report(folder: str | os.PathLike) -> pathlib.Path:
    """Makes the page report.html of an output folder, as `crawler report` does, and returns its path. Raises InputError
    and FileError."""
    _called("report", folder, {"quiet": True})
    return pathlib.Path(folder) / "report.html"


@checked
def paper(folder: str | os.PathLike, *, output: str | os.PathLike | None = None, **options) -> list[pathlib.Path]:
    """Makes a figure and tables for a journal of the output folder of a run or sweep, as `crawler paper` does, and
    returns their paths.

    output: the folder of the files; None: paper in the output folder. options: columns=1 or 2, height=70 [mm], and those
    of the picture (crawler paper --help). Raises InputError and FileError.
    """
    return _written(_called("paper", folder, {"output": output, **options}))
