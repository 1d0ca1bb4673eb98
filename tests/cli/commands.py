#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler run and check as their users see them: files, lines on the screen, exit codes and statuses.

    python3 commands.py PATH_TO_CRAWLER
"""
import math
import pathlib
import re
import sys
from xml.etree import ElementTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, contents, expect, prm, sets  # noqa: E402
from tables import summary_of  # noqa: E402

CRAWLER = pathlib.Path(sys.argv[1]).resolve()
SCENE = "# the default wave\n" + prm("Accuracy=1e-3", "Output/Number of snapshots=3")
OPTIMAL, EXPRESSION = "Active stress/Optimal wave/", "Active stress/Expression/"
BY_SPEED = OPTIMAL + "Choose wave by=wave speed"
# Keys of summary.json, which are a contract.
KEYS = "status reason displacement_error model seconds versions command_line".split()
NUMBERS = "displacement end_time cells degree degrees_of_freedom steps rejected_steps newton_iterations".split()
ENERGIES = "stress_power dissipation elastic_energy ledger_residual paper_energy positive_power net_friction".split()


def crawler(folder, *words, **more):
    return call([CRAWLER, *words], folder, **more)


def run(folder, *entries, options=(), text=SCENE, code=0):
    """Runs a parameter file with these entries into "results", and expects this exit code."""
    (folder / "scene.prm").write_text(text, encoding="utf-8")
    done = crawler(folder, "run", "scene.prm", "--output", "results", *options, *sets(entries))
    expect(done.returncode == code, f"{entries}, {options}: exit code {done.returncode}, {done.stderr}")
    return done


def read(file):
    return file.read_text(encoding="utf-8")


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def expect_words(text, *words):
    for word in words:
        expect(word in text, f'"{word}" is not in: {text}')


def expect_complete(summary, has_energies=True):
    """Every key is there, and what is known is a number."""
    missing = [key for key in KEYS if key not in summary]
    missing += [key for key in NUMBERS if not is_number(summary[key])]
    missing += [key for key in ENERGIES if not (is_number(summary[key]) if has_energies else summary[key] is None)]
    missing += [(key, part) for key in ("min_stretch", "max_stretch") for part in "value s t".split()
                if not is_number(summary[key][part])]
    missing += [part for part in ("total", "space", "time", "model") if part not in summary["displacement_error"]]
    missing += [part for part in ("setup", "solve", "output") if not is_number(summary["seconds"][part])]
    missing += [part for part in ("crawler", "deal.II", "PETSc") if part not in summary["versions"]]
    expect(not missing, f"summary.json: {missing}, {summary}")


def output_times(results):
    """Times that solution.pvd lists for the body; each file that it lists must be a whole one of VTK."""
    times = []
    for entry in ElementTree.parse(results / "solution.pvd").getroot().findall("Collection/DataSet"):
        if entry.get("name") == "body":
            times.append(float(entry.get("timestep")))
        kind = ElementTree.parse(results / entry.get("file")).getroot().get("type")
        expect(kind == "UnstructuredGrid", f"{entry.get('file')} is of the type {kind}")
    return times


def expect_output_times(results, wanted):
    times, n_files = output_times(results), len(list((results / "solution").iterdir()))
    expect(len(times) == len(wanted) and all(abs(a - b) < 1e-11 for a, b in zip(times, wanted)), f"output times {times}")
    # Body, grip and line; ground and scale; and nothing half-written.
    expect(n_files == 3 * len(wanted) + 2, f"{n_files} files of {len(wanted)} output times")


def statistics(results):
    """Rows of statistics.csv; every row is complete and every number finite."""
    head, *rows = [line.split(",") for line in read(results / "statistics.csv").splitlines()]
    rows = [[float(cell) for cell in row] for row in rows]
    expect(all(len(row) == len(head) and all(map(math.isfinite, row)) for row in rows), f"rows of {results}")
    return rows


def test_check(folder):
    """It lists the waves, of which several spend this energy, and writes nothing."""
    (folder / "scene.prm").write_text(SCENE, encoding="utf-8")
    before = contents(folder)
    done = crawler(folder, "check", "scene.prm", "--output", "results", "--set", OPTIMAL + "Energy=0.51")
    expect(done.returncode == 0 and done.stderr == "" and done.stdout.count("\n") >= 10, f"check: {done}")
    expect_words(done.stdout, "Model nonlinear", "Mesh: ", "index", "speed", "displacement", "<- chosen", "no files were written")
    expect(contents(folder) == before, "check writes files")


def test_files(folder):
    """A run writes every file."""
    results, done = folder / "results", run(folder)
    expect(done.stderr == "" and "results/solution.pvd" in done.stdout.splitlines()[-1], f"a run: {done}")
    expect(read(results / "original.prm") == SCENE and read(results / "log.txt") == done.stdout, "original.prm and log.txt")
    summary = summary_of(results)
    expect_complete(summary)
    expect((summary["status"], summary["reason"], summary["end_time"]) == ("finished", None, 1)
           and abs(summary["displacement"] - 0.0900726) < 1e-4
           and summary["command_line"] == "crawler run scene.prm --output results", f"summary.json: {summary}")

    head = read(results / "statistics.csv").splitlines()[0]
    expect(all(re.fullmatch(r"[a-z ]+ \[[a-z0-9/ ^]+\]", cell) for cell in head.split(",")), f"columns: {head}")
    rows = statistics(results)
    times = [row[1] for row in rows]
    expect(len(rows) == summary["steps"] + 1 + 2, f"{len(rows)} rows of {summary['steps']} steps; two snapshots are within steps")
    expect(times == sorted(times) and times[-1] == 1 and rows[-1][3] == summary["displacement"], f"the last row: {rows[-1]}")

    expect_output_times(results, [0, 1 / 3, 2 / 3, 1])
    kymograph = ElementTree.parse(results / "kymograph.vts").getroot()
    names = {array.get("Name") for array in kymograph.iter("DataArray")}
    expect(kymograph.get("type") == "StructuredGrid" and {"stretch", "velocity", "active_stress", "friction_force"} <= names,
           f"the kymograph has {names}")

    # The effective parameters give the same displacement, to the last bit.
    (folder / "again.prm").write_text(read(results / "parameters.prm"), encoding="utf-8")
    again = crawler(folder, "run", "again.prm")
    expect(again.returncode == 0 and summary_of(folder / "output-again")["displacement"] == summary["displacement"], f"again: {again}")


def test_files_without_a_mesh(folder):
    """They and their names are the same; fields are at 201 points."""
    waves = prm("Output/Number of snapshots=3", "Active stress/Generator=prescribed strain",
                "Active stress/Prescribed strain/Given by=wave")
    results, done = folder / "results", run(folder, "Model=auto", text=waves)
    expect_words(done.stdout, "Model kinematic: the strain is prescribed", "displacement      0.04606079858 +- ")
    expect(read(results / "log.txt") == done.stdout and read(results / "original.prm") == waves, "log.txt and original.prm")
    summary = summary_of(results)
    expect((summary["degree"], summary["model"], summary["cells"]) == (None, "kinematic", 0)
           and all(map(is_number, summary["displacement_error"].values())), f"summary.json: {summary}")
    expect_complete({**summary, "degree": 0})
    expect_output_times(results, [0, 1 / 3, 2 / 3, 1])
    rows = statistics(results)
    expect(len(rows) == 4 and abs(rows[-1][3] - summary["displacement"]) < 1e-10, f"{len(rows)} rows, the last one {rows[-1]}")
    expect_words(read(results / "kymograph.vts"), '"friction_force"')


def test_accuracy_not_met(folder):
    """A model that cannot meet Accuracy says so."""
    done = run(folder, "Model=perturbation", text=prm("Accuracy=1e-4"), code=3)
    expect(done.stderr.startswith("crawler: accuracy_not_met: the estimated error of the displacement is 0.01"), done.stderr)
    summary = summary_of(folder / "results")
    expect((summary["status"], summary["reason"], summary["positive_power"]) == ("failed", "accuracy_not_met", None)
           and abs(summary["displacement"] - 0.08) < 1e-15
           and summary["displacement_error"]["total"] >= 9.00725298e-2 - 0.08, f"summary.json: {summary}")


def test_overrides(folder):
    """They beat the file, the last one all others; and standard input is read."""
    done = crawler(folder, "run", "-", *sets(["Output/Number of snapshots=0", "Time/End time=2", "Time/End time = 0.5"]), input=SCENE)
    output = folder / "output-stdin"
    expect(done.returncode == 0 and summary_of(output)["end_time"] == 0.5 and read(output / "original.prm") == SCENE, f"overrides: {done}")
    expect(re.search(r"set End time += 0.5\b", read(output / "parameters.prm")), "parameters.prm has the override")
    expect(not any((output / name).exists() for name in ("solution", "solution.pvd", "kymograph.vts")), "there are no snapshots")
    expect(done.stdout.splitlines()[-1] == "Results are in output-stdin/.", done.stdout)


def test_places_of_files(folder):
    """A profile beside the file that an include names; what was run can be run again from anywhere."""
    scenes, results = folder / "scenes", folder / "results"
    scenes.mkdir()
    (scenes / "ground.csv").write_text("x,value\n-5,1\n0,2\n2,1.5\n5,1\n", encoding="utf-8")
    (scenes / "rough.prm").write_text(prm("Ground/Profile=ground.csv"), encoding="utf-8")
    run(folder, options=["--quiet"], text="include scenes/rough.prm\n" + SCENE)
    displacement = summary_of(results)["displacement"]
    again = crawler(scenes, "run", "../results/parameters.prm", "--output", "again")
    expect(again.returncode == 0 and summary_of(scenes / "again")["displacement"] == displacement, f"from another folder: {again}")
    run(folder, "Ground/Profile=scenes/ground.csv", options=["--quiet", "--overwrite"])
    expect(summary_of(results)["displacement"] == displacement, "--set counts from the current folder")


def test_byte_order_mark(folder):
    run(folder, options=["--quiet"], text="\ufeff" + SCENE)
    expect((folder / "results/summary.json").exists(), "a file with a byte order mark")


def test_minus_zero(folder):
    """Waves at p = 1 move nothing, by 0 and not by -0."""
    done = run(folder, "Body/Anchoring exponent=1")
    expect_words(done.stdout, "leading-order displacement 0,")
    for text in (done.stdout, *(read(folder / "results" / name) for name in ("log.txt", "statistics.csv"))):
        expect(not re.search(r"(^|[^a-z0-9.])-(0|0[.]0*|nan)([^0-9.]|$)", text, re.M), f"minus zero: {text}")


def test_notes(folder):
    """Tables beyond the body are in millimetres instead of metres, most likely. A cycle stop needs three cycles, and only
    one is in the scene; a series has no energy balance to check."""
    (folder / "skin.csv").write_text("s,value\n0,1\n1,2\n3,2\n4,1\n", encoding="utf-8")
    (folder / "m.csv").write_text("s,t,m\n0,0,0\n0,1,0.1\n4,0,0\n4,1,0.2\n", encoding="utf-8")
    tables = ("Body/Friction profile=skin.csv", "Active stress/Generator=table", "Active stress/Table/File=m.csv",
              "Active stress/Table/Interpolation=linear")
    strain = ("Active stress/Generator=prescribed strain", EXPRESSION + "Active stress=sin(s)")
    formula = ("Active stress/Generator=expression", EXPRESSION + "Active stress=A*sin(2*pi*(s+t))",
               EXPRESSION + "Constants=A = 0.1, B = 2")
    for lines, settings, *notes in (
            (tables, (), 'Note: the table of "Body/Friction profile" reaches to s = 4, but the body ends at 1',
             'Note: the table reaches to s = 4, but the body ends at 1; check "Active stress/Table/Unit'),
            (strain, ("Model=kinematic",), f'"{EXPRESSION}Active stress" has no effect with'),
            (formula, (), f'"B" of "{EXPRESSION}Constants" has no effect with'),
            (formula, (EXPRESSION + "Active stress=sin(2*pi*(s+t))/10",), f'"{EXPRESSION}Constants" has no effect with'),
            (formula, (EXPRESSION + "Constants=A = 0.1",)),
            (("Active stress/Table/File=/elsewhere/actuation.csv",), ()),
            (("Active stress/Table/File=/elsewhere/stress.csv",), (), '"Active stress/Table/File" has no effect'),
            ((), ("Active stress/Table/File=/elsewhere/actuation.csv",), '"Active stress/Table/File" has no effect'),
            ((BY_SPEED,), ("Time/Cycle stop=off",), '"Time/Cycle stop" has no effect'),
            ((BY_SPEED,), ("Time/Cycle stop=off", "Time/End time=4")),
            ((BY_SPEED,), ("Time/Cycle stop=off", "Time/End time=4", "Time/Step control=fixed", "Time/Initial step=0.1"),
             '"Time/Cycle stop" has no effect'),
            ((BY_SPEED,), ("Output/Ledger tolerance=0.1", "Model=perturbation"), '"Output/Ledger tolerance" has no effect'),
            ((BY_SPEED,), ("Output/Ledger tolerance=0.1", "Model=nonlinear")),
            ((BY_SPEED,), ("Time/Engine=petsc", "Time/Integrator=bdf"), '"Time/Engine" has no effect'),
            ((BY_SPEED,), ("Time/Engine=petsc",))):
        done = crawler(folder, "check", "-", *sets(settings), input=SCENE + prm(*lines))
        expect(done.returncode == 0 and (notes or "has no effect" not in done.stdout), f"{lines}, {settings}: {done}")
        expect_words(done.stdout, *notes)


def test_quiet(folder):
    done = run(folder, options=["--quiet"])
    expect(done.stdout + done.stderr == "", f"--quiet prints {done}")
    expect_words(read(folder / "results/log.txt"), "Finished at t = 1")


def test_overwrite(folder):
    """It replaces own files only."""
    results = folder / "results"
    run(folder, options=["--quiet"])
    (results / "notes.txt").write_text("mine\n", encoding="utf-8")
    (results / "solution/figure.png").write_text("mine too\n", encoding="utf-8")
    run(folder, options=["--quiet"], code=2)

    def replace(entries, *gone):
        run(folder, *entries, options=["--quiet", "--overwrite"])
        expect(not any((results / name).exists() for name in gone), f"{gone} of the run before are left behind {entries}")

    replace(["Output/Number of snapshots=1", "Output/Statistics=false"], "solution/000002.vtu", "statistics.csv")
    expect(output_times(results) == [0, 1], "output times of the second run")
    replace(["Output/Snapshot format=xdmf"], "solution.pvd", "line.pvd", "solution/000000.vtu")
    replace([], "solution.xdmf", "line.xdmf", "solution.h5")
    expect(read(results / "notes.txt") == "mine\n" and read(results / "solution/figure.png") == "mine too\n", "files of others stay")


def test_without_energies(folder):
    run(folder, "Output/Ledger=false")
    expect_complete(summary_of(folder / "results"), has_energies=False)
    expect("dissipation" not in read(folder / "results/statistics.csv"), "works that nobody wants")


def test_numerics_of_the_user(folder):
    done = run(folder, "Discretization/Degree=3", "Discretization/Number of cells=17", "Time/Tolerance=1e-7")
    summary = summary_of(folder / "results")
    expect([summary[key] for key in ("degree", "cells", "degrees_of_freedom")] == [3, 17, 52], f"summary.json: {summary}")
    expect_words(done.stdout, "tolerance 1e-07")


def test_unused_petsc_options(folder):
    """They are reported."""
    warning = "warning: nothing used the PETSc option -ts_adapt_clp\n"
    done = run(folder, options=["--set", "Output/Statistics=false", "--", "-ts_adapt_clp", "0.1;2", "-ts_type", "bdf"])
    summary = summary_of(folder / "results")
    expect(done.stderr == "crawler: " + warning and warning in read(folder / "results/log.txt"), f"an unused option: {done}")
    expect(summary["integrator"] == "bdf" and summary["command_line"] == "crawler run scene.prm --output results "
           "--set Output/Statistics=false -- -ts_adapt_clp '0.1;2' -ts_type bdf", f"summary.json: {summary}")
    (folder / "scene.prm").write_text(SCENE + prm("Sweep/Axes=Body/Elastic modulus : 1, 2"), encoding="utf-8")
    sweep = crawler(folder, "sweep", "scene.prm", "--quiet", "--", "-ts_adapt_clp", "-1", "-ts_max_snes_failures", "3")
    expect(sweep.returncode == 0 and sweep.stderr == "crawler: " + warning, f"an unused option of a sweep: {sweep}")


def test_options_of_the_krylov_method(folder):
    """Feedback from elsewhere is solved by GMRES, whose tolerance the user may set."""
    text = prm("Active stress/Generator=strain feedback", "Active stress/Strain feedback/Active stress=0.1*s*t*w_near",
               "Active stress/Strain feedback/Distance=0.3")
    answers = set()
    for options in ([], ["--", "-ksp_rtol", "1e-10"]):
        run(folder, text=text, options=["--overwrite", *options])
        answers.add(summary_of(folder / "results")["displacement"])
    expect(len(answers) == 2, f"displacements with and without -ksp_rtol: {answers}")


def test_inversion_of_the_position_form(folder):
    """For -1 < a < 0 only the stretch form is believed when it says that a body inverts."""
    done = run(folder, BY_SPEED, OPTIMAL + "Wave speed=1", OPTIMAL + "Perturbation parameter=0.7", "Body/Anchoring exponent=1.5",
               "Discretization/Formulation=position", code=3)
    summary = summary_of(folder / "results")
    expect_words(done.stderr, "Discretization/Formulation = stretch")
    expect((summary["reason"], summary["inversion"]) == ("under_resolved", None), f"summary.json: {summary}")


def test_last_row_of_an_inversion(folder):
    """Statistics end with the answer, and pictures go on until the body inverts."""
    run(folder, "Output/Number of snapshots=64", "Active stress/Generator=travelling wave",
        "Active stress/Travelling wave/Amplitude=1.2", code=4)
    summary, row = summary_of(folder / "results"), statistics(folder / "results")[-1]
    expect(summary["status"] == "inverted" and math.isclose(row[1], summary["end_time"], rel_tol=1e-15)
           and math.isclose(row[3], summary["displacement"], rel_tol=1e-15), f"the last row: {row}, {summary}")
    expect(output_times(folder / "results")[-1] > summary["end_time"], "pictures until the body inverts")


def test_files_of_the_other_form(folder):
    """An answer that the position form gives in place of the stretch form is the one that the files show."""
    run(folder, BY_SPEED, "Accuracy=2e-8", "Body/Elastic modulus=1e-3", "Body/Anchoring exponent=4.5", OPTIMAL + "Wave speed=1.3",
        OPTIMAL + "Perturbation parameter=0.25")
    summary, row = summary_of(folder / "results"), statistics(folder / "results")[-1]
    expect(summary["formulation"] == "position" and row[0] > 100 and abs(row[3] - summary["displacement"]) <= summary["displacement_error"]["total"],
           f"the last row: {row}, {summary}")


def test_inversion(folder):
    """With a = 1 and chi = 0.6 the body really inverts, inside, near t = 0.308 (ends: verification/extremes_test.cc)."""
    done = run(folder, BY_SPEED, OPTIMAL + "Wave speed=-1", OPTIMAL + "Perturbation parameter=0.6", "Body/Anchoring exponent=0",
               "Output/Number of snapshots=10", code=4)
    results = folder / "results"
    expect(done.stderr.count("\n") == 1 and "the body inverted" in done.stderr, done.stderr)
    summary = summary_of(results)
    expect_complete(summary)
    expect((summary["status"], summary["reason"]) == ("inverted", "inverted_inside")
           and abs(summary["inversion"]["t"] - 0.30812) < 1e-3 and abs(summary["inversion"]["s"] - 0.667) < 0.01
           and summary["min_stretch"]["value"] > 0, f"no inverted state is counted: {summary}")
    expect(all(row[4] > 0 for row in statistics(results)), "stretches of statistics.csv are positive")
    expect_output_times(results, [0, 0.1, 0.2, 0.3])
    ElementTree.parse(results / "kymograph.vts")


def test_exit_codes(folder):
    """They agree with the status, and both with the message."""
    for entries, code, status, reason in (
            (["Time/Maximum number of steps=3"], 5, "stopped", "step_limit"),
            (["Output/Ledger tolerance=1e-15"], 7, "failed", "ledger_residual"),
            (["Active stress/Generator=expression", EXPRESSION + "Active stress=0.1*s*t + 0*sqrt((t-0.58)^2-1e-4)",
              "Output/Number of snapshots=50"], 3, "failed", "nonfinite")):  # a step ends at 0.58
        done = run(folder, *entries, options=["--quiet", "--overwrite"], code=code)
        summary = summary_of(folder / "results")
        expect_complete(summary)
        expect((summary["status"], summary["reason"]) == (status, reason), f"summary.json: {summary}")
        expect(done.stderr.count("\n") == 1 and done.stderr.startswith(f"crawler: {reason}: ") and summary["message"] in done.stderr,
               f"{reason}: {done.stderr}")
        expect(("Stopped at t = " in read(folder / "results/log.txt")) == (status == "stopped"), f"log.txt of {reason}")
        statistics(folder / "results")


checks.run((test_check, test_files, test_files_without_a_mesh, test_accuracy_not_met, test_overrides, test_places_of_files,
            test_byte_order_mark, test_minus_zero, test_notes, test_quiet, test_overwrite, test_without_energies,
            test_numerics_of_the_user, test_unused_petsc_options, test_options_of_the_krylov_method,
            test_inversion_of_the_position_form, test_last_row_of_an_inversion, test_files_of_the_other_form, test_inversion,
            test_exit_codes))
