#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler optimize: the numbers of doc/theory.md ("Gait efficiency"), the bound that no evaluation exceeds, gradients,
a study that is killed and resumed, ranks, and answers to bad input.

    python3 optimize.py PATH_TO_CRAWLER PATH_TO_PRM MPIEXEC...
"""
import csv
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

CRAWLER, PRM, MPIEXEC = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:]
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
MODES = "Active stress/Modes/"
EIGHT = [MODES + "Harmonics=8", "Optimize/Variables=" + MODES + "Coefficients[1-17] : -1 to 1"]
failures = []


def expect(condition, what):
    """Notes what is wrong."""
    if not condition:
        failures.append(what)


def run(study, folder, *settings, options=(), ranks=1):
    """The finished process; the study is the name of one in prm/studies."""
    command = (MPIEXEC + ["-n", str(ranks)] if ranks > 1 else []) + [CRAWLER, "optimize", str(PRM / (study + ".prm"))]
    for setting in settings:
        command += ["--set", setting]
    return subprocess.run(command + ["--output", str(folder), *options], env=ENVIRONMENT, capture_output=True, text=True,
                          timeout=300)


def summary(folder):
    return json.loads((folder / "summary.json").read_text())


def rows(folder):
    with open(folder / "results.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def merits(folder):
    """No merit is above the bound for strains of at most 0.3 and a = -1, where they are admissible."""
    bound = 0.7 ** 0.5 - 1.3 ** 0.5
    return [float(row["objective"]) / abs(bound) for row in rows(folder)
            if row["objective"] and float(row["violation"]) < 1e-5]


with tempfile.TemporaryDirectory() as place:
    place = pathlib.Path(place)

    # Best merits. The references, 0.22619, 0.25105 and 0.27819, exceed their limits of strain by about 1e-5.
    for name, settings, reference in [("two", [], 0.22618),
                                      ("three", [MODES + "Harmonics=3",
                                                 "Optimize/Variables=" + MODES + "Coefficients[1-7] : -1 to 1"], 0.25104),
                                      ("eight", EIGHT, 0.27818)]:
        done = run("optimize_harmonics", place / name, *settings)
        expect(done.returncode == 0, f"{name} harmonics: exit code {done.returncode}: {done.stderr}")
        best = summary(place / name)
        optimum = best["optimize"]["optima"][0]
        expect(optimum["objective"] >= reference, f"{name} harmonics: merit {optimum['objective']}, wanted {reference}")
        expect(best["min_stretch"]["value"] >= 0.7 - 1e-5 and best["max_stretch"]["value"] <= 1.3 + 1e-5,
               f"{name} harmonics: stretch {best['min_stretch']} to {best['max_stretch']}")
        expect(0.7 < best["gait"]["efficiency"] < 1, f"{name} harmonics: efficiency {best['gait']['efficiency']}")
        merit = best["displacement"] / math.sqrt(best["stress_power"])
        expect(abs(merit - optimum["objective"]) < 1e-6, f"{name} harmonics: the run gives the merit {merit}")
        expect(max(merits(place / name)) <= 1, f"{name} harmonics: an evaluation is better than any gait can be")
        parts = [float(row["efficiency"]) for row in rows(place / name) if row["efficiency"]]
        expect(len(parts) > 100 and max(parts) <= 1 and abs(max(parts) - best["gait"]["efficiency"]) < 0.05,
               f"{name} harmonics: efficiencies up to {max(parts)}")

    # The optimum is a parameter file that runs.
    again = subprocess.run([CRAWLER, "run", str(place / "two" / "optimum.prm"), "--output", str(place / "again")],
                           env=ENVIRONMENT, capture_output=True, text=True, timeout=60)
    expect(again.returncode == 0 and summary(place / "again")["displacement"] == summary(place / "two")["displacement"],
           "optimum.prm does not give the displacement of the summary")

    # The theorem: a travelling wave, D = 1e-4 to leading order, and one more part of either limit brings half a part.
    done = run("optimize_theorem", place / "theorem")
    optimum = summary(place / "theorem")["optimize"]["optima"][0]
    expect(abs(optimum["objective"] - 1e-4) < 1e-6, f"theorem: displacement {optimum['objective']}")
    for limit in ("Work", "Mean-square strain"):
        expect(abs(optimum["limits"][limit]["multiplier"] - 0.5) < 0.01, f"theorem: {limit} {optimum['limits'][limit]}")

    # Robots, by simulations.
    done = run("optimize_robot", place / "robot")
    expect(done.returncode == 0, f"robot: exit code {done.returncode}: {done.stderr}")
    expect(summary(place / "robot")["displacement"] > 0.0669, f"robot: {summary(place / 'robot')['displacement']}")

    # Several limits of work and starts, on one rank and on two, killed and resumed: the same table.
    budgets = ["Sweep/Axes=Optimize/Work : 0.001, 0.003", "Optimize/Objective=displacement", "Optimize/Starts=3"]
    run("optimize_harmonics", place / "one", *budgets)
    optima = summary(place / "one")["optimize"]["optima"]
    limits = [o["case"]["Optimize/Work"] for o in optima]
    expect(limits == [0.001, 0.003], f"budgets: {optima}")
    expect(all(o["stress_power"] <= limit * (1 + 1e-5) for o, limit in zip(optima, limits)), f"budgets: {optima}")
    expect([o["number"] for o in optima] == [1, 2] and (place / "one" / "best-2" / "summary.json").exists(), "cases")
    with open(place / "one" / "optima.csv", encoding="utf-8") as file:
        table = list(csv.DictReader(file))
    expect([float(row["displacement"]) for row in table] == [o["objective"] for o in optima], f"optima.csv: {table}")
    single = run("optimize_harmonics", place / "single", *budgets[1:], "Optimize/Work=0.003")
    expect(single.returncode == 0 and summary(place / "single")["optimize"]["optima"][0]["objective"]
           == optima[1]["objective"], "a case has another optimum than the same alone")

    # Cases that differ in words, numbers and lists, with starts and variables of their own: the best of each is better
    # with more segments, and for a = 1 it is the mirror image of a wave.
    cases = run("optimize_robot", place / "cases", "Sweep/Design=zip", "Optimize/Variables=Active stress/Segments/Phase lag"
                " : 0.02 to 0.45", "Sweep/Axes=Active stress/Segments/Number of segments : 4, 8, 8; Active stress/Segments/"
                "Phase lag : 0.25, 0.125, 0.125; Body/Anchoring exponent : 2, 2, 0; Optimize/Direction : forward, forward,"
                " backward", "Optimize/Tolerance=1e-3")
    expect(cases.returncode == 0, f"cases: {cases.stderr}")
    found = [o["objective"] for o in summary(place / "cases")["optimize"]["optima"]]
    expect(0.05 < found[0] < found[1] < 0.07 and -0.08 < found[2] < -0.07, f"cases: {found}")
    text = (place / "cases" / "optimum-3.prm").read_text()
    expect("set Direction" in text and "8, 8" not in text, "an optimum has the axes of the study")

    # Of a gait that repeats the elastic energy of its start does not count.
    done = run("optimize_segments", place / "periodic", "Sweep/Axes=")
    best = summary(place / "periodic")
    expect(done.returncode == 0 and best["optimize"]["optima"][0]["objective"] > 0.1265, f"periodic: {done.stderr}")
    expect(0.83 < best["gait"]["stride_efficiency"] < 0.87 and best["gait"]["efficiency"] < 0.2, f"{best['gait']}")
    expect(run("optimize_harmonics", place / "both", *budgets, ranks=2).returncode == 0, "two ranks")
    without_times = [[{k: v for k, v in row.items() if k != "seconds"} for row in rows(place / folder)]
                     for folder in ("one", "both")]
    expect(without_times[0] == without_times[1], "two ranks have another table")
    command = [CRAWLER, "optimize", str(PRM / "optimize_harmonics.prm"), "--output", str(place / "killed")]
    for setting in budgets:
        command += ["--set", setting]
    process = subprocess.Popen(command, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    limit = time.monotonic() + 60
    while process.poll() is None and time.monotonic() < limit and not list((place / "killed" / "starts").glob("*.json")):
        time.sleep(0.005)
    process.send_signal(signal.SIGKILL)
    process.wait()
    expect(run("optimize_harmonics", place / "killed", *budgets, options=["--resume"]).returncode == 0, "resume")
    expect(rows(place / "killed") == rows(place / "one"), "a resumed study has another table")
    refused = run("optimize_harmonics", place / "one", "Optimize/Largest strain=0.2", options=["--resume"])
    expect(refused.returncode == 2 and "Optimize/Largest strain was" in refused.stderr, f"resume: {refused.stderr}")

    # A time limit ends with the best so far.
    stopped = run("optimize_from_rest", place / "stopped", "Optimize/Time limit=4")
    expect(stopped.returncode == 5 and summary(place / "stopped")["optimize"]["status"] == "stopped"
           and (place / "stopped" / "best" / "summary.json").exists(),
           f"time limit: exit code {stopped.returncode}, {stopped.stderr}")

    # Starts that cannot be computed are rows; one that does not move and cannot say where to go is no optimum.
    run("optimize_harmonics", place / "starts", "Optimize/Starts=4", "Optimize/Start spread=1")
    with open(place / "starts" / "starts.csv", encoding="utf-8") as file:
        starts = list(csv.DictReader(file))
    expect(len(starts) == 4 and any("invert" in start["problem"] or "-1 is expected" in start["problem"]
                                    for start in starts), f"starts that invert: {starts}")
    still = run("optimize_harmonics", place / "still", MODES + "In time=harmonics", MODES + "Coefficients=0, 0.1, 0.1",
                "Optimize/Work=0.1", "Optimize/Objective=displacement")
    expect(still.returncode == 3 and "does not move" in still.stdout, f"start at rest: {still.stdout}{still.stderr}")

    # The check says what the starts give.
    for settings, words in [([], "keeps to all limits"), (["Sweep/Axes=Optimize/Largest strain : 0.3, 0.1"],
                                                          "with Largest strain = 0.1: merit 0.145"),
                            (["Optimize/Largest strain=0.1"], "exceeds a limit by")]:
        command = [CRAWLER, "check", str(PRM / "optimize_harmonics.prm")]
        for setting in settings:
            command += ["--set", setting]
        check = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, timeout=60)
        expect(check.returncode == 0 and words in check.stdout and "is in order" in check.stdout,
               f"check {settings}: {check.stdout}{check.stderr}")

    # Gradients.
    for study, settings in [("optimize_harmonics", []), ("optimize_harmonics", ["Optimize/Work=0.01",
                            "Optimize/Mean-square strain=0.01", "Optimize/Largest stress=1"]),
                            ("optimize_theorem", []), ("optimize_robot", []), ("optimize_uneven", ["Sweep/Axes="]),
                            ("optimize_segments", []), ("optimize_actuators", ["Sweep/Axes=Active stress/Segments/Number of segments : 2",
                                                                           "Active stress/Segments/Phase lag=0.25",
                                                                           "Optimize/Smallest strain=-0.2"]),
                            ("optimize_harmonics", ["Body/Friction profile=0.5+s", "Body/Elastic modulus profile=1.5-s",
                                                    "Ground/Friction law=Newtonian", "Optimize/Positive work=1"])]:
        done = run(study, place / "nothing", *settings, options=["--check-gradient"])
        expect(done.returncode == 0, f"gradient of {study}: {done.stdout}{done.stderr}")
        expect(done.stdout.count("is allowed") >= (3 if study == "optimize_actuators" else 1),
               f"gradient of {study}: too little was compared: {done.stdout}")
    expect(not (place / "nothing").exists(), "--check-gradient writes files")

    # On a body that is not the same everywhere, the strain being given: the run agrees, and there is no bound.
    uneven = run("optimize_harmonics", place / "uneven", "Body/Friction profile=1.5-s", "Body/Elastic modulus profile=1+s")
    best = summary(place / "uneven")
    merit = best["displacement"] / math.sqrt(best["stress_power"])
    expect(uneven.returncode == 0 and abs(merit - best["optimize"]["optima"][0]["objective"]) < 1e-6 and merit > 0.2
           and best["gait"]["efficiency"] is None and "efficiency" not in rows(place / "uneven")[0],
           f"a body with profiles: merit {merit}, {uneven.stdout}{uneven.stderr}")

    # The range says little of how large a variable is; and what has no adjoint is not compared with itself.
    lag, robot = "Active stress/Segments/Phase lag", "Active stress/Segments/Amplitude"
    wide = run("optimize_robot", place / "nothing", f"Optimize/Variables={robot} : 0.01 to 1000", options=["--check-gradient"])
    expect(wide.returncode == 0 and "allowed" in wide.stdout, f"gradient in a wide range: {wide.stdout}{wide.stderr}")
    rough = run("optimize_robot", place / "nothing", f"Optimize/Variables={lag} : 0.1 to 0.2", "Time/Engine=petsc",
                options=["--check-gradient"])
    expect(rough.returncode == 0 and "nothing to compare" in rough.stdout, f"without adjoint: {rough.stdout}{rough.stderr}")

    # What holds a gait back is said: friction that no gait can use, a body that all but inverts.
    flat = run("optimize_robot", place / "flat", "Sweep/Axes=Body/Anchoring exponent : 1", f"Optimize/Variables={lag} : 0.1 to 0.2")
    expect(flat.returncode == 3 and "no gait moves the body" in flat.stdout and "There is no picture" not in flat.stdout,
           f"a = 0: {flat.stdout}{flat.stderr}")
    strong = run("optimize_robot", place / "strong", f"Optimize/Variables={robot} : 0.1 to 0.95", "Optimize/Tolerance=1e-2",
                 "Active stress/Segments/Switching=smooth", "Active stress/Segments/Rate limit=automatic")
    expect("Optimize/Smallest strain sets one" in strong.stdout, f"near inversion: {strong.stdout}{strong.stderr}")

    # Beside inversion the optimiser cannot go on, which is no optimum; from rest with a limit on work alone it can.
    brink = run("optimize_robot", place / "brink", f"{robot}=1.5", f"Optimize/Variables={lag} : 0.02 to 0.45; "
                "Active stress/Segments/Duty cycle : 0.2 to 0.8", "Active stress/Segments/Rate limit=1.5")
    expect(brink.returncode == 3 and "better gaits are impossible: inverted" in brink.stdout,
           f"beside inversion: {brink.returncode}, {brink.stdout}{brink.stderr}")
    free = run("optimize_tradeoff", place / "free", "Optimize/Smallest strain=automatic", "Sweep/Axes=", "Optimize/Work=0.01",
               "Optimize/Largest strain=automatic", "Optimize/Starts=1")
    expect(free.returncode == 0 and summary(place / "free")["displacement"] > 0.022,
           f"work alone: {free.returncode}, {free.stdout}{free.stderr}")

    # Words and numbers that go together; a limit that is exceeded has a name; a start without work; a damaged file.
    pairs = run("optimize_harmonics", place / "pairs", "Sweep/Design=zip", f"Sweep/Axes={MODES}Harmonics : 1, 2; {MODES}"
                'Coefficients : "0, 0.2, 0.001", "0, 0.2, 0.001, 0.01, 0.02"')
    found = [o["objective"] for o in summary(place / "pairs")["optimize"]["optima"]] if pairs.returncode == 0 else []
    expect(len(found) == 2 and abs(found[0] - 0.21462) < 1e-4 and abs(found[1] - 0.22618) < 1e-4,
           f"pairs: {found}, {pairs.stderr}")
    against = run("optimize_robot", place / "against", "Optimize/Largest stress rate=1e-3", "Optimize/Most iterations=2",
                  f"Optimize/Variables={lag} : 0.1 to 0.2")
    expect(against.returncode == 3 and "Largest stress rate is EXCEEDED" in against.stdout
           and summary(place / "against")["optimize"]["optima"][0]["exceeded_limit"] == "Largest stress rate",
           f"an empty set: {against.stdout}{against.stderr}")
    nothing = run("optimize_harmonics", place / "zero", MODES + "Coefficients=0, 0, 0, 0, 0")
    expect(nothing.returncode == 3 and "its work is 0" in nothing.stderr and "nan" not in nothing.stdout,
           f"a start without work: {nothing.stdout}{nothing.stderr}")
    (place / "pairs" / "starts" / "2-0.json").write_text('{"case": ')
    damaged = run("optimize_harmonics", place / "pairs", "Sweep/Design=zip", f"Sweep/Axes={MODES}Harmonics : 1, 2; {MODES}"
                  'Coefficients : "0, 0.2, 0.001", "0, 0.2, 0.001, 0.01, 0.02"', options=["--resume"])
    expect(damaged.returncode == 2 and "2-0.json" in damaged.stderr and damaged.stderr.count("\n") == 1,
           f"a damaged file: {damaged.returncode}, {damaged.stderr}")

    # Bad input.
    no_limit = ["Optimize/Smallest strain=automatic", "Optimize/Largest strain=automatic"]
    for settings, words in [(["Optimize/Variables="], "Variables is empty"),
                            (["Optimize/Variables=Body/Lenght : 1 to 2"], "nearest name is \"Body/Length\""),
                            (["Optimize/Variables=Active stress/Modes/Harmonics : 1 to 2"], "is a whole number"),
                            (["Optimize/Variables=Body/Length : 2 to 3"], "in its range, from 2 to 3"),
                            (["Optimize/Variables=Body/Length : 1 to 1"], "increasing numbers"),
                            (["Optimize/Variables=Body/Length : -1 to 2"], "positive number"),
                            (["Optimize/Variables=Body/Length"], "FROM to TO"),
                            (["Optimize/Variables=" + MODES + "Coefficients[0] : -1 to 1"], "from 1 to"),
                            (["Optimize/Variables=Body/Length : 1e-9 to 1e300"], "narrower"),
                            (["Optimize/Work=0"], "positive number"),
                            (["Optimize/Work=0.1, 0.2"], "positive number"),
                            (["Sweep/Axes=Optimize/Objective : merit, speed"], "the same for all cases"),
                            (["Sweep/Axes=Body/Lenght : 1, 2"], "nearest name is \"Length\""),
                            (["Sweep/Axes=Active stress/Modes/Coefficients[2] : 0.2, 3"], "expected in its range"),
                            (no_limit, "has no maximum"),
                            (["Model=perturbation"], "perturbation")]:
        bad = run("optimize_harmonics", place / "bad", *settings)
        expect(bad.returncode == 2 and words in bad.stderr and bad.stderr.count("\n") == 1,
               f"{settings}: exit code {bad.returncode}: {bad.stderr}")
    expect(not (place / "bad").exists(), "bad input leaves a folder")

sys.exit("\n".join(failures) or 0)
