#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the rows of a tradeoff mean together (contrib/python/crawler/tradeoff.py), on rows that are made up.

    python3 tradeoff.py
"""
import math
import pathlib
import random
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "contrib/python"), str(ROOT / "tests/support")]
from crawler.tradeoff import evaluate, pareto_front, recommend, recommendations_prm  # noqa: E402
from program import checks, expect  # noqa: E402



def row(cells, error, seconds, bar=1e-12, **others):
    """A row of a single run that finished with this error."""
    return {"model": "nonlinear", "formulation": "position", "mesh": "uniform", "engine": "fused", "integrator": "radau 5", "degree": "4",
            "cells": str(cells), "mesh tolerance": "", "tolerance": "0.1", "entries": f"Model=nonlinear; Discretization/Number of cells={cells}",
            "status": "finished", "reason": "", "message": "", "error": repr(error), "shown error": repr(max(error, bar)),
            "below bar": "true" if error < bar else "false", "seconds": repr(seconds), "memory": "2000.0", **others}


def gap(cells, reason):
    return {**row(cells, 0.0, 0.0), "status": "stopped" if reason else "", "reason": reason, "error": "", "shown error": "", "seconds": "",
            "memory": "", "below bar": "false"}


def test_front():
    """It is what no other point beats."""
    nan = math.nan
    for costs, errors, front in (([1, 2, 3, 2.5], [3, 2, 1, 2.5], [0, 1, 2]),
                                 # Of two that are as good the cheaper one, as cheap the better one, of equal ones the first.
                                 ([2, 1], [1, 1], [1]), ([1, 1], [2, 1], [1]), ([1, 1], [1, 1], [0]),
                                 ([nan, 1, 0.5], [0, nan, 1], [2]), ([], [], [])):
        expect(pareto_front(costs, errors) == front, f"the front of {costs}, {errors}: {pareto_front(costs, errors)}")
    numbers = random.Random(1)
    points = [(numbers.randrange(40), numbers.randrange(40)) for _ in range(300)]  # with ties
    front = pareto_front(*zip(*points))
    for i, (cost, error) in enumerate(points):
        beaten = any(c <= cost and e <= error and ((c, e) != (cost, error) or j < i) for j, (c, e) in enumerate(points))
        expect((i in front) != beaten, f"point {i} by the definition")


def test_bar():
    """Errors below the bar count as the bar: nothing is said about what is smaller."""
    found = evaluate([row(4, 1e-3, 1, 1e-6), row(8, 1e-9, 2, 1e-6), row(16, 1e-8, 3, 1e-6)])
    expect(found["pareto"] == [0, 1], "the last one cannot be told from the middle")
    last = found["recommendations"][-1]
    expect(last["accuracy"] == 1e-6 and last["index"] == 1 and last["error"] == 1e-9, f"nothing is said about 1e-7: {last}")
    expect("error below the bar of 1.0e-06, 2 s, 2 kB" in found["advice"][-1], f"in words: {found['advice']}")


def test_safe():
    """A small error by luck, which a tighter tolerance on the mesh does not have, is not recommended."""
    rows = [row(4, 1e-7, 1), row(4, 5e-3, 2), row(8, 9e-5, 3), row(8, 9e-6, 4)]
    expect(recommend(rows) == [(2, 0), (3, 2), (4, 2), (5, 3)], f"the cheapest that is safe: {recommend(rows)}")
    text = recommendations_prm(rows)
    expect("# For 1e-5: error 9.0e-06, 4 s, 2 kB\nset Model = nonlinear\nsubsection Discretization\n  set Number of cells = 8\nend\n" in text,
           f"a block for the parameter file: {text}")
    advice = evaluate(rows)["advice"]
    expect(advice[2].startswith("For 1e-3 and 1e-4 use position, fused, radau 5, degree 4, 8 cells, tolerance 0.1 of the displacement: error"),
           f"accuracies with the same setting share a line: {advice}")


def test_doubt():
    """Nothing is recommended that may be worse than it looks: a level that says so, a mesh whose tighter tolerances have failed or
    are not tried; but a tighter tolerance for which there was no time says nothing."""
    level = row("", 1e-9, 0.1, model="kinematic", message="the error may be larger")
    for reason, good in (("", False), ("not_converged", False), ("time_limit", True)):
        found = evaluate([level, row(8, 1e-3, 1), gap(8, reason)])
        expect([item["index"] for item in found["recommendations"]] == [1] * 2 * good, f"behind a gap {reason!r}: {found['recommendations']}")
        expect(good or "nothing to recommend" in found["advice"][-1], f"that is said: {found['advice']}")


def test_batches():
    """They have a front and recommendations of their own."""
    found = evaluate([row(4, 1e-3, 1), row(4, 1e-3, 0.1, engine="batch"), gap(16, "gave_up")])
    expect(found["pareto"] == [0, 1] and [item["index"] for item in found["recommendations"]] == [0, 0]
           and [(item["index"], item["prm"]) for item in found["batch_recommendations"]] == [(1, None)] * 2, f"batches: {found}")
    expect(found["advice"][0] == "2 settings finished, 0 of them below the bar, 2 on the Pareto fronts; gaps: gave_up 1."
           and found["advice"][-1].startswith("Many bodies, for 1e-2 and 1e-3: position, batch"), f"in words: {found['advice']}")


for test in (test_front, test_bar, test_safe, test_doubt, test_batches):
    test()
checks.end()
