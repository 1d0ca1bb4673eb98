#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler.measured: smoothing splines against what is known of them, gaps, periods and strain of known motions, and the
files of trackers, of which each must give the strain of the same body.

    python3 -m unittest tests/python/measured.py
"""
import pathlib
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "contrib/python"))
from crawler.measured import Samples, Settings, estimated_noise, find_period, prepare, read_samples  # noqa: E402
from crawler.measured.splines import SmoothingSpline, periodic_spline  # noqa: E402
from crawler.needs import FileError, InputError  # noqa: E402

PI = np.pi
WIDE = "t;0;0.5;1;1.5\n0;1;2;3;4\n1;5;6;7;8\n2;9;10;11;12\n3;13;14;15;16\n"


def samples_of(function, n_s, n_t, duration, quantity="m"):
    """Samples of f(s, t) for 0 <= s <= 1."""
    s, t = np.linspace(0, 1, n_s), np.linspace(0, duration, n_t)
    return Samples(quantity, s, t, function(s, t[:, np.newaxis]), [str(i) for i in range(n_s)])


def read(text, name="file.csv", **options):
    """Samples of the text of a file."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, name)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_samples(path, **options)


class Splines(unittest.TestCase):
    """Against discrete eigenvalues, polynomials and orders."""

    def test_damps_periodic_waves_as_known(self):
        """A wave stays a wave, times 1/(1 + lambda mu) with the discrete eigenvalue mu of the fourth derivative."""
        for n in (5, 6, 11, 24):
            for k in (0, 1, 2):
                h, width, q = 1 / n, 0.7, 2 * PI * k
                x = np.linspace(0, 1, n + 1)
                y = np.cos(q * x + 0.3)
                curve = periodic_spline(x, y, width, np.ones(n + 1))
                second, mass = (2 * np.cos(q * h) - 2) / h, h * (4 + 2 * np.cos(q * h)) / 6
                part = 1 / (1 + (width / (2 * PI))**4 / h * second**2 / mass)
                np.testing.assert_allclose(curve(x), part * y, atol=1e-12)
                np.testing.assert_allclose(curve(x, 2), part * y * second / mass, atol=1e-9)

    def test_halves_waves_as_long_as_the_width(self):
        x = np.linspace(0, 1, 401)
        curve = periodic_spline(x, np.sin(8 * PI * x), 0.25, np.ones(401))
        self.assertAlmostEqual(float(curve(1 / 16)), 0.5, delta=1e-4)

    def test_keeps_cubic_polynomials(self):
        x = np.array([1, 1.2, 1.9, 2, 3.3, 4, 4.4, 6])
        cubic = np.polynomial.Polynomial([2, -1, 0.5, -0.3])
        places = np.array([1, 1.5, 3, 5.9])
        for width in (0, 0.1, 1, 10):
            curve = SmoothingSpline(x, cubic(x), width)
            np.testing.assert_allclose(curve(places), cubic(places), atol=1e-9)
            np.testing.assert_allclose(curve(places, 1), cubic.deriv()(places), atol=1e-8)

    def test_keeps_slopes_at_the_ends(self):
        """Of waves three times as long as the width; a width of nearly nothing does nothing."""
        for n, width, most in ((10, 0.3, 0.1), (19, 0.3, 0.08), (40, 0.3, 0.08), (40, 1e-3, 0.01)):
            x = np.linspace(0, 0.9, n + 1)
            errors = [SmoothingSpline(x, np.sin(2 * PI * (x + phase)), width)(x[[0, -1]], 1) / (2 * PI)
                      - np.cos(2 * PI * (x[[0, -1]] + phase)) for phase in np.arange(16) / 16]
            self.assertLess(np.max(np.abs(errors)), most, (n, width))

    def test_bias_is_of_fourth_order(self):
        x = np.linspace(0, 1, 801)
        bias = [abs(SmoothingSpline(x, np.sin(5 * x), width)(0.5) - np.sin(2.5)) for width in (0.1, 0.05)]
        self.assertAlmostEqual(np.log2(bias[0] / bias[1]), 4, delta=0.1)


class Preparation(unittest.TestCase):
    """Tables of known functions."""

    def test_fills_gaps_of_cubics_exactly(self):
        def f(s, t):
            return 1 + s - t + 2 * t**2 - 3 * t**3 + s * t**3 - s**3
        samples = samples_of(f, 6, 12, 1)
        truth = samples.values.copy()
        samples.values[[4, 5, 6, 9], 2] = np.nan
        samples.values[0, 3] = np.nan  # from its neighbours along the body
        for width in (0, 0.5):
            np.testing.assert_allclose(prepare(samples, Settings(smooth_t=width)).values, truth, atol=1e-9)
        samples.values[5:9, 1:5] = np.nan
        with self.assertRaisesRegex(InputError, "in a row, but at most 3"):
            prepare(samples, Settings())

    def test_finds_periods(self):
        period = 0.7310987

        def f(s, t):
            x = 2 * PI * (t / period - s)
            return np.exp(np.cos(x)) + 0.4 * np.sin(2 * x)
        for cycles in (1.4, 2, 5.3):
            samples = samples_of(f, 5, int(40 * cycles), cycles * period)
            self.assertAlmostEqual(find_period(samples), period, delta=1e-4 * period)
            table = prepare(samples, Settings(period="find"))
            np.testing.assert_array_equal(table.values[0], table.values[-1])
            np.testing.assert_allclose(table.values, f(table.s, table.t[:, np.newaxis]), atol=2e-3)
        drift = samples_of(lambda s, t: s + t, 5, 50, 1)
        self.assertIsNone(find_period(drift))
        with self.assertRaisesRegex(InputError, "more than 5 times the noise"):
            prepare(drift, Settings(period="whole"))

    def test_averages_noisy_cycles(self):
        """The noise of the table is smaller than that of the samples."""
        def f(s, t):
            return np.sin(2 * PI * (s + t))
        samples = samples_of(f, 9, 401, 10)
        samples.values += np.random.default_rng(3).normal(0, 0.05, samples.values.shape)
        self.assertAlmostEqual(estimated_noise(samples), 0.05, delta=0.002)
        samples.values[100:103, 4] = np.nan
        table = prepare(samples, Settings(smooth_t=0.2, period="find"))
        self.assertAlmostEqual(table.period, 1, delta=2e-3)
        error = table.values - f(table.s, table.t[:, np.newaxis])
        self.assertLess(np.sqrt(np.mean(error**2)), 0.05 / np.sqrt(10))

    def test_smooth_waves_are_no_noise(self):
        """Not even with eight samples in a cycle: a cycle that does not close by a sixth of its amplitude is refused."""
        samples = samples_of(lambda s, t: 0.3 * np.sin(2 * PI * (s + t)) + 0.05 * t, 9, 9, 1)
        self.assertLess(estimated_noise(samples), 5e-4)
        with self.assertRaisesRegex(InputError, "more than 5 times the noise"):
            prepare(samples, Settings(period="whole"))

    def test_noise_of_uneven_times(self):
        """Is the same as that of even ones."""
        random = np.random.default_rng(1)
        t = np.concatenate([np.arange(60) / 10, 6 + np.arange(60) / 5]) + random.uniform(-0.02, 0.02, 120)
        s = np.linspace(0, 1, 9)
        values = np.sin(s + 0.5 * t[:, np.newaxis]) + random.normal(0, 0.01, (120, 9))
        self.assertAlmostEqual(estimated_noise(Samples("m", s, t, values)), 0.01, delta=0.001)

    def test_turns_tracks_into_strain(self):
        """Without noise the error falls with the third power of the distance of markers."""
        def strain(s, t):
            return 0.3 * np.sin(PI * t) * np.cos(2 * PI * s + t)

        def place(s, t):
            return 5 + s + 0.1 * t + 0.3 * np.sin(PI * t) * (np.sin(2 * PI * s + t) - np.sin(t)) / (2 * PI)

        def error(n, width):
            table = prepare(samples_of(place, n, 21, 0.8, "x"), Settings(smooth_s=width))
            self.assertEqual((table.quantity, table.s[-1]), ("strain", 1))
            return np.max(np.abs(table.values - strain(table.s, table.t[:, np.newaxis])))
        self.assertLess(error(11, 0), 0.02)
        self.assertAlmostEqual(np.log2(error(17, 0) / error(33, 0)), 3, delta=0.4)
        self.assertLess(error(33, 0.2), 0.03)  # smoothing flattens it, most at the ends
        self.assertLess(error(33, 0.1), 0.01)

    def test_lost_points_of_tracks(self):
        """A point lost between measured ones is filled, also beside an end; only frames before a marker appears, or after it
        has vanished, are left out; both are counted in words, and a longer gap is refused with its place."""
        tracks = samples_of(lambda s, t: 2 * s + 0.01 * t**3, 5, 12, 11, "x")
        settings = Settings(gap=2, markers_at="0,0.5,1,1.5,2")

        def prepared(*lost):
            cut = Samples("x", tracks.s, tracks.t, tracks.values.copy(), tracks.names)
            for marker, frames in lost:
                cut.values[frames, marker] = np.nan
            return prepare(cut, settings)

        for lost, times, words in (([(2, [5])], tracks.t, "1 gap filled, up to 1 in a row"),
                                   ([(0, [0]), (2, [1, 5, 6])], tracks.t[1:], "3 gaps filled, up to 2 in a row"),
                                   ([(4, [10, 11]), (1, [9, 5])], tracks.t[:10], "2 gaps filled, up to 1 in a row")):
            table = prepared(*lost)
            np.testing.assert_array_equal(table.t, times - times[0])  # a prescribed strain begins at 0
            np.testing.assert_allclose(table.values, 0, atol=1e-12)
            n = len(tracks.t) - len(times)
            left_out = [word for word in table.words if "left out" in word]
            self.assertEqual(left_out, [f"{n} frame{'s' if n > 1 else ''} at the beginning or end left out, in which markers are missing"] if n else [])
            self.assertIn(words, table.words)
        with self.assertRaisesRegex(InputError, "marker 2 from t = 1 to 3, 3 samples in a row"):
            prepared((2, [1, 2, 3]))
        with self.assertRaisesRegex(InputError, "marker 2 from t = 0 to 2, the beginning"):
            prepared((2, [0, 1, 2]))

    def test_extrapolates_strain_as_stated(self):
        """The strain 0.2 t s of a body from 0 to 1, with markers from 0.2 to 0.8."""
        tracks = samples_of(lambda part, t: 0.2 + 0.6 * part + 0.1 * t * (0.2 + 0.6 * part)**2, 7, 5, 1, "x")
        for ends, tail, head in (("hold", 0.04, 0.16), ("linear", 0, 0.2)):
            table = prepare(tracks, Settings(points_s=6, first_marker=0.2, length=1, ends=ends))
            np.testing.assert_allclose(table.values[4, [0, 5]], [tail, head], atol=1e-9)
            np.testing.assert_array_equal(table.values[0], 0)


class Files(unittest.TestCase):
    """What instruments write, and what is refused."""

    def test_reads_one_table_in_many_styles(self):
        expected = read(WIDE)
        np.testing.assert_array_equal(expected.s, [0, 0.5, 1, 1.5])
        self.assertEqual(expected.values[2, 1], 10)
        rows = WIDE.split("\n", 1)[1]
        for text in ("\ufefft;0,0;0,5;1,0;1,5\r\n" + rows.replace("\n", "\r\n"), "sep=;\n" + WIDE, WIDE.replace(";", ","),
                     "# made today\nMy title;;;;\ntime [ms];0;0.5;1;1.5\nms;N;N;N;N\n" + rows,
                     '"t"\t0\t0,5\t1\t1,5\n' + rows.replace(";", "\t"), "# t 0 0.5 1 1.5\n" + rows.replace(";", " "),
                     "".join(line + ";\n" for line in WIDE.splitlines())):
            samples = read(text)
            np.testing.assert_array_equal(samples.s, expected.s, text)
            np.testing.assert_array_equal(samples.values, expected.values, text)
        longer = "m;s;t\n" + "".join(f"{'NaN' if (i, j) == (1, 2) else 1 + i + 4 * j};{5 * i}e-1;{j}\n" for i in range(4) for j in range(4))
        samples = read(longer)
        self.assertTrue(np.isnan(samples.values[2, 1]) and samples.values[3, 1] == 14)

    def test_turns_units_and_shifts(self):
        samples = read(WIDE.replace("t;", "t [ms];", 1), unit_of_s="4", unit_of_t="s", unit_of_m="-1", shift_s="2", shift_t="first")
        np.testing.assert_array_equal(samples.s, [2, 4, 6, 8])
        self.assertAlmostEqual(samples.t[3], 3e-3, delta=1e-18)
        self.assertEqual(samples.values[0, 0], -1)
        self.assertAlmostEqual(read(WIDE, unit_of_t="1/30").t[3], 0.1, delta=1e-15)

    def test_seconds_since_1970_lose_their_round_off(self):
        text = "t;0;0.5;1;1.5\n" + "".join(f"{1580724432 + j / 10:.3f};1;2;3;{j}\n" for j in range(17))
        np.testing.assert_array_equal(read(text, shift_t="first").t, np.round(np.arange(17) / 10, 6))

    def test_noise_is_no_bend(self):
        """Markers on a straight line with noise in y are read along it, those of a body that bends along the body; a cell that is no
        number is named by all rows of its head."""
        noise, t, x = np.random.default_rng(1), np.arange(60), np.arange(9)
        rows = ["scorer" + ",net" * 18, "bodyparts" + "".join(f",m{i},m{i}" for i in range(9)), "coords" + ",x,y" * 9]
        for bend, along in ((0, "x and y lie on a straight line"), (1.5, "the body bends, by")):
            y = bend * np.sin(0.8 * x - 0.2 * t[:, None]) + 0.06 * noise.standard_normal((60, 9))
            lines = rows + [",".join([str(j), *(f"{x[i] + 0.01 * j:.3f},{y[j, i]:.3f}" for i in range(9))]) for j in t]
            words = []
            samples = read("\n".join(lines), words=words)
            self.assertTrue([word for word in words if word.startswith(along)], words)
            self.assertAlmostEqual(np.mean(np.diff(samples.values, axis=1)), 1 if bend == 0 else np.mean(np.hypot(1, np.diff(y, axis=1))), delta=1e-3)
        with self.assertRaisesRegex(InputError, '"none of it" under m2 y,'):
            read("\n".join(lines[:-1] + [lines[-1].replace(lines[-1].split(",")[6], "none of it")]))

    def test_columns_beside_markers(self):
        """What is not of a marker is left out, and that is said."""
        words = []
        samples = read("t,x1,x2,x3,x4,speed\n" + "".join(f"{j},1,2,3,4,{j}\n" for j in range(5)), words=words)
        self.assertEqual((samples.quantity, samples.values.shape), ("x", (5, 4)))
        self.assertIn("beside the columns of markers left out: speed", words)

    def test_arguments_are_of_their_kinds(self):
        """In one sentence, also of the classes."""
        good = samples_of(lambda s, t: s + t, 5, 9, 1)
        for action, words in ((lambda: read_samples(None), '"path" is None, but a text or a path is expected'),
                              (lambda: read_samples("a.csv", confidence="high"), "\"confidence\" is 'high', but a number"),
                              (lambda: prepare(None, Settings()), '"samples" is None, but a Samples'),
                              (lambda: prepare(good, Settings(markers_at=["a"])), "a list of numbers"),
                              (lambda: prepare(Samples("m", good.s, good.t, good.values.T), Settings()), r"\(time, place\) are expected"),
                              (lambda: find_period(Samples("m", good.s, good.t, np.full((9, 5), np.nan))), "have gaps")):
            with self.assertRaisesRegex(InputError, words):
                action()

    def test_clock_times_and_per_cent(self):
        """Over midnight; a strain in per cent is turned into one without unit."""
        clock = "t;0;0.5;1;1.5\n" + "".join(f"{(86398 + j) % 86400 // 3600}:{(86398 + j) % 3600 // 60:02}:{(86398 + j) % 60:02};1;2;3;{j}\n"
                                            for j in range(6))
        np.testing.assert_array_equal(read(clock).t, np.arange(6))
        percent = "s,t,strain [%]\n" + "".join(f"{i},{j},{10 * i}\n" for i in range(4) for j in range(4))
        np.testing.assert_allclose(read(percent).values[0], [0, 0.1, 0.2, 0.3])

    def test_thousands(self):
        """1,000 ms are a second where the times increase by that only; 1,368 may be both, unless the file or the user tells."""
        times = "".join(f"{100 * j:,};1;2;3;{j}\n" for j in range(17))
        self.assertEqual(read("t;0;0.5;1;1.5\n" + times).t[-1], 1600)
        three = "t;0;0.5;1;1.5\n" + "".join(f"{j};1,368;2,000;3,100;4,000\n" for j in range(9))
        self.assertEqual([read(three, decimal=decimal).values[0, 0] for decimal in ("comma", "point")], [1.368, 1368])
        self.assertEqual(read("t;0;0.5;1;1.5\n" + "".join(f"{j};1.368,5;2,0;3,1;4,0\n" for j in range(9))).values[0, 0], 1368.5)
        with self.assertRaisesRegex(InputError, '"1,368", which may be 1.368 or 1368'):
            read(three)
        points = "t;0;0.5;1;1.5\n" + "".join(f"{j};1.368;2.000;3.100;4.000\n" for j in range(9))
        self.assertEqual([read(points, decimal=decimal).values[0, 0] for decimal in ("comma", "point")], [1368, 1.368])
        self.assertEqual(read(points.replace("2.000", "2,5")).values[0, 0], 1368)
        self.assertEqual(read(points.replace("2.000", "2.5")).values[0, 0], 1.368)
        with self.assertRaisesRegex(InputError, '"1.368", which may be 1.368 or 1368'):
            read(points)
        self.assertEqual(len(read(WIDE + ";;;;\n;;;;\n").t), len(read(WIDE).t))  # rows of empty cells

    def test_refusals_name_the_place(self):
        rows = WIDE.split("\n", 1)[1]
        longer = "m;s;t\n" + "".join(f"{1 + i + 4 * j};{i};{j}\n" for i in range(4) for j in range(4))
        for text, words, options in (
                (WIDE + "4;1;2;x;4\n", 'row 6 of ".*" has "x" under 1,', {}), (WIDE + "4;1;2;3\n5;1;1;1;1\n", "row 6 .* has 4 cells, but 5", {}),
                (rows, "no line of 5 names", {}), ("t;a;b;c;d\n" + rows, 'column 2 of ".*" is "a"', {}),
                ("a;b;c;d;e\n" + rows, "has the columns a, b, c, d, e", {}), (WIDE, "has no unit", {"unit_of_t": "s"}),
                (WIDE, "a number, a fraction", {"unit_of_t": "parsec"}), (WIDE + "2;1;1;1;1\n", "row 6 .* gives s = 0, t = 2 a second", {}),
                ("t;0;0.5;1;1.5\n1;2;2.5x;3;4\n2;1;2;3;4\n3;1;2;3;4\n4;1;2;3;4\n", 'row 2 .*"2.5x"', {}), ("", "is empty", {}),
                ("only words\n", "no row of numbers", {}), (WIDE.encode("utf-16"), "UTF-16", {}), (b"PK\x03\x04", "a workbook", {}),
                (b"a\0b", "a binary file", {}), (b"\x89HDF\r\n\x1a\n", "HDF5", {}), (WIDE, '"--head"', {"head": "x1"}), (WIDE, '"--animal"', {"animal": "1"}),
                (longer.replace("m;", "strain;", 1).replace("\n1;0;0", "\n-5;0;0"), "a strain above -1", {}),
                (longer, 'has the column m, but "--quantity" is strain', {"quantity": "strain"}),
                (WIDE + "#DIV/0!;1;2;3;4\n", 'row 6 of ".*" has "#DIV/0!" under t', {}),
                (WIDE + "4;1\n", "row 6 .* has 2 cells, but 5 are expected, as in most", {}), (WIDE + "end\n", "row 6 .* has 1 cells, but 5 are", {}),
                (longer.replace("\n1;0;0", "\n1_0;0;0"), '"1_0" under', {}), (WIDE, "NAME=COLUMN", {"columns": "q=t"}),
                ("t,y1,y2,y3,y4\n" + "".join(f"{j},1,2,3,4\n" for j in range(5)), "but no x", {}), (WIDE, 'the column "q"', {"columns": "t=q"}),
                ("t,x1,x2,x3,x4\n" + "".join(f"{j},1,2,3,4\n" for j in range(5)), '"--columns" has "x=x1", but', {"columns": "t=t, x=x1"}),
                (WIDE.replace(";", ","), "commas separate the columns", {"decimal": "comma"}),
                ('note,t,m\n"a,b",0,1.234\n"a,c",1,2.345\n', "commas separate the columns", {"decimal": "comma"}),
                ("t,x1,x2,x3,x4\n" + "".join(f"{j},1,2,1e300,4\n" for j in range(5)), 'marker x3, t = 0, .* see "--unit-of-s"', {}),
                ("t,x1,x2,x3,x4\n" + "0,1,2,3,4\n" * 5, "row 3 .* gives marker = x1, t = 0 a second", {})):
            with self.assertRaisesRegex(InputError, words, msg=text):
                read(text, **options)
        with self.assertRaises(FileError):
            read_samples("/nowhere/at/all.csv")

    def test_any_bytes_end_in_samples_or_a_sentence(self):
        """Damaged files; no exception of another kind."""
        random = np.random.default_rng(5)
        for _ in range(400):
            data = bytearray(WIDE.encode())
            for _ in range(random.integers(1, 6)):
                data[random.integers(len(data))] = random.choice(list(b"\0\xff,;\t \n\"'.-e#x0/:[("))
            try:
                prepare(read(bytes(data)), Settings())
            except InputError as error:
                self.assertNotIn("\n", str(error))


class Trackers(unittest.TestCase):
    """The same body in the files of each: nine markers, a wave of strain 0.2, ten frames a second."""
    S = np.linspace(0, 4, 9)
    T = np.arange(17) / 10
    NAMES = [f"p{i}" for i in range(9)]
    DEEPLABCUT = (f"scorer{',net' * 27}\nbodyparts" + "".join(f",p{i}" * 3 for i in range(9))
                  + f"\ncoords{',x,y,likelihood' * 9}\n")

    @classmethod
    def x(cls):
        wave = 0.4 / PI * (np.cos(PI * (cls.S / 2 - cls.T[:, np.newaxis] / 0.8)) - np.cos(PI * cls.T[:, np.newaxis] / 0.8))
        return cls.S + wave + 0.05 * cls.T[:, np.newaxis]

    def agrees(self, samples, frames=True):
        """Distances of neighbours and times are those of the body."""
        np.testing.assert_allclose(np.diff(samples.values, axis=1), np.diff(self.x(), axis=1), atol=2e-3)
        np.testing.assert_allclose(samples.t, self.T * (10 if frames else 1), atol=1e-9)

    def rows(self, *columns):
        return "".join(",".join(str(value) for value in row) + "\n" for row in zip(*columns))

    def test_deeplabcut(self):
        x = self.x()
        triples = [column for i in range(9) for column in (x[:, i], np.full(17, 3.0), 0.9 + 0.005 * np.arange(17))]
        text = self.DEEPLABCUT + self.rows(range(17), *triples)
        self.agrees(read(text))
        self.assertEqual(np.isnan(read(text, confidence=0.9249).values).sum(), 5 * 9)
        with self.assertRaisesRegex(InputError, "no place at any time"):
            read(text, confidence=1)
        several = text.replace("bodyparts", "individuals" + ",worm1" * 27 + "\nbodyparts")
        self.agrees(read(several))
        with self.assertRaisesRegex(InputError, "2 animals"):
            read(several.replace(",worm1", ",worm2", 1))

    def test_sleap(self):
        import h5py
        x = self.x()
        head = "track,frame_idx,instance.score," + ",".join(f"{name}.x,{name}.y,{name}.score" for name in self.NAMES) + "\n"
        columns = [column for i in range(9) for column in (x[:, i], np.full(17, 3.0), np.full(17, 0.9))]
        self.agrees(read(head + self.rows(["worm_0"] * 17, range(17), [0.9] * 17, *columns)))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "analysis.h5")
            with h5py.File(path, "w") as file:
                file["tracks"] = np.array([[x.T, np.full((9, 17), 3.0)]])
                file["node_names"] = [name.encode() for name in self.NAMES]
                file["track_names"] = [b"worm_0"]
            self.agrees(read_samples(path))

    def test_trackmate_and_imagej(self):
        """A row for each spot; the numbers of tracks do not follow the body."""
        number = [4, 2, 7, 1, 0, 8, 3, 6, 5]
        spots = [(f"ID{j}{i}", number[i], self.x()[j, i] * 1000, 812.5, self.T[j], j) for j in range(17) for i in range(9)]
        head = "LABEL,TRACK_ID,POSITION_X,POSITION_Y,POSITION_T,FRAME\nLabel,Track ID,X,Y,T,Frame\nLabel,Track ID,X,Y,T,Frame\n,,(micron),(micron),(sec),\n"
        self.agrees(read(head + self.rows(*zip(*spots)), unit_of_s="mm"), frames=False)
        imagej = " ,Track n°,Slice n°,X,Y\n" + self.rows(range(1, 154), *zip(*[(spot[1], spot[5], spot[2] / 1000, 3) for spot in spots]))
        self.agrees(read(imagej.encode("cp1252")))

    def test_tracker_pairs_and_spines(self):
        x = self.x()
        pairs = [column for i in range(9) for column in (x[:, i], np.full(17, 3.0))]
        self.agrees(read("#multi:\n\t" + "\t\t".join(self.NAMES) + "\t\n" + "t" + "\tx\ty" * 9 + "\n"
                         + self.rows(self.T, *pairs).replace(",", "\t")), frames=False)
        self.agrees(read("Frame,Time," + ",".join(f"x{i},y{i}" for i in range(1, 10)) + "\n" + self.rows(range(17), self.T, *pairs)), frames=False)
        self.agrees(read("t," + ",".join(f"{name}_x,{name}_y" for name in self.NAMES) + "\n" + self.rows(self.T, *pairs)), frames=False)
        spine = self.rows(["20150716_112930"] * 17, ["00003"] * 17, self.T, *pairs).replace(",", " ")
        self.agrees(read(spine, name="a.spine"), frames=False)

    def test_fimtrack(self):
        """Rows are quantities at frames, from the head."""
        names = ["head", *(f"spinepoint_{i}" for i in range(1, 8)), "tail"]
        x = self.x()[:, ::-1]
        rows = "".join(f"{name}_x({j}),{x[j, i]},1\n{name}_y({j}),3,1\n" for i, name in enumerate(names) for j in range(17))
        text = ",larva(0),larva(1)\n" + rows + "".join(f"area({j}),50,50\n" for j in range(17))
        self.agrees(read(text, animal="larva(0)"))
        with self.assertRaisesRegex(InputError, r"larva\(0\), larva\(1\)"):
            read(text)

    def test_tierpsy(self):
        import h5py
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "featuresN.hdf5")
            with h5py.File(path, "w") as file:
                file["coordinates/skeletons"] = np.stack([self.x(), np.full((17, 9), 3.0)], axis=2)
                file["timeseries_data"] = np.array([(1, j) for j in range(17)], dtype=[("worm_index", "i4"), ("timestamp", "i8")])
            self.agrees(read_samples(path))

    def test_a_body_that_bends(self):
        """On a circle: distances are those along the body, and the mean place moves with it."""
        x, radius = self.x(), 3.0
        columns = [column for i in range(9) for column in (radius * np.sin(x[:, i] / radius), radius * np.cos(x[:, i] / radius))]
        samples = read("t," + ",".join(f"x{i},y{i}" for i in range(9)) + "\n" + self.rows(self.T, *columns))
        np.testing.assert_allclose(np.diff(samples.values, axis=1), np.diff(x, axis=1), rtol=2e-3)
        self.assertRegex(samples.notes[0], "the body bends.*distances along it, of x and y")

    def test_a_lost_marker_moves_no_others(self):
        """On a circle, one misplaced and uncertain: the places of all others stay, and its own is a gap."""
        x, radius = self.x(), 3.0
        columns = [column for i in range(9) for column in (radius * np.sin(x[:, i] / radius), radius * np.cos(x[:, i] / radius), np.ones(17))]
        whole = read(self.DEEPLABCUT + self.rows(range(17), *columns)).values
        gaps = [(0, 0), (6, 4), (16, 5)]  # frame and marker, also where no frames beside tell
        for frame, marker in gaps:
            columns[3 * marker][frame], columns[3 * marker + 1][frame], columns[3 * marker + 2][frame] = 9, 9, 0.1
        lost = read(self.DEEPLABCUT + self.rows(range(17), *columns), confidence=0.6).values
        self.assertEqual([tuple(one) for one in np.argwhere(np.isnan(lost))], gaps)
        moved = lost - whole - np.nanmean(lost - whole)  # the origin is nobody's
        self.assertLess(np.nanmax(np.abs(moved)), 0.01)
        self.assertLess(np.nanmax(np.abs(moved[1:-1])), 1e-3)

    def test_material_coordinates_of_whole_cycles(self):
        """The mean of 1.5 cycles is that of one, where the period is known."""
        t = np.arange(31) / 20
        x = self.S + 0.3 * np.sin(PI * (self.S / 3 - 2 * t[:, np.newaxis]))
        tracks = Samples("x", np.arange(9.0), t, x, self.NAMES)
        means = [prepare(tracks, Settings(markers_at="mean", period=period)).s[-1] for period in ("1", "")]
        self.assertAlmostEqual(means[0], 4, delta=1e-6)
        self.assertGreater(abs(means[1] - 4), 1e-3)

    def test_head(self):
        """Which end is the head turns the body round, so that it points from tail to head."""
        text = "t," + ",".join(f"x{i}" for i in range(9)) + "\n" + self.rows(self.T, *self.x().T)
        self.agrees(read(text, head="x8"), frames=False)
        turned = read(text, head="x0")
        np.testing.assert_allclose(turned.values, -self.x()[:, ::-1])
        self.assertEqual(turned.names[-1], "x0")
        with self.assertRaisesRegex(InputError, "which lies between x0 and x8"):
            read(text, head="x4")
        named = read(text.replace("x0", "x_nose", 1), quantity="markers").names
        self.assertEqual(named[-1], "x8")
        self.assertEqual(read(text.replace("t,x0", "t,nose", 1), quantity="markers").names[-1], "nose")


unittest.main()
