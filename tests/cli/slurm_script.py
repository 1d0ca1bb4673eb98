#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""contrib/slurm/sweep.sbatch with small stand-ins for srun and scontrol: what goes back to the queue, and what does not.

    python3 slurm_script.py PATH_TO_CRAWLER
"""
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect  # noqa: E402
from tables import json_of  # noqa: E402

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "contrib" / "slurm" / "sweep.sbatch"

# Runs the program alone, or plays one that ends with CODE after it has made the rows that ROWS says. The table gets the
# time of a day of its own with each of them: a table without a new row is one whose time is the same.
SRUN = """#!/bin/bash
while [[ $1 == -* ]]; do shift; done
echo "$@" >> calls.txt
if [ -z "${CODE:-}" ]; then exec "$@"; fi
if [ -n "${ROWS:-}" ]; then
  mkdir -p output-sweep
  echo "{\\"status\\": \\"$STATUS\\", \\"computed\\": $ROWS, }" > output-sweep/summary.json
  if [ "$ROWS" -gt 0 ]; then
    echo row >> output-sweep/results.h5
    touch -d "2026-01-01 + $(wc -l < output-sweep/results.h5) days" output-sweep/results.h5
  fi
fi
exit "$CODE"
"""
SCONTROL = """#!/bin/bash
echo "$@" >> requeued.txt
"""


class Cluster:
    """A folder with the stand-ins and a parameter file."""

    def __init__(self, folder, program="crawler"):
        self.folder = folder
        (folder / "bin").mkdir()
        for name, text in (("srun", SRUN), ("scontrol", SCONTROL)):
            (folder / "bin" / name).write_text(text, encoding="utf-8")
            (folder / "bin" / name).chmod(0o755)
        self.variables = {"PATH": f"{folder / 'bin'}:{os.environ['PATH']}", "CRAWLER": program, "CRAWLER_LAUNCHER": ""}

    def write(self, entries="  set Axes = Body/Anchoring exponent : 1.5, 2, 3"):
        (self.folder / "sweep.prm").write_text(f"subsection Sweep\n{entries}\nend\n", encoding="utf-8")

    def start(self, *arguments, status="stopped", job="17", stop_at=None, **plays):
        """One start of the job: exit code, what it said, and whether it was put back into the queue."""
        result = call(["bash", SCRIPT, *arguments], self.folder, stop_at,
                      {**self.variables, "STATUS": status, "SLURM_JOB_ID": job, **plays})
        requeued = self.folder / "requeued.txt"
        lines = requeued.read_text(encoding="utf-8").splitlines() if requeued.exists() else []
        requeued.unlink(missing_ok=True)
        expect(lines in ([], [f"requeue {job}"]), f"at most one request, for this job ({lines})")
        return result.returncode, result.stdout + result.stderr, bool(lines)

    def calls(self):
        """What srun was asked to start."""
        calls = self.folder / "calls.txt"
        return calls.read_text(encoding="utf-8").splitlines() if calls.exists() else []


def test_usage(folder):
    """Without a parameter file nothing starts."""
    cluster = Cluster(folder)
    for arguments in ((), ("missing.prm",)):
        code, words, requeued = cluster.start(*arguments, CODE="0")
        expect(code == 2 and "usage" in words and not requeued and not cluster.calls(), f"{arguments}: {code}, {words}")


def test_codes(folder):
    """Each exit code of crawler sweep."""
    cluster = Cluster(folder)
    cluster.write()
    code, _, requeued = cluster.start("sweep.prm", "--set", "Accuracy=1e-3", CODE="0", ROWS="3", status="finished")
    expect(code == 0 and not requeued, "0: finished")
    expect(cluster.calls() == ["crawler sweep sweep.prm --resume --set Accuracy=1e-3"], f"the command: {cluster.calls()}")
    code, words, requeued = cluster.start("sweep.prm", CODE="5", ROWS="2")
    expect(code == 5 and requeued, f"5: back to the queue ({words})")
    code, words, requeued = cluster.start("sweep.prm", CODE="5", ROWS="0")
    expect(code == 5 and not requeued and "too short" in words, f"5 without a new row: not again ({words})")
    code, words, requeued = cluster.start("sweep.prm", CODE="0")
    expect(code == 1 and requeued, f"0 of an srun that launched nothing: not finished, again ({words})")
    for error in ("2", "3", "4", "6", "7", "8"):
        code, words, requeued = cluster.start("sweep.prm", CODE=error)
        expect(code == int(error) and not requeued and "not put back" in words, f"{error}: an error stays one")


def test_crashes(folder):
    """A rank that dies: again, but not the third time without a new row."""
    cluster = Cluster(folder)
    cluster.write()
    code, words, requeued = cluster.start("sweep.prm", CODE="137")
    expect(code == 137 and not requeued and "did not start" in words, f"no table: it never started ({words})")
    for rows, again in ((4, True), (0, True), (0, False), (0, False), (1, True), (1, True), (1, True), (0, True), (0, False)):
        code, words, requeued = cluster.start("sweep.prm", CODE="137", ROWS=str(rows))
        expect(code == 137 and requeued == again, f"dies after {rows} new rows: {'again' if again else 'no more'} ({words})")
    for job, again in (("18", True), ("18", True), ("18", False), ("19", True)):  # job 17 has three such lines in the file
        code, words, requeued = cluster.start("sweep.prm", CODE="137", ROWS="0", job=job)
        expect(code == 137 and requeued == again, f"job {job} of the same folder dies, again: {again} ({words})")
    code, words, requeued = cluster.start("sweep.prm", "--output", "elsewhere", CODE="1")
    expect(code == 1 and not requeued, "--output FOLDER is the folder that it looks at")
    code, words, _ = cluster.start("sweep.prm", "--output", CODE="1")
    expect(code == 2 and "--output needs a folder" in words, f"--output without one: {code}, {words}")
    code, words, requeued = cluster.start("sweep.prm", "--output=output-sweep", CODE="1", ROWS="1")
    expect(code == 1 and requeued, "so is --output=FOLDER")


def test_program(folder):
    """The real program: stopped by the signal or its time limit, killed, and finished in the next start."""
    cluster = Cluster(folder, str(pathlib.Path(sys.argv[1]).resolve()))
    n = 144
    cluster.write("  set Axes = Body/Anchoring exponent : linspace(1.5, 4, 12); \\\n"
                  "             Active stress/Optimal wave/Perturbation parameter : linspace(0.05, 0.4, 12)\n")
    summary = folder / "output-sweep" / "summary.json"
    code, words, requeued = cluster.start("sweep.prm", stop_at="row:20:TERM")
    computed = json_of(summary)["computed"]
    expect(code == 5 and requeued and 20 <= computed < n, f"stopped after {computed} points: {code} {words}")
    code, words, requeued = cluster.start("sweep.prm", "--set", "Sweep/Time limit=0.001")
    expect(code == 5 and not requeued and "too short" in words and json_of(summary)["reason"] == "time_limit",
           f"a time limit that is too short for a point: {code}, not again {words}")
    code, words, requeued = cluster.start("sweep.prm", stop_at="row:1:KILL")
    expect(code == 137 and requeued, f"killed: {code}, again {words}")
    code, words, requeued = cluster.start("sweep.prm", "--set", "Sweep/Time limit=1e6")
    last = json_of(summary)
    expect(code == 0 and not requeued and 0 < last["computed"] < n - computed and last["statuses"] == {"finished": n},
           f"the next start computes the other {last['computed']} and finishes ({code}) {words}")
    code, words, requeued = cluster.start("sweep.prm", "--set", "Body/Length=-1")
    expect(code == 2 and not requeued, f"a bad parameter: {code}, not again {words}")


checks.run((test_usage, test_codes, test_crashes, test_program))
