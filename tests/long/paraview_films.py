#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The scripts in contrib/paraview draw a run of either format, in ParaView itself: the body is where the files have it
and has the colours of its stretch, and a film has a picture for each frame.

    python3 paraview_films.py PATH_TO_CRAWLER PATH_TO_PVBATCH      77 without ParaView, ffmpeg or Xvfb
"""
import pathlib
import shutil
import subprocess
import sys

import numpy as np
from matplotlib.image import imread

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect, prm  # noqa: E402

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "contrib" / "paraview"
SCENE = prm("Output/Number of snapshots=4")


def draw(folder, screen, script, *arguments):
    """Calls a script; gives its exit code and what it says."""
    done = call([sys.argv[2], SCRIPTS / script, *arguments], folder, variables={"HOME": str(folder), "DISPLAY": screen})
    return done.returncode, done.stderr


def coloured(picture):
    """Which pixels of a picture have a colour (the ground is grey, the rest white)."""
    pixels = picture[..., :3]
    return pixels.max(axis=2) - pixels.min(axis=2) > 0.15


def main(folder):
    missing = [name for name in (sys.argv[2], "Xvfb", "ffmpeg") if shutil.which(name) is None]
    if missing:
        print(f"not installed: {', '.join(missing)} (Debian: python3-paraview, not beside python3-vtk9; xvfb, ffmpeg)")
        sys.exit(77)
    with subprocess.Popen(["Xvfb", "-displayfd", "1", "-screen", "0", "1280x1024x24"], stdout=subprocess.PIPE, text=True) as server:
        try:
            check_all(folder, ":" + server.stdout.readline().strip())
        finally:
            server.terminate()


def check_all(folder, screen):
    """Notes all that is wrong."""
    (folder / "scene.prm").write_text(SCENE)
    for style in ("vtu", "xdmf"):
        call([sys.argv[1], "run", "scene.prm", "--quiet", "--output", style, "--set", f"Output/Snapshot format={style}"], folder)
        code, text = draw(folder, screen, "movie.py", style, "--time", "0.25", "--output", f"{style}.png", "--size",
                          "800x240")
        if not expect(code == 0, f"{style}: movie.py makes no picture: {code} {text}"):
            return
    picture = imread(folder / "vtu.png")
    body = coloured(picture)[60:]  # below the words
    columns = np.flatnonzero(body.sum(axis=0) > 10)
    expect(body.sum() > 2000 and abs(columns.mean() - 400) < 40, "the camera follows the coloured body")
    # ParaView cuts quadrilaterals of a structured and of an unstructured grid into other triangles.
    different = np.abs(picture - imread(folder / "xdmf.png")).max(axis=2) > 0.05
    expect(different.mean() < 1e-3, f"both formats give the same picture: {different.sum()} pixels differ")
    code, text = draw(folder, screen, "movie.py", "vtu", "--output", "film.gif", "--size", "320x120", "--state",
                      "view.pvsm")
    expect(code == 0 and (folder / "view.pvsm").is_file(), f"movie.py makes a film and a state: {text}")
    count = call(["ffprobe", "-v", "error", "-count_frames", "-show_entries", "stream=nb_read_frames", "-of", "csv=p=0",
                  "film.gif"], folder)
    expect(count.stdout.strip() == "5", f"the film has 5 frames, not {count.stdout}")
    code, text = draw(folder, screen, "kymograph.py", "vtu")
    expect(code == 0 and coloured(imread(folder / "vtu" / "kymograph.png")).mean() > 0.2, f"a kymograph: {text}")
    code, text = draw(folder, screen, "movie.py", "nothing")
    expect(code == 2 and "nothing has neither solution.pvd nor solution.xdmf" in text, f"no run: {code} {text}")


checks.run((main,))
