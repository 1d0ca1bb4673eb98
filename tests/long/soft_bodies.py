#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Error bounds of soft bodies: random waves on bodies with K < 5e-3 at Accuracy 1e-4, automatic, against the position form
at 1e-7. No answer may be further away than its bound and that of the reference. Files of an answer that the position form
gives in place of the stretch form show this answer.

    python3 soft_bodies.py PATH_TO_CRAWLER MPIRUN NUMBER SEED
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect, on_ranks, prm, sets  # noqa: E402
from tables import h5_columns, json_of  # noqa: E402

BLOCK = 50  # points of a sweep
SCENES = prm("Model=nonlinear", "Active stress/Generator=optimal wave",
             "Active stress/Optimal wave/Choose wave by=wave speed", "Sweep/Design=random",
             "Sweep/Number of points=NUMBER", "Sweep/Seed=SEED",
             "Sweep/Axes=Body/Elastic modulus : loguniform(3e-4, 5e-3); Body/Anchoring exponent : uniform(-2, 5); "
             "Active stress/Optimal wave/Perturbation parameter : uniform(0.1, 0.45); "
             "Active stress/Optimal wave/Wave speed : uniform(0.7, 1.3)",
             "Sweep/Time limit per point=20")
OTHER_FORM = prm("Model=nonlinear", "Accuracy=2e-8", "Body/Elastic modulus=1e-3", "Body/Anchoring exponent=4.5",
                 "Active stress/Generator=optimal wave", "Active stress/Optimal wave/Choose wave by=wave speed",
                 "Active stress/Optimal wave/Wave speed=1.3", "Active stress/Optimal wave/Perturbation parameter=0.25")


def check_files(program, folder):
    """The last row of the statistics is the answer, whose form is that of its summary."""
    (folder / "other.prm").write_text(OTHER_FORM, encoding="utf-8")
    result = call([program, "run", "other.prm", "--output", "other"], folder)
    summary = json_of(folder / "other" / "summary.json")
    last = np.genfromtxt(folder / "other" / "statistics.csv", delimiter=",", skip_header=1)[-1]
    expect(result.returncode == 0 and summary["formulation"] == "position" and last[0] > 100
           and abs(last[3] - summary["displacement"]) <= summary["displacement_error"]["total"],
           f"files of the other form: {result.stderr}, {summary['displacement']}, {last}")


def ratios_of_block(program, mpirun, folder, seed):
    """Both sweeps of a block of points: differences over bounds where there are both answers."""
    (folder / "soft.prm").write_text(SCENES.replace("NUMBER", str(BLOCK)).replace("SEED", seed), encoding="utf-8")
    tables = []
    for which, settings in (("answer", ("Accuracy=1e-4",)), ("reference", ("Accuracy=1e-7", "Discretization/Formulation=position"))):
        result = call([*on_ranks(mpirun, 2), program, "sweep", "soft.prm", "--overwrite", "--output", which, *sets(settings)], folder)
        expect(result.returncode == 0, f"sweep {which}: {result.stderr}")
        tables.append(h5_columns(folder / which / "results.h5", "results"))
    both = np.array([all(table["status"][i] == "finished" for table in tables) for i in range(BLOCK)])
    difference = np.abs(tables[0]["displacement"] - tables[1]["displacement"])
    ratio = difference / sum(table["displacement_error.total"] for table in tables)
    for i in np.flatnonzero(both & ~(ratio <= 1.)):
        expect(False, f"point {i} of seed {seed}: {ratio[i]:.3g} bounds away")
    return ratio[both]


def main(folder):
    program, mpirun, number, seed = pathlib.Path(sys.argv[1]).resolve(), *sys.argv[2:5]
    check_files(program, folder)
    ratios = []
    for block in range(0, int(number), BLOCK):
        ratios.extend(ratios_of_block(program, mpirun, folder, str(1000 * int(seed) + block // BLOCK)))
    expect(len(ratios) > 0.5 * int(number), f"only {len(ratios)} points have both answers")
    print(f"{len(ratios)} of {number} compared; bound over error: median {1. / np.median(ratios):.3g}, "
          f"least {1. / np.max(ratios):.3g}")


checks.run((main,))
