# SPDX-License-Identifier: LGPL-2.1-or-later
"""The commands of crawler that are written in Python. The program hands over to them; its name is CRAWLER_PROGRAM.

    python3 contrib/python/crawler table IN.csv OUT.csv [options]
"""
import importlib
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
COMMANDS = {"report": ("report.command", ("numpy", "h5py")),  # module and what it needs
            "table": ("measured.command", ("numpy", "scipy"))}

if __name__ == "__main__":
    sys.path.insert(0, str(HERE))
    from needs import need
    module, needed = COMMANDS[sys.argv[1]]
    need(*needed)
    sys.path[0] = str(HERE.parent)
    importlib.import_module("crawler.needs").run_script(importlib.import_module(f"crawler.{module}").main)
