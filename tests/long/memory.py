#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The memory of a process that computes many points does not grow with their number: a sweep without a mesh, one by the
lanes, and one by PETSc. Prints the most that a process has had in memory after a third of its rows and at its end.

    python3 memory.py PATH_TO_CRAWLER POINTS [PART_FOR_PETSC]

PART_FOR_PETSC: its points are slower, so only this part of them is computed (default: 0.1).
"""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import Paused, checks, expect, prm  # noqa: E402

CRAWLER, POINTS = sys.argv[1], int(sys.argv[2])
PART = float(sys.argv[3]) if len(sys.argv) > 3 else 0.1
WAVE = prm("Accuracy=1e-3", "Active stress/Generator=expression",
           "Active stress/Expression/Active stress=0.15*sin(2*pi*(s+t))",
           "Sweep/Axes=Body/Elastic modulus : linspace(1, 2, %d)")
SWEEPS = {
    "no mesh": (prm("Model=kinematic", "Active stress/Generator=prescribed strain",
                    "Active stress/Prescribed strain/Given by=wave",
                    "Sweep/Axes=Active stress/Prescribed strain/Amplitude : linspace(0.05, 0.3, %d)"), 1., []),
    "lanes": (WAVE, 1., []),
    "PETSc": (WAVE, PART, ["--set", "Time/Engine=petsc", "--set", "Error estimate=false"]),
}
ALLOWED = 12.  # MB: what the allocator keeps in reserve differs by so much


def largest(process):
    """MB of memory that the process has had."""
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="ascii")
    return float(re.search(r"VmHWM:\s+(\d+) kB", status)[1]) / 1024.


def measure(name, place):
    """A sweep that waits after a third of its rows and at the end of its work."""
    text, part, more = SWEEPS[name]
    n = max(100, int(part * POINTS))
    scene = place / "scene.prm"
    scene.write_text(text % n, encoding="utf-8")
    sizes = []
    for stop_at in (f"row:{n // 3}:STOP", "write:summary.json:STOP"):
        folder = place / f"{name}_{len(sizes)}".replace(" ", "_")
        with Paused([CRAWLER, "sweep", scene, "--output", folder, "--quiet", *more], stop_at) as paused:
            sizes.append(largest(paused.process))
            if len(sizes) == 2:
                done = paused.go_on()
                expect(done.returncode == 0, f"{name}: exit code {done.returncode}, {done.stderr[:300]!r}")
    print(f"{name}: {n} points, {sizes[0]:.1f} MB after a third of them, {sizes[1]:.1f} MB at the end")
    expect(sizes[1] <= sizes[0] + ALLOWED, f"{name}: the memory grows from {sizes[0]:.1f} to {sizes[1]:.1f} MB")


def main(folder):
    for one in SWEEPS:
        measure(one, folder)


checks.run((main,))
