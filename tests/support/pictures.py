# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scripts of crawler plot, run in a fork of this process, which has loaded matplotlib already; and what their pictures say."""
import os
import pathlib
import re
import runpy
import subprocess
import sys
import tempfile
import traceback

import h5py  # noqa: F401
import matplotlib.pyplot  # noqa: F401

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "contrib/python/crawler/plot"


def draw(script, *arguments, folder="."):
    """What this script does when it is started in the folder: the finished process."""
    sys.stdout.flush()
    with tempfile.TemporaryFile("w+", encoding="utf-8") as out, tempfile.TemporaryFile("w+", encoding="utf-8") as errors:
        child = os.fork()
        if child == 0:
            code = 1
            try:
                os.dup2(out.fileno(), 1)
                os.dup2(errors.fileno(), 2)
                os.chdir(folder)
                sys.argv = [str(SCRIPTS / script), *arguments]
                sys.path.insert(0, str(SCRIPTS))
                runpy.run_path(sys.argv[0], run_name="__main__")
                code = 0
            except SystemExit as end:
                code = end.code or 0
            except BaseException:  # pylint: disable=broad-except
                traceback.print_exc()
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(code)
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        texts = [(file.seek(0), file.read())[1] for file in (out, errors)]
    return subprocess.CompletedProcess([script, *arguments], code, *texts)


def words(picture):
    """The texts of a picture in SVG (matplotlib leaves them as comments)."""
    return re.findall(r"<!-- (.*?) -->", pathlib.Path(picture).read_text(encoding="utf-8"), re.DOTALL)
