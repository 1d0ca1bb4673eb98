# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler table: turns a file of measured samples into a table for the generators "table" and "prescribed strain"."""
import dataclasses
import math
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

import numpy as np

from .. import to_prm
from ..needs import FileError, InputError, Parser, read_rows, write_whole
from ..results import parameters_of
from .options import NUMBER, TEXT, WHOLE, add_options, add_reading_options, parts_of, reading_of
from .preparation import prepare
from .samples import read_samples
from .settings import Settings

DESCRIPTION = """Turns measured samples or tracks of markers into a table that a scene can read. IN: s, t, m; or t, marker, x; or t
and a column for each place or marker; or a file of DeepLabCut, SLEAP, TrackMate, Tierpsy, Tracker, FIMTrack, ImageJ or the
Multi-Worm Tracker (doc/measured_data.md)."""
ACCURACY_OF_COPIES = 1e-4  # relative; what noise does is known to 9 %


def command_line():
    """Parses the options."""
    parser = Parser(prog="crawler table", description=DESCRIPTION, allow_abbrev=False)
    parser.add_argument("input", metavar="IN", help="measured samples or tracks")
    parser.add_argument("output", metavar="OUT", help="the table to be written, NAME.csv")
    add_reading_options(parser)
    add_options(parser, (
            ("gap", WHOLE, "largest number of samples in a row that are filled in (default: 3)"),
            ("smooth-t", NUMBER, "width of the smoothing in t: waves of this length are halved (default: 0)"),
            ("smooth-s", NUMBER, "the same in s"),
            ("period", TEXT, "find, whole or a number: makes a single closed cycle of all"),
            ("cycles", WHOLE, "how often the cycle is written (default: 1)"),
            ("points-s", WHOLE, "equally spaced places of the table (default: those of the samples; markers: 33)"),
            ("points-t", WHOLE, "equally spaced times of the table (default: those of the samples)"),
            ("markers-at", TEXT, "material coordinates: first (frame; default), mean, or a list of numbers"),
            ("first-marker", NUMBER, "s of the first marker (default: 0)"),
            ("length", NUMBER, "length of the body (default: up to the last marker)"),
            ("ends", TEXT, "strain beyond the outermost markers: hold (default) or linear"),
            ("noise", NUMBER, "standard deviation of a sample, in units of the table (default: estimated)"),
            ("scene", TEXT, "parameter file that uses the table: how uncertain the noise makes its displacement"),
            ("copies", WHOLE, "number of noisy copies from which that is found (default: 64)"),
            ("seed", WHOLE, "seed of their random numbers (default: 1)")))
    parser.add_argument("--set", action="append", default=[], metavar="TEXT",
                        help='sets an entry of the scene: "Section/Entry=value" (repeatable)')
    parser.add_argument("--overwrite", action="store_true", help="replaces OUT")
    parser.add_argument("--quiet", action="store_true", help="prints only errors")
    return parser


def require_files(options):
    """Raises InputError for names of files that can be refused without samples."""
    if getattr(options, "copies", 64) < 8:
        raise InputError(f'"--copies" is {options.copies}, but at least 8 are expected')
    if getattr(options, "seed", 0) < 0:
        raise InputError(f'"--seed" is {options.seed}, but a whole number of 0 or more is expected')
    for name in ("copies", "seed", "set"):
        if not hasattr(options, "scene") and getattr(options, name, None):
            raise InputError(f'"--{name}" is for "--scene", which is missing')
    if getattr(options, "scene", None) == "":
        raise InputError('"--scene" is empty, but the name of a parameter file is expected')
    if not os.path.isdir(os.path.dirname(options.output) or "."):
        raise FileError(f'cannot write "{options.output}": there is no such folder')
    for name in (options.input, getattr(options, "scene", "")):
        if name and not is_own(name, options.output) and not os.path.exists(name):
            raise FileError(f'cannot read "{name}": No such file or directory')
    if "#" in os.path.basename(options.output):
        raise InputError(f'the table is to be "{options.output}", but a name without # is expected, which begins a comment in a parameter file')
    if not options.output.endswith(".csv"):
        raise InputError(f'the table is to be "{options.output}", but a name that ends in .csv is expected')
    if os.path.exists(options.output):
        if os.path.exists(options.input) and os.path.samefile(options.input, options.output):
            raise InputError(f'"{options.output}" is to be read and written, but another name for the table is expected')
        if not options.overwrite:
            raise InputError(f'"{options.output}" exists; another name or "--overwrite" is expected')


def scene_of(output):
    """Name of the parameter file beside a table, a scene to start from."""
    return f"{output.removesuffix('.csv')}.prm"


def is_own(scene, output):
    """True if a scene is that beside the table."""
    return os.path.abspath(scene) == os.path.abspath(scene_of(output))


def scene_text(table, output, overrides):
    """Parameter file of a scene that reads a table, with the entries of --set."""
    strain = {"Model": "kinematic", "Generator": "prescribed strain", "Prescribed strain/Given by": "table", "Prescribed strain/File": os.path.basename(output)}
    stress = {"Generator": "table", "Table/File": os.path.basename(output), **({"Table/Outside": "periodic"} if table.period else {})}
    entries = {"Body/Length": f"{table.s[-1]:.12g}", "Body/Elastic modulus": "1", "Body/Friction coefficient": "1", "Body/Anchoring exponent": "2",
               **{name if name == "Model" else f"Active stress/{name}": value for name, value in (strain if table.quantity == "strain" else stress).items()},
               "Time/End time": f"{table.t[-1]:.12g}", **dict(map(str.strip, one.split("=", 1)) for one in overrides if "=" in one)}
    return "# Scene of crawler table, to start from: friction and elasticity are those of the animal.\n\n" + to_prm(entries)


def changes_of_scene(scene, output, table):
    """Entries of an existing scene that have the length and the end of the table before and are to have those of the new one."""
    try:
        old = pathlib.Path(output).read_text(encoding="utf-8").split()[-1].split(",")
        text = pathlib.Path(scene).read_text(encoding="utf-8")
        found = [(entry, re.search(rf"^\s*set\s+{entry.split('/')[1]}\s*=\s*(\S+)", text, re.MULTILINE), float(before), new) for entry, before, new in
                 (("Body/Length", old[0], table.s[-1]), ("Time/End time", old[1], table.t[-1]))]
        return {entry: f"{new:.12g}" for entry, match, before, new in found
                if match and math.isclose(float(match[1]), before, rel_tol=1e-9) and not math.isclose(new, before, rel_tol=1e-9)}
    except (OSError, ValueError, IndexError):
        return {}  # no table before, or a scene of another form


def change_scene(scene, changes):
    """Sets entries of a scene that it has."""
    text = pathlib.Path(scene).read_text(encoding="utf-8")
    for entry, value in changes.items():
        text = re.sub(rf"(?m)^(\s*set\s+{entry.split('/')[1]}\s*=\s*)\S+", rf"\g<1>{value}", text)
    write_whole(pathlib.Path(scene), text.encode())


def write_columns(path, names, columns, digits):
    """Writes columns of numbers, each with its number of digits."""
    lines = [",".join(names), *(",".join(f"{value:.{n}g}" for value, n in zip(row, digits)) for row in zip(*columns))]
    write_whole(pathlib.Path(path), ("\n".join(lines) + "\n").encode())


def write_table(path, s, t, values, names):
    """Writes a row for each point that is no gap; values: [time, place]."""
    there = ~np.isnan(values.ravel())
    columns = [column[there] for column in (np.tile(s, len(t)), np.repeat(t, len(s)), values.ravel())]
    write_columns(path, names, columns, (15, 15, 10))


def displacements(scene, overrides, entry, tables):
    """Rows of a sweep of the scene over tables, read one after the other, a dict of texts for each; and the entries of
    the scene. Raises InputError and FileError with the message of the program."""
    if "CRAWLER_PROGRAM" not in os.environ:
        raise InputError('"--scene" needs the program (doc/install.md): crawler table IN OUT --scene FILE is expected')
    with tempfile.TemporaryDirectory(prefix="crawler-table-") as folder:
        names = [os.path.join(folder, f"{k}.csv") for k in range(len(tables))]
        for name, table in zip(names, tables):
            write_table(name, table.s, table.t, table.values, ("s", "t", table.quantity))
        if not os.path.exists(scene):  # the one that is to be written beside the table
            scene = os.path.join(folder, os.path.basename(scene))
            pathlib.Path(scene).write_text(scene_text(tables[0], names[0], overrides), encoding="utf-8")
        settings = [*overrides, "Sweep/Design=grid", f"Sweep/Axes={entry} : {', '.join(names)}"]
        output = os.path.join(folder, "sweep")
        end = subprocess.run([os.environ["CRAWLER_PROGRAM"], "sweep", scene, "--output", output, "--quiet",
                              *(word for setting in settings for word in ("--set", setting))], capture_output=True, text=True, check=False)
        if end.returncode:
            problem = end.stderr.strip().removeprefix("crawler: ").replace(names[0], "the new table")
            problem = re.sub(r'^--set "Sweep/Axes=.*?": ', "", problem).replace(folder + os.sep, "")
            problem += f" (the new table goes from s = {tables[0].s[0]:g} to {tables[0].s[-1]:.10g}, t = {tables[0].t[0]:g} to {tables[0].t[-1]:.10g})"
            raise FileError(problem) if end.returncode == FileError.code else InputError(problem)
        return read_rows(os.path.join(output, "results.csv")), parameters_of(pathlib.Path(output, "parameters.prm").read_text(encoding="utf-8"))


def noisy_tables(samples, noise, options, settings, period):
    """Tables of copies of the samples with noise, prepared in the same way. Raises InputError if more than a tenth of the copies gives none."""
    n, generator, tables, failed = getattr(options, "copies", 64), np.random.default_rng(getattr(options, "seed", 1)), [], []
    for _ in range(n):
        copy = dataclasses.replace(samples, values=samples.values + noise * generator.standard_normal(samples.values.shape))
        try:
            tables.append(prepare(copy, settings, period))
        except InputError as error:
            failed.append(error)
            if len(failed) > 0.1 * n:
                raise InputError(f"with noise of {noise:.3g} added, {len(failed)} of {len(tables) + len(failed)} copies of the samples give no table, so "
                                 f'that the uncertainty is not known; one of them: {error}; more smoothing, or another "--noise", is expected') from None
    return tables


def with_half_smoothing(samples, settings, period):
    """Tables with half the widths of smoothing: one, or none if there is no such table."""
    if settings.smooth_s == 0 and settings.smooth_t == 0:
        return []
    try:
        return [prepare(samples, dataclasses.replace(settings, smooth_s=settings.smooth_s / 2, smooth_t=settings.smooth_t / 2), period)]
    except InputError:
        return []


def others_of(row, rows):
    """Numbers of a row beside its displacement with their deviations in rows, in words."""
    words = []
    for key, name in (("dissipation", "dissipation"), ("min_stretch.value", "smallest stretch"), ("max_stretch.value", "largest stretch")):
        values = [float(one[key]) for one in rows if one[key]]
        if row[key] and len(values) > 1:
            words.append(f"{name} {float(row[key]):.4g} +- {np.std(values, ddof=1):.2g} (mean of copies {np.mean(values):.4g})")
    return ", ".join(words) + ("; the means of the copies show what noise adds once more" if words else "")


def uncertainty(options, samples, table, settings, changes):
    """Describes, in sentences, the uncertainty of the displacement of a scene by the noise: copies of the samples get
    noise of the same size, are prepared in the same way, and the scene, with changes, is computed with each."""
    entry = "Active stress/" + ("Table/File" if table.quantity == "m" else "Prescribed strain/File")
    is_new = not os.path.exists(options.scene)
    overrides = [*(f"{entry}={value}" for entry, value in changes.items()), *options.set]
    noisy = noisy_tables(samples, table.noise, options, settings, table.period)
    half = with_half_smoothing(samples, settings, table.period)
    lengths = [copy.s[-1] for copy in noisy]  # of markers; displacements are proportional to the length
    for copy in [*noisy, *half]:
        copy.s = table.s
    (first,), parameters = displacements(options.scene, overrides, entry, [table])
    if first["status"] != "finished" or not first["displacement"]:
        raise InputError(f'"{options.scene}" with the new table: {first["message"] or first["status"]}')
    own, accuracy = parameters[entry], max(float(parameters["Accuracy"]), ACCURACY_OF_COPIES)
    rows, _ = displacements(options.scene, [*overrides, f"Accuracy={accuracy}", "Error estimate=false"], entry, [*noisy, *half])
    rows, of_half = rows[:len(noisy)], rows[len(noisy):]
    copies = [float(row["displacement"]) * length / table.s[-1] for row, length in zip(rows, lengths)
              if row["status"] == "finished" and row["displacement"]]
    if len(copies) < 0.9 * len(rows):
        problem = next(row["message"] for row in rows if row["status"] != "finished")
        raise InputError(f"only {len(copies)} of {len(rows)} noisy copies could be run, so that the uncertainty is not known; one of the others: "
                         f"{problem}")
    if len({row["displacement"] for row in rows}) == 1 and table.noise > 0:
        reader = '"table"' if table.quantity == "m" else '"prescribed strain" with Given by = table'
        raise InputError(f'"{options.scene}" does not read the table: "{entry}" does not change its displacement; the generator {reader} is '
                         "expected")
    bound, deviation = first["displacement_error.total"], np.std(copies, ddof=1)
    note = "" if is_new or os.path.realpath(own) == os.path.realpath(options.output) else f'; with the new table, while the scene names "{own}"'
    if not math.isclose(float(parameters["Body/Length"]), table.s[-1], rel_tol=1e-6):
        note += f"; the scene has a Body/Length of {parameters['Body/Length']}, so the rest of the table, up to {table.s[-1]:.10g}, is cut off"
    words = [f"displacement {float(first['displacement']):.8g} +- {f'{float(bound):.1e}' if bound else '?'} (numerical bound) +- "
             f"{deviation:.2g} (standard deviation by noise of {table.noise:.3g}, {len(copies)} copies, known to "
             f"{100 / math.sqrt(2 * (len(copies) - 1)):.0f} %; their mean is {np.mean(copies):.8g}){note}"]
    n_periods = float(parameters["Time/End time"]) / table.period if table.period else 0
    if n_periods > 1.5:
        words.append(f"that is {float(first['displacement']) / n_periods:.4g} +- {deviation / n_periods:.2g} a period")
    if others := others_of(first, rows):
        words.append(others)
    for row in of_half:
        if row["displacement"]:
            words.append(f"with half the widths of smoothing the displacement is {float(row['displacement']):.5g}: what smoothing takes away is not in "
                         "the deviations")
    return words


def main():
    """Reads, prepares, writes and reports."""
    options = command_line().parse_args(sys.argv[2:])
    settings = Settings(**parts_of(options, Settings.__dataclass_fields__))
    require_files(options)
    words = []
    samples = read_samples(options.input, words=words, **reading_of(options))
    table = prepare(samples, settings)
    words += table.words
    if settings.noise is None:
        words.append(f"noise of a sample, as estimated from its neighbours in time: {table.noise:.3g}")
    scene = scene_of(options.output)
    changes = changes_of_scene(scene, options.output, table)
    if hasattr(options, "scene"):
        if not options.quiet:
            print(f"{options.scene} is computed with {getattr(options, 'copies', 64)} copies of the samples, to which noise is added ...", flush=True)
        try:
            words += uncertainty(options, samples, table, settings, changes if is_own(options.scene, options.output) else {})
        except InputError as error:
            if os.path.exists(options.scene):
                raise
            words.append(f"no displacement yet: {error}")
    words.append(f"table of {table.quantity} at {len(table.s)} places, s = {table.s[0]:g} to {table.s[-1]:.10g}, and {len(table.t)} times, "
                 f"t = {table.t[0]:g} to {table.t[-1]:.10g}")
    stem = options.output.removesuffix(".csv")
    is_new = not os.path.exists(scene) and (table.t[0] == 0 or table.period)
    if is_new:
        words.append(f"{scene} is a scene that reads the table: crawler run {shlex.quote(scene)}")
    elif changes:
        words.append(f"{scene} has got the new {' and '.join(f'{entry} = {value}' for entry, value in changes.items())}")
    elif not os.path.exists(scene):
        words.append(f"the table begins at t = {table.t[0]:g}, but a scene at 0: \"--shift-t first\"")
    report = f"{options.input} -> {options.output}\n" + "".join(f"  {sentence}\n" for sentence in words)
    write_table(f"{stem}_before.csv", samples.s, samples.t, samples.values, ("marker" if samples.quantity == "x" else "s", "t",
                                                                               samples.quantity))
    write_whole(pathlib.Path(f"{stem}_report.txt"), report.encode())
    write_table(options.output, table.s, table.t, table.values, ("s", "t", table.quantity))
    if is_new:
        write_whole(pathlib.Path(scene), scene_text(table, options.output, options.set).encode())
    elif changes:
        change_scene(scene, changes)
    if not options.quiet:
        how = ("prescribed strain, Given by = table" if table.quantity == "strain" else "table")
        print(f"{report}Picture: crawler plot {shlex.quote(options.output)}. In the parameter file: Generator = {how}, File = {options.output}"
              f"{', Outside = periodic' if table.period and table.quantity == 'm' else ''}")
