#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Disks that are full, files that may not grow, folders that are read-only, removed or replaced: every command ends with
exit code 6 and one sentence with the name of the file, leaves older files as they were and no part of a file, and what
can be resumed gives with --resume the files of an undisturbed command.

    python3 disk.py PATH_TO_CRAWLER PATH_TO_PRM [FAULTS [SEED [COMMAND...]]]

A small disk is a tmpfs, for which this program must be allowed to mount; the largest file is a limit of the process
(ulimit -f), which always works. FAULTS: so many sizes of the disk, and as many of the largest file, chosen at random, for
each command (default: 1; contrib/verify.sh has more).
"""
import os
import pathlib
import random
import resource
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import NO_PICTURES, Paused, call, checks, expect, prm, skip  # noqa: E402
from tables import without_columns  # noqa: E402

CRAWLER, PRM = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
FAULTS, SEED = (int(sys.argv[i]) if len(sys.argv) > i else 1 for i in (3, 4))
PAGE = 4096
RUN = prm("Accuracy=1e-3", "Active stress/Generator=expression",
          "Active stress/Expression/Active stress=0.15*sin(2*pi*(s+t))", "Time/Engine=petsc",
          "Output/Number of snapshots=3", "Output/Active stress table=4, 4", "Output/Sensitivities=Body/Elastic modulus")
QUICK = prm("Model=kinematic", "Active stress/Generator=prescribed strain",
            "Active stress/Prescribed strain/Given by=wave", "Output/Number of snapshots=2")
SWEEP = QUICK + prm("Sweep/Axes=Active stress/Prescribed strain/Amplitude : linspace(0.05, 0.3, 16)", "Sweep/Keep fields=1, 8")
TRADEOFF = prm("Active stress/Optimal wave/Perturbation parameter=0.4",
               "Active stress/Optimal wave/Choose wave by=wave speed", "Tradeoff/Integrators=radau 5",
               "Tradeoff/Degrees=2", "Tradeoff/Cells=3", "Tradeoff/Tolerances=1e-2, 1e-3", "Tradeoff/Repetitions=1",
               "Time/End time=0.1")
SAMPLES = "s,t,m\n" + "".join(f"{s / 4},{t / 8},{(s - t) % 3}\n" for t in range(9) for s in range(5))
TIMES = ("seconds", "cost", "memory", "speed", "time of")  # parts of names of columns that differ from run to run
chance = random.Random(SEED)


def content(folder):
    """Contents of all files by name; the folder itself, which some name, is FOLDER."""
    return {str(path.relative_to(folder)): path.read_bytes().replace(str(folder).encode(), b"FOLDER")
            for path in sorted(folder.rglob("*")) if path.is_file()}


class Case:
    """Command. {out}: place of its results, a folder or a file; {in}: a folder with inputs."""

    def __init__(self, name, words, resumes=True, prepared=None, place="out"):
        self.name, self.words, self.resumes, self.prepared, self.place = name, words, resumes, prepared, place

    def start(self, out, inputs, options=(), largest=None):
        """Runs the command; returns the finished process. out: place of the results, largest: size of the largest file
        in bytes."""
        words = [str(word).replace("{out}", str(out)).replace("{in}", str(inputs)) for word in self.words]

        def limit():
            if largest is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))

        command = [CRAWLER, *words, *options]
        drawn = self.name != "tradeoff"  # the pictures of an optimisation and of "plot" are enough
        return call(command, preexec_fn=limit,
                    variables={"MPLCONFIGDIR": str(inputs / "matplotlib"), **({} if drawn else NO_PICTURES)})


class Faults:
    """Counts disturbed commands, and judges them."""

    def __init__(self):
        self.n = 0

    def compare(self, case, folder, whole, what):
        """Expects the files of an undisturbed command."""
        ours = content(folder) if folder.is_dir() else {"": folder.read_bytes()}
        free = {"log.txt", "restart.dat", "restart.old.dat"}
        expect(set(ours) - free == set(whole) - free, f"{what}: other files: {sorted(set(ours) ^ set(whole))}")
        for name in set(ours) & set(whole) - free:
            if name.endswith(("results.csv", "starts.csv", "optima.csv")):
                same = without_columns(ours[name].decode(), *TIMES) == without_columns(whole[name].decode(), *TIMES)
            elif name.endswith(".prm") and "recommendations" not in name:  # comments follow names of folders
                same = ours[name].split() == whole[name].split()
            elif name.endswith((".vtu", ".vts", ".pvd", "sensitivity_body.csv", "statistics.csv", "stress.csv")):
                same = ours[name] == whole[name]
            else:  # contain times
                same = abs(len(ours[name]) - len(whole[name])) < 0.2 * len(whole[name]) + 200
            expect(same, f"{what}: {name} is another one")

    def judge(self, done, out, before, what):
        """Judges a command that could not write: exit code, sentence, older files. Returns True if it had enough
        room."""
        self.n += done.returncode != 0
        if done.returncode == 0:
            return True
        words = done.stderr
        expect(done.returncode == 6, f"{what}: exit code {done.returncode}, {words[:400]!r}")
        expect(words.count("\n") == 1 and words.startswith("crawler: ") and len(words) < 1000 and
               any(text in words for text in ("disk", '"')), f"{what}: {words[:600]!r} is not one sentence")
        for path, text in before.items():
            expect(path.read_bytes() == text, f"{what}: {path.name}, which is older, was damaged")
        parts = [path.name for path in (out.rglob("*") if out.is_dir() else out.parent.glob("*.part"))
                 if path.name.endswith(".part")]
        expect(not parts, f"{what}: {parts} are left")
        return False

    def resumed(self, case, out, inputs, whole, what):
        """Expects the command, with enough room, to go on to the end."""
        options = ["--resume"] if case.resumes else []
        if not case.resumes and case.prepared is None:
            out.unlink(missing_ok=True)
        done = case.start(out, inputs, options)
        expect(done.returncode == 0, f"{what}, then with room: exit code {done.returncode}, {done.stderr[:400]!r}")
        if done.returncode == 0:
            self.compare(case, out, whole, what)

    def taken_away(self, place, command, stop_at):
        """Removes, renames or replaces the folder {out} of a run or study while it waits."""
        for how in ("removed", "renamed", "replaced"):
            out, other = place / "taken", place / "other"
            for folder in (out, other):
                shutil.rmtree(folder, ignore_errors=True)
            what = f"{command[1]}, its folder {how}"
            with Paused([*command, "--output", out], stop_at) as paused:
                expect((out / "study.lock").exists(), f"{what}: it has not begun, {list(out.rglob('*'))}")
                if how == "removed":
                    shutil.rmtree(out)
                else:
                    out.rename(other)
                if how == "replaced":
                    out.mkdir()
                    (out / "mine").write_text("mine", encoding="utf-8")
                done = paused.go_on()
            self.n += 1
            expect(done.returncode == 6 and done.stderr.count("\n") == 1 and str(out) in done.stderr,
                        f"{what}: exit code {done.returncode}, {done.stderr[:400]!r}")
            if how == "replaced":
                expect(content(out) == {"mine": b"mine"}, f"{what}: written into the new folder: {[*content(out)]}")


faults = Faults()


class Disk:
    """Tmpfs of some size."""

    def __init__(self, place):
        self.place = place
        place.mkdir()

    def room(self):
        """Sets the size to a maximum that is never exceeded."""
        return self.mount("size=64M")

    def used(self):
        return sum(-(-path.stat().st_size // PAGE) for path in self.place.rglob("*") if path.is_file())

    def mount(self, options):
        """Mounts it; returns True if that is possible."""
        mounted = ["-o", "remount," + options] if os.path.ismount(self.place) else ["-t", "tmpfs", "-o", options, "tmpfs"]
        return subprocess.run(["mount", *mounted, str(self.place)], capture_output=True, check=False).returncode == 0

    def unmount(self):
        """Unmounts it in any case."""
        if os.path.ismount(self.place):
            subprocess.run(["umount", str(self.place)], check=True)


def fresh(case, out, inputs):
    """Restores the place of the results to its state before the command; returns the older files in it."""
    shutil.rmtree(out, ignore_errors=True)
    out.unlink(missing_ok=True)
    if case.prepared is not None:
        shutil.copytree(inputs / case.prepared, out)
    return {path: path.read_bytes() for path in out.rglob("*") if path.is_file()} if out.is_dir() else {}


def prepare(inputs):
    """Returns the commands, after writing their parameter files."""
    inputs.mkdir()
    for file, text in [("run.prm", RUN), ("quick.prm", QUICK), ("sweep.prm", SWEEP), ("tradeoff.prm", TRADEOFF),
                       ("samples.csv", SAMPLES)]:
        (inputs / file).write_text(text, encoding="utf-8")
    optimize = PRM / "studies" / "optimize_harmonics.prm"
    return [Case("run", ["run", "{in}/run.prm", "--output", "{out}", "--quiet"]),
            Case("run xdmf", ["run", "{in}/run.prm", "--output", "{out}", "--quiet", "--set",
                               "Output/Snapshot format=xdmf", "--set", "Output/Sensitivities="]),
            Case("run without a mesh", ["run", "{in}/quick.prm", "--output", "{out}", "--quiet"]),
            Case("sweep", ["sweep", "{in}/sweep.prm", "--output", "{out}", "--quiet"]),
            Case("tradeoff", ["tradeoff", "{in}/tradeoff.prm", "--output", "{out}", "--quiet"]),
            Case("optimize", ["optimize", optimize, "--output", "{out}", "--quiet", "--set", "Optimize/Starts=1"]),
            Case("report", ["report", "{out}", "--quiet"], resumes=False, prepared="whole_run"),
            Case("plot", ["plot", "{out}"], resumes=False, prepared="whole_run"),
            Case("table", ["table", "{in}/samples.csv", "{out}", "--quiet", "--overwrite"], resumes=False,
                  place="out.csv"),
            Case("init", ["init", "robot", "--output", "{out}"], resumes=False)]


# Runs and studies whose folders are taken away: without pilot runs, and too long to end before.
LONG_RUN = ["--set", "Time/End time=60", "--set", "Output/Sensitivities=", "--set", "Output/Active stress table=", "--set",
            "Output/Number of snapshots=0", "--set", "Time/Tolerance=1e-9", "--set", "Time/Integrator=radau 5", "--set",
            "Discretization/Number of cells=8", "--set", "Time/Cycle stop=off", "--set", "Time/Checkpoint interval=0", "--quiet"]
LONG_SWEEP = ["--set", "Sweep/Axes=Active stress/Prescribed strain/Amplitude : linspace(0.05, 0.3, 500)", "--set",
              "Sweep/Keep fields=", "--quiet"]


def take_folders_away(place, inputs):
    """Takes away the folders of a run and of a sweep."""
    faults.taken_away(place, [CRAWLER, "run", inputs / "run.prm", *LONG_RUN], "step:300:STOP")
    faults.taken_away(place, [CRAWLER, "sweep", inputs / "sweep.prm", *LONG_SWEEP], "row:3:STOP")


def chosen(sizes):
    """FAULTS of the sizes, always the smallest and the largest if they are several."""
    sizes = sorted(set(sizes))
    if FAULTS == 1:
        return [chance.choice(sizes)]
    return sizes if len(sizes) <= FAULTS else sorted({sizes[0], sizes[-1], *chance.sample(sizes[1:-1], FAULTS - 2)})


def small_files(case, place, inputs, whole, written):
    """No file may be larger than one of those that it writes, or half of it."""
    out, found = place / case.place, []
    sizes = [len(text) // 2 for text in written] + ([0, *(len(text) - 1 for text in written)] if FAULTS > 1 else [])
    for size in chosen(sizes):
        what, before = f"{case.name}, files of {size} bytes at most", fresh(case, out, inputs)
        found.append(not faults.judge(case.start(out, inputs, largest=size), out, before, what))
        if found[-1]:
            faults.resumed(case, out, inputs, whole, what)
    expect(any(found), f"{case.name}: no fault")


def small_disks(case, disk, inputs, whole, written):
    """The disk has so many pages for what it writes, and no more for a first --resume."""
    out, older, found = disk.place / case.place, disk.place / "older", []
    pages = sum(1 + (len(text) - 1) // PAGE for text in written)
    for size in chosen(range(pages // 2 + 1 if FAULTS == 1 else pages + 8)):
        what = f"{case.name}, a disk of {size} pages"
        disk.room()
        before = fresh(case, out, inputs)
        older.write_bytes(b"older")
        before[older] = b"older"
        if not disk.mount(f"size={(disk.used() + size) * PAGE}"):
            continue
        found.append(not faults.judge(case.start(out, inputs), out, before, what))
        if found[-1]:
            if case.resumes:
                faults.judge(case.start(out, inputs, ["--resume"]), out, {older: b"older"}, what + ", resumed")
            disk.room()
            faults.resumed(case, out, inputs, whole, what)
    expect(any(found), f"{case.name}: no fault")
    disk.room()


def read_only(cases, disk, has_disk, inputs):
    """A folder that may not be written to: on a disk, or one of the kernel's."""
    if has_disk:
        disk.mount("remount,ro")
    place = disk.place if has_disk else pathlib.Path("/proc/self")
    for case in cases:
        if case.prepared is None:
            out = place / ("new_" + case.place)
            what = f"{case.name}, read-only"
            expect(not faults.judge(case.start(out, inputs), out, {}, what), f"{what}: no fault")


def main(place):
    print(f"seed {SEED}", flush=True)
    inputs, disk, only = place / "inputs", Disk(place / "disk"), sys.argv[5:]
    cases = prepare(inputs)
    has_disk = disk.room()
    if not has_disk:
        skip("small disks and a read-only one: a tmpfs may not be mounted here")
    try:
        for case in cases:
            out = place / case.place
            older = {str(path.relative_to(out)): text for path, text in fresh(case, out, inputs).items()}
            if only and case.name not in ["run", *only]:
                continue
            done = case.start(out, inputs)
            expect(done.returncode == 0, f"{case.name} itself: {done.returncode}, {done.stderr[:500]!r}")
            whole = content(out) if out.is_dir() else {"": out.read_bytes()}
            if case.name == "run":
                shutil.copytree(out, inputs / "whole_run", dirs_exist_ok=True)
            written = [text for name, text in whole.items() if text != older.get(name) and len(text) > 1 and name != "log.txt"]
            small_files(case, place, inputs, whole, written)
            if has_disk:
                small_disks(case, disk, inputs, whole, written)
        read_only(cases, disk, has_disk, inputs)
    finally:
        disk.unmount()
    take_folders_away(place, inputs)
    print(f"{faults.n} faults")


checks.run((main,))
