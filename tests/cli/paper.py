#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""contrib/paper/make_figures.py: all numbers of the paper's figures are right and are printed, the pictures
show something and are those of the page, a number that is off ends with 7.

    python3 paper.py PATH_TO_CRAWLER
"""
import pathlib
import sys

import numpy as np
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "contrib" / "paper" / "make_figures.py"
PAGE, KEPT = ROOT / "doc" / "paper.md", ROOT / "doc" / "images" / "paper"
PICTURES = ("fig_1a.png", "fig_2a.png", "fig_2b.png", "fig_3.png", "fig_s1.png", "movie.gif")
WRONG = """
import pathlib, sys
sys.path.insert(0, sys.argv[1])
sys.argv = ["make_figures.py", *sys.argv[2:]]
import make_figures
make_figures.RUNS = {}
make_figures.figures.ALL = [lambda results, numbers, out: numbers.require("Fig. 0", "a number", 1, VALUE, 1e-3, "nowhere")]
make_figures.run_script(make_figures.main)
"""


def test_pictures(out):
    """Sizes, contents, and that the kept ones look like the new ones."""
    page = PAGE.read_text(encoding="utf-8")
    for name in PICTURES:
        new, kept = Image.open(out / name), Image.open(KEPT / name)
        limit = 400_000 if name.endswith(".gif") else 80_000
        expect((KEPT / name).stat().st_size < limit, f"{name}: {(KEPT / name).stat().st_size} bytes, at most {limit}")
        grey = np.asarray(new.convert("L"), dtype=float)
        expect(min(grey.shape) >= 250 and grey.std() > 20, f"{name} is not blank: {grey.shape}, {grey.std():.0f}")
        expect(np.ptp(np.asarray(new.convert("RGB")).astype(int), axis=2).max() > 100, f"{name} has colours")
        expect(f"images/paper/{name}" in page and kept.size == new.size, f"{name} is on the page, as large as the new one")
        if kept.size == new.size and not name.endswith(".gif"):
            off = np.abs(np.asarray(kept.convert("L"), dtype=float) - grey).mean()
            expect(off < 4, f"{name} is the one on the page: mean difference of grey {off:.2f} of 255")
    film = Image.open(out / "movie.gif")
    frames = []
    for number in range(film.n_frames):
        film.seek(number)
        frames.append(np.asarray(film.convert("L"), dtype=float))
    changes = [np.abs(a - b).max() for a, b in zip(frames, frames[1:])]
    expect(len(frames) > 80 and min(changes) > 50, f"the film moves: {len(frames)} frames, least change {min(changes):.0f}")
    places = []
    for number in (10, 90):  # the same phase, four strides apart
        film.seek(number)
        ground = np.asarray(film.convert("RGB")).astype(int)[: film.size[1] // 2, : -110]  # without the colour bar
        places.append(np.nonzero(np.ptp(ground, axis=2) > 60)[1].mean())
    expect(places[1] > places[0] + 40, f"the coloured body goes to the right, by {places[1] - places[0]:.0f} pixels")


def test_numbers(out, printed):
    """All rows of the tables are printed, known numbers among them."""
    rows = [line for line in (out / "numbers.md").read_text(encoding="utf-8").splitlines() if line.startswith("|")]
    missing = [row for row in rows if row not in printed]
    expect(len(rows) > 30 and not missing, f"{len(rows)} rows of the tables are printed; missing: {missing}")
    for number in ("1.801968", "0.09007253", "0.08137766", "0.1559398"):
        expect(number in printed, f"{number} is printed")


def main(folder):
    program = pathlib.Path(sys.argv[1]).resolve()
    out = folder / "paper"
    end = call([sys.executable, SCRIPT, program, out])
    expect(end.returncode == 0, f"all numbers are right: {end.returncode} {end.stderr.strip()}")
    if end.returncode == 0:
        test_pictures(out)
        test_numbers(out, end.stdout)
    for value, code in ((1.0005, 0), (1.002, 7), (float("nan"), 7)):
        end = call([sys.executable, "-c", WRONG.replace("VALUE", f'float("{value}")'), SCRIPT.parent, program, out])
        expect(end.returncode == code, f"{value}, where 1 +- 1e-3 is expected: {end.returncode} {end.stderr.strip()[-200:]}")
    for arguments, word in (((folder,), "contrib/setup.sh"), ((program, program / "x"), "cannot make the folder"), ((), "BUILD")):
        end = call([sys.executable, SCRIPT, *arguments])
        expect(end.returncode in (2, 6) and end.stderr.count("\n") == 1 and word in end.stderr,
               f"bad input: {end.returncode} {end.stderr.strip()[-200:]}")


checks.run((main,))
