#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs that are killed at many random places and go on with --resume leave the same files as undisturbed ones.

    python3 run_kills.py PATH_TO_CRAWLER MPIEXEC_COMMAND [KILLS [SEED [SCENE...]]]

KILLS: so many in each scene (default: 20); then a tenth as many, by signals, on two ranks. tests/cli/resume_run.py is the
short version. Some 10 minutes.
"""
import pathlib
import random
import shutil
import signal
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import Places, checks, expect  # noqa: E402
from run_scenes import SCENES, STATES, Scene  # noqa: E402

FILES = ("restart.dat", "restart.dat.new", "000003.vtu", "line_000007.vtu", "grip_000005.vtu", "kymograph.vts",
         "parameters.prm", "summary.json")


def disturb(scene, n, chance, how="KILL"):
    """The run is stopped n times at random places, resumed each time, and then left alone. How often it went on."""
    places = Places(chance, ("step", "step", "write"), FILES, {"step": 1 << 14, "restart.dat": 64, "restart.dat.new": 64})
    hits, resumed, folder = 0, 0, scene.place / "disturbed"
    shutil.rmtree(folder, ignore_errors=True)
    ends = {"KILL": -signal.SIGKILL}.get(how, 5)
    for _ in range(20 * n):
        if hits == n:
            break
        what, place = places.next()
        resume = ["--resume"] if folder.exists() else []
        done = scene.run("disturbed", [*STATES, *resume], f"{place}:{how}")
        hits += done.returncode == ends
        if done.returncode == 0:
            places.too_late(what)
            scene.compare("disturbed", f"behind {place}")
            resumed += scene.went_on("disturbed")
            shutil.rmtree(folder)
        else:
            expect(done.returncode == ends, f"{scene.name}, {place}:{how}: {done.returncode}, {done.stderr[:300]!r}")
    scene.expect("disturbed", [*STATES, "--resume"], 0)
    scene.compare("disturbed", f"after the last {how}")
    expect(hits == n, f"{scene.name}: only {hits} of {n} places were reached")
    return hits, resumed + scene.went_on("disturbed")


def main(place):
    n, seed = (int(word) if word else default for word, default in zip((sys.argv[3:5] + ["", ""])[:2], (20, 1)))
    names, chance = sys.argv[5:] or list(SCENES), random.Random(seed)
    print(f"seed {seed}", flush=True)
    resumed = 0
    for one in names:
        scene = Scene(sys.argv[1], place / one.replace(" ", "_"), one, is_long=True)
        numbers = disturb(scene, n, chance)
        resumed += numbers[1]
        print(f"{one}: {numbers[0]} kills, {numbers[1]} times on from a state", flush=True)
    expect(resumed > 0, "no run went on from a state")
    for one, more in (("lanes", []), ("petsc", ["Discretization/Share cells=yes"])):
        if one in names:
            scene = Scene(sys.argv[1], place / f"two_{one}", one, more, [sys.argv[2], "--oversubscribe", "-n", "2"])
            print(f"two ranks, {one}: stopped, and on from a state", *disturb(scene, max(1, n // 10), chance, "USR1"),
                  flush=True)


checks.run((main,))
