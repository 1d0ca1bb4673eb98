#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Output/Sensitivities of crawler run: derivatives against differences of runs, what is named instead of one, answers to
bad input, and the picture.

    python3 sensitivities.py PATH_TO_CRAWLER
"""
import pathlib
import sys

import matplotlib.image
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect, prm, refused, sets  # noqa: E402
from tables import csv_rows, json_of  # noqa: E402

PLOT = pathlib.Path(__file__).resolve().parents[2] / "contrib/python/crawler/plot" / "sensitivity.py"
WAVE = prm("Accuracy=1e-6", "Active stress/Optimal wave/Perturbation parameter=0.3",
           "Active stress/Optimal wave/Choose wave by=wave speed", "Output/Number of snapshots=0")
ROBOT = prm("Active stress/Generator=segments", "Active stress/Segments/Number of segments=4",
            "Active stress/Segments/Phase lag=0.25", "Active stress/Segments/Ramp duration=0.5",
            "Output/Number of snapshots=0")
STRAIN = prm("Model=auto", "Accuracy=1e-6", "Active stress/Generator=prescribed strain",
             "Active stress/Prescribed strain/Given by=wave", "Output/Number of snapshots=0")
K, P, CHI = "Body/Elastic modulus", "Body/Anchoring exponent", "Active stress/Optimal wave/Perturbation parameter"


def crawler(folder, text, *settings, stop_at=None):
    """Runs a parameter file; the result of the process and the summary, if there is one."""
    file = folder / "scene.prm"
    file.write_text(text, encoding="utf-8")
    output = folder / "output"
    result = call([sys.argv[1], "run", file, "--output", output, "--overwrite", *sets(settings)], stop_at=stop_at)
    summary = output / "summary.json"
    return result, json_of(summary) if summary.exists() else None


def answers_without_adjoint(folder):
    """Differences of answers, where there is no adjoint: they agree with it where one is known."""
    T = "Time/End time"
    wanted = f"Output/Sensitivities={K}, {P}, {CHI}, {T}"
    _, summary = crawler(folder, WAVE, wanted)
    exact = summary["sensitivities"]
    for way in ("Time/Integrator=bdf", "Discretization/Mesh=adaptive", "Discretization/Formulation=stretch"):
        result, summary = crawler(folder, WAVE, way, "Accuracy=1e-4" if "stretch" in way else "Accuracy=1e-6", wanted)
        expect(result.returncode == 0, f"sensitivities with {way}: {result.stderr}")
        for entry, found in summary["sensitivities"].items():
            for number in (None, "stress_power", "dissipation"):
                one, other = (found, exact[entry]) if number is None else (found[number], exact[entry][number])
                expect(one["value"] is not None and abs(one["value"] - other["value"]) <= one["error"] + other["error"],
                       f"{way}, {number or 'displacement'} by {entry}: {one} and {other}")
    # k has no effect at a = 0, and D = 0; that by p is not.
    _, summary = crawler(folder, WAVE, f"{P}=1", wanted)
    for entry, found in summary["sensitivities"].items():
        expect(found["value"] is not None and (entry == P) == (abs(found["value"]) > 1e-9), f"a = 0: {entry}: {found}")
    # A soft body, in the stretch form; by chi against two runs.
    soft = ("Body/Elastic modulus=1e-3", "Accuracy=1e-4")
    _, summary = crawler(folder, WAVE, *soft, f"Output/Sensitivities={CHI}")
    found, chi = summary["sensitivities"][CHI], 0.3
    sides = [crawler(folder, WAVE, *soft, f"{CHI}={chi + d}")[1] for d in (-0.02, 0.02)]
    difference = (sides[1]["displacement"] - sides[0]["displacement"]) / 0.04
    expect(abs(found["value"] - difference) < 0.02 * abs(difference) and found["error"] < 0.02 * abs(difference),
           f"a soft body: {found}, but {difference} by runs")
    # A kink beside the value, that both differences jump over.
    _, summary = crawler(folder, WAVE, "Body/Elastic modulus=1000", f"{CHI}=0.4995", "Accuracy=1e-4",
                         "Discretization/Formulation=stretch", f"Output/Sensitivities={CHI}")
    found = summary["sensitivities"][CHI]
    expect(found["value"] is None or abs(found["value"] - 2.2376) <= found["error"], f"beside a kink: {found}")
    # A signal comes while they are computed: the first one is known, and the second one is not.
    result, summary = crawler(folder, WAVE, "Time/Integrator=bdf", "Accuracy=1e-4", f"Output/Sensitivities={K}, {P}",
                              stop_at="step:1000:INT")
    expect(result.returncode == 5 and summary["status"] == "stopped" and summary["displacement"] is not None,
           f"stopped while sensitivities are computed: {result.returncode}, {summary['status']}")
    expect(summary["sensitivities"][K]["value"] is not None and "stopped" in summary["sensitivities"][P]["reason"],
           f"stopped while sensitivities are computed: {summary['sensitivities']}")


def with_a_given_strain(folder):
    """At the kinematic level: D = 1 - sqrt(1 - A^2) for a = -1 and the strain A sin 2 pi(s+t), whatever k is."""
    amplitude = "Active stress/Prescribed strain/Amplitude"
    result, summary = crawler(folder, STRAIN, f"Output/Uncertainty={amplitude} : 0.01; {K} : 5 %")
    expect(result.returncode == 0 and summary["model"] == "kinematic", f"a given strain: {result.stderr}")
    by_amplitude, by_k = (summary["sensitivities"][entry] for entry in (amplitude, K))
    exact = 0.3 / (1 - 0.3 ** 2) ** 0.5
    expect(abs(by_amplitude["value"] - exact) <= by_amplitude["error"] < 1e-3 * exact,
           f"displacement by the amplitude: {by_amplitude}, exact {exact}")
    expect(abs(by_k["value"]) <= by_k["error"] < 1e-5, f"displacement by k: {by_k}")
    expect(abs(summary["uncertainty"]["displacement"] - 0.01 * exact) < 1e-5, f"uncertainty: {summary['uncertainty']}")


def main(folder):
    result, summary = crawler(folder, WAVE, "Output/Sensitivities=all")
    expect(result.returncode == 0, f"a run with sensitivities ended with {result.returncode}: {result.stderr}")
    found = summary["sensitivities"]
    for entry, value in ((K, 1.0), (P, 2.0), (CHI, 0.3)):
        step = 0.002 * value
        moved = [crawler(folder, WAVE, "Accuracy=1e-9", f"{entry}={value + i * step}")[1]["displacement"]
                 for i in (-1, 1)]
        by_difference = (moved[1] - moved[0]) / (2 * step)
        one = found[entry]
        expect(abs(one["value"] - by_difference) < 1e-4 * abs(by_difference) + one["error"],
               f"{entry}: {one['value']} +- {one['error']}, but differences of runs are {by_difference}")
        expect(abs(one["elasticity"] - one["value"] * value / summary["displacement"]) < 1e-12, f"{entry}: elasticity")
        expect(entry in result.stdout, f"{entry} is not on the screen")
    for number in ("stress_power", "dissipation", "positive_power", "paper_energy", "gait.displacement", "gait.speed"):
        expect(found[K][number]["error"] > 0, f"{number} has no derivative by {K}")

    _, summary = crawler(folder, WAVE, f"Output/Uncertainty={K} : 5 %; {P} : 0.2")
    by_hand = np.hypot(0.05 * found[K]["value"], 0.2 * found[P]["value"])
    expect(abs(summary["uncertainty"]["displacement"] - by_hand) < 1e-9 * by_hand,
           f"the uncertainty is {summary['uncertainty']}, but {by_hand} by hand")
    expect(set(summary["sensitivities"]) == {K, P}, f"uncertain entries: {list(summary['sensitivities'])}")
    sizes = [abs(one["elasticity"]) for one in found.values() if one["elasticity"] is not None]
    expect(sizes[:5] == sorted(sizes, reverse=True)[:5], "what matters most is not first")

    crawler(folder, WAVE, "Output/Sensitivities=" + K)
    output = folder / "output"
    columns = list(csv_rows(output / "sensitivity_body.csv")[0])
    expect(columns == ["s [length]", "elastic modulus [1]", "friction [1]"], f"sensitivity_body.csv has {columns}")
    plot = call([sys.executable, PLOT, output])
    expect(plot.returncode == 0, f"sensitivity.py: {plot.stderr}")
    picture = matplotlib.image.imread(output / "sensitivity.png")
    expect(np.ptp(picture[..., :3]) > 0.5 and picture.shape[1] > 800, "sensitivity.png is blank")
    _, summary = crawler(folder, WAVE)
    expect(summary["sensitivities"] is None, "sensitivities that nobody wants")
    refused(call([sys.executable, PLOT, folder]), "Output/Sensitivities")

    phase = "Active stress/Segments/Phase lag"
    _, summary = crawler(folder, ROBOT, "Time/End time=1.3", "Output/Sensitivities=" + phase)
    expect(summary["sensitivities"][phase]["value"] is not None, "jumps that come together")
    _, summary = crawler(folder, ROBOT, "Time/End time=1", "Output/Sensitivities=" + phase)
    expect("kink" in summary["sensitivities"][phase].get("reason", ""), "a jump at the end of the run")
    # With a rate limit the stress has kinks there instead: both sides have one derivative.
    smooth = ("Time/End time=1", "Active stress/Segments/Rate limit=3")
    _, summary = crawler(folder, ROBOT, *smooth, "Output/Sensitivities=" + phase)
    lag, found = 0.25, summary["sensitivities"][phase]
    moved = [crawler(folder, ROBOT, *smooth, "Accuracy=1e-7", f"{phase}={lag + d}")[1]["displacement"]
             for d in (-1e-4, 0, 1e-4)]
    for slope in (moved[1] - moved[0], moved[2] - moved[1]):
        expect(found["value"] is not None and abs(found["value"] - 1e4 * slope) <= found["error"] + 1e-2 < 0.1,
               f"a kink of the stress at the end: {found}, but {1e4 * slope} by runs")
    answers_without_adjoint(folder)
    for wrong, words in ((K, "colon"), (K + " : x", "positive number"), ("Accuracy : 1", "are expected"),
                         ("Active stress/Optimal wave/Cosine coefficients : 5 %", "without %")):
        refused(crawler(folder, WAVE, "Output/Uncertainty=" + wrong)[0], words)
    for wrong, words in (("Body/Elastic moduls", "Body/Elastic modulus"), ("Accuracy", "are expected"),
                         (f"all, {K}", "is expected alone"),
                         ("Active stress/Segments/Number of segments", "are expected")):
        refused(crawler(folder, WAVE, "Output/Sensitivities=" + wrong)[0], words)
    refused(crawler(folder, WAVE, "Model=kinematic", "Output/Sensitivities=all")[0], "nonlinear")
    with_a_given_strain(folder)
    in_sweeps(folder)


def in_sweeps(folder):
    """Columns of a sweep, against single runs."""
    file, output = folder / "sweep.prm", folder / "sweep"
    file.write_text(WAVE + f"subsection Sweep\n set Axes = {P} : 1.7, 3.2; {CHI} : 0.1, 0.35\nend\n", encoding="utf-8")
    result = call([sys.argv[1], "sweep", file, "--output", output, "--set", "Output/Sensitivities=" + K, "--set",
                   f"Output/Uncertainty={P} : 10 %"])
    expect(result.returncode == 0, f"a sweep with sensitivities: {result.stderr}")
    rows = csv_rows(output / "results.csv")
    expect(len(rows) == 4, f"{len(rows)} rows of a sweep")
    for row in rows:
        _, summary = crawler(folder, WAVE, f"{P}={row[P]}", f"{CHI}={row[CHI]}", f"Output/Sensitivities={K}, {P}")
        for entry in (K, P):
            one = summary["sensitivities"][entry]
            for number, alone in (("", one), ("stress_power.", one["stress_power"]), ("gait.speed.", one["gait.speed"])):
                value, error = (float(row[f"sensitivities.{entry}.{number}{word}"]) for word in ("value", "error"))
                expect(abs(value - alone["value"]) <= error + alone["error"],
                       f"{entry}, {number}: {value} in the sweep, {alone['value']} alone")
        expect(abs(float(row["uncertainty.displacement"])
                   / abs(0.1 * float(row[P]) * float(row[f"sensitivities.{P}.value"])) - 1) < 1e-9,
               f"uncertainty in the sweep: {row['uncertainty.displacement']}")


checks.run((main,))
