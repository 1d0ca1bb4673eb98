# SPDX-License-Identifier: LGPL-2.1-or-later
"""Installs crawler, builds plug-ins against the installed package, and runs them, good ones and bad ones.

Usage: plugin.py CMAKE BUILD_FOLDER MPIRUN     exit status 1 if something is not as it should be
"""
import csv
import glob
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

CMAKE, BUILD, MPIRUN = sys.argv[1:4]
HERE = os.path.dirname(os.path.abspath(__file__))
PLUGIN_SOURCE = os.path.join(HERE, "..", "..", "contrib", "plugin")
ENVIRONMENT = dict(os.environ, LANG="C")
failed = 0


def expect(condition, what):
    global failed
    if not condition:
        failed += 1
        print("NOT AS EXPECTED:", what)


def command(*words):
    result = subprocess.run(words, capture_output=True, text=True, env=ENVIRONMENT)
    if result.returncode != 0:
        sys.exit(f"{' '.join(words)} failed:\n{result.stdout}\n{result.stderr}")


def run(name, generator, entries, more="", command="run", before=()):
    """Runs a scene; gives the exit code, standard error and output folder."""
    section = generator.capitalize()
    lines = "\n".join(f"set {entry} = {value}" for entry, value in entries.items())
    with open(f"{name}.prm", "w") as file:
        file.write(f"{more}\nsubsection Active stress\nset Generator = {generator}\nsubsection {section}\n{lines}\nend\nend\n")
    words = [*before, PROGRAM, command, f"{name}.prm"] + ([] if command == "check" else ["--output", name, "--overwrite"])
    result = subprocess.run(words, capture_output=True, text=True, env=ENVIRONMENT)
    return result.returncode, result.stderr, result.stdout


def no_constant(name):
    raise ValueError(f"{name} in summary.json")


def summary(name):
    with open(os.path.join(name, "summary.json")) as file:
        return json.load(file, parse_constant=no_constant)


def is_finite(file):
    """Are all numbers of a VTU file finite?"""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(file)
    reader.Update()
    data = reader.GetOutput().GetPointData()
    return all(np.isfinite(vtk_to_numpy(data.GetArray(i))).all() for i in range(data.GetNumberOfArrays()))


def refused(name, entries, *words):
    """The program must refuse this with exit code 2 and one sentence that has these words in it, and write nothing."""
    for kind in ("run", "check"):
        code, err, _ = run(name, "library", entries, command=kind)
        lines = err.strip().splitlines()
        expect(code == 2, f"{name}: exit code {code} of {kind} instead of 2")
        expect(len(lines) == 1 and lines[0].startswith("crawler: "), f"{name}: not one sentence: {err}")
        for word in words:
            expect(word in err, f"{name}: \"{word}\" is not in: {err}")
    expect(not os.path.exists(name), f"{name}: something was written")


def fails(name, parameters, words, last_time, n_frames, before=(), snapshots=20, more=""):
    """The run must fail with the reason nonfinite, name function, place and time, and keep what it has written."""
    code, err, out = run(name, "library", {"File": FAULTY, "Parameters": parameters},
                         f"{more}\nsubsection Output\nset Number of snapshots = {snapshots}\nend", before=before)
    expect(code == 3, f"{name}: exit code {code} instead of 3: {err} {out[-500:]}")
    expect("nonfinite" in err, f"{name}: nonfinite is not in: {err}")
    for word in words:
        expect(word in err, f"{name}: \"{word}\" is not in: {err}")
    result = summary(name)
    expect(result["status"] == "failed" and result["reason"] == "nonfinite", f"{name}: {result['status']} {result['reason']}")
    frames = glob.glob(os.path.join(name, "solution", "[0-9]*.vtu"))
    expect(len(frames) in (n_frames if isinstance(n_frames, range) else [n_frames]),
           f"{name}: {len(frames)} frames instead of {n_frames}")
    for file in frames:
        expect(is_finite(file), f"{name}: not finite: {file}")
    times = []  # a run that fails at once has no row, and no file
    if os.path.exists(os.path.join(name, "statistics.csv")):
        with open(os.path.join(name, "statistics.csv")) as file:
            times = [float(row["time [time]"]) for row in csv.DictReader(file)]
    expect(not times or max(times) <= last_time, f"{name}: the statistics end at {max(times, default=0)}")
    return result, times


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
        code, err, out = run("plugin", "library", good, f"set Accuracy = {accuracy}")
        expect(code == 0, f"the example: {err}")
        expect('Plug-in "peristalsis"' in out, f"the plug-in is not named: {out}")
        code, err, _ = run("formula", "expression", formula, f"set Accuracy = {accuracy}")
        a, b = summary("plugin"), summary("formula")
        error = abs(a["displacement"] / b["displacement"] - 1)
        expect(error <= 1e-12, f"plug-in and formula differ by {error} at accuracy {accuracy}")
        expect(a["steps"] == b["steps"], "plug-in and formula need different steps")
    for engine in ("petsc", "automatic"):
        code, err, _ = run("adaptive", "library", good,
                           f"subsection Discretization\nset Mesh = adaptive\nend\nsubsection Time\nset Engine = {engine}\nend")
        error = abs(summary("adaptive")["displacement"] / b["displacement"] - 1)
        expect(code == 0 and error <= 2e-6, f"adaptive mesh, engine {engine}: {err}, error {error}")

    # Its values as a strain, which is not 0 at an end: the formula, and the table that both write.
    library = "\n".join(f"set {entry} = {value}" for entry, value in good.items())
    more = f"""subsection Active stress
subsection Library
{library}
end
end
subsection Output
set Active stress table = 9, 5
end
"""
    for model, error in (("kinematic", 1e-12), ("nonlinear", 1e-6)):
        model = f"set Model = {model}\n"
        code, err, _ = run("strain", "prescribed strain", {"Given by": "library"}, model + more)
        expect(code == 0, f"the example as a strain: {err}")
        code, err, _ = run("strain_formula", "prescribed strain",
                           {"Strain": formula["Active stress"], "Constants": formula["Constants"]}, model + more)
        expect(code == 0, f"the formula as a strain: {err}")
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
    result = subprocess.run([PROGRAM, "run", "peristalsis.prm", "--output", "../peristalsis"], cwd="source", env=ENVIRONMENT,
                            capture_output=True, text=True)
    expect(result.returncode == 0, f"peristalsis.prm: {result.stderr}")
    displacement = summary("peristalsis")["displacement"]
    expect(abs(displacement / float(expected) - 1) <= float(tolerance), f"peristalsis.prm: displacement {displacement}")

    # The installed gallery, of two of its examples; one has a table beside it.
    share = os.path.join("installed", "share", "crawler")
    for file in glob.glob(os.path.join(share, "prm", "examples", "*.prm")):
        if os.path.basename(file) not in ("earthworm.prm", "measured_table.prm"):
            os.remove(file)
    result = subprocess.run([sys.executable, os.path.join(share, "python/crawler/plot", "gallery.py"), PROGRAM], env=ENVIRONMENT,
                            capture_output=True, text=True)
    expect(result.returncode == 0 and os.path.exists("gallery.png") and "measured_table" in result.stdout,
           f"the installed gallery: {result.stdout} {result.stderr}")

    # The installed program finds the installed plot scripts: this one says that it is the one.
    with open(os.path.join(share, "python/crawler/plot", "sweep.py"), "w") as file:
        file.write("import sys, pathlib\n(pathlib.Path(sys.argv[1]) / 'installed_script').touch()\n")
    os.mkdir("drawn")
    with open("drawn/results.h5", "w"):
        pass
    result = subprocess.run([PROGRAM, "plot", "drawn"], env=ENVIRONMENT, capture_output=True, text=True)
    expect(result.returncode == 0 and os.path.exists("drawn/installed_script"), f"plot: {result.stdout} {result.stderr}")

    # What does not even start.
    FAULTY = os.path.join(folder, "faulty.so")
    include = f"-I{folder}/installed/include"
    compiler = os.environ.get("CXX", "c++")
    command(compiler, "-std=c++20", "-shared", "-fPIC", include, os.path.join(HERE, "faulty_plugin.cc"), "-o", FAULTY)
    refused("missing", {"File": "no.so"}, "there is no file", f"{folder}/no.so", "missing.prm, line ")
    refused("folder", {"File": "source"}, "is not a file")
    refused("text", {"File": "text.prm"}, "cannot be loaded", "invalid ELF header", "compiled with -shared on this machine")
    refused("empty", {"File": ""}, "name of the shared object is missing")
    with open("other.c", "w") as file:
        file.write("int f(void) { return 0; }\n")
    command(compiler, "-x", "c", "-shared", "-fPIC", "other.c", "-o", "other.so")
    refused("other", {"File": "other.so"}, "has no function crawler_active_stress_plugin", "CRAWLER_ACTIVE_STRESS_PLUGIN")
    with open("other.c", "w") as file:
        file.write("int g(void);\nint f(void) { return g(); }\n")
    command(compiler, "-x", "c", "-shared", "-fPIC", "other.c", "-o", "undefined.so")
    refused("undefined", {"File": "undefined.so"}, "cannot be loaded", "undefined symbol: g")
    with open("other.so", "rb") as file:
        content = bytearray(file.read())
    content[18:20] = (0x1234).to_bytes(2, "little")
    with open("machine.so", "wb") as file:
        file.write(content)
    refused("machine", {"File": "machine.so"}, "cannot be loaded", "compiled with -shared on this machine")
    for name, interface, version in (("old", 0, "PLUGIN_VERSION"), ("version", 1, '"0.0.7"')):
        with open("old.cc", "w") as file:
            file.write("#include <crawler/scene/plugin_version.h>\n#define PLUGIN_VERSION crawler::plugin_version\n"
                       "struct Old { unsigned int interface; const char *version; };\n"
                       'extern "C" const Old *crawler_active_stress_plugin()\n'
                       f"{{ static const Old old = {{{interface}, {version}}}; return &old; }}\n")
        command(compiler, "-std=c++20", "-shared", "-fPIC", include, "old.cc", "-o", f"{name}.so")
        refused(name, {"File": f"{name}.so"}, "was built against crawler", "but this program is crawler", "build it again")
    refused("factory", {"File": FAULTY, "Parameters": "kind=factory"}, "refuses the scene: this body is too short")
    refused("number", {"File": FAULTY, "Parameters": "t=soon"}, 'the parameter "t" is "soon"', "a number is expected")
    refused("nothing", {"File": FAULTY, "Parameters": "kind=nothing"}, "returned nothing")
    refused("period", {"File": FAULTY, "Parameters": "kind=period"}, "its period is -1")
    refused("breaks", {"File": FAULTY, "Parameters": "kind=breaks"}, "breaks_in_space(): no breaks here")
    refused("unknown", {"File": FAULTY, "Parameters": "knd=nan"}, 'does not know the parameter "knd"', '"kind"')
    refused("words", {"File": FAULTY, "Parameters": "kind"}, 'found "kind"', "name=value")
    refused("twice", {"File": FAULTY, "Parameters": "t=1, t=2"}, '"t"', "a second time")

    # What goes wrong on the way. Frames every 0.05 of the time.
    throws, petsc = 'plug-in "faulty" threw an exception in values() at s = 0.5', "subsection Time\nset Engine = petsc\nend"
    half = "kind=throw, s=0.5, t=0.68"
    # What follows the last accepted step is lost.
    THROWN = range(12, 15)
    result, times = fails("throws", half, [throws, "the valve is shut"], 0.68, THROWN)
    expect(max(times) > 0.6, f"throws: the statistics end at {max(times)}")
    fails("throws_petsc", half, [throws, "the valve is shut"], 0.68, THROWN, more=petsc)
    fails("throws_linear", half, [throws, "the valve is shut"], 0.68, THROWN,
          more="set Model = linear\nsubsection Body\nset Anchoring exponent = 1\nend")
    fails("throws_adaptive", half, [throws, "the valve is shut"], 0.68, THROWN,
          more="subsection Discretization\nset Mesh = adaptive\nend")
    fails("throws_number", "kind=throw number, t=0.68", ["something that is not a std::exception"], 0.68, THROWN)
    fails("gives_nan", "kind=nan, s=0.5, t=0.43", ["returned nan in values() at s = 0.5", "a finite number"], 0.43, 9)
    # Only where the pictures look, and at an end, whose stress is no part of the equation inside.
    fails("place", "kind=nan at place, s=0.5, t=0.35", ["nonfinite", "returned nan in values() at s = 0.5, t = 0.35"], 0.36, 7)
    fails("end", "kind=nan at place, s=1, t=0.35", ["returned nan in values() at s = 1, t = "], 0.5, 0, snapshots=0)
    fails("at_once", "kind=throw", ["threw an exception in values() at s = ", "t = 0: "], 0., 0)
    fails("no_evaluator", "kind=no evaluator", ["returned no evaluator in at()"], 0., 0)
    fails("two_ranks", "kind=throw, s=0.75, t=0.68", [throws.replace("0.5", "0.75"), "the valve is shut"], 0.68, THROWN,
          before=(MPIRUN, "--oversubscribe", "-n", "2"))
    fails("shared", "kind=throw, s=0.75, t=0.68", [throws.replace("0.5", "0.75"), "the valve is shut"], 0.68, THROWN,
          before=(MPIRUN, "--oversubscribe", "-n", "2"), more="subsection Discretization\nset Number of cells = 300\nset Degree = 2\nset Share cells = yes\nend")
    fails("shared_place", "kind=nan at place, s=0.5, t=0.35", ["returned nan in values() at s = 0.5, t = 0.35"], 0.36, 7,
          before=(MPIRUN, "--oversubscribe", "-n", "2"), more="subsection Discretization\nset Number of cells = 300\nset Degree = 2\nset Share cells = yes\nend")
    code, err, _ = run("term", "sum", {}, f"""subsection Active stress
subsection Sum
subsection Term 1
set Generator = library
set Factor = 0.5
subsection Library
set File = {FAULTY}
set Parameters = {half}
end
end
subsection Term 2
set Factor = 0.1
end
end
end
""")
    expect(code == 3 and "nonfinite: the " + throws in err and summary("term")["status"] == "failed", f"a term that throws: {code} {err}")
    code, err, out = run("warned", "library", {"File": FAULTY, "Parameters": "kind=throw, t=0.7"}, command="check")
    expect(code == 0 and "warning: the plug-in" in err, f"check does not warn: {code} {err}")
    os.chdir("/")

sys.exit(failed > 0)
