#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The same input, program and number of ranks leave the same files, times aside; the instruction sets of the processor
agree within the error bounds; a set that is not there is refused.

    python3 same_bytes.py PATH_TO_CRAWLER
"""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect, prm, refused, sets  # noqa: E402
from tables import answer_in, h5_columns, json_of  # noqa: E402

CRAWLER = pathlib.Path(sys.argv[1]).resolve()
BASE = prm("Accuracy=1e-4", "Active stress/Optimal wave/Choose wave by=wave speed", "Output/Number of snapshots=5")
CHI, P = "Active stress/Optimal wave/Perturbation parameter", "Body/Anchoring exponent"
STUDIES = {
    "run": [],
    "sweep": [f"Sweep/Axes={P} : 1.5, 2.5; {CHI} : 0.1, 0.2, 0.3", "Sweep/Cross-check=true"],
}
SETS = ("baseline", "avx2", "avx512")
# What may differ: seconds, moments, the folder's name; in tables, columns and rows of them.
TIMES = re.compile(rb'(?i)("?[\w. ]*(?:seconds|duration|processor|wall)[\w. ]*"?\s*[:=,]\s*)[-+\d.e]+|\d+(?:\.\d+)? ?(?:s|ms|us|min|h)\b'
                   rb'|\d{4}-\d\d-\d\d[T ][\d:.]+Z?|[\d.]+ points/s|(?<=[_/])(?:first|second)\b')


def computed(folder, command, entries, output, instruction_set=None):
    return call([CRAWLER, command, "scene.prm", "--quiet", "--output", output, *sets(entries)], folder,
                variables={} if instruction_set is None else {"CRAWLER_INSTRUCTION_SET": instruction_set})


def files(folder):
    return {name: TIMES.sub(b"TIME", content) if isinstance(content, bytes) else content for name, content in answer_in(folder).items()}


def same_files(folder, command, entries):
    results = [computed(folder, command, entries, f"{command}_{name}") for name in ("first", "second")]
    one, two = (files(folder / f"{command}_{name}") for name in ("first", "second"))
    differ = sorted(name for name in one.keys() | two.keys() if one.get(name) != two.get(name))
    expect(all(r.returncode == 0 for r in results) and len(one) > 3 and not differ,
           f"{command}: {len(one)} files twice the same {differ or ''} {results[0].stderr.strip()}")


def same_answer(folder):
    """Every instruction set gives the answer within its error bound; they are not all the same computation."""
    answers = {}
    for name in SETS:
        result = computed(folder, "run", [], f"with_{name}", name)
        if result.returncode == 2 and "this processor does not have it" in result.stderr:
            print(f"       {name}: {result.stderr.strip()}")
            continue
        summary = json_of(folder / f"with_{name}" / "summary.json")
        sweep = computed(folder, "sweep", STUDIES["sweep"], f"sweep_{name}", name)
        rows = h5_columns(folder / f"sweep_{name}" / "results.h5", "results")
        answers[name] = (summary["displacement"], summary["displacement_error"]["total"], rows)
        expect(result.returncode == sweep.returncode == 0, f"{name} is used {result.stderr.strip()}{sweep.stderr.strip()}")
    expect("baseline" in answers, "baseline is there")
    base = answers["baseline"]
    for name, (value, bound, rows) in answers.items():
        key, error = "displacement", "displacement_error.total"
        apart = abs(value - base[0])
        largest = max(abs(rows[key] - base[2][key]) / (rows[error] + base[2][error]))
        expect(apart <= bound + base[1] and largest <= 1,
               f"{name}: run differs from baseline by {apart:.1e} (bound {bound:.1e}), a sweep by {largest:.1e} of the bounds")


def main(folder):
    (folder / "scene.prm").write_text(BASE, encoding="utf-8")
    for command, entries in STUDIES.items():
        same_files(folder, command, entries)
    same_answer(folder)
    result = computed(folder, "run", [], "none", "sse9")
    refused(result, 'CRAWLER_INSTRUCTION_SET is "sse9"', "baseline")
    expect(not (folder / "none").exists(), "an unknown instruction set has written files")


checks.run((main,))
