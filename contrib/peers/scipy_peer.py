#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""SciPy: the stretch by Chebyshev collocation (one element of high degree), the integrators of scipy.integrate.

With gamma = L = c = 1 the equation for the stretch w = zeta_s is an ordinary differential equation for its values at the
inner points; at the ends w = 1 - m/k is known:

    w_t = D v,  v = w^(-a) (m_s + k D w),  displacement' = int v ds,  w(s,0) = 1

METHOD is "lsoda" (odeint: bdf of variable order in Fortran), "radau" or "bdf" (solve_ivp). Each has the analytic Jacobian.
The lines that are read and written are those of body.h; the number of points is DEGREE + 1.
"""
import math
import sys
import time
import warnings

import numpy as np
from scipy.integrate import odeint, solve_ivp

TWO_PI = 2 * np.pi


class Chebyshev:
    """Points, derivative matrix and quadrature weights on [0, 1], for degrees asked for before kept."""
    known = {}

    def __init__(self, degree):
        angle = np.pi * np.arange(degree, -1, -1) / degree
        x, n = np.cos(angle), np.arange(degree + 1)
        scale = np.where(n % degree == 0, 2.0, 1.0) * (-1.0) ** n
        D = scale[:, None] / scale / (x[:, None] - x + np.eye(degree + 1))
        D -= np.diag(np.diag(D))
        D -= np.diag(D.sum(axis=1))
        self.s, self.D = (1 + x) / 2, 2 * D
        moments = np.zeros(degree + 1)
        moments[::2] = 1 / (1.0 - n[::2] ** 2)
        self.weights = np.linalg.solve(np.cos(np.outer(n, angle)), moments)

    @classmethod
    def of(cls, degree):
        """The one of this degree."""
        if degree not in cls.known:
            cls.known[degree] = cls(degree)
        return cls.known[degree]


class Body:
    """Right-hand side and Jacobian for y = (stretch at the inner points, displacement)."""

    def __init__(self, a, chi, k, degree):
        space = Chebyshev.of(degree)
        sine, cosine = np.sin(TWO_PI * space.s), np.cos(TWO_PI * space.s)
        self.a, self.chi = a, chi
        # m_s + k D w as one product with (w, 1, cos 2 pi t, sin 2 pi t); of m beside m_s its values at the ends are needed
        m_s = chi * np.array((TWO_PI * k * cosine, sine - TWO_PI * k * cosine, cosine + TWO_PI * k * sine))
        self.force, self.known = np.hstack((k * space.D, m_s.T)), np.ones(degree + 4)
        self.rows = np.vstack((space.D[1:-1], space.weights))  # of v: rates of the inner stretches and the displacement
        self.jac, self.inside = np.zeros((degree, degree)), np.arange(degree - 1)

    def velocity(self, t, y):
        """v and w^(-a)."""
        known, sine = self.known, math.sin(TWO_PI * t)
        known[1:-4] = y[:-1]
        known[0] = known[-4] = 1 + self.chi * sine
        known[-2], known[-1] = math.cos(TWO_PI * t), sine
        w = known[:-3]
        mobility = w if self.a == -1 else w ** -self.a
        return mobility * self.force.dot(known), mobility

    def rate(self, t, y):
        """dy/dt."""
        return self.rows.dot(self.velocity(t, y)[0])

    def jacobian(self, t, y):
        """d(dy/dt)/dy."""
        v, mobility = self.velocity(t, y)
        by_w = mobility[:, None] * self.force[:, 1:-4]
        by_w[self.inside + 1, self.inside] -= self.a * v[1:-1] / y[:-1]
        self.jac[:, :-1] = self.rows.dot(by_w)
        return self.jac


def run(method, a, chi, k, end_time, degree, tolerance):
    """The displacement; not a number if the integrator gives up."""
    body = Body(a, chi, k, degree)
    start = np.append(np.ones(degree - 1), 0.0)
    if method == "lsoda":
        y, report = odeint(body.rate, start, (0, end_time), Dfun=body.jacobian, rtol=0, atol=tolerance, tfirst=True, mxstep=100000,
                           full_output=True)
        return y[-1, -1] if report["message"] == "Integration successful." else np.nan
    found = solve_ivp(body.rate, (0, end_time), start, {"radau": "Radau", "bdf": "BDF"}[method], jac=body.jacobian, rtol=3e-14,
                      atol=tolerance, t_eval=(end_time,))
    return found.y[-1, -1] if found.success else np.nan


def main():
    """Answers line by line."""
    warnings.simplefilter("ignore")
    np.seterr(all="ignore")
    for line in sys.stdin:
        method, *numbers = line.split()
        a, chi, k, end_time, degree, _, tolerance, repeat = map(float, numbers)
        start = time.process_time()
        for _ in range(int(repeat)):
            value = run(method, a, chi, k, end_time, int(degree), tolerance)
        seconds = (time.process_time() - start) / repeat
        print(f"{value:.16g} {seconds:.6g}" if np.isfinite(value) else "failed", flush=True)


if __name__ == "__main__":
    main()
