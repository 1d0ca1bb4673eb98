#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Independent reference solution of the crawler equation (numpy and scipy only).

    gamma zeta_t zeta_s^a = m_s + k zeta_ss,    m + k (zeta_s - 1) = 0 at s = 0, L,    zeta(s,0) = s

is solved for the stretch w = zeta_s, from which the velocity v = zeta_t follows without integration:

    w_t = v_s,    v = w^(-a) (m_s + k w_s)/gamma,    w = 1 - m/k at both ends,    w(s,0) = 1.

Space: collocation at Chebyshev points s_j, j = 0..N, of the whole body (one polynomial of degree N).
Time: Radau IIA collocation with q stages (order 2q-1); the step follows the last Legendre coefficient of the
solution on the step. The run is repeated with more points, more stages and a tighter time tolerance until
the displacement stops changing; the last change is the error estimate.
Units: any consistent set of length, time and force, e.g. mm, s, uN.
"""
import argparse
import json
import time

import numpy as np
from numpy.polynomial import chebyshev, legendre
from scipy.interpolate import BarycentricInterpolator
from scipy.linalg import lu_factor, lu_solve
from scipy.optimize import minimize_scalar

POINTS = (24, 36, 54, 80, 120, 180, 270, 400, 600)  # degrees N tried in turn


class StretchLost(RuntimeError):
    """The stretch reached zero, or the time step did while following it, at this time and place."""

    def __init__(self, t, s, smallest, history=()):
        super().__init__(f"stretch too small to follow at t = {t:.6g}, s = {s:.6g}: {smallest:.3e}. Inside the body "
                         "this is a loss of stretch only if the exponent exceeds -1, otherwise a lack of points.")
        self.time = t
        self.history = history  # (t, s, smallest stretch) of every step


class Chebyshev:
    """Points s (N+1), quadrature weights (N+1) and derivative matrix (N+1, N+1) on [0, length]."""

    def __init__(self, degree, length):
        x = np.sin(np.pi * np.arange(-degree, degree + 1, 2) / (2 * degree))  # symmetric to the last bit
        self.s = 0.5 * length * (1 + x)
        scale = np.where((np.arange(degree + 1) % degree) == 0, 2.0, 1.0) * (-1.0) ** np.arange(degree + 1)
        angle = np.pi * np.arange(degree + 1) / (2 * degree)
        # x_i - x_j as a product of sines: no cancellation between neighbours near the ends
        difference = 2 * np.sin(angle[:, None] + angle) * np.sin(angle[:, None] - angle) + np.eye(degree + 1)
        derivative = scale[:, None] / scale / difference
        np.fill_diagonal(derivative, 0)
        np.fill_diagonal(derivative, -derivative.sum(axis=1))  # a constant has derivative zero
        self.derivative = derivative * 2 / length
        n = np.arange(0, degree + 1, 2)
        moments = np.zeros(degree + 1)
        moments[::2] = 2.0 / (1.0 - n**2)
        self.weights = np.linalg.solve(chebyshev.chebvander(x, degree).T, moments) * length / 2


class Radau:
    """Radau IIA: nodes c (q), matrix (q, q), last row = weights; its eigen-decomposition; error functional."""

    def __init__(self, stages):
        nodes = legendre.legroots(np.append(np.zeros(stages - 1), (-1.0, 1.0)))  # zeros of P_q - P_(q-1)
        nodes[-1] = 1.0
        self.c = (1 + nodes) / 2
        vandermonde = legendre.legvander(nodes, stages - 1)
        integrals = np.array([legendre.legval(nodes, legendre.legint(row, lbnd=-1)) for row in np.eye(stages)]).T
        self.matrix = np.linalg.solve(vandermonde.T, integrals.T).T / 2
        value, vector = np.linalg.eig(self.matrix)
        keep = value.imag > -1e-12  # one of each complex pair is enough
        self.eigenvalue = value[keep]
        self.inverse = np.linalg.inv(vector)[keep]
        self.vector = vector[:, keep] * np.where(value[keep].imag > 1e-12, 2, 1)
        self.times = np.append(0, self.c)  # of the polynomial through start value and stages
        self.last_coefficient = np.linalg.inv(legendre.legvander(2 * self.times - 1, stages))[-1]


def optimal_wave(chi, speed, sine=(1.0,), cosine=(), elastic_modulus=1.0, friction=1.0, length=1.0):
    """Active stress m(s,t) of the theorem and its derivative m_s, as one function (s, t) -> (m, m_s)."""
    count = max(len(sine), len(cosine))
    a = np.append(sine, np.zeros(count - len(sine)))[:, None]
    b = np.append(cosine, np.zeros(count - len(cosine)))[:, None]
    q = 2 * np.pi * np.arange(1, count + 1)[:, None] / length

    def stress(s, t):
        x, y, z = q * s, q * (s + speed * t), q * speed * t
        drag = (a * (np.cos(z) - np.cos(y)) + b * (np.sin(y) - np.sin(z))) / q
        strain = a * (np.sin(y) - np.sin(x)) + b * (np.cos(y) - np.cos(x))
        drag_s = a * np.sin(y) + b * np.cos(y)
        strain_s = q * (a * (np.cos(y) - np.cos(x)) - b * (np.sin(y) - np.sin(x)))
        ratio = elastic_modulus / speed
        return chi * (friction * drag - ratio * strain).sum(0), chi * (friction * drag_s - ratio * strain_s).sum(0)

    return stress


def expression_stress(expression):
    """Active stress from a numpy expression of s and t; m_s is left to the spectral derivative."""
    names = {n: getattr(np, n) for n in "sin cos tan arctan sinh cosh tanh exp log sqrt abs where pi".split()}
    code = compile(expression, "active stress", "eval")
    return lambda s, t: (eval(code, {"__builtins__": {}}, dict(names, s=s, t=t)) + 0.0 * s, None)


def extreme(polynomial, to_fine_s, t_nodes, values, sign):
    """Largest sign*w of one step, in its space-time polynomial through values (q+1, N+1): best s for the best t."""
    in_time, fine_s = BarycentricInterpolator(t_nodes, values), np.linspace(*polynomial.xi[[0, -1]], to_fine_s.shape[1])

    def largest(function, low, high):
        found = minimize_scalar(lambda x: -function(x), bounds=(low, high), method="bounded",
                                options=dict(xatol=1e-8 * (high - low)))
        return max(-found.fun, function(low), function(high))

    def peak(t):
        polynomial.set_yi(sign * in_time(t))
        j = (polynomial.yi[:, 0] @ to_fine_s).argmax()
        return largest(lambda s: float(polynomial(s)), fine_s[max(j - 1, 0)], fine_s[min(j + 1, len(fine_s) - 1)])

    return largest(peak, t_nodes[0], t_nodes[-1])


def solve(stress, exponent, end_time, elastic_modulus=1.0, friction=1.0, length=1.0, points=48, stages=6,
          time_tolerance=1e-10, stop_at=0.0):
    """One run at fixed resolution; returns a dict of numbers, see reference(). A smallest stretch (on a fine grid) below
    stop_at raises StretchLost with the history of t, s and smallest stretch."""
    k, gamma, space, radau = elastic_modulus, friction, Chebyshev(points, length), Radau(stages)
    s, derivative, weights = space.s, space.derivative, space.weights
    inside, identity = slice(1, -1), np.eye(points - 1)
    polynomial = BarycentricInterpolator(s)
    polynomial.wi = (-1.0) ** np.arange(points + 1) * np.where(np.arange(points + 1) % points == 0, 0.5, 1.0)

    def active(t):
        m, m_s = stress(s, t)
        return m, derivative @ m if m_s is None else m_s

    def velocity(w, m_s):
        with np.errstate(invalid="ignore"):
            return w ** -exponent * (m_s + k * (w @ derivative.T)) / gamma

    def jacobian(w, m_s):
        """d(v_s)/dw at the inner points: D [ -a v/w + k w^(-a)/gamma D ]."""
        v_w = np.diag(-exponent * velocity(w, m_s) / w) + (k * w ** -exponent / gamma)[:, None] * derivative
        return derivative[inside] @ v_w[:, inside]

    def step(t, h, w_start):
        """Stage stretches (q, N+1), or None where Newton's method fails; also m and m_s at the stages."""
        m, m_s = (np.array(x) for x in zip(*[active(t + c * h) for c in radau.c]))
        w = np.tile(w_start, (stages, 1))
        w[:, [0, -1]] = 1 - m[:, [0, -1]] / k
        last = np.inf
        for iteration in range(25):
            if not np.all(w > 0):
                return None, m, m_s
            if iteration in (0, 3):  # simplified Newton: one Jacobian for all stages, renewed once
                J = jacobian(w.mean(0), m_s.mean(0))
                factors = [lu_factor(identity - h * x * J, check_finite=False) for x in radau.eigenvalue]
            rate = velocity(w, m_s) @ derivative[inside].T
            residual = radau.inverse @ (w_start[inside] + h * radau.matrix @ rate - w[:, inside])
            update = (radau.vector @ np.array([lu_solve(f, r) for f, r in zip(factors, residual)])).real
            w[:, inside] += update
            size = np.abs(update).max()
            if size < 1e-14 or (size < 1e-11 and size > 0.5 * last):
                return (w if np.all(w > 0) else None), m, m_s
            if not size < 1e3 or (iteration > 5 and size > 0.8 * last):
                return None, m, m_s
            last = size
        return None, m, m_s  # no convergence

    polynomial.set_yi(np.eye(points + 1))
    to_fine_s = polynomial(np.linspace(0, length, 4 * points + 1)).T
    w, t, h, steps, smallest = np.ones(points + 1), 0.0, 1e-3 * end_time, 0, []
    fine_s = np.linspace(0, length, 4 * points + 1)
    total, end_work = np.zeros(3), 0.0  # length * displacement, dissipation, paper's energy; its end term
    extremes = {-1: -np.inf, 1: -np.inf}  # largest sign*w so far, for either sign
    while t < end_time:
        h = min(h, end_time - t) if end_time - t > 1.5 * h else (end_time - t) / (1 if end_time - t <= h else 2)
        if h < 1e-10 * end_time:
            raise StretchLost(t, s[w.argmin()], w.min())
        W, m, m_s = step(t, h, w)
        history = np.vstack((w, w if W is None else W))
        fine = history @ to_fine_s
        lost = W is None or fine.min() <= 0
        error = np.inf if lost else np.abs(radau.last_coefficient @ history[:, inside]).max()
        if error > time_tolerance:
            h *= 0.4 if error == np.inf else max(0.2, 0.8 * (time_tolerance / error) ** (1 / stages))
            continue
        v, in_time = velocity(W, m_s), h * radau.matrix[-1]
        total += in_time @ np.array((v @ weights, (gamma * W ** exponent * v**2) @ weights, (m_s * v) @ weights)).T
        end_work += in_time @ (m[:, -1] * v[:, -1] - m[:, 0] * v[:, 0])
        times = t + h * radau.times
        for sign in extremes:
            if (sign * fine).max() > extremes[sign] - 2e-3:
                extremes[sign] = max(extremes[sign], extreme(polynomial, to_fine_s, times, history, sign))
        w, t, steps = W[-1], end_time if end_time - t <= h else t + h, steps + 1
        h *= min(3.0, 0.8 * (time_tolerance / max(error, 1e-30)) ** (1 / stages))
        i = np.clip(fine[-1].argmin(), 1, 4 * points - 1)
        left, middle, right = fine[-1][i - 1:i + 2]
        x = np.clip(0.5 * (left - right) / max(left - 2 * middle + right, 1e-300), -1, 1)  # vertex of the parabola
        smallest.append((t, fine_s[i] + x * fine_s[1], middle + 0.25 * x * (right - left)))
        if smallest[-1][2] < stop_at:
            raise StretchLost(*smallest[-1], smallest)
    return {"displacement": total[0] / length, "stress_power": total[2] - end_work, "dissipation": total[1],
            "elastic_energy": 0.5 * k * (w - 1) ** 2 @ weights, "paper_energy": total[2],
            "min_stretch": -extremes[-1], "max_stretch": extremes[1], "points": points, "steps": steps}


def reference(stress, exponent, end_time, elastic_modulus=1.0, friction=1.0, length=1.0, points=None, rtol=1e-10):
    """Solve at growing resolution until the displacement changes by less than rtol; returns a dict:

    displacement [length] (1/L) int (zeta(s,T) - s) ds, displacement_error (last change), stress_power
    -int int m zeta_st [force length], dissipation int int gamma w^a zeta_t^2, elastic_energy (k/2) int (w-1)^2
    at the end, paper_energy int int m_s zeta_t, min_stretch, max_stretch over all s and t, points, steps, seconds,
    errors (last change of every number). With `points`: one pair of runs, 2/3 of the points and all of them.
    Two runs in a row differ in points, stages and hence steps, so the change sees errors in space and in time.
    """
    start, previous, lost_before, errors = time.perf_counter(), None, np.nan, {}
    degrees = POINTS if points is None else (2 * points // 3, points)
    for i, degree in enumerate(degrees):
        try:
            now = solve(stress, exponent, end_time, elastic_modulus, friction, length, degree,
                        stages=6 + i % 2, time_tolerance=max(0.1 * rtol, 2e-13))
        except StretchLost as lost:  # too coarse, unless the next resolution agrees
            if degree in (degrees[-1], 270) or abs(lost.time - lost_before) < 3e-4 * end_time:
                raise
            lost_before = lost.time
            continue
        if previous:
            errors = {key: abs(now[key] - previous[key]) for key in now if key not in ("points", "steps")}
            if errors["displacement"] <= rtol * max(abs(now["displacement"]), 1e-3 * length):
                break
        previous = now
    now.update(displacement_error=errors.get("displacement"), errors=errors, seconds=time.perf_counter() - start)
    return now


def main():
    """Command line: prints the dict of reference() as JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, default in (("exponent", -1), ("chi", 0.4), ("speed", 1), ("end-time", 1), ("elastic-modulus", 1),
                          ("friction", 1), ("length", 1), ("rtol", 1e-10)):
        parser.add_argument("--" + name, type=float, default=default)
    parser.add_argument("--sine", type=float, nargs="+", default=[1.0], help="a_n of the velocity wave, n = 1, 2, ...")
    parser.add_argument("--cosine", type=float, nargs="+", default=[0.0], help="b_n")
    parser.add_argument("--points", type=int, help="polynomial degree in space; chosen automatically without it")
    parser.add_argument("--active-stress", help="numpy expression of s and t instead of the optimal wave")
    o = parser.parse_args()
    body = dict(elastic_modulus=o.elastic_modulus, friction=o.friction, length=o.length)
    try:
        stress = expression_stress(o.active_stress) if o.active_stress else optimal_wave(
            o.chi, o.speed, o.sine, o.cosine, **body)
        print(json.dumps(reference(stress, o.exponent, o.end_time, points=o.points, rtol=o.rtol, **body), indent=1))
    except (StretchLost, SyntaxError, NameError) as problem:
        parser.exit(1, f"{problem}\n")


if __name__ == "__main__":
    main()
