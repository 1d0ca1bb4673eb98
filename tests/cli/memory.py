#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The memory of a process that computes many points does not grow with their number: a sweep without a mesh, one by the
lanes, and one by PETSc. Prints what a process has in memory after a third of its time and at its end.

    python3 memory.py PATH_TO_CRAWLER POINTS [PART_FOR_PETSC]

PART_FOR_PETSC: its points are slower, so only this part of them is computed (default: 0.1).
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import time

CRAWLER, POINTS = sys.argv[1], int(sys.argv[2])
PART = float(sys.argv[3]) if len(sys.argv) > 3 else 0.1
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
WAVE = """set Accuracy = 1e-3
subsection Active stress
  set Generator = expression
  subsection Expression
    set Active stress = 0.15*sin(2*pi*(s+t))
  end
end
subsection Sweep
  set Axes = Body/Elastic modulus : linspace(1, 2, %d)
end
"""
SWEEPS = {
    "no mesh": ("""set Model = kinematic
subsection Active stress
  set Generator = prescribed strain
  subsection Prescribed strain
    set Given by = wave
  end
end
subsection Sweep
  set Axes = Active stress/Prescribed strain/Amplitude : linspace(0.05, 0.3, %d)
end
""", 1., []),
    "lanes": (WAVE, 1., []),
    "PETSc": (WAVE, PART, ["--set", "Time/Engine=petsc", "--set", "Error estimate=false"]),
}
ALLOWED = 12.  # MB: what the allocator keeps in reserve differs by so much
failures = []


def megabytes(process):
    """Of memory that the process has; 0 if it has ended."""
    try:
        status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="ascii")
    except OSError:
        return 0.
    return next((float(line.split()[1]) / 1024. for line in status.splitlines() if line.startswith("VmRSS")), 0.)


def measure(name, place):
    """A sweep, watched."""
    text, part, more = SWEEPS[name]
    n = max(100, int(part * POINTS))
    scene = place / "scene.prm"
    scene.write_text(text % n, encoding="utf-8")
    samples = []
    begin = time.monotonic()
    with subprocess.Popen([CRAWLER, "sweep", str(scene), "--output", str(place / name.replace(" ", "_")), "--quiet", *more],
                          env=ENVIRONMENT, stderr=subprocess.PIPE, text=True) as process:
        while process.poll() is None:
            samples.append((time.monotonic() - begin, megabytes(process)))
            time.sleep(0.01)
        words = process.stderr.read()
    if process.returncode != 0:
        failures.append(f"{name}: exit code {process.returncode}, {words[:300]!r}")
        return
    seconds = samples[-1][0]
    early = max((size for when, size in samples if when <= seconds / 3.), default=0.)
    late = max(size for when, size in samples if when > seconds / 3.)
    print(f"{name}: {n} points in {seconds:.1f} s, {early:.1f} MB after a third of the time, {late:.1f} MB at most later")
    if late > early + ALLOWED:
        failures.append(f"{name}: the memory grows from {early:.1f} to {late:.1f} MB")


with tempfile.TemporaryDirectory() as directory:
    for one in SWEEPS:
        measure(one, pathlib.Path(directory))

sys.exit("\n".join(failures) or 0)
