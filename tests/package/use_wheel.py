# SPDX-License-Identifier: LGPL-2.1-or-later
"""Uses the wheel of the Python package: its answers are those of the program, and what it does not have it refuses in
one sentence. tests/package/try_wheel.sh calls this with the Python that has the wheel.

    python use_wheel.py SCENE.prm FOLDER PRM    the folder of `crawler run` with this scene; folder of many scenes
    python use_wheel.py PRM                     with the program's package: keeps the answers to PRM in PRM/answers.json
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import warnings

import crawler

NEAR = 1e-9
NEED_PETSC = {"examples/feedback.prm", "examples/feedback_clock.prm"}  # cells that depend on distant ones
INSTEAD = "which the wheel does not have: the full program computes it, see doc/install.md"
failures = []


def check(condition, what):
    """Prints what was checked and keeps failures."""
    print(f"{'ok    ' if condition else 'FAILED'} {what}", flush=True)
    if not condition:
        failures.append(what)


def is_near(one, other, scale=0.):
    return abs(one - other) <= NEAR * max(abs(other), scale)


def answers(prm):
    """Status and displacement of each scene of a folder; of those that are refused the sentence."""
    found = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # notes of studies, whose single run this is
        for path in sorted(prm.rglob("*.prm")):
            try:
                result = crawler.run(path, fields=False)
                found[str(path.relative_to(prm))] = [result.status, result.displacement]
            except crawler.InputError as error:
                found[str(path.relative_to(prm))] = [str(error), None]
    return found


def test_scenes(prm):
    """All scenes of the repository, formulas among them."""
    theirs, ours = json.loads((prm / "answers.json").read_text(encoding="utf-8")), answers(prm)
    wrong = {name: (ours.get(name), answer) for name, answer in theirs.items() if name not in NEED_PETSC and
             not (ours[name][0] == answer[0] == "finished" and is_near(ours[name][1], answer[1]))}
    check(len(theirs) > 40 and not wrong, f"{len(theirs) - len(NEED_PETSC)} scenes of prm have the answers of the program {wrong}")
    for name in sorted(NEED_PETSC):
        check("PETSc" in ours[name][0] and INSTEAD in ours[name][0], f"{name} is refused: {ours[name][0]}")


def test_formulas():
    """Formulas by the muParser of the wheel, whose exceptions become sentences."""
    run = crawler.run(SCENE, set={"Ground/Profile": "1 + 0.5*sin(6*x)"}, fields=False)
    check(run.status == "finished" and run.displacement != crawler.read(FOLDER).displacement, f"a formula: {run.displacement!r}")
    for formula, words in {"1 + foo*x": "foo", "sin(x": "Missing", "1/(x - x)": "inf at x"}.items():
        try:
            problem = f"it is computed: {crawler.run(SCENE, set={'Ground/Profile': formula})}"
        except crawler.InputError as error:
            problem = str(error)
        check(words.lower() in problem.lower() and "\n" not in problem, f"refused: {problem}")
    maps = pathlib.Path("/proc/self/maps").read_text(encoding="utf-8")
    loaded = {line.split()[-1] for line in maps.splitlines() if "libmuparser" in line or "libgomp" in line}
    check(len(loaded) == 2 and all("/crawler.libs/" in name for name in loaded), f"libraries of the wheel are used: {sorted(loaded)}")


def test_answers():
    """Single runs, batches, sweeps, derivatives, entries."""
    theirs, ours = crawler.read(FOLDER), crawler.run(SCENE)
    for key in ("displacement", "displacement_error.total", "stress_power", "gait.speed", "max_stretch.value"):
        check(is_near(ours[key], theirs[key], 1. if "error" in key else 0.), f"{key} is {ours[key]!r}, that of the program {theirs[key]!r}")
    check(abs(ours.fields.stretch - theirs.fields.stretch).max() <= NEAR, f"the stretch at {ours.fields.stretch.size} points")
    bound = ours.displacement_error.total
    one, other = crawler.batch([SCENE, SCENE], elastic_modulus=1)
    check(one.displacement == other.displacement and abs(one.displacement - ours.displacement) <= 2 * bound, "a batch")
    table = crawler.sweep(SCENE, {"Body/Elastic modulus": [1, 2]})
    check(list(table["status"]) == ["finished"] * 2 and abs(table["displacement"][0] - ours.displacement) <= 2 * table["displacement_error.total"][0], "a sweep")
    step = 1e-3
    slope = (crawler.run(SCENE, elastic_modulus=1 + step).displacement - crawler.run(SCENE, elastic_modulus=1 - step).displacement) / (2 * step)
    gradient = crawler.gradient(SCENE, "Body/Elastic modulus")
    check(abs(gradient.derivatives[0] - slope) <= gradient.errors[0] + bound / step, "a derivative")
    check(crawler.check(SCENE) == ours.parameters and len(crawler.entries()) > 100, "check and entries")


def test_refusals(folder):
    """Scenes and calls that need a library which is left out."""
    table = folder / "table.h5"
    table.write_bytes(b"\x89HDF\r\n\x1a\n")
    calls = {
        "PETSc": lambda: crawler.run(SCENE, set={"Discretization/Mesh": "adaptive"}),
        "PETSc's time": lambda: crawler.batch([SCENE], set={"Discretization/Mesh": "adaptive"}),
        "shared object": lambda: crawler.run({"Active stress": {"Generator": "library", "Library": {"File": table}}}),
        "HDF5": lambda: crawler.run({"Active stress": {"Generator": "table", "Table": {"File": table}}}),
        "crawler.run": lambda: crawler.run(SCENE, output=folder / "run"),
        "crawler.sweep": lambda: crawler.sweep(SCENE, {"Body/Elastic modulus": [1, 2]}, output=folder / "sweep"),
        "crawler.optimize": lambda: crawler.optimize(SCENE, {"Body/Elastic modulus": (1, 2)})}
    for word, call in calls.items():
        try:
            problem = f"it is computed: {call()}"
        except crawler.InputError as error:
            problem = str(error)
        check(word in problem and INSTEAD in problem and "\n" not in problem, f"refused: {problem}")
    row = crawler.sweep(SCENE, {"Body/Elastic modulus": [1]}, set={"Discretization/Mesh": "adaptive"})
    check(row["status"][0] == "failed" and row["reason"][0] == "refused" and "PETSc" in row["message"][0], f"a row of a sweep: {row['message'][0]}")
    check(not (folder / "run").exists() and not (folder / "sweep").exists(), "no folder is left behind")


def test_commands():
    def call(*words):
        end = subprocess.run([sys.executable, "-m", "crawler", *words], capture_output=True, text=True, check=False)
        return end.returncode, end.stderr.strip()
    code, problem = call("run", SCENE)
    check(code == 2 and "full program" in problem and "\n" not in problem, f"refused: {problem}")
    check(crawler.needs.CHART_LIBRARIES[0].is_file(), "the wheel has Chart.js")
    try:
        import h5py  # noqa: F401
        code, problem = call("report", FOLDER, "--quiet")
        check(code == 0 and (pathlib.Path(FOLDER) / "report.html").stat().st_size > 10000, f"a report {problem}")
        import matplotlib  # noqa: F401
        code, problem = call("paper", FOLDER, "--output", pathlib.Path(FOLDER).parent / "paper")
        check(code == 0 and "displacement,length" in (pathlib.Path(FOLDER).parent / "paper/numbers.csv").read_text(encoding="utf-8"), f"a figure {problem}")
    except ImportError:
        code, problem = call("report", FOLDER)
        check(code != 0 and "has no h5py" in problem, f"without h5py: {problem}")


def main():
    warnings.simplefilter("error")
    check("site-packages" in crawler.__file__ and set(crawler.run(SCENE).versions) == {"crawler", "revision"}, f"the wheel is used: {crawler.__file__}")
    test_answers()
    test_formulas()
    test_scenes(PRM)
    with tempfile.TemporaryDirectory() as folder:
        test_refusals(pathlib.Path(folder))
    test_commands()
    return "\n".join(failures) or 0


if __name__ == "__main__":
    PRM = pathlib.Path(sys.argv[-1])
    if len(sys.argv) == 2:
        (PRM / "answers.json").write_text(json.dumps(answers(PRM)), encoding="utf-8")
        sys.exit()
    SCENE, FOLDER = sys.argv[1:3]
    sys.exit(main())
