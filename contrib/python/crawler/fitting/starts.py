# SPDX-License-Identifier: LGPL-2.1-or-later
"""Searches from several starts, in this process or in others. The result of a start depends on the start only, so that
it is the same on any number of processes, and for a fit that was interrupted."""
import concurrent.futures
import math
import multiprocessing
import os
import signal
import sys
import threading
import types

import numpy as np

from ..needs import InputError, Stopped


def best_of_starts(problem, kept, workers, progress):
    """Best of all starts: (scaled variables, "" or why it did not end in order); places of the data are those of this
    start then.

    kept: {number: result of search_from()} of starts that are finished; the others are added to it.
    """
    model, places = problem.model, problem.data.places
    points = first_points(model, int(model.parameters["Fit/Starts"]), int(model.parameters["Fit/Seed"]))
    missing = {number: z for number, z in enumerate(points) if number not in kept}
    for one in wanted_of(problem, kept):
        _see(problem, one)
    if len(missing) < len(points):
        progress(f"{len(points) - len(missing)} of {len(points)} starts already done")
    searched = _searched_by_others if min(workers, len(missing)) > 1 else _searched_here
    for found in searched(problem, missing, min(workers, len(missing))):
        kept[found["start"]] = found
        _see(problem, found)
        if len(points) == 1 and found["squares"] == math.inf:
            break  # its reason is that of the InputError below
        least = _root_mean_square(problem, min(one["squares"] for one in wanted_of(problem, kept)))
        progress(f"start {found['start'] + 1} of {len(points)}: " + (
            found["reason"] if found["squares"] == math.inf else f"residuals {_root_mean_square(problem, found['squares']):.6g} (root mean square{' in deviations' if len(problem.data.series) > 1 else ''}), least so far {least:.6g}"))
    best = min(wanted_of(problem, kept), key=lambda one: one["squares"])
    model.n_runs, model.n_cut = (sum(one[key] for one in wanted_of(problem, kept)) for key in ("n_runs", "n_cut"))
    if best["squares"] == math.inf:
        raise InputError(f"the scene cannot be run at {'the start' if len(points) == 1 else f'any of {len(points)} starts'}: {kept[0]['reason']}")
    problem.data.places, problem.last = np.array(best["places"]) if len(places) else places, None
    return np.array(best["z"]), best["reason"]


def first_points(model, n, seed):
    """Initial points of n searches, in scaled variables: the values of the scene, and random ones. A larger n begins
    with the same ones."""
    random = np.random.default_rng(seed)
    return [(model.start - model.low) / (model.high - model.low), *(random.random(len(model.start)) for _ in range(n - 1))]


def wanted_of(problem, kept):
    """Finished starts among those that the scene asks for, in their order."""
    return [one for number, one in sorted(kept.items()) if number < int(problem.model.parameters["Fit/Starts"])]


def search_from(problem, number, z, places):
    """Searches from one start; returns numbers, texts and lists that a JSON file keeps exactly."""
    model, others = problem.model, problem.least
    problem.data.places, problem.last, problem.least, n_runs, n_cut = places, None, (math.inf, None, places), model.n_runs, model.n_cut
    try:
        squares, z, why = problem.search(z)
    finally:
        problem.least = min(problem.least, others, key=lambda one: one[0])
    return {"start": number, "squares": squares, "z": z.tolist(), "places": problem.data.places.tolist(), "reason": why,
            "n_runs": model.n_runs - n_runs, "n_cut": model.n_cut - n_cut}


def table_of_starts(problem, kept):
    """Table [{start, residuals, reason, values}] of finished starts: residuals is their root mean square, None if there
    is no run."""
    return [{"start": one["start"], "residuals": None if one["squares"] == math.inf else _root_mean_square(problem, one["squares"]), "reason": one["reason"],
             "values": dict(zip(problem.model.names, problem.real(one["z"]).tolist()))} for one in wanted_of(problem, kept)]


def _root_mean_square(problem, squares):
    return math.sqrt(squares / problem.data.n) * problem.scale


def _see(problem, found):
    """Passes the result of a start to the problem."""
    before = problem.data.places
    problem.data.places = np.array(found["places"])
    problem.see(found["squares"], found["z"])
    problem.data.places = before


def _searched_here(problem, missing, _workers):
    """Yields the results of search_from(), one after the other."""
    places = problem.data.places
    for number, z in missing.items():
        yield search_from(problem, number, z, places)
    problem.data.places = places


def _searched_by_others(problem, missing, workers):
    """Yields results of searches in other processes, in the order in which they end."""
    with concurrent.futures.ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), _begin_worker, (type(problem), problem.model)) as pool:
        try:
            # Workers import __main__: an empty one keeps them from running a user's script.
            main, sys.modules["__main__"] = sys.modules["__main__"], types.ModuleType("__main__")
            try:
                futures = [pool.submit(_search_in_worker, number, z) for number, z in missing.items()]
            finally:
                sys.modules["__main__"] = main
            for future in concurrent.futures.as_completed(futures):
                yield future.result()
        except concurrent.futures.process.BrokenProcessPool:
            raise Stopped("a process of the fit was killed, perhaps for lack of memory") from None
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for worker in multiprocessing.active_children():
                worker.terminate()
            raise


def _begin_worker(kind, model):
    """Ignores Ctrl-C, which is for the parent process, and ends the worker with the parent."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=lambda: (multiprocessing.parent_process().join(), os._exit(1)), daemon=True).start()
    _search_in_worker.problem = kind(model, model.data)


def _search_in_worker(number, z):
    """Calls search_from() with the problem of this process, whose places are moved by a search."""
    problem = _search_in_worker.problem
    places = problem.data.places
    try:
        return search_from(problem, number, z, places)
    finally:
        problem.data.places = places
