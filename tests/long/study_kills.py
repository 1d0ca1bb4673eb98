#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Studies that are killed at random places and resumed lose nothing and compute nothing twice; little memory.

    python3 study_kills.py PATH_TO_CRAWLER MPIRUN [KILLS [SEED]]

KILLS: so many of a sweep (default: 20), and a quarter of it of a cross-checked one, a tradeoff and an optimisation: of one
rank, of mpirun, by SIGTERM. tests/cli/sweep.py, tradeoff.py and optimize.py are the short versions. Some minutes.
"""
import ctypes
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import PATIENCE, Places, call, checks, environment, expect, on_ranks, prm  # noqa: E402
from tables import csv_rows, h5_columns, json_of  # noqa: E402

CHI, P = "Active stress/Optimal wave/Perturbation parameter", "Body/Anchoring exponent"
BODY = prm("Accuracy=1e-4", "Active stress/Optimal wave/Perturbation parameter=0.4",
           "Active stress/Optimal wave/Choose wave by=wave speed", "Tradeoff/Integrators=radau 5, bdf",
           "Tradeoff/Degrees=2, 6", "Tradeoff/Cells=3, 8", "Tradeoff/Mesh tolerances=1e-3",
           "Tradeoff/Tolerances=logspace(-2, -8, 4)", "Tradeoff/Repetitions=1")
CHECKED = ("--set", "Sweep/Cross-check=true")
PROGRAM, MPIRUN = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
PRM = pathlib.Path(__file__).resolve().parents[2] / "prm" / "studies"
N_KILLS, SEED = int(sys.argv[3]) if len(sys.argv) > 3 else 20, int(sys.argv[4]) if len(sys.argv) > 4 else 7
# Runs a command that stops at its place, sends mpirun the signal instead, and lets the command go on.
KILLER = """
import os, signal, subprocess, sys
rank = subprocess.Popen(sys.argv[2:])
if os.WIFSTOPPED(os.waitpid(rank.pid, os.WUNTRACED)[1]):
    os.kill(os.getppid(), int(sys.argv[1]))
    rank.send_signal(signal.SIGCONT)
"""


class Study:
    """One of the studies: how it is started, which files it makes, and what is kept of an unfinished one."""

    def __init__(self, command, files, most_rows):
        self.command, self.files, self.most_rows = command, files, most_rows

    def start(self, output, *more, ranks=1):
        return call([*on_ranks(MPIRUN, ranks), PROGRAM, *self.command, "--output", output.name, *more], output.parent)

    def done(self, output):
        """What is computed: {row: its seconds}."""
        raise NotImplementedError

    def answers(self, output):
        """What does not depend on who computed it, and when."""
        raise NotImplementedError


class PointStudy(Study):
    """A sweep."""

    def __init__(self, command, table="results"):
        super().__init__(command, ("original.prm", "parameters.prm", f"{table}.h5", f"{table}.csv", "summary.json"), 300)
        self.table = table

    def columns(self, output):
        """Of the table, if there is one."""
        file = output / f"{self.table}.h5"
        return h5_columns(file, self.table) if file.exists() else None

    def done(self, output):
        rows = self.columns(output)
        return {i: rows["seconds"][i] for i, status in enumerate(rows["status"]) if status} if rows else {}

    def answers(self, output):
        return {name: column if isinstance(column, list) else column.tobytes()
                for name, column in self.columns(output).items() if not name.endswith("seconds")}


class TradeoffStudy(PointStudy):
    """What a setting costs is no answer; one that did not finish has no seconds."""

    def done(self, output):
        return {row: seconds for row, seconds in super().done(output).items() if seconds == seconds}

    def answers(self, output):
        costs = ("seconds", "spread", "repetitions", "memory")
        return {name: column for name, column in super().answers(output).items() if not name.endswith(costs)}


class OptimizeStudy(Study):
    """A row for each start; one that was stopped goes on."""

    def done(self, output):
        file = output / "starts.h5"
        rows = h5_columns(file, "starts") if file.exists() else {"status": []}
        return {(rows["case"][i], rows["start"][i]): rows["seconds"][i]
                for i, status in enumerate(rows["status"]) if status == "finished"}

    def answers(self, output):
        return [{name: value for name, value in row.items() if name != "seconds"}
                for row in csv_rows(output / "results.csv")]


def disturbed(study, output, victim, n, rank, place):
    """The study on n ranks, of which one comes to the place: its exit code when all of its processes have ended."""
    own = [PROGRAM, *study.command, "--output", output.name, "--resume"]
    if victim == "rank":
        chosen = ["env", f"CRAWLER_STOP_AT={place}:KILL", *own]
    elif victim == "one signal":
        chosen = ["env", f"CRAWLER_STOP_AT={place}:TERM", *own]
    else:
        number = {"mpirun": signal.SIGKILL, "mpirun in order": signal.SIGTERM}[victim]
        chosen = ["env", f"CRAWLER_STOP_AT={place}:STOP", sys.executable, "-c", KILLER, int(number), *own]
    words = [MPIRUN, "--oversubscribe"]
    for i in range(n):
        words += [":"] * (i > 0) + ["-n", 1] + (chosen if i == rank else own)
    process = subprocess.Popen([str(word) for word in words], cwd=output.parent, env=environment(), stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    signal.alarm(PATIENCE)  # ends what hangs
    code = process.wait()
    try:
        while True:
            os.wait()  # the ranks of an mpirun that was killed
    except ChildProcessError:
        signal.alarm(0)
    return code


def kills(name, study, folder, n_kills):
    """The study is stopped so often, resumed each time; in the end it is what it would be without."""
    whole = study.start(folder / "whole")
    expect(whole.returncode == 0, f"{name}: an unbroken one {whole.stderr}")
    reference, hits, output, before = study.answers(folder / "whole"), 0, folder / "killed", {}
    chance = random.Random(SEED)
    places = Places(chance, ("row", "row", "step", "write"), study.files, {"row": study.most_rows, "step": 4096})
    for _ in range(20 * n_kills):
        if hits == n_kills:
            break
        victim = chance.choice(("rank", "rank", "mpirun", "mpirun in order", "one signal"))
        n = chance.choice((2, 2, 3, 4))
        what, place = places.next()
        rank = 0 if place.startswith("write") else chance.randrange(n)
        code = disturbed(study, output, victim, n, rank, place)
        where = f"{name}: {victim} at {place} of rank {rank} of {n}: exit code {code}, {len(before)} rows before"
        if code == 0:  # too late
            expect(study.answers(output) == reference, f"{where}: another table")
            places.too_late(what)
            shutil.rmtree(output)
            before = {}
            continue
        hits += 1
        wanted = {"rank": 128 + signal.SIGKILL, "mpirun": -signal.SIGKILL, "one signal": 5}
        expect(code == wanted.get(victim, code), where)
        now = study.done(output)
        lost = [row for row, seconds in before.items() if now.get(row) != seconds]
        expect(not lost, f"{where}: lost or computed again: {lost[:9]}")
        before = now
    expect(hits == n_kills, f"{name}: {hits} of {n_kills} kills hit")
    last = study.start(output, "--resume", ranks=3)
    now = study.done(output)
    expect(last.returncode == 0 and study.answers(output) == reference and all(now[row] == before[row] for row in before),
           f"{name}: in the end it is the unbroken one {last.stderr}")


def write(folder, axes):
    """scene.prm with these axes."""
    (folder / "scene.prm").write_text(BODY + prm(f"Sweep/Axes={axes}"), encoding="utf-8")


def test_kills(folder):
    point_study = {"sweep": PointStudy(("sweep", "scene.prm")),
                   "cross-check": PointStudy(("sweep", "scene.prm", "--set", "Accuracy=1e-3", *CHECKED, "--set",
                                              f"Sweep/Axes={CHI} : linspace(0.1, 0.3, 60); {P} : 0, 2"))}
    budgets = ("--set", "Sweep/Axes=Optimize/Work : 0.001, 0.003", "--set", "Optimize/Objective=displacement",
               "--set", "Optimize/Starts=3")
    tables = ("starts.h5", "results.h5", "results.csv", "starts.csv", "summary.json")
    studies = {**point_study,
               "tradeoff": TradeoffStudy(("tradeoff", "scene.prm"), "tradeoff"),
               "optimize": OptimizeStudy(("optimize", PRM / "optimize_harmonics.prm", *budgets), tables, 400)}
    for name, study in studies.items():
        (folder / name).mkdir()
        write(folder / name, f"{P} : linspace(1.5, 4, 16); {CHI} : linspace(0.05, 0.5, 48)")
        kills(name, study, folder / name, N_KILLS if name == "sweep" else max(1, N_KILLS // 4))


def test_out_of_memory(folder):
    """What a run throws is how it ends: with a reason, a summary and exit code 3; in a sweep it is a row."""
    cells = "Discretization/Number of cells"
    limited = ("sh", "-c", 'ulimit -v 1600000; exec "$@"', "sh", PROGRAM)
    write(folder, f"{cells} : 4, 10000000, 5")
    for tolerance in ((), ("--set", "Time/Tolerance=1e-3")):  # in a pilot run, and in the run itself
        result = call([*limited, "run", "scene.prm", "--output", "large", "--overwrite", "--quiet", "--set",
                       f"{cells}=10000000", *tolerance], folder)
        file = folder / "large" / "summary.json"
        summary = json_of(file) if file.is_file() else {}
        expect(result.returncode == 3 and summary.get("status") == "failed" and summary.get("reason") == "out_of_memory" and
               "out_of_memory" in result.stderr, f"a run that needs too much memory says so: {result}")
    result = call([*limited, "sweep", "scene.prm", "--output", "memory"], folder)
    rows = h5_columns(folder / "memory" / "results.h5", "results")
    expect(result.returncode == 0 and rows["reason"] == ["", "out_of_memory", ""] and
           rows["status"] == ["finished", "failed", "finished"], f"in a sweep it is a row {rows['reason']} {result.stderr}")


print(f"{N_KILLS} kills, seed {SEED}", flush=True)
ctypes.CDLL(None).prctl(36, 1)  # PR_SET_CHILD_SUBREAPER: the ranks of a killed mpirun become children of this process
checks.run((test_out_of_memory, test_kills))
