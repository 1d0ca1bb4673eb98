#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""contrib/slurm/sweep.sbatch with small stand-ins for srun and scontrol: what goes back to the queue, and what does not.

    python3 slurm_script.py PATH_TO_CRAWLER
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "contrib" / "slurm" / "sweep.sbatch"
failures = 0

# Runs the program alone, or plays one that ends with CODE after it has made the rows that ROWS says.
SRUN = """#!/bin/bash
while [[ $1 == -* ]]; do shift; done
echo "$@" >> calls.txt
if [ -z "${CODE:-}" ]; then exec "$@"; fi
if [ -n "${ROWS:-}" ]; then
  mkdir -p output-sweep
  echo "{\\"status\\": \\"$STATUS\\", \\"computed\\": $ROWS, }" > output-sweep/summary.json
  if [ "$ROWS" -gt 0 ]; then sleep 0.02; echo row >> output-sweep/results.h5; fi
fi
exit "$CODE"
"""
SCONTROL = """#!/bin/bash
echo "$@" >> requeued.txt
"""


def check(condition, what):
    """Prints one line and counts failures."""
    global failures
    failures += not condition
    print(("ok     " if condition else "FAILED ") + what)


class Cluster:
    """A folder with the stand-ins and a parameter file."""

    def __init__(self, folder, program="crawler"):
        self.folder = folder
        (folder / "bin").mkdir(parents=True)
        for name, text in (("srun", SRUN), ("scontrol", SCONTROL)):
            (folder / "bin" / name).write_text(text, encoding="utf-8")
            (folder / "bin" / name).chmod(0o755)
        self.environment = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}", "CRAWLER": program, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        self.environment.pop("CRAWLER_LAUNCHER", None)

    def write(self, entries="  set Axes = Body/Anchoring exponent : 1.5, 2, 3"):
        """Writes sweep.prm."""
        (self.folder / "sweep.prm").write_text(f"subsection Sweep\n{entries}\nend\n", encoding="utf-8")

    def start(self, *arguments, status="stopped", job="17", **plays):
        """One start of the job: exit code, what it said, and whether it was put back into the queue."""
        result = subprocess.run(["bash", SCRIPT, *arguments], cwd=self.folder, capture_output=True, text=True, check=False,
                                env={**self.environment, "STATUS": status, "SLURM_JOB_ID": job, **plays}, timeout=120)
        requeued = self.folder / "requeued.txt"
        lines = requeued.read_text(encoding="utf-8").splitlines() if requeued.exists() else []
        requeued.unlink(missing_ok=True)
        check(lines in ([], [f"requeue {job}"]), f"at most one request, for this job ({lines})")
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
        check(code == 2 and "usage" in words and not requeued and not cluster.calls(), f"{arguments}: {code}, {words.strip()}")


def test_codes(folder):
    """Each exit code of crawler sweep."""
    cluster = Cluster(folder)
    cluster.write()
    code, _, requeued = cluster.start("sweep.prm", "--set", "Accuracy=1e-3", CODE="0", ROWS="3", status="finished")
    check(code == 0 and not requeued, "0: finished")
    check(cluster.calls() == ["crawler sweep sweep.prm --resume --set Accuracy=1e-3"], f"the command: {cluster.calls()}")
    code, words, requeued = cluster.start("sweep.prm", CODE="5", ROWS="2")
    check(code == 5 and requeued, f"5: back to the queue ({words.strip()})")
    code, words, requeued = cluster.start("sweep.prm", CODE="5", ROWS="0")
    check(code == 5 and not requeued and "too short" in words, f"5 without a new row: not again ({words.strip()})")
    code, words, requeued = cluster.start("sweep.prm", CODE="0")
    check(code == 1 and requeued, f"0 of an srun that launched nothing: not finished, again ({words.strip()})")
    for error in ("2", "3", "4", "6", "7", "8"):
        code, words, requeued = cluster.start("sweep.prm", CODE=error)
        check(code == int(error) and not requeued and "not put back" in words, f"{error}: an error stays one")


def test_crashes(folder):
    """A rank that dies: again, but not the third time without a new row."""
    cluster = Cluster(folder)
    cluster.write()
    code, words, requeued = cluster.start("sweep.prm", CODE="137")
    check(code == 137 and not requeued and "did not start" in words, f"no table: it never started ({words.strip()})")
    for rows, again in ((4, True), (0, True), (0, False), (0, False), (1, True), (1, True), (1, True), (0, True), (0, False)):
        code, words, requeued = cluster.start("sweep.prm", CODE="137", ROWS=str(rows))
        check(code == 137 and requeued == again, f"dies after {rows} new rows: {'again' if again else 'no more'}")
    for job, again in (("18", True), ("18", True), ("18", False), ("19", True)):  # job 17 has three such lines in the file
        code, words, requeued = cluster.start("sweep.prm", CODE="137", ROWS="0", job=job)
        check(code == 137 and requeued == again, f"job {job} of the same folder dies: {'again' if again else 'no more'}")
    code, words, requeued = cluster.start("sweep.prm", "--output", "elsewhere", CODE="1")
    check(code == 1 and not requeued, "--output FOLDER is the folder that it looks at")
    code, words, requeued = cluster.start("sweep.prm", "--output=output-sweep", CODE="1", ROWS="1")
    check(code == 1 and requeued, "so is --output=FOLDER")


def test_program(folder, program):
    """The real program: stopped by its time limit, back to the queue, finished in the next start."""
    cluster = Cluster(folder, program)
    cluster.write("  set Axes = Body/Anchoring exponent : linspace(1.5, 4, 60); \\\n"
                  "             Active stress/Optimal wave/Perturbation parameter : linspace(0.05, 0.4, 60)\n"
                  "  set Time limit = 0.5")
    code, words, requeued = cluster.start("sweep.prm")
    computed = json.loads((folder / "output-sweep" / "summary.json").read_text(encoding="utf-8"))["computed"]
    check(code == 5 and requeued and 0 < computed < 3600, f"stopped after {computed} of 3600 points: {words.splitlines()[-1]}")
    code, words, requeued = cluster.start("sweep.prm", "--set", "Sweep/Time limit=100")
    summary = json.loads((folder / "output-sweep" / "summary.json").read_text(encoding="utf-8"))
    check(code == 0 and not requeued and summary["computed"] == 3600 - computed and summary["statuses"] == {"finished": 3600},
          f"the next start computes the other {summary['computed']} and finishes ({code})")
    code, words, requeued = cluster.start("sweep.prm", "--set", "Body/Length=-1")
    check(code == 2 and not requeued, f"a bad parameter: {code}, not again")


def main():
    """All tests in a folder of their own."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        test_usage(folder / "usage")
        test_codes(folder / "codes")
        test_crashes(folder / "crashes")
        test_program(folder / "program", str(pathlib.Path(sys.argv[1]).resolve()))
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
