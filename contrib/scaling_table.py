#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes prm/studies/scaling.csv: earthworms of 0.012 to 8.5 g that are scaled copies of each other, and one worm at many
stride frequencies.

    python3 contrib/scaling_table.py > prm/studies/scaling.csv

Units mm, s, mN, g. Scaling of the paper: length and friction coefficient ~ M^(1/3), stride frequency nu ~ M^0; the wave
speed is nu L, the velocity wave's coefficient a_1 is as large as the wave speed (so the strain is the same for all), and
the elastic modulus ~ M (so that k/(gamma c L) is the same for all).
"""
LENGTH, FRICTION, MODULUS, FREQUENCY = 100.0, 1e-3, 30.0, 0.3  # of a worm of 1 g: mm, mN s/mm^2, mN, 1/s

print("family,mass,frequency,length,friction,modulus,wave_speed,end_time")


def row(family, mass, frequency):
    """One worm, ten strides."""
    third = mass ** (1 / 3)
    length = LENGTH * third
    print(f"{family},{mass:.12g},{frequency:.12g},{length:.12g},{FRICTION * third:.12g},{MODULUS * mass:.12g},"
          f"{frequency * length:.12g},{10 / frequency:.12g}")


N = 15
for i in range(N):
    row("mass", 0.012 * (8.5 / 0.012) ** (i / (N - 1)), FREQUENCY)
for i in range(N):
    row("frequency", 1.0, 0.05 * 20 ** (i / (N - 1)))
