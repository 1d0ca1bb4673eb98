#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a run costs in Python, beside the program as a process.

    PYTHONPATH=build/python contrib/python/timing.py [--build build] [--file prm/paper/fig_s1.prm] [--repeat 50]

Prints wall and processor time [ms]: medians, but for what happens once. Then the runs that searches of fits need: of
Gauss and Newton with differences of runs, as they are, and of L-BFGS by the gradient of chi-square alone, where each run
would have a sweep of the adjoint beside it.
"""
import argparse
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import numpy  # noqa: F401  its import is not counted

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def processor_time():
    """Of this process and those that it waited for [s]."""
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def measure(name, action, repeat=1, parts=1):
    """Prints a line; the action has so many parts, each of which counts."""
    walls, processors = [], []
    for _ in range(repeat):
        wall, processor = time.perf_counter(), processor_time()
        action()
        walls.append((time.perf_counter() - wall) / parts)
        processors.append((processor_time() - processor) / parts)
    print(f"{name:42}{1e3 * statistics.median(walls):10.2f}{1e3 * statistics.median(processors):12.2f}")


def load():
    import crawler
    return crawler


def tracks_of(crawler, scene, settings, duration, places, noise):
    """Tracks of 13 markers in 300 frames, from a run, and a setting with their places."""
    import numpy
    from crawler.measured import Samples
    t = numpy.linspace(0, duration, 300)
    x = crawler.run(scene, set=settings, fields=t, places=places).fields.position
    x += noise * numpy.random.default_rng(1).standard_normal(x.shape)
    return Samples("x", numpy.arange(13.), t, x, [str(i) for i in range(13)]), {"Fit/Markers at": ", ".join(map(repr, places.tolist()))}


def fits(crawler):
    """Fits of three numbers, and of 16, 15 of which are a stress that starts at nothing: [(scene, tracks, settings)]."""
    import numpy
    worm, exponent, modes = str(SOURCE / "prm/studies/fit_worm.prm"), "Body/Anchoring exponent", "Active stress/Modes/"
    truth = {"Fit/Variables": "", "Body/Elastic modulus": 1.3, exponent: 2.4, "Active stress/Travelling wave/Amplitude": 0.25}
    tracks, places = tracks_of(crawler, worm, truth, 12, numpy.linspace(0, 3, 13), 0.01)
    yield worm, tracks, places
    scene = {exponent: 1.8, "Active stress/Generator": "modes", modes + "In time": "splines", modes + "Harmonics": 1, modes + "Time cells": 3}
    stress = (0.15 * numpy.random.default_rng(3).standard_normal(15)).tolist()
    tracks, places = tracks_of(crawler, scene, {modes + "Coefficients": ", ".join(map(repr, stress))}, 1, numpy.linspace(0, 1, 13), 0.004)
    yield ({**scene, modes + "Coefficients": ", ".join(15 * ["0"])}, tracks,
           {**places, "Fit/Variables": f"{modes}Coefficients[1-15] : -1 to 1; {exponent} : 0.5 to 5", "Fit/Standard deviation": 0.004})


def print_searches(scene, tracks, settings):
    """Prints the runs that searches from the start of a scene need, and where they end."""
    import numpy
    from crawler.fitting import prepared
    from crawler.fitting.fit import LARGEST_ACCURACY, Failed, Problem
    from scipy.optimize import minimize
    model, _ = prepared(scene, [f"{name}={value}" for name, value in settings.items()], tracks)
    model.accuracy, problem = LARGEST_ACCURACY, Problem(model, model.data)
    start = (model.start - model.low) / problem.width
    squares, _, why = problem.search(start)
    print(f"{len(start)} numbers: {model.n_runs} runs, least sum {squares:.6g} {why}", end="; ")
    effects = numpy.linalg.norm(problem.jacobian(start), axis=0)  # they scale the variables for L-BFGS
    unit = 1 / numpy.where(effects > 0, effects, effects.max())

    def value_and_gradient(y):
        try:
            residuals = problem.residuals(y * unit)
            return residuals @ residuals, 2 * unit * (problem.jacobian(y * unit).T @ residuals)
        except Failed:  # no run there: the search goes back
            return 1e9 * squares, numpy.zeros(len(y))
    found = minimize(value_and_gradient, start / unit, jac=True, method="L-BFGS-B", bounds=[(0, 1 / one) for one in unit],
                     options={"ftol": 1e-6 / model.data.n, "maxcor": 20, "maxiter": 1000})
    print(f"L-BFGS: {found.nfev} runs with sweeps, least sum {found.fun:.6g}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=SOURCE / "build")
    parser.add_argument("--file", type=pathlib.Path, default=SOURCE / "prm/paper/fig_s1.prm")
    parser.add_argument("--repeat", type=int, default=50)
    arguments = parser.parse_args()
    file, program = str(arguments.file), str(arguments.build / "crawler")
    sys.path.insert(0, str(arguments.build / "python"))
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
    print(f"{'':42}{'wall [ms]':>10}{'processor':>12}")
    measure("import crawler", load)
    crawler = load()
    measure("libraries, at the first use", crawler.entries)
    measure("the first run (MPI and PETSc start)", lambda: crawler.run(file, fields=False))
    measure("run(file)", lambda: crawler.run(file), arguments.repeat)
    measure("run(file, fields=False)", lambda: crawler.run(file, fields=False), arguments.repeat)
    measure("  of which check(file)", lambda: crawler.check(file), arguments.repeat)
    stiffness = [1 + 1e-3 * i for i in range(1024)]
    entry = "Body/Elastic modulus"
    measure("batch, each of 64", lambda: crawler.batch([file] * 64), 5, 64)
    measure("sweep, each of 1024 points", lambda: crawler.sweep(file, {entry: stiffness}), 3, 1024)
    scenes = list(fits(crawler))
    scene, tracks, settings = scenes[0]
    measure("fit, 3 numbers to 13 markers x 300 frames", lambda: crawler.fit(scene, tracks, set=settings), 5)
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "run", file, "--quiet", "--overwrite", "--output", folder + "/output"]
        measure("crawler run, a process with files", lambda: subprocess.run(command, check=True), 7)
        command += ["--set", "Output/Number of snapshots=0", "--set", "Output/Statistics=false"]
        measure("crawler run, without fields", lambda: subprocess.run(command, check=True), 7)
    for one in scenes:
        print_searches(*one)


if __name__ == "__main__":
    main()
