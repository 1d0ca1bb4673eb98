#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Computes what takes long: the numbers of the documents anew, statistics, kills, faults, films. Prints one table.

    contrib/verify.sh [BUILD] [--only WORD ...] [--list] [--output FOLDER] [--again]

A check is a command that must end with 0; 77 says that something it needs is not installed, which is a skip with a name.
If it belongs to a part of a document (all tables, or the next one, or the paragraph behind a phrase), each number there
of three digits or more (apart from times) is looked for in what the command prints and in the files that it writes: it
agrees if one of these rounds to it, or, for what is measured (a share, an error, a maximum), if one is as close as the
check allows. What is not found is printed with its nearest neighbour. Numbers of one or two digits are found everywhere
and prove nothing, so they are left out.

FOLDER (default: BUILD/verify) has the output of each command, drift.csv and done.json: what has passed is not done
again after a break unless the program has changed or --again is given. contrib/verify.sh builds and installs what the checks
need. All of it takes some four hours on 2 cores.

Ends with 0 if all is as expected, 7 if a number has drifted, 2 for a bad input, 3 if a command failed.
"""
import argparse
import csv
import dataclasses
import decimal
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?(?![\w])")
TIMES = re.compile(r"[\d.]+(?: to [\d.]+)? (?:s|ms|us|minutes|min|h|points/s)(?![\w])")
LEFT_OUT = re.compile(r"\bms\b|\bs\b|seconds|CPU|cost of|[Tt]ime|^series$")  # columns of times, and of a formula
SELF_CHECK, FAILED, SKIPPED = 7, 3, 77
THEORY, NUMERICS, OPTIMIZE = "doc/theory.md", "doc/numerics.md", "doc/optimize.md"


@dataclasses.dataclass
class Check:
    """A command, and the numbers of a document that come from it, if there are any."""
    name: str
    minutes: float
    command: str  # {build}, {out}: folders; {mpi}: two processes; {crawler}: the program
    document: str = ""
    phrase: str = ""  # where the part begins
    part: str = "table"  # the next one; "tables": all from there to the next heading; "text": the paragraph
    files: tuple = ()  # in {out}
    within: float = 0.0  # relative, of what is measured


def optimum(name, phrase="", minutes=0.5):
    """An optimisation, whose numbers are in the paragraph behind the phrase."""
    return Check(name, minutes, f"{{mpi}} {{build}}/crawler optimize {{root}}/prm/studies/{name}.prm --overwrite --output {{out}}/{name}",
                 OPTIMIZE if phrase else "", phrase, "text", (f"{name}/optima.csv", f"{name}/summary.json"), 2e-3)


CHECKS = (
    Check("paper", 0.5, "{root}/contrib/paper/make_figures.py {build} {out}/paper"),
    Check("reference_numbers", 0.2, "{build}/tests/theory_table {root}/contrib/reference/table.json", THEORY,
          "## 5. Reference numbers", files=("{root}/contrib/reference/table.json",)),
    Check("accuracy", 0.2, "{build}/tests/theory_table {root}/contrib/reference/table.json", NUMERICS, "**Accuracy** ("),
    Check("independent_solver", 10, "{root}/contrib/reference/table.py", THEORY, "## 5. Reference numbers",
          files=("{root}/contrib/reference/table.json",)),
    Check("scaling", 0.3, "{root}/tests/verification/scaling.py {build}/crawler"),
    Check("examples", 1, "{root}/tests/verification/prm_files.py {build}/crawler", "", ""),
    Check("jumps_on_meshes", 0.2, "{build}/tests/jump_study -1 1", NUMERICS, "(`build/tests/jump_study -1 1`", "text"),
    Check("calibration", 4, "{mpi} {build}/tests/calibration 220 {out}/calibration.csv", NUMERICS,
          "mpirun -n 2 build/tests/calibration 220", "text", within=0.01),
    Check("calibration_of_jumps", 3, "{mpi} {build}/tests/calibration 10000-10059 {out}/jumps.csv"),
    Check("number_errors", 4, "{root}/tests/verification/number_errors.py {build}/crawler 100 7", NUMERICS,
          "python3 tests/verification/number_errors.py", "text", within=0.01),
    Check("sensitivities", 2, "{root}/tests/verification/sensitivity_bounds.py {crawler} 1e-9 {root}/prm/paper/fig_s1.prm "
          "{root}/prm/examples/larva.prm {root}/prm/examples/travelling_wave.prm"),
    Check("long_tests", 2, "{build}/tests/verification_tests long"),
    Check("cycle_stop", 3, "{build}/tests/cycle_study 150", NUMERICS, "`build/tests/cycle_study 150`", "text", within=0.03),
    Check("map_of_outcomes", 10, "{mpi} {build}/crawler sweep {root}/prm/studies/outcomes_chi_p.prm --overwrite --output {out}/map",
          NUMERICS, "**The map of outcomes**", "text", ("map/summary.json", "map/log.txt"), 3e-3),
    optimum("optimize_segments", "4, 8, 16 and 32 segments reach"),
    optimum("optimize_actuators", "With 2, 4, 8 and 16 segments worms go"),
    optimum("optimize_uneven", minutes=3),
    optimum("optimize_grounds", minutes=1.5),
    # Statistics of errors: scenes that nobody has looked at.
    Check("fresh_scenes", 8, "{mpi} {build}/tests/calibration {scenes} {out}/fresh_scenes.csv"),
    Check("fresh_jumps", 6, "{mpi} {build}/tests/calibration {jumps} {out}/fresh_jumps.csv 1e-3 1e-6"),
    Check("fresh_hard", 8, "{mpi} {build}/tests/calibration {hard} {out}/fresh_hard.csv 1e-3 1e-5"),
    Check("fresh_soft", 8, "{mpi} {build}/tests/calibration {soft} {out}/fresh_soft.csv 1e-4"),
    Check("random_extremes", 25, "{build}/tests/random_extremes {extremes} {out}/random_extremes.csv"),
    Check("kinds", 22, "{root}/tests/long/kinds.py {build}/python 100 {seed}"),
    Check("fits", 20, "{root}/tests/python/fit_coverage.py {build}/python 200 1", "doc/fit.md", "`contrib/verify.sh --only fits`", within=0.02),
    Check("fit_profiles", 2, "{root}/tests/python/fit_coverage.py {build}/python 40 1 profiles"),
    # Interruptions and faults.
    Check("kills_of_runs", 10, "{root}/tests/long/run_kills.py {crawler} mpirun 6 {seed}"),
    Check("kills_of_studies", 10, "{root}/tests/long/study_kills.py {crawler} mpirun 20 {seed}"),
    Check("optimize_long", 9, "{root}/tests/cli/optimize.py {crawler} {root}/prm/studies mpirun --long"),
    Check("nodes", 5, "{root}/tests/long/nodes.py {crawler} mpirun"),
    Check("disk", 15, "{root}/tests/cli/disk.py {crawler} {root}/prm 12 {seed}"),
    Check("entries", 30, "{root}/tests/python/entry_effects.py {crawler} {build}/python {root} all"),
    Check("hostile_input", 3, "{root}/tests/cli/faults.py {crawler}"),
    Check("memory", 3, "{root}/tests/long/memory.py {crawler} 100000 0.2"),
    Check("fuzz", 65, "{root}/contrib/fuzz.sh 600"),
    Check("sanitizers", 12, "{root}/contrib/check_sanitizers.sh"),
    Check("tidy", 15, "{root}/contrib/check_tidy.sh source tests"),
    Check("tidy_headers", 1, "{root}/contrib/check_tidy.sh --headers"),
    # What people see.
    Check("films", 4, "{root}/tests/long/paraview_films.py {crawler} pvbatch"),
    Check("live_page", 15, "{root}/tests/long/live_page.py {crawler} {build}/live"),
    Check("wheel", 8, "{root}/tests/package/try_wheel.sh {build}"),
    Check("notebooks", 2, "{root}/tests/python/documents.py {build}/python all"),
    Check("octave", 0.5, "{root}/tests/long/octave_tutorial.py {crawler}"),
    # Other programs.
    Check("peers", 10, "{root}/contrib/peers/compare.py {build}"),
    Check("trade", 4, "{root}/contrib/peers/trade.py {build} --picture {build}/trade.png"),
)


def numbers_of(text):
    """All numbers of a text."""
    found = {float(one) for one in NUMBER.findall(text)}
    return found | {100 * one for one in found if abs(one) <= 1}  # shares may be written in per cent


def written_as(text):
    """How many digits a number is written with, and half a unit of the last one."""
    _, digits, exponent = decimal.Decimal(text).as_tuple()
    return len(digits), 0.5 * 10.0 ** exponent


def tables_of(lines):
    """The cells below the head of each table, but for columns that are left out."""
    table = []
    for line in [*lines, ""]:
        if line.startswith("|"):
            table.append([cell.strip() for cell in line.strip().strip("|").split("|")])
        elif table:
            keep = [i for i, name in enumerate(table[0]) if not LEFT_OUT.search(name)]
            yield [" ; ".join(row[i] for i in keep if i < len(row)) for row in table[2:]]
            table = []


def part_of(check):
    """The lines of the document that hold the numbers of a check."""
    text = (ROOT / check.document).read_text(encoding="utf-8")
    if check.phrase not in text:
        sys.exit(f"verify.py: {check.document} has no \"{check.phrase}\", behind which the numbers of {check.name} are expected")
    rest = text[text.rindex("\n", 0, text.index(check.phrase)) + 1:]
    if check.part == "text":
        return [TIMES.sub("", rest[rest.index(check.phrase) + len(check.phrase) - 1:].split("\n\n")[0])]
    rest = re.split(r"\n#+ ", rest[1:])[0]
    tables = list(tables_of(rest.splitlines()))
    return [row for table in (tables[:1] if check.part == "table" else tables) for row in table]


def fresh(seed):
    """Numbers of random scenes (tests/verification/random_scenes.h) behind those of the documents."""
    def numbers(first, n):
        first += seed % (9000 - n)
        return f"{first}-{first + n - 1}"
    return {"scenes": numbers(600, 200), "jumps": numbers(10100, 60), "hard": numbers(20200, 80),
            "soft": numbers(30000, 300), "extremes": numbers(10000, 500)}


class Runs:
    """Runs commands in a folder; what has been done by this program is kept there."""

    def __init__(self, build, out, seed, again):
        self.build, self.out = build, out
        self.places = {"build": build, "out": out, "root": ROOT, "mpi": "mpirun --oversubscribe -n 2", "crawler": build / "crawler",
                       "seed": seed, **fresh(seed)}
        self.file = out / "done.json"
        self.program = hashlib.sha256((build / "crawler").read_bytes()).hexdigest()
        known = json.loads(self.file.read_text(encoding="utf-8")) if self.file.is_file() and not again else {}
        self.done = known.get("checks", {}) if known.get("program") == self.program else {}

    def make(self, check):
        """Exit code, minutes, what the command printed, and what its files have in them."""
        command = re.sub(r"\{([a-z]+)\}", lambda name: str(self.places[name[1]]), check.command)
        log = self.out / f"{check.name}.log"
        known = self.done.get(check.name, {})
        if known.get("command") != command or known.get("code") != 0 or not log.is_file():  # what failed is tried again
            words = shlex.split(command)
            words = [sys.executable, *words] if words[0].endswith(".py") else words
            begin = time.monotonic()
            done = subprocess.run(words, cwd=self.out, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                                  stdin=subprocess.DEVNULL,
                                  env={**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"})
            log.write_text(done.stdout, encoding="utf-8")
            self.done[check.name] = {"command": command, "code": done.returncode, "minutes": (time.monotonic() - begin) / 60}
            part = self.file.with_suffix(".part")
            part.write_text(json.dumps({"program": self.program, "checks": self.done}, indent=1), encoding="utf-8")
            part.replace(self.file)
        known, text = self.done[check.name], log.read_text(encoding="utf-8")
        for name in check.files:
            path = self.out / name.format(**self.places)
            text += path.read_text(encoding="utf-8") if path.is_file() else ""
        return known["code"], known["minutes"], text


def compared(check, text):
    """A row for each number of the document: as written, nearest, relative drift, whether it agrees."""
    if not check.document:
        return []
    found, rows = numbers_of(text), []
    for line in part_of(check):
        for written in NUMBER.findall(line):
            digits, half_unit = written_as(written)
            if digits < 3 or not (value := float(written)):
                continue
            nearest = min(found, key=lambda one: abs(one - value), default=float("nan"))
            # A document may round what a command cuts off, and the other way round.
            agrees = abs(nearest - value) <= max(2.0002 * half_unit, check.within * abs(value))
            rows.append((line[:60], written, nearest, abs(nearest - value) / abs(value), agrees))
    if not rows:
        sys.exit(f"verify.py: {check.document} has no numbers behind \"{check.phrase}\" ({check.name})")
    return rows


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--only", nargs="+", metavar="WORD", default=[], help="checks with one of these words in their name")
    parser.add_argument("--list", action="store_true", help="prints the checks, runs nothing")
    parser.add_argument("--output", type=pathlib.Path, metavar="FOLDER")
    parser.add_argument("--again", action="store_true", help="what is done is done again")
    parser.add_argument("--seed", type=int, default=0, help="of the random scenes and kills that are new (default: %(default)s)")
    options = parser.parse_args()
    checks = [one for one in CHECKS if not options.only or any(word in one.name for word in options.only)]
    if not checks:
        parser.error(f"no check has one of the words {', '.join(options.only)} in its name: "
                     + ", ".join(one.name for one in CHECKS))
    if options.list:
        for check in checks:
            print(f"{check.name:22} {check.minutes:4g} min  {check.document or '-'} : {check.command}")
        return
    build = options.build.resolve()
    if not (build / "crawler").is_file() or not (build / "tests/theory_table").is_file():
        parser.error(f"{build} has no crawler and tests/theory_table; contrib/verify.sh builds them")
    out = (options.output or build / "verify").resolve()
    out.mkdir(parents=True, exist_ok=True)
    runs = Runs(build, out, options.seed, options.again)
    print("| check | expected | found | seconds |\n|---|---|---|---|", flush=True)
    drifted, failed, skipped, table = [], [], [], []
    for check in checks:
        code, minutes, text = runs.make(check)
        last = ([line.strip() for line in text.splitlines() if line.strip()] or [""])[-1][:100].replace("|", "/")
        rows = compared(check, text) if code == 0 else []
        drifted += [(check, *row) for row in rows if not row[-1]]
        table += [(check.name, check.document, *row) for row in rows]
        if code == SKIPPED:
            skipped.append(f"{check.name}: {last}")
        elif code:
            failed.append(f"{check.name} ended with {code}; {out / (check.name + '.log')} says why")
        n, agree = len(rows), sum(row[-1] for row in rows)
        expected = f"{n} numbers of {check.document}" if n else "exit 0"
        found = (f"skipped: {last}" if code == SKIPPED else f"exit {code}: {last}" if code
                 else f"{agree}, drift at most {max(row[3] for row in rows):.1e}" if n else f"exit 0: {last}")
        print(f"| {check.name} | {expected} | {found} | {60 * minutes:.0f} |", flush=True)
    with open(out / "drift.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(("check", "document", "where", "written", "nearest", "relative drift", "agrees"))
        writer.writerows(table)
    for check, where, written, nearest, drift, _ in drifted:
        print(f"{check.document}, {check.name}: {written} is not there; the nearest is {nearest:.10g} ({drift:.1e}) in: {where}")
    for line in failed:
        print(line)
    print(f"{len(checks) - len(failed) - len(skipped)} checks passed, {len(failed)} failed, {len(skipped)} skipped, "
          f"{len(drifted)} numbers drifted")
    sys.exit(FAILED if failed else SELF_CHECK if drifted else 0)


if __name__ == "__main__":
    main()
