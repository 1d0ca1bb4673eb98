# SPDX-License-Identifier: LGPL-2.1-or-later
"""Evaluation of all rows of a tradeoff: Pareto fronts, and which setting to use for which accuracy.

    python3 contrib/python/crawler tradeoff FOLDER

adds it to the files of the folder. A row is a dict of the texts in tradeoff.csv; rows of one mesh follow each other,
from the loosest tolerance on.
"""
import collections
import json
import math
import pathlib
import sys

from . import needs, to_prm
from .needs import InputError, Parser, number, write_whole

EXPONENTS = range(2, 15)  # exponents of the errors 1e-2, 1e-3, ... with recommendations
OF_A_SETTING = ("model", "formulation", "mesh", "engine", "integrator", "degree", "cells", "mesh tolerance")  # and the tolerance


def pareto_front(costs, errors):
    """Indices of the points that no other one dominates, the cheapest first: none is as cheap and as accurate and
    better in one of the two. Of equal points the first counts; points with NaN are never on the front."""
    best, front = math.inf, []
    for cost, error, i in sorted((*point, i) for i, point in enumerate(zip(costs, errors)) if not any(map(math.isnan, point))):
        if error < best:
            best = error
            front.append(i)
    return front


def safe_errors(rows):
    """Largest error of each row and of all tighter tolerances on its mesh; infinite if one of them failed."""
    def mesh(row):
        return [row[name] for name in OF_A_SETTING]

    safe, last = [], None
    for row in reversed(rows):
        # Tighter tolerances that ran out of time say nothing against the looser ones.
        own = number(row["shown error"]) if row["status"] == "finished" else 0.0 if row["reason"] == "time_limit" else math.inf
        safe.append(max(own, safe[-1]) if last is not None and mesh(row) == mesh(last) else own)
        last = row
    return safe[::-1]


def recommend(rows, batch=False):
    """Recommends [(exponent, index of the row)]: for errors of 10^-exponent the cheapest setting that is safe, if there
    is one. Accidentally small errors are not recommended, nor a level whose own error estimate (the message) exceeds
    its promise."""
    candidates = [(number(row["seconds"]), i, safe) for i, (row, safe) in enumerate(zip(rows, safe_errors(rows)))
                  if row["status"] == "finished" and not row["message"] and (row["engine"] == "batch") == batch]
    found = []
    for exponent in EXPONENTS:
        good = [(seconds, i) for seconds, i, safe in candidates if safe <= float(f"1e-{exponent}")]
        if not good:
            break
        found.append((exponent, min(good)[1]))
    return found


def setting_in_words(row):
    """ "position, fused, radau 5, degree 4, 8 cells, tolerance 1e-05 of the displacement" """
    tolerance = number(row["tolerance"])
    if row["model"] != "nonlinear":
        return f"model {row['model']}, Accuracy {tolerance:g}"
    cells = number(row["cells"])
    mesh = f"adaptive mesh of tolerance {number(row['mesh tolerance']):g}" if row["mesh"] == "adaptive" else \
        f"{cells:g} cell{'s' if cells != 1 else ''}"
    return f"{row['formulation']}, {row['engine']}, {row['integrator']}, degree {number(row['degree']):g}, {mesh}, " \
           f"tolerance {tolerance:g} of the displacement"


def cost_in_words(row):
    """ "error 1.2e-05, 0.2 ms, 34 kB" """
    seconds, memory = number(row["seconds"]), number(row["memory"])
    bar = "below the bar of " if row["below bar"] == "true" else ""
    time = f"{1e6 * seconds:.3g} us" if seconds < 1e-3 else f"{1e3 * seconds:.3g} ms" if seconds < 1 else f"{seconds:.3g} s"
    return f"error {bar}{number(row['shown error']):.1e}, {time}{' a body' if row['engine'] == 'batch' else ''}" + (
        "" if math.isnan(memory) else f", {memory / 1e3:.0f} kB")


def block(row):
    """Setting as lines of a parameter file."""
    return to_prm(dict(entry.split("=", 1) for entry in row["entries"].split("; ")))


def items(rows, found):
    """Recommendations for summary.json; batches have no parameter file."""
    def known(value):
        return None if math.isnan(value) else value

    return [{"accuracy": float(f"1e-{exponent}"), "index": i, "setting": setting_in_words(rows[i]),
             **{name: known(number(rows[i][name])) for name in ("error", "seconds", "memory")},
             "prm": None if rows[i]["engine"] == "batch" else block(rows[i])} for exponent, i in found]


def lines(rows, found, words):
    """Formats a line for each recommended setting, with its accuracies in place of {}."""
    exponents = collections.defaultdict(list)
    for exponent, i in found:
        exponents[i].append(f"1e-{exponent}")
    return [f"{words.format(' and '.join(of))}{setting_in_words(rows[i])}: {cost_in_words(rows[i])}" for i, of in exponents.items()]


def evaluate(rows):
    """Entries of summary.json besides those of the program: pareto, the indices of the rows on the front of single runs
    and on that of batches; recommendations and batch_recommendations; advice, sentences."""
    fronts, found = [], []
    for batch in (False, True):
        own = [i for i, row in enumerate(rows) if row["status"] == "finished" and (row["engine"] == "batch") == batch]
        front = pareto_front(*([number(rows[i][name]) for i in own] for name in ("seconds", "shown error")))
        fronts += [own[place] for place in front]
        found.append(recommend(rows, batch))
    below = sum(row["below bar"] == "true" for row in rows)
    gaps = collections.Counter(row["reason"] for row in rows if row["reason"])
    advice = [f"{sum(row['status'] == 'finished' for row in rows)} settings finished, {below} of them below the bar, {len(fronts)} on the "
              f"Pareto fronts; gaps: {', '.join(f'{reason} {n}' for reason, n in sorted(gaps.items())) or 'none'}.",
              *lines(rows, found[0], "For {} use "), *lines(rows, found[1], "Many bodies, for {}: ")]
    if not found[0]:
        advice.append("No single run has a displacement that is accurate to 1e-2: there is nothing to recommend.")
    return {"pareto": sorted(fronts), "recommendations": items(rows, found[0]), "batch_recommendations": items(rows, found[1]),
            "advice": advice}


def recommendations_prm(rows):
    """Blocks for a parameter file, each with a comment about its cost."""
    text = ("# The cheapest settings that crawler tradeoff has found for this scene. Copy the block that you want into the\n"
            "# parameter file; errors are relative, costs are processor time of a run without snapshots.\n")
    return text + "".join(f"\n# For 1e-{exponent}: {cost_in_words(rows[i])}\n{block(rows[i])}" for exponent, i in recommend(rows))


def read_rows(folder):
    """Rows of tradeoff.csv. Raises FileError if it cannot be read, and InputError if it is missing or of another
    version."""
    path = folder / "tradeoff.csv"
    if not path.exists():
        raise InputError(f'"{path}" does not exist; the output folder of crawler tradeoff is expected')
    rows = needs.read_rows(path)
    if not rows or "entries" not in rows[0]:
        raise InputError(f'"{path}" has no column "entries": it is from another version of crawler, or incomplete; the output folder of '
                         "crawler tradeoff is expected")
    return rows


def complete(folder):
    """Summary of a folder, a dict, with the results of evaluate(). If summary.json lacks these, it is written, and
    recommendations.prm. Raises InputError, FileError."""
    path = folder / "summary.json"
    try:
        summary = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
    except ValueError as error:
        raise InputError(f'"{path}" is damaged ({error}); a summary of crawler is expected') from None
    if summary and "advice" not in summary:
        rows = read_rows(folder)
        summary.update(evaluate(rows))
        write_whole(folder / "recommendations.prm", recommendations_prm(rows).encode())
        write_whole(path, (json.dumps(summary, indent=2, ensure_ascii=False) + "\n").encode())
    return summary


def main():
    """Completes a folder at the end of crawler tradeoff."""
    parser = Parser(prog="crawler tradeoff", description=complete.__doc__)
    parser.add_argument("folder", metavar="DIR", help="Output folder of crawler tradeoff")
    complete(pathlib.Path(parser.parse_args(sys.argv[2:]).folder))
