#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs the program and contrib/reference/crawler_reference.py, which shares no code and no method with it, on the same
scenes and compares the results.

    python3 independent_solver.py PATH_TO_CRAWLER          needs python3-numpy and python3-scipy, takes 10 s
"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect, prm  # noqa: E402
from tables import json_of  # noqa: E402

REFERENCE = pathlib.Path(__file__).resolve().parents[2] / "contrib/reference/crawler_reference.py"

# Largest relative difference. The program looks for extreme stretches at the quadrature points and time steps only, so
# they come from a run with more cells than the Accuracy asks for.
TOLERANCE = {"displacement": 1e-7, "stress_power": 1e-6, "dissipation": 1e-6, "min_stretch": 1e-4, "max_stretch": 1e-4}
ACCURACY = 1e-8
CELLS_FOR_EXTREMES = 64

# name: exponent a, length, elastic modulus, friction coefficient, end time, and the active stress: a formula,
# or chi, wave speed, sine and cosine coefficients of the optimal wave
SCENES = {
    "Fig. S1, chi = 0.4": (-1, 1, 1, 1, 1, (0.4, 1, (1,), (0,))),
    "a = 2, two harmonics, sines and cosines": (2, 1.5, 2, 0.6, 1.2, (0.1, -1.3, (1, 0.5), (-0.4, 0.3))),
    "a = -1.5, formula": (-1.5, 1, 1, 1, 1, "0.2*(1-cos(2*pi*t))*(sin(2*pi*(s+t))+s^2)"),
}


def printed(*arguments):
    done = call(arguments)
    if done.returncode != 0:
        sys.exit(f"{' '.join(arguments)}\nexits with {done.returncode}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def reference(exponent, length, modulus, friction, end_time, stress):
    """Results of the independent solver."""
    options = {"exponent": exponent, "length": length, "elastic-modulus": modulus, "friction": friction,
               "end-time": end_time, "rtol": 1e-9}
    if isinstance(stress, str):
        options["active-stress"] = stress.replace("^", "**")
    else:
        options["chi"], options["speed"] = stress[:2]
    arguments = [f"--{name}={value}" for name, value in options.items()]
    if not isinstance(stress, str):
        for name, coefficients in zip(("--sine", "--cosine"), stress[2:]):
            arguments += [name, *map(str, coefficients)]
    return json.loads(printed(sys.executable, str(REFERENCE), *arguments))


def parameter_file(exponent, length, modulus, friction, end_time, stress):
    """The same scene for the program."""
    if isinstance(stress, str):
        generator = ["Generator=expression", f"Expression/Active stress={stress}"]
    else:
        chi, speed, sine, cosine = stress
        generator = ["Generator=optimal wave", f"Optimal wave/Perturbation parameter={chi}",
                     "Optimal wave/Choose wave by=wave speed", f"Optimal wave/Wave speed={speed}",
                     f"Optimal wave/Sine coefficients={', '.join(map(str, sine))}",
                     f"Optimal wave/Cosine coefficients={', '.join(map(str, cosine))}"]
    return prm(f"Accuracy={ACCURACY}", f"Body/Length={length}", f"Body/Elastic modulus={modulus}",
               f"Body/Friction coefficient={friction}", f"Body/Anchoring exponent={1 - exponent}",
               *("Active stress/" + entry for entry in generator), f"Time/End time={end_time}",
               "Output/Number of snapshots=0", "Output/Statistics=false")


def crawler(folder, *scene):
    """Results of the program, extremes without their places."""
    file, output = folder / "scene.prm", folder / "output"
    file.write_text(parameter_file(*scene))
    summaries = []
    for cells in ("automatic", CELLS_FOR_EXTREMES):
        printed(sys.argv[1], "run", str(file), "--quiet", "--output", str(output), "--overwrite",
                "--set", f"Discretization/Number of cells={cells}")
        summaries.append(json_of(output / "summary.json"))
    automatic, fine = summaries
    return {name: fine[name]["value"] if name.endswith("_stretch") else automatic[name] for name in TOLERANCE}


def main(folder):
    for name, scene in SCENES.items():
        theirs, ours = reference(*scene), crawler(folder, *scene)
        print(f"{name}: independent solver with {theirs['points']} points in {theirs['seconds']:.1f} s")
        for quantity, tolerance in TOLERANCE.items():
            difference = abs(ours[quantity] / theirs[quantity] - 1)
            own_error = theirs["errors"][quantity] / abs(theirs[quantity])
            text = (f"{quantity:<13} {ours[quantity]:>15.10g}, reference {theirs[quantity]:>15.10g} +- {own_error:.0e}, "
                    f"difference {difference:.1e} of at most {tolerance:g}")
            print(f"  {text}", flush=True)
            expect(difference <= tolerance and own_error <= 0.2 * tolerance, text)


checks.run((main,))
