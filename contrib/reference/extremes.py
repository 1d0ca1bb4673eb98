#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reference values for extreme scenes; writes extremes.json beside this file. `extremes.py WORD ...` redoes the rows
whose name contains a word and keeps the others.

Every row is the optimal wave with length = friction = 1. Two methods that share only the time integrator's coefficients:
- log-stretch: log_stretch.py with three numbers of cells, each twice the last, then h^2 extrapolation of the last two;
  error = difference to the extrapolation of the first two.
- Chebyshev: crawler_reference.py; error = last change when points, stages and steps grow.
A row whose exponent exceeds -1 and whose stretch is lost gives place and time instead of a displacement.
"""
import json
import math
import pathlib
import signal
import sys
import time

import numpy as np

from crawler_reference import StretchLost, optimal_wave, reference, solve
import log_stretch

FILE = pathlib.Path(__file__).parent / "extremes.json"


def scene(a, chi, speed=1, end_time=1, modulus=1, sine=(1.0,), cosine=()):
    """Scene parameters by name."""
    return dict(exponent=a, chi=chi, speed=speed, end_time=end_time, elastic_modulus=modulus, sine=list(sine),
                cosine=list(cosine))


def stress_of(p):
    """Active stress of the scene."""
    return optimal_wave(p["chi"], p["speed"], p["sine"], p["cosine"], p["elastic_modulus"])


def extrapolate(values):
    """h^2 limit of three values at doubling resolution, and its difference to the limit of the first two."""
    first, second = (y + (y - x) / 3 for x, y in zip(values, values[1:]))
    return second, abs(second - first)


def toward_ends(x):
    """A smooth mesh 50 times finer at the ends, for end layers."""
    return x - 0.98 * np.sin(2 * np.pi * x) / (2 * np.pi)


def cells(p, numbers, mesh=None):
    """Displacement by log-stretch."""
    runs = [log_stretch.solve(stress_of(p), p["exponent"], p["end_time"], n, p["elastic_modulus"], mesh=mesh)
            for n in numbers]
    value, error = extrapolate([r["displacement"] for r in runs])
    last = runs[-1]
    return dict(displacement=value, error=error + 1e-9, min_stretch=last["min_stretch"],
                log_min_stretch=last["log_min_stretch"],
                log_min_stretch_error=abs(last["log_min_stretch"] - runs[-2]["log_min_stretch"]),
                min_at=dict(s=last["min_at"][0], t=last["min_at"][1]),
                raw=[[r["cells"], r["displacement"], r["log_min_stretch"]] for r in runs], method="log-stretch")


def spectral(p, rtol=1e-10):
    """Displacement by Chebyshev."""
    r = reference(stress_of(p), p["exponent"], p["end_time"], p["elastic_modulus"], rtol=rtol)
    return dict(displacement=float(r["displacement"]), error=max(float(r["displacement_error"]), 1e-13),
                min_stretch=float(r["min_stretch"]), min_stretch_error=float(r["errors"]["min_stretch"]),
                points=r["points"], method="Chebyshev")


def strides(p, count=6, points=80):
    """Many cycles: `count` of them are computed, the last increment is used for the others."""
    def run(n, degree, stages):
        return solve(stress_of(p), p["exponent"], n, p["elastic_modulus"], points=degree, stages=stages,
                     time_tolerance=2e-13)["displacement"]
    d = [float(run(n, points, 7)) for n in range(1, count + 1)]
    steps = [y - x for x, y in zip(d, d[1:])]
    left = p["end_time"] - count
    other = float(run(count, points * 3 // 2, 6) - run(count - 1, points * 3 // 2, 6))
    return dict(displacement=d[-1] + left * steps[-1], error=left * max(abs(steps[-1] - steps[-2]), abs(steps[-1] - other), 1e-12),
                cycles=d, per_cycle=steps[-1], method="Chebyshev, settled cycle")


def lost(p, numbers=(250, 500, 1000), smallest=1e-9):
    """Place and time at which the stretch is lost: log-stretch until `smallest`, and the time by Chebyshev."""
    runs = [log_stretch.solve(stress_of(p), p["exponent"], p["end_time"], n, p["elastic_modulus"], stop_at=smallest, time_tolerance=1e-6,
                              switch=p["exponent"] < 0)
            for n in numbers]
    t = runs[-1]["time"]  # the place of the minimum within its cell matters: no clean order, no extrapolation
    t_error = max(abs(r["time"] - t) for r in runs[:-1])
    s = [r["min_at"][0] for r in runs]
    result = dict(inversion=dict(s=s[-1], t=t, s_error=abs(s[-1] - s[-2]) + 1 / numbers[-1], t_error=t_error),
                  raw=[[r["cells"], *r["min_at"], r["log_min_stretch"]] for r in runs], method="log-stretch")
    for degree in (80, 120):  # two resolutions show how far the polynomial can follow
        try:
            solve(stress_of(p), p["exponent"], p["end_time"], p["elastic_modulus"], points=degree, stages=7)
        except StretchLost as found:
            result.setdefault("Chebyshev_t", []).append(float(found.time))
    both = result.get("Chebyshev_t", [])
    if len(both) == 2 and abs(both[1] - both[0]) < 1e-8 and abs(both[1] - t) < 1e-4:  # smooth up to the end: a = 0
        result["inversion"].update(t=both[1], t_error=abs(both[1] - both[0]) + 1e-9)
    return result


def lost_smoothly(p, stop_at, points=(48, 72)):
    """The same for large a > 0: where friction vanishes the force in the body is constant, and the stretch goes to 0 as
    smoothly as the active stress. Chebyshev until `stop_at`; a parabola of time over the smallest stretch, through the
    states at 1, 2 and 3 times the last stretch, is followed to 0. Error: with the line through two of them, and with
    other points."""
    found = []
    for degree in points:
        try:
            solve(stress_of(p), p["exponent"], p["end_time"], p["elastic_modulus"], points=degree, stages=5, time_tolerance=1e-6,
                  stop_at=stop_at)
        except StretchLost as lost_at:
            history = np.array(lost_at.history)
            last = history[-1, 2]
            at = [abs(history[:, 2] - factor * last).argmin() for factor in (1, 2, 3)]
            t, s, w = history[at].T
            found.append([degree, *(float(np.polyval(np.polyfit(w, x, 2), 0)) for x in (s, t)),
                          float(np.polyval(np.polyfit(w[:2], t[:2], 1), 0)), float(last)])
    (_, s_other, t_other, *_), (_, s, t, line, _) = found
    return dict(inversion=dict(s=s, t=t, s_error=abs(s - s_other) + 1e-3, t_error=abs(t - t_other) + abs(t - line)),
                raw=found, method="Chebyshev, extrapolated")


def end_lost(p):
    """The end stretch 1 + (chi/c) sin(2 pi c t) reaches zero at this time (one harmonic, any exponent, any k)."""
    t = (math.pi + math.asin(p["speed"] / p["chi"])) / (2 * math.pi * p["speed"])
    return dict(inversion=dict(s=[0.0, 1.0], t=t, t_error=1e-15, s_error=0.0), method="closed form",
                formula="t = L (pi + asin(c/chi))/(2 pi c), both ends, chi > c > 0")


def rows():
    """(name, scene, method, options), in order of importance."""
    for chi, n in ((0.6, (2000, 4000, 8000)), (0.7, (250, 500, 1000)), (0.8, (250, 500, 1000)), (0.9, (250, 500, 1000)),
                   (0.95, (250, 500, 1000)), (0.999, (250, 500, 1000))):
        yield f"collapse a=-1 chi={chi}", scene(-1, chi), cells, dict(numbers=n)
    for T in (2, 3):
        yield f"collapse a=-1 chi=0.6 T={T}", scene(-1, 0.6, end_time=T), cells, dict(numbers=(1000, 2000, 4000))
    for a, chi in ((-1.5, 0.8), (-3, 0.8), (-3, 0.95), (-3, 0.999), (-2, 0.9)):
        yield f"contraction a={a} chi={chi}", scene(a, chi), cells, dict(numbers=(500, 1000, 2000), mesh=toward_ends)
    for a, speed, chi, w in ((1, -1, 0.6, 1e-10), (0, 1, 0.6, 1e-10), (2, -1, 0.7, 1e-6), (-0.5, 1, 0.7, 1e-16),
                             (-0.9, 1, 0.8, 1e-80)):
        yield f"inversion a={a} chi={chi}", scene(a, chi, speed), lost, dict(smallest=w)
    for a, chi, w in ((11, 0.7, 0.02), (8, 0.73, 0.01), (6, 0.71, 0.01)):
        yield f"inversion a={a} chi={chi}", scene(a, chi), lost_smoothly, dict(stop_at=w)
    yield "inversion a=0.5 chi=0.87", scene(0.5, 0.87), lost, dict(smallest=1e-9)
    yield "inversion ends chi=1.2", scene(-1, 1.2), end_lost, {}
    for a, speed, chi in ((10, -1, 0.2), (3, -1, 0.4), (-10, 1, 0.3), (21, -1, 0.1), (-19, 1, 0.2), (-20, 1, 0.2)):
        yield f"exponent a={a} chi={chi}", scene(a, chi, speed), spectral, {}
    yield "exponent a=-20 chi=0.4", scene(-20, 0.4), cells, dict(numbers=(1000, 2000, 4000), mesh=toward_ends)
    yield "exponent a=-20 chi=0.6", scene(-20, 0.6), cells, dict(numbers=(1000, 2000, 4000), mesh=toward_ends)
    yield "modulus k=1e-3 chi=0.4", scene(-1, 0.4, modulus=1e-3), spectral, {}
    yield "modulus k=1e-6 chi=0.3", scene(-1, 0.3, modulus=1e-6), cells, dict(numbers=(1000, 2000, 4000), mesh=toward_ends)
    for k in ("1e-3", "1e-4", "1e3", "1e6"):
        yield f"modulus k={k} chi=0.3", scene(-1, 0.3, modulus=float(k)), spectral, {}
    harmonics = [1 / n for n in range(1, 17)]
    yield "harmonics a_n=1/n n<=16 chi=0.05", scene(-1, 0.05, sine=harmonics), spectral, {}
    yield "harmonics a_n=b_n=1/n n<=16 chi=0.03", scene(-1, 0.03, sine=harmonics, cosine=harmonics), spectral, {}
    yield "strides T=1000 chi=0.4", scene(-1, 0.4, end_time=1000), strides, {}


def main():
    """Compute the rows asked for; the file is written after every row."""
    def too_slow(*_):
        raise TimeoutError("not finished in the time allowed")
    signal.signal(signal.SIGALRM, too_slow)
    known = {r["name"]: r for r in json.loads(FILE.read_text())["rows"]} if FILE.exists() else {}
    for name, p, method, options in rows():
        if sys.argv[1:] and not any(word in name for word in sys.argv[1:]):
            continue
        start = time.perf_counter()
        signal.alarm(300)
        try:
            row = dict(name=name, **p, length=1, friction=1, **method(p, **options))
        except (RuntimeError, TimeoutError, ValueError) as problem:
            print(name, "FAILED", problem, flush=True)
            continue
        finally:
            signal.alarm(0)
        row["seconds"] = round(time.perf_counter() - start, 1)
        known[name] = row
        print({k: v for k, v in row.items() if k not in ("exponent", "chi", "sine", "cosine", "length", "friction")}, flush=True)
        FILE.write_text(json.dumps({"made": "by extremes.py; see its first lines for methods and errors",
                                    "rows": [known[n] for n, *_ in rows() if n in known]}, indent=1) + "\n")


if __name__ == "__main__":
    main()
