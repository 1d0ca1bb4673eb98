# SPDX-License-Identifier: LGPL-2.1-or-later
"""Installs crawler, builds plug-ins against the installed package, and runs them, good ones and bad ones.

Usage: plugin.py CMAKE BUILD_FOLDER MPIRUN     exit status 1 if something is not as it should be
"""
import csv
import glob
import json
import os
import pathlib
import re
import shutil
import sys
import tempfile

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect, on_ranks, refused, sets  # noqa: E402
from tables import csv_rows  # noqa: E402

CMAKE, BUILD, MPIRUN = sys.argv[1:4]
HERE = pathlib.Path(__file__).resolve().parent
PLUGIN_SOURCE = HERE.parents[1] / "contrib/plugin"


def command(*words):
    done = call(words)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))} failed:\n{done.stdout}\n{done.stderr}")


def run(name, generator, entries, more=None, command="run", before=()):
    """Runs a scene with these entries of its generator, and more that are set; gives the finished process."""
    lines = "\n".join(f"set {entry} = {value}" for entry, value in entries.items())
    pathlib.Path(f"{name}.prm").write_text(f"subsection Active stress\nset Generator = {generator}\nsubsection "
                                           f"{generator.capitalize()}\n{lines}\nend\nend\n", encoding="utf-8")
    return call([*before, PROGRAM, command, f"{name}.prm", *sets(more or {}),
                 *([] if command == "check" else ["--output", name, "--overwrite"])], variables={"LANG": "C"})


def no_constant(name):
    raise ValueError(f"{name} in summary.json")


def summary(name):
    return json.loads(pathlib.Path(name, "summary.json").read_text(encoding="utf-8"), parse_constant=no_constant)


def is_finite(file):
    """Are all numbers of a VTU file finite?"""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(file)
    reader.Update()
    data = reader.GetOutput().GetPointData()
    return all(np.isfinite(vtk_to_numpy(data.GetArray(i))).all() for i in range(data.GetNumberOfArrays()))


def is_refused(name, entries, *words):
    """The program must refuse this with exit code 2 and one sentence that has these words in it, and write nothing."""
    if isinstance(entries, str):
        entries = {"File": FAULTY, "Parameters": entries}
    for kind in ("run", "check"):
        done = run(name, "library", entries, command=kind)
        refused(done, "crawler: ", *words)
    expect(not os.path.exists(name), f"{name}: something was written")


def fails(name, parameters, words, last_time, n_frames, n_ranks=1, **more):
    """The run must fail with the reason nonfinite, name function, place and time, and keep what it has written; gives the
    times of its statistics."""
    settings = {"Output/Number of snapshots": 20, **{key.replace("__", "/").replace("_", " "): value for key, value in more.items()}}
    done = run(name, "library", {"File": FAULTY, "Parameters": parameters}, settings, before=on_ranks(MPIRUN, n_ranks))
    result = summary(name)
    expect(done.returncode == 3 and all(word in done.stderr for word in ("nonfinite", *words))
           and (result["status"], result["reason"]) == ("failed", "nonfinite"),
           f"{name}: {done.returncode}, {done.stderr} {done.stdout[-500:]}")
    frames = glob.glob(os.path.join(name, "solution", "[0-9]*.vtu"))
    expect(len(frames) in n_frames, f"{name}: {len(frames)} frames instead of {n_frames}")
    expect(all(map(is_finite, frames)), f"{name}: not finite")
    table = pathlib.Path(name, "statistics.csv")  # a run that fails at once has no row, and no file
    times = [float(row["time [time]"]) for row in csv_rows(table)] if table.exists() else []
    expect(not times or max(times) <= last_time, f"{name}: the statistics end at {max(times, default=0)}")
    return times


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    command(CMAKE, "--install", BUILD, "--prefix", os.path.join(folder, "installed"))
    PROGRAM = os.path.join(folder, "installed", "bin", "crawler")

    # The example, out of tree.
    shutil.copytree(PLUGIN_SOURCE, "source")
    command(CMAKE, "-G", "Ninja", "-S", "source", "-B", "source/build", f"-DCMAKE_PREFIX_PATH={folder}/installed")
    command(CMAKE, "--build", "source/build")
    good = {"File": "source/build/libperistalsis.so", "Parameters": "height=0.4, waves=1, frequency=1, start=0.2"}
    formula = {"Active stress": "height*(1-cos(2*pi*(s+t)))/2*(1-exp(-t/start))", "Constants": "height=0.4, start=0.2"}
    for accuracy in ("1e-4", "1e-8"):
        one, other = (run(name, generator, entries, {"Accuracy": accuracy})
                      for name, generator, entries in (("plugin", "library", good), ("formula", "expression", formula)))
        expect(one.returncode == 0 and 'Plug-in "peristalsis"' in one.stdout, f"the example: {one}")
        a, b = summary("plugin"), summary("formula")
        error = abs(a["displacement"] / b["displacement"] - 1)
        expect(error <= 1e-12 and a["steps"] == b["steps"], f"plug-in and formula differ by {error} at accuracy {accuracy}: {other}")
    for engine in ("petsc", "automatic"):
        done = run("adaptive", "library", good, {"Discretization/Mesh": "adaptive", "Time/Engine": engine})
        error = abs(summary("adaptive")["displacement"] / b["displacement"] - 1)
        expect(done.returncode == 0 and error <= 2e-6, f"adaptive mesh, engine {engine}: {done.stderr}, error {error}")

    # Its values as a strain, which is not 0 at an end: the formula, and the table that both write.
    library = {f"Active stress/Library/{entry}": value for entry, value in good.items()}
    as_strain = {"Strain": formula["Active stress"], "Constants": formula["Constants"]}
    for model, error in (("kinematic", 1e-12), ("nonlinear", 1e-6)):
        more = {"Model": model, **library, "Output/Active stress table": "9, 5"}
        for name, entries in (("strain", {"Given by": "library"}), ("strain_formula", as_strain)):
            done = run(name, "prescribed strain", entries, more)
            expect(done.returncode == 0, f"{name}: {done.stderr}")
        a, b = summary("strain")["displacement"], summary("strain_formula")["displacement"]
        expect(abs(a / b - 1) <= error, f"{model}: plug-in and formula differ as strains: {a}, {b}")
        with open("strain/active_stress.csv") as one, open("strain_formula/active_stress.csv") as other:
            rows, others = list(csv.reader(one)), list(csv.reader(other))
        expect(rows[0] == ["s", "t", "m"] and len(rows) == 1 + 9 * 5, f"active_stress.csv has {len(rows)} rows")
        m, n = np.array(rows[1:], dtype=float), np.array(others[1:], dtype=float)
        expect(np.abs(m - n).max() < 1e-12 and np.abs(m[:, 2]).max() > 0.1, "the recovered stresses differ")

    # Its own parameter file, from its folder, and the number that this promises.
    with open("source/peristalsis.prm") as file:
        expected, tolerance = re.search(r"# Expect: displacement (\S+), tolerance (\S+)", file.read()).groups()
    result = call([PROGRAM, "run", "peristalsis.prm", "--output", "../peristalsis"], "source")
    expect(result.returncode == 0, f"peristalsis.prm: {result.stderr}")
    displacement = summary("peristalsis")["displacement"]
    expect(abs(displacement / float(expected) - 1) <= float(tolerance), f"peristalsis.prm: displacement {displacement}")

    # The installed gallery, of two of its examples; one has a table beside it.
    share = os.path.join("installed", "share", "crawler")
    for file in glob.glob(os.path.join(share, "prm", "examples", "*.prm")):
        if os.path.basename(file) not in ("earthworm.prm", "measured_table.prm"):
            os.remove(file)
    result = call([sys.executable, os.path.join(share, "python/crawler/plot", "gallery.py"), PROGRAM])
    expect(result.returncode == 0 and os.path.exists("gallery.png") and "measured_table" in result.stdout,
           f"the installed gallery: {result.stdout} {result.stderr}")

    # What does not even start.
    FAULTY = os.path.join(folder, "faulty.so")
    include = f"-I{folder}/installed/include"
    compiler = os.environ.get("CXX", "c++")
    command(compiler, "-std=c++20", "-shared", "-fPIC", include, HERE / "faulty_plugin.cc", "-o", FAULTY)
    is_refused("missing", {"File": "no.so"}, "there is no file", f"{folder}/no.so", "missing.prm, line ")
    is_refused("folder", {"File": "source"}, "is not a file")
    is_refused("text", {"File": "text.prm"}, "cannot be loaded", "invalid ELF header", "compiled with -shared on this machine")
    is_refused("empty", {"File": ""}, "name of the shared object is missing")
    with open("other.c", "w") as file:
        file.write("int f(void) { return 0; }\n")
    command(compiler, "-x", "c", "-shared", "-fPIC", "other.c", "-o", "other.so")
    is_refused("other", {"File": "other.so"}, "has no function crawler_active_stress_plugin", "CRAWLER_ACTIVE_STRESS_PLUGIN")
    with open("other.c", "w") as file:
        file.write("int g(void);\nint f(void) { return g(); }\n")
    command(compiler, "-x", "c", "-shared", "-fPIC", "other.c", "-o", "undefined.so")
    is_refused("undefined", {"File": "undefined.so"}, "cannot be loaded", "undefined symbol: g")
    with open("other.so", "rb") as file:
        content = bytearray(file.read())
    content[18:20] = (0x1234).to_bytes(2, "little")
    with open("machine.so", "wb") as file:
        file.write(content)
    is_refused("machine", {"File": "machine.so"}, "cannot be loaded", "compiled with -shared on this machine")
    for name, interface, version in (("old", 0, "PLUGIN_VERSION"), ("version", 1, '"0.0.7"')):
        with open("old.cc", "w") as file:
            file.write("#include <crawler/scene/plugin_version.h>\n#define PLUGIN_VERSION crawler::plugin_version\n"
                       "struct Old { unsigned int interface; const char *version; };\n"
                       'extern "C" const Old *crawler_active_stress_plugin()\n'
                       f"{{ static const Old old = {{{interface}, {version}}}; return &old; }}\n")
        command(compiler, "-std=c++20", "-shared", "-fPIC", include, "old.cc", "-o", f"{name}.so")
        is_refused(name, {"File": f"{name}.so"}, "was built against crawler", "but this program is crawler", "build it again")
    is_refused("factory", "kind=factory", "refuses the scene: this body is too short")
    is_refused("number", "t=soon", 'the parameter "t" is "soon"', "a number is expected")
    is_refused("nothing", "kind=nothing", "returned nothing")
    is_refused("period", "kind=period", "its period is -1")
    is_refused("breaks", "kind=breaks", "breaks_in_space(): no breaks here")
    is_refused("time", "kind=break in time, t=-1", "returned -1 in breaks_in_time(); a number from 0 to 1 is expected")
    for t in (0, 1):
        done = run("ends", "library", {"File": FAULTY, "Parameters": f"kind=break in time, t={t}"})
        expect(done.returncode == 0, f"a break at {t} is not admitted: {done}")
    for what, value, expected in (("distance", -5, "a number between -1 and 1"), ("delay", -1, "at least 1e-06"), ("sensor length", 3, "from 1e-06 to 1")):
        is_refused(what, f"kind={what}, s={value}", f"the {what.capitalize()} {value}; ", expected)
    is_refused("unknown", "knd=nan", 'does not know the parameter "knd"', '"kind"')
    is_refused("words", "kind", 'found "kind"', "name=value")
    is_refused("twice", "t=1, t=2", '"t"', "a second time")

    # What goes wrong on the way. Frames every 0.05 of the time; what follows the last accepted step is lost.
    half, late, thrown = "kind=throw, s=0.5, t=0.68", "kind=throw, s=0.75, t=0.68", range(12, 15)
    throws, throws_late = ([f'plug-in "faulty" threw an exception in values() at s = {s}', "the valve is shut"] for s in (0.5, 0.75))
    place, at_place = "kind=nan at place, s=0.5, t=0.35", ["returned nan in values() at s = 0.5, t = 0.35"]
    shared = {"n_ranks": 2, "Discretization__Number_of_cells": 300, "Discretization__Degree": 2, "Discretization__Share_cells": "yes"}
    expect(max(fails("throws", half, throws, 0.68, thrown)) > 0.6, "throws: the statistics end early")
    for name, more in (("petsc", {"Time__Engine": "petsc"}), ("linear", {"Model": "linear", "Body__Anchoring_exponent": 1}),
                       ("adaptive", {"Discretization__Mesh": "adaptive"})):
        fails(f"throws_{name}", half, throws, 0.68, thrown, **more)
    fails("throws_number", "kind=throw number, t=0.68", ["something that is not a std::exception"], 0.68, thrown)
    fails("gives_nan", "kind=nan, s=0.5, t=0.43", ["returned nan in values() at s = 0.5", "a finite number"], 0.43, [9])
    # Only where the pictures look, and at an end, whose stress is no part of the equation inside.
    fails("place", place, at_place, 0.36, [7])
    fails("end", "kind=nan at place, s=1, t=0.35", ["returned nan in values() at s = 1, t = "], 0.5, [0], Output__Number_of_snapshots=0)
    fails("at_once", "kind=throw", ["threw an exception in values() at s = ", "t = 0: "], 0., [0])
    fails("no_evaluator", "kind=no evaluator", ["returned no evaluator in at()"], 0., [0])
    fails("two_ranks", late, throws_late, 0.68, thrown, n_ranks=2)
    fails("shared", late, throws_late, 0.68, thrown, **shared)
    fails("shared_place", place, at_place, 0.36, [7], **shared)
    term = "Active stress/Sum/Term 1/"
    done = run("term", "sum", {}, {term + "Generator": "library", term + "Factor": 0.5, term + "Library/File": FAULTY,
                                   term + "Library/Parameters": half, "Active stress/Sum/Term 2/Factor": 0.1})
    expect(done.returncode == 3 and "nonfinite: the " + throws[0] in done.stderr and summary("term")["status"] == "failed",
           f"a term that throws: {done}")
    done = run("warned", "library", {"File": FAULTY, "Parameters": "kind=throw, t=0.7"}, command="check")
    expect(done.returncode == 0 and "warning: the plug-in" in done.stderr, f"check does not warn: {done}")
    os.chdir("/")

checks.end()
