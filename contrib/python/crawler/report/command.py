# SPDX-License-Identifier: LGPL-2.1-or-later
"""Command line of crawler report, and the page with its data: page.html with page.css and scripts of this folder."""
import json
import os
import pathlib
import subprocess
import sys

from .. import _compiled
from ..needs import InputError, Parser, chart_library, write_whole
from ..results import entries_of
from ..tradeoff import evaluate, read_rows
from .folder import data_of_fit, fits_within, parameters_in, run_in, runs_within, summary_in, table_in, text_of, units_of

HERE = pathlib.Path(__file__).resolve().parent
SCRIPTS = ("base.js", "plot.js", "body.js", "run.js", "explorer.js", "fit.js", "studies.js")
TIMES, FEWEST_TIMES = 640, 64  # times of all kymographs of a page together, and least number of each

# Kinds of folders: name, a file or folder that only this kind has, its table, and the group in it.
KINDS = (("tradeoff", "tradeoff.h5", "tradeoff.h5", "tradeoff"),
         ("comparison", "comparison.csv", "comparison.csv", None), ("fit", "inputs.json", "residuals.csv", None), 
         ("optimisation", "starts.h5", "results.h5", "optimize"),
         ("optimisation", "starts.csv", "results.h5", "optimize"),
         ("sweep", "results.h5", "results.h5", "results"), ("run", "summary.json", None, None),
         ("run", "statistics.csv", None, None), ("run", "kymograph.vts", None, None))


def kind_of(folder):
    """Entry of KINDS for a folder. Raises InputError if it is not that of a command."""
    expected = "the output folder of a run, sweep, tradeoff, optimisation, fit or comparison of fits is expected"
    if not os.path.isdir(folder):
        raise InputError(f'"{folder}" {"is a file" if os.path.exists(folder) else "does not exist"}, but {expected}')
    for kind in KINDS:
        if os.path.exists(os.path.join(folder, kind[1])):
            return kind
    raise InputError(f'"{folder}" has no results: none of summary.json, statistics.csv, kymograph.vts, results.h5, tradeoff.h5 '
                     f"exists; {expected}")


def program():
    """Description of the program by itself, or of the compiled part of this package: its versions, and key, unit and
    meaning of each number of a run."""
    name = os.environ.get("CRAWLER_PROGRAM")
    if name is None:
        return {"versions": _compiled().versions, "numbers": json.loads(_compiled().numbers())}
    try:
        return json.loads(subprocess.check_output([name, "parameters", "--format", "results"]))
    except (OSError, ValueError, subprocess.SubprocessError):
        raise InputError(f'"{name}" is not the program crawler, whose path is expected in CRAWLER_PROGRAM') from None


def reasons():
    """Reasons and advice from the table of the user guide; nothing where the guide is not installed."""
    root = HERE.parents[3]  # the source code, or share/ of an installed program
    for guide in (root / "doc/user_guide.md", root / "doc/crawler/doc/user_guide.md"):
        if guide.is_file():
            return text_of(guide).partition("\n## Reasons and what to do\n")[2].partition("\n## ")[0]
    return ""


def data_of(folder, kind):
    """Data of the page of a folder. Raises FileError where a file is damaged."""
    name, _, table, group = kind
    effective = text_of(folder / "parameters.prm") or ""
    entries, own = entries_of(effective), program()
    data = {"kind": name, "folder": folder.resolve().name, "path": str(folder), "program": own["versions"],
            "summary": summary_in(folder), "parameters": parameters_in(folder, effective, entries),
            "entries": own["numbers"], "units": units_of(entries), "reasons": reasons(), "table": None, "more_runs": []}
    if name == "comparison":
        if not (data["summary"] or {}).get("comparison"):
            raise InputError(f"{folder} has no scenes to compare: {(data['summary'] or {}).get('message')}")
        return {**data, "runs": [], "fits": fits_within(folder, data["summary"] or {})}
    if table and (folder / table).exists():
        data["table" if group else "tables"] = table_in(folder / table, group) if group else data_of_fit(folder / table)
    if name == "tradeoff" and (folder / "tradeoff.csv").exists() and "advice" not in (data["summary"] or {"advice": []}):
        data["summary"].update(evaluate(read_rows(folder)))
    if name == "run":
        return {**data, "runs": [run_in(folder, "", TIMES)]}
    within = runs_within(folder, "points" if name == "sweep" else "")
    shown = within[:2 * TIMES // FEWEST_TIMES]
    times = max(FEWEST_TIMES, TIMES // max(1, len(shown)))
    return {**data, "runs": [run_in(folder / one, one, times) for one in shown], "more_runs": within[len(shown):]}


def page_of(data):
    """Page as bytes. No text of the data can end its script, as "<" is escaped."""
    words = json.dumps(data, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")
    page = text_of(HERE / "page.html").replace("{{styles}}", text_of(HERE / "page.css"))
    page = page.replace("{{library}}", chart_library()).replace("{{scripts}}", "".join(text_of(HERE / name) for name in SCRIPTS)).replace("{{data}}", words)
    return page.encode("utf-8", errors="replace")


def main():
    """crawler report DIR [--quiet]"""
    parser = Parser(prog="crawler report", description="Makes a page for browsers, report.html, of the output folder of "
                    "any other command.")
    parser.add_argument("folder", metavar="DIR", help="Output folder of a run, sweep, tradeoff, optimisation or fit")
    parser.add_argument("--quiet", action="store_true", help="Prints only errors")
    options = parser.parse_args(sys.argv[2:])
    kind, folder = kind_of(options.folder), pathlib.Path(options.folder)
    write_whole(folder / "report.html", page_of(data_of(folder, kind)))
    if not options.quiet:
        print(f"The report of this {kind[0]} is {folder / 'report.html'}; open it in a browser.")
