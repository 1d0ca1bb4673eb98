#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fits of random animals whose truth is known: do the intervals hold it as often as they say, and is there a bias?

    fit_coverage.py FOLDER_OF_THE_PYTHON_PACKAGE [ANIMALS [FIRST [profiles]]]

Each animal has a body, a gait, noise, gaps and markers that are not quite where they are said to be; what is fitted is known
strain (the exponent), a wave of stress (exponent, modulus, amplitude) or its frequency and phase; with "profiles" the friction
at three places of the body, between which it is linear. Prints a table, and fails if a
share of intervals is outside of its binomial error (one in a thousand), or a mean error above a fifth of the deviation and
outside of its own. Error over deviation is the root of the rise of chi-square from the best value to the truth, with the sign of
the error: as the intervals, it does not depend on how a variable is written (modulus, its inverse, its logarithm).
"""
import sys
import warnings

sys.path.insert(0, sys.argv[1])
import numpy as np  # noqa: E402
from scipy import stats  # noqa: E402

import crawler  # noqa: E402
from crawler.measured import Samples  # noqa: E402

ALL, FIRST = (int(sys.argv[i]) if len(sys.argv) > i else default for i, default in ((2, 10), (3, 1)))
OF_PROFILES = sys.argv[4:] == ["profiles"]
CHANCE = 1e-3  # of a failure of a right program
WAVE, STRAIN = "Active stress/Travelling wave/", "Active stress/Prescribed strain/"
BODY = "Body/"
PROFILE = BODY + "Friction profile"


def truth_of(scene, name):
    """Number of a scene; that of a list by NAME[1], NAME[2], ..."""
    return scene[PROFILE][int(name[-2]) - 1] if name.startswith(PROFILE) else scene[name]


def with_number(scene, name, value):
    """Scene with another number."""
    if not name.startswith(PROFILE):
        return {**scene, name: value}
    return {**scene, PROFILE: [value if i == int(name[-2]) else one for i, one in enumerate(scene[PROFILE], 1)]}


def animal(number):
    """A scene as a dict of entries, the variables with their ranges, and the random numbers."""
    random = np.random.default_rng(number)
    length, duration = random.uniform(0.5, 5), random.uniform(1.5, 3)
    scene = {BODY + "Length": length, BODY + "Anchoring exponent": random.uniform(1, 3.5), "Time/End time": duration}
    kind = "profile" if OF_PROFILES else ("strain", "wave", "clock")[number % 3]
    if kind == "strain":
        scene |= {"Model": "kinematic", "Active stress/Generator": "prescribed strain", STRAIN + "Given by": "wave",
                  STRAIN + "Amplitude": random.uniform(0.1, 0.4), STRAIN + "Wave number": random.uniform(0.7, 1.5),
                  STRAIN + "Wave speed": random.uniform(0.5, 1.5) * length}
        return scene, {BODY + "Anchoring exponent": (0.1, 6)}, random
    modulus, friction = random.uniform(0.5, 3), random.uniform(0.3, 1) / length ** 2
    scene |= {BODY + "Elastic modulus": modulus, BODY + "Friction coefficient": friction, "Active stress/Generator": "travelling wave",
              WAVE + "Amplitude": random.uniform(0.1, 0.3) * modulus, WAVE + "Wave number": random.uniform(0.7, 1.5),
              WAVE + "Frequency": random.uniform(0.7, 1.3)}
    if kind == "clock":
        scene[WAVE + "Phase"] = random.uniform(-0.2, 0.2)
        return scene, {WAVE + "Frequency": (0.5, 1.5), WAVE + "Phase": (-0.5, 0.5)}, random
    if kind == "profile":
        scene[BODY + "Profile interpolation"] = "linear"
        scene[PROFILE] = random.uniform(0.6, 1.7, 3).tolist()
        return scene, {f"{PROFILE}[{i}]": (0.1, 6) for i in (1, 2, 3)}, random
    return scene, {BODY + "Anchoring exponent": (0.1, 6), BODY + "Elastic modulus": (0.2, 8), WAVE + "Amplitude": (0.01, 2)}, random


def measured(scene, random):
    """Tracks with noise, gaps and misplaced markers, and what is said of them."""
    length, n, n_t = scene[BODY + "Length"], int(random.integers(5, 10)), int(random.integers(30, 60))
    said = np.linspace(0.05, 0.95, n) * length
    noise, shift = random.uniform(0.002, 0.01) * length, random.uniform(0.002, 0.01) * length
    places = np.clip(said + shift * random.standard_normal(n), 0, length)
    t = np.sort(random.uniform(0, scene["Time/End time"], n_t))
    x = crawler.run(scene, fields=t, places=places, accuracy=1e-8, check=True).fields.position
    x = x + random.uniform(-5, 5) * length + noise * random.standard_normal(x.shape)
    x[random.random(x.shape) < random.uniform(0, 0.2)] = np.nan
    return (Samples("x", np.arange(float(n)), t, x, [str(i) for i in range(n)]),
            {"markers_at": said, "place_deviation": shift, "standard_deviation": noise})


def errors_of(number):
    """For each variable: error over deviation, and whether the intervals have the truth."""
    truth, variables, random = animal(number)
    data, said = measured(truth, random)
    scene = dict(truth)
    for name, (low, high) in variables.items():  # a start beside the truth
        scene = with_number(scene, name, float(np.clip(truth_of(truth, name) * random.uniform(0.8, 1.25) + (0.05 if "Phase" in name else 0), low, high)))
    settings = {"set": {"Fit/Markers at": ", ".join(map(repr, said.pop("markers_at").tolist()))}, **said}
    found = crawler.fit(scene, data, variables, **settings)
    rows = []
    for name, one in found.variables.items():
        true = truth_of(truth, name)
        if one["determined"]:
            within = [(ends[0] is None or ends[0] <= true) and (ends[1] is None or true <= ends[1])
                      for ends in (one["interval_68"], one["interval_95"])]
            rise, share = rise_at(true, one), one["numerical_error"] / (one["deviation"] or np.inf)
        else:  # those with large values are often not told: without them there would be a bias
            held = scene
            for other, its in found.variables.items():
                held = with_number(held, other, true if other == name else its["used"])
            held = crawler.fit(held, data, {other: variables[other] for other in variables if other != name}, **settings)
            rise, share, within = held.goodness.chi_square - found.goodness.chi_square, 0, [None, None]
        rows.append((name.split("/")[-1], np.sign(one["used"] - true) * np.sqrt(max(rise, 0)), *within, share))
    return rows, found.goodness.probability


def rise_at(truth, one):
    """By how much chi-square is larger if a variable is held at the truth: between, or beyond, the points of its profile."""
    x, roots = np.array([[x, np.copysign(np.sqrt(rise), x - one["value"])] for x, rise in one["profile"]]).T
    end = -1 if truth > x[-1] else 0
    return (np.interp(truth, x, roots) if x[0] <= truth <= x[-1] else roots[end] * (truth - one["value"]) / (x[end] - one["value"])) ** 2


def main():
    warnings.simplefilter("ignore")
    return print_table([errors_of(number) for number in range(FIRST, FIRST + ALL)])


def print_table(animals):
    """Returns how much is wrong."""
    fitting = [one for one in animals if one[1] > CHANCE]  # of the others the program says that the scene does not fit
    rows, probabilities = [row for one in fitting for row in one[0]], [one[1] for one in fitting]
    wrong = int(len(fitting) < 0.97 * len(animals))
    print(f"{len(animals)} animals, of which {len(animals) - len(fitting)} are said not to fit (another minimum)\n"
          "| number | fits | told | 68 % | 95 % | mean error/deviation | spread |\n|---|---|---|---|---|---|---|")
    for name in [*sorted({row[0] for row in rows}), "all"]:
        mine = [row for row in rows if name in ("all", row[0])]
        told, errors = [row for row in mine if row[2] is not None], np.array([row[1] for row in mine])
        shares = []
        for column, level in ((2, 0.6827), (3, 0.95)):
            inside = sum(row[column] for row in told)
            wrong += stats.binomtest(inside, len(told), level).pvalue < CHANCE
            shares.append(f"{100 * inside / len(told):.1f}")
        wrong += abs(errors.mean()) > 0.2 and abs(errors.mean()) > stats.norm.isf(CHANCE / 2) / np.sqrt(len(mine))
        print(f"| {name} | {len(mine)} | {len(told)} | {shares[0]} | {shares[1]} | {errors.mean():+.2f} | {errors.std():.2f} |")
    print(f"numerical error over deviation: at most {max(row[4] for row in rows):.1e}")
    wrong += stats.kstest(probabilities, "uniform").pvalue < CHANCE  # of chi-square, which is then right, too
    print(f"probability of chi-square: uniform with {stats.kstest(probabilities, 'uniform').pvalue:.2g}; {wrong} wrong")
    return wrong


if __name__ == "__main__":
    sys.exit(int(main()))
