#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler optimize: the numbers of doc/theory.md ("Gait efficiency"), the bound that no evaluation exceeds, gradients,
a study that is killed and resumed, ranks, and answers to bad input.

    python3 optimize.py PATH_TO_CRAWLER PATH_TO_PRM MPIRUN [alone|several|--long]

--long: with narrow tolerances, more variables and more cases, some minutes.
"""
import math
import pathlib
import signal
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import NO_PICTURES, call, checks, expect, on_ranks, refused, sets  # noqa: E402
from tables import csv_rows, h5_columns, summary_of  # noqa: E402

CRAWLER, PRM, MPIRUN = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3]
MODES, SEGMENTS = "Active stress/Modes/", "Active stress/Segments/"
LAG, AMPLITUDE = SEGMENTS + "Phase lag", SEGMENTS + "Amplitude"
BUDGETS = ["Sweep/Axes=Optimize/Work : 0.001, 0.003", "Optimize/Objective=displacement", "Optimize/Starts=3"]
LONG = "--long" in sys.argv


def run(study, folder, *settings, options=(), ranks=1, stop_at=None, picture=False):
    """The finished process; the study is the name of one in prm/studies. Most need no picture."""
    return call([*on_ranks(MPIRUN, ranks), CRAWLER, "optimize", PRM / f"{study}.prm", *sets(settings),
                 "--output", folder, *options], None, stop_at, {} if picture else NO_PICTURES)


def optima(folder):
    """The optimum of each case."""
    return summary_of(folder)["optimize"]["optima"]


def rows(folder):
    """All evaluations, but for how long they took."""
    return [{name: value for name, value in row.items() if name != "seconds"} for row in csv_rows(folder / "results.csv")]


def kept(folder):
    """What is known of the starts that have ended, by case and start; not where it stands."""
    columns = h5_columns(folder / "starts.h5", "starts")
    names = [name for name in columns if name != "index"]
    return {(columns["case"][i], columns["start"][i]): str([columns[name][i] for name in names])
            for i, status in enumerate(columns["status"]) if status == "finished"}


def merits(folder):
    """No merit is above the bound for strains of at most 0.3 and a = -1, where they are admissible."""
    bound = 0.7 ** 0.5 - 1.3 ** 0.5
    return [float(row["objective"]) / abs(bound) for row in rows(folder)
            if row["objective"] and float(row["violation"]) < 1e-5]


def test_merits(place):
    """Best merits. The references, 0.22619, 0.25105 and 0.27819, exceed their limits of strain by about 1e-5."""
    for name, n, reference in (("two", 2, 0.22618), ("three", 3, 0.25104), ("eight", 8, 0.27818))[:3 if LONG else 2]:
        more = [] if n == 2 else [MODES + f"Harmonics={n}",
                                  f"Optimize/Variables={MODES}Coefficients[1-{2 * n + 1}] : -1 to 1"]
        done = run("optimize_harmonics", place / name, *more, picture=name == "two")
        expect(done.returncode == 0, f"{name} harmonics: exit code {done.returncode}: {done.stderr}")
        best = summary_of(place / name)
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
    expect(list((place / "two").glob("*.png")), "there is a picture")

    # The optimum is a parameter file that runs.
    again = call([CRAWLER, "run", place / "two" / "optimum.prm", "--output", place / "again"])
    expect(again.returncode == 0 and summary_of(place / "again")["displacement"] == summary_of(place / "two")["displacement"],
           f"optimum.prm gives the displacement of the summary {again.stderr}")


def test_theorem(place):
    """A travelling wave, D = 1e-4 to leading order, and one more part of either limit brings half a part."""
    run("optimize_theorem", place / "theorem")
    optimum = optima(place / "theorem")[0]
    expect(abs(optimum["objective"] - 1e-4) < 1e-6, f"theorem: displacement {optimum['objective']}")
    for limit in ("Work", "Mean-square strain"):
        expect(abs(optimum["limits"][limit]["multiplier"] - 0.5) < 0.01, f"theorem: {limit} {optimum['limits'][limit]}")


def test_simulations(place):
    """Robots, by simulations; gaits that repeat."""
    done = run("optimize_robot", place / "robot", *([] if LONG else ["Optimize/Tolerance=1e-2"]))
    expect(done.returncode == 0, f"robot: exit code {done.returncode}: {done.stderr}")
    expect(summary_of(place / "robot")["displacement"] > 0.0669, f"robot: {summary_of(place / 'robot')['displacement']}")
    # Of a gait that repeats the elastic energy of its start does not count.
    done = run("optimize_segments", place / "periodic", "Sweep/Axes=")
    best = summary_of(place / "periodic")
    expect(done.returncode == 0 and best["optimize"]["optima"][0]["objective"] > 0.1265, f"periodic: {done.stderr}")
    expect(0.83 < best["gait"]["stride_efficiency"] < 0.87 and best["gait"]["efficiency"] < 0.2, f"{best['gait']}")


def test_pulling_limits(place):
    """A limit of strain that pulls is reached, from a start with a twentieth of the objective; and kept between steps."""
    limit = 0.1
    done = run("optimize_robot", place / "pulling", "Active stress/Generator=travelling wave", f"Optimize/Largest strain={limit}",
               "Body/Anchoring exponent=2", "Body/Elastic modulus=1", "Time/End time=1",
               f"Active stress/Travelling wave/Amplitude={0.1 if LONG else 0.05}", "Active stress/Travelling wave/Wave number=0.5",
               "Optimize/Variables=Active stress/Travelling wave/Amplitude : 0.01 to 0.4")
    optimum = optima(place / "pulling")[0] if done.returncode == 0 else {"has_converged": False}
    expect(optimum["has_converged"], f"pulling: {done.stderr}")
    call([CRAWLER, "run", place / "pulling" / "optimum.prm", "--output", place / "pulling-dense", "--set",
          "Output/Number of snapshots=2000"])
    largest = max(float(row["max stretch [1]"]) for row in csv_rows(place / "pulling-dense" / "statistics.csv")) - 1
    expect(limit * (1 - 2e-3) < largest <= limit * (1 + 2e-5), f"pulling: strain {largest}")


def test_many_crests(place):
    """A wave whose strains reach their limits in many places: 600 random steps found 0.0168, half of the optimum. Limits
    may be exceeded by the tolerance."""
    low, high, tolerance = -0.21, 0.17, 1e-3
    done = run("optimize_harmonics", place / "crests", "Model=nonlinear", "Accuracy=1e-3", "Body/Anchoring exponent=2.4", "Body/Elastic modulus=1.3",
               "Active stress/Generator=modes", MODES + "Harmonics=3", MODES + "Coefficients=0, 0.2, 0.01, 0.02, 0.03, 0.01, 0.02",
               f"Optimize/Variables={MODES}Coefficients[2-7] : -2 to 2", "Optimize/Objective=displacement",
               f"Optimize/Smallest strain={low}", f"Optimize/Largest strain={high}", "Optimize/Starts=1", f"Optimize/Tolerance={tolerance}")
    optimum = optima(place / "crests")[0] if done.returncode == 0 else {"has_converged": False, "objective": 0, "violation": 1}
    best = summary_of(place / "crests")
    expect(optimum["has_converged"] and 0.99 * 0.0222 < optimum["objective"] < 0.023, f"crests: {optimum} {done.stderr}")
    strains = best["min_stretch"]["value"] - 1, best["max_stretch"]["value"] - 1
    expect(low * (1 + tolerance) <= strains[0] <= 0.97 * low and 0.97 * high <= strains[1] <= high * (1 + tolerance),
           f"crests: strains {strains}")
    expect(optimum["violation"] <= tolerance, f"crests: {optimum['violation']} is over the limits")


def test_far_start(place):
    """A start seven times beyond its limit leads to a body at rest, and from there back to as much as the limits admit."""
    wave = "Active stress/Travelling wave/"
    done = run("optimize_robot", place / "far", "Accuracy=1e-3", "Active stress/Generator=travelling wave", f"{wave}Amplitude=0.544", f"{wave}Wave number=1",
               f"{wave}Ramp duration=0.3", "Body/Anchoring exponent=2.55", "Body/Elastic modulus=1.283", "Time/End time=2", "Optimize/Tolerance=1e-2",
               f"Optimize/Variables={wave}Amplitude : 0 to 1.7; {wave}Wave number : 0.3 to 3", "Optimize/Smallest strain=-0.265", "Optimize/Largest strain=0.078")
    optimum = optima(place / "far")[0] if done.returncode == 0 else {"objective": 0, "has_converged": False}
    expect(optimum["has_converged"] and 0.0067 < optimum["objective"] < 0.0072, f"far: {optimum} {done.stderr}")


def test_narrow_stress(place):
    """A limit of the stress is kept between the points where the optimiser looks, and reached."""
    expression = "Active stress/Expression/"
    done = run("optimize_robot", place / "narrow", "Active stress/Generator=expression", f"{expression}Constants=A=0.05", "Time/End time=1",
               f"{expression}Active stress=A*sin(2*pi*(s+t))*(0.5+0.5*exp(-((s-0.515)/0.03)^2))", "Accuracy=1e-3",
               f"Optimize/Variables={expression}Constants[A] : 0.001 to 1", "Optimize/Largest stress=0.1", "Optimize/Tolerance=1e-2")
    optimum = optima(place / "narrow")[0] if done.returncode == 0 else {"variables": {"": 0}, "violation": 1}
    largest = next(iter(optimum["variables"].values()))  # at s = 0.515
    expect(0.099 < largest <= 0.1 * (1 + 1e-4) and optimum["violation"] <= 1e-4, f"narrow: {optimum} {done.stderr}")


def test_cases(place):
    """Cases that differ in words, numbers and lists, with starts and variables of their own."""
    # The best of each is better with more segments, and for a = 1 it is the mirror image of a wave.
    cases = run("optimize_robot", place / "cases", "Sweep/Design=zip", f"Optimize/Variables={LAG} : 0.02 to 0.45",
                f"Sweep/Axes={SEGMENTS}Number of segments : 4, 8, 8; {LAG} : 0.25, 0.125, 0.125; Body/Anchoring exponent : "
                "2, 2, 0; Optimize/Direction : forward, forward, backward", f"Optimize/Tolerance={1e-3 if LONG else 1e-2}")
    expect(cases.returncode == 0, f"cases: {cases.stderr}")
    found = [o["objective"] for o in optima(place / "cases")]
    expect(0.05 < found[0] < found[1] < 0.07 and -0.08 < found[2] < -0.07, f"cases: {found}")
    text = (place / "cases" / "optimum-3.prm").read_text(encoding="utf-8")
    expect("set Direction" in text and "8, 8" not in text, "an optimum has the axes of the study")

    # Words and numbers that go together; a damaged row; a folder without them.
    settings = ("Sweep/Design=zip", f"Sweep/Axes={MODES}Harmonics : 1, 2; {MODES}"
                'Coefficients : "0, 0.2, 0.001", "0, 0.2, 0.001, 0.01, 0.02"')
    pairs = run("optimize_harmonics", place / "pairs", *settings)
    found = [o["objective"] for o in optima(place / "pairs")] if pairs.returncode == 0 else []
    expect(len(found) == 2 and abs(found[0] - 0.21462) < 1e-4 and abs(found[1] - 0.22618) < 1e-4,
           f"pairs: {found}, {pairs.stderr}")
    for name, group, column in (("starts.h5", "starts", "seconds"), ("results.h5", "optimize", "objective")):
        before, text = rows(place / "pairs"), (place / "pairs" / name).read_bytes()
        numbers = h5_columns(place / "pairs" / name, group)[column]
        value = struct.pack("<d", next(one for one in numbers[::-1] if one == one))
        (place / "pairs" / name).write_bytes(text.replace(value, struct.pack("<d", 1234.5), 1))
        damaged = run("optimize_harmonics", place / "pairs", *settings, options=["--resume"])
        expect(value in text and damaged.returncode == 0 and "was damaged" in damaged.stderr
               and rows(place / "pairs") == before, f"a damaged row of {name}: {damaged.returncode}, {damaged.stderr}")
    (place / "old" / "starts").mkdir(parents=True)
    (place / "old" / "starts" / "1-0.json").write_text("{}", encoding="utf-8")
    refused(run("optimize_harmonics", place / "old", options=["--resume"]), "no optimization that can be resumed")


def test_neighbours(place):
    """Cases that are one problem with three starts, of which two end in local optima: neighbours lead them to the best."""
    starts = ('"0, 0.2, 0.001, 0.01, 0.02"', '"0, 0.2, 0.001, -0.05, -0.05"', '"0, 0.05, 0.001, 0.2, 0"')
    alone = [run("optimize_harmonics", place / f"alone-{i}", f"{MODES}Coefficients={start[1:-1]}")
             for i, start in enumerate(starts)]
    own = [optima(place / f"alone-{i}")[0]["objective"] for i in range(3)]
    expect(own[0] > own[1] * 1.01 and own[0] > own[2] * 1.01 and all("may be a local one" in one.stdout for one in alone),
           f"local optima: {own}")
    settings = [f"Sweep/Axes={MODES}Coefficients : {', '.join(starts)}"]
    together = run("optimize_harmonics", place / "neighbours", *settings)
    found = [o["objective"] for o in optima(place / "neighbours")]
    expect(together.returncode == 0 and all(abs(one / own[0] - 1) < 1e-3 for one in found), f"neighbours: {own}, {found}")
    expect("gaits of neighbours" in together.stdout, f"neighbours are named: {together.stdout}")
    before = rows(place / "neighbours")
    resumed = run("optimize_harmonics", place / "neighbours", *settings, options=["--resume"])
    expect(resumed.returncode == 0 and rows(place / "neighbours") == before, f"resumed: {resumed.stderr}")
    several = run("optimize_harmonics", place / "several", "Optimize/Starts=2")
    expect("may be a local one" not in several.stdout, f"two starts: {several.stdout}")
    # The optimum is the file that was optimised but for the variables.
    text = (place / "alone-0" / "optimum.prm").read_text(encoding="utf-8")
    expect("include parameters.prm" in text and text.count(" set ") == 1 and "set Coefficients" in text, f"optimum: {text}")


def test_stops(place):
    """Several limits of work and starts, on one rank and on two, killed, stopped and resumed: the same table."""
    run("optimize_harmonics", place / "one", *BUDGETS)
    found = optima(place / "one")
    limits = [o["case"]["Optimize/Work"] for o in found]
    expect(limits == [0.001, 0.003], f"budgets: {found}")
    expect(all(o["stress_power"] <= limit * (1 + 1e-5) for o, limit in zip(found, limits)), f"budgets: {found}")
    expect([o["number"] for o in found] == [1, 2] and (place / "one" / "best-2" / "summary.json").exists(), "cases")
    table = csv_rows(place / "one" / "optima.csv")
    expect([float(row["displacement"]) for row in table] == [o["objective"] for o in found], f"optima.csv: {table}")
    single = run("optimize_harmonics", place / "single", *BUDGETS[1:], "Optimize/Work=0.003")
    expect(single.returncode == 0 and optima(place / "single")[0]["objective"] == found[1]["objective"],
           "a case has the same optimum alone")
    refused(run("optimize_harmonics", place / "one", "Optimize/Largest strain=0.2", options=["--resume"]),
            "Optimize/Largest strain was")

    # The row of evaluations behind which this start has a row of its own.
    evaluations = [int(float(start["evaluations"])) for start in csv_rows(place / "one" / "starts.csv")]
    last = [sum(evaluations[:i + 1]) + i for i in range(3)]

    # Of two ranks the one that keeps the rows is killed, or the other one.
    for name, ranks, stop_at, code in (("two ranks", 2, None, 0), ("killed", 1, f"row:{last[2]}:KILL", -signal.SIGKILL),
                                       ("a rank killed", 2, f"row:{last[1]}:KILL", 128 + signal.SIGKILL),
                                       ("the other killed", 2, "step:200:KILL:1", 128 + signal.SIGKILL),
                                       ("stopped", 1, f"row:{last[0]}:TERM", 5)):
        folder = place / name.replace(" ", "_")
        done = run("optimize_harmonics", folder, *BUDGETS, ranks=ranks, stop_at=stop_at)
        expect(done.returncode == code and (folder / "results.csv").exists() == (code in (0, 5)),
               f"{name}: {done.returncode}, {done.stderr}")
        if code == 5:
            state = summary_of(folder)["optimize"]
            expect(state["status"] == "stopped" and state["reason"] == "signal" and "--resume" in done.stderr
                   and (folder / "best-1" / "summary.json").exists(), f"a signal ends with the best so far: {done.stderr}")
        if code != 0:
            before = kept(folder)
            resumed = run("optimize_harmonics", folder, *BUDGETS, options=["--resume"])
            after = kept(folder)
            expect(resumed.returncode == 0 and (ranks > 1 or before) and all(after[one] == before[one] for one in before),
                   f"{name}, and resumed: {before.keys()}, {resumed.stderr}")
        expect(rows(folder) == rows(place / "one"), f"{name}: the table of one in one go")

    # A start at which the program crashed twice is a row that says so.
    for i in range(2):
        died = run("optimize_harmonics", place / "crashed", *BUDGETS, options=["--resume"] if i else [],
                   stop_at=f"row:{last[2]}:SEGV")
        expect(died.returncode == -signal.SIGSEGV, f"crash {i}: {died.returncode}, {died.stderr}")
    given_up = run("optimize_harmonics", place / "crashed", *BUDGETS, options=["--resume"])
    starts = csv_rows(place / "crashed" / "starts.csv")
    expect(sum("crashed twice" in start["problem"] for start in starts) == 1 and len(starts) == 6,
           f"a start that crashed twice: {given_up.returncode}, {given_up.stderr}, {starts}")

    # Within the first start there is a best so far, too.
    within = run("optimize_from_rest", place / "within", stop_at="step:30:TERM")
    expect(within.returncode == 5 and summary_of(place / "within")["status"] == "stopped"
           and (place / "within" / "best" / "summary.json").exists(), f"a signal: {within.returncode}, {within.stderr}")
    for limit, code in (("0.001", 5), ("1e6", 0)):
        limited = run("optimize_harmonics", place / "limited", f"Optimize/Time limit={limit}", options=["--resume"])
        expect(limited.returncode == code and ("Time limit" in limited.stderr) == (code == 5)
               and (code == 5 or rows(place / "limited")), f"time limit {limit}: {limited.returncode}, {limited.stderr}")


def test_starts(place):
    """Starts that cannot be computed are rows; one that does not move and cannot say where to go is no optimum."""
    run("optimize_harmonics", place / "starts", "Optimize/Starts=4", "Optimize/Start spread=1",
        *([] if LONG else ["Optimize/Most iterations=1"]))
    starts = csv_rows(place / "starts" / "starts.csv")
    expect(len(starts) == 4 and any("invert" in start["problem"] or "-1 is expected" in start["problem"]
                                    for start in starts), f"starts that invert: {starts}")
    still = run("optimize_harmonics", place / "still", MODES + "In time=harmonics", MODES + "Coefficients=0, 0.1, 0.1",
                "Optimize/Work=0.1", "Optimize/Objective=displacement")
    expect(still.returncode == 3 and "does not move" in still.stdout, f"start at rest: {still.stdout}{still.stderr}")
    nothing = run("optimize_harmonics", place / "zero", MODES + "Coefficients=0, 0, 0, 0, 0")
    expect(nothing.returncode == 3 and "its work is 0" in nothing.stderr and "nan" not in nothing.stdout,
           f"a start without work: {nothing.stdout}{nothing.stderr}")

    # The check says what the starts give.
    for settings, words in (([], "is within all limits"), (["Sweep/Axes=Optimize/Largest strain : 0.3, 0.1"],
                                                          "with Largest strain = 0.1: merit 0.145"),
                            (["Optimize/Largest strain=0.1"], "exceeds Largest strain by")):
        check = call([CRAWLER, "check", PRM / "optimize_harmonics.prm", *sets(settings)])
        expect(check.returncode == 0 and words in check.stdout and "is valid" in check.stdout,
               f"check {settings}: {check.stdout}{check.stderr}")


def test_gradients(place):
    """Gradients by the adjoint are those by differences; --check-gradient writes no files."""
    wave = "Active stress/Travelling wave/"
    for study, settings in (("optimize_harmonics", []), ("optimize_harmonics", ["Optimize/Work=0.01",
                            "Optimize/Mean-square strain=0.01", "Optimize/Largest stress=1"]),
                            ("optimize_theorem", []), ("optimize_robot", []), ("optimize_uneven", ["Sweep/Axes="]),
                            ("optimize_segments", [] if LONG else ["Sweep/Axes="]),
                            ("optimize_actuators", [f"Sweep/Axes={SEGMENTS}Number of segments : 2", f"{LAG}=0.25",
                                                    "Optimize/Smallest strain=-0.2"]),
                            # Two crests are equally high here.
                            ("optimize_robot", ["Active stress/Generator=travelling wave", f"{wave}Amplitude=0.0112", f"{wave}Wave number=1",
                                                f"{wave}Ramp duration=0.3", "Body/Anchoring exponent=3.14", "Body/Elastic modulus=0.238",
                                                "Accuracy=1e-3", "Time/End time=1", "Optimize/Smallest strain=-0.094",
                                                f"Optimize/Variables={wave}Amplitude : 0 to 0.11186; {wave}Wave number : 0.3 to 3"]),
                            ("optimize_harmonics", ["Body/Friction profile=0.5+s", "Body/Elastic modulus profile=1.5-s",
                                                    "Ground/Friction law=Newtonian", "Optimize/Positive work=1"])):
        done = run(study, place / "nothing", *settings, options=["--check-gradient"])
        expect(done.returncode == 0, f"gradient of {study}: {done.stdout}{done.stderr}")
        expect(done.stdout.count("is allowed") >= (3 if study == "optimize_actuators" else 1),
               f"gradient of {study}: too little was compared: {done.stdout}")
    # The range says little of how large a variable is; and what has no adjoint is not compared with itself.
    wide = run("optimize_robot", place / "nothing", f"Optimize/Variables={AMPLITUDE} : 0.01 to 1000",
               options=["--check-gradient"])
    expect(wide.returncode == 0 and "allowed" in wide.stdout, f"gradient in a wide range: {wide.stdout}{wide.stderr}")
    rough = run("optimize_robot", place / "nothing", f"Optimize/Variables={LAG} : 0.1 to 0.2", "Time/Engine=petsc",
                options=["--check-gradient"])
    expect(rough.returncode == 0 and "nothing to compare" in rough.stdout, f"without adjoint: {rough.stdout}{rough.stderr}")
    # A start that nearly inverts: changes of a hundredth of the ranges are no gaits, and evaluations would take a hundred times as long.
    near = run("optimize_harmonics", place / "nothing", "Active stress/Modes/Coefficients=-0.372249, 0.2201606, 0.0962, -0.370116, 0.0914092",
               options=["--check-gradient"])
    expect(near.returncode == 0 and "the strain is linear in the variables" in near.stdout, f"near inversion: {near.stdout}{near.stderr}")
    expect(not (place / "nothing").exists(), "--check-gradient writes files")


def test_uneven(place):
    """On a body that is not the same everywhere, the strain being given: the run agrees, and there is no bound."""
    uneven = run("optimize_harmonics", place / "uneven", "Body/Friction profile=1.5-s", "Body/Elastic modulus profile=1+s")
    best = summary_of(place / "uneven")
    merit = best["displacement"] / math.sqrt(best["stress_power"])
    expect(uneven.returncode == 0 and abs(merit - best["optimize"]["optima"][0]["objective"]) < 1e-6 and merit > 0.2
           and best["gait"]["efficiency"] is None and not any(row["efficiency"] for row in rows(place / "uneven")),
           f"a body with profiles: merit {merit}, {uneven.stdout}{uneven.stderr}")


def test_obstacles(place):
    """What holds a gait back is said: friction that no gait can use, a body that all but inverts, limits."""
    short = [] if LONG else ["Time/End time=1", "Optimize/Tolerance=1e-2"]
    flat = run("optimize_robot", place / "flat", "Sweep/Axes=Body/Anchoring exponent : 1",
               f"Optimize/Variables={LAG} : 0.1 to 0.2", *short, picture=True)
    expect(flat.returncode == 3 and "no gait moves the body" in flat.stdout and "No picture was drawn" not in flat.stdout,
           f"a = 0: {flat.stdout}{flat.stderr}")
    short = [] if LONG else [SEGMENTS + "Number of segments=2", "Accuracy=1e-2", "Time/End time=2"]
    strong = run("optimize_robot", place / "strong", f"Optimize/Variables={AMPLITUDE} : 0.1 to 0.95",
                 SEGMENTS + "Switching=smooth", SEGMENTS + "Rate limit=automatic", *short,
                 f"Optimize/Tolerance={1e-2 if LONG else 1e-1}")
    expect("Optimize/Smallest strain sets one" in strong.stdout, f"near inversion: {strong.stdout}{strong.stderr}")

    # Beside inversion the optimiser cannot go on, which is no optimum; from rest with a limit on work alone it can.
    short = [] if LONG else ["Accuracy=1e-2"]
    brink = run("optimize_robot", place / "brink", f"{AMPLITUDE}=1.5", SEGMENTS + "Rate limit=1.5", *short,
                f"Optimize/Variables={LAG} : 0.02 to 0.45; {SEGMENTS}Duty cycle : 0.2 to 0.8")
    expect(brink.returncode == 3 and "better gaits are impossible: inverted" in brink.stdout,
           f"beside inversion: {brink.returncode}, {brink.stdout}{brink.stderr}")
    free = run("optimize_tradeoff", place / "free", "Optimize/Smallest strain=automatic", "Sweep/Axes=", "Optimize/Work=0.01",
               "Optimize/Largest strain=automatic", "Optimize/Starts=1")
    expect(free.returncode == 0 and summary_of(place / "free")["displacement"] > 0.022,
           f"work alone: {free.returncode}, {free.stdout}{free.stderr}")
    # Beside gaits with fewer than two strides, which have no speed, derivatives are of one side.
    wave = "Active stress/Travelling wave/"
    few = run("optimize_robot", place / "few", "Active stress/Generator=travelling wave", wave + "Amplitude=0.2",
              wave + "Ramp duration=0.5", "Time/End time=3", "Optimize/Objective=speed", "Optimize/Work=0.1",
              "Optimize/Smallest strain=-0.4", "Optimize/Largest strain=automatic", "Optimize/Tolerance=1e-4", "Accuracy=1e-5",
              f"Optimize/Variables={wave}Amplitude : 0.05 to 0.6; {wave}Frequency : 0.3 to 3")
    expect(few.returncode == 3 and "better gaits are impossible: the speed is not known" in few.stdout,
           f"few strides: {few.returncode}, {few.stdout}{few.stderr}")
    # Without a strain below 0 there is no scale for it.
    longer = run("optimize_harmonics", place / "longer", "Optimize/Smallest strain=0", "Optimize/Largest strain=automatic")
    expect(longer.returncode == 0 and "Smallest strain = 0 holds it back" in longer.stdout,
           f"no strain below 0: {longer.returncode}, {longer.stdout}{longer.stderr}")
    # A limit that is exceeded has a name.
    against = run("optimize_robot", place / "against", "Optimize/Largest stress rate=1e-3", "Optimize/Most iterations=2",
                  f"Optimize/Variables={LAG} : 0.1 to 0.2")
    expect(against.returncode == 3 and "Largest stress rate is EXCEEDED" in against.stdout
           and optima(place / "against")[0]["exceeded_limit"] == "Largest stress rate",
           f"an empty set: {against.stdout}{against.stderr}")
    # The run of the best gait finished, but the study did not.
    whole = summary_of(place / "against")
    expect((whole["status"], whole["reason"]) == ("failed", "limits_exceeded") and "Largest stress rate" in whole["message"],
           f"status of the study: {whole['status']}, {whole['reason']}, {whole['message']}")


def test_bad_input(place):
    no_limit = ["Optimize/Smallest strain=automatic", "Optimize/Largest strain=automatic"]
    for settings, words in ((["Optimize/Variables="], 'Variables" is empty'),
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
                            (["Model=perturbation"], "perturbation")):
        refused(run("optimize_harmonics", place / "bad", *settings), words)
    expect(not (place / "bad").exists(), "bad input leaves a folder")


checks.run((test_merits, test_theorem, test_simulations, test_pulling_limits, test_many_crests, test_far_start,
            test_narrow_stress, test_cases, test_neighbours, test_starts, test_gradients, test_uneven, test_obstacles,
            test_bad_input), (test_stops,))
