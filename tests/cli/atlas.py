#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler atlas on a tiny map: its files agree with each other, on one rank and on more, and with crawler run.

    python3 atlas.py PATH_TO_CRAWLER MPIRUN
"""
import csv
import json
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

import h5py

CHI, P = "Active stress/Optimal wave/Perturbation parameter", "Body/Anchoring exponent"
RUNS = ("run", "position", "stretch", "refined")
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1",
                   OPENBLAS_NUM_THREADS="1")
SCENE = """
set Accuracy = 1e-3
subsection Active stress
  subsection Optimal wave
    set Choose wave by = wave speed
  end
end
subsection Atlas
  set First axis  = Active stress/Optimal wave/Perturbation parameter : 0.1, 0.2, 0.3
  set Second axis = Body/Anchoring exponent : linspace(0, 2, 2)
end
"""
failures = 0


def check(condition, what):
    """Prints what was checked and counts failures."""
    global failures
    failures += not condition
    print(f"{'ok    ' if condition else 'FAILED'} {what}", flush=True)


def call(program, folder, *arguments, command=()):
    """Runs the program in the folder, with the scene in scene.prm."""
    pathlib.Path(folder, "scene.prm").write_text(SCENE, encoding="utf-8")
    return subprocess.run([*command, program, *arguments], cwd=folder, env=ENVIRONMENT, capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=300, check=False)


def table(folder):
    """The rows of atlas.csv."""
    with open(folder / "atlas.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def number(text):
    """What is not known is empty in CSV and not a number in HDF5."""
    return float(text) if text else math.nan


def same(a, b):
    """Numbers that are equal, or both not known."""
    return a == b or (math.isnan(a) and math.isnan(b))


def check_rows(rows):
    """What is known about the six points."""
    check([(row[CHI], row[P]) for row in rows] == [(chi, p) for chi in ("0.1", "0.2", "0.3") for p in ("0", "2")],
          "six points in their order")
    outcomes = {row["outcome"] for row in rows}
    check(outcomes == {"finished"}, f"outcomes {outcomes}")
    check(all(row["verdict"] == "agree" for row in rows), "all answers agree")
    theory = {"0": -1, "2": 1}  # -a chi^2/2
    # The stretch form is tried for a < 0, p > 1.
    runs = {"0": [run for run in RUNS if run != "stretch"], "2": RUNS}
    check(not any(row["stretch status"] for row in rows if row[P] == "0"), "no stretch form where a >= 0")
    check(all(abs(number(row[f"{run} displacement"]) / (theory[row[P]] * float(row[CHI]) ** 2 / 2) - 1) < 0.25
              for row in rows for run in runs[row[P]]), "small displacements are those of the theory")
    check(all(0 <= number(row[f"{run} measured error"]) <= number(row[f"{run} promised error"])
              + number(row["refined promised error"]) for row in rows for run in runs[row[P]] if run != "refined"),
          "measured errors are below the promised ones")


def check_hdf5(folder, rows):
    """The same numbers and texts in atlas.h5."""
    with h5py.File(folder / "atlas.h5") as file:
        group = file["atlas"]
        names = {bytes(dataset.attrs["name"]).decode(): dataset for dataset in group.values()}
        check(set(names) == set(rows[0]), "the columns of atlas.h5 are those of atlas.csv")
        good = True
        for name, dataset in names.items():
            if h5py.check_string_dtype(dataset.dtype):
                good &= list(dataset.asstr()[:]) == [row[name] for row in rows]
            else:
                good &= all(same(a, number(row[name])) for a, row in zip(dataset[:], rows))
        check(good, "the values of atlas.h5 are those of atlas.csv")
        check(group["run displacement"].attrs["unit"] == b"length" and group["Body.Anchoring exponent"].shape == (6,)
              and b"subsection Atlas" in group.attrs["parameters.prm"] and "version of PETSc" in group.attrs,
              "atlas.h5 knows units and where it comes from")


def check_files(folder, ranks):
    """The files of a whole atlas."""
    names = {path.name for path in folder.iterdir()}
    check(names == {"original.prm", "parameters.prm", "log.txt", "atlas.csv", "atlas.h5", "atlas.png", "atlas.svg",
                    "summary.json"}, f"files {sorted(names)}")
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    check(summary["status"] == "finished" and summary["points"] == summary["computed"] == 6
          and summary["finished"] == 6 and summary["inverted"] == 0 and summary["silent_wrong_answers"] == 0
          and summary["ranks"] == ranks and 0 < summary["largest_error_ratio"] <= 1, f"summary.json {summary}")
    check((folder / "atlas.png").read_bytes()[:4] == b"\x89PNG" and "<svg" in (folder / "atlas.svg").read_text(),
          "pictures are pictures")


def check_refused(program, folder):
    """A scene that makes no sense is a row, and a formulation that the user chose is the only one."""
    result = call(program, folder, "atlas", "scene.prm", "--quiet", "--set", "Discretization/Formulation=position",
                  "--set", "Active stress/Optimal wave/Choose wave by=energy",
                  "--set", "Atlas/First axis=Active stress/Optimal wave/Energy : 0.4, 0.5",
                  "--set", "Atlas/Second axis=Discretization/Number of cells : 4, 8")
    rows = table(pathlib.Path(folder, "output-scene"))
    check(result.returncode == 0 and not result.stdout and not result.stderr, "quiet is quiet")
    check([row["outcome"] for row in rows] == ["refused"] * 2 + ["finished"] * 2
          and "no wave spends the energy" in rows[0]["explanation"], "an inadmissible scene is a row with its reason")
    check(not any(row["position status"] + row["stretch status"] for row in rows), "only one form if one is set")
    check(rows[2]["verdict"] == "unchecked" and not rows[2]["run promised error"], "no promise where cells are set")


def check_inverted(program, folder):
    """Ends of stretch 1 - 2 t/k invert at t = k/2."""
    result = call(program, folder, "atlas", "scene.prm", "--overwrite", "--set", "Active stress/Generator=expression",
                  "--set", "Active stress/Expression/Active stress=2*t",
                  "--set", "Atlas/First axis=Body/Elastic modulus : 1, 4",
                  "--set", f"Atlas/Second axis={P} : 0, 1")
    rows = table(pathlib.Path(folder, "output-scene"))
    check(result.returncode == 0 and [row["outcome"] for row in rows] == ["inverted at end"] * 2 + ["finished"] * 2,
          f"outcomes {[row['outcome'] for row in rows]}")
    check(all(abs(number(row["run inversion t"]) - 0.5) < 1e-3 and row["verdict"] == "agree"
              and not row["run displacement"] for row in rows[:2]), "the ends invert at t = k/2, and all runs say so")


def columns(folder):
    """All columns of atlas.h5 but for times."""
    with h5py.File(folder / "atlas.h5", "r") as file:
        return {name: list(data.asstr()[:]) if data.dtype.kind == "S" else list(map(float.hex, data[:]))
                for name, data in file["atlas"].items() if not name.endswith(" seconds")}


def computed(folder):
    """How many points have a row, of an atlas that may be writing."""
    try:
        return sum(outcome != "" for outcome in columns(folder)["outcome"])
    except (OSError, KeyError):
        return 0


LONG = ["--set", f"Atlas/First axis={CHI} : linspace(0.1, 0.3, 60)"]


def start(program, folder, output, *more, command=()):
    """An atlas of 120 points that goes on in the background."""
    pathlib.Path(folder, "scene.prm").write_text(SCENE, encoding="utf-8")
    return subprocess.Popen([*command, program, "atlas", "scene.prm", "--output", output, *LONG, *more], cwd=folder,
                            env=ENVIRONMENT, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE)


def wait_for_rows(process, folder, n):
    """Until so many points have a row, or the atlas has ended."""
    end = time.time() + 60
    while process.poll() is None and computed(folder) < n and time.time() < end:
        time.sleep(0.02)


def check_interrupted(program, mpirun, folder):
    """SIGTERM, and kill -9 at some moments: what is computed is kept, and --resume makes the rest, bit for bit."""
    whole = call(program, folder, "atlas", "scene.prm", "--output", "whole", *LONG)
    check(whole.returncode == 0, f"an atlas of 120 points: {whole.stderr}")
    reference, output = columns(pathlib.Path(folder, "whole")), pathlib.Path(folder, "stopped")
    with start(program, folder, "stopped") as process:
        wait_for_rows(process, output, 8)
        process.send_signal(signal.SIGTERM)
        _, errors = process.communicate(timeout=60)
    summary = json.loads((output / "summary.json").read_text(encoding="utf-8"))
    rows = table(output)
    check(process.returncode == 5 and "stopped by a signal" in errors and "--resume" in errors
          and summary["status"] == "stopped" and len(rows) == 120
          and 0 < sum(row["outcome"] != "" for row in rows) == summary["computed"] < 120,
          f"stopped after {summary['computed']} points: {errors.strip()}")
    n_before, n_kills = summary["computed"], 0
    for n, ranks in ((24, 1), (48, 2), (72, 2)):
        command = [mpirun, "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
        with start(program, folder, "stopped", "--resume", command=command) as process:
            wait_for_rows(process, output, n)
            n_kills += process.poll() is None
            for child in subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True,
                                        check=False).stdout.split():
                os.kill(int(child), signal.SIGKILL)
            process.kill()
            process.communicate()
        time.sleep(1)  # orphans of mpirun end by themselves
        now = computed(output)
        check(now >= n_before, f"{now} rows outlive kill -9")
        n_before = now
    check(n_kills >= 2, f"{n_kills} were killed under way")
    changed = call(program, folder, "atlas", "scene.prm", "--output", "stopped", "--resume", *LONG, "--set",
                   "Body/Length=2")
    check(changed.returncode == 2 and "Body/Length" in changed.stderr, f"other inputs are refused: {changed.stderr.strip()}")
    last = call(program, folder, "atlas", "scene.prm", "--output", "stopped", "--resume", *LONG)
    check(last.returncode == 0 and columns(output) == reference and not (output / "study.lock").exists(),
          f"the table is that of an atlas in one go {last.stderr}")
    other = call(program, folder, "atlas", "scene.prm", "--output", "stopped", "--overwrite")
    check(other.returncode == 0 and len(table(output)) == 6, "the next atlas replaces it")


def main():
    """1 if any check failed."""
    if len(sys.argv) != 3:
        sys.exit("usage: atlas.py PATH_TO_CRAWLER MPIRUN")
    program, mpirun = str(pathlib.Path(sys.argv[1]).resolve()), sys.argv[2]
    results = {}
    for ranks in (1, 3, 8):  # the last: more ranks than points
        with tempfile.TemporaryDirectory() as folder:
            command = [mpirun, "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
            result = call(program, folder, "atlas", "scene.prm", "--output", "map", command=command)
            check(result.returncode == 0 and not result.stderr, f"exit code {result.returncode} on {ranks} ranks "
                  f"{result.stderr}")
            paragraph = re.search(r"6 points, 6 finished, 0 inverted.* 0 disagree", result.stdout)
            check(paragraph is not None, f"the paragraph on the screen: {result.stdout.splitlines()[-2]}")
            output = pathlib.Path(folder, "map")
            check_files(output, ranks)
            rows = table(output)
            check_rows(rows)
            check_hdf5(output, rows)
            results[ranks] = [{name: value for name, value in row.items() if not name.endswith(" seconds")}
                              for row in rows]
    check(results[1] == results[3] == results[8], "the same table on 1, 3 and 8 ranks")

    with tempfile.TemporaryDirectory() as folder:
        call(program, folder, "run", "scene.prm", "--output", "single", "--set", f"{CHI}=0.2", "--set", f"{P}=2",
             "--set", "Output/Number of snapshots=0")
        single = json.loads(pathlib.Path(folder, "single", "summary.json").read_text(encoding="utf-8"))
        # The lanes of a batch and a run alone add up in another order.
        check(math.isclose(single["displacement"], number(results[1][3]["run displacement"]), rel_tol=1e-13)
              and str(single["steps"]) == results[1][3]["run steps"], "crawler run gives the same answer")
        check_refused(program, folder)
        check_inverted(program, folder)
        check_interrupted(program, mpirun, folder)
    print(f"{failures} checks failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
