#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs that are stopped or killed go on with --resume and leave the same files as those that were never disturbed.

    python3 resume_run.py PATH_TO_CRAWLER KILLS MPIEXEC_COMMAND

KILLS: so many kills at random moments. With SCENES=lanes,petsc in the environment only these.
"""
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

CRAWLER, KILLS = sys.argv[1], int(sys.argv[2])
TWO_RANKS = [sys.argv[3], "--oversubscribe", "-n", "2"]
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
WAVE = """
set Accuracy = 1e-7
subsection Body
  set Anchoring exponent = 2
end
subsection Active stress
  set Generator = expression
  subsection Expression
    set Active stress = 0.15*sin(2*pi*(s+t))
  end
end
subsection Time
  set End time = 20
end
subsection Output
  set Number of snapshots = 10
end
"""
SEGMENTS = """
set Accuracy = 1e-4
subsection Active stress
  set Generator = segments
  subsection Segments
    set Number of segments = 8
    set Amplitude          = 0.1
    set Phase lag          = 0.125
  end
end
subsection Output
  set Number of snapshots = 10
end
"""
FEEDBACK = """
set Accuracy = 1e-4
subsection Body
  set Elastic modulus = 0.1
  set Initial stretch = 1+0.01*exp(-((s-0.425)/0.05)^2)
end
subsection Active stress
  set Generator = strain feedback
  subsection Strain feedback
    set Active stress = A*tanh(g*(w_%s-1)/A)
    set Constants     = A=0.05, g=0.5
    %s
  end
end
subsection Time
  set End time = %s
end
subsection Output
  set Number of snapshots = 5
end
"""
FINE = ["Discretization/Number of cells=40", "Time/Tolerance=1e-8", "Time/Integrator=radau 9"]
# What a run can be: a scene, and entries that are set.
SCENES = {
    "lanes": (WAVE, [*FINE, "Time/End time=1000"]),
    "jumps": (SEGMENTS, [*FINE[1:], "Discretization/Number of cells=24", "Time/End time=60"]),
    "petsc": (WAVE, [*FINE, "Time/Engine=petsc", "Time/End time=150"]),
    "bdf": (WAVE, ["Time/Integrator=bdf", "Time/End time=800", "Accuracy=1e-4"]),
    "linear": (WAVE, ["Body/Anchoring exponent=1", "Model=linear", "Time/End time=3000"]),
    "stretch form": (WAVE, ["Discretization/Formulation=stretch", "Time/End time=200", "Accuracy=1e-5"]),
    "adaptive": (WAVE, ["Discretization/Mesh=adaptive", "Time/End time=200", "Accuracy=1e-5"]),
    "feedback": (FEEDBACK % ("near", "set Distance = -0.25\n    set Sensor length = 0.2", "3"), []),
    "delay": (FEEDBACK % ("delayed", "set Delay = 0.3", "1"), ["Discretization/Number of cells=8", "Accuracy=1e-3"]),
    "xdmf": (WAVE, [*FINE, "Output/Snapshot format=xdmf", "Time/End time=600"]),
    "finer mesh of the user": (WAVE, ["Discretization/Number of cells=12", "Time/Tolerance=1e-9",
                                        "Time/Integrator=radau 5"]),
}
GOES_ON = "goes on from the state"
# Multistep methods start anew, so their results differ by the error of the steps.
STARTS_ANEW = {"bdf"}
failures = []


def expect(condition, what):
    """Notes what is wrong."""
    if not condition:
        failures.append(what)


class Scene:
    """A scene in a folder of its own, with the files of an undisturbed run."""

    def __init__(self, place, name, extra=()):
        text, entries = SCENES[name]
        self.name, self.place = name, place
        self.file = place / "scene.prm"
        place.mkdir()
        self.file.write_text(text)
        self.entries = [*entries, *extra]
        begin = time.monotonic()
        done = self.run("whole", [])
        self.seconds = time.monotonic() - begin
        expect(done.returncode == 0, f"{name}: exit code {done.returncode}, {done.stderr[:300]!r}")

    def command(self, folder, options, before=()):
        """Its words."""
        sets = [word for entry in self.entries for word in ("--set", entry)]
        return [*before, CRAWLER, "run", str(self.file), "--output", str(self.place / folder), "--quiet", *sets,
                *options]

    def run(self, folder, options, before=()):
        """The finished process."""
        return subprocess.run(self.command(folder, options, before), env=ENVIRONMENT, capture_output=True, text=True,
                              timeout=300, check=False)

    def killed(self, folder, options, seconds, how=signal.SIGKILL, before=()):
        """The exit code of a run that is killed if it lasts so long; negative if it was."""
        with subprocess.Popen(self.command(folder, options, before), env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as process:
            try:
                return process.wait(seconds)
            except subprocess.TimeoutExpired:
                process.send_signal(how)
                return process.wait(120)

    def compare(self, folder, other="whole"):
        """All files of two folders, but for times and what tells one run from another."""
        one, two = self.place / folder, self.place / other
        if self.name in STARTS_ANEW:
            ends = [json.loads((place / "summary.json").read_text()) for place in (one, two)]
            expect(abs(ends[0]["displacement"] - ends[1]["displacement"]) <= ends[1]["displacement_error"]["total"],
                   f"{self.name}: the displacement is another one after a resume")
            return
        own = {"log.txt", "restart.dat", "restart.old.dat", "original.prm", "parameters.prm"}
        names = [{str(file.relative_to(place)) for file in place.rglob("*") if file.is_file()} - own
                 for place in (one, two)]
        expect(names[0] == names[1], f"{self.name}: other files after a resume: {sorted(names[0] ^ names[1])[:5]}")
        for name in sorted(names[0] & names[1]):
            if name == "summary.json":
                same = plain(json.loads((one / name).read_text())) == plain(json.loads((two / name).read_text()))
            elif name.endswith(".h5"):
                same = same_data(one / name, two / name)
            else:
                same = (one / name).read_bytes() == (two / name).read_bytes()
            expect(same, f"{self.name}: {name} of {folder} is another one than that of {other}")


def plain(summary):
    """Without times, the command and the number of ranks."""
    return {key: value for key, value in summary.items() if key not in ("seconds", "command_line", "versions", "ranks")}


def log_of(folder):
    """Its text."""
    return (folder / "log.txt").read_text()


def same_data(one, two):
    """Are all numbers of two HDF5 files the same?"""
    with h5py.File(one) as first, h5py.File(two) as second:
        names = []
        first.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
        return all(name in second and np.array_equal(first[name][()], second[name][()], equal_nan=True)
                   for name in names)


def kills(scene, n, chance, interval="0.02", how=signal.SIGKILL, before=()):
    """The run is killed at n random moments, resumed each time, and then left alone. Returns how often that hit, and how
    often the run went on from a state."""
    options = ["--set", f"Time/Checkpoint interval={interval}"]
    folder, hits, resumed = "killed", 0, 0
    shutil.rmtree(scene.place / folder, ignore_errors=True)
    for i in range(n):
        code = scene.killed(folder, [*options, *(["--resume"] if i > 0 else [])],
                            chance.uniform(0.2, 0.9) * scene.seconds, how, before)
        hits += code not in (0, 2)
        if code == 0:
            scene.compare(folder)
            resumed += log_of(scene.place / folder).count(GOES_ON)
            shutil.rmtree(scene.place / folder)
    done = scene.run(folder, [*options, "--resume"], before)
    expect(done.returncode == 0, f"{scene.name}: exit code {done.returncode} after kills, {done.stderr[:300]!r}")
    scene.compare(folder)
    return hits, resumed + log_of(scene.place / folder).count(GOES_ON)


def stops(scene):
    """By a signal, by the wall time and by a file: exit code 5, a state, and two resumes in sequence."""
    options = ["--set", "Time/Checkpoint interval=1000"]
    for how in (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1):
        shutil.rmtree(scene.place / "stopped", ignore_errors=True)
        resume = []
        for _ in range(2):
            code = scene.killed("stopped", [*options, *resume], 0.5 * scene.seconds, how)
            expect(code in (0, 5), f"{scene.name}: exit code {code} after {how.name}")
            resume = ["--resume"]
        expect(scene.run("stopped", [*options, *resume]).returncode == 0, f"{scene.name}: resumed after {how.name}")
        scene.compare("stopped")
    shutil.rmtree(scene.place / "stopped")
    for part in (0.4, 0.1, 0.03):  # the machine may have been busier when the run was timed
        shutil.rmtree(scene.place / "stopped", ignore_errors=True)
        limit = ["--set", f"Time/Wall time limit={part * scene.seconds + 0.1}"]
        codes = [scene.run("stopped", limit).returncode]
        if codes[0] != 0:
            break
    reason = json.loads((scene.place / "stopped" / "summary.json").read_text())["reason"]
    while codes[-1] == 5 and len(codes) < 40:
        codes.append(scene.run("stopped", [*limit, "--resume"]).returncode)
    expect(len(codes) > 1 and codes[-1] == 0 and reason == "time_limit", f"{scene.name}: time limits end with {codes}")
    scene.compare("stopped")


def stop_file(scene):
    """Who makes the file stop in the folder stops the run."""
    folder = scene.place / "asked"
    slow = ["--set", "Time/End time=20000"]
    with subprocess.Popen(scene.command("asked", slow), env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True) as process:
        for _ in range(600):
            if (folder / "statistics.csv").exists():
                break
            time.sleep(0.05)
        (folder / "stop").touch()
        words = process.communicate(timeout=60)[1]
    expect(process.returncode == 5 and "stop_file" in words, f"a stop file: {process.returncode}, {words!r}")
    expect((folder / "restart.dat").exists(), "a stop file: no state was written")


def harm(scene, chance):
    """Damaged states are named and the older one, or none, is taken; other parameters are refused."""
    options = ["--set", "Time/Checkpoint interval=0.02"]
    for _ in range(20):
        shutil.rmtree(scene.place / "harmed", ignore_errors=True)
        scene.killed("harmed", options, chance.uniform(0.3, 0.5) * scene.seconds)
        if (scene.place / "harmed" / "restart.old.dat").exists():
            break
    expect((scene.place / "harmed" / "restart.old.dat").exists(), "no two states to be damaged")
    for names in (["restart.dat"], ["restart.dat", "restart.old.dat"]):
        for cut in (False, True):
            folder = scene.place / "copy"
            shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(scene.place / "harmed", folder)
            for name in names:
                content = bytearray((folder / name).read_bytes())
                content[chance.randrange(len(content))] ^= 1 << chance.randrange(8)
                (folder / name).write_bytes(content[:len(content) // 2] if cut else content)
            done = scene.run("copy", [*options, "--resume"])
            expect(done.returncode == 0 and all(name in done.stderr for name in names),
                   f"damaged {names}: {done.returncode}, {done.stderr!r}")
            scene.compare("copy")
    for change, words in [("Accuracy=1e-6", "Accuracy was"), ("Time/End time=1", "larger one is expected"),
                          ("Time/End time=4000", "has not come to its end")]:
        done = scene.run("harmed", ["--resume", "--set", change])
        expect(done.returncode == 2 and words in done.stderr and done.stderr.count("\n") == 1,
               f"resumed with {change}: {done.returncode}, {done.stderr!r}")
    done = scene.run("harmed", ["--resume", "--overwrite"])
    expect(done.returncode == 2, f"--resume with --overwrite: {done.returncode}")
    slow = ["--set", "Time/End time=20000", "--set", "Time/Wall time limit=1"]
    done = scene.run("lost", slow)
    expect(done.returncode == 5, f"a time limit: {done.returncode}")
    (scene.place / "lost" / "statistics.csv").unlink()
    done = scene.run("lost", [*slow, "--resume"])
    expect(done.returncode == 6 and "statistics.csv" in done.stderr, f"lost statistics: {done.returncode}, {done.stderr!r}")


def ends(scene):
    """What is complete is not computed again; a later end time prolongs it."""
    summary = scene.place / "whole" / "summary.json"
    before = summary.read_bytes()
    done = scene.run("whole", ["--resume"])
    expect(done.returncode == 0 and summary.read_bytes() == before, "a complete run is computed again")
    options = ["--set", "Time/Checkpoint interval=0"]
    expect(scene.run("longer", options).returncode == 0, "the run that is to be prolonged")
    rows = (scene.place / "longer" / "statistics.csv").read_text()
    longer = ["--set", "Time/End time=1200"]
    done = scene.run("longer", [*options, *longer, "--resume"])
    expect(done.returncode == 0, f"prolonged: {done.returncode}, {done.stderr!r}")
    expect((scene.place / "longer" / "statistics.csv").read_text().startswith(rows), "prolonged: earlier rows are lost")
    expect(scene.run("direct", longer).returncode == 0, "the long run itself")
    one, two = (json.loads((scene.place / name / "summary.json").read_text()) for name in ("longer", "direct"))
    expect(abs(one["displacement"] - two["displacement"]) <= one["displacement_error"]["total"] +
           two["displacement_error"]["total"], f"prolonged: {one['displacement']}, but {two['displacement']} at once")
    expect(one["end_time"] == 1200, "prolonged: another end time")
    for name in ("min_stretch", "max_stretch"):
        expect(abs(one[name]["value"] - two[name]["value"]) < 1e-5, f"prolonged: {one[name]}, but {two[name]} at once")
    for name in ("stress_power", "dissipation"):
        expect(abs(one[name] / two[name] - 1.) < 1e-6, f"prolonged: {name} {one[name]}, but {two[name]} at once")
    times = np.genfromtxt(scene.place / "longer" / "statistics.csv", delimiter=",", skip_header=1)[:, 1]
    expect(np.all(np.diff(times) > 0.) and times[-1] == 1200., "prolonged: times of the statistics do not ascend")


def folders(scene):
    """Where there is nothing to go on with."""
    done = scene.run("new", ["--resume"])
    expect(done.returncode == 0, f"--resume of nothing: {done.returncode}, {done.stderr!r}")
    foreign = scene.place / "foreign"
    foreign.mkdir()
    (foreign / "letter.txt").write_text("dear")
    done = scene.run("foreign", ["--resume"])
    expect(done.returncode == 2 and "no run" in done.stderr, f"a foreign folder: {done.returncode}, {done.stderr!r}")
    expect((foreign / "letter.txt").read_text() == "dear", "a foreign file was changed")


def two_ranks(place, scenes, chance):
    """One of them writes what both compute, or they share the cells; mpirun hands SIGUSR1 on to them."""
    for name, entry in [("lanes", None), ("petsc", "Discretization/Share cells=yes")]:
        if name not in scenes:
            continue
        scene = scenes[name]
        if entry:
            scene = Scene(place / "shared", name, [entry])
            shutil.rmtree(scene.place / "whole")
            expect(scene.run("whole", [], TWO_RANKS).returncode == 0, f"{name}: two ranks")
        number = kills(scene, 3, chance, how=signal.SIGUSR1, before=TWO_RANKS)
        print(f"two ranks, {name}: stopped and resumed", *number)


def main():
    """All of it."""
    chance = random.Random(7)
    only = os.environ.get("SCENES", "").split(",") if os.environ.get("SCENES") else list(SCENES)
    with tempfile.TemporaryDirectory() as name:
        place = pathlib.Path(name)
        scenes = {one: Scene(place / one.replace(" ", "_"), one) for one in only}
        hits = {one: kills(scene, max(1, KILLS // len(scenes)), chance) for one, scene in scenes.items()}
        print("kills that hit a run, and resumes from a state:",
              *(f"{one} {number[0]}, {number[1]} ({scenes[one].seconds:.2f} s);" for one, number in hits.items()),
              f"in all {sum(one for one, _ in hits.values())}, {sum(one for _, one in hits.values())}")
        expect(any(one for _, one in hits.values()), "no run went on from a state")
        if "lanes" in scenes:
            for part in (stops, ends, folders, stop_file):
                part(scenes["lanes"])
            harm(scenes["lanes"], chance)
        two_ranks(place, scenes, chance)
    sys.exit("\n".join(failures) or 0)


if __name__ == "__main__":
    main()
