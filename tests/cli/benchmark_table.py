#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Does contrib/benchmark.py make its tables, whatever other benchmarks there are?

A program that measures nothing stands for crawler_benchmark; some of its benchmarks have no setting as label.
"""
import pathlib
import subprocess
import sys
import tempfile

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "contrib" / "benchmark.py"
PROGRAM = f"""#!{sys.executable}
import json, re, sys
paths = [f"run/{{path}}/{{error}}" for path in ("petsc", "fused", "batch") for error in ("1e-4", "1e-6", "1e-9")]
paths += [f"case/{{name}}/1e-6/{{path}}" for name in ("fig2", "stiff") for path in ("petsc", "fused", "batch")]
others = ["runs_of_levels/linear", "level/linear/1e-04", "reduced/linear", "sweep_of_levels"]
pattern = next(word.split("=", 1)[1] for word in sys.argv if word.startswith("--benchmark_filter="))
entries = []
for name in paths + ["sweep/1e-4", "sweep/1e-6", "scale/newton_step/500000"] + others:
    if re.search(pattern, name):
        entry = dict(run_type="iteration", run_name=name, cpu_time=1., time_unit="ms", items_per_second=1e3,
                     error=1e-7)
        entries.append(entry if name in others else entry | dict(label="a setting"))
print(json.dumps(dict(benchmarks=entries)))
"""

with tempfile.TemporaryDirectory() as folder:
    program = pathlib.Path(folder) / "tests" / "benchmark" / "crawler_benchmark"
    program.parent.mkdir(parents=True)
    program.write_text(PROGRAM, encoding="utf-8")
    program.chmod(0o755)
    result = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True, check=False)
    lines = result.stdout.splitlines()
    missing = [words for words in ("| run/1e-6 |", "| run/batch/1e-4 | 1.0e-07 | 1000 | a setting |", "Falls short:")
               if not any(line.startswith(words) for line in lines)]
    strangers = [line for line in lines if "level" in line or "reduced" in line]
    if result.returncode != 0 or missing or strangers:
        sys.exit(f"exit code {result.returncode}, missing {missing}, not asked for {strangers}\n{result.stderr}")
print("the tables are complete")
