#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a run costs in Python, beside the program as a process.

    PYTHONPATH=build/python contrib/python/timing.py [--build build] [--file prm/paper/fig_s1.prm] [--repeat 50]

Prints wall and processor time [ms]: medians, but for what happens once.
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


def fit_of_tracks(crawler):
    """The fit of a worm whose tracks a run makes."""
    import numpy
    from crawler.measured import Samples
    scene = str(SOURCE / "prm/studies/fit_worm.prm")
    t, s = numpy.linspace(0, 12, 300), numpy.linspace(0, 3, 13)
    set_truth = {"Fit/Variables": "", "Body/Elastic modulus": 1.3, "Body/Anchoring exponent": 2.4, "Active stress/Travelling wave/Amplitude": 0.25}
    x = crawler.run(scene, set=set_truth, fields=t, places=s).fields.position
    tracks = Samples("x", numpy.arange(13.), t, x + 0.01 * numpy.random.default_rng(1).standard_normal(x.shape), [str(i) for i in range(13)])
    return lambda: crawler.fit(scene, tracks, markers_at=s)


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
    measure("fit, 3 numbers to 13 markers x 300 frames", fit_of_tracks(crawler), 5)
    with tempfile.TemporaryDirectory() as folder:
        command = [program, "run", file, "--quiet", "--overwrite", "--output", folder + "/output"]
        measure("crawler run, a process with files", lambda: subprocess.run(command, check=True), 7)
        command += ["--set", "Output/Number of snapshots=0", "--set", "Output/Statistics=false"]
        measure("crawler run, without fields", lambda: subprocess.run(command, check=True), 7)


if __name__ == "__main__":
    main()
