#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler table: measured samples and tracks of markers become tables that scenes read at once; what the noise makes
uncertain agrees with the sensitivities of the adjoint; pictures; refusals.

    python3 table.py PATH_TO_CRAWLER
"""
import os
import pathlib
import sys

import matplotlib.image
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect, prm, refused  # noqa: E402
from tables import json_of  # noqa: E402

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]
SAMPLES = [sys.executable, ROOT / "contrib/measured_samples.py"]
LARVA = ["--unit-of-t", "s", "--shift-t", "first", "--period", "find", "--smooth-t", "0.15", "--smooth-s", "0.4"]
TRACKS = ["--columns", "t=frame time", "--first-marker", "0.2", "--length", "4", "--smooth-t", "0.15", "--smooth-s", "0.8"]
KINEMATIC = prm("Model=kinematic", "Body/Length=4", "Body/Anchoring exponent=2",
                "Active stress/Generator=prescribed strain", "Active stress/Prescribed strain/Given by=table",
                "Active stress/Prescribed strain/File=tracks.csv", "Time/End time=1.98")
# Of the adjoint: a table without smoothing, linear between its samples.
LINEAR = prm("Accuracy=1e-4", "Body/Anchoring exponent=2", "Active stress/Generator=table",
             "Active stress/Table/File=small.csv", "Active stress/Table/Interpolation=linear", "Time/End time=1")
# Arguments, exit code, what the one sentence has.
REFUSED = [
    ([], 2, "IN, OUT missing"), (["larva_raw.csv", "out.csv", "--gap", "few"], 2, '"--gap" is "few", but a whole number is expected'),
    (["larva_raw.csv", "out.csv", "--noise", "low"], 2, '"--noise" is "low", but a number is expected'),
    (["larva_raw.csv", "out.csv", "--gap"], 2, 'a value is expected after "--gap"'), (["larva_raw.csv"], 2, "OUT"), (["a.csv", "b.csv", "c.csv"], 2, "c.csv"),
    (["nowhere.csv", "out.csv"], 6, "nowhere.csv"), (["larva_raw.csv", "larva.csv"], 2, "--overwrite"),
    (["larva_raw.csv", "larva_raw.csv"], 2, "another name"), (["larva_raw.csv", "out.txt"], 2, ".csv"),
    (["larva_raw.csv", "no/out.csv"], 6, "no/out"), (["larva_raw.csv", "out.csv", "--smoth-t", "1"], 2, "--smooth-t"),
    (["larva_raw.csv", "out.csv", "--gap", "0"], 2, "m is missing at s ="),
    (["larva_raw.csv", "out.csv", "--unit-of-t", "mm"], 2, 'the unit "ms"'),
    (["larva_raw.csv", "out.csv", "--period", "9999"], 2, "the samples last from"),
    (["larva_raw.csv", "out.csv", "--period", "500"], 2, "not a period"),
    (["larva_raw.csv", "out.csv", "--period", "never"], 2, '"find", "whole"'),
    (["larva_raw.csv", "out.csv", "--cycles", "2"], 2, "--period"), (["larva_raw.csv", "out.csv", "--smooth-s", "-1"], 2, "-1"),
    (["larva_raw.csv", "out.csv", "--ends", "free"], 2, "hold"), (["larva_raw.csv", "out.csv", "--copies", "1"], 2, "--copies"),
    (["larva_raw.csv", "out.csv", "--scene", "kinematic.prm", "--copies", "8"], 2, "does not read the table"),
    (["larva_raw.csv", "out.csv", "--scene", "nowhere.prm"], 6, "nowhere.prm"),
    (["tracks_raw.csv", "out.csv"], 2, "--columns"), (["tracks_raw.csv", "out.csv", *TRACKS[:2], "--length", "2"], 2, "the body from 0 to 2"),
    (["tracks_raw.csv", "out.csv", *TRACKS[:2], "--markers-at", "0,1"], 2, "there are 10 markers"),
    (["broken.csv", "out.csv"], 2, 'row 3 of "broken.csv" has "2.5x"')]


def crawler(*arguments):
    return call([PROGRAM, *arguments])


def displacement(scene, folder, *options):
    """Of a run that must finish."""
    run = crawler("run", scene, "--output", folder, *options)
    expect(run.returncode == 0, f"crawler run {scene} {run.stderr}")
    return json_of(pathlib.Path(folder, "summary.json"))["displacement"]


def table(path):
    return np.loadtxt(path, delimiter=",", skiprows=1).T


def stress():
    """One period from 3.4 noisy cycles with gaps: next to the truth, read by the generator, drawn."""
    made = crawler("table", "larva_raw.csv", "larva.csv", *LARVA)
    expect(made.returncode == 0, f"crawler table larva_raw.csv {made.stderr}")
    for words in ("between semicolons, with decimal commas", "46 gaps", "multiplied by 0.001"):
        expect(words in made.stdout, f'the report has "{words}"')
    period = float(made.stdout.split("period ")[1].split(" ")[0])
    expect(abs(period / 1.2 - 1) < 1e-4, f"the period {period} is 1.2, from 3.4 noisy cycles")
    expect(pathlib.Path("larva_report.txt").read_text(encoding="utf-8") in made.stdout, "larva_report.txt has the same")
    s, t, m = table("larva.csv")
    error = np.sqrt(np.mean((m - 2 * np.exp(4 * np.cos(2 * np.pi * (s / 4 - t / 1.2)) - 4))**2))
    expect(error < 0.04, f"the table is nearer to the truth, {error:.3f}, than the samples, 0.06")
    expect((m[t == t.min()] == m[t == t.max()]).all(), "the period closes")
    scene = (ROOT / "prm/examples/measured_table.prm").read_text(encoding="utf-8")
    pathlib.Path("larva.prm").write_text(scene.replace("measured_table.csv", "larva.csv"), encoding="utf-8")
    D = displacement("larva.prm", "larva_run")
    expect(abs(D / 0.0677 - 1) < 0.03, f"the displacement {D:.5f} is that of the example")
    drawn = crawler("plot", "larva.csv")
    expect(drawn.returncode == 0 and matplotlib.image.imread("larva.png").std() > 0.1, f"crawler plot larva.csv {drawn.stderr}")


def tracks():
    """Strain of markers, read by prescribed strain."""
    made = crawler("table", "tracks_raw.csv", "tracks.csv", *TRACKS, "--scene", "kinematic.prm", "--copies", "16")
    expect(made.returncode == 0, f"crawler table tracks_raw.csv {made.stderr}")
    s, t, e = table("tracks.csv")
    ramp = np.minimum(t / 0.5, 1)
    truth = 0.2 * ramp**2 * (3 - 2 * ramp) * np.sin(2 * np.pi * (s / 4 + t))
    error = np.sqrt(np.mean((e - truth)**2))
    expect(error < 0.03, f"the strain is known to {error:.4f}")
    expect((e[t == t.min()] == 0).all(), "the body begins at rest")
    expect("while the scene names" not in made.stdout, "the scene reads the new table")
    other = crawler("table", "tracks_raw.csv", "others.csv", *TRACKS, "--scene", "kinematic.prm", "--copies", "8")
    expect("with the new table, while the scene names" in other.stdout and "tracks.csv" in other.stdout,
           f"a scene that names another table is said to be computed with the new one: {other.stdout}{other.stderr}")
    new = crawler("table", "tracks_raw.csv", "new.csv", *TRACKS, "--scene", "new.prm", "--copies", "8", "--set", "Body/Anchoring exponent=3")
    expect(new.returncode == 0 and "new.prm is a scene that reads the table" in new.stdout, f"the scene beside the table: {new.stderr}")
    of_noise = float(new.stdout.split("displacement ")[1].split(" ")[0])
    expect(abs(displacement("new.prm", "new_run", "--set", "Body/Anchoring exponent=3") / of_noise - 1) < 1e-6, "it has the displacement of the report")
    frames = crawler("table", "tracks_raw.csv", "new.csv", *TRACKS, "--unit-of-t", "0.5", "--overwrite", "--scene", "./new.prm", "--copies", "8")
    expect("new.prm has got the new Time/End time" in frames.stdout and crawler("run", "new.prm", "--output", "slow").returncode == 0,
           f"a scene with the end of the table before gets the new one: {frames.stdout} {frames.stderr}")
    pathlib.Path("new.prm").write_text("# mine\n", encoding="utf-8")
    crawler("table", "tracks_raw.csv", "new.csv", *TRACKS, "--overwrite")
    expect(pathlib.Path("new.prm").read_text(encoding="utf-8") == "# mine\n", "a scene that is there stays")
    expect("the strain is held" in made.stdout and "copies" in made.stdout, "the report tells what is beyond the markers")
    expect(abs(displacement("kinematic.prm", "tracks_run")) > 0.01, "the body moves by the strain")
    drawn = crawler("plot", "tracks.csv")
    expect(drawn.returncode == 0 and matplotlib.image.imread("tracks.png").std() > 0.05, f"crawler plot tracks.csv {drawn.stderr}")


def hats(x, knots):
    """Of the samples of a linear interpolation, at places x."""
    return np.array([np.interp(x, knots, unit) for unit in np.eye(len(knots))])


def integral_weights(x):
    """Of points within 0 and 1: each stands for what lies up to the middle between it and its neighbours."""
    return np.diff(np.concatenate([[0], 0.5 * (x[1:] + x[:-1]), [1]]))


def uncertainty():
    """The bootstrap against the sensitivity dD/dm(s,t): sigma^2 sum_ij (int int dD/dm hat_i hat_j ds dt)^2."""
    places, times, sigma = np.linspace(0, 1, 7), np.linspace(0, 1, 9), 0.003
    with open("small_raw.csv", "w", encoding="utf-8") as file:
        print("s,t,m", *(f"{s},{t},{0.2 * np.sin(2 * np.pi * (s + t)) * np.sin(np.pi * t / 2)**2}" for t in times for s in places),
              sep="\n", file=file)
    made = crawler("table", "small_raw.csv", "small.csv", "--noise", sigma, "--scene", "small.prm", "--copies", "96")
    expect(made.returncode == 0, f"crawler table small_raw.csv {made.stderr}")
    found = float(made.stdout.split("numerical bound) +- ")[1].split()[0])
    displacement("small.prm", "small_run", "--set", "Output/Sensitivities=Body/Elastic modulus")
    rows = np.loadtxt("small_run/sensitivity_stress.csv", delimiter=",", skiprows=1)
    s, t = np.unique(rows[:, 0]), np.unique(rows[:, 1])
    density = rows[:, 2].reshape(len(t), len(s))
    by_samples = (hats(t, times) * integral_weights(t)) @ density @ (hats(s, places) * integral_weights(s)).T
    expected = sigma * np.sqrt((by_samples**2).sum())
    expect(abs(found / expected - 1) < 0.2, f"the uncertainty {found:.3g} is that of the adjoint, {expected:.3g}")


def refusals():
    """One sentence each, and nothing is written."""
    pathlib.Path("broken.csv").write_text("t;0;1;2;3\n1;2;3;4;5\n2;2.5x;3;4;5\n", encoding="utf-8")
    for arguments, code, words in REFUSED:
        refused(crawler("table", *arguments), words, code=code)
    expect(not pathlib.Path("out.csv").exists(), "nothing is written")


def main(folder):
    os.chdir(folder)
    for kind, name in (("stress", "larva_raw.csv"), ("tracks", "tracks_raw.csv")):
        made = call([*SAMPLES, kind])
        expect(made.returncode == 0, f"measured_samples.py {kind}: {made.stderr}")
        pathlib.Path(name).write_text(made.stdout, encoding="utf-8")
    pathlib.Path("kinematic.prm").write_text(KINEMATIC, encoding="utf-8")
    pathlib.Path("small.prm").write_text(LINEAR, encoding="utf-8")
    stress()
    tracks()
    uncertainty()
    refusals()


checks.run((main,))
