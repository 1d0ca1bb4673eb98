# SPDX-License-Identifier: LGPL-2.1-or-later
"""Common parts of all commands and scripts in Python: required modules, command lines, tables, and exit codes.

A script that fails prints the reason in one sentence and ends with 2 (bad input), 3 (no result could be computed), 5
(stopped), 6 (a file that cannot be read or written) or 69 (no Python has the modules that it needs).
"""
import argparse
import contextlib
import csv
import ctypes
import difflib
import importlib
import logging
import os
import pathlib
import re
import signal
import sys
import warnings

STOPPING = (signal.SIGINT, signal.SIGTERM, signal.SIGUSR1)
DEBIANS_PYTHON, LACKING = "/usr/bin/python3", "CRAWLER_LACKING_PYTHON"  # the latter: modules that another Python lacks
CHART_LIBRARIES = [pathlib.Path(__file__).resolve().parents[1] / "crawler.libs/chart.min.js",  # of the wheel
                   pathlib.Path("/usr/share/javascript/chart.js/chart.min.js")]
PACKAGES = {name: f"python3-{name}" for name in ("h5py", "matplotlib", "numpy", "scipy")}


class InputError(ValueError):
    """Wrong input: what was found, what was expected, and where."""
    code = 2


class FileError(OSError):
    """File or folder that cannot be read or written."""
    code = 6


class Failed(RuntimeError):
    """Failure of a computation."""
    code = 3


class Stopped(RuntimeError):
    """Stop of the work by a signal."""
    code = 5


def script():
    """Name of the running script."""
    return pathlib.Path(sys.argv[0]).name


def complain(sentence):
    """Prints an error after the name of the script; alone in __main__.py, where that of the program precedes it."""
    print(sentence if script() == "__main__.py" else f"{script()}: {sentence}", file=sys.stderr)


def need(*modules):
    """Ensures that all modules exist: if this Python lacks one, Debian's Python continues the script. If that lacks one
    too, or does not exist, the script ends and names the missing modules. Pictures need no screen. Warnings of modules
    are suppressed: standard error has the messages of the program only."""
    warnings.simplefilter("ignore")
    logging.getLogger("matplotlib").setLevel(logging.ERROR)
    missing = []
    for name in modules:
        try:
            importlib.import_module(name)
        except ImportError:
            missing.append(name)
    if missing:
        lacks = f"{os.environ.get(LACKING, '')}{sys.executable} has no {' and no '.join(missing)}"
        if LACKING not in os.environ and sys.prefix != "/usr" and os.access(DEBIANS_PYTHON, os.X_OK):
            os.environ[LACKING] = lacks + "; "
            os.execv(DEBIANS_PYTHON, [DEBIANS_PYTHON, *sys.argv])
        packages = " ".join(PACKAGES[name] for name in missing)
        complain(f"{lacks} (on Debian: apt install {packages})")
        sys.exit(os.EX_UNAVAILABLE)
    if "matplotlib" in modules:
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
        plt.rcParams.update({"font.size": 10, "axes.titlesize": 10, "axes.labelsize": 10, "xtick.labelsize": 9,
                             "ytick.labelsize": 9, "axes.linewidth": 0.7, "hatch.linewidth": 0.5,
                             "svg.hashsalt": "crawler"})


def chart_library():
    """Text of Chart.js as a script of a page. Ends the script if it is missing."""
    found = next((path for path in CHART_LIBRARIES if path.is_file()), None)
    if found is None:
        complain(f"{CHART_LIBRARIES[-1]}, which draws charts, is missing (on Debian: apt install libjs-chart.js)")
        sys.exit(os.EX_UNAVAILABLE)
    return found.read_text(encoding="utf-8").replace("</script", "<\\/script")


def write_whole(path, content):
    """Writes a temporary file and renames it, so that the file is whole or missing; a link in its place is not
    followed."""
    part = path.with_name(path.name + ".part")
    try:
        part.unlink(missing_ok=True)
        with open(part, "xb") as file:
            file.write(content)
        part.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)
        raise FileError(f'cannot write "{path}": {error.strerror or error}') from None


def number(text):
    """Converts the text of a cell to a number; NaN if it is unknown."""
    return float(text) if text not in ("", None) else float("nan")


@contextlib.contextmanager
def open_table(path, errors="strict"):
    """Opens a CSV file of the program. Raises FileError if it cannot be read, and InputError if it is no such file."""
    try:
        with open(path, newline="", encoding="utf-8", errors=errors) as file:
            yield file
    except OSError as error:
        raise FileError(f'cannot read "{path}": {error.strerror or error}') from None
    except (ValueError, csv.Error) as error:
        raise InputError(f'"{path}" is no table of crawler ({error})') from None


def read_rows(path):
    """Rows of a CSV file of the program, as dictionaries of texts. Raises what open_table() does."""
    with open_table(path) as file:
        return list(csv.DictReader(file))


# Mistakes on a command line, in the words of argparse and in those of the program.
SLIPS = ((r"^argument (\S+): invalid float value: '(.*)'$", r'"\1" is "\2", but a number is expected'),
         (r"^argument (\S+): invalid int value: '(.*)'$", r'"\1" is "\2", but a whole number is expected'),
         (r"^argument (\S+): invalid choice: '?(.*?)'? \(choose from (.*)\)$", r'"\1" is "\2", but one of \3 is expected'),
         (r"^argument (\S+): expected one argument$", r'a value is expected after "\1"'),
         (r"^the following arguments are required: (.*)$", r"\1 missing"),
         (r"^unrecognized arguments: (.*)$", r'found "\1", but nothing more is expected'))


class Parser(argparse.ArgumentParser):
    """Argument parser that reports errors of the command line in one sentence."""

    def error(self, message):
        word = message.removeprefix("unrecognized arguments: ").split(" ")[0]
        if word != message.split(" ")[0] and word.startswith("-"):
            near = difflib.get_close_matches(word, self._option_string_actions, n=1, cutoff=0)
            message = f'unknown option "{word}"; the nearest is "{near[0]}"'
        for pattern, sentence in SLIPS:
            message = re.sub(pattern, sentence, message)
        complain(f"{message} (--help lists the arguments)")
        self.exit(InputError.code)


def _stop(_number, _frame, seen=[]):  # noqa: B006
    """Ends the script in an orderly way at the first signal; further ones do nothing."""
    if not seen:
        seen.append(_number)
        raise KeyboardInterrupt


def end_with_parent(number):
    """Asks for this signal when the process that waits for this one is killed (prctl(2), PR_SET_PDEATHSIG)."""
    if hasattr(ctypes.CDLL(None), "prctl"):
        ctypes.CDLL(None).prctl(1, int(number))


def end_with_program(number=signal.SIGTERM):
    """Asks for this signal when the program, if it started this script, is killed."""
    if "CRAWLER_PROGRAM" in os.environ:
        end_with_parent(number)


def run_script(main):
    """Calls main() and reports errors in one sentence. Signals, which the program blocks until here, stop it in
    order."""
    end_with_program()
    for number in STOPPING:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, _stop)
    try:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, STOPPING)
        main()
        sys.stdout.flush()
    except (InputError, FileError, Failed, Stopped) as error:
        complain(error)
        sys.exit(error.code)
    except KeyboardInterrupt:
        complain("stopped by a signal")
        sys.exit(Stopped.code)
    except OSError as error:
        if error.filename is None:  # standard output: unwritten text would be another error at the end
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(error, BrokenPipeError):  # the reader may leave
            complain(f"{error.filename or 'standard output'}: {error.strerror}")
            sys.exit(FileError.code)
