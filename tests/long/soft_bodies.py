#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Error bounds of soft bodies: random waves on bodies with K < 5e-3 at Accuracy 1e-4, automatic, against the position form
at 1e-7. No answer may be further away than its bound and that of the reference.

    python3 soft_bodies.py PATH_TO_CRAWLER MPIRUN NUMBER SEED
"""
import pathlib
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import Checks, call, on_ranks  # noqa: E402
from tables import h5_columns  # noqa: E402

SCENES = """
set Model = nonlinear
subsection Active stress
  set Generator = optimal wave
  subsection Optimal wave
    set Choose wave by = wave speed
  end
end
subsection Sweep
  set Design           = random
  set Number of points = NUMBER
  set Seed             = SEED
  set Axes             = Body/Elastic modulus : loguniform(3e-4, 5e-3); Body/Anchoring exponent : uniform(-2, 5); \\
    Active stress/Optimal wave/Perturbation parameter : uniform(0.1, 0.45); \\
    Active stress/Optimal wave/Wave speed : uniform(0.7, 1.3)
  set Time limit per point = 20
end
"""


def main():
    """Both sweeps, point by point."""
    program, mpirun, number, seed = pathlib.Path(sys.argv[1]).resolve(), *sys.argv[2:5]
    checks = Checks()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "soft.prm").write_text(SCENES.replace("NUMBER", number).replace("SEED", seed), encoding="utf-8")
        tables = {}
        for which, settings in (("answer", ("Accuracy=1e-4",)),
                                ("reference", ("Accuracy=1e-7", "Discretization/Formulation=position"))):
            more = [word for setting in settings for word in ("--set", setting)]
            result = call([*on_ranks(mpirun, 2), program, "sweep", "soft.prm", "--output", which, *more], folder)
            checks.expect(result.returncode == 0, f"sweep {which}: {result.stderr}")
            tables[which] = h5_columns(folder / which / "results.h5", "results")
        both = np.array([all(table["status"][i] == "finished" for table in tables.values()) for i in range(int(number))])
        checks.expect(np.count_nonzero(both) > 0.5 * int(number), f"only {np.count_nonzero(both)} points have both answers")
        difference = np.abs(tables["answer"]["displacement"] - tables["reference"]["displacement"])
        bound = sum(table["displacement_error.total"] for table in tables.values())
        ratio = difference / bound
        for i in np.flatnonzero(both & ~(ratio <= 1.)):
            checks.expect(False, f"point {i} of seed {seed}: {ratio[i]:.3g} bounds away")
        print(f"{np.count_nonzero(both)} of {number} compared; bound over error: median {np.median(1. / ratio[both]):.3g}, "
              f"least {np.min(1. / ratio[both]):.3g}")
    checks.end()


if __name__ == "__main__":
    main()
