# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every entry of the parameter file changes something, or a note says that it has no effect.

Each declared entry is set to another value in a scene that is paired with it here: a file of the answer is another one
then, and there is no note. In every sixth of these scenes all entries that a note names are set together: nothing
changes. With the argument "all" that is done in all of them, and each entry is tried in each: it must do one of both.

    python3 entry_effects.py PATH_TO_CRAWLER FOLDER_OF_THE_PACKAGE FOLDER_OF_THE_SOURCE [all]
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import warnings

PROGRAM, PACKAGE, SOURCE = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:4])
sys.path[:0] = [PACKAGE, str(pathlib.Path(__file__).resolve().parents[1] / "support")]
import crawler  # noqa: E402
from program import NO_PICTURES, call, checks, expect, warnings_of  # noqa: E402
from tables import answer_in  # noqa: E402

FILES = pathlib.Path(tempfile.mkdtemp())
# What a run says of itself, not of the crawler.
NO_ANSWER = ("log.txt", ".prm", ".png")

M, D, T, OUT = "Active stress/", "Discretization/", "Time/", "Output/"
BODY, GROUND = "Body/", "Ground/"
OPTIMAL, TRAVEL, STAND, PULSE, SEGMENTS, FORMULA, STRAIN, TWO, LIBRARY, FEEDBACK, TABLE, MODES = (
    M + name + "/" for name in ("Optimal wave", "Travelling wave", "Standing wave", "Pulse", "Segments", "Expression",
                                "Prescribed strain", "Two-level wave", "Library", "Strain feedback", "Table", "Modes"))
SUM = M + "Sum/Term 1/"


def write_files():
    """Tables along the body, along the ground, over body and time, and a plug-in."""
    from math import cos, pi, sin
    grid = [i / 10 for i in range(11)]
    (FILES / "body.csv").write_text("s,value\n" + "".join(f"{s},{1 + 0.3 * sin(3 * s)}\n" for s in grid))
    (FILES / "body2.csv").write_text("s,value\n" + "".join(f"{s},{1 + 0.2 * sin(3 * s)}\n" for s in grid))
    (FILES / "ground.csv").write_text("x,value\n" + "".join(f"{x},{1 + 0.3 * sin(5 * x)}\n" for x in grid))
    (FILES / "shape.csv").write_text("x,f\n" + "".join(f"{x / 20},{sin(2 * pi * x / 20)}\n" for x in range(0, 61)))
    (FILES / "shape2.csv").write_text("x,f\n" + "".join(f"{x / 20},{0.9 * sin(2 * pi * x / 20)}\n" for x in range(0, 61)))
    for name, column, size, ends in (("stress", "m", 0.2, 11), ("stress2", "m", 0.15, 11), ("part", "m", 0.2, 9),
                                     ("strain", "strain", 0.2, 11), ("strain2", "strain", 0.15, 11)):
        rows = [f"{s},{t},{size * (sin(2 * pi * (s + t)) - (sin(2 * pi * s) if column == 'strain' else 0))}\n"
                for s in grid[:ends] for t in grid]
        (FILES / f"{name}.csv").write_text(f"s,t,{column}\n" + "".join(rows))
    for name, size in (("tracks", 0.2), ("tracks2", 0.15)):
        rows = [",".join(str(x) for x in (t, *(s + 0.1 * t - size / (2 * pi) * cos(2 * pi * (s + t)) for s in (0.1, 0.4, 0.9)))) for t in grid[:9]]
        (FILES / f"{name}.csv").write_text("t,x1,x2,x3\n" + "\n".join(rows) + "\n")
    text = (pathlib.Path(SOURCE) / "contrib/plugin/peristalsis.cc").read_text()
    for name, start in (("plugin", "0.1"), ("plugin2", "0.2")):
        (FILES / f"{name}.cc").write_text(text.replace("0.1 * input.end_time", f"{start} * input.end_time"))
        subprocess.run([os.environ.get("CXX", "c++"), "-std=c++20", "-O1", "-shared", "-fPIC", f"-I{SOURCE}/include",
                        f"-I{pathlib.Path(PROGRAM).parent}/include",
                        FILES / f"{name}.cc", "-o", FILES / f"{name}.so"], check=True)


FAST = {"Accuracy": "1e-3", OUT + "Number of snapshots": "0"}
BY_SPEED = {**FAST, OPTIMAL + "Choose wave by": "wave speed"}
BY_ENERGY = {**FAST, OPTIMAL + "Perturbation parameter": "0.1", OPTIMAL + "Energy": "0.6"}


def by(generator, **others):
    return {**FAST, M + "Generator": generator, **others}


def window(section):
    return {section + "Window start": "0.2", section + "Window end": "0.8", section + "Window edge": "0.1"}


TRAVELS = {**by("travelling wave"), TRAVEL + "Amplitude": "0.2"}
SQUARE = {**TRAVELS, TRAVEL + "Profile": "smoothed square", "Accuracy": "1e-2"}
LOW = {**TRAVELS, T + "End time": "4"}
WAVE_OF_STRAIN = {**by("prescribed strain"), "Model": "kinematic", STRAIN + "Given by": "wave"}
TWO_LEVELS = {**by("two-level wave"), "Model": "kinematic"}
SEES = {**by("strain feedback"), FEEDBACK + "Active stress": "0.1*sin(2*pi*(s+t)) - 0.2*(w_near-1) - 0.1*(w_delayed-1)",
        FEEDBACK + "Delay": "0.1", FEEDBACK + "Distance": "-0.2"}
OF_MODES = {**by("modes"), MODES + "Coefficients": "0, 0.1, 0.1"}
HARMONICS = {**OF_MODES, MODES + "In time": "harmonics", MODES + "Coefficients": "0, 0.1, 0, 0, 0.1, 0, 0, 0.1"}
READS = {**by("table"), TABLE + "File": FILES / "stress.csv", T + "End time": "0.9"}
ADDS = {**by("sum"), SUM + "Generator": "travelling wave", SUM + "Travelling wave/Amplitude": "0.2"}
PROFILED = {**BY_SPEED, BODY + "Elastic modulus profile": FILES / "body.csv"}
ON_GROUND = {**BY_SPEED, GROUND + "Profile": FILES / "ground.csv"}
PICTURES = {**BY_SPEED, OUT + "Number of snapshots": "4"}

# (scene, other values): in the scene each of these values alone changes something.
PAIRS = [
    (BY_SPEED, {"Model": "kinematic", "Accuracy": "1e-5", "Error estimate": "false", BODY + "Length": "1.1",
                BODY + "Elastic modulus": "1.1", BODY + "Friction coefficient": "1.1", BODY + "Anchoring exponent": "2.1",
                BODY + "Elastic modulus profile": "1+0.1*s", BODY + "Friction profile": "1+0.1*s",
                BODY + "Initial stretch": "1+0.1*sin(pi*s)", GROUND + "Profile": "1+0.1*x",
                GROUND + "Friction law": "Newtonian", M + "Generator": "travelling wave"}),
    (PROFILED, {BODY + "Profile interpolation": "linear"}),
    ({**BY_SPEED, BODY + "Friction profile": "1+g*s", BODY + "Constants": "g = 0.1"}, {BODY + "Constants": "g = 0.2"}),
    (BY_SPEED, {"Units/Length": "mm", "Units/Time": "s", "Units/Force": "mN"}),
    (ON_GROUND, {GROUND + "Profile interpolation": "linear", GROUND + "Outside": "error"}),
    ({**BY_SPEED, GROUND + "Friction law": "expression", GROUND + "Expression": "w^a", GROUND + "Constants": "a = -1"},
     {GROUND + "Expression": "2*w^a", GROUND + "Constants": "a = -1.5"}),
    ({**BY_SPEED, GROUND + "Switching velocity": "0.1"}, {GROUND + "Backward ratio": "2"}),
    ({**BY_SPEED, GROUND + "Switching velocity": "0.1", GROUND + "Backward ratio": "2"}, {GROUND + "Switching velocity": "0.2"}),
    # generators
    (BY_SPEED, {OPTIMAL + "Perturbation parameter": "0.3", OPTIMAL + "Shape": "expression",
                OPTIMAL + "Sine coefficients": "1, 0.2", OPTIMAL + "Cosine coefficients": "0.2",
                OPTIMAL + "Wave speed": "1.3"}),
    ({**BY_SPEED, OPTIMAL + "Shape": "expression", OPTIMAL + "Shape formula": "a*sin(2*pi*x/L)",
      OPTIMAL + "Shape constants": "a = 1"},
     {OPTIMAL + "Shape formula": "0.9*a*sin(2*pi*x/L)", OPTIMAL + "Shape constants": "a = 0.8"}),
    ({**BY_SPEED, OPTIMAL + "Shape": "table", OPTIMAL + "Shape file": FILES / "shape.csv"},
     {OPTIMAL + "Shape file": FILES / "shape2.csv"}),
    (BY_ENERGY, {OPTIMAL + "Choose wave by": "wave speed", OPTIMAL + "Energy": "0.8",
                 OPTIMAL + "Sine coefficients": "1, 0.2"}),
    ({**BY_ENERGY, OPTIMAL + "Root index": "2"}, {OPTIMAL + "Root": "index"}),
    ({**BY_ENERGY, OPTIMAL + "Root": "index"}, {OPTIMAL + "Root index": "2"}),
    (TRAVELS, {TRAVEL + "Amplitude": "0.1", TRAVEL + "Offset": "0.1", TRAVEL + "Wave number": "1.5",
               TRAVEL + "Direction": "from tail to head", TRAVEL + "Frequency": "1.5",
               TRAVEL + "Phase": "0.5", TRAVEL + "Profile": "square", TRAVEL + "Window start": "0.2",
               TRAVEL + "Window end": "0.8", TRAVEL + "Ramp duration": "0.5"}),
    ({**TRAVELS, TRAVEL + "Wave number": "2", TRAVEL + "Given by": "wave speed"},
     {TRAVEL + "Given by": "frequency", TRAVEL + "Wave speed": "1.5"}),
    (SQUARE, {TRAVEL + "Duty cycle": "0.4", TRAVEL + "Front width": "0.2"}),
    ({**TRAVELS, **window(TRAVEL)}, {TRAVEL + "Window edge": "0.2"}),
    ({**by("standing wave"), STAND + "Offset": "0.01"},
     {STAND + "Amplitude": "0.2", STAND + "Offset": "0.1", STAND + "Wave number": "1.5", STAND + "Phase in space": "0.5",
      STAND + "Frequency": "1.5", STAND + "Phase": "0.5", STAND + "Profile": "square", STAND + "Window start": "0.2",
      STAND + "Window end": "0.8", STAND + "Ramp duration": "0.5"}),
    ({**by("standing wave"), STAND + "Profile": "smoothed square", "Accuracy": "1e-2"},
     {STAND + "Duty cycle": "0.4", STAND + "Front width": "0.2"}),
    ({**by("standing wave"), **window(STAND)}, {STAND + "Window edge": "0.2"}),
    (by("pulse"), {PULSE + "Shape": "compact", PULSE + "Amplitude": "0.2", PULSE + "Width": "0.2",
                   PULSE + "Start position": "-0.2", PULSE + "Direction": "from head to tail", PULSE + "Speed": "1.5",
                   PULSE + "Repetition period": "0.5", PULSE + "Window start": "0.2", PULSE + "Window end": "0.8",
                   PULSE + "Ramp duration": "0.5"}),
    ({**by("pulse"), **window(PULSE)}, {PULSE + "Window edge": "0.2"}),
    ({**by("segments"), "Accuracy": "1e-2", SEGMENTS + "Number of segments": "4", SEGMENTS + "Switching": "smooth"},
     {SEGMENTS + "Number of segments": "3", OUT + "Segment table": "10", SEGMENTS + "Amplitude": "0.2", SEGMENTS + "Frequency": "1.5",
      SEGMENTS + "Phase lag": "0.3", SEGMENTS + "Direction": "from tail to head", SEGMENTS + "Duty cycle": "0.4",
      SEGMENTS + "Switching": "square", SEGMENTS + "Front width": "0.2", SEGMENTS + "Phase": "0.2",
      SEGMENTS + "Gap": "0.1", SEGMENTS + "Saturation": "0.2", SEGMENTS + "Rate limit": "1",
      SEGMENTS + "Ramp duration": "0.5"}),
    ({**by("expression"), FORMULA + "Active stress": "A*sin(2*pi*(s+t))", FORMULA + "Constants": "A = 0.1"},
     {FORMULA + "Active stress": "2*A*sin(2*pi*(s+t))", FORMULA + "Constants": "A = 0.2"}),
    ({**by("prescribed strain"), "Model": "kinematic", STRAIN + "Strain": "A*(sin(2*pi*(s+t)) - sin(2*pi*s))",
      STRAIN + "Constants": "A = 0.2"},
     {STRAIN + "Given by": "wave", STRAIN + "Strain": "A*sin(2*pi*(s+t))", STRAIN + "Constants": "A = 0.3"}),
    (WAVE_OF_STRAIN, {STRAIN + "Mean strain": "0.1", STRAIN + "Amplitude": "0.2", STRAIN + "Wave number": "2",
                      STRAIN + "Wave speed": "1.5", STRAIN + "Phase": "0.5"}),
    ({**WAVE_OF_STRAIN, STRAIN + "Given by": "table", STRAIN + "File": FILES / "strain.csv"},
     {STRAIN + "File": FILES / "strain2.csv"}),
    (TWO_LEVELS, {TWO + "Smallest strain": "-0.2", TWO + "Largest strain": "0.2", TWO + "Share": "0.4",
                  TWO + "Front width": "0.1", TWO + "Wave number": "2", TWO + "Direction": "from tail to head",
                  TWO + "Given by": "work", TWO + "Frequency": "2", TWO + "Phase": "0.5", TWO + "Ramp duration": "0.5"}),
    ({**TWO_LEVELS, TWO + "Wave number": "2", TWO + "Given by": "wave speed"}, {TWO + "Wave speed": "2"}),
    ({**TWO_LEVELS, TWO + "Given by": "work"}, {TWO + "Work": "0.02"}),
    (SEES, {FEEDBACK + "Active stress": "0.1*sin(2*pi*(s+t))", FEEDBACK + "Distance": "-0.3",
            FEEDBACK + "Sensor length": "0.1", FEEDBACK + "Delay": "0.2"}),
    ({**by("strain feedback"), FEEDBACK + "Active stress": "A*sin(2*pi*(s+t))-0.1*(w-1)", FEEDBACK + "Constants": "A = 0.1"},
     {FEEDBACK + "Constants": "A = 0.2"}),
    (READS, {TABLE + "File": FILES / "stress2.csv", TABLE + "Interpolation": "linear", TABLE + "Unit of s": "1.1",
             TABLE + "Unit of t": "1.1", TABLE + "Unit of m": "1.1"}),
    ({**READS, T + "End time": "2", TABLE + "Outside": "hold"}, {TABLE + "Outside": "periodic"}),
    ({**READS, TABLE + "File": FILES / "part.csv", TABLE + "Outside in s": "hold"}, {TABLE + "Outside in s": "error"}),
    ({**by("library"), LIBRARY + "File": FILES / "plugin.so"},
     {LIBRARY + "File": FILES / "plugin2.so", LIBRARY + "Parameters": "height = 0.2"}),
    (OF_MODES, {MODES + "Harmonics": "0", MODES + "In time": "splines", MODES + "Wave speed": "1.5",
                MODES + "From rest": "true", MODES + "Coefficients": "0, 0.2"}),
    (HARMONICS, {MODES + "Period": "0.8", MODES + "Harmonics": "1"}),
    ({**HARMONICS, MODES + "Harmonics": "1", MODES + "Time harmonics": "2",
      MODES + "Coefficients": "0, 0.1, 0, 0, 0.1, 0, 0, 0.1, 0, 0.1"}, {MODES + "Time harmonics": "1", MODES + "From rest": "true"}),
    ({**OF_MODES, MODES + "In time": "splines"}, {MODES + "Time cells": "5"}),
    (ADDS, {SUM + "Factor": "0.5", SUM + "Window in s": "0.2, 0.8", SUM + "Window in t": "0.2, 0.8",
            SUM + "Generator": "optimal wave", SUM + "Combine": "multiply"}),
    ({**ADDS, SUM + "Window in s": "0.2, 0.8", SUM + "Edge width in s": "0.1", SUM + "Window in t": "0.2, 0.8",
      SUM + "Edge width in t": "0.1"}, {SUM + "Edge width in s": "0.2", SUM + "Edge width in t": "0.2"}),
    # numerics
    (BY_SPEED, {D + "Formulation": "stretch", D + "Mesh": "adaptive", D + "Degree": "3", D + "Number of cells": "20",
                T + "End time": "1.1", T + "Integrator": "bdf", T + "Engine": "petsc", T + "Step control": "fixed",
                T + "Tolerance": "1e-4", T + "Initial step": "0.001", T + "Maximum number of steps": "5",
                T + "Wall time limit": "1e-9"}),
    ({**BY_SPEED, D + "Mesh": "adaptive"}, {D + "Mesh tolerance": "1e-2"}),
    ({**BY_SPEED, D + "Mesh": "adaptive", D + "Degree": "1", D + "Number of cells": "8", D + "Mesh tolerance": "1e-4"},
     {D + "Smallest cell": "0.1"}),
    ({**BY_SPEED, T + "Integrator": "bdf"}, {T + "Order": "3"}),
    ({**LOW, T + "End time": "40"}, {T + "Cycle stop": "off"}),
    # output
    (PICTURES, {OUT + "Number of snapshots": "5", OUT + "Snapshot format": "xdmf", OUT + "Kymograph": "false",
                OUT + "Statistics": "false", OUT + "Ledger": "false", OUT + "Ledger tolerance": "1e-30",
                OUT + "Active stress table": "9, 9", OUT + "Sensitivities": "Body/Elastic modulus",
                OUT + "Uncertainty": "Body/Elastic modulus : 5 %"}),
]

GRID = {**BY_SPEED, "Sweep/Axes": "Body/Elastic modulus : 1, 2; Body/Anchoring exponent : 2, 3"}
DRAWN = {**BY_SPEED, "Sweep/Axes": "Body/Elastic modulus : uniform(1, 2)", "Sweep/Design": "random",
         "Sweep/Number of points": "3"}
CHECKED = {**GRID, T + "End time": "0.3", "Sweep/Cross-check": "true"}
TRADES = {**BY_SPEED, T + "End time": "0.1", **{"Tradeoff/" + name: value for name, value in {
    "Models": "nonlinear", "Formulations": "position", "Meshes": "uniform", "Engines": "fused", "Integrators": "radau 5",
    "Degrees": "2", "Cells": "4", "Tolerances": "1e-2", "Repetitions": "1"}.items()}}
FITTED = {**WAVE_OF_STRAIN, **{"Fit/" + name: value for name, value in {
    "Data": FILES / "tracks.csv", "Variables": f"{STRAIN}Amplitude : 0.01 to 0.4", "Markers at": "0.1, 0.4, 0.9", "Starts": "2",
    "Standard deviation": "0.01"}.items()}}
BEST = {**WAVE_OF_STRAIN, "Optimize/Variables": STRAIN + "Amplitude : 0.1 to 0.4"}
# The same for studies: (command, scene, other values).
STUDY_PAIRS = [
    ("sweep", GRID, {"Sweep/Design": "zip", "Sweep/Axes": "Body/Elastic modulus : 1, 3", "Sweep/Keep fields": "1",
                     "Sweep/Time limit per point": "1e-9", "Sweep/Time limit": "1e-9"}),
    ("sweep", DRAWN, {"Sweep/Number of points": "4", "Sweep/Seed": "2"}),
    ("sweep", CHECKED, {"Sweep/Cross-check": "false", "Sweep/Cross-check refinement": "1000"}),
    ("tradeoff", TRADES, {"Tradeoff/Models": "kinematic, nonlinear", "Tradeoff/Formulations": "position, stretch",
                          "Tradeoff/Meshes": "uniform, adaptive", "Tradeoff/Engines": "petsc",
                          "Tradeoff/Integrators": "radau 9", "Tradeoff/Degrees": "4", "Tradeoff/Cells": "8",
                          "Tradeoff/Tolerances": "1e-3", "Tradeoff/Time limit per run": "1e-9",
                          "Tradeoff/Time limit": "1e-9"}),
    ("tradeoff", {**TRADES, "Tradeoff/Meshes": "adaptive", "Tradeoff/Engines": "petsc"},
     {"Tradeoff/Mesh tolerances": "1e-3"}),
    ("optimize", BEST, {"Optimize/Objective": "merit", "Optimize/Direction": "backward",
                        "Optimize/Variables": STRAIN + "Amplitude : 0.1 to 0.35", "Optimize/Work": "0.1",
                        "Optimize/Positive work": "0.1", "Optimize/Dissipation": "0.1", "Optimize/Smallest strain": "-0.2",
                        "Optimize/Largest strain": "0.2", "Optimize/Mean-square strain": "0.02",
                        "Optimize/Largest stress": "0.2", "Optimize/Largest stress rate": "1", "Optimize/Starts": "2",
                        "Optimize/Time limit": "1e-9"}),
    ("optimize", {**BEST, "Optimize/Work": "0.02",
                  "Optimize/Variables": f"{STRAIN}Amplitude : 0.1 to 0.4; {STRAIN}Wave speed : 0.5 to 2"},
     {"Optimize/Tolerance": "0.1", "Optimize/Most iterations": "1"}),
    ("fit", FITTED, {"Fit/Data": FILES / "tracks2.csv", "Fit/Variables": f"{STRAIN}Amplitude : 0.02 to 0.4",
                     "Fit/Markers at": "0.1, 0.5, 0.9", "Fit/Place deviation": "0.01", "Fit/Origin": "tail", "Fit/First time": "0.1",
                     "Fit/Standard deviation": "0.02", "Fit/Starts": "3", "Fit/Seed": "2"}),
    ("optimize", {**BEST, "Optimize/Starts": "2"}, {"Optimize/Start spread": "0.5", "Optimize/Seed": "2"}),
]
# How often a cost is measured is to be seen in nothing but its scatter, a checkpoint after a crash only; cells are shared
# where there are several ranks.
NOT_TO_BE_SEEN = {"Tradeoff/Repetitions", "Time/Checkpoint interval", "Discretization/Share cells"}
# A limit is silent where nothing reaches it, and a switch where what it switches to has the same value; then this is set.
LIMITS = {D + "Smallest cell", OUT + "Ledger tolerance", TABLE + "Outside in s", MODES + "Time harmonics"}
WHAT_IT_SWITCHES_TO = {TRAVEL + "Given by": {TRAVEL + "Frequency": "1.5"}, OPTIMAL + "Root": {OPTIMAL + "Root index": "2"}}


def outcome(scene, command="run"):
    """The answer (a sentence, if the scene is refused), and the notes on entries without an effect."""
    folder = pathlib.Path(tempfile.mkdtemp(dir=FILES)) / "out"
    if command == "run":
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                crawler.run(scene, output=folder)
            except crawler.InputError as error:
                return str(error), []
            except KeyboardInterrupt:  # before there were files
                return "stopped", []
        log = (folder / "log.txt").read_text().splitlines()
        return answer_in(folder, *NO_ANSWER), [line for line in log if "has no effect" in line]
    file = folder.parent / "scene.prm"
    file.write_text(crawler.to_prm(scene))
    ended = call([PROGRAM, command, file, "--output", folder], variables={} if command == "fit" else NO_PICTURES)
    expect(0 <= ended.returncode < 100, f"{command} of {scene} ends with {ended.returncode}: {ended.stderr}")
    if ended.returncode == 2:
        return ended.stderr, []
    return answer_in(folder, *NO_ANSWER), [line for line in ended.stdout.splitlines() if "has no effect" in line]


def in_a_sum(scene):
    """The scene with its generator as the only term of a sum."""
    terms = {name.replace(M, SUM, 1) if name.startswith(M) else name: value for name, value in scene.items()}
    return {SUM + "Generator": "optimal wave", **terms, M + "Generator": "sum"}


def all_pairs():
    yield from (("run", scene, others) for scene, others in PAIRS)
    yield from STUDY_PAIRS
    in_sums = {"prescribed strain", "two-level wave", "sum"}  # a term has no strain that is not 0 at the start
    for scene, others in PAIRS:
        own = [name for name in others if name.startswith(M) and name.count("/") == 2][-1:]
        generator = scene.get(M + "Generator", "optimal wave")
        if own and generator not in in_sums:
            in_sums.add(generator)
            yield "run", in_a_sum(scene), {name.replace(M, SUM, 1): others[name] for name in own}


def declared():
    """All entries, also those of a term of a sum."""
    section = ""
    for line in call([PROGRAM, "parameters", "--format", "markdown"]).stdout.splitlines():
        if line.startswith("## "):
            section = "" if line == "## Top level" else line[3:] + "/"
        elif line.startswith("| ") and not line.startswith(("| entry |", "|---")):
            yield section + line.split("|")[1].strip()


def check_pairs():
    """Every entry has a scene in which it changes something and is not noted."""
    seen = set()
    for command, scene, others in all_pairs():
        answer, notes = outcome(scene, command)
        expect(isinstance(answer, dict), f"{command} {scene}: {answer}")
        for name, value in others.items():
            other, its_notes = outcome({**scene, name: value}, command)
            expect(other != answer, f"{name} = {value} changes nothing in {command} of {scene}")
            expect(not any(f'"{name}"' in note for note in its_notes), f"{name} = {value}: {its_notes} in {scene}")
            seen.add(name)
    names = list(declared())
    expect(set(crawler.entries()) < set(names), f"{len(names)} declared entries")
    for name in names:
        twin = name.replace(SUM, M) if name.count("/") > 3 else name  # the same generator in a sum
        expect(twin in seen or name in NOT_TO_BE_SEEN, f"no scene is paired with {name}")


def values():
    """Other values of each entry, in the order of the pairs."""
    found = {}
    for _, _, others in all_pairs():
        for name, value in others.items():
            found.setdefault(name, value)
    return found


def idle_of(scene, others):
    """Those of the other values that a note of check() names; sections are tried as a whole first."""
    def noted(some):
        try:
            notes, _ = warnings_of(lambda: crawler.check(scene, set=some))
        except crawler.InputError:
            return None
        return {name: value for name, value in some.items() if any(f'"{name}" has no effect' in note for note in notes)}

    idle, sections = {}, {}
    for name, value in others.items():
        sections.setdefault(name.rpartition("/")[0], {})[name] = value
    for section in sections.values():
        if noted(section) == section:
            idle.update(section)
        else:
            for name, value in section.items():
                idle.update(noted({name: value}) or {})
    return idle


def changes(scene, answer, idle):
    """Those of the idle entries by which the answer is another one; halves are tried, as some are refused together."""
    if outcome({**scene, **idle})[0] == answer:
        return []
    if len(idle) == 1:
        return list(idle)
    half = len(idle) // 2
    return [name for part in (list(idle)[:half], list(idle)[half:])
            for name in changes(scene, answer, {name: idle[name] for name in part})]


def check_idle(each):
    """What is noted in a scene changes nothing there; with each, what is not noted changes something."""
    others = {name: value for name, value in values().items() if SUM not in name}
    for scene, _ in PAIRS if each else PAIRS[::6]:
        answer, _ = outcome(scene)
        idle = idle_of(scene, {name: value for name, value in others.items() if name not in scene})
        changed = changes(scene, answer, idle)
        expect(not changed, f"{changed} are noted, but change something in {scene}")
        expect(len(idle) > 20, f"{len(idle)} entries are noted in {scene}")
        for name, value in others.items() if each else ():
            if name in idle or name in scene or name in NOT_TO_BE_SEEN | LIMITS or re.match("Sweep|Optimize|Fit|Tradeoff", name):
                continue
            other, notes = outcome({**scene, name: value, **WHAT_IT_SWITCHES_TO.get(name, {})})
            expect(other != answer or any(f'"{name}" has no effect' in note for note in notes),
                   f"{name} = {value} changes nothing in {scene}")


def check_channels():
    """A note is the same from a file, --set, check and Python, and in studies."""
    name, sentence = GROUND + "Expression", f'has no effect with "{GROUND}Friction law = power"'
    scene = {name: value for name, value in BY_SPEED.items() if not name.startswith(OUT)}
    idle = {**scene, name: "2/w"}
    file = FILES / "channels.prm"
    for written, words in ((idle, ()), (scene, ("--set", f"{name}=2/w"))):
        file.write_text(crawler.to_prm(written))
        for command in ("run", "check"):
            ended = call([PROGRAM, command, file, *words,
                          *(("--output", FILES / "channels", "--overwrite") if command == "run" else ())])
            place = f'--set "{name}=2/w"' if words else f"{file}, line "
            expect(ended.returncode == 0 and f"Note: {place}" in ended.stdout and f'"{name}" {sentence}' in ended.stdout,
                   f"crawler {command} {words} says {ended.stdout}")
    in_python = {"run": lambda: crawler.run(idle, fields=False), "check": lambda: crawler.check(idle),
                 "set": lambda: crawler.run(scene, set={name: "2/w"}), "batch": lambda: crawler.batch([idle]),
                 "output": lambda: crawler.run(idle, output=FILES / "channels", overwrite=True),
                 "sweep": lambda: crawler.sweep(idle, {BODY + "Length": [1, 2]}),
                 "sweep with files": lambda: crawler.sweep(idle, {BODY + "Length": [1, 2]}, output=FILES / "channels2")}
    for kind, action in in_python.items():
        texts, files = warnings_of(action)
        expect(len(texts) == 1 and sentence in texts[0] and files == {__file__}, f"{kind} in Python: {texts}")
    # A run without files has fields or none; how they are written is nothing to it.
    for name, value, n in (("Output/Number of snapshots", 3, 1), ("Output/Number of snapshots", 0, 0), ("Output/Statistics", False, 0),
                           ("Output/Snapshot format", "xdmf", 1), ("Output/Active stress table", "4, 4", 1),
                           ("Time/Checkpoint interval", 3, 1)):
        texts, _ = warnings_of(lambda: crawler.run({name: value}))
        expect(len(texts) == n and all(f'"{name}" has no effect' in text for text in texts), f"{name} = {value} in Python: {texts}")
    # An axis may give the entry its effect, and may itself have none.
    for axes, n in ((GROUND + "Friction law : power, expression", 0), (BODY + "Length : 1, 2", 1),
                    (GROUND + "Switching velocity : 0.1, 0.2", 2)):
        _, notes = outcome({**idle, "Sweep/Axes": axes}, "sweep")
        expect(len(notes) == n, f"{axes}: {notes}")
    # So is what the scene itself leaves without an effect, unless an axis may give it one.
    for axes, n in ((BODY + "Length : 1, 2", 1), (T + "End time : 1, 5", 0)):
        _, notes = outcome({**scene, T + "Cycle stop": "off", "Sweep/Axes": axes}, "sweep")
        expect(len(notes) == n, f"{axes}: {notes}")
    # The section of another command is noted once.
    _, notes = outcome(BEST)
    expect(len(notes) == 1 and '"Optimize/Variables" has no effect with "crawler run"' in notes[0], f"{notes}")
    _, notes = outcome({**GRID, "Sweep/Design": "zip"})
    expect(len(notes) == 1 and 'section "Sweep" has no effect with "crawler run"' in notes[0], f"{notes}")


def check_commas():
    """A list that may be meant as a decimal is noted; one with a blank, or in a file without decimals, is a list."""
    coefficients = OPTIMAL + "Sine coefficients"
    for value, k, n in (("0,5", "1", 1), ("0, 5", "1", 0), ("1,5", "0.5", 1), ("1,5", "1", 0), ("0,0.5", "0.5", 0), ("0.3, 0,5", "1", 1),
                        ("0.3, 0, 5", "1", 0), ("0.3,0,5", "1", 0)):
        scene = {OPTIMAL + "Choose wave by": "wave speed", OPTIMAL + "Perturbation parameter": "1e-2",
                 BODY + "Elastic modulus": k, coefficients: value}
        texts, _ = warnings_of(lambda: crawler.check(scene))
        expect(len(texts) == n and all("decimals are written with a point" in text for text in texts), f"{value}: {texts}")
    file = FILES / "commas.prm"
    file.write_text(crawler.to_prm({**scene, coefficients: "0,5"}))
    ended = call([PROGRAM, "check", file])
    expect("Coefficients: sine 0, 5; cosine 0, 0" in ended.stdout, f"the coefficients are not told: {ended.stdout}")


write_files()
check_channels()
check_commas()
check_pairs()
check_idle(each=sys.argv[4:] == ["all"])
shutil.rmtree(FILES)
checks.end()
