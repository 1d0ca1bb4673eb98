#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The answer does not depend on the number of ranks, nor does the way a run fails.

    python3 same_answer.py PATH_TO_CRAWLER MPIRUN
"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect, on_ranks, sets  # noqa: E402

TOLERANCE = 1e-10  # relative
SAME = ("displacement", "stress_power", "dissipation", "elastic_energy", "paper_energy", "positive_power")
PLACES = ("min_stretch", "max_stretch")

# Coarse in time, so few steps: communication is slow where there are fewer processors than ranks.
SHARED = {"Discretization/Share cells": "yes"}
WAVE = {**SHARED, "Active stress/Optimal wave/Choose wave by": "wave speed", "Active stress/Optimal wave/Wave speed": 1,
        "Active stress/Optimal wave/Perturbation parameter": 0.4, "Discretization/Number of cells": 8,
        "Time/Tolerance": 1e-6, "Output/Number of snapshots": 2}
FORMULA = {**SHARED, "Active stress/Generator": "expression", "Body/Anchoring exponent": 1.5,
           "Active stress/Expression/Active stress": "0.3*(1-cos(2*pi*t))*sin(pi*(s-t))^2",
           "Discretization/Number of cells": 3, "Time/Tolerance": 1e-6, "Output/Number of snapshots": 2}
INVERTS = {**WAVE, "Body/Anchoring exponent": 0, "Active stress/Optimal wave/Wave speed": -1,
           "Active stress/Optimal wave/Perturbation parameter": 0.6}
BAD_VALUE = {**WAVE, "Body/Length": -1}
UNKNOWN = {**WAVE, "Body/Lenght": 1}
INCONSISTENT = {**WAVE, "Active stress/Optimal wave/Wave speed": 0}  # found while the scene is built



def run(program, mpirun, folder, ranks, scene):
    """Runs the scene; returns exit code, summary (None if there is none) and the lines of the program's messages."""
    file, output = pathlib.Path(folder, "scene.prm"), pathlib.Path(folder, "output")
    file.write_text("set Model = nonlinear\n")
    command = [*on_ranks(mpirun, ranks), program, "run", file, "--quiet", "--overwrite", "--output", output, *sets(scene)]
    summary = output / "summary.json"
    summary.unlink(missing_ok=True)
    done = call(command)
    messages = [line for line in (done.stdout + done.stderr).splitlines() if line.startswith("crawler: ")]
    return done.returncode, json.loads(summary.read_text()) if summary.exists() else None, messages


def same_answer(name, scene, ranks, *where):
    """The summary of the scene on one rank and on others."""
    code, one, _ = run(*where, 1, scene)
    expect(code == 0, f"{name}: exit code {code} on 1 rank")
    for n in ranks if code == 0 else ():
        code, many, _ = run(*where, n, scene)
        if code != 0 or many is None:
            expect(False, f"{name}: exit code {code} on {n} ranks")
            continue
        errors = {key: abs(many[key] - one[key]) / max(abs(one[key]), 1e-3 * abs(one["stress_power"])) for key in SAME}
        for key in PLACES:
            errors[key] = abs(many[key]["value"] - one[key]["value"])
        worst = max(errors, key=errors.get)
        expect(many["ranks"] == n and many["degrees_of_freedom"] == one["degrees_of_freedom"]
               and many["cells_shared"] == (scene["Discretization/Share cells"] == "yes")
               and all(error <= TOLERANCE for error in errors.values()),
               f"{name}: {n} ranks, {many['steps']} steps ({one['steps']} on one), "
               f"largest difference {errors[worst]:.1e} in {worst}")


def main(folder):
    where = (sys.argv[1], sys.argv[2], folder)
    same_answer("Fig. S1, chi = 0.4", WAVE, (2, 3), *where)
    same_answer("the whole body on each rank", {**WAVE, "Discretization/Share cells": "no"}, (2,), *where)
    same_answer("formula, 3 cells", FORMULA, (2, 3), *where)
    same_answer("one cell", {**FORMULA, "Discretization/Number of cells": 1}, (2,), *where)

    ends = []
    for ranks in (1, 2):
        code, summary, messages = run(*where, ranks, INVERTS)
        expect(code == 4 and len(messages) <= 1, f"inversion: exit code {code} on {ranks} ranks, message {messages}")
        expect(summary is not None and summary["status"] == "inverted" and summary["inversion"] is not None,
               f"inversion: summary.json of {ranks} ranks says so")
        ends.append((summary or {}).get("inversion"))
    if None not in ends:
        expect(all(abs(ends[0][key] - ends[1][key]) <= 1e-6 for key in ("s", "t")),
               f"inversion at the same place: {ends}")

    bad = {"value out of range": BAD_VALUE, "unknown entry": UNKNOWN, "impossible wave": INCONSISTENT}
    for name, scene in bad.items():
        code, _, messages = run(*where, 2, scene)
        expect(code == 2 and len(messages) == 1, f"{name}: exit code {code} on 2 ranks, messages {messages}")


checks.run((main,))
