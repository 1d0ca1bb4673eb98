#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The scaling study of doc/theory.md as a sweep: exponents within 1 % of theory, and exact where the worms are similar.

    python3 scaling.py PATH_TO_CRAWLER
"""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = ROOT / "prm" / "studies" / "scaling.csv"
DRAW = (sys.executable, ROOT / "contrib/python/crawler/plot/scaling.py")
EXACT = 1e-4  # per cent; Accuracy of the runs is 1e-6


def main(folder):
    made = call([sys.executable, "contrib/scaling_table.py"], ROOT)
    expect(made.stdout == TABLE.read_text(encoding="utf-8"), "scaling.csv is what contrib/scaling_table.py makes")
    sweep = call([pathlib.Path(sys.argv[1]).resolve(), "sweep", "prm/studies/scaling.prm", "--output", folder, "--strict"], ROOT)
    expect(sweep.returncode == 0, f"the sweep finishes ({sweep.returncode}) {sweep.stderr.strip()}")
    plot = call([*DRAW, folder, TABLE, "--require", "1"])
    expect(plot.returncode == 0, f"all exponents within 1 % ({plot.returncode}) {plot.stderr.strip()}")
    laws = re.findall(r"(\w+): (\w+) = (\S+) \* (\w+)\^(\S+) \(theory (\S+), off by (\S+) %\)", plot.stdout)
    expect(len(laws) == 6, f"{len(laws)} laws")
    for family, y, factor, x, power, theory, off in laws:
        wanted = EXACT if family in ("mass", "similar") else 1.0
        expect(float(off) <= wanted and abs(float(power) / float(theory) - 1) <= 0.01 * wanted,
               f"{family}: {y} ~ {x}^{power}, theory {theory}")
        if (family, y) == ("mass", "speed"):
            expect(abs(float(factor) / 3.8 - 1) < 0.01, f"a worm of 1 g goes {factor} mm/s")
    picture = folder / "scaling.png"
    expect(picture.is_file() and picture.stat().st_size > 20000, "the picture is there")
    strict = call([*DRAW, folder, TABLE, "--require", "0.01"])
    expect(strict.returncode == 1 and "at most 0.01 %" in strict.stderr, "--require ends with 1 if an exponent is off by more")


checks.run((main,))
