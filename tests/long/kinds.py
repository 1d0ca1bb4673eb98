#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Random scenes of the kinds in which answers once were wrong: events in long formulas, formulas that jump, ground with two
directions, jumps in profiles, bodies that invert, other units of measurement, limits of optimised gaits.

    python3 kinds.py FOLDER_OF_THE_PACKAGE NUMBER SEED [KIND...]     NUMBER of scenes of each kind (default: all kinds)

An answer must be within its bound and that of a far more accurate one, and every scene must have one.
"""
import math
import pathlib
import random
import sys

import numpy as np

sys.path.insert(0, sys.argv[1])
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import crawler  # noqa: E402
from program import checks, expect  # noqa: E402


def wave(at_random, ramp):
    """A travelling wave on a body of length 1."""
    return {"Generator": "travelling wave",
            "Travelling wave": {"Amplitude": at_random.uniform(0.05, 0.25), "Wave number": at_random.choice((0.5, 1, 1.5, 2)),
                                "Frequency": at_random.choice((0.5, 1, 2)), "Phase": at_random.uniform(0, 6.28),
                                "Ramp duration": ramp}}


def answer(scene, **more):
    """The run without fields."""
    return crawler.run(scene, fields=False, **more)


def compare(kind, scene, accuracy):
    """The scene at an Accuracy and at a thousandth of it; returns the bound over the error."""
    one = answer(scene, set={"Accuracy": accuracy})
    other = answer(scene, set={"Accuracy": max(accuracy * 1e-3, 1e-9)})
    text = f"{kind}: {one}, {other}\n{crawler.to_prm(scene)}"
    if one.status != "finished" or (other.status != "finished" and other.reason != "accuracy_not_met"):
        expect(one.status == other.status, text)
        return math.inf
    ratio = (one.displacement_error.total + other.displacement_error.total) / max(abs(one.displacement - other.displacement), 1e-300)
    expect(ratio >= 1 and one.displacement_error.total <= max(accuracy * abs(one.displacement), 1e-8), text)
    return ratio


def formulas(at_random):
    """An event of a thousandth to a tenth of a stride, somewhere in thousands of strides: what it adds is what it adds to twenty."""
    speed, amplitude, width = at_random.choice((1, 0.5, -1)), at_random.uniform(0.1, 0.25), 10 ** at_random.uniform(-2.5, -1)
    duration, strength, phase = at_random.choice((300, 1000, 3000)), at_random.uniform(0.2, 0.5), at_random.uniform(0, 2)
    place = 2 * at_random.randint(5, duration // 2 - 5)

    def with_event(end, strides, strength):
        event = f" + {strength!r}*sin(pi*s)*sin(2*pi*s)*exp(-((t-{strides + phase!r})/{width!r})^2)" if strength else ""
        return {"Active stress": {"Generator": "expression", "Expression": {"Active stress": f"{amplitude!r}*sin(2*pi*(s+{speed}*t)){event}"}},
                "Time": {"End time": end}}
    scene = with_event(duration, place, strength)
    one, without = (answer(each, set={"Accuracy": 1e-6}) for each in (scene, with_event(duration, 0, 0)))
    short, short_without = (answer(each, set={"Accuracy": 1e-7}) for each in (with_event(20, 8, strength), with_event(20, 0, 0)))
    effect, expected = one.displacement - without.displacement, short.displacement - short_without.displacement
    bound = sum(each.displacement_error.total for each in (one, without, short, short_without))
    expect(abs(effect - expected) <= bound and abs(without.displacement) > 0.5 * duration * abs(short_without.displacement) / 20,
           f"formulas: the event adds {effect}, expected {expected} +- {bound}\n{crawler.to_prm(scene)}")
    return bound / max(abs(effect - expected), 1e-300)


def jumps(at_random):
    """A formula, also with feedback, with jumps and kinks in s and t."""
    u, x = at_random.uniform, at_random.choice
    place, time = "(s/L)", f"(t/{x((0.5, 1, 0.7))})"
    in_space = x(("1", f"({place}<{u(0.1, 0.9):.3f} ? 1 : {u(-1, 1):.2f})", f"abs({place}-{u(0.2, 0.8):.3f})", f"floor({x((2, 3, 4, 5))}*{place})/3",
                  f"max(0,sin({x((2, 3))}*pi*{place}))", f"({place}>{u(0.1, 0.4):.3f} && {place}<{u(0.5, 0.9):.3f})", f"mod({x((2, 3))}*{place},1)",
                  f"min(1,{u(2, 9):.2f}*{place})", f"sign(sin({u(4, 20):.2f}*{place}))"))
    in_time = x(("1", f"(mod({time},1)<{u(0.2, 0.8):.3f})", f"abs(sin(pi*{time}))", f"max(0,sin(2*pi*{time}))", f"min(1,{time}/0.3)",
                 f"({time}>0.31 && {time}<{u(0.35, 0.6):.4f} ? 1 : 0.2)", f"sign(sin(2*pi*{time}+0.3))", f"floor({time})", f"rint({time})",
                 f"(mod({time}-floor(3*{place})/3,1)<0.5)"))
    wave = x(("1", f"sin(2*pi*({place}+{time}))", f"sin(2*pi*({place}-{time}))", f"(1+0.5*cos(pi*{place}))"))
    modulus, length = 10 ** u(-1, 1.2), x((1, 3, 0.01))
    formula = f"{modulus * u(0.05, 0.4)!r}*{in_space}*{in_time}*{wave}*{x(('1', '(1-exp(-5*t))'))}"
    stress = ({"Generator": "expression", "Expression": {"Active stress": formula}} if u(0, 1) < 0.8 else
              {"Generator": "strain feedback", "Strain feedback": {"Active stress": f"({formula})*(1+0.3*(w-1))"}})
    scene = {"Body": {"Length": length, "Elastic modulus": modulus, "Friction coefficient": 1 / length ** 2, "Anchoring exponent": x((2, 3, u(-3, 5)))},
             "Active stress": stress, "Time": {"End time": u(0.4, 4)}}
    return compare("jumps", scene, 10 ** u(-6, -3))


def directions(at_random):
    """Friction that is less in one direction, with and without a ramp."""
    scene = {"Body": {"Elastic modulus": 10 ** at_random.uniform(-0.5, 1), "Anchoring exponent": at_random.uniform(-1, 4)},
             "Ground": {"Backward ratio": at_random.uniform(0.2, 3), "Switching velocity": 10 ** at_random.uniform(-2, -0.5)},
             "Active stress": wave(at_random, at_random.choice((0, 0.3))), "Time": {"End time": at_random.uniform(0.3, 3)}}
    return compare("directions", scene, 1e-4)


def profiles(at_random):
    """Friction, modulus and stress that jump along the body."""
    def profile():
        return f"s<{at_random.uniform(0.1, 0.9):.3f}*L ? 1 : {10 ** at_random.uniform(-0.6, 0.6):.3f}"
    body = {"Elastic modulus": 10 ** at_random.uniform(-0.5, 1), "Anchoring exponent": at_random.uniform(-3, 4)}
    for entry in at_random.sample(("Friction profile", "Elastic modulus profile"), at_random.randint(1, 2)):
        body[entry] = profile()
    scene = {"Body": body, "Active stress": wave(at_random, at_random.choice((0, 0.3))), "Time": {"End time": at_random.uniform(0.3, 3)}}
    return compare("profiles", scene, 1e-4)


def inversions(at_random):
    """A body that inverts ends with its last state, before it; at an end at the time that a formula gives, inside at one that
    finer meshes confirm."""
    modulus = 10 ** at_random.uniform(-0.5, 0.5)
    amplitude = modulus * at_random.uniform(1.02, 1.6)
    scene = {"Body": {"Elastic modulus": modulus, "Anchoring exponent": at_random.uniform(-1, 4)},
             "Active stress": {"Generator": "travelling wave",
                               "Travelling wave": {"Amplitude": amplitude, "Wave number": at_random.choice((0.5, 1, 1.5)), "Frequency": 1,
                                                   "Phase": at_random.choice((0, at_random.uniform(0, 6.28)))}}}
    accuracy = 10 ** at_random.uniform(-5, -2)
    one = crawler.run(scene, set={"Accuracy": accuracy, "Output/Number of snapshots": 2})
    text = f"inversions, Accuracy {accuracy:.2g}: {one} {one.inversion}\n{crawler.to_prm(scene)}"
    if not expect(one.status == "inverted" and one.end_time <= one.inversion.t, text):
        return math.inf
    if one.end_time > 0:
        last = one.statistics.iloc[-1]
        expect(abs(last["displacement"] - one.displacement) <= 1e-8 * abs(one.displacement) and last["time"] == one.end_time,
               f"last row {last['time']}, {last['displacement']}: {text}")
    if one.inversion.error is None:
        return math.inf
    finer = answer(scene, set={"Accuracy": 1e-8})
    ratio = (one.inversion.error + (finer.inversion.error or 0)) / max(abs(one.inversion.t - finer.inversion.t), 1e-300)
    expect(ratio >= 1, f"finer {finer.inversion}: {text}")
    return ratio


def units(at_random):
    """The same scene in other units of length, time and force has the same outcome and, within the bounds, the same number."""
    stress, stiffness, exponent = at_random.uniform(0.05, 0.9), 10 ** at_random.uniform(-2.5, 1), at_random.uniform(-16, 8)
    number, end = at_random.choice((0.5, 1, 1.5, 2)), at_random.uniform(0.3, 2)
    accuracy = 10 ** at_random.uniform(-5, -3)
    results = []
    for length, time, force in ((1, 1, 1), tuple(10 ** at_random.uniform(-3, 3) for _ in range(3))):
        friction = force * time / length ** 2
        scene = {"Accuracy": accuracy, "Body": {"Length": length, "Elastic modulus": stiffness * force, "Anchoring exponent": exponent,
                                                "Friction coefficient": friction},
                 "Active stress": {"Generator": "travelling wave",
                                   "Travelling wave": {"Amplitude": stress * stiffness * force, "Wave number": number, "Frequency": 1 / time}},
                 "Time": {"End time": end * time}}
        results.append((length, answer(scene), scene))
    (_, one, _), (length, other, scene) = results
    text = f"units: {one}, {other}, {other.reason}\n{crawler.to_prm(scene)}"
    expect(one.status == other.status and one.reason == other.reason, text)
    if one.status != "finished" or other.status != "finished":
        return math.inf
    bound = one.displacement_error.total + other.displacement_error.total / length
    error = abs(one.displacement - other.displacement / length)
    expect(error <= bound, text)
    return bound / max(error, 1e-300)


def limits(at_random):
    """An optimised gait keeps its limits on a grid that the optimiser does not have."""
    smallest, largest, work = -at_random.uniform(0.1, 0.3), at_random.uniform(0.1, 0.3), at_random.uniform(0.05, 0.3)
    scene = {"Body": {"Anchoring exponent": at_random.uniform(1, 3), "Elastic modulus": at_random.uniform(0.5, 3)},
             "Active stress": {"Generator": "travelling wave", "Travelling wave": {"Amplitude": 0.05, "Wave number": 1, "Frequency": 1}},
             "Time": {"End time": 1},
             "Optimize": {"Variables": "Active stress/Travelling wave/Amplitude : 0.01 to 0.4; Active stress/Travelling wave/Wave number : 0.5 to 2",
                          "Smallest strain": smallest, "Largest strain": largest, "Work": work}}
    best = crawler.optimize(scene).best[0]
    fields = crawler.run(best.parameters, fields=np.linspace(0, 1, 2001), places=np.linspace(0, 1, 1001), set={"Accuracy": 1e-7}).fields
    strain = np.asarray(fields.stretch) - 1
    text = f"limits: strain {strain.min()} to {strain.max()}, {smallest} to {largest}, work {best.stress_power} of {work}\n{crawler.to_prm(scene)}"
    expect(strain.min() >= smallest * (1 + 1e-4) and strain.max() <= largest * (1 + 1e-4) and best.stress_power <= work * (1 + 1e-4), text)
    return math.inf


def main():
    kinds = {one.__name__: one for one in (formulas, jumps, directions, profiles, inversions, units, limits)}
    number, seed, *names = sys.argv[2:]
    for name in names or kinds:
        ratios = []
        for i in range(int(number)):
            try:
                ratios.append(kinds[name](random.Random(f"{seed} {name} {i}")))
            except (RuntimeError, ValueError) as error:
                expect(False, f"{name} {i}: {error}")
        finite = [ratio for ratio in ratios if ratio < 1e290]
        print(f"{name}: {len(ratios)} scenes" + (f", {len(finite)} compared, bound over error: median {np.median(finite):.3g}, least {min(finite):.3g}"
                                                 if finite else ""), flush=True)
    checks.end()


main()
