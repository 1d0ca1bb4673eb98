# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs that are disturbed and go on with --resume: the possible scenes of a run, and whether its files are those of an
undisturbed run.
"""
import shutil

from program import call, expect, prm, sets
from tables import answer_in, json_of

WAVE = prm("Accuracy=1e-7", "Body/Anchoring exponent=2", "Active stress/Generator=expression",
           "Active stress/Expression/Active stress=0.15*sin(2*pi*(s+t))", "Output/Number of snapshots=10")
SEGMENTS = prm("Accuracy=1e-4", "Active stress/Generator=segments", "Active stress/Segments/Number of segments=8",
               "Active stress/Segments/Amplitude=0.1", "Active stress/Segments/Phase lag=0.125",
               "Output/Number of snapshots=10")
PULSE = prm("Accuracy=1e-8", "Body/Anchoring exponent=2", "Active stress/Generator=pulse", "Active stress/Pulse/Shape=compact",
            "Active stress/Pulse/Amplitude=0.6", "Active stress/Pulse/Width=0.3", "Active stress/Pulse/Speed=1.6",
            "Active stress/Pulse/Repetition period=1", "Output/Number of snapshots=10")
REFLEX = "Active stress/Strain feedback/"
FEEDBACK = ["Accuracy=1e-4", "Body/Elastic modulus=0.1", "Body/Initial stretch=1+0.01*exp(-((s-0.425)/0.05)^2)",
            "Active stress/Generator=strain feedback", REFLEX + "Constants=A=0.05, g=0.5", "Output/Number of snapshots=5"]
FINE = ["Discretization/Number of cells=40", "Time/Tolerance=1e-8", "Time/Integrator=radau 9"]
COARSE = ["Discretization/Number of cells=12", *FINE[1:]]
# Scenes of a run, with entries, the end time among them, for a long and for a short run.
SCENES = {
    "lanes": (WAVE, [*FINE, "Time/End time=1000"], [*COARSE, "Time/End time=20"]),
    "jumps": (SEGMENTS, [*FINE[1:], "Discretization/Number of cells=24", "Time/End time=60"],
              ["Time/Tolerance=1e-6", "Time/Integrator=radau 5", "Discretization/Number of cells=8", "Time/End time=2"]),
    "petsc": (WAVE, [*FINE, "Time/Engine=petsc", "Time/End time=150"], [*COARSE, "Time/Engine=petsc", "Time/End time=5"]),
    "bdf": (WAVE, ["Time/Integrator=bdf", "Time/End time=800", "Accuracy=1e-4"],
            ["Time/Integrator=bdf", "Time/End time=20", "Accuracy=1e-4"]),
    "linear": (WAVE, ["Body/Anchoring exponent=1", "Model=linear", "Time/End time=3000"],
               ["Body/Anchoring exponent=1", "Model=linear", "Time/End time=20"]),
    "stretch form": (WAVE, ["Discretization/Formulation=stretch", "Time/End time=200", "Accuracy=1e-5"],
                     ["Discretization/Formulation=stretch", "Time/End time=10", "Accuracy=1e-4"]),
    "adaptive": (WAVE, ["Discretization/Mesh=adaptive", "Time/End time=200", "Accuracy=1e-5"],
                 ["Discretization/Mesh=adaptive", "Time/End time=10", "Accuracy=1e-4"]),
    "feedback": (prm(*FEEDBACK, REFLEX + "Active stress=A*tanh(g*(w_near-1)/A)", REFLEX + "Distance=-0.25",
                     REFLEX + "Sensor length=0.2"), ["Time/End time=3"], ["Time/End time=1", "Accuracy=1e-3"]),
    "delay": (prm(*FEEDBACK, REFLEX + "Active stress=A*tanh(g*(w_delayed-1)/A)", REFLEX + "Delay=0.3"),
              ["Discretization/Number of cells=8", "Accuracy=1e-3", "Time/End time=1"],
              ["Discretization/Number of cells=4", "Accuracy=1e-3", "Time/End time=1"]),
    "xdmf": (WAVE, [*FINE, "Output/Snapshot format=xdmf", "Time/End time=600"],
             [*COARSE, "Output/Snapshot format=xdmf", "Time/End time=10"]),
    "second try": (PULSE, ["Time/End time=5"], ["Time/End time=5"]),
    "finer mesh of the user": (WAVE, ["Discretization/Number of cells=12", "Time/Tolerance=1e-9", "Time/Integrator=radau 5",
                                      "Time/End time=20"],
                               ["Discretization/Number of cells=12", "Time/Tolerance=1e-8", "Time/Integrator=radau 5",
                                "Time/End time=5"]),
}
GOES_ON = "resumes from the state"
STATES = ["--set", "Time/Checkpoint interval=0"]  # written as often as possible, the first at once
# Multistep methods start anew, so their results differ by the error of the steps.
STARTS_ANEW = {"bdf"}


class Scene:
    """Scene in a folder of its own, with the files of an undisturbed run in "whole"."""

    def __init__(self, program, place, name, extra=(), before=(), is_long=False):
        text, long, short = SCENES[name]
        self.program, self.place, self.name, self.before = program, place, name, before
        self.file = place / "scene.prm"
        self.entries = [*(long if is_long else short), *extra]
        place.mkdir()
        self.file.write_text(text, encoding="utf-8")
        self.expect("whole", [], 0)

    def command(self, folder, options=()):
        """Words of the command."""
        return [*self.before, self.program, "run", self.file, "--output", self.place / folder, "--quiet", *sets(self.entries), *options]

    def run(self, folder, options=(), stop_at=None):
        """Runs the command; returns the finished process."""
        return call(self.command(folder, options), stop_at=stop_at)

    def expect(self, folder, options, code, *words, stop_at=None):
        """Runs it and expects this end and these words."""
        done = self.run(folder, options, stop_at)
        expect(done.returncode == code and all(word in done.stderr for word in words),
               f"{self.name}, {options}, stopped at {stop_at}: exit code {done.returncode}, {done.stderr[:500]!r}")
        return done

    def copy(self, folder, other):
        shutil.rmtree(self.place / other, ignore_errors=True)
        shutil.copytree(self.place / folder, self.place / other)

    def went_on(self, folder):
        """Number of times this run went on from a state."""
        log = self.place / folder / "log.txt"
        return log.read_text(encoding="utf-8").count(GOES_ON) if log.exists() else 0

    def compare(self, folder, what):
        """Compares all files with those of the undisturbed run, except times and identifiers of a run."""
        one, two = self.place / folder, self.place / "whole"
        if self.name in STARTS_ANEW:
            ends = [json_of(place / "summary.json") for place in (one, two)]
            expect(abs(ends[0]["displacement"] - ends[1]["displacement"]) <= ends[1]["displacement_error"]["total"],
                   f"{self.name}, {what}: the displacement is another one after a resume")
            return
        ours, others = (answer_in(place, "log.txt", "restart.dat", "restart.old.dat", "original.prm", "parameters.prm") for place in (one, two))
        expect(ours.keys() == others.keys() and "summary.json" in ours,
               f"{self.name}, {what}: other files after a resume: {sorted(ours.keys() ^ others.keys())[:5]}")
        for name in ours.keys() & others.keys():
            expect(ours[name] == others[name], f"{self.name}, {what}: {name} is another one")
