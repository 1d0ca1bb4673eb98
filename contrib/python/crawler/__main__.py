# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands of crawler that are written in Python. The program, whose path is CRAWLER_PROGRAM and
whose number as a process CRAWLER_PROGRAM_ID, calls them; without it:

    python3 -m crawler table IN.csv OUT.csv [options]
"""
import importlib
import os
import pathlib
import signal
import sys

HERE = pathlib.Path(__file__).absolute().parent  # in the build folder, or installed
COMMANDS = {"fit": ("fitting.command", ("numpy", "scipy")),  # module and the modules it needs
            "paper": ("paper", ("numpy", "h5py", "matplotlib")),
            "plot": ("pictures", ("numpy", "matplotlib")),
            "report": ("report.command", ("numpy", "h5py")),
            "table": ("measured.command", ("numpy", "scipy")),
            "tradeoff": ("tradeoff", ("numpy",))}  # part of the command left to Python


def place_of_package():
    """Folder of the package with its compiled part: for an installed program a folder of Python's path; else this
    one."""
    places = [HERE.parent, *(HERE.parents[3].glob("lib/python3*/dist-packages") if len(HERE.parents) > 3 else ())]
    return next((place for place in places if any(place.glob("crawler/_core*"))), HERE.parent)


if __name__ == "__main__":
    sys.path.insert(0, str(HERE))
    from needs import STOPPING, InputError, complain, end_with_program, need
    signal.pthread_sigmask(signal.SIG_BLOCK, STOPPING)  # until run_script()
    end_with_program()
    if os.getppid() != int(os.environ.pop("CRAWLER_PROGRAM_ID", os.getppid())):  # the program was killed before
        signal.raise_signal(signal.SIGTERM)
    if sys.argv[1:2] == [] or sys.argv[1] not in COMMANDS:
        complain(f"one of the commands {', '.join(COMMANDS)} is expected; others need the full program (doc/install.md)")
        sys.exit(InputError.code)
    module, needed = COMMANDS[sys.argv[1]]
    need(*needed)
    sys.path[0] = str(place_of_package() if sys.argv[1] == "fit" else HERE.parent)
    importlib.import_module("crawler.needs").run_script(importlib.import_module(f"crawler.{module}").main)
