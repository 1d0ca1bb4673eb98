#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures how much faster a sweep is on several ranks than on one.

    python3 contrib/sweep_efficiency.py [--build build] [--file prm/studies/sweep_p_chi.prm] [--ranks 2] [--repeat 3]
                                        [--set "Section/Entry=value"] [--mpirun "mpirun --oversubscribe"]

Runs the sweep on one rank and on --ranks ranks in turns, so that other work on the machine disturbs both alike. "whole" is
the wall time of the command, "sweep" the time that the sweep itself reports (without the start of the processes). A ratio is
that of two runs next to each other; the tables of all runs must be the same bit for bit, times aside.
"""
import argparse
import json
import os
import pathlib
import shlex
import statistics
import subprocess
import sys
import tempfile
import time

import h5py

SOURCE = pathlib.Path(__file__).resolve().parent.parent


def measure(command, folder):
    """Wall time, the sweep's own time [s], processor time of all ranks [s]."""
    before, start = os.times(), time.perf_counter()
    result = subprocess.run([*command, "--output", folder, "--overwrite"], capture_output=True, text=True, check=False)
    wall, after = time.perf_counter() - start, os.times()
    if result.returncode != 0:
        sys.exit(f"{shlex.join(command)} ended with {result.returncode}:\n{result.stdout}{result.stderr}")
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    processor = sum(after[2:4]) - sum(before[2:4])
    return {"whole": wall, "sweep": summary["seconds"], "processor": processor, "points": summary["points"]}


def table(folder):
    """The bytes of each column but the times."""
    with h5py.File(folder / "results.h5") as file:
        return {name: data[:].tobytes() for name, data in file["results"].items() if name != "seconds"}


def main():
    """Measures and prints a table in Markdown."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=SOURCE / "build", help="build folder")
    parser.add_argument("--file", type=pathlib.Path, default=SOURCE / "prm/studies/sweep_p_chi.prm")
    parser.add_argument("--ranks", type=int, default=2, help="compared with one rank")
    parser.add_argument("--repeat", type=int, default=3, help="pairs of runs")
    parser.add_argument("--set", action="append", default=[], help="changes an entry, as for crawler")
    parser.add_argument("--mpirun", default="mpirun --oversubscribe", help="what starts ranks")
    arguments = parser.parse_args()
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    sweep = [str(arguments.build / "crawler"), "sweep", str(arguments.file), "--quiet"]
    for entry in arguments.set:
        sweep += ["--set", entry]
    counts = (1, arguments.ranks)
    ratios = {"whole": [], "sweep": [], "processor": []}
    print("| ranks | whole [s] | sweep [s] | processor [s] | points/s | ratio, whole | ratio, sweep |\n" + 7 * "|---" + "|")
    with tempfile.TemporaryDirectory() as name:
        first = None
        for _ in range(arguments.repeat):
            pair = []
            for n in counts:
                folder = pathlib.Path(name, f"ranks-{n}")
                pair.append(measure([*shlex.split(arguments.mpirun), "-n", str(n), *sweep], folder))
                rows = table(folder)
                first = first or rows
                if rows != first:
                    sys.exit("the tables differ in " + ", ".join(key for key in first if first[key] != rows.get(key)))
            for key, values in ratios.items():
                values.append(pair[0][key] / pair[1][key])
            for n, run in zip(counts, pair):
                ends = "" if n == 1 else f"{ratios['whole'][-1]:.3f} | {ratios['sweep'][-1]:.3f}"
                print(f"| {n} | {run['whole']:.2f} | {run['sweep']:.2f} | {run['processor']:.2f} | "
                      f"{run['points'] / run['sweep']:.4g} | {ends or ' | '} |", flush=True)
    print(f"\nMedians: {statistics.median(ratios['whole']):.3f} times as fast, {statistics.median(ratios['sweep']):.3f} without "
          f"the start of the processes; {1 / statistics.median(ratios['processor']):.3f} times the processor time. All tables are the same.")


if __name__ == "__main__":
    main()
