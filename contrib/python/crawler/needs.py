# SPDX-License-Identifier: LGPL-2.1-or-later
"""What all commands and scripts in Python share: which modules they need, command lines, and how they end.

A script that fails says why in one sentence and ends with 2 (bad input), 3 (it could not be computed), 5 (stopped), 6 (a
file that cannot be written) or 69 (no Python has the modules that it needs).
"""
import argparse
import contextlib
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
DEBIANS_PYTHON, LACKING = "/usr/bin/python3", "CRAWLER_LACKING_PYTHON"  # the latter: what another Python lacks
PACKAGES = {name: f"python3-{name}" for name in ("h5py", "matplotlib", "numpy", "scipy")}


class InputError(ValueError):
    """The input is wrong: what was found, what was expected, and where."""
    code = 2


class FileError(OSError):
    """A file or folder cannot be read or written."""
    code = 6


class Failed(RuntimeError):
    """What was asked for could not be computed."""
    code = 3


class Stopped(RuntimeError):
    """A signal has stopped what was to be done."""
    code = 5


def script():
    """The name of the script that runs."""
    return pathlib.Path(sys.argv[0]).name


def complain(sentence):
    """Prints what is wrong, behind the name of the script; that of the program stands before the sentence already."""
    print(sentence if script() == "__main__.py" else f"{script()}: {sentence}", file=sys.stderr)


def need(*modules):
    """Sees to it that all modules are there: if this Python lacks one, Debian's Python goes on with the script. If that
    lacks one too, or is not there, the script ends and says which Python lacks what. Pictures need no screen. What modules
    warn of is not shown: standard error has the sentences of the program only."""
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


def write_whole(path, content):
    """Writes a file beside its place first, so that it is whole or not there; a link in its place is not followed."""
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


# Slips on a command line, in the words of argparse and in those of the program.
SLIPS = ((r"^argument (\S+): invalid float value: '(.*)'$", r'"\1" is "\2", but a number is expected'),
         (r"^argument (\S+): invalid int value: '(.*)'$", r'"\1" is "\2", but a whole number is expected'),
         (r"^argument (\S+): invalid choice: '(.*)' \(choose from (.*)\)$", r'"\1" is "\2", but one of \3 is expected'),
         (r"^argument (\S+): expected one argument$", r'a value is expected behind "\1"'),
         (r"^the following arguments are required: (.*)$", r"\1 missing"),
         (r"^unrecognized arguments: (.*)$", r'found "\1", but nothing more is expected'))


class Parser(argparse.ArgumentParser):
    """Says what is wrong with the command line in one sentence."""

    def error(self, message):
        word = message.removeprefix("unrecognized arguments: ").split(" ")[0]
        if word != message.split(" ")[0] and word.startswith("-"):
            near = difflib.get_close_matches(word, self._option_string_actions, n=1, cutoff=0)
            message = f'unknown option "{word}"; the nearest is "{near[0]}"'
        for pattern, sentence in SLIPS:
            message = re.sub(pattern, sentence, message)
        complain(f"{message} (--help tells the arguments)")
        self.exit(InputError.code)


def _stop(_number, _frame):
    """The first signal stops the script in order; more of them change nothing."""
    for number in STOPPING:
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt


def _end_with_the_program():
    """A program that is killed takes the script with it that it waits for (prctl(2), PR_SET_PDEATHSIG)."""
    if "CRAWLER_PROGRAM" in os.environ and hasattr(ctypes.CDLL(None), "prctl"):
        ctypes.CDLL(None).prctl(1, signal.SIGTERM)


def run_script(main):
    """Calls main() and says in one sentence what went wrong."""
    _end_with_the_program()
    for number in STOPPING:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, _stop)
    try:
        main()
        sys.stdout.flush()
    except (InputError, FileError, Failed, Stopped) as error:
        complain(error)
        sys.exit(error.code)
    except KeyboardInterrupt:
        complain("stopped by a signal")
        sys.exit(Stopped.code)
    except OSError as error:
        if error.filename is None:  # of standard output; what is left of it would be another error at the end
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(error, BrokenPipeError):  # the reader may leave
            complain(f"{error.filename or 'standard output'}: {error.strerror}")
            sys.exit(FileError.code)
