# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Python package computes what the program does: run() to the last bit of summary.json, statistics.csv and
kymograph.vts, sweep() to the last bit of results.csv, batch() within the error bounds; read() gives what is in the
folders of all commands; nothing is written or printed unless it is asked for.

    python3 same_numbers.py PATH_TO_CRAWLER FOLDER_OF_THE_PACKAGE
"""
import os
import pathlib
import pickle
import sys

import numpy as np

PROGRAM, PACKAGE = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])
sys.path[:0] = [PACKAGE, str(pathlib.Path(__file__).resolve().parents[1] / "support")]
import crawler  # noqa: E402
from program import call, checks, expect, sets  # noqa: E402

PRM = pathlib.Path(__file__).resolve().parents[2] / "prm"
K, P = "Body/Elastic modulus", "Body/Anchoring exponent"
WAVE = {"Accuracy": 1e-4,
        "Active stress": {"Optimal wave": {"Perturbation parameter": 0.3, "Choose wave by": "wave speed"}}}
INVERTS = {"Active stress": {"Generator": "expression", "Expression": {"Active stress": "3*sin(2*pi*(s+t))"}}}
JUMPS = {"Accuracy": 1e-2, "Active stress": {"Generator": "travelling wave", "Travelling wave": {"Profile": "square"}}}
# Name: scene, overrides.
RUNS = {
    "paper": (PRM / "paper/fig_s1.prm", {}),
    "dict": (WAVE, {"Body/Length": 2, K: 1.5}),
    "sensitivities": (WAVE, {"Output/Sensitivities": "all", "Output/Uncertainty": K + " : 5 %"}),
    "without snapshots": (WAVE, {"Output/Number of snapshots": 0}),
    "series": (PRM / "examples/small_wave.prm", {"Model": "perturbation", "Accuracy": 0.01}),
    "kinematic": (PRM / "examples/prescribed_strain.prm", {"Model": "kinematic"}),
    "linear": (WAVE, {P: 1, "Model": "linear"}),
    "stretch form": (WAVE, {"Discretization/Formulation": "stretch"}),
    "petsc": (WAVE, {"Time/Engine": "petsc", "Time/Integrator": "bdf"}),
    "adaptive": (WAVE, {"Discretization/Mesh": "adaptive"}),
    "inverted": (INVERTS, {}),
    "jumps that move": (JUMPS, {}),
}


def program(*arguments, text=None):
    """What a command of the program says; its exit code."""
    return call([PROGRAM, *arguments, "--quiet", "--overwrite"], input=text or "")


def of_the_scene(summary):
    """What does not say something of the process."""
    return {key: value for key, value in summary.items() if key not in ("seconds", "command_line")}


def same_fields(a, b, what):
    if a is None or b is None:
        expect(a is None and b is None, f"{what}: fields in one of them only")
        return
    for name, values in vars(a).items():
        other = getattr(b, name)
        same = np.allclose(values, other, rtol=1e-14) if name == "t" else np.array_equal(values, other)
        expect(values.shape == other.shape and same, f"{what}: {name} differs")


def same_statistics(a, b, what):
    if a is None or b is None:
        expect(a is None and b is None, f"{what}: statistics in one of them only")
        return
    expect(list(a) == list(b) and len(a) == len(b), f"{what}: the statistics have other rows or columns")
    for name in a:
        expect(np.allclose(a[name], b[name], rtol=1e-2, atol=0, equal_nan=True) and
               (name not in ("time", "displacement") or np.allclose(a[name], b[name], rtol=1e-15, atol=0)),
               f"{what}: column {name} differs")


def check_runs(folder):
    for name, (scene, values) in RUNS.items():
        before = set(pathlib.Path.cwd().rglob("*"))
        result = crawler.run(scene, set=values)
        expect(set(pathlib.Path.cwd().rglob("*")) == before, f"{name}: a file was written")
        file, text = (scene, None) if isinstance(scene, pathlib.Path) else ("-", crawler.to_prm(scene))
        ended = program("run", file, "--output", folder / "program", *sets(values), text=text)
        read = crawler.read(folder / "program")
        expect(of_the_scene(result) == of_the_scene(read),
               f"{name}: other numbers than crawler run: {of_the_scene(result)} {of_the_scene(read)} {ended.stderr}")
        same_fields(result.fields, read.fields, name)
        same_statistics(result.statistics, read.statistics, name)
        expect(result.parameters == read.parameters and len(result.parameters) > 100, f"{name}: other parameters")
        expect((name == "inverted") == (result.status == "inverted"), f"{name}: status {result.status}")
    result = crawler.run(WAVE, fields=False)
    program("run", "-", "--output", folder / "program", "--set", "Output/Number of snapshots=0", "--set",
            "Output/Statistics=false", text=crawler.to_prm(WAVE))
    expect(of_the_scene(result) == of_the_scene(crawler.read(folder / "program")) and result.fields is None and
           result.statistics is None, "without fields: not the numbers of crawler run")


def check_results():
    """Ways to numbers, fields at wanted times, and that results can be sent to other processes."""
    times = [0., 0.1, 0.25, 1.]
    result = crawler.run(WAVE, fields=times)
    f = result.fields
    expect(np.array_equal(f.t, times) and f.stretch.shape == (4, 201), "fields at other times than wanted")
    expect(np.allclose(f.stretch[0], 1) and np.allclose(f.position[0], f.s), "the body does not start at rest")
    expect(abs(np.mean((f.displacement[-1, 1:] + f.displacement[-1, :-1]) / 2) - result.displacement) < 1e-4,
           "the mean of the displacement is not the displacement")
    expect(np.allclose(np.gradient(f.position[-1], f.s)[1:-1], f.stretch[-1, 1:-1], rtol=1e-3),
           "the stretch is not the slope of the position")
    expect(result.gait.speed == result["gait.speed"] == result["gait"]["speed"] and "gait" in dir(result) and
           result.displacement_error.total > 0 and result.errors.stress_power > 0, "attributes and keys differ")
    again = pickle.loads(pickle.dumps(result))
    expect(again == result and np.array_equal(again.fields.stretch, f.stretch) and
           again.parameters == result.parameters, "a pickled result is another one")
    expect(repr(result).startswith("<crawler.Result: finished at t = 1, displacement 0.0"), f"{result!r}")
    expect(crawler.run(WAVE, elastic_modulus=2, fields=False).parameters[K] == 2., "a keyword has no effect")
    again = crawler.run(crawler.run(WAVE, fields=False).parameters, fields=False)
    expect(again.displacement == crawler.run(WAVE, fields=False).displacement, f"parameters of a result as a scene: {again!r}")
    run = crawler.run(WAVE, set={"Active stress/Generator": "travelling wave", "Output/Sensitivities": K}, fields=False)
    local = run.local_sensitivities
    whole = np.sum((local.elastic_modulus[1:] + local.elastic_modulus[:-1]) / 2 * np.diff(local.s))
    expect(abs(whole / run.sensitivities[K].value - 1) < 0.02 and
           local.active_stress.shape == (len(local.t), len(local.s)),
           f"the local sensitivities make {whole}, not {run.sensitivities[K].value}")


def check_batch():
    scenes = [dict(WAVE, Body={"Anchoring exponent": p}) for p in (1.5, 2, 3, 4)]
    together = crawler.batch([*scenes, PRM / "paper/fig_s1.prm"], set={"Time/End time": 1})
    alone = [crawler.batch([scene])[0] for scene in scenes]
    for scene, one, single in zip(scenes, together, alone):
        run = crawler.run(scene, fields=False)
        expect(of_the_scene(one) == of_the_scene(single), "a run of a batch depends on its neighbours")
        expect(abs(one.displacement - run.displacement) <= one.displacement_error.total + run.displacement_error.total,
               f"batch {one!r}, run {run!r}")


def same_tables(a, b, what):
    expect(list(a) == list(b) and len(a["index"]) == len(b["index"]), f"{what}: other columns or rows")
    for name in a:
        if name == "seconds":
            continue
        x, y = np.asarray(a[name]), np.asarray(b[name])
        if x.dtype == y.dtype == float:
            expect(np.array_equal(x, y, equal_nan=True), f"{what}: {name} differs")
        elif y.dtype == float:  # nothing in the column of words
            expect(not any(x) and np.isnan(y).all(), f"{what}: {name} differs")
        else:
            expect(list(x) == list(y), f"{what}: {name} differs")


def check_sweeps(folder):
    axes = {K: [0.5, 1, 2], "Active stress/Optimal wave/Perturbation parameter": "linspace(0.1, 0.9, 4)"}
    table = crawler.sweep(WAVE, axes)
    prm = crawler.to_prm(dict(WAVE, Sweep={"Axes": f"{K} : 0.5, 1, 2; " + "; ".join(
        f"{name} : {text}" for name, text in list(axes.items())[1:])}))
    program("sweep", "-", "--output", folder / "sweep", text=prm)
    study = crawler.read(folder / "sweep")
    same_tables(table, study.table, "sweep")
    expect(study.kind == "sweep" and study.points == 12 and study.parameters["Accuracy"] == 1e-4, f"{study!r}")
    same_tables(crawler.sweep(prm), study.table, "the sweep of a file")
    same_tables(crawler.sweep(WAVE, axes, output=folder / "from_python"), study.table, "a sweep with files")
    expect((folder / "from_python/results.h5").exists(), "a sweep with files has none")
    zipped = crawler.sweep(WAVE, {"elastic_modulus": np.array([1, 2]), P: range(2, 4)}, design="zip")
    expect(list(zipped[P]) == [2, 3] and list(zipped[K]) == [1, 2], "a zip of arrays")
    refused = crawler.sweep(WAVE, {"Body/Length": [1, 2], "Discretization/Smallest cell": [1.5]}, design="grid")
    expect(list(refused["status"]) == ["failed", "finished"] and "Smallest cell" in refused["message"][0],
           "a row that fails")
    many = crawler.sweep(WAVE, {K: "linspace(1, 2, 600)"})  # the numerics are shared
    program("sweep", "-", "--output", folder / "many", "--set", f"Sweep/Axes={K} : linspace(1, 2, 600)",
            text=crawler.to_prm(WAVE))
    same_tables(many, crawler.read(folder / "many").table, "a sweep of many points")


def check_other_folders(folder):
    result = crawler.run(WAVE, output=folder / "with_files")
    expect(of_the_scene(result) == of_the_scene(crawler.run(WAVE)) and (folder / "with_files/solution.pvd").exists() and
           (folder / "with_files/original.prm").read_text() == crawler.to_prm(WAVE), "a run with files")
    text = crawler.to_prm(WAVE)
    program("sweep", "-", "--output", folder / "checked", *sets({
        "Sweep/Axes": f"{K} : 1, 2; {P} : 2, 3", "Sweep/Cross-check": "true"}), text=text)
    checked = crawler.read(folder / "checked")
    expect(checked.kind == "sweep" and checked.cross_check.checked == 4 and list(checked.table["verdict"]) == 4 * ["agree"],
           f"{checked!r}")
    program("tradeoff", "-", "--output", folder / "tradeoff", *sets({
        "Tradeoff/Models": "nonlinear", "Tradeoff/Formulations": "position", "Tradeoff/Meshes": "uniform",
        "Tradeoff/Engines": "fused", "Tradeoff/Integrators": "radau 5", "Tradeoff/Degrees": 4, "Tradeoff/Cells": 8,
        "Tradeoff/Tolerances": "1e-4, 1e-6", "Tradeoff/Repetitions": 1}), text=text)
    tradeoff = crawler.read(folder / "tradeoff")
    expect(tradeoff.kind == "tradeoff" and tradeoff.table["error"][1] < tradeoff.table["error"][0], f"{tradeoff!r}")
    program("optimize", "-", "--output", folder / "optimize", *sets({
        "Optimize/Variables": "Active stress/Optimal wave/Wave speed : 0.5 to 2", "Optimize/Work": 0.1}), text=text)
    optimum = crawler.read(folder / "optimize")
    expect(optimum.kind == "optimize" and len(optimum.best) == 1 and optimum.best[0].status == "finished" and
           len(optimum.starts) > 0, f"{optimum!r}")


def main(folder):
    empty, folder = folder / "empty", folder / "files"
    for place in (empty, folder):
        place.mkdir()
    os.chdir(empty)
    check_runs(folder)
    check_results()
    check_batch()
    check_sweeps(folder)
    check_other_folders(folder)
    expect(not list(empty.iterdir()), f"files were written: {list(empty.iterdir())}")


checks.run((main,))
