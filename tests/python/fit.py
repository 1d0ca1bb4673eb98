#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler.fit: numbers that data without noise must give back, deviations and intervals against their definitions, what data
cannot tell, and refusals.

    fit.py FOLDER_OF_THE_PYTHON_PACKAGE
"""
import contextlib
import io
import os
import pathlib
import pickle
import re
import signal
import sys
import tempfile
import threading
import unittest
import unittest.mock
import warnings

sys.path.insert(0, sys.argv.pop(1))
import numpy as np  # noqa: E402

import crawler  # noqa: E402
from crawler.fitting import prepared  # noqa: E402
from crawler.fitting.fit import Problem, _looked_at  # noqa: E402
from crawler.fitting.model import Model  # noqa: E402
from crawler.fitting.starts import _without_signals  # noqa: E402
from crawler.fitting.uncertainty import covariance, curvature_bias, undetermined_directions  # noqa: E402
from crawler.measured import Samples, Settings, prepare, read_samples  # noqa: E402

BODY, WAVE = "Body/", "Active stress/Travelling wave/"
P, K, GAMMA, AMPLITUDE = BODY + "Anchoring exponent", BODY + "Elastic modulus", BODY + "Friction coefficient", WAVE + "Amplitude"
STRAIN = {"Model": "kinematic", "Active stress/Generator": "prescribed strain", "Active stress/Prescribed strain/Given by": "wave",
          "Active stress/Prescribed strain/Amplitude": 0.3, BODY + "Length": 2, P: 2, "Time/End time": 2}
STRESS = {"Active stress/Generator": "travelling wave", AMPLITUDE: 0.3, WAVE + "Wave number": 1, WAVE + "Frequency": 1,
          BODY + "Length": 2, K: 1.5, P: 2, "Time/End time": 2}
RANGES = {P: (0.2, 6), K: (0.3, 6), GAMMA: (0.2, 5), AMPLITUDE: (0.02, 0.9), WAVE + "Frequency": (0.6, 1.5)}
T, S = np.linspace(0, 2, 41), np.linspace(0, 2, 7)
NOISE = 0.004


def fields(scene, places=S):
    """Of a run that is as good as exact."""
    return crawler.run(scene, fields=T, places=places, accuracy=1e-9, check=True).fields


def tracks(scene, noise=NOISE, seed=1, origin=3.0):
    """Of markers at S."""
    x = fields(scene).position + origin
    return Samples("x", np.arange(7.0), T, x + noise * np.random.default_rng(seed).standard_normal(x.shape), [str(i) for i in range(7)])


def path(scene, noise=NOISE, kind="centre"):
    """Of the centre of mass, or its speed."""
    values = crawler.run(scene, fields=T, accuracy=1e-9, check=True).fields
    values = np.trapz(values.position if kind == "centre" else values.velocity, dx=1 / 200, axis=1)[:, None]
    return Samples(kind, np.zeros(1), T, values + noise * np.random.default_rng(1).standard_normal(values.shape))


def scaled(samples, factor):
    """Samples in another unit."""
    samples.values = samples.values * factor
    return samples


def quiet_fit(*arguments, **settings):
    """The Fit, without its warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return crawler.fit(*arguments, **settings)


def fit(scene, data, *names, **settings):
    """The Fit of variables with these names, from a start beside the truth."""
    start = {**scene, **{name: scene.get(name, 1) * 1.1 for name in names}}
    kinds = [one.quantity for one in (data if isinstance(data, list) else [data])]
    where = {"markers_at": S} if "x" in kinds else {}
    return quiet_fit(start, data, {name: RANGES[name] for name in names}, **where, **settings)


class Values(unittest.TestCase):
    """Best values and their deviations."""

    def test_gives_back_what_made_the_data(self):
        for scene, names in ((STRAIN, (P,)), (STRESS, (P, K, AMPLITUDE)), (STRESS, (WAVE + "Frequency", GAMMA))):
            for origin in (0, -1e3):
                found = fit(scene, tracks(scene, noise=0, origin=origin), *names)
                for name in names:
                    self.assertAlmostEqual(found.variables[name]["used"], scene.get(name, 1), delta=2e-5, msg=name)

    def test_reads_strain_centre_and_speed(self):
        strain = Samples("strain", S, T, fields(STRESS).stretch - 1)
        for data, names in ((strain, (K, AMPLITUDE)), (path(STRESS, 0), (P,)), (path(STRESS, 0, "speed"), (P,))):
            found = fit(STRESS, data, *names)
            for name in names:  # the mean over points is good to 1e-5
                self.assertAlmostEqual(found.variables[name]["used"], STRESS[name], delta=5e-4, msg=data.quantity)

    def test_length_from_the_path_of_the_middle(self):
        """With a known origin the centre of mass starts in the middle of the body."""
        found = crawler.fit({**STRESS, BODY + "Length": 2.1}, path(STRESS, 0), {BODY + "Length": (1.5, 3)}, origin="tail")
        self.assertAlmostEqual(found.variables[BODY + "Length"]["used"], 2, delta=5e-4)

    def test_more_starts_change_no_better_value(self):
        """The random starts of this seed end elsewhere or fail; places of markers stay those of the best one."""
        data = tracks(STRESS)
        variables = {WAVE + "Frequency": (0.6, 3), AMPLITUDE: (0.02, 5)}
        few, many = (crawler.fit(STRESS, data, variables, standard_deviation=NOISE, starts=n) for n in (1, 5))
        self.assertGreater(max(one["residuals"] or 1 for one in many.starts), 2 * many.starts[0]["residuals"])
        self.assertEqual(many, crawler.fit(STRESS, data, variables, standard_deviation=NOISE, starts=5, workers=2))
        for name in variables:
            self.assertLess(abs(few.variables[name]["value"] - many.variables[name]["value"]), 1e-2 * few.variables[name]["deviation"])

    def test_deviation_is_that_of_least_squares(self):
        """For one number it is noise over the norm of the derivatives; here those of runs beside the best one."""
        found = fit(STRAIN, tracks(STRAIN, origin=0), P, standard_deviation=NOISE, set={"Fit/Origin": "tail"} | {"Fit/First time": 0})
        step, at = 1e-3, found.variables[P]["used"]
        sides = [fields({**STRAIN, P: at + d}).position for d in (-step, step)]
        self.assertAlmostEqual(found.variables[P]["deviation"] / (NOISE / np.linalg.norm((sides[1] - sides[0]) / (2 * step))), 1, delta=1e-3)

    def test_each_number_has_its_deviation(self):
        """The same everywhere it is Fit/Standard deviation; a number of which it is huge counts as nothing, a gap."""
        data = path(STRESS)
        data.deviation = np.full((41, 1), NOISE)
        one, same = fit(STRESS, data, P), fit(STRESS, path(STRESS), P, standard_deviation=NOISE)
        self.assertAlmostEqual(one.goodness.chi_square, same.goodness.chi_square, delta=1e-6)
        self.assertAlmostEqual(one.variables[P]["value"], same.variables[P]["value"], delta=1e-4 * same.variables[P]["deviation"])
        gaps = path(STRESS)
        gaps.values[20:] = np.nan
        data.values[20:] += 1
        data.deviation[20:] = 1e6
        one, same = fit(STRESS, data, P), fit(STRESS, gaps, P, standard_deviation=NOISE)
        for key in ("value", "deviation"):
            self.assertAlmostEqual(one.variables[P][key], same.variables[P][key], delta=1e-3 * same.variables[P]["deviation"])
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "path.csv")
            file.write_text("t,centre [mm],deviation\n0,1,0.5\n1,2,0.25\n", encoding="utf-8")
            np.testing.assert_allclose(read_samples(file, unit_of_s="m").deviation[:, 0], (5e-4, 2.5e-4))

    def test_deviation_is_a_share_of_the_noise(self):
        small, large = (fit(STRESS, tracks(STRESS, noise), P, K, AMPLITUDE, standard_deviation=noise) for noise in (1e-5, 1e-4))
        for name in (P, K, AMPLITUDE):
            self.assertAlmostEqual(large.variables[name]["deviation"] / small.variables[name]["deviation"], 10, delta=0.05)

    def test_bias_of_an_inverse(self):
        """With n data y = c/k and noise sigma, the mean of the values of k is sigma^2 k^3/(n c^2) too large, to second order."""
        n, c, k, sigma = 50, 3.0, 0.4, 0.2
        bias = curvature_bias(lambda x: np.full(n, c / x[0] - c / k) / sigma, np.full((n, 1), -c / k ** 2 / sigma), np.array([k]))
        self.assertAlmostEqual(bias[0] / (sigma ** 2 * k ** 3 / (n * c ** 2)), 1, delta=1e-4)

    def test_numerical_error_has_the_last_step(self):
        """Beside the best value the last step is the largest part of it."""
        model, _ = prepared({**STRAIN, "Fit/Variables": f"{P} : 0.2 to 6", "Fit/Markers at": ", ".join(map(repr, S.tolist()))}, [], tracks(STRAIN))
        problem, model.accuracy = Problem(model, model.data), 1e-6
        _, z, _ = problem.search(np.array([0.3]))
        best = _looked_at(problem, z + 0.01)
        self.assertAlmostEqual(best.z[0], z[0], delta=1e-3)
        self.assertGreater(best.numerical[0], 0.009)

    def test_each_variable_belongs_to_an_undetermined_direction(self):
        """Also where a looser one has all its variables, and where many share the deviation of each alike."""
        axes = np.linalg.qr(np.array([[1.0, 1, 1], [1, -1, 0], [1, 1, -2]]).T)[0].T
        loose, members = undetermined_directions(np.diag([1e-3, 1, 100]) @ axes)
        self.assertEqual((len(loose), members.tolist()), (1, [[True, True, True]]))
        for size in (1, 0.01):
            _, members = undetermined_directions(size * np.linalg.qr(np.random.default_rng(1).standard_normal((12, 12)))[0])
            self.assertTrue(members.any(axis=0).all() and members.any(axis=1).all())

    def test_few_data(self):
        """Ten numbers for three unknowns and an origin: no sentence is about nothing."""
        few = Samples("x", np.arange(5.0), T[:2], tracks(STRESS).values[:2, 1:6], list("abcde"))
        found = quiet_fit(STRESS, few, {name: RANGES[name] for name in (P, K, AMPLITUDE)}, standard_deviation=0.1, markers_at=S[1:6])
        self.assertEqual((found.status, [one["determined"] for one in found.variables.values()], len(found.undetermined) > 0), ("finished", 3 * [False], True))

    def test_deviation_beside_an_undetermined_direction(self):
        """The direction is one of round-off: the deviation of a variable that is not in it is that of the variable alone."""
        random = np.random.default_rng(1).standard_normal((2, 50))
        regular = 300 * random[0] / np.linalg.norm(random[0])
        matrix = covariance(np.stack([regular, 1e-8 * regular + 1e-8 * random[1]], axis=1))
        self.assertAlmostEqual(300 * np.sqrt(matrix[0, 0]), 1, delta=1e-3)
        data = tracks(STRESS)
        alone, beside = (fit(STRESS, data, *names, standard_deviation=NOISE) for names in ((P, K, AMPLITUDE), (P, GAMMA, K, AMPLITUDE)))
        self.assertAlmostEqual(beside.variables[P]["deviation"] / alone.variables[P]["deviation"], 1, delta=1e-3)

    def test_noise_is_found(self):
        found = fit(STRESS, tracks(STRESS), P, K, AMPLITUDE)
        n = found.goodness.degrees_of_freedom
        self.assertEqual(n, T.size * S.size - 4)
        self.assertAlmostEqual(found.goodness.series[0]["deviation"] / NOISE, 1, delta=4 / np.sqrt(2 * n))

    def test_interval_ends_where_chi_square_says(self):
        """With the variable held at an end and the others free, chi-square is larger by 1, and by 1.96 squared."""
        data = tracks(STRESS, noise=0.03)
        found = fit(STRESS, data, P, K, AMPLITUDE, standard_deviation=0.03)
        self.assertTrue(0 < found.variables[K]["bias"] < found.variables[K]["deviation"])  # the tracks tell 1/k
        for level, rise in (("interval_68", 1), ("interval_95", 3.8415)):
            for end in found.variables[P][level]:
                held = fit({**STRESS, P: end}, data, K, AMPLITUDE, standard_deviation=0.03)
                self.assertAlmostEqual(held.goodness.chi_square - found.goodness.chi_square, rise, delta=0.1 * rise)

    def test_interval_along_a_curved_valley(self):
        """The path of the centre tells the product of exponent and amplitude: where the derivatives at the best values lead
        beyond the range, the profile goes on from its last points."""
        scene = {**STRESS, BODY + "Length": 1, K: 1, AMPLITUDE: 0.25, "Time/End time": 3}
        data = self.path_of_centre(scene, np.linspace(0, 3, 61), 0.001, 3)
        variables = {P: (0.5, 5), AMPLITUDE: (0.02, 1)}
        found = quiet_fit({**scene, P: 1.7, AMPLITUDE: 0.2}, data, variables, standard_deviation=0.001)
        for end in found.variables[P]["interval_95"]:
            held = quiet_fit({**scene, P: end, AMPLITUDE: 0.5 if end < 2 else 0.15}, data, {AMPLITUDE: (0.02, 1)}, standard_deviation=0.001)
            self.assertAlmostEqual(held.goodness.chi_square - found.goodness.chi_square, 3.8415, delta=0.2)

    def test_leaves_a_minimum_beside_which_a_profile_is_lower(self):
        """Of chi-square 84 at a frequency of 0.91; it is 64 at 1.05, and the truth is 1.06."""
        scene = {**STRESS, BODY + "Length": 1.4, P: 2.18, K: 1.43, GAMMA: 0.25, AMPLITUDE: 0.29, WAVE + "Frequency": 1.06, WAVE + "Wave number": 0.87,
                 "Time/End time": 3.82}
        data = self.path_of_centre(scene, np.linspace(0, 3.82, 70), 0.001, 4)
        found = quiet_fit({**scene, P: 2.26, WAVE + "Frequency": 0.9}, data, {P: (-3, 6), WAVE + "Frequency": (0.5, 1.5)}, standard_deviation=0.001)
        self.assertLess(found.starts[0]["values"][WAVE + "Frequency"], 0.95)
        self.assertLess(abs(found.variables[WAVE + "Frequency"]["value"] - 1.06), 3 * found.variables[WAVE + "Frequency"]["deviation"])
        self.assertIn("chi-square has another minimum", " ".join(found.notes))

    def test_names_starts_that_end_at_a_rival(self):
        """A phase fits as well a cycle later."""
        found = crawler.fit(STRESS, tracks(STRESS), {WAVE + "Phase": (-7, 7)}, standard_deviation=NOISE, markers_at=S, starts=5)
        rivals = [note for note in found.notes if "another minimum that fits nearly as well" in note]
        low, high = found.variables[WAVE + "Phase"]["interval_95"]
        outside = [one for one in found.starts if one["residuals"] < 1.01 * NOISE and not low <= one["values"][WAVE + "Phase"] <= high]
        self.assertGreater(len(outside), 0)
        self.assertEqual([int(re.search(r"start (\d+)", note)[1]) for note in rivals], [one["start"] + 1 for one in outside])

    @staticmethod
    def path_of_centre(scene, t, noise, seed):
        """Path of the centre of mass of a run, as Samples with noise."""
        s = np.linspace(0, scene[BODY + "Length"], 401)
        x = np.trapz(crawler.run(scene, fields=t, places=s, accuracy=1e-8, check=True).fields.position, dx=1 / 400, axis=1)[:, None]
        return Samples("centre", np.zeros(1), t, x + noise * np.random.default_rng(seed).standard_normal(x.shape))

    def test_numerical_error_is_a_tenth(self):
        for noise in (1e-3, 1e-6, 1e-8):
            found = fit(STRESS, tracks(STRESS, noise), P, K, AMPLITUDE, standard_deviation=noise)
            for name, one in found.variables.items():
                self.assertLess(one["numerical_error"], 0.1 * one["deviation"])
                self.assertLess(abs(one["value"] - STRESS[name]), 5 * one["deviation"])

    def test_numerical_error_holds(self):
        for scene, names in ((STRESS, (P, K, AMPLITUDE)), (STRAIN, (P,))):
            data = tracks(scene)
            rough, fine = (fit(scene, data, *names, standard_deviation=NOISE, accuracy=accuracy) for accuracy in (1e-4, 1e-9))
            for name in names:
                one, other = rough.variables[name], fine.variables[name]
                self.assertGreater(one["numerical_error"], 0)
                self.assertLess(abs(one["value"] - other["value"]), one["numerical_error"] + other["numerical_error"] + 1e-4 * one["deviation"])

    def test_lists_are_filled_up(self):
        modes = {**STRAIN, "Active stress/Prescribed strain/Given by": "modes", "Active stress/Modes/Coefficients": "0, 0.2, 0.1"}
        name = "Active stress/Modes/Coefficients[5]"
        found = crawler.fit(modes, tracks({**modes, "Active stress/Modes/Coefficients": "0, 0.2, 0.1, 0, 0.05"}, 1e-3), {name: (-0.1, 0.2)},
                            markers_at=S, standard_deviation=1e-3)
        self.assertLess(abs(found.variables[name]["value"] - 0.05), 4 * found.variables[name]["deviation"])

    def test_stress_as_splines(self):
        """An active stress of which nothing is known but that it is smooth in time; it starts at nothing."""
        coefficients = 0.15 * np.random.default_rng(1).standard_normal(9)
        splines = {**STRESS, "Active stress/Generator": "modes", "Active stress/Modes/In time": "splines", "Active stress/Modes/Harmonics": 1,
                   "Active stress/Modes/Time cells": 1, "Active stress/Modes/Coefficients": ", ".join(map(repr, coefficients.tolist()))}
        found = crawler.fit({**splines, "Active stress/Modes/Coefficients": ", ".join(["0"] * 9)}, tracks(splines),
                            {"Active stress/Modes/Coefficients[1-9]": (-1, 1)}, standard_deviation=NOISE, markers_at=S)
        self.assertEqual((found.undetermined, len(found.variables)), ([], 9))
        self.assertLess(found.n_runs, 15 * 9)  # of a variable: a derivative in a step of the search, two at the end, two for the bias, two for the profile
        for one, truth in zip(found.variables.values(), coefficients):
            self.assertLess(abs(one["value"] - truth), 4 * one["deviation"])

    def test_profiles_and_constants_of_formulas(self):
        """Friction or stiffness as a few numbers along the body, in both interpolations, and the constants of a friction law and of a
        profile; the derivatives are those of runs."""
        friction, stiffness, flat = BODY + "Friction profile", BODY + "Elastic modulus profile", [1, 1, 1, 1]
        law = {**STRESS, "Ground/Friction law": "expression", "Ground/Expression": "b*w^a + 0.1"}
        for scene, entry, truth, start, names, limits in (
                (STRESS, friction, [0.5, 1.2, 2, 0.8], flat, "1234", (0.1, 8)),
                ({**STRESS, BODY + "Profile interpolation": "linear"}, stiffness, [1.2, 2.5, 1, 2], flat, "1234", (0.3, 8)),
                ({**STRESS, friction: "1 + g*(s/L)^n"}, BODY + "Constants", "g = 1.5, n = 2", "g = 0.7, n = 1.5", "gn", (0.1, 6)),
                (law, "Ground/Constants", "a = -1.5, b = 1.5", "a = -1, b = 1", "ab", (-4, 4))):
            values = truth if isinstance(truth, list) else [float(one.split("=")[1]) for one in truth.split(",")]
            variables = {f"{entry}[{name}]": limits if name != "b" else (0, 4) for name in names}
            with self.subTest(entry=entry):
                found = crawler.fit({**scene, entry: start}, tracks({**scene, entry: truth}), variables, standard_deviation=NOISE, markers_at=S)
                self.assertEqual((found.status, found.undetermined, found.notes), ("finished", [], []))
                for one, value in zip(found.variables.values(), values):
                    self.assertLess(abs(one["value"] - value), 4 * one["deviation"])
                first, step = next(iter(variables)), 1e-3
                exact = crawler.gradient({**scene, entry: truth}, first)
                sides = [crawler.run({**scene, entry: truth}, set={first: values[0] + side}, accuracy=1e-10, fields=False).displacement for side in (step, -step)]
                self.assertAlmostEqual(exact.derivatives[0] / ((sides[0] - sides[1]) / (2 * step)), 1, delta=1e-3)
        again = crawler.run({**law, "Ground/Constants": "a = 1, b = 1"}, set=found.settings, fields=False)
        self.assertEqual(again.parameters["Ground/Constants"], ", ".join(f"{name} = {one['value']!r}" for name, one in zip("ab", found.variables.values())))

    def test_places_of_the_first_frame(self):
        """Also of a body that has strain in the first frame, where markers are not where they are at rest."""
        for scene in (STRESS, STRAIN):
            found = crawler.fit({**scene, P: 1.5}, tracks(scene), {P: RANGES[P]}, standard_deviation=NOISE, starts=2)
            self.assertEqual(found.goodness.n_constants, 8)
            self.assertLess(abs(found.variables[P]["value"] - 2), 4 * found.variables[P]["deviation"])
            self.assertGreater(found.goodness.probability, 1e-3)


    def test_places_within_their_deviation(self):
        """Markers up to 0.14 away from where they are said to be: more than the spacing of two waves admits as linear."""
        pulls, said = [], {"markers_at": S, "place_deviation": 0.1, "standard_deviation": NOISE / 2}
        for seed in range(5):
            shifts = np.clip(0.1 * np.random.default_rng(seed).standard_normal(7), -0.14, 0.14)
            data = tracks(STRESS, NOISE / 2, seed)
            data.values += fields(STRESS, np.clip(S + shifts, 0, 2)).position - fields(STRESS).position
            found = crawler.fit({**STRESS, P: 1.8}, data, {P: RANGES[P], K: RANGES[K]}, **said)
            pulls.append((found.variables[P]["value"] - 2) / found.variables[P]["deviation"])
            self.assertGreater(found.goodness.probability, 1e-4)
        self.assertLess(np.sum(np.square(pulls)), 20.5)  # chi-square of 5, exceeded once in a thousand


class Together(unittest.TestCase):
    """Several kinds of data in one fit."""

    def test_information_adds_up(self):
        """Of independent data the inverse squares of the deviations of one variable do, and so does chi-square at one value."""
        strain = Samples("strain", S, T, fields(STRESS).stretch - 1 + NOISE * np.random.default_rng(3).standard_normal((41, 7)))
        kinds, noise = [tracks(STRESS, origin=0), strain, path(STRESS), path(STRESS, 0.02, "speed")], [NOISE, NOISE, NOISE, 0.02]
        alone = [fit(STRESS, one, P, standard_deviation=deviation, origin="tail") for one, deviation in zip(kinds, noise)]
        both = fit(STRESS, kinds, P, standard_deviation=noise, origin="tail")
        self.assertAlmostEqual(both.variables[P]["deviation"] ** -2 / sum(one.variables[P]["deviation"] ** -2 for one in alone), 1, delta=0.05)
        self.assertLess(abs(both.variables[P]["value"] - 2), 4 * both.variables[P]["deviation"])
        self.assertEqual([one["kind"] for one in both.goodness.series], ["markers", "strain", "centre", "speed"])
        self.assertAlmostEqual(sum(one["chi_square"] for one in both.goodness.series), both.goodness.chi_square, delta=1e-6)
        self.assertEqual(([one.shape for one in both.residuals], both.goodness.n_data), ([(41, 7), (41, 7), (41, 1), (41, 1)], 656))
        for residuals, deviation, one in zip(both.residuals, noise, both.goodness.series):
            self.assertAlmostEqual(np.sum(residuals ** 2) / deviation ** 2, one["chi_square"], delta=1e-6 * one["chi_square"])
        one, two = (fit(STRESS, kinds, P, standard_deviation=noise, origin="tail", workers=n, starts=2) for n in (1, 2))
        self.assertEqual(one, two)

    def test_one_origin_and_clock_for_all(self):
        """The path counts from where the tracks do, and begins later; places of markers stay free."""
        centre, data = path(STRESS), tracks(STRESS)
        centre.values, centre.t, data.t = centre.values[10:] + 3, centre.t[10:] + 5, data.t + 5
        found = crawler.fit({**STRESS, P: 1.8}, [data, centre], {P: RANGES[P]}, standard_deviation=[NOISE, NOISE], first_time=0)
        self.assertEqual(found.goodness.n_constants, 8)
        self.assertGreater(found.goodness.probability, 1e-3)
        self.assertLess(abs(found.variables[P]["value"] - 2), 4 * found.variables[P]["deviation"])

    def test_names_the_kind_of_the_largest_residual(self):
        speed = path(STRESS, 0.02, "speed")
        speed.values[20] += 0.3
        found = fit(STRESS, [tracks(STRESS), speed], P, standard_deviation=[NOISE, 0.02])
        self.assertIn("at the speed, t = 1 of the run", found.notes[0])


class Valley(unittest.TestCase):
    """Exponent and amplitude change the path of the centre of mass in nearly the same way: along a curved valley."""
    SCENE = {**STRESS, WAVE + "Frequency": 0.5, "Time/End time": 8}

    @classmethod
    def setUpClass(cls):
        t = np.linspace(0, 8, 60)
        centre = np.mean(crawler.run(cls.SCENE, fields=t, places=np.linspace(0.001, 1.999, 1000), accuracy=1e-8, check=True).fields.position, axis=1)
        cls.data = Samples("centre", np.zeros(1), t, (centre + 1e-4 * np.random.default_rng(1).standard_normal(60))[:, None])

    def from_start(self, exponent, amplitude):
        return quiet_fit({**self.SCENE, P: exponent, AMPLITUDE: amplitude}, self.data, {P: (0.5, 5), AMPLITUDE: RANGES[AMPLITUDE]}, standard_deviation=1e-4)

    def test_search_follows_it_to_its_end(self):
        far, near = self.from_start(3, 0.15), self.from_start(2, 0.3)
        for found in (far, near):
            self.assertEqual(found.status, "finished")
            self.assertLess(abs(found.variables[P]["value"] - 2), 3 * found.variables[P]["deviation"])
        self.assertAlmostEqual(far.variables[P]["value"], near.variables[P]["value"], delta=0.03 * near.variables[P]["deviation"])

    def test_search_that_does_not_end_has_values_so_far_only(self):
        with unittest.mock.patch("crawler.fitting.fit.MOST_STEPS", 5):
            found = self.from_start(3, 0.15)
        self.assertEqual((found.status, found.undetermined), ("failed", []))
        self.assertIn("did not end", found.message)
        for one in found.variables.values():
            self.assertEqual([one[key] for key in ("determined", "deviation", "interval_95", "profile")], [None, None, None, []])
        finished = self.from_start(2, 0.3)
        self.assertEqual((finished.keys() - found.keys(), finished.goodness.keys(), finished.goodness.series[0].keys(), finished.information.keys()),
                         (set(), found.goodness.keys(), found.goodness.series[0].keys(), found.information.keys()))
        self.assertEqual([found.goodness.chi_square, found.goodness.probability, found.goodness.largest_residual, found.information.aic, found.correlation,
                          found.goodness.series[0]["chi_square"]], 6 * [None])


class NoRun(unittest.TestCase):
    """Values at which there is no run, or one that would not end."""

    def test_inversion_at_once(self):
        """The active stress is beyond the modulus at t = 0: there is no step, and nothing between steps to show."""
        modes = {"Active stress/Generator": "modes", "Active stress/Modes/Coefficients": 2}
        self.assertEqual(crawler.run(modes, fields=[0, 1], places=[0.5]).reason, "inverted_at_end")

    def test_derivatives_beside_the_last_run(self):
        class Square(Model):
            def __init__(self):
                self.low, self.high, self.names, self.problem, self.is_refused = np.zeros(1), np.full(1, 2.0), ["x"], "inversion", False

            def choose_at(self, x):
                pass

            def __call__(self, x, is_similar=False):
                return np.full(3, x[0] ** 2 if x[0] <= self.end else np.nan), None
        model = Square()
        model.end = 1
        for value in (None, np.ones(3)):
            np.testing.assert_allclose(model.jacobian([1.0], value), 2, rtol=1e-3)
        model.end = 0.9
        with self.assertRaisesRegex(crawler.fitting.model.Failed, "beside x = 1 there is no run: inversion"):
            model.jacobian([1.0], np.ones(3))

    def test_search_without_derivatives_keeps_what_was_found(self):
        with unittest.mock.patch.object(Model, "jacobian", side_effect=crawler.fitting.model.Failed("beside x = 1 there is no run: inversion")):
            found = fit(STRAIN, tracks(STRAIN), P, standard_deviation=NOISE, starts=2)
        self.assertEqual((found.status, len(found.starts), found.variables[P]["deviation"]), ("failed", 2, None))
        self.assertIn("there is no run: inversion; the values are those so far, and not the best ones, so there are no deviations", found.notes[-1])

    def test_absurd_values_are_given_up(self):
        found = crawler.fit(STRESS, tracks(STRESS), {P: (-90, 90)}, standard_deviation=NOISE, markers_at=S, starts=3)
        self.assertRegex(" ".join(found.notes), "runs needed more than 500 steps and count as failed")
        self.assertLess(abs(found.variables[P]["value"] - 2), 4 * found.variables[P]["deviation"])


class Runs(unittest.TestCase):
    """Runs of a fit, which are without energies, gait and errors."""

    def test_are_those_of_a_run(self):
        """Also at other values than before, and with mesh and tolerance of a run beside it."""
        where = {"Fit/Markers at": ", ".join(map(repr, S.tolist()))}
        for scene, names in ((STRESS, (P, K)), (STRAIN, (P,))):
            model, _ = prepared({**scene, **where, "Fit/Variables": "; ".join(f"{name} : 0.3 to 6" for name in names)}, [], tracks(scene))
            model.accuracy = 1e-6
            for at, is_similar in ((2.0, False), (1.2, False), (1.2001, True), (2.0, True)):
                values, _ = model(np.full(len(names), at), is_similar=is_similar)
                alone = crawler.run({**scene, **{name: at for name in names}}, fields=T, places=S, accuracy=1e-6).fields.position
                np.testing.assert_allclose(values.reshape(alone.shape), alone, rtol=0, atol=1e-6 if is_similar else 1e-7)


class Untold(unittest.TestCase):
    """What the data do not tell is said, and not returned as a number."""

    def check(self, found, untold, *words):
        self.assertEqual({name for name, one in found.variables.items() if not one["determined"]}, set(untold))
        for name in untold:
            self.assertIsNone(found.variables[name]["value"])
        sentences = " ".join(found.undetermined)
        for word in (*words, *untold):
            self.assertIn(word, sentences)
        if not untold:
            self.assertEqual(found.undetermined, [])

    def test_degenerate_cases(self):
        for scene, data, names, untold, word in (
                (STRESS, tracks(STRESS), (GAMMA, K, AMPLITUDE), (GAMMA, K, AMPLITUDE), "common factor"),
                (STRESS, tracks(STRESS), (P, GAMMA, K, AMPLITUDE), (GAMMA, K, AMPLITUDE), "common factor"),
                (STRAIN, tracks(STRAIN), (GAMMA,), (GAMMA,), "any value"),
                (STRAIN, tracks(STRAIN), (P, GAMMA), (GAMMA,), "any value"),
                (STRAIN, tracks(STRAIN), (GAMMA, K), (GAMMA, K), "any value"),
                (STRESS, path(STRESS, 0.02), (P, AMPLITUDE), (P, AMPLITUDE), "apart")):
            with self.subTest(names=names, data=data.quantity):
                self.check(fit(scene, data, *names, standard_deviation=0.02 if data.quantity == "centre" else NOISE), untold, word)

    def test_regular_cases(self):
        for scene, data, names in ((STRESS, tracks(STRESS), (P, K, AMPLITUDE)), (STRESS, tracks(STRESS), (GAMMA, K)),
                                   (STRESS, tracks(STRESS), (P, GAMMA, AMPLITUDE)), (STRAIN, tracks(STRAIN), (P,)),
                                   (STRESS, path(STRESS, 1e-4), (P, GAMMA))):
            with self.subTest(names=names):
                self.check(fit(scene, data, *names, standard_deviation=1e-4 if data.quantity == "centre" else NOISE), ())

    def test_does_not_tell_what_may_be_anywhere_in_its_range(self):
        """A range of less than two deviations at each side."""
        data, settings = tracks(STRAIN), {"standard_deviation": NOISE, "markers_at": S}
        best = crawler.fit(STRAIN, data, {P: RANGES[P]}, **settings).variables[P]
        for width, untold in ((1.6, (P,)), (2.4, ())):
            ends = [float(best["value"] + side * width * best["deviation"]) for side in (-1, 1)]
            self.check(crawler.fit({**STRAIN, P: best["value"]}, data, {P: ends}, **settings), untold)

    def test_says_that_a_scene_does_not_fit(self):
        found = fit({**STRESS, WAVE + "Wave number": 1.3}, tracks(STRESS), P, K, standard_deviation=NOISE)
        self.assertIn("does not fit", found.notes[0])
        found = fit({**STRESS, WAVE + "Wave number": 1.3}, tracks(STRESS), P, K)
        self.assertIn("similar", " ".join(found.notes))

    def test_says_that_units_may_be_others(self):
        """Speeds for minutes, where the ranges are so wide that an end comes near; not where the scene fits."""
        variables, notes = {P: (0.2, 6), AMPLITUDE: (0.02, 0.9)}, []
        for start, factor, is_said in ((0.3, 60, True), (0.06, 1, False)):
            data = scaled(path(STRESS, 1e-3, "speed"), factor)
            found = crawler.fit({**STRESS, AMPLITUDE: start}, data, variables, standard_deviation=1e-3 * factor)
            notes.append(" ".join(found.notes))
            self.assertEqual("if that is not meant" in notes[-1], is_said, notes[-1])
        self.assertRegex(notes[0], r"its speed is 1\.\d+ in the data \(root mean square\), about [5-7]\d times the 0.02\d+ with the values of the scene")

    def test_says_that_data_fit_too_well(self):
        found = fit(STRESS, tracks(STRESS), P, standard_deviation=10 * NOISE)
        self.assertIn("nearer to the scene", found.notes[0])

    def test_strain_of_the_same_tracks_is_not_exact(self):
        with tempfile.TemporaryDirectory() as folder:
            table = pathlib.Path(folder, "strain.csv")
            table.write_text("s,t,strain\n" + "".join(f"{s},{t},{0.2 * np.sin(np.pi * (s - 2 * t))}\n" for s in np.linspace(0, 2, 33) for t in T))
            scene = {**STRAIN, "Active stress/Prescribed strain/Given by": "table", "Active stress/Prescribed strain/File": str(table)}
            self.assertIn("taken as exact", " ".join(fit(scene, tracks(scene), P, standard_deviation=NOISE).notes))

    def test_entries_without_effect(self):
        found = crawler.fit({**STRAIN, P: 1.8}, path(STRAIN), {P: RANGES[P]}, standard_deviation=NOISE, set={"Fit/Place deviation": "0.1"})
        self.assertIn('"Fit/Place deviation" has no effect', " ".join(found.notes))

    def test_entries_that_a_variable_gives_an_effect(self):
        scene, ratio = {**STRESS, "Fit/Variables": "Ground/Backward ratio : 0.5 to 2"}, "Ground/Switching velocity=0.1"
        self.assertEqual(prepared(scene, [ratio], path(STRESS))[1], [])
        self.assertIn("no effect", prepared({**scene, "Fit/Variables": f"{P} : 1 to 3"}, [ratio], path(STRESS))[1][0])

    def test_data_that_are_short_beside_the_run(self):
        data, sentence = path(STRESS), 'last 0.002, 1/1000 of the run (Time/End time is 2): see "--unit-of-t"'
        data.t = data.t / 1000
        with self.assertRaisesRegex(crawler.InputError, re.escape(sentence)):  # the body does not come so far
            fit(STRESS, data, P)
        data.values = 1e-6 * data.values
        self.assertIn(sentence, fit(STRESS, data, P).notes[0])

    def test_says_that_a_value_is_at_its_limit(self):
        found = crawler.fit({**STRAIN, P: 1.5}, tracks(STRAIN), {P: (0.5, 1.8)}, standard_deviation=NOISE)
        self.assertEqual((found.variables[P]["at_limit"], found.variables[P]["interval_95"][1]), ("to", None))
        self.assertRegex(" ".join(found.notes), "at the limit of its range, 1.8:.*one-sided.*no deviation")
        self.assertIsNone(found.variables[P]["deviation"])
        self.assertRegex(repr(found), "at the limit of its range.*1 start: the minimum may be local")
        for level, rise in (("interval_68", 1), ("interval_95", 3.8415)):  # from the limit to where chi-square says
            end = found.variables[P][level][0]
            held = crawler.fit({**STRAIN, P: end}, tracks(STRAIN), {P: (end, end + 1e-6)}, standard_deviation=NOISE)
            self.assertAlmostEqual(held.goodness.chi_square - found.goodness.chi_square, rise, delta=0.1 * rise)
        near = crawler.fit(STRAIN, tracks(STRAIN), {P: (1.92, 100)}, standard_deviation=NOISE, markers_at=S)  # in a wide range
        self.assertTrue(all(near.variables[P]["interval_95"]))
        self.assertEqual((near.variables[P]["at_limit"], near.notes), ("", []))

    def test_names_the_largest_residual(self):
        """A wrong number makes a scene fail; of it and its place speaks the first sentence, and none of what the data tell."""
        for size, name, words in ((300, GAMMA, ("does not fit", "marker 4, t = 1 of the run")), (10, P, ("perhaps an outlier", "marker 4, t = 1 of the run"))):
            data = tracks(STRAIN)
            data.values[20, 4] += size * NOISE
            found = fit(STRAIN, data, name, standard_deviation=NOISE)
            for word in words:
                self.assertIn(word, found.notes[0])
            self.assertEqual(found.undetermined, [])
            self.assertEqual(f"there is no deviation of {GAMMA}" in " ".join(found.notes), name == GAMMA)
            self.assertAlmostEqual(abs(found.goodness.largest_residual.deviations) / size, 1, delta=0.5)


class Screen(unittest.TestCase):
    """Lines on the screen."""

    def lines(self, every, **more):
        """Those of a fit that may print one each so many seconds."""
        text = io.StringIO()
        with unittest.mock.patch("crawler.fitting.progress.EVERY", every), contextlib.redirect_stdout(text):
            fit(STRESS, tracks(STRESS), P, K, standard_deviation=NOISE, verbose=True, **more)
        return text.getvalue().splitlines()

    def test_says_what_it_does(self):
        """Behind each run if no time is to pass between; only beginnings and ends if that is long."""
        lines = self.lines(0, starts=2, accuracy=1e-4)
        for words in ("first runs: 1 runs", "start 1 of 2: 3 runs, residuals 0.", "start 2 of 2: 3 runs", "start 2 of 2: residuals", "derivatives at the best values: 1 ",
                      "curvature at the best values: 1 ", f"profile of chi-square of {P}: 1 ", f"profile of chi-square of {K}: 1 "):
            self.assertTrue(any(line.startswith(words) for line in lines), f"{words} is missing in {lines}")
        counted = [int(found[1]) for line in lines if (found := re.match(r"start 1 of 2: (\d+) runs", line))]
        self.assertEqual(counted, list(range(1, len(counted) + 1)))
        self.assertEqual([line.split(":")[0] for line in self.lines(1e6, starts=2)], ["start 1 of 2", "start 2 of 2"])

    def test_says_what_other_processes_do(self):
        last = [line for line in self.lines(0, starts=2, workers=2) if line.startswith("searches on 2 processes")][-1]
        self.assertRegex(last, r": [1-9]\d* runs, residuals 0\.\d+ so far")


class Workers(unittest.TestCase):
    """Processes that share the starts."""

    def test_signal_of_another_thread_waits_until_they_are_known(self):
        def signal_here():
            signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
            os.kill(os.getpid(), signal.SIGINT)

        ended, thread = False, threading.Thread(target=signal_here)
        with self.assertRaises(KeyboardInterrupt):
            with _without_signals():
                thread.start()
                thread.join()
                ended = True
        self.assertTrue(ended)


class Files(unittest.TestCase):
    """What crawler fit writes."""

    def test_folder_is_read(self):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder)
            (place / "residuals.csv").write_text("t,place,data,model,residual\n0,1,2,2.5,-0.5\n", encoding="utf-8")
            (place / "summary.json").write_text('{"status": "finished", "variables": {"Body/Length": {"value": 2}}}', encoding="utf-8")
            study = crawler.read(place)
            self.assertEqual((study.kind, study.variables["Body/Length"].value, float(study.table["residual"][0])), ("fit", 2, -0.5))


    def test_path_is_read_in_its_units(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "path.csv")
            for head, factor in (("t [ms],centre [mm]", 1e-3), ("t [ms],speed [mm/s]", 1e-3), ("t [ms],speed [mm/min]", 1e-3 / 60), ("t [ms],speed [mm]", 1)):
                file.write_text(f"{head}\n100,2\n200,3\n", encoding="utf-8")
                samples = read_samples(file, unit_of_s="m", unit_of_t="s")
                self.assertEqual((samples.quantity, samples.values.shape), (head[7:].split()[0], (2, 1)))
                np.testing.assert_allclose(samples.t, (0.1, 0.2))
                np.testing.assert_allclose(samples.values[:, 0], (2 * factor, 3 * factor))
            with self.assertRaisesRegex(crawler.InputError, "--head.*along a body"):
                read_samples(file, head="x")
            with self.assertRaisesRegex(crawler.InputError, "crawler fit"):
                prepare(read_samples(file), Settings())

    def test_says_what_was_in_another_order(self):
        """Markers of which two stand in each other's place, and a time with one wrong digit."""
        x, order = tracks(STRAIN).values, [0, 1, 2, 4, 3, 5, 6]
        for t, words in ((T, ("the markers put in order along the body: x1, x2, x3, x5, x4",)), (np.where(np.arange(41) == 33, 0.165, T),
                         ("do not increase in the file: t = 0.165 in row 35 comes after 1.6;", "put in order along the body"))):
            text = "t," + ",".join(f"x{i + 1}" for i in range(7)) + "\n" + "".join(
                f"{at:.9g}," + ",".join(map(repr, row[order].tolist())) + "\n" for at, row in zip(t, x))
            with tempfile.TemporaryDirectory() as folder:
                file = pathlib.Path(folder, "tracks.csv")
                file.write_text(text, encoding="utf-8")
                notes = fit(STRAIN, read_samples(file), P, standard_deviation=1).notes
            for word in words:
                self.assertIn(word, " ".join(notes))
            self.assertEqual("do not increase" in " ".join(notes), len(words) == 2)


    def test_tracks_in_hdf5(self):
        """A plain file, one of SLEAP and one of DeepLabCut fit as the same numbers in a table."""
        try:
            import h5py
        except ImportError:
            self.skipTest("no h5py")
        data = tracks(STRAIN, seed=4)
        said = {"standard_deviation": NOISE, "markers_at": S}
        wanted = crawler.fit({**STRAIN, P: 1.8}, data, {P: RANGES[P]}, **said)
        names = [f"m{i}" for i in range(7)]
        heads = [("someone", name, part) for name in names for part in ("x", "y", "likelihood")]
        numbers = np.stack([data.values, np.zeros((41, 7)), np.ones((41, 7))], axis=2).reshape(41, 21)
        rows = np.zeros(41, dtype=[("index", "<i8"), ("values_block_0", "<f8", (21,))])
        rows["index"], rows["values_block_0"] = np.arange(41), numbers
        with tempfile.TemporaryDirectory() as folder:
            plain, sleap, deeplabcut, other = (pathlib.Path(folder, f"{name}.h5") for name in ("plain", "sleap", "deeplabcut", "other"))
            with h5py.File(plain, "w") as file:
                file["t"], file["x"] = data.t, data.values
            with h5py.File(sleap, "w") as file:
                file["tracks"], file["node_names"] = np.stack([data.values.T, np.zeros((7, 41))])[None], [name.encode() for name in names]
            with h5py.File(deeplabcut, "w") as file:
                file["df_with_missing/table"] = rows
                file["df_with_missing"].attrs["non_index_axes"] = np.bytes_(pickle.dumps([(1, heads)], 0))
            for path in (plain, sleap, deeplabcut):
                found = crawler.fit({**STRAIN, P: 1.8}, read_samples(path, unit_of_t="" if path is plain else "1/20"), {P: RANGES[P]}, **said)
                self.assertAlmostEqual(found.variables[P]["value"], wanted.variables[P]["value"], delta=1e-6, msg=path.name)
            for axes, word in ((pickle.dumps(print, 0), "names of columns"), (pickle.dumps([(1, heads[1:])], 0), "20 names of columns")):
                with h5py.File(other, "w") as file:
                    file["df_with_missing/table"] = rows
                    file["df_with_missing"].attrs["non_index_axes"] = np.bytes_(axes)
                with self.assertRaisesRegex(crawler.InputError, word):
                    read_samples(other)
            with h5py.File(other, "w") as file:
                file["t"], file["x"] = data.t, data.values.T
            with self.assertRaisesRegex(crawler.InputError, "41 times x markers are expected.*reversed"):
                read_samples(other)


class Refusals(unittest.TestCase):
    """One sentence each."""

    def refused(self, sentence, scene=STRAIN, data=None, variables=None, **settings):
        with self.assertRaises((crawler.InputError, crawler.FileError)) as caught:
            crawler.fit(scene, tracks(STRAIN) if data is None else data, {P: (0.2, 6)} if variables is None else variables, **settings)
        self.assertIn(sentence, str(caught.exception))

    def test_bad_input(self):
        few = Samples("centre", np.zeros(1), T[:2], np.zeros((2, 1)))
        late = Samples("centre", np.zeros(1), T + 1, np.zeros((41, 1)))
        wide = Samples("strain", 2 * S, T, np.zeros((41, 7)))
        inverted, micrometres = {**STRESS, AMPLITUDE: 5}, tracks(STRAIN)
        micrometres.values *= 1000
        for sentence, more in (
                ("more data or fewer variables", {"data": few}), ("Time/End time", {"data": late}), ("Body/Length", {"data": wide}),
                ("samples of m", {"data": Samples("m", S, T, np.zeros((41, 7)))}), ("Fit/Data is empty", {"data": ""}),
                ("nowhere.csv", {"data": "nowhere.csv"}), ("2 places, but", {"markers_at": "0, 1"}), ("increasing places", {"markers_at": [6, 5, 4, 3, 2, 1, 0]}),
                ("a list of numbers is expected", {"markers_at": "here"}), ('Variables" is empty', {"variables": {}}),
                ("Anchoring exponent", {"variables": {BODY + "Anchoring exponnent": (1, 2)}}), ("in its range", {"variables": {P: (3, 4)}}),
                ("whose Body/Length is 3", {"set": {BODY + "Length": 3}}), ("Standard deviation", {"place_deviation": 0.1}),
                ('"Fit/Place deviation" is 0.5, but less than 0.5', {"place_deviation": 0.5, "standard_deviation": NOISE, "markers_at": S}),
                ('"Body/Length" from 1.5 to 4, but the outermost marker is at 2', {"variables": {BODY + "Length": (1.5, 4)}, "markers_at": S}),
                ("a list of places", {"variables": {BODY + "Length": (1.9, 4)}}), ("data do not depend", {"variables": {"Time/End time": (2, 4)}}),
                ("of the type ndarray, but the name of a file or measured.Samples", {"data": np.zeros((41, 7))}),
                ("of the type ndarray", {"data": (T, np.zeros(41))}), ("measured.read_samples(NAME, unit_of_t=...)", {"unit_of_t": "1/30"}),
                ("the time 1.95 after 2", {"data": Samples("centre", np.zeros(1), T[::-1], np.zeros((41, 1)))}),
                ("the data have inf at t = 0", {"data": Samples("centre", np.zeros(1), T, np.full((41, 1), np.inf))}),
                ("the deviation 0 at t = 0", {"data": Samples("centre", np.zeros(1), T, np.zeros((41, 1)), deviation=np.zeros((41, 1)))}),
                ("one of the two", {"data": Samples("centre", np.zeros(1), T, np.zeros((41, 1)), deviation=np.ones((41, 1))), "standard_deviation": 1}),
                ("the standard deviation of number 2 of the data is not known", {"data": [tracks(STRAIN), path(STRESS)], "standard_deviation": [NOISE, "automatic"]}),
                ("2 of them are expected", {"data": [tracks(STRAIN), path(STRESS)], "standard_deviation": NOISE}),
                ('has "-1" for number 2', {"data": [tracks(STRAIN), path(STRESS)], "standard_deviation": [NOISE, -1]}),
                ("number 2 of the data has no numbers", {"data": [tracks(STRAIN), Samples("centre", np.zeros(1), T, np.full((41, 1), np.nan))], "standard_deviation": [1, 1]}),
                ("Fit/Data is empty", {"data": []}), ("one file of each kind is expected", {"data": [tracks(STRAIN), tracks(STRAIN)]}),
                ("shape (41,)", {"data": Samples("centre", np.zeros(1), T, np.zeros(41))}),
                ("[1] to [4] are", {"scene": {**STRAIN, BODY + "Friction profile": "1, 1, 1, 1"}, "variables": {BODY + "Friction profile[5]": (0.1, 2)}}),
                ("numbers at equally spaced places", {"variables": {BODY + "Friction profile[1]": (0.1, 2)}}),
                ('"rate" is expected', {"scene": {**STRAIN, BODY + "Friction profile": "1+rate*s", BODY + "Constants": "rate=1"}, "variables": {BODY + "Constants[rat]": (0.1, 2)}}),
                ("is 0 at s = 1", {"scene": {**STRAIN, BODY + "Friction profile": "2+rate*s", BODY + "Constants": "rate=1"}, "variables": {BODY + "Constants[rate]": (-2, 2)}}),
                ("times their distance on the body", {"data": micrometres, "markers_at": S}),
                ("Switching velocity is automatic, but a velocity", {"scene": STRESS, "variables": {"Ground/Backward ratio": (0.5, 2)}, "markers_at": S}),
                ("the path of the centre of mass varies by 15", {"scene": STRESS, "data": scaled(path(STRESS), 1000), "standard_deviation": 1}),
                ("varies by 0 in the data (root mean square), beside the", {"scene": STRESS, "data": Samples("centre", np.zeros(1), T, np.ones((41, 1))), "variables": {K: (1, 2)}}),
                ("its speed is 1.5", {"scene": STRESS, "data": scaled(path(STRESS, kind="speed"), 60), "variables": {K: (1, 2), AMPLITUDE: (0.2, 0.4)}}),
                ("no run within the ranges of Fit/Variables comes near", {"scene": STRESS, "data": scaled(path(STRESS, 1e-4), 1e-3), "variables": {K: (1, 2)}}),
                ("cannot be run", {"scene": inverted, "variables": {AMPLITUDE: (4, 6)}})):
            with self.subTest(sentence=sentence):
                self.refused(sentence, **more)

    def test_reads_columns_of_a_path(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "path.csv")
            for text, sentence in (("centre,x\n1,2\n2,3\n", "t is expected"), ("t,centre\n1,2\n1,3\n", "increasing times"),
                                   ("t,speed\n0,0.1\n", "more data")):
                file.write_text(text, encoding="utf-8")
                self.refused(sentence, data=str(file))


if __name__ == "__main__":
    unittest.main()
