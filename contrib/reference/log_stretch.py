#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Finite volumes in u = log(stretch): follows a body that collapses to any small stretch (numpy and scipy only).

    gamma zeta_t zeta_s^a = m_s + k zeta_ss,    m + k (zeta_s - 1) = 0 at s = 0, L,    zeta(s,0) = s

Cells i of width h_i have the stretch w_i = exp(u_i) and the force N_i = k (w_i - 1) + m_i, nodes have the velocity v_i:

    v_i = (N_i - N_(i-1)) / (gamma (h_(i-1) w_(i-1)^a + h_i w_i^a)/2),    u_i' = (v_(i+1) - v_i)/(h_i w_i),

with N = 0 and no friction outside. Averaging friction never empties a cell in finite time for a <= -1, but it also stops
material from entering a collapsed cell: the front then lags by O(h |log w|) and the smallest stretch does not converge.
So friction is averaged only where the emptier neighbour gives length away; where it receives, the mobility w^(-a)/gamma
is averaged. v is continuous across the switch (it happens at v = 0), both are of second order, and the error is O(h^2).
Time: Radau IIA with q stages, tridiagonal Newton systems. D = (1/L) int int v ds dt with the trapezoidal rule in s.
"""
import argparse
import json
import time

import numpy as np
from scipy.linalg import lapack

from crawler_reference import Radau, optimal_wave


def solve(stress, exponent, end_time, cells, elastic_modulus=1.0, friction=1.0, length=1.0, stages=5,
          time_tolerance=1e-4, mesh=None, stop_at=0.0, max_seconds=1e9, switch=True):
    """One run; mesh maps [0, 1] to [0, 1] (uniform cells by default).

    stop_at: end the run when the smallest stretch is below this. Returns a dict of numbers; length_error is the change
    of the body's length that the end velocities do not explain (errors of the time integration).
    """
    a, k, gamma, radau, start = exponent, elastic_modulus, friction, Radau(stages), time.perf_counter()
    x = np.linspace(0, 1, cells + 1)
    s = length * (x if mesh is None else mesh(x))
    h = np.diff(s)
    middle = 0.5 * (s[1:] + s[:-1])
    span = np.concatenate((h[:1], 0.5 * (h[1:] + h[:-1]), h[-1:]))

    def velocity(u, m):
        w = np.exp(u)
        force = np.zeros(u.shape[:-1] + (cells + 2,))
        force[..., 1:-1] = k * (w - 1) + m
        g = np.zeros_like(force)
        g[..., 1:-1] = 0.5 * gamma * h * np.exp(a * u)
        drag = g[..., 1:] + g[..., :-1]
        jump = np.diff(force)
        mobility = 1 / drag
        part = -a * mobility**2 * g[..., 1:], -a * mobility**2 * g[..., :-1]  # of u_i, u_(i-1)
        if switch:
            power = np.exp(-a * u) / (2 * gamma)
            advancing = np.zeros(jump.shape, bool)  # v_i > 0 takes length from cell i, v_i < 0 from cell i - 1
            advancing[..., 1:-1] = (jump[..., 1:-1] > 0) == (np.diff(u) > 0)
            pr, pl = np.zeros_like(jump), np.zeros_like(jump)
            pr[..., :-1] = power
            pl[..., 1:] = power
            pr /= span
            pl /= span
            mobility = np.where(advancing, pr + pl, mobility)
            part = np.where(advancing, -a * pr, part[0]), np.where(advancing, -a * pl, part[1])
        return jump * mobility, mobility, jump * part[0], jump * part[1], w

    def rate(u, m):
        v, _, _, _, w = velocity(u, m)
        return np.diff(v) / (h * w)

    def jacobian(u, m):
        """Bands (below, diagonal, above) of d(rate)/du."""
        v, mobility, part_right, part_left, w = velocity(u, m)
        right = k * w * mobility[:-1] + part_right[:-1]  # dv_i/du_i
        left = -k * w * mobility[1:] + part_left[1:]  # dv_(i+1)/du_i
        hw = h * w
        return -left[:-1] / hw[1:], (left - right) / hw - np.diff(v) / hw, right[1:] / hw[:-1]

    def step(t, dt, u_start, guess):
        m = np.array([stress(middle, t + c * dt)[0] for c in radau.c])
        u, last = guess, np.inf
        for iteration in range(14):
            if iteration in (0, 4):
                low, diagonal, up = jacobian(u.mean(0), m.mean(0))
                factors = []
                for e in radau.eigenvalue:
                    e = e.real if abs(e.imag) < 1e-12 else e
                    kind = lapack.dgttrf if np.isrealobj(e) else lapack.zgttrf
                    factors.append((e, kind(-dt * e * low, 1 - dt * e * diagonal, -dt * e * up)))
            residual = radau.inverse @ (u_start + dt * radau.matrix @ rate(u, m) - u)
            change = []
            for (e, f), r in zip(factors, residual):
                real = np.isrealobj(e)
                change.append((lapack.dgttrs if real else lapack.zgttrs)(*f[:5], r.real if real else r)[0])
            update = (radau.vector @ np.array(change)).real
            u = u + update
            size = np.abs(update).max()
            if size < 0.01 * time_tolerance:
                return u, m
            if not size < 20 or (iteration > 1 and iteration != 4 and size > 0.9 * last):
                break
            last = size
        return None, m

    u, t, dt, steps, rejected = np.zeros(cells), 0.0, 1e-4 * end_time, 0, 0
    total, least, where = 0.0, 0.0, (0.0, 0.0)
    node_weight = np.zeros(cells + 1)
    node_weight[:-1] += h / 2
    node_weight[1:] += h / 2
    ends, previous = [0.0, 0.0], None
    while t < end_time:
        dt = min(dt, end_time - t)
        guess = np.tile(u, (stages, 1))
        if previous is not None:  # continue the polynomial of the last step
            at = 1 + radau.c * dt / previous[0]
            basis = np.array([np.prod([(at - y) / (x - y) for y in radau.times if y != x], axis=0) for x in radau.times])
            extrapolated = basis.T @ previous[1]
            if np.abs(extrapolated - guess).max() < 3:
                guess = extrapolated
        U, m = step(t, dt, u, guess)
        history = None if U is None else np.vstack((u, U))
        error = np.inf if U is None else np.abs(radau.last_coefficient @ history).max()
        if not error < time_tolerance:
            dt *= 0.3 if not np.isfinite(error) else max(0.2, 0.8 * (time_tolerance / error) ** (1 / stages))
            rejected += 1
            previous = None if U is None else previous
            if dt < 1e-15 * end_time:
                raise RuntimeError(f"time step lost at t = {t}, s = {middle[u.argmin()]}, w = {np.exp(u.min())}")
            continue
        v = velocity(U, m)[0]
        total += dt * radau.matrix[-1] @ (v @ node_weight)
        ends = [e + dt * radau.matrix[-1] @ v[:, i] for e, i in zip(ends, (0, -1))]
        previous = (dt, history)
        u, t, steps = U[-1], end_time if end_time - t <= dt * (1 + 1e-12) else t + dt, steps + 1
        if u.min() < least:
            least, where = u.min(), (middle[u.argmin()], t)
        if stop_at and least < np.log(stop_at):
            break
        dt *= min(3.0, 0.8 * (time_tolerance / max(error, 1e-30)) ** (1 / stages))
        if time.perf_counter() - start > max_seconds:
            raise RuntimeError(f"too slow: t = {t}, {steps} steps, {rejected} rejected")
    return {"displacement": float(total / length), "log_min_stretch": float(least), "min_stretch": float(np.exp(least)),
            "min_at": (float(where[0]), float(where[1])), "length_error": float(h @ np.exp(u) - length - ends[1] + ends[0]), "cells": cells,
            "steps": steps, "rejected": rejected, "time": t, "seconds": time.perf_counter() - start}


def main():
    """Command line: one JSON line for every number of cells."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, default in (("exponent", -1), ("chi", 0.6), ("speed", 1), ("end-time", 1), ("elastic-modulus", 1),
                          ("stop-at", 0)):
        parser.add_argument("--" + name, type=float, default=default)
    parser.add_argument("--cells", type=int, nargs="+", default=[500, 1000, 2000])
    o = parser.parse_args()
    for cells in o.cells:
        print(json.dumps(solve(optimal_wave(o.chi, o.speed, elastic_modulus=o.elastic_modulus), o.exponent, o.end_time,
                               cells, o.elastic_modulus, stop_at=o.stop_at)), flush=True)


if __name__ == "__main__":
    main()
