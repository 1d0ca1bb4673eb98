#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler atlas on a tiny map: its files agree with each other, on one rank and on more, and with crawler run.

    python3 atlas.py PATH_TO_CRAWLER MPIRUN
"""
import math
import pathlib
import re
import shutil
import signal
import sys
import tempfile

import h5py

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import NO_PICTURES, Checks, call, on_ranks, ranks_that_stop  # noqa: E402
from tables import csv_rows, h5_columns, json_of, number, same_as_csv, same_columns  # noqa: E402

CHI, P = "Active stress/Optimal wave/Perturbation parameter", "Body/Anchoring exponent"
RUNS = ("run", "position", "stretch", "refined")
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
PROGRAM, MPIRUN = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
checks = Checks()
check = checks.expect


def atlas(output, *more, ranks=1, stop_at=None, picture=False):
    """The atlas of the scene."""
    return call([*on_ranks(MPIRUN, ranks), PROGRAM, "atlas", "scene.prm", "--output", output.name, *more], output.parent,
                stop_at, {} if picture else NO_PICTURES)


def table(folder):
    """The rows of atlas.csv."""
    return csv_rows(folder / "atlas.csv")


def columns(folder):
    """All columns of atlas.h5."""
    return h5_columns(folder / "atlas.h5", "atlas")


def computed(folder):
    """Which points have a row."""
    return [i for i, outcome in enumerate(columns(folder)["outcome"]) if outcome != ""]


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
    check(same_as_csv(columns(folder), rows), "atlas.h5 has what atlas.csv has")
    with h5py.File(folder / "atlas.h5") as file:
        group = file["atlas"]
        check(group["run displacement"].attrs["unit"] == b"length" and group["Body.Anchoring exponent"].shape == (6,)
              and b"subsection Atlas" in group.attrs["parameters.prm"] and "version of PETSc" in group.attrs,
              "atlas.h5 knows units and where it comes from")


def check_files(folder, ranks):
    """The files of a whole atlas."""
    names = {path.name for path in folder.iterdir()}
    check(names == {"original.prm", "parameters.prm", "log.txt", "atlas.csv", "atlas.h5", "atlas.png", "atlas.svg",
                    "summary.json"}, f"files {sorted(names)}")
    summary = json_of(folder / "summary.json")
    check(summary["status"] == "finished" and summary["points"] == summary["computed"] == 6
          and summary["finished"] == 6 and summary["inverted"] == 0 and summary["silent_wrong_answers"] == 0
          and summary["ranks"] == ranks and 0 < summary["largest_error_ratio"] <= 1, f"summary.json {summary}")
    check((folder / "atlas.png").read_bytes()[:4] == b"\x89PNG" and "<svg" in (folder / "atlas.svg").read_text(),
          "pictures are pictures")


def check_refused(folder):
    """A scene that makes no sense is a row, and a formulation that the user chose is the only one."""
    result = atlas(folder / "refused", "--quiet", "--set", "Discretization/Formulation=position",
                   "--set", "Active stress/Optimal wave/Choose wave by=energy",
                   "--set", "Atlas/First axis=Active stress/Optimal wave/Energy : 0.4, 0.5",
                   "--set", "Atlas/Second axis=Discretization/Number of cells : 4, 8")
    rows = table(folder / "refused")
    check(result.returncode == 0 and not result.stdout and not result.stderr, f"quiet is quiet {result}")
    check([row["outcome"] for row in rows] == ["refused"] * 2 + ["finished"] * 2
          and "no wave spends the energy" in rows[0]["explanation"], "an inadmissible scene is a row with its reason")
    check(not any(row["position status"] + row["stretch status"] for row in rows), "only one form if one is set")
    check(rows[2]["verdict"] == "unchecked" and not rows[2]["run promised error"], "no promise where cells are set")


def check_inverted(folder):
    """Ends of stretch 1 - 2 t/k invert at t = k/2."""
    result = atlas(folder / "inverted", "--set", "Active stress/Generator=expression",
                   "--set", "Active stress/Expression/Active stress=2*t",
                   "--set", "Atlas/First axis=Body/Elastic modulus : 1, 4",
                   "--set", f"Atlas/Second axis={P} : 0, 1")
    rows = table(folder / "inverted")
    check(result.returncode == 0 and [row["outcome"] for row in rows] == ["inverted at end"] * 2 + ["finished"] * 2,
          f"outcomes {[row['outcome'] for row in rows]}")
    check(all(abs(number(row["run inversion t"]) - 0.5) < 1e-3 and row["verdict"] == "agree"
              and not row["run displacement"] for row in rows[:2]), "the ends invert at t = k/2, and all runs say so")


def check_crashes(folder):
    """A fault of the program at every point of two: each is tried once more, alone, and given up by name if that crashes."""
    two = ("--set", f"Atlas/First axis={CHI} : 0.2", "--set", f"Atlas/Second axis={P} : 2, 3")
    for i in range(3):
        died = atlas(folder / "crashed", *two, *(["--resume"] if i > 0 else []), stop_at="step:5:SEGV")
        check(died.returncode == -signal.SIGSEGV, f"crash {i}: {died}")
    notes = (folder / "crashed" / "crashes.txt").read_text(encoding="utf-8").split()
    last = atlas(folder / "crashed", "--resume", *two)
    rows = table(folder / "crashed")
    check(last.returncode == 0 and sorted(notes[:2]) == ["0", "1"]
          and [row["outcome"] for row in rows] == ["failed: crashed" if i == int(notes[2]) else "finished" for i in range(2)]
          and "crashed twice" in rows[int(notes[2])]["explanation"], f"crashes at {notes}: {rows} {last.stderr}")


def check_stops(folder):
    """SIGTERM and kill -9 at some rows: what is computed is kept, and --resume makes the rest, bit for bit."""
    n, long = 24, ("--set", f"Atlas/First axis={CHI} : linspace(0.1, 0.3, 12)")
    whole = atlas(folder / "whole", *long)
    reference, output = columns(folder / "whole"), folder / "stopped"
    check(whole.returncode == 0 and len(computed(folder / "whole")) == n, f"an atlas of {n} points: {whole.stderr}")
    stopped = atlas(output, *long, stop_at="row:4:TERM")
    summary, rows = json_of(output / "summary.json"), table(output)
    check(stopped.returncode == 5 and "stopped by a signal" in stopped.stderr and "--resume" in stopped.stderr
          and summary["status"] == "stopped" and len(rows) == n
          and 4 <= sum(row["outcome"] != "" for row in rows) == summary["computed"] < n,
          f"stopped after {summary['computed']} points: {stopped}")
    command = [PROGRAM, "atlas", "scene.prm", "--output", output.name, "--resume", *long]
    # Rank 0 waits from its first row on, until mpirun ends it: it may make more rows in its last moments.
    for what, words, stop_at, code in (
            ("the only process", command, "row:4:KILL", -signal.SIGKILL),
            ("rank 1 of two", ranks_that_stop(MPIRUN, command, "row:1:STOP", "row:4:KILL"), None, 128 + signal.SIGKILL)):
        before, times = computed(output), columns(output)["run seconds"]
        killed = call(words, folder, stop_at)
        after, done = columns(output), computed(output)
        check(killed.returncode == code and len(done) >= len(before) + 4 and (output / "study.lock").exists()
              and all(after["run seconds"][i] == times[i] for i in before), f"{what} killed: {killed}")
        again = folder / f"again after {what}"
        shutil.copytree(output, again)
        last = atlas(again, "--resume", *long)
        rest = columns(again)
        check(last.returncode == 0 and same_columns(rest, reference) and not (again / "study.lock").exists()
              and all(rest["run seconds"][i] == after["run seconds"][i] for i in done),
              f"{what} killed: the table is that of an atlas in one go {last.stderr}")
    changed = atlas(output, "--resume", *long, "--set", "Body/Length=2")
    check(changed.returncode == 2 and "Body/Length" in changed.stderr, f"other inputs are refused: {changed.stderr}")
    other = atlas(output, "--overwrite")
    check(other.returncode == 0 and len(table(output)) == 6, "the next atlas replaces it")


def main():
    """All checks in a folder of their own."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "scene.prm").write_text(SCENE, encoding="utf-8")
        results = {}
        for ranks in (1, 4):
            output = folder / f"on-{ranks}"
            result = atlas(output, ranks=ranks, picture=True)
            check(result.returncode == 0 and not result.stderr, f"exit code {result.returncode} on {ranks} ranks "
                  f"{result.stderr}")
            check(re.search(r"6 points, 6 finished, 0 inverted.* 0 disagree", result.stdout) is not None,
                  f"the paragraph on the screen: {result.stdout}")
            check_files(output, ranks)
            rows = table(output)
            check_rows(rows)
            check_hdf5(output, rows)
            results[ranks] = columns(output)
        check(same_columns(results[1], results[4]), "the same table on 1 and 4 ranks")
        few = atlas(folder / "few", "--set", f"Atlas/First axis={CHI} : 0.2, 0.3", "--set", f"Atlas/Second axis={P} : 2",
                    ranks=4)
        of_these = {name: column[3::2] for name, column in results[1].items()}
        check(few.returncode == 0 and same_columns(columns(folder / "few"), of_these, but=("seconds", "index")),
              f"more ranks than points: the same rows {few.stderr}")

        call([PROGRAM, "run", "scene.prm", "--output", "single", "--set", f"{CHI}=0.2", "--set", f"{P}=2",
              "--set", "Output/Number of snapshots=0"], folder)
        single = json_of(folder / "single" / "summary.json")
        # The lanes of a batch and a run alone add up in another order.
        check(math.isclose(single["displacement"], results[1]["run displacement"][3], rel_tol=1e-13)
              and single["steps"] == results[1]["run steps"][3], "crawler run gives the same answer")
        check_refused(folder)
        check_inverted(folder)
        check_crashes(folder)
        check_stops(folder)
    checks.end()


if __name__ == "__main__":
    main()
