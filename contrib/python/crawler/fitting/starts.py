# SPDX-License-Identifier: LGPL-2.1-or-later
"""Searches from several starts, in this process or in others. The result of a start depends on the start only, so that
it is the same on any number of processes, and for a fit that was interrupted."""
import concurrent.futures
import contextlib
import math
import multiprocessing
import signal
import sys
import threading
import types
from multiprocessing import resource_tracker

import numpy as np

from ..needs import STOPPING, InputError, Stopped, end_with_parent
from . import progress


def best_of_starts(problem, kept, workers):
    """Best of all starts: (scaled variables, "" or why it did not end in order); places of the data are those of this
    start then.

    kept: {number: result of search_from()} of starts that are finished; the others are added to it.
    """
    model, places, say = problem.model, problem.data.places, problem.progress
    points = first_points(model, int(model.parameters["Fit/Starts"]), int(model.parameters["Fit/Seed"]))
    missing = {number: z for number, z in enumerate(points) if number not in kept}
    for one in wanted_of(problem, kept):
        _see(problem, one)
    if len(missing) < len(points):
        say(f"{len(points) - len(missing)} of {len(points)} starts already done")
    searched = _searched_by_others if min(workers, len(missing)) > 1 else _searched_here
    with contextlib.closing(searched(problem, missing, min(workers, len(missing)))) as results:
        for found in results:
            kept[found["start"]] = found
            _see(problem, found)
            if len(points) == 1 and found["squares"] == math.inf:
                break  # its reason is that of the InputError below
            least = problem.root_mean_square(min(one["squares"] for one in wanted_of(problem, kept)))
            say(f"start {found['start'] + 1} of {len(points)}: " + (
                found["reason"] if found["squares"] == math.inf else f"residuals {problem.root_mean_square(found['squares']):.6g} (root mean square{' in deviations' if len(problem.data.series) > 1 else ''}), least so far {least:.6g}"))
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
    return [{"start": one["start"], "residuals": None if one["squares"] == math.inf else problem.root_mean_square(one["squares"]), "reason": one["reason"],
             "values": dict(zip(problem.model.names, problem.real(one["z"]).tolist()))} for one in wanted_of(problem, kept)]


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
        problem.progress.begin(f"start {number + 1} of {int(problem.model.parameters['Fit/Starts'])}")
        yield search_from(problem, number, z, places)
    problem.data.places = places


def _searched_by_others(problem, missing, workers):
    """Yields results of searches in other processes, in the order in which they end."""
    others, spawn = multiprocessing.active_children(), multiprocessing.get_context("spawn")
    n_runs, least = (spawn.RawArray("d", [none] * (max(missing) + 1)) for none in (0.0, math.inf))  # [start]
    with contextlib.ExitStack() as stack:
        try:
            with _without_signals():
                pool = stack.enter_context(concurrent.futures.ProcessPoolExecutor(
                    workers, spawn, _begin_worker, (type(problem), problem.model, n_runs, least)))
                futures = [pool.submit(_search_in_worker, number, z) for number, z in missing.items()]
            problem.progress.begin(f"searches on {workers} processes")
            seen = 0
            while futures:
                done, futures = concurrent.futures.wait(futures, progress.EVERY, concurrent.futures.FIRST_COMPLETED)
                yield from (future.result() for future in done)
                seen, before = sum(n_runs), seen
                problem.progress.ran(int(seen - before), lambda: problem.so_far(min(least)))
        except concurrent.futures.process.BrokenProcessPool:
            raise Stopped("a process of the fit was killed, perhaps for lack of memory") from None
        except BaseException:
            for process in multiprocessing.active_children():
                if process not in others:
                    process.kill()  # so that the pool ends, too
            raise


@contextlib.contextmanager
def _without_signals():
    """Starts of processes within: none of them gets a signal that is for the parent, which ends them; nor does Python's
    process for semaphores, after which each of these would print an error. A signal that another thread gets waits for
    the end, too: an exception within would leave a process that nobody knows."""
    main, before, came = sys.modules["__main__"], signal.pthread_sigmask(signal.SIG_BLOCK, STOPPING), []
    here = threading.current_thread() is threading.main_thread()  # where Python runs all handlers
    handlers = {number: signal.signal(number, lambda number, _frame: came.append(number))
                for number in STOPPING if here and callable(signal.getsignal(number))}
    sys.modules["__main__"] = types.ModuleType("__main__")  # which workers import, instead of running a user's script
    try:
        resource_tracker.ensure_running()
        signal.pthread_sigmask(signal.SIG_BLOCK, STOPPING)  # it unblocks some
        yield
    finally:
        sys.modules["__main__"] = main
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        for number, handler in handlers.items():
            signal.signal(number, handler)
        for number in came:
            signal.raise_signal(number)


def _begin_worker(kind, model, n_runs, least):
    """Makes the problem of a worker, which ends with its parent. n_runs, least: for the parent, the number of runs and
    the least sum of squares of each start."""
    end_with_parent(signal.SIGKILL)
    _search_in_worker.problem, _search_in_worker.shared = kind(model, model.data), (n_runs, least)


def _search_in_worker(number, z):
    """Calls search_from() with the problem of this process, whose places are moved by a search."""
    problem, (n_runs, least) = _search_in_worker.problem, _search_in_worker.shared
    places = problem.data.places

    def ran():
        n_runs[number] += 1
        least[number] = problem.least[0]

    problem.model.ran = ran
    try:
        return search_from(problem, number, z, places)
    finally:
        problem.data.places = places
