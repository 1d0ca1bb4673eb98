#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures start-up and memory of crawler against a deal.II program that does nothing.

    python3 contrib/startup.py [--build build] [--file prm/paper/fig_s1_chi_0.4.prm] [--repeat 15]

Runs tests/benchmark/empty_program (MPI and PETSc start and end), `crawler run FILE --quiet`, and commands that compute
nothing and start neither MPI nor PETSc, in turns, from start to exit. Prints medians of the wall time [s], the ratio of
those of `crawler run` and the empty program, the processor time of the program itself (MPI also waits for a helper
process), and the largest peak of resident memory [MiB].
"""
import argparse
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent


def measure(command, expected=0):
    """Wall and processor time [s] and peak of resident memory [MiB] of one run; its output is shown if it fails."""
    start = time.perf_counter()
    with tempfile.TemporaryFile() as printed:
        process = subprocess.Popen(command, stdout=printed, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != expected:
            printed.seek(0)
            sys.exit(f"{' '.join(map(str, command))} ended with {process.returncode}:\n{printed.read().decode()}")
    return seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024  # Linux counts in KiB


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=SOURCE / "build", help="build folder (with the tests)")
    parser.add_argument("--file", type=pathlib.Path, default=SOURCE / "prm/paper/fig_s1_chi_0.4.prm")
    parser.add_argument("--repeat", type=int, default=15, help="runs of each program")
    arguments = parser.parse_args()
    empty, crawler = arguments.build / "tests/benchmark/empty_program", arguments.build / "crawler"
    for needed in (empty, crawler, arguments.file):
        if not needed.exists():
            sys.exit(f"{needed} does not exist; cmake --build build --target studies makes the programs")
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    with tempfile.TemporaryDirectory() as folder:
        run = [crawler, "run", arguments.file, "--quiet", "--overwrite", "--output", folder + "/output"]
        programs = {"empty program": ([empty], 0), "crawler run": (run, 0), "--version": ([crawler, "--version"], 0),
                    "parameters": ([crawler, "parameters"], 0), "input error": ([crawler, "run"], 2)}
        for command, expected in programs.values():
            measure(command, expected)  # the first run reads the libraries from disk
        results = {name: [] for name in programs}
        for _ in range(arguments.repeat):
            for name, (command, expected) in programs.items():
                results[name].append(measure(command, expected))
    medians = {}
    print(f"{'':15}{'median [s]':>12}{'minimum [s]':>13}{'processor [s]':>15}{'peak memory [MiB]':>19}")
    for name, samples in results.items():
        seconds, processor, peaks = zip(*samples)
        medians[name] = statistics.median(seconds)
        print(f"{name:15}{medians[name]:12.3f}{min(seconds):13.3f}{statistics.median(processor):15.3f}{max(peaks):19.1f}")
    print(f"ratio of the medians {medians['crawler run'] / medians['empty program']:.3f}")


if __name__ == "__main__":
    main()
