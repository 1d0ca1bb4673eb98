#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""An installed crawler has all its parts, and works without the source and the build folder: no file of it names them,
and the program runs, draws and reports where these folders cannot be seen (if the machine allows that to be tried).

    python3 installed.py CMAKE BUILD_FOLDER
"""
import glob
import os
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect  # noqa: E402

CMAKE, BUILD = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
SOURCE = pathlib.Path(__file__).resolve().parents[2]
PARTS = ["bin/crawler", "include/crawler/scene/stress_plugin.h", "lib*/**/cmake/crawler/crawlerConfig.cmake",
         "share/bash-completion/completions/crawler", "share/man/man1/crawler.1",
         "share/crawler/python/crawler/plot/plotting.py", "share/crawler/python/crawler/report/page.html",
         "share/crawler/paraview/movie.py", "share/crawler/plugin/peristalsis.cc",
         "share/crawler/prm/default.prm", "share/crawler/prm/examples/earthworm.prm", "share/doc/crawler/README.md",
         "share/doc/crawler/LICENSE", "share/doc/crawler/doc/user_guide.md", "share/doc/crawler/doc/images/fig_2.png"]
# In a namespace of its own (user, files), with empty folders in place of source and build.
HIDDEN = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c",
          f'mount -t tmpfs none "{SOURCE}" && {{ [ ! -d "{BUILD}" ] || mount -t tmpfs none "{BUILD}"; }} && exec "$@"', "sh"]


def printed(*words, folder, before=()):
    end = call([*before, *words], folder, variables={"PATH": "/usr/bin:/bin"})
    expect(end.returncode == 0, f"{' '.join(map(str, words))}: {end.returncode}\n{end.stdout}{end.stderr}")
    return end.stdout


def main(here):
    prefix = here / "installed"
    printed(CMAKE, "--install", BUILD, "--prefix", prefix, "--strip", folder=here)
    parts = list(PARTS)
    if (BUILD / "python/crawler").is_dir():
        parts += ["lib/python3*/dist-packages/crawler/" + file for file in ("__init__.py", "results.py", "_core*.so")]
    for part in parts:
        expect(glob.glob(str(prefix / part), recursive=True), f"{part} is not installed")
    for path in sorted(prefix.rglob("*")):
        expect(not path.is_symlink(), f"{path} is a link")
        if path.is_file():
            for folder in (SOURCE, BUILD):
                expect(os.fsencode(folder) + b"/" not in path.read_bytes(), f"{path} names {folder}")

    can_hide = shutil.which("unshare") and call([*HIDDEN, "true"]).returncode == 0
    before = HIDDEN if can_hide else ()
    if not can_hide:
        print("Source and build folder are not hidden: unshare --user --mount is not allowed here")
    program = prefix / "bin/crawler"
    (here / "a.prm").write_text(printed(program, "init", "earthworm", folder=here, before=before))
    printed(program, "run", "a.prm", "--quiet", folder=here, before=before)
    printed(program, "plot", "output-a", "--output", "picture.png", folder=here, before=before)
    printed(program, "report", "output-a", folder=here, before=before)
    for file in ("output-a/summary.json", "picture.png", "output-a/report.html"):
        expect((here / file).is_file(), f"{file} is not there")
    expect("`inverted_inside`" in (here / "output-a/report.html").read_text(), "the report has no advice")
    if packages := glob.glob(str(prefix / "lib/python3*/dist-packages")):
        printed("/usr/bin/python3", "-c", f"import sys; sys.path.insert(0, '{packages[0]}'); import crawler; "
                "assert crawler.run('a.prm').displacement > 0", folder=here, before=before)
    printed(program, "run", prefix / "share/crawler/prm/examples/earthworm.prm", "--quiet", "--output", "example",
         folder=here, before=before)


checks.run((main,))
