#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Are the bounds of sensitivities (Output/Sensitivities = all) above their errors? Each derivative at Accuracy 1e-3,
1e-4 and 1e-6, where that is 1000 times REFERENCE at least, is compared with that at REFERENCE.

    python3 sensitivity_bounds.py PATH_TO_CRAWLER REFERENCE FILE.prm...
"""
import collections
import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect  # noqa: E402
from tables import json_of  # noqa: E402

ACCURACIES = (1e-3, 1e-4, 1e-6)


def sensitivities(program, file, accuracy, folder):
    """{(entry, number): (value, error)} of a run; nothing if it failed."""
    command = [program, "run", file, "--overwrite", "--quiet", "--output", folder, "--set", f"Accuracy={accuracy}",
               "--set", "Output/Sensitivities=all", "--set", "Output/Number of snapshots=0"]
    done = call(command)
    if done.returncode != 0:
        print(f"{file}, Accuracy {accuracy}: {done.stderr.strip()}")
        return {}
    found = {}
    for entry, one in json_of(folder / "summary.json")["sensitivities"].items():
        if one["value"] is not None:
            found[entry, "displacement"] = one["value"], one["error"]
        for number, other in one.items():
            if isinstance(other, dict):
                found[entry, number] = other["value"], other["error"]
    return found


def main(folder):
    ratios, reference = collections.defaultdict(list), float(sys.argv[2])
    for file in sys.argv[3:]:
        exact = sensitivities(sys.argv[1], file, reference, folder)
        for accuracy in (one for one in ACCURACIES if one > 999 * reference):
            for (entry, number), (value, error) in sensitivities(sys.argv[1], file, accuracy, folder).items():
                if (entry, number) not in exact:
                    continue
                true, of_true = exact[entry, number]
                ratios[number].append(abs(value - true) / error)
                expect(abs(value - true) <= error + of_true,
                       f"{file}, Accuracy {accuracy}: d({number})/d({entry}) = {value} +- {error}, "
                       f"but {true} +- {of_true} at Accuracy {reference}")
    for number, list_of_one in ratios.items():
        print(f"{number}: {len(list_of_one)} derivatives, true error/bound {statistics.median(list_of_one):.2g} in the "
              f"median, {max(list_of_one):.2g} at most")


checks.run((main,))
