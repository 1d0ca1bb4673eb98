#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Modes of a body with linear strain feedback at small strain: does it start a wave of its own?

    python3 feedback_modes.py --modulus 0.1 --gain 0.5 --distance -0.25 --sensor 0.2 [--viscosity 0] [--cells 400]

For m = gain (w_near - 1) + viscosity w_t, with L = gamma = 1 (doc/generators/strain_feedback.md). A mode
exp(sigma t) of the strain grows if Re sigma > 0, and its period is 2 pi/|Im sigma|. Finite volumes of second order,
extrapolated from half the number of cells; needs numpy (Debian: python3-numpy).
"""
import argparse

import numpy as np


def sensor_means(n, distance, length):
    """The matrix [cell][cell] from the strain in n cells to its mean over the sensor of each of them."""
    ends = np.arange(n + 1) / n
    middles = np.clip((ends[:-1] + ends[1:]) / 2 + distance, length / 2, 1 - length / 2)
    left, right = middles - length / 2, middles + length / 2
    overlap = np.minimum(right[:, None], ends[None, 1:]) - np.maximum(left[:, None], ends[None, :-1])
    return np.maximum(overlap, 0) / length


def modes(n, modulus, gain, distance, length, viscosity):
    """The eigenvalues sigma of e_t = N_ss, N = k e + gain (mean of e) + viscosity e_t, N = 0 at the ends."""
    difference = n * (np.eye(n, n + 1, 1) - np.eye(n, n + 1))
    weights = np.full(n + 1, 1 / n)
    weights[[0, -1]] /= 2
    minus_laplace = difference @ (difference / weights).T / n
    force = modulus * np.eye(n) + gain * sensor_means(n, distance, length)
    sigma = np.linalg.eigvals(-np.linalg.solve(np.eye(n) + viscosity * minus_laplace, minus_laplace @ force))
    sigma = sigma[sigma.imag >= 0]
    return sigma[np.argsort(-sigma.real)]


def main():
    """Prints the modes that decay slowest, or grow."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("modulus", "gain", "distance", "sensor"):
        parser.add_argument(f"--{name}", type=float, required=True)
    parser.add_argument("--viscosity", type=float, default=0.0)
    parser.add_argument("--cells", type=int, default=400)
    a = parser.parse_args()
    if not 0 < a.sensor <= 1 or not abs(a.distance) < 1 or not a.modulus > 0 or a.cells < 20:
        parser.error("0 < sensor <= 1, |distance| < 1, modulus > 0 and at least 20 cells are expected")
    scene = (a.modulus, a.gain, a.distance, a.sensor, a.viscosity)
    coarse, fine = (modes(n, *scene)[:4] for n in (a.cells // 2, a.cells))
    for sigma in (4 * fine - coarse) / 3:
        period = f", period {2 * np.pi / sigma.imag:.5g}" if sigma.imag > 1e-9 else ""
        print(f"{'grows ' if sigma.real > 0 else 'decays'} at the rate {sigma.real:.6g}{period}")


if __name__ == "__main__":
    main()
