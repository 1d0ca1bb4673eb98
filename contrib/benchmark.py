#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures the speeds of crawler and compares them with the targets and with other programs.

    contrib/benchmark.py [build] [--repeat 3] [--json FILE]

Runs tests/benchmark/crawler_benchmark of the build folder (whole runs, sweeps, a Newton step of a large mesh)
and prints a table in Markdown. Of the repetitions the fastest counts, in processor time: the machine may be doing other
things. Each process searches for its settings, which with the runs takes about five minutes. The numbers of the other
programs are in contrib/reference/peers.json. What falls short is printed last; that is not an error.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys

SOURCE = pathlib.Path(__file__).resolve().parent.parent
FILTER = "^(run/|case/|sweep/|scale/newton_step/500000)"  # with a slash: not every name that begins so
SECONDS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
# Runs per second and core: the paths of a row that must reach them. One run to 1e-6 also has limits of time.
TARGETS = {
    "run/1e-4": {"petsc": 3000, "batch": 60000},
    "run/1e-6": {"petsc": 1000, "fused": 1 / 0.3e-3, "batch": 15000},
    "run/1e-9": {"petsc": 300, "batch": 4000},
    "case/fig2/1e-6": {},
    "case/stiff/1e-6": {},
    "sweep/1e-4": {"batch": 30000},
    "sweep/1e-6": {"batch": 8000},
}
NEWTON_STEP = ("scale/newton_step/500000", 0.060)  # 1e6 unknowns of degree 2 [s]
BATCH_FACTOR = 20  # goal: a batch is so many times as fast as the best peer


def measure(program, names, repeat=1):
    """The fastest repetition of each benchmark that matches, by name, with rate [1/s] and processor time [s]."""
    command = [program, f"--benchmark_filter={names}", f"--benchmark_repetitions={repeat}", "--benchmark_format=json"]
    finished = subprocess.run(command, stdout=subprocess.PIPE, check=False)
    if finished.returncode != 0:
        sys.exit(f"{program} ended with {finished.returncode}")
    fastest = {}
    for entry in json.loads(finished.stdout)["benchmarks"]:
        if entry.get("run_type") != "iteration":
            continue
        name = entry["run_name"]
        if entry.get("error_occurred"):
            sys.exit(f"{name}: {entry['error_message']}")
        entry["seconds"] = entry["cpu_time"] * SECONDS[entry["time_unit"]]
        entry["rate"] = entry["items_per_second"]
        if name not in fastest or entry["seconds"] < fastest[name]["seconds"]:
            fastest[name] = entry
    return fastest


def paths_of(row, found):
    """The measurements of a row: petsc, fused, batch."""
    kind, _, rest = row.partition("/")
    if kind == "sweep":
        return {"batch": found[row]}
    names = {path: f"run/{path}/{rest}" if kind == "run" else f"{row}/{path}" for path in ("petsc", "fused", "batch")}
    return {path: found[name] for path, name in names.items()}


def best_peer(row, peers):
    """Name and runs per second of the fastest peer."""
    entry = peers[row]
    rates = entry.get("peers_per_second") or {name: 1 / seconds for name, seconds in entry["peers"].items()}
    name = max(rates, key=rates.get)
    return name, rates[name]


def shortfalls(row, measured, peer):
    """What is missed, in words."""
    missed = []
    for path, rate in TARGETS[row].items():
        if measured[path]["rate"] < rate:
            missed.append(f"{row}: {path} {measured[path]['rate']:.0f} runs/s, target {rate:.0f}")
    for path, entry in measured.items():
        least = peer * (BATCH_FACTOR if path == "batch" else 1)
        if entry["rate"] < least:
            missed.append(f"{row}: {path} {entry['rate']:.0f} runs/s, {least:.0f} needed to be "
                          f"{f'{BATCH_FACTOR} x' if path == 'batch' else 'as fast as'} the best peer")
    return missed


def cell(entry):
    """Runs per second and seconds of one run."""
    return f"{entry['rate']:.0f}/s ({1e3 / entry['rate']:.3g} ms)" if entry else ""


def print_rows(found, peers):
    """The table of runs and sweeps; returns what falls short."""
    print("| case and error | target | best peer* | PETSc | fused | batch | met |\n|---|---|---|---|---|---|---|")
    missed = []
    for row, targets in TARGETS.items():
        measured = paths_of(row, found)
        name, rate = best_peer(row, peers)
        short = shortfalls(row, measured, rate)
        target = ", ".join(f"{path} {value:.0f}/s" for path, value in targets.items()) or "peers"
        cells = [cell(measured.get(path)) for path in ("petsc", "fused", "batch")]
        print(f"| {row} | {target} | {name} {rate:.0f}/s | {' | '.join(cells)} | {'no' if short else 'yes'} |")
        missed += short
    name, seconds = NEWTON_STEP
    is_met = found[name]["seconds"] <= seconds
    print(f"| Newton step, 1e6 unknowns | {seconds * 1e3:.0f} ms | | {found[name]['seconds'] * 1e3:.1f} ms | | | "
          f"{'yes' if is_met else 'no'} |")
    if not is_met:
        missed.append(f"{name}: {found[name]['seconds'] * 1e3:.1f} ms, target {seconds * 1e3:.0f} ms")
    print(f"\n* {peers['made']}\n")
    return missed


def print_settings(found):
    """True errors and settings of whole runs."""
    print("| benchmark | true error | per second | setting |\n|---|---|---|---|")
    for name, entry in found.items():
        if "error" in entry:
            back = f", {entry['given_back']:.0f} runs given back" if "given_back" in entry else ""
            print(f"| {name} | {entry['error']:.1e} | {entry['rate']:.0f} | {entry.get('label', '')}{back} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=pathlib.Path, default=SOURCE / "build")
    parser.add_argument("--repeat", type=int, default=3, help="repetitions of each benchmark")
    parser.add_argument("--json", type=pathlib.Path, help="keep the measurements in this file")
    arguments = parser.parse_args()
    program = (arguments.build / "tests/benchmark/crawler_benchmark").resolve()
    if not program.exists():
        sys.exit(f"{program} does not exist; cmake --build build --target studies makes it (needs Google Benchmark)")
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    found = measure(program, FILTER, arguments.repeat)
    if arguments.json:
        arguments.json.write_text(json.dumps(found, indent=1), encoding="utf-8")
    peers = json.loads((SOURCE / "contrib/reference/peers.json").read_text(encoding="utf-8"))
    missed = print_rows(found, peers)
    print_settings(found)
    print("\nFalls short:" if missed else "\nAll targets are met.")
    for line in missed:
        print("  " + line)


if __name__ == "__main__":
    main()
