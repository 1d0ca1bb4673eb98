#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""contrib/python/crawler/plot/sweep.py on small sweeps of each design: which pictures it makes, and what it says to bad input.

    python3 sweep_plot.py PATH_TO_CRAWLER
"""
import json
import os
import pathlib
import re
import shutil
import sys

import h5py
import matplotlib.image
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from pictures import SCRIPTS, draw, words  # noqa: E402
from program import call, checks, expect, prm, refused  # noqa: E402

SCRIPT = SCRIPTS / "sweep.py"
CHI, P, K = "Active stress/Optimal wave/Perturbation parameter", "Body/Anchoring exponent", "Body/Elastic modulus"
BASE = prm("Accuracy={accuracy}", "Active stress/Optimal wave/Choose wave by=wave speed",
           "Sweep/Axes={axes}") + "subsection Sweep\n  {more}\nend\n"
# Name: axes, other entries, accuracy.
SWEEPS = {
    "line": (f"{CHI} : linspace(0.1, 0.3, 5)", "", 1e-2),
    "grid": (f"{P} : 0, 1, 2; {CHI} : linspace(0.1, 0.3, 5)", "", 1e-3),
    "log": (f"{K} : 1, 4; {CHI} : logspace(-3, -0.6, 7)", "", 1e-3),
    "three": (f"{K} : 1, 4; {P} : 2, 3; {CHI} : 0.1, 0.2, 0.3", "", 1e-3),
    "four": (f"Time/End time : 1, 2; {K} : 1, 2, 3, 4, 5; {P} : 2, 3; {CHI} : 0.1, 0.2", "", 1e-2),
    "five": (f"Body/Length : 1, 2; Time/End time : 1, 2; {K} : 1, 2; {P} : 2, 3; {CHI} : 0.1, 0.2", "", 1e-2),
    "one": (f"Body/Length : 1; {P} : 2, 3; {CHI} : 0.1, 0.2", "", 1e-2),
    "zip": (f"{P} : 2, 2.5, 3; {CHI} : 0.1, 0.15, 0.2", "set Design = zip", 1e-2),
    "random": (f"{P} : uniform(2, 4); {CHI} : loguniform(0.01, 0.3)", "set Design = random\n  set Number of points = 20", 1e-2),
    "files": (f"File : soft.prm, stiff.prm; {CHI} : 0.1, 0.2, 0.3", "", 1e-2),
    "failed": (f"{P} : 0, 0.5; {CHI} : 0.1, 0.3, 0.6", "", 1e-2),
    "unfinished": (f"{P} : linspace(2, 4, 5); {CHI} : linspace(0.05, 0.4, 6)", "", 1e-2),
}


def drawn(folder, name, *arguments, alone=False):
    """Calls the script as its users do (alone), or in a fork of this process, which saves the time of reading its libraries."""
    if alone:
        return call([sys.executable, SCRIPT, name, *arguments], folder)
    return draw(SCRIPT.name, name, *arguments, folder=folder)


def expect_picture(folder, name, wanted, *arguments, alone=False):
    """A picture in both formats, in which certain words stand."""
    for old in ("results.png", "results.svg"):
        (folder / name / old).unlink(missing_ok=True)
    result = drawn(folder, name, *arguments, alone=alone)
    said = " ".join([name, *arguments])
    if result.returncode != 0:
        expect(False, f"{said}: {result.returncode} {result.stderr.strip()}")
        return []
    image = matplotlib.image.imread(folder / name / "results.png")[:, :, :3]
    texts = words(folder / name / "results.svg")
    missing = [word for word in wanted if not any(word in text for text in texts)]
    expect(result.stderr == "" and min(image.shape[:2]) > 300 and image.std() > 0.02 and not missing,
           f"{said}: {image.shape[1]} x {image.shape[0]} {result.stderr.strip()} {'without ' + str(missing) if missing else ''}")
    return texts


def test_pictures(folder):
    texts = expect_picture(folder, "line", ["Perturbation parameter", "displacement $D$ [length]"], alone=True)
    expect("Anchoring exponent" not in texts, "what is no axis is not named")
    expect_picture(folder, "grid", ["Perturbation parameter", "Anchoring exponent", "displacement $D$ [length]"])
    expect_picture(folder, "grid", ["Anchoring exponent = 0", "Anchoring exponent = 2"], "--lines")
    expect_picture(folder, "grid", ["Perturbation parameter", "Anchoring exponent"], "--x", P)
    expect_picture(folder, "grid", ["Anchoring exponent = 2"], "--where", "exponent=2")
    expect_picture(folder, "grid", ["net friction"], "--value", "net_friction")
    expect_picture(folder, "grid", ["finished: 15"], "--value", "status")
    expect_picture(folder, "grid", ["mesh changes"], "--value", "mesh_changes")  # constant
    expect_picture(folder, "grid", ["displacement $D$ [length]"], "--scale", "log")  # both signs
    expect_picture(folder, "log", ["Perturbation parameter", "Elastic modulus $k$ [force]"])
    expect_picture(folder, "three", ["Elastic modulus = 1", "Elastic modulus = 4"])
    expect_picture(folder, "three", ["Elastic modulus = 1", "Anchoring exponent = 2"], "--lines")
    expect_picture(folder, "four", ["Elastic modulus = 5", "End time = 2"])
    test_titles(folder)
    expect_picture(folder, "four", ["Elastic modulus = 3", "End time = 1"], "--where", "modulus=3", "--where", "End time=1")
    expect_picture(folder, "five", ["Length = 2"], "--where", "Length=2")
    expect_picture(folder, "one", ["Length = 1"])
    expect_picture(folder, "zip", ["Anchoring exponent", "Perturbation parameter varies, too"])
    expect_picture(folder, "zip", ["Anchoring exponent", "Perturbation parameter"], "--x", CHI, "--y", P)
    expect_picture(folder, "random", ["Anchoring exponent", "Perturbation parameter", "displacement $D$ [length]"])
    expect_picture(folder, "random", ["Anchoring exponent varies, too"], "--lines")
    expect_picture(folder, "files", ["soft", "stiff"])
    expect_picture(folder, "files", ["soft", "stiff"], "--lines", "--x", "File")
    expect_picture(folder, "failed", ["inverted (inverted inside): 2"])
    expect_picture(folder, "failed", ["inverted (inverted inside): 2"], "--lines")
    expect_picture(folder, "failed", ["inversion, t [time]", "finished: 4"], "--value", "inversion.t")
    texts = expect_picture(folder, "unfinished", ["not computed yet"])
    with h5py.File(folder / "unfinished" / "results.h5", "r") as file:
        missing = np.count_nonzero(file["results/status"][:] == b"")
    expect(f"not computed yet: {missing}" in texts and missing == 19, f"{missing} points that are missing are counted")


def test_titles(folder):
    """Those of small maps over two lines each, one below the other and none over its neighbour, by their places in the SVG."""
    text = (folder / "four" / "results.svg").read_text(encoding="utf-8")
    places = {}
    for words_, x, y in re.findall(r"<!-- ((?:Elastic modulus|End time) = .*?) -->\s*<g [^>]*translate\((\S+) (\S+)\)", text):
        places.setdefault(float(y), []).append((float(x), len(words_)))
    apart = [right[0] - left[0] > 4.5 * left[1]  # a letter is about 4.5 pt wide
             for row in places.values() for left, right in zip(sorted(row), sorted(row)[1:])]
    expect(len(places) == 4 and len(apart) == 12 and all(apart), f"titles of 8 maps lie side by side ({len(places)} rows, {len(apart)} gaps)")


def test_fit(folder):
    """The displacement of small waves grows as chi^2; one that is a power exactly comes out exactly."""
    result = drawn(folder, "log", "--fit", "--where", "modulus=1")
    match = re.search(r"displacement = (\S+) \* \(.*\)\^(\S+)", result.stdout)
    expect(match and abs(float(match[2]) - 2) < 0.01 and abs(float(match[1]) - 0.5) < 0.02,
           f"displacement = chi^2/2: {result.stdout.splitlines()[0]}")
    shutil.copytree(folder / "log", folder / "power")
    with h5py.File(folder / "power" / "results.h5", "r+") as file:
        group = file["results"]
        group["displacement"][:] = -3 * group[CHI.replace("/", ".")][:] ** -1.5
        group["displacement_error.total"][:] = np.nan  # the signs of values without errors count
    result = drawn(folder, "power", "--fit", "--where", "modulus=4")
    lines = result.stdout.splitlines()
    expect("displacement = -3 * " in result.stdout and "^-1.500000" in result.stdout, f"-3 x^-1.5: {lines[0]}")
    texts = expect_picture(folder, "grid", ["Anchoring exponent = 0; -0.", "Anchoring exponent = 1; no power law",
                                            "Anchoring exponent = 2; 0."], "--fit", "--lines", "--value", "gait.speed")
    lines = drawn(folder, "grid", "--fit", "--lines", "--value", "gait.speed").stdout.splitlines()
    expect(texts and [line.rpartition(" at ")[2] for line in lines[:2]] == [f"{P} = 0", f"{P} = 2"] and
           lines[2].startswith("drawn without a fit") and lines[2].endswith(f": 1 of 3 lines ({P} = 1)"),
           f"p = 1 does not move: {lines[2]}")
    lines = drawn(folder, "three", "--fit").stdout.splitlines()
    expect(lines[3].endswith(f" at {P} = 3, {K} = 4"), f"small pictures are named: {lines[3]}")


def test_bad_input(folder):
    """One sentence, exit code 2 (6 where a picture cannot be written), no picture."""
    (folder / "broken").mkdir()
    (folder / "broken" / "results.h5").write_text("no HDF5", encoding="utf-8")
    (folder / "other").mkdir()
    with h5py.File(folder / "other" / "results.h5", "w") as file:
        file["x"] = [1.0]
    shutil.copytree(folder / "line", folder / "unknown")
    with h5py.File(folder / "unknown" / "results.h5", "r+") as file:
        file["results/displacement"][:] = np.nan
    with h5py.File(folder / "grid" / "results.h5", "r") as file:
        numbers = sum(data.dtype.kind == "f" for data in file["results"].values())
    cases = [(("nowhere",), 'no "nowhere/results.h5"'), (("broken",), "not a table"), (("other",), "not a table"),
             (("unknown",), "no point has a displacement (5 finished"), (("grid", "--value", "displacment"), "displacement"),
             (("grid", "--value", "engine"), "column of numbers"),
             (("grid", "--value", "model"), '"model" holds texts'), (("grid", "--value", "MODEL"), '"model" holds texts'),
             (("grid", "--value", "gait.spede"), "names are gait.speed, "), (("grid", "--value", "nix"), "first line of results.csv"),
             (("grid", "--value", "total_"), f"nearest of {numbers} names"), (("grid", "--value", "speed"), "several names: gait."), (("grid", "--x", "Length"), "one of"),
             (("grid", "--x", P, "--y", P), "two axes"), (("grid", "--where", "exponent=7"), "near it are 0, 1, 2"),
             (("grid", "--where", "exponent"), "AXIS=VALUE"), (("grid", "--where", "exponent=two"), "number"),
             (("files", "--where", "File=hard.prm"), "soft.prm, stiff.prm"), (("five",), "--where"),
             (("four", "--lines"), "--where"), (("grid", "--fit", "--where", "exponent=1"), "one sign"),
             (("grid", "--output", "picture.xyz"), "picture.xyz"), (("grid", "--output", "no/picture.png"), "no/picture.png"),
             (("line", "--value", "status"), "two axes")]
    for arguments, word in cases:
        result = drawn(folder, *arguments, alone=arguments[0] == "nowhere" or "no/picture.png" in arguments)
        refused(result, word, code=6 if "no/picture.png" in arguments else 2)
        expect("wrote" not in result.stdout, f"{' '.join(arguments)}: {result.stdout}")


def test_without_matplotlib(folder):
    """Every script here says what to install."""
    (folder / "blind").mkdir()
    (folder / "blind" / "matplotlib.py").write_text("raise ImportError(\"No module named 'matplotlib'\")\n", encoding="utf-8")
    for script in sorted(set(SCRIPT.parent.glob("*.py")) - {SCRIPT.parent / "plotting.py"}):
        arguments = ["grid", "table.csv"] if script.name == "scaling.py" else ["grid"]
        result = call([sys.executable, script, *arguments], folder, variables={"PYTHONPATH": str(folder / "blind")})
        refused(result, "apt install python3-", code=69)
        expect(os.access(script, os.X_OK), f"{script.name} cannot be called")


def test_columns(folder, program):
    """Columns of a sweep are the numbers that the program lists, with their units, beside the axes, the point and its time."""
    listed = json.loads(call([program, "parameters", "--format", "results"]).stdout)["numbers"]
    told = {number["key"]: number["unit"] or "texts" for number in listed if not number["key"].startswith(("seconds.", "cells_shared"))}
    told |= {"index": "1", "seconds": "s"}
    with h5py.File(folder / "line" / "results.h5", "r") as file:
        found = {data.attrs["name"].decode(): "texts" if data.dtype.kind == "S" else data.attrs["unit"].decode()
                 for data in file["results"].values() if data.attrs["description"] != b"axis of the sweep"}
        ascii_only = all(data.id.get_type().get_cset() == h5py.h5t.CSET_ASCII for data in file["results"].values()
                         if data.dtype.kind == "S")
    expect(ascii_only, "texts have the label that Octave can read")
    wrong = sorted(name for name in told.keys() | found.keys() if told.get(name) != found.get(name))
    expect(not wrong and len(found) > 50, f"{len(found)} columns are listed by the program with their units {wrong or ''}")


def main(folder):
    program = pathlib.Path(sys.argv[1]).resolve()
    for scene, modulus in (("soft", 1), ("stiff", 10)):
        (folder / f"{scene}.prm").write_text(f"subsection Body\n  set Elastic modulus = {modulus}\nend\n", encoding="utf-8")
    for sweep, (axes, more, accuracy) in SWEEPS.items():
        (folder / f"{sweep}.prm").write_text(BASE.format(axes=axes, more=more, accuracy=accuracy), encoding="utf-8")
        result = call([program, "sweep", f"{sweep}.prm", "--output", sweep], folder)
        expect(result.returncode == 0, f"sweep {sweep}: {result.returncode} {result.stderr}")
    with h5py.File(folder / "unfinished" / "results.h5", "r+") as file:  # as if only the first points were computed
        file["results/status"][11:] = b""
        file["results/displacement"][11:] = np.nan
    test_pictures(folder)
    test_fit(folder)
    test_bad_input(folder)
    test_without_matplotlib(folder)
    test_columns(folder, program)


checks.run((main,))
