#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs that are stopped or killed go on with --resume and leave the same files as those that were never disturbed.

    python3 resume_run.py PATH_TO_CRAWLER MPIEXEC_COMMAND [alone|several]

Each kind of run is killed once; tests/long/run_kills.py kills them at many random places.
"""
import pathlib
import random
import signal
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import Paused, checks, environment, expect  # noqa: E402
from run_scenes import SCENES, STATES, Scene  # noqa: E402

CRAWLER, TWO_RANKS = sys.argv[1], [sys.argv[2], "--oversubscribe", "-n", "2"]
# Where each kind of run is killed one time after the other: with its first state behind it, and in its pilot runs if it
# has some. How often it then goes on from a state.
PLACES = {name: (["write:000003.vtu:KILL"], 1) for name in SCENES}
PLACES["feedback"] = PLACES["delay"] = (["write:000002.vtu:KILL"], 1)
PLACES["adaptive"] = (["pilot:20:KILL", "write:000003.vtu:KILL"], 1)
PLACES["second try"] = (["write:000003.vtu:2:KILL", "write:000006.vtu:KILL", "write:kymograph.vts:KILL"], 3)
PLACES["xdmf"] = (["step:200:KILL"], 1)
PLACES["lanes"] = (["write:original.prm:KILL", "write:parameters.prm:KILL",  # from the first picture on with a state
                    "state:1:KILL", "write:restart.dat.new:KILL", "write:restart.dat:KILL", "write:000001.vtu:KILL",
                    "write:restart.dat.new:KILL", "write:restart.dat:KILL", "write:000006.vtu:KILL",
                    "write:kymograph.vts:KILL", "write:summary.json:KILL"], 9)
NEVER = ["--set", "Time/Checkpoint interval=1e6"]


def killed(scene):
    """The run is killed at one place after the other, resumed each time, and then left alone."""
    places, n_states = PLACES[scene.name]
    resume = []
    for place in places:
        scene.expect("killed", [*STATES, *resume], -signal.SIGKILL, stop_at=place)
        resume = ["--resume"]
    scene.expect("killed", [*STATES, "--resume"], 0)
    expect(scene.went_on("killed") == n_states, f"{scene.name}: {scene.went_on('killed')} times from a state after {places}")
    scene.compare("killed", f"killed at {places}")


def signals_in_pilots(scene):
    for how in ("TERM", "INT", "USR1"):
        scene.expect("pilots", [], 5, "nothing was written", stop_at=f"pilot:20:{how}")
        expect(not (scene.place / "pilots").exists(), f"{how} in the pilots: there are files")


def signals(scene, in_try=""):
    """In the run, or the try with this number: exit code 5, a state, and it goes on. In what follows it: the same."""
    resume = []
    for place in (f"write:000002.vtu:{in_try}TERM", "write:000004.vtu:INT", "write:000006.vtu:USR1", "write:kymograph.vts:TERM"):
        scene.expect("stopped", [*NEVER, *resume], 5, "signal", stop_at=place)
        expect((scene.place / "stopped" / "restart.dat").exists(), f"{place}: no state was written")
        resume = ["--resume"]
    scene.expect("stopped", [*NEVER, "--resume"], 0)
    expect(scene.went_on("stopped") == 4, f"after signals {scene.went_on('stopped')} times from a state")
    scene.compare("stopped", "signals")


def time_limits(scene):
    """A limit that is over at once stops in order, also what goes on from a state; one that is never over, never."""
    at_once, never = (["--set", f"Time/Wall time limit={limit}"] for limit in ("0.001", "1e6"))
    scene.expect("limited", at_once, 5, "Time/Wall time limit")
    scene.expect("limited", [*NEVER, *never], 5, stop_at="write:000003.vtu:TERM")
    state = (scene.place / "limited" / "restart.dat").read_bytes()
    scene.expect("limited", [*at_once, "--resume"], 5, "Time/Wall time limit")
    expect((scene.place / "limited" / "restart.dat").read_bytes() == state, "a time limit: the state is another one")
    scene.expect("limited", [*never, "--resume"], 0)
    expect(scene.went_on("limited") == 1, f"time limits: {scene.went_on('limited')} times from a state")
    scene.compare("limited", "time limits")


def stop_file(scene):
    """Who makes the file stop in the folder stops the run."""
    folder = scene.place / "asked"
    with Paused(scene.command("asked", ["--set", "Time/End time=1e5"]), "write:000000.vtu:STOP") as run:
        (folder / "stop").touch()
        done = run.go_on()
    expect(done.returncode == 5 and "stop_file" in done.stderr, f"a stop file: {done.returncode}, {done.stderr!r}")
    expect((folder / "restart.dat").exists(), "a stop file: no state was written")


def damaged(scene):
    """Damaged states are named and the older one, or none, is taken."""
    chance = random.Random(7)
    scene.expect("harmed", STATES, -signal.SIGKILL, stop_at="write:000001.vtu:KILL")
    scene.expect("harmed", [*STATES, "--resume"], -signal.SIGKILL, stop_at="write:000006.vtu:KILL")
    for names, cut in ((["restart.dat"], False), (["restart.dat"], True), (["restart.dat", "restart.old.dat"], True)):
        scene.copy("harmed", "copy")
        for name in names:
            file = scene.place / "copy" / name
            content = bytearray(file.read_bytes())
            content[chance.randrange(len(content))] ^= 1 << chance.randrange(8)
            file.write_bytes(content[:len(content) // 2] if cut and name == "restart.dat" else content)
        scene.expect("copy", [*STATES, "--resume"], 0, *names)
        expect(scene.went_on("copy") == (2 if len(names) == 1 else 0),
               f"damaged {names}: {scene.went_on('copy')} times from a state")
        scene.compare("copy", f"damaged {names}")


def other_parameters(scene):
    """They are refused in one line; a file that is lost is named."""
    for change, words in [("Accuracy=1e-6", "Accuracy was"), ("Time/End time=4000", "Time/End time was")]:
        done = scene.expect("harmed", ["--resume", "--set", change], 2, words)
        expect(done.stderr.count("\n") == 1, f"{change}: {done.stderr!r}")
    scene.expect("harmed", ["--resume", "--overwrite"], 2)
    scene.copy("harmed", "lost")
    (scene.place / "lost" / "statistics.csv").unlink()
    scene.expect("lost", ["--resume"], 6, "statistics.csv")


def ends(scene):
    """What is complete is not computed again."""
    summary = scene.place / "whole" / "summary.json"
    before = summary.read_bytes()
    scene.expect("whole", ["--resume"], 0)
    expect(summary.read_bytes() == before, "a complete run is computed again")


def folders(scene):
    """Where there is nothing to go on with."""
    scene.expect("new", ["--resume"], 0)
    foreign = scene.place / "foreign"
    foreign.mkdir()
    (foreign / "letter.txt").write_text("dear")
    scene.expect("foreign", ["--resume"], 2, "no run")
    expect((foreign / "letter.txt").read_text() == "dear", "a foreign file was changed")


def one_rank(place):
    """All kinds of runs."""
    scenes = {one: Scene(CRAWLER, place / one.replace(" ", "_"), one) for one in SCENES}
    for scene in scenes.values():
        killed(scene)
    signals_in_pilots(scenes["adaptive"])
    signals(scenes["second try"], "2:")
    for part in (signals, time_limits, stop_file, damaged, other_parameters, ends, folders):
        part(scenes["lanes"])


def two_ranks(place):
    """One of them writes what both compute, or they share the cells. One that is killed ends the other, too."""
    lanes = Scene(CRAWLER, place / "two_lanes", "lanes")
    shared = Scene(CRAWLER, place / "shared", "petsc", ["Discretization/Share cells=yes"], TWO_RANKS)
    lanes.before = TWO_RANKS
    for scene, place_of_signal in ((lanes, "step:150:USR1"), (shared, "write:000003.vtu:USR1:0")):
        scene.expect("two", STATES, 5, "signal", stop_at=place_of_signal)
        done = scene.run("two", [*STATES, "--resume"], "write:000009.vtu:KILL:0")
        expect(done.returncode not in (0, 2, 5), f"{scene.name}, two ranks, one killed: exit code {done.returncode}")
        scene.expect("two", [*STATES, "--resume"], 0)
        expect(scene.went_on("two") == 2, f"{scene.name}, two ranks: {scene.went_on('two')} times from a state")
        scene.compare("two", "two ranks")
    # mpirun hands SIGUSR1 on to a run that has begun and does not end by itself.
    command = [str(word) for word in lanes.command("handed", ["--set", "Time/End time=1e6"]) if word != "--quiet"]
    with subprocess.Popen(command, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        begun = any("cells" in line for line in process.stdout)
        process.send_signal(signal.SIGUSR1)
        _, errors = process.communicate()
    expect(begun and process.returncode == 5 and "signal" in errors and (lanes.place / "handed" / "restart.dat").exists(),
           f"SIGUSR1 to mpirun: exit code {process.returncode}, {errors[:500]!r}")


checks.run((one_rank,), (two_ranks,))
