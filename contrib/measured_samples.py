#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes the examples of doc/measured_data.md, data as instruments leave them, with known truth.

    python3 contrib/measured_samples.py stress > larva_raw.csv
    python3 contrib/measured_samples.py tracks > tracks_raw.csv

stress: the active stress of prm/examples/measured_table.csv, m = 2 mN exp(4 cos(2 pi (s/L - t/P)) - 4) with L = 4 mm and
P = 1.2 s, by 17 sensors every 40 ms over 3.4 cycles, with an error of 0.06 mN, gaps, decimal commas, a title and units.

tracks: ten markers on a body of 4 mm in rest at first; the strain is 0.2 sin(2 pi (s/L + t/P)) r(t), where r(t) goes from 0
to 1 in the first half of a second, P = 1 s, and the body crawls 0.3 mm in each second; with an error of 0.004 mm.
"""
import math
import random
import sys

LENGTH = 4.0


def comma(value, digits):
    """A number as a spreadsheet of half of Europe writes it."""
    return f"{value:.{digits}f}".replace(".", ",")


def stress(error=0.06, period=1.2):
    """A wide table with gaps."""
    places = [LENGTH * i / 16 for i in range(17)]
    print("Larve 7, Kraftsensoren, 17.03.")
    print(";".join(["t [ms]", *(comma(s, 2) for s in places)]))
    print(";".join(["ms", *("mN" for _ in places)]))
    for j in range(103):
        row = []
        for i, s in enumerate(places):
            m = 2 * math.exp(4 * math.cos(2 * math.pi * (s / LENGTH - 0.04 * j / period)) - 4) + random.gauss(0, error)
            lost = random.random() < 0.02 or (i == 5 and 40 <= j < 43)
            row.append(random.choice(("", "NaN")) if lost else comma(m, 3))
        print(";".join([str(100 + 40 * j), *row]))


def displacement(s, t, period=1.0):
    """Of the point s; its derivative is the strain."""
    x = min(t / 0.5, 1)
    q = 2 * math.pi / LENGTH
    return 0.2 * x * x * (3 - 2 * x) / q * (math.cos(2 * math.pi * t / period) - math.cos(q * s + 2 * math.pi * t / period)) + 0.3 * t


def tracks(error=0.004):
    """A long table."""
    print("frame time (s),ID,X (mm)")
    for j in range(101):
        for i in range(10):
            s, t = 0.2 + 0.4 * i, 0.02 * j
            if random.random() > 0.01 or j == 0:
                print(f"{t:.2f},{i + 1},{7 + s + displacement(s, t) + random.gauss(0, error):.4f}")


if __name__ == "__main__":
    random.seed(6)
    KINDS = {"stress": stress, "tracks": tracks}
    if len(sys.argv) != 2 or sys.argv[1] not in KINDS:
        sys.exit(__doc__)
    KINDS[sys.argv[1]]()
