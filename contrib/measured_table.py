#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes prm/examples/measured_table.csv: one stride of a larva's active stress as a measurement might have it.

    python3 contrib/measured_table.py > prm/examples/measured_table.csv

A contraction runs from tail (s = 0) to head (s = 4 mm) once in 1.2 s: m = 2 mN exp(4 cos(2 pi (s/L - t/P)) - 4), with an
error of 0.03 mN (the same in every call), rounded to 0.001 mN. The last time repeats the first, as the generator "table"
expects of a period.
"""
import math
import random

N_S, N_T, LENGTH, PERIOD = 17, 25, 4.0, 1.2

random.seed(6)
ERRORS = [[random.uniform(-1, 1) for _ in range(N_S)] for _ in range(N_T - 1)]
print("s,t,m")
for j in range(N_T):
    for i in range(N_S):
        s, t = LENGTH * i / (N_S - 1), PERIOD * j / (N_T - 1)
        m = 2 * math.exp(4 * math.cos(2 * math.pi * (s / LENGTH - t / PERIOD)) - 4)
        m += 0.03 * math.sqrt(3) * ERRORS[j % (N_T - 1)][i]
        print(f"{s:.2f},{t:.2f},{m:.3f}")
