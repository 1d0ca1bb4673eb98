#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes examples of measured data with known truth: a table that a scene reads, and data as instruments leave them
(doc/measured_data.md).

    python3 contrib/measured_samples.py table > prm/examples/measured_table.csv
    python3 contrib/measured_samples.py stress > larva_raw.csv
    python3 contrib/measured_samples.py tracks > tracks_raw.csv

table: the active stress of a larva, m = 2 mN exp(4 cos(2 pi (s/L - t/P)) - 4) with L = 4 mm and P = 1.2 s: a contraction
that runs from tail (s = 0) to head once in 1.2 s, with an error of 0.03 mN, rounded to 0.001 mN. The last time repeats the
first, as the generator "table" expects of a period.

stress: the same, by 17 sensors every 40 ms over 3.4 cycles, with an error of 0.06 mN, gaps, decimal commas, a title and
units.

tracks: ten markers on a body of 4 mm in rest at first; the strain is 0.2 sin(2 pi (s/L + t/P)) r(t), where r(t) goes from 0
to 1 in the first half of a second, P = 1 s, and the body crawls 0.3 mm in each second; with an error of 0.004 mm.
"""
import math
import random
import sys

LENGTH, PERIOD, PLACES = 4.0, 1.2, 17


def contraction(s, t):
    """Active stress of the larva [mN]."""
    return 2 * math.exp(4 * math.cos(2 * math.pi * (s / LENGTH - t / PERIOD)) - 4)


def table(error=0.03, times=25):
    """A period, whose last time is the first one."""
    errors = [[random.uniform(-1, 1) for _ in range(PLACES)] for _ in range(times - 1)]
    print("s,t,m")
    for j in range(times):
        for i in range(PLACES):
            s, t = LENGTH * i / (PLACES - 1), PERIOD * j / (times - 1)
            m = contraction(s, t) + error * math.sqrt(3) * errors[j % (times - 1)][i]
            print(f"{s:.2f},{t:.2f},{m:.3f}")


def comma(value, digits):
    """A number as a spreadsheet of half of Europe writes it."""
    return f"{value:.{digits}f}".replace(".", ",")


def stress(error=0.06):
    """A wide table with gaps."""
    places = [LENGTH * i / 16 for i in range(PLACES)]
    print("Larve 7, Kraftsensoren, 17.03.")
    print(";".join(["t [ms]", *(comma(s, 2) for s in places)]))
    print(";".join(["ms", *("mN" for _ in places)]))
    for j in range(103):
        row = []
        for i, s in enumerate(places):
            m = contraction(s, 0.04 * j) + random.gauss(0, error)
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
    KINDS = {"table": table, "stress": stress, "tracks": tracks}
    if len(sys.argv) != 2 or sys.argv[1] not in KINDS:
        sys.exit(__doc__)
    KINDS[sys.argv[1]]()
