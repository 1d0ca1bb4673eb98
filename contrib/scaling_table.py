#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes prm/studies/scaling.csv: earthworms of 0.012 to 8.5 g that are scaled copies of each other, and one worm at many
stride frequencies.

    python3 contrib/scaling_table.py > prm/studies/scaling.csv

Units mm, s, mN, g. A worm of 1 g is 100 mm long, so it has a cross-section of 10 mm^2, and with 10 kPa a modulus of 100 mN.
Length and friction coefficient ~ M^(1/3), stride frequency nu ~ M^0 (the paper); the wave speed is nu L, and the velocity
wave's coefficient a_1 is as large, so the strain is the same for all. The families differ in the elastic modulus k:

mass       k ~ M, so that k/(gamma c L) is the same for all: the worms are similar, and the laws exact
material   k ~ M^(2/3), the same material in all
frequency  k the same at all frequencies of a worm of 1 g
similar    k ~ nu for a worm of 1 g: k/(gamma c L) is the same again
"""
LENGTH, FRICTION, MODULUS, FREQUENCY = 100.0, 1e-3, 100.0, 0.32  # of a worm of 1 g: mm, mN s/mm^2, mN, 1/s
N = 15  # in a family

print("family,mass,frequency,length,friction,modulus,wave_speed,end_time")


def row(family, mass, frequency, modulus):
    """One worm, ten strides."""
    third = mass ** (1 / 3)
    length = LENGTH * third
    print(f"{family},{mass:.12g},{frequency:.12g},{length:.12g},{FRICTION * third:.12g},{modulus:.12g},"
          f"{frequency * length:.12g},{10 / frequency:.12g}")


MASSES = [0.012 * (8.5 / 0.012) ** (i / (N - 1)) for i in range(N)]
FREQUENCIES = [0.05 * 20 ** (i / (N - 1)) for i in range(N)]
for m in MASSES:
    row("mass", m, FREQUENCY, MODULUS * m)
for m in MASSES:
    row("material", m, FREQUENCY, MODULUS * m ** (2 / 3))
for nu in FREQUENCIES:
    row("frequency", 1.0, nu, MODULUS)
for nu in FREQUENCIES:
    row("similar", 1.0, nu, MODULUS * nu / FREQUENCY)
