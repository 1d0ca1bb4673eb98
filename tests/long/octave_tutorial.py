# SPDX-License-Identifier: LGPL-2.1-or-later
"""contrib/octave/tutorial.m reads the files of a run and of a sweep and prints the numbers that are in them. Without
Octave it does not run (77, which ctest reports).

    python3 octave_tutorial.py PATH_TO_CRAWLER
"""
import os
import pathlib
import re
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect  # noqa: E402
from tables import csv_rows, json_of  # noqa: E402

PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "contrib/octave/tutorial.m"


def main(folder):
    octave = shutil.which("octave-cli")
    if octave is None:
        print("not run: there is no Octave (Debian: apt install octave)")
        sys.exit(77)
    os.chdir(folder)
    os.symlink(ROOT / "prm", "prm")
    # The commands that its first lines show, as they stand.
    for line in re.findall(r"^%   (crawler .*)", SCRIPT.read_text(encoding="utf-8"), re.M):
        done = call(["sh", "-c", line.replace("crawler", f"'{PROGRAM}'", 1) + " --quiet"])
        expect(done.returncode == 0, f"{line}: {done.stderr}")
    ended = call([octave, "--no-init-file", "--eval", f"draw = false; source('{SCRIPT}')"])
    summary = json_of("output-fig_s1/summary.json")
    rows = csv_rows("output-sweep/results.csv")
    screen = ended.stdout
    expect(ended.returncode == 0, f"Octave: {ended.stdout} {ended.stderr}")
    wanted = [f"finished: displacement {summary['displacement']:.10g} +- ",
              f"at t = 1 with displacement {summary['displacement']:.10g}",
              "stretch, displacement, velocity, active_stress, friction_force", "201 points at 129 times"]
    wanted += [f"k = {float(row['Body/Elastic modulus']):g}: displacement {float(row['displacement']):.8g} +- "
               for row in rows]
    for words in wanted:
        expect(words in screen, f'"{words}" is not in\n{screen}')
    smallest = re.search(r"smallest stretch ([\d.]+)", screen)
    expect(len(rows) == 3 and smallest and abs(float(smallest[1]) / summary["min_stretch"]["value"] - 1) < 1e-3,
           f"the smallest stretch is {summary['min_stretch']}, read {smallest and smallest[1]}")


checks.run((main,))
