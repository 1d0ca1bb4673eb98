# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figure and table for a journal, of the output folder of a run or sweep:

    figure.pdf   vectors, one column wide (86 mm) or two (178 mm), letters of 8 points, whose font is embedded
    numbers.csv  of a run each number with an error bound; of a sweep its points with the value that is drawn
    numbers.tex  the same as a table for LaTeX's package longtable
"""
import argparse
import csv
import io
import math
import pathlib
import re
import sys

from . import needs, results
from .needs import FileError, InputError, Parser, write_whole
from .report.command import program

sys.path.append(str(pathlib.Path(__file__).resolve().parent / "plot"))
sys.modules["needs"] = needs  # exceptions of the scripts of pictures are those of the package
import kymograph  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402
import sweep  # noqa: E402
from plotting import existing, label, save, unit_names, with_own_units  # noqa: E402

WIDTHS, HEIGHTS = {1: 86, 2: 178}, {1: 80, 2: 70}  # of a figure, by its columns [mm]
STYLE = {"font.family": "STIXGeneral", "mathtext.fontset": "stix", "pdf.fonttype": 42, "font.size": 8, "axes.titlesize": 8,
         "axes.labelsize": 8, "xtick.labelsize": 7, "ytick.labelsize": 7, "axes.linewidth": 0.5, "xtick.major.width": 0.5,
         "ytick.major.width": 0.5, "xtick.major.size": 2.5, "ytick.major.size": 2.5, "xtick.minor.size": 1.5, "ytick.minor.size": 1.5}
BOUNDS = {"displacement": "displacement_error.total", "inversion.t": "inversion.error"}  # others: errors.NUMBER


def bound_of(key):
    """Name of the bound of a number."""
    return BOUNDS.get(key, f"errors.{key.removesuffix('.value')}")


def number_in(summary, key):
    """Number of a summary under a key with dots; NaN if it is not known."""
    for word in key.split("."):
        summary = summary.get(word) if isinstance(summary, dict) else None
    return float(summary) if isinstance(summary, (int, float)) and not isinstance(summary, bool) else math.nan


def in_latex(value, bound=math.nan):
    """Number as LaTeX, with as many digits as its bound has, two of which are shown; six without a bound."""
    if not math.isfinite(value):
        return "--"
    has_bound = math.isfinite(bound) and bound > 0
    power = math.floor(math.log10(max(abs(value), bound if has_bound else 0) or 1))
    last = max(math.floor(math.log10(bound)) - 1, power - 14) if has_bound else power - 5
    scale, shift = (1, 0) if -4 <= power < 6 else (10.0**power, power)
    digits = max(shift - last, 0)
    text = f"{value / scale:.{digits}f}" + (rf" \pm {bound / scale:.{digits}f}" if has_bound else "")
    if not has_bound and "." in text:
        text = text.rstrip("0").rstrip(".")
    return f"${text}$" if not shift else rf"$({text}) \times 10^{{{power}}}$" if has_bound else rf"${text} \times 10^{{{power}}}$"


def escaped(text):
    """Text with formulas for LaTeX: signs outside of the formulas are escaped."""
    parts = text.split("$")
    parts[::2] = [re.sub(r"[&%#_{}]", r"\\\g<0>", part.replace("\\", "/")).replace("^", r"\textasciicircum{}").replace("~", r"\textasciitilde{}")
                  for part in parts[::2]]
    return "$".join(parts)


def text_of(cell):
    """Cell of a table of HDF5 as text: words, or a number in all its digits."""
    return cell.decode(errors="replace") if isinstance(cell, bytes) else repr(float(cell))


def of_run(folder, size, words):
    """Figure of a run, and its numbers as rows for CSV and for LaTeX, the headings first."""
    figure = kymograph.draw(kymograph.arguments().parse_args([str(folder), *words]), size)
    summary, units = results.read(folder), unit_names(folder)
    table, cells = [("number", "unit", "value", "bound")], [("number", "value and bound")]
    for entry in program()["numbers"]:
        key, unit = entry["key"], entry["unit"]
        value, bound = number_in(summary, key), number_in(summary, bound_of(key))
        if math.isfinite(value) and math.isfinite(bound):
            table.append((key, with_own_units(f"[{unit}]", units)[1:-1], repr(value), repr(bound)))
            cells.append((label(key, unit, key.removesuffix(".value").replace("_", " ").replace(".", ", ")), in_latex(value, bound)))
    if len(table) == 1:
        raise InputError(f"{folder} has no number with an error bound (the run is {summary.status}); one that finished is expected")
    return figure, table, cells


def of_sweep(folder, size, words):
    """Figure of a sweep, and its points as rows for CSV and for LaTeX, the headings first."""
    options = sweep.arguments().parse_args([str(folder), *words])
    points = sweep.chosen_points(options)
    figure = sweep.draw(points, options, size)
    figure.suptitle("")
    axes, value = points.varying() or points.axes, options.value
    word = value if value in sweep.WORDS else "status"
    unknown = [math.nan] * len(points.chosen)
    table = [(*axes, *([value, "bound"] if value != word else []), word)]
    cells = [(*(label(name, points.units[name]) for name in axes), label(value, points.units[value]))]
    for *place, end, number, bound in zip(*map(points.column, axes), points.column(word), *(
            points.column(name) if name in points.data and points.is_number(name) else unknown for name in (value, bound_of(value)))):
        numbers = [repr(float(one)) if math.isfinite(one) else "" for one in (number, bound)]
        table.append((*map(text_of, place), *(numbers if value != word else []), text_of(end)))
        cells.append((*(text_of(one) if isinstance(one, bytes) else in_latex(one) for one in place),
                      in_latex(number, bound) if numbers[0] else text_of(end).replace("_", " ")))
    return figure, table, cells


def longtable(cells, units):
    """Table for LaTeX, whose first row has the headings."""
    head, *rows = [" & ".join(escaped(with_own_units(cell, units)) for cell in row) + r" \\" for row in cells]
    return "\n".join([r"% needs \usepackage{longtable}", rf"\begin{{longtable}}{{{'l' * len(cells[0])}}}", r"\hline", head, r"\hline",
                      r"\endhead", *rows, r"\hline", r"\end{longtable}", ""])


def main():
    """crawler paper DIR [options]"""
    own = Parser(prog="crawler paper", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                 epilog="All other options are those of the picture, which crawler plot DIR --help lists.", allow_abbrev=False)
    own.add_argument("folder", metavar="DIR", type=pathlib.Path, help="output folder of a run or sweep")
    own.add_argument("--columns", type=int, choices=(1, 2), default=1, help="width of the figure (default: 1)")
    own.add_argument("--height", type=float, metavar="MM", help=f"height of the figure (default: {HEIGHTS[1]}, of two columns {HEIGHTS[2]})")
    own.add_argument("--output", type=pathlib.Path, metavar="FOLDER", help="folder of the files (default: DIR/paper)")
    options, words = own.parse_known_args(sys.argv[2:])
    height = HEIGHTS[options.columns] if options.height is None else options.height
    if not 20 <= height <= 250:
        raise InputError(f'"--height" is "{height:g}", but a number of millimetres from 20 to 250 is expected')
    existing(options.folder / "summary.json", "the output folder of a run or sweep that has ended")
    kind = getattr(results.read(options.folder), "kind", "run")
    if kind not in ("run", "sweep"):
        raise InputError(f'"{options.folder}" is the folder of {dict(optimize="an optimisation").get(kind, "a " + kind)}, but that of a run or sweep is expected')
    plt.rcParams.update(STYLE)
    size = (WIDTHS[options.columns] / 25.4, height / 25.4)
    figure, table, cells = (of_run if kind == "run" else of_sweep)(options.folder, size, words)
    place = options.output or options.folder / "paper"
    try:
        place.mkdir(exist_ok=True)
    except OSError as error:
        raise FileError(f'cannot make the folder "{place}": {error.strerror}') from None
    save(figure, place / "figure.pdf", study=options.folder, dpi=600)
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(table)
    for name, content in (("numbers.csv", text.getvalue()), ("numbers.tex", longtable(cells, unit_names(options.folder)))):
        write_whole(place / name, content.encode())
        print(f"wrote {place / name}")
