#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The displacement of a body whose unknown is the stretch, by finite volumes on graded meshes and Richardson's extrapolation.

Shares nothing with the program: cells with one stretch w each, mobilities w^(-a)/gamma averaged at the faces (the arithmetic
mean where the emptier cell receives, the harmonic mean elsewhere), LSODA with a banded Jacobian. Made for soft bodies, whose
thin layers at the ends it resolves, and for collapsing ones. Optimal wave with a_1 = 1; gamma = L = 1.

    python3 stretch.py K P CHI C T [CELLS]      prints the displacement and its change from the mesh before
"""
import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq


def mesh(n, layer):
    """Ends of n cells of the body [0, 1]; half of them lie in layers of this thickness at both ends."""
    total = 2 * np.log((layer + 1) / layer)

    def share(s):
        return 0.5 * (np.log((layer + s) / layer) + np.log((layer + 1) / (layer + 1 - s))) / total + 0.5 * s

    return np.array([0.] + [brentq(lambda s, x=i / n: share(s) - x, 0, 1, xtol=1e-15) for i in range(1, n)] + [1.])


def displacement(n, k, p, chi, c, duration, tolerance=1e-10):
    """Of the centre of mass after this duration, with n cells."""
    a, q = 1. - p, 2 * np.pi
    ends = mesh(n, min(0.02, 3 * k / abs(chi)))
    h = np.diff(ends)
    s = 0.5 * (ends[:-1] + ends[1:])
    reach = np.concatenate(([h[0] / 2], 0.5 * (h[:-1] + h[1:]), [h[-1] / 2]))

    def stress(t):
        return chi * ((np.cos(q * c * t) - np.cos(q * (s + c * t))) / q - k / c * (np.sin(q * (s + c * t)) - np.sin(q * s)))

    def velocity(t, w):
        force = stress(t) + k * (w - 1)
        pull = np.concatenate(([force[0]], np.diff(force), [-force[-1]]))
        mobility = np.maximum(w, 1e-300)**(-a)
        left, right = mobility[:-1], mobility[1:]
        fills = pull[1:-1] * (w[1:] - w[:-1]) > 0
        inner = np.where(fills, 0.5 * (left + right), 2 / (1 / left + 1 / right))
        return pull * np.concatenate(([mobility[0]], inner, [mobility[-1]])) / reach

    def rate(t, y):
        v = velocity(t, y[1:])
        return np.concatenate(([v[0]], np.diff(v) / h))

    start = np.concatenate(([0.], np.ones(n)))
    end = solve_ivp(rate, (0, duration), start, method="LSODA", rtol=tolerance, atol=tolerance, lband=2, uband=2,
                    max_step=0.02 / abs(c)).y[:, -1]
    nodes = end[0] + np.concatenate(([0.], np.cumsum(h * (end[1:] - 1))))  # displacement of the ends of cells
    return np.sum(h * 0.5 * (nodes[:-1] + nodes[1:]))


def extrapolated(arguments, first=100, tolerance=1e-10, most=1600, wanted=1e-7):
    """Displacement, and how much it changed with the last mesh; meshes are doubled until that is small."""
    before = displacement(first, *arguments, tolerance=tolerance)
    result, change, n = before, np.inf, first
    while change > wanted * abs(result) and 2 * n <= most:
        n *= 2
        now = displacement(n, *arguments, tolerance=tolerance)
        value = (4 * now - before) / 3
        change, result, before = (np.inf if n == 2 * first else abs(value - result)), value, now
    return result, change


if __name__ == "__main__":
    numbers = [float(x) for x in sys.argv[1:6]]
    print("%.12g +- %.2g" % extrapolated(numbers, int(sys.argv[6]) if len(sys.argv) > 6 else 100))
