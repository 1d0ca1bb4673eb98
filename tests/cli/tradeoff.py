#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler tradeoff on a small study: its files agree, nothing is lost or done twice, and its advice holds.

    python3 tradeoff.py PATH_TO_CRAWLER MPIRUN
"""
import math
import os
import pathlib
import re
import shutil
import signal
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import NO_PICTURES, call, checks, expect, on_ranks, prm, ranks_that_stop, refused, sets  # noqa: E402
from tables import csv_rows, h5_columns, number, same_as_csv, summary_of  # noqa: E402

BODY = prm("Active stress/Optimal wave/Perturbation parameter=0.4",
           "Active stress/Optimal wave/Choose wave by=wave speed")
STUDY = prm("Tradeoff/Integrators=radau 5, bdf", "Tradeoff/Degrees=2, 6", "Tradeoff/Cells=3, 8",
            "Tradeoff/Mesh tolerances=1e-3", "Tradeoff/Tolerances=logspace(-2, -8, 4)", "Tradeoff/Repetitions=1")
KEY = ("model", "formulation", "mesh", "engine", "integrator", "degree", "cells", "mesh tolerance", "tolerance")
DETERMINISTIC = ("status", "reason", "displacement", "error", "shown error", "below bar", "steps")
REFERENCE = 9.0072529800e-2  # doc/theory.md
PROGRAM, MPIRUN = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]


def study(output, *more, ranks=1, stop_at=None, picture=False):
    """The study, or the rest of it."""
    return call([*on_ranks(MPIRUN, ranks), PROGRAM, "tradeoff", "small.prm", "--output", output.name, *more], output.parent,
                stop_at, {} if picture else NO_PICTURES)


def table(folder):
    """The rows of tradeoff.csv that were tried."""
    return [row for row in csv_rows(folder / "tradeoff.csv") if row["status"]]


def answers(rows):
    """What must not depend on who computed it and when."""
    return {tuple(row[name] for name in KEY): tuple(row[name] for name in DETERMINISTIC) for row in rows}


def tried(summary):
    """How many settings have a row."""
    return summary["points"] - summary["statuses"].get("missing", 0)


def check_rows(rows, summary):
    """Every setting is one row, with cost and error or a reason."""
    expect(len(answers(rows)) == len(rows) == tried(summary) == summary["points"], f"{len(rows)} different settings")
    expect(len({row["index"] for row in rows}) == len(rows), "each with a number of its own")
    reference = summary["reference"]
    expect(abs(reference["displacement"] - REFERENCE) < 1e-11 and reference["relative_bar"] < 1e-10,
           f"reference {reference}")
    finished = [row for row in rows if row["status"] == "finished"]
    expect(all(math.isclose(number(row["error"]), abs(number(row["displacement"]) - reference["displacement"])
                            / reference["size"], rel_tol=1e-9, abs_tol=1e-16) for row in finished),
           "errors are distances to the reference")
    expect(all(number(row["shown error"]) == max(number(row["error"]), reference["relative_bar"]) and
               (row["below bar"] == "true") == (number(row["error"]) < reference["relative_bar"]) for row in finished),
           "errors are shown at the bar or above")
    expect(all(number(row["seconds"]) > 0 and number(row["memory"]) >= (row["model"] == "nonlinear")
               and number(row["repetitions"]) >= 1 and number(row["spread"]) >= 0 for row in finished), "all that finished have a cost")
    gaps = [row for row in rows if row["status"] != "finished"]
    expect(all(row["reason"] and row["message"] and not row["seconds"] for row in gaps),
           f"{len(gaps)} gaps have a reason, and no cost")
    rungs = {row["model"]: row for row in finished if row["model"] != "nonlinear"}
    expect(abs(number(rungs["perturbation"]["displacement"]) - 0.08) < 1e-12  # chi^2/2
           and abs(number(rungs["kinematic"]["displacement"]) - 9.372520e-2) < 1e-8, "the rungs are rows, too")
    finished = [row for row in finished if row["model"] == "nonlinear"]
    expect({row["engine"] for row in finished} == {"fused", "petsc", "batch"}
           and {row["mesh"] for row in finished} == {"uniform", "adaptive"}
           and {row["formulation"] for row in finished} == {"position", "stretch"}, "all ways have finished")


def check_hdf5(folder, rows):
    """The same numbers and texts in tradeoff.h5."""
    expect(same_as_csv(h5_columns(folder / "tradeoff.h5", "tradeoff"), rows), "tradeoff.h5 has what tradeoff.csv has")
    with h5py.File(folder / "tradeoff.h5") as file:
        group = file["tradeoff"]
        expect(group["seconds"].attrs["unit"] == b"s" and b"subsection Tradeoff" in group.attrs["parameters.prm"]
               and "version of PETSc" in group.attrs, "tradeoff.h5 knows units and where it comes from")


def check_files(folder):
    """The files of a study that is finished."""
    names = {path.name for path in folder.iterdir()}
    expect(names == {"original.prm", "parameters.prm", "log.txt", "tradeoff.csv", "tradeoff.h5", "tradeoff.png",
                     "tradeoff.svg", "summary.json", "recommendations.prm"}, f"files {sorted(names)}")
    expect((folder / "tradeoff.png").read_bytes()[:4] == b"\x89PNG" and "<svg" in (folder / "tradeoff.svg").read_text(),
           "pictures are pictures")


def check_advice(folder, output, screen):
    """Each recommendation, pasted into the file, reproduces its error."""
    summary = summary_of(output)
    advice = summary["recommendations"]
    expect([item["accuracy"] for item in advice] == [10.0**-k for k in range(2, 2 + len(advice))] and len(advice) >= 5,
           f"{len(advice)} recommendations")
    expect(all(re.search(rf"^For .*1e-{len(advice) + 1} use .*error", text, re.MULTILINE)
               for text in (screen, (output / "log.txt").read_text(encoding="utf-8"))), "on the screen and in log.txt")
    blocks = (output / "recommendations.prm").read_text(encoding="utf-8")
    for item in {item["setting"]: item for item in advice}.values():
        expect(item["prm"] in blocks, f"recommendations.prm has {item['setting']}")
        pathlib.Path(folder, "pasted.prm").write_text(BODY + item["prm"], encoding="utf-8")
        call([PROGRAM, "run", "pasted.prm", "--overwrite", "--quiet", "--set", "Output/Number of snapshots=0"], folder)
        run = summary_of(pathlib.Path(folder, "output-pasted"))
        error = abs(run["displacement"] - summary["reference"]["displacement"]) / summary["reference"]["size"]
        expect(run["status"] == "finished" and error <= item["accuracy"]
               and math.isclose(error, item["error"], rel_tol=1e-3, abs_tol=1e-12),
               f"pasted for {item['accuracy']:g}: error {error:.3e}, measured {item['error']:.3e}")


def written(folder):
    """The rows of tradeoff.h5 that were tried, by their numbers."""
    columns = h5_columns(folder / "tradeoff.h5", "tradeoff")
    rows = [dict(zip(columns, values)) for values in zip(*columns.values())]  # not a number is not equal to itself
    return {int(row["index"]): row for row in rows if row["status"]}


def check_crashes(output, whole):
    """A fault of the program at a setting is noted; one that crashed twice is a row that says so, and the rest goes on."""
    died = study(output, stop_at="row:3:SEGV")
    note = output / "crashes.txt"
    expect(died.returncode == -signal.SIGSEGV and int(note.read_text(encoding="utf-8")) in written(output)
           and len(written(output)) == 3, f"a crash at the third setting: {died}, {note.read_text(encoding='utf-8')}")
    missing = next(row["index"] for row in whole if row["status"] == "finished" and int(row["index"]) not in written(output))
    note.write_text(f"{missing}\n{missing}\n", encoding="utf-8")
    done = study(output, "--resume")
    rows = table(output)
    crashed = [row for row in rows if row["reason"] == "crashed"]
    expect(done.returncode == 0 and [row["index"] for row in crashed] == [missing] and "crashed twice" in crashed[0]["message"]
           and sum(row["status"] == "finished" for row in rows) > 50, f"a setting that crashed twice: {done}, {crashed}")


def check_reference(output):
    """A study that is stopped while its reference is made goes on; without a reference the summary says why; errors are relative
    to the displacement, also to a small one."""
    quick = ("--set", "Tradeoff/Models=kinematic")
    stopped = study(output, *quick, stop_at="step:1:TERM")
    summary = summary_of(output)
    expect(stopped.returncode == 5 and summary["status"] == "stopped" and summary["reference"] is None and not table(output),
           f"stopped in the reference: {stopped}")
    done = study(output, *quick, "--resume", picture=True)
    expect(done.returncode == 0 and len(table(output)) == summary["points"] and "nothing to recommend" in done.stdout,
           f"and goes on: {done}")
    inverts = study(output, *quick, "--overwrite", "--set", "Active stress/Optimal wave/Perturbation parameter=1.5")
    summary = summary_of(output)
    expect(inverts.returncode == 4 and summary["status"] == "inverted" and "inverted" in summary["message"]
           and summary["reference"] is None, f"a body that inverts: {inverts}, {summary}")
    page = call([PROGRAM, "report", output.name], output.parent)
    expect(page.returncode == 0, f"its page: {page}")
    late = study(output, *quick, "--overwrite", "--set", "Tradeoff/Time limit per run=1e-6")
    expect(late.returncode == 3 and "Time limit per run" in late.stderr, f"no time for a reference: {late}")
    small = study(output, *quick, "--overwrite", "--set", "Active stress/Optimal wave/Perturbation parameter=0.01")
    reference = summary_of(output)["reference"]
    expect(small.returncode == 0 and 0 < reference["displacement"] < 1e-4 and reference["size"] == reference["displacement"],
           f"a small displacement: {small.stderr}, {reference}")


def check_strides(folder):
    """Steps end where the last stride begins, as in a run: what is pasted has the same error to the last digit, whatever Model is."""
    few = ("Tradeoff/Models=nonlinear", "Tradeoff/Engines=fused", "Tradeoff/Meshes=uniform", "Tradeoff/Formulations=position",
           "Tradeoff/Integrators=radau 5", "Tradeoff/Degrees=4", "Tradeoff/Cells=4", "Tradeoff/Tolerances=1e-2", "Time/End time=3",
           "Model=auto")
    result = study(folder / "strides", *sets(few), picture=True)
    advice = summary_of(folder / "strides")["recommendations"][0]
    pathlib.Path(folder, "strides.prm").write_text(BODY + advice["prm"], encoding="utf-8")
    call([PROGRAM, "run", "strides.prm", "--quiet", "--output", "pasted", "--set", "Time/End time=3"], folder)
    run, row = summary_of(folder / "pasted"), table(folder / "strides")[0]
    expect(result.returncode == 0 and advice["prm"].startswith("set Model = nonlinear") and run["displacement"] == number(row["displacement"]),
           f"three strides: {run['displacement']}, {row}")


def check_stops(output, expected):
    """Kills of the only process and of one rank of two, signals and the limit of time lose nothing but what was under way.

    One study: each of them stops it again, and what was measured before is kept to the end.
    """
    killed = study(output, stop_at="row:5:KILL")
    lines = written(output)
    expect(killed.returncode == -signal.SIGKILL and 5 <= len(lines) < len(expected) and not (output / "tradeoff.csv").exists(),
           f"the only process is killed after {len(lines)} of {len(expected)} settings: {killed}")
    refused(study(output, "--resume", "--set", "Body/Length=2"), 'Body/Length was "1" and is "2"')
    refused(study(output), "not empty")
    for stop_at, reason, more in (("row:3:TERM", "signal", ()), ("step:1:INT", "signal", ()),
                                  (None, "time_limit", ("--set", "Tradeoff/Time limit=0.001"))):
        stopped = study(output, "--resume", *more, stop_at=stop_at)
        rows, summary = table(output), summary_of(output)
        expect(stopped.returncode == 5 and summary["status"] == "stopped" and summary["reason"] == reason
               and "--resume continues" in stopped.stderr and len(rows) == tried(summary) < len(expected)
               and len(rows) >= len(lines) + (3 if reason == "signal" else 0) and answers(rows).items() <= expected.items(),
               f"stopped by {stop_at}{more} after {len(rows)} settings: {stopped}")
    before = written(output)
    command = [PROGRAM, "tradeoff", "small.prm", "--output", output.name, "--resume"]
    # Rank 0 waits from its first row on, until mpirun ends it.
    killed = call(ranks_that_stop(MPIRUN, command, "row:1:STOP", "row:5:KILL"), output.parent)
    lines = written(output)
    expect(killed.returncode == 128 + signal.SIGKILL and len(lines) >= len(before) + 5
           and all(str(lines.get(index)) == str(row) for index, row in before.items()),
           f"rank 1 of two is killed after {len(lines)} settings, {len(before)} before: {killed}")
    done = study(output, "--resume", "--set", "Tradeoff/Time limit=1e6", ranks=2, picture=True)
    expect(done.returncode == 0 and "are already done" in done.stdout, f"resumed on two ranks {done.stderr}")
    rows = table(output)
    expect(answers(rows) == expected and len(rows) == len(expected), "the same settings and errors as without a break")
    after = {int(row["index"]): row for row in rows}
    expect(all(number(after[index]["seconds"]) == row["seconds"] for index, row in lines.items()
               if row["status"] == "finished"), "what was measured before is kept")
    check_files(output)
    again = study(output, "--resume")
    expect(again.returncode == 0 and table(output) == rows, "a finished study has nothing to resume")
    other = output.parent / "other"
    other.mkdir()
    (other / "file").write_text("mine", encoding="utf-8")
    refused(study(other, "--resume"), "no tradeoff that can be resumed")


def check_time_limit(output, expected):
    """Settings that took too long are tried again if they may take longer; without Python for the rest, crawler plot makes it."""
    study(output, stop_at="row:20:TERM")
    result = study(output, "--resume", "--set", "Tradeoff/Time limit per run=1e-6")
    late = [row for row in table(output) if row["reason"] == "time_limit"]
    expect(result.returncode == 0 and len(late) > 50 and all(row["time limit"] == "1e-06" and row["entries"] for row in late)
           and any("not tried" in row["message"] for row in late), f"settings that took too long: {result}, {late[:2]}")
    result = study(output, "--resume")
    expect(result.returncode == 0 and answers(table(output)) == expected, f"and may take longer: {result}")
    summary = summary_of(output)
    expect("advice" not in summary and not (output / "recommendations.prm").exists(), "without Python there is no advice yet")
    made = call([PROGRAM, "plot", output.name], output.parent)
    expect(made.returncode == 0 and {**summary_of(output), **summary} == summary_of(output) and (output / "recommendations.prm").exists()
           and len(summary_of(output)["advice"]) > 4, f"crawler plot makes it: {made}")


def check_lacking_python(output):
    """All rows are kept, and a sentence says what is missing."""
    (output.parent / "bin").mkdir()
    python = output.parent / "bin/python3"
    python.write_text("#!/bin/sh\necho it has no numpy >&2\nexit 69\n", encoding="utf-8")
    python.chmod(0o755)
    result = call([PROGRAM, "tradeoff", "small.prm", "--output", output.name, "--set", "Tradeoff/Models=kinematic"], output.parent, None,
                  {"PATH": f"{python.parent}:{os.environ['PATH']}"})
    expect(result.returncode == 0 and result.stdout.count("it has no numpy. Make them later with: crawler plot") == 1
           and len(table(output)) == summary_of(output)["points"] > 3, f"a Python that lacks something: {result}")


def check_refused(output):
    """Settings that crawler run refuses are not recommended: tolerances of the stretch form have a limit."""
    study(output, "--set", "Tradeoff/Models=nonlinear", "--set", "Tradeoff/Formulations=stretch", "--set", "Tradeoff/Meshes=uniform",
          "--set", "Tradeoff/Engines=fused", "--set", "Tradeoff/Integrators=radau 5", "--set", "Tradeoff/Cells=8", "--set",
          "Tradeoff/Tolerances=0.1, 1e-5")
    rows = table(output)
    expect([row["status"] for row in rows] == ["refused", "finished"] and "at most a thousandth" in rows[0]["message"], rows)


def check_old_folder(output, whole):
    """The table of another version is refused in a sentence."""
    shutil.copytree(whole, output)
    with h5py.File(output / "tradeoff.h5", "r+") as file:
        for data in file["tradeoff"].values():
            if data.attrs["name"] == b"entries":
                data.attrs["name"] = np.bytes_("pareto")
    refused(study(output, "--resume"), "another version of the program")


def main(folder):
    (folder / "small.prm").write_text(BODY + STUDY, encoding="utf-8")
    all_answers = {}
    for ranks in (1, 2):
        output = folder / f"on-{ranks}"
        result = study(output, ranks=ranks, picture=True)
        expect(result.returncode == 0 and not result.stderr, f"exit code {result.returncode} on {ranks} ranks "
               f"{result.stderr}")
        rows, summary = table(output), summary_of(output)
        all_answers[ranks] = answers(rows)
        expect(summary["status"] == "finished" and summary["ranks"] == ranks, f"summary {summary}")
        check_files(output)
        check_rows(rows, summary)
        check_hdf5(output, rows)
        if ranks == 1:
            check_advice(folder, output, result.stdout)
    expect(all_answers[1] == all_answers[2], "the same settings and errors on 1 and 2 ranks")
    check_reference(folder / "reference")
    check_strides(folder)
    check_crashes(folder / "crashed", table(folder / "on-1"))
    check_stops(folder / "stopped", all_answers[1])
    check_time_limit(folder / "late", all_answers[1])
    check_lacking_python(folder / "lacking")
    check_refused(folder / "refused")
    check_old_folder(folder / "old", folder / "on-1")


checks.run((main,))
