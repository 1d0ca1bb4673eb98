#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler tradeoff on a small study: its files agree, nothing is lost or done twice, and its advice holds.

    python3 tradeoff.py PATH_TO_CRAWLER MPIRUN
"""
import csv
import json
import math
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

import h5py

ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1",
                   OPENBLAS_NUM_THREADS="1")
BODY = """
subsection Active stress
  subsection Optimal wave
    set Perturbation parameter = 0.4
    set Choose wave by = wave speed
  end
end
"""
STUDY = """
subsection Tradeoff
  set Integrators     = radau 5, bdf
  set Degrees         = 2, 6
  set Cells           = 3, 8
  set Mesh tolerances = 1e-3
  set Tolerances      = logspace(-2, -8, 4)
  set Repetitions     = 1
end
"""
KEY = ("model", "formulation", "mesh", "engine", "integrator", "degree", "cells", "mesh tolerance", "tolerance")
DETERMINISTIC = ("status", "reason", "displacement", "error", "shown error", "below bar", "steps")
REFERENCE = 9.0072529800e-2  # doc/theory.md
failures = 0


def check(condition, what):
    """Prints what was checked and counts failures."""
    global failures
    failures += not condition
    print(f"{'ok    ' if condition else 'FAILED'} {what}", flush=True)


def write_study(folder):
    """The study as small.prm."""
    pathlib.Path(folder, "small.prm").write_text(BODY + STUDY, encoding="utf-8")


def call(program, folder, *arguments, command=()):
    """Runs the program in the folder."""
    return subprocess.run([*command, program, *arguments], cwd=folder, env=ENVIRONMENT, capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=300, check=False)


def table(folder):
    """The rows of tradeoff.csv."""
    with open(folder / "tradeoff.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def summary_of(folder):
    """summary.json."""
    return json.loads((folder / "summary.json").read_text(encoding="utf-8"))


def number(text):
    """What is not known is empty in CSV and not a number in HDF5."""
    return float(text) if text else math.nan


def same(a, b):
    """Numbers that are equal, or both not known."""
    return a == b or (math.isnan(a) and math.isnan(b))


def answers(rows):
    """What must not depend on who computed it and when."""
    return {tuple(row[name] for name in KEY): tuple(row[name] for name in DETERMINISTIC) for row in rows}


def check_rows(rows, summary):
    """Every setting is one row, with cost and error or a reason."""
    check(len(answers(rows)) == len(rows) == summary["tried"] <= summary["settings"], f"{len(rows)} different settings")
    check(len({row["index"] for row in rows}) == len(rows), "each with a number of its own")
    reference = summary["reference"]
    check(abs(reference["displacement"] - REFERENCE) < 1e-11 and reference["relative_bar"] < 1e-10,
          f"reference {reference}")
    finished = [row for row in rows if row["status"] == "finished"]
    check(all(math.isclose(number(row["error"]), abs(number(row["displacement"]) - reference["displacement"])
                           / reference["size"], rel_tol=1e-9, abs_tol=1e-16) for row in finished),
          "errors are distances to the reference")
    check(all(number(row["shown error"]) == max(number(row["error"]), reference["relative_bar"]) and
              (row["below bar"] == "true") == (number(row["error"]) < reference["relative_bar"]) for row in finished),
          "errors are shown at the bar or above")
    check(all(number(row["seconds"]) > 0 and number(row["memory"]) >= (row["model"] == "nonlinear")
              and number(row["repetitions"]) >= 1 and number(row["spread"]) >= 0 for row in finished), "all that finished have a cost")
    gaps = [row for row in rows if row["status"] != "finished"]
    check(all(row["reason"] and row["message"] and not row["seconds"] and row["pareto"] == "false" for row in gaps),
          f"{len(gaps)} gaps have a reason, and no cost")
    # fused: all but radau 5 on uniform meshes; batch: that in the position form only; petsc: the position form
    n_missing = sum(row["status"] == "not offered" for row in rows)
    check(n_missing == (8 - 2) + (8 - 1) + 4, f"what is not offered is said ({n_missing} combinations)")
    rungs = {row["model"]: row for row in finished if row["model"] != "nonlinear"}
    check(abs(number(rungs["perturbation"]["displacement"]) - 0.08) < 1e-12  # chi^2/2
          and abs(number(rungs["kinematic"]["displacement"]) - 9.372520e-2) < 1e-8, "the rungs are rows, too")
    finished = [row for row in finished if row["model"] == "nonlinear"]
    check({row["engine"] for row in finished} == {"fused", "petsc", "batch"}
          and {row["mesh"] for row in finished} == {"uniform", "adaptive"}
          and {row["formulation"] for row in finished} == {"position", "stretch"}, "all ways have finished")


def check_pareto(rows):
    """By the definition: no other row is as cheap and as good, and better in one."""
    good = True
    for batch in False, True:
        own = [(number(row["seconds"]), number(row["shown error"]), row["pareto"] == "true") for row in rows
               if row["status"] == "finished" and (row["engine"] == "batch") == batch]
        for cost, error, on_front in own:
            beaten = any(c <= cost and e <= error and (c, e) != (cost, error) for c, e, _ in own)
            good &= on_front != beaten
        check(sum(on_front for _, _, on_front in own) > 1, "a front of several")
    check(good, "the Pareto fronts are what the definition says")


def check_hdf5(folder, rows):
    """The same numbers and texts in tradeoff.h5."""
    with h5py.File(folder / "tradeoff.h5") as file:
        group = file["tradeoff"]
        names = {bytes(dataset.attrs["name"]).decode(): dataset for dataset in group.values()}
        good = set(names) == set(rows[0])
        for name, dataset in names.items():
            if h5py.check_string_dtype(dataset.dtype):
                good &= list(dataset.asstr()[:]) == [row[name] for row in rows]
            else:
                good &= all(same(a, number(row[name])) for a, row in zip(dataset[:], rows))
        check(good, "tradeoff.h5 has what tradeoff.csv has")
        check(group["seconds"].attrs["unit"] == b"s" and b"subsection Tradeoff" in group.attrs["parameters.prm"]
              and "version of PETSc" in group.attrs, "tradeoff.h5 knows units and where it comes from")


def check_files(folder):
    """The files of a study that is finished."""
    names = {path.name for path in folder.iterdir()}
    check(names == {"original.prm", "parameters.prm", "log.txt", "tradeoff.csv", "tradeoff.h5", "tradeoff.png",
                    "tradeoff.svg", "summary.json", "recommendations.prm"}, f"files {sorted(names)}")
    check((folder / "tradeoff.png").read_bytes()[:4] == b"\x89PNG" and "<svg" in (folder / "tradeoff.svg").read_text(),
          "pictures are pictures")


def check_advice(program, folder, output, screen):
    """Each recommendation, pasted into the file, reproduces its error."""
    summary = summary_of(output)
    advice = summary["recommendations"]
    check([item["accuracy"] for item in advice] == [10.0**-k for k in range(2, 2 + len(advice))] and len(advice) >= 5,
          f"{len(advice)} recommendations")
    check(all(re.search(rf"^For .*1e-{len(advice) + 1} use .*error", text, re.MULTILINE)
              for text in (screen, (output / "log.txt").read_text(encoding="utf-8"))), "on the screen and in log.txt")
    blocks = (output / "recommendations.prm").read_text(encoding="utf-8")
    for item in {item["setting"]: item for item in advice}.values():
        check(item["prm"] in blocks, f"recommendations.prm has {item['setting']}")
        pathlib.Path(folder, "pasted.prm").write_text(BODY + item["prm"], encoding="utf-8")
        call(program, folder, "run", "pasted.prm", "--overwrite", "--quiet", "--set", "Output/Number of snapshots=0")
        run = summary_of(pathlib.Path(folder, "output-pasted"))
        error = abs(run["displacement"] - summary["reference"]["displacement"]) / summary["reference"]["size"]
        check(run["status"] == "finished" and error <= item["accuracy"]
              and math.isclose(error, item["error"], rel_tol=1e-3, abs_tol=1e-12),
              f"pasted for {item['accuracy']:g}: error {error:.3e}, measured {item['error']:.3e}")


def start(program, folder, output, *arguments, command=()):
    """Starts the study and waits until some settings are done."""
    process = subprocess.Popen([*command, program, "tradeoff", "small.prm", "--output", output, *arguments], cwd=folder,
                               env=ENVIRONMENT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
    rows, end = pathlib.Path(folder, output, "rows"), time.time() + 60
    while process.poll() is None and time.time() < end and (
            sum(path.read_bytes().count(b"\n") for path in rows.glob("*.jsonl")) < 5):
        time.sleep(0.01)
    return process


def check_kill(program, folder, expected, mpirun):
    """kill -9 at a random moment loses nothing but what was under way."""
    seed = int(time.time())
    slow = ("--set", "Tradeoff/Repetitions=20")  # so that it does not end before it is killed
    process = start(program, folder, "killed", *slow)
    time.sleep(random.Random(seed).uniform(0, 1))
    process.kill()
    process.communicate()
    output = pathlib.Path(folder, "killed")
    lines = (output / "rows" / "0.jsonl").read_text(encoding="utf-8").splitlines()
    before = {row["index"]: row for row in map(json.loads, lines[:-1])}
    with open(output / "rows" / "0.jsonl", "a", encoding="utf-8") as file:
        file.write(lines[0][:40])  # what a full disk or a power cut leaves
    check(5 <= len(lines) < len(expected) and not (output / "tradeoff.csv").exists(),
          f"killed after {len(lines)} of {len(expected)} settings (seed {seed})")
    changed = call(program, folder, "tradeoff", "small.prm", "--output", "killed", "--resume", *slow,
                   "--set", "Body/Length=2")
    check(changed.returncode == 2 and 'Body/Length was "1" and is "2"' in changed.stderr,
          f"other parameters are refused: {changed.stderr.strip()}")
    refused = call(program, folder, "tradeoff", "small.prm", "--output", "killed")
    check(refused.returncode == 2 and "not empty" in refused.stderr, "without --resume the folder is refused")
    done = call(program, folder, "tradeoff", "small.prm", "--output", "killed", "--resume", *slow,
                command=(mpirun, "--oversubscribe", "-n", "2"))
    check(done.returncode == 0 and "Resumed with" in done.stdout, f"resumed on two ranks {done.stderr}")
    rows = table(output)
    check(answers(rows) == expected and len(rows) == len(expected), "the same settings and errors as without a break")
    after = {int(row["index"]): row for row in rows}
    check(all(number(after[index]["seconds"]) == row["seconds"] for index, row in before.items()
              if row["seconds"] is not None), "what was measured before is kept")
    check_files(output)
    again = call(program, folder, "tradeoff", "small.prm", "--output", "killed", "--resume", *slow)
    check(again.returncode == 0 and "nothing is left to do" in again.stdout, "a finished study has nothing to resume")


def check_stop(program, folder, expected):
    """A signal, and the limit of time, end the study in order."""
    slow = ("--set", "Tradeoff/Repetitions=20")
    process = start(program, folder, "stopped", *slow)
    process.send_signal(signal.SIGTERM)
    _, errors = process.communicate(timeout=60)
    output = pathlib.Path(folder, "stopped")
    n, summary = len(table(output)), summary_of(output)
    check(process.returncode == 5 and summary["status"] == "stopped" and summary["reason"] == "signal"
          and "--resume goes on" in errors and 5 <= n < len(expected), f"stopped after {n} settings: {errors.strip()}")
    seconds = min(4.0, max(1.5, summary["seconds"] + 0.3))
    result = call(program, folder, "tradeoff", "small.prm", "--output", "stopped", "--resume", *slow, "--set",
                  f"Tradeoff/Time limit={seconds}")
    summary = summary_of(output)
    check(result.returncode == 5 and summary["reason"] == "time_limit" and n < summary["tried"] < len(expected)
          and set(answers(table(output)).items()) <= set(expected.items()), f"out of time after {summary['tried']}")
    other = pathlib.Path(folder, "other")
    other.mkdir()
    (other / "file").write_text("mine", encoding="utf-8")
    result = call(program, folder, "tradeoff", "small.prm", "--output", "other", "--resume")
    check(result.returncode == 2 and "no tradeoff that could be resumed" in result.stderr, "a strange folder is refused")


def main():
    """1 if any check failed."""
    if len(sys.argv) != 3:
        sys.exit("usage: tradeoff.py PATH_TO_CRAWLER MPIRUN")
    program, mpirun = str(pathlib.Path(sys.argv[1]).resolve()), sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        write_study(folder)
        all_answers = {}
        for ranks in (1, 2):
            command = [mpirun, "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
            result = call(program, folder, "tradeoff", "small.prm", "--output", f"on-{ranks}", command=command)
            check(result.returncode == 0 and not result.stderr, f"exit code {result.returncode} on {ranks} ranks "
                  f"{result.stderr}")
            output = pathlib.Path(folder, f"on-{ranks}")
            rows, summary = table(output), summary_of(output)
            all_answers[ranks] = answers(rows)
            check(summary["status"] == "finished" and summary["ranks"] == ranks
                  and len(summary["calibration_seconds"]["at_start"]) == ranks, f"summary of {summary['seconds']:.1f} s")
            check_files(output)
            check_rows(rows, summary)
            check_pareto(rows)
            check_hdf5(output, rows)
            if ranks == 1:
                check_advice(program, folder, output, result.stdout)
        check(all_answers[1] == all_answers[2], "the same settings and errors on 1 and 2 ranks")
        check_kill(program, folder, all_answers[1], mpirun)
        check_stop(program, folder, all_answers[1])
    print(f"{failures} checks failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
