#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Disks that are full, files that may not grow, folders that are read-only, removed or replaced: every command ends with
exit code 6 and one sentence with the name of the file, leaves older files as they were and no part of a file, and what
can be resumed gives with --resume the files of an undisturbed command.

    python3 disk.py PATH_TO_CRAWLER PATH_TO_PRM FAULTS

FAULTS: so many sizes of the disk, and as many of the largest file, for each command. A small disk is a tmpfs, for which
this program must be allowed to mount; the largest file is a limit of the process (ulimit -f), which always works.
"""
import csv
import os
import pathlib
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import time

CRAWLER, PRM, FAULTS = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), int(sys.argv[3])
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
PAGE = 4096
RUN = """set Accuracy = 1e-3
subsection Active stress
  set Generator = expression
  subsection Expression
    set Active stress = 0.15*sin(2*pi*(s+t))
  end
end
subsection Time
  set Engine = petsc
end
subsection Output
  set Number of snapshots = 3
  set Active stress table = 4, 4
  set Sensitivities       = Body/Elastic modulus
end
"""
QUICK = """set Model = kinematic
subsection Active stress
  set Generator = prescribed strain
  subsection Prescribed strain
    set Given by = wave
  end
end
subsection Output
  set Number of snapshots = 2
end
"""
SWEEP = QUICK + """subsection Sweep
  set Axes = Active stress/Prescribed strain/Amplitude : linspace(0.05, 0.3, 16)
  set Keep fields = 1, 8
end
"""
ATLAS = """set Accuracy = 1e-3
subsection Active stress
  subsection Optimal wave
    set Choose wave by = wave speed
  end
end
subsection Atlas
  set First axis  = Active stress/Optimal wave/Perturbation parameter : 0.1, 0.2
  set Second axis = Body/Anchoring exponent : linspace(0, 2, 2)
end
"""
TRADEOFF = """subsection Active stress
  subsection Optimal wave
    set Perturbation parameter = 0.4
    set Choose wave by = wave speed
  end
end
subsection Tradeoff
  set Integrators = radau 5
  set Degrees     = 2
  set Cells       = 3
  set Tolerances  = 1e-2, 1e-3
  set Repetitions = 1
end
"""
SAMPLES = "s,t,m\n" + "".join(f"{s / 4},{t / 8},{(s - t) % 3}\n" for t in range(9) for s in range(5))
TIMES = ("seconds", "cost", "memory", "speed", "time of")  # in names of columns that differ from run to run
failures, faults, skipped = [], 0, set()


def expect(condition, what):
    """Notes what is wrong."""
    if not condition:
        failures.append(what)
        print("FAILED", what, flush=True)


def content(folder):
    """All files by name; the folder itself, which some name, is FOLDER."""
    return {str(path.relative_to(folder)): path.read_bytes().replace(str(folder).encode(), b"FOLDER")
            for path in sorted(folder.rglob("*")) if path.is_file()}


class Case:
    """A command. {out}: where its results go, a folder or a file; {in}: a folder with inputs."""

    def __init__(self, name, words, resumes=True, prepared=None, to_screen=False, place="out"):
        self.name, self.words, self.resumes, self.prepared = name, words, resumes, prepared
        self.to_screen, self.place = to_screen, place

    def start(self, out, inputs, options=(), largest=None):
        """The finished process; out is where results go, largest the size of the largest file in bytes."""
        words = [str(word).replace("{out}", str(out)).replace("{in}", str(inputs)) for word in self.words]
        environment = dict(ENVIRONMENT, MPLCONFIGDIR=str(inputs / "matplotlib"))

        def limit():
            if largest is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))

        if not self.to_screen:
            return subprocess.run([CRAWLER, *words, *options], env=environment, stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True, timeout=120, check=False, preexec_fn=limit)
        try:
            with open(out, "w", encoding="utf-8") as file:
                return subprocess.run([CRAWLER, *words, *options], env=environment, stdout=file, stderr=subprocess.PIPE,
                                      text=True, timeout=120, check=False, preexec_fn=limit)
        except OSError:  # no room for the name of the file: that is the shell's affair
            return None


def without_times(text):
    """The rows of a table without columns that differ from run to run."""
    rows = list(csv.reader(text.decode().splitlines()))
    kept = [i for i, name in enumerate(rows[0]) if not any(word in name for word in TIMES)]
    return [[row[i] for i in kept] for row in rows]


def compare(case, folder, whole, what):
    """Are these the files of an undisturbed command?"""
    ours = content(folder) if folder.is_dir() else {"": folder.read_bytes()}
    free = {"log.txt", "restart.dat", "restart.old.dat"}
    expect(set(ours) - free == set(whole) - free, f"{what}: other files: {sorted(set(ours) ^ set(whole))}")
    for name in set(ours) & set(whole) - free:
        if name.endswith("results.csv") or name.endswith("atlas.csv") or name.endswith(("starts.csv", "optima.csv")):
            same = without_times(ours[name]) == without_times(whole[name])
        elif name.endswith(".prm") and "recommendations" not in name:  # comments stand behind names of folders
            same = ours[name].split() == whole[name].split()
        elif name.endswith((".vtu", ".vts", ".pvd", "sensitivity_body.csv", "statistics.csv", "stress.csv")):
            same = ours[name] == whole[name]
        else:  # times are in them
            same = abs(len(ours[name]) - len(whole[name])) < 0.2 * len(whole[name]) + 200
        expect(same, f"{what}: {name} is another one")


def disturbed(case, done, out, before, what):
    """A command that could not write: exit code, sentence, older files. Returns whether it had room enough."""
    global faults
    if done is None:
        return False
    faults += done.returncode != 0
    if done.returncode == 0:
        return True
    words = done.stderr
    expect(done.returncode == 6, f"{what}: exit code {done.returncode}, {words[:400]!r}")
    expect(words.count("\n") == 1 and words.startswith("crawler: ") and len(words) < 1000 and
           any(text in words for text in ("disk", '"', "standard output")), f"{what}: {words[:600]!r} is not one sentence")
    for path, text in before.items():
        expect(path.read_bytes() == text, f"{what}: {path.name}, which is older, was damaged")
    parts = [path.name for path in (out.rglob("*") if out.is_dir() else out.parent.glob("*.part"))
             if path.name.endswith(".part")]
    expect(not parts, f"{what}: {parts} are left")
    return False


class Disk:
    """A tmpfs of some size."""

    def __init__(self, place):
        self.place = place
        place.mkdir()

    def mount(self, options):
        """Whether that is possible."""
        mounted = ["-o", "remount," + options] if os.path.ismount(self.place) else ["-t", "tmpfs", "-o", options, "tmpfs"]
        return subprocess.run(["mount", *mounted, str(self.place)], capture_output=True, check=False).returncode == 0

    def unmount(self):
        """Whatever was there."""
        if os.path.ismount(self.place):
            subprocess.run(["umount", str(self.place)], check=True)


def chosen(sizes, chance):
    """FAULTS of the sizes, always the smallest and the largest."""
    sizes = sorted(set(sizes))
    if len(sizes) <= FAULTS:
        return sizes
    return sorted({sizes[0], sizes[-1], *chance.sample(sizes[1:-1], max(0, FAULTS - 2))})


def fresh(case, out, inputs):
    """The place of the results as it is before the command, and the older files in it."""
    shutil.rmtree(out, ignore_errors=True)
    out.unlink(missing_ok=True)
    if case.prepared is not None:
        shutil.copytree(inputs / case.prepared, out)
    return {path: path.read_bytes() for path in out.rglob("*") if path.is_file()} if out.is_dir() else {}


def resumed(case, out, inputs, whole, what):
    """With room enough, the command goes on to the end."""
    options = ["--resume"] if case.resumes else []
    if not case.resumes and case.prepared is None:
        out.unlink(missing_ok=True)
    done = case.start(out, inputs, options)
    expect(done.returncode == 0, f"{what}, then with room: exit code {done.returncode}, {done.stderr[:400]!r}")
    if done.returncode == 0:
        compare(case, out, whole, what)


def small_files(case, place, inputs, whole, chance):
    """No file may be larger than ..."""
    out = place / case.place
    sizes = [size for text in whole.values() for size in (len(text) - 1, len(text) // 2) if size >= 0]
    for size in chosen([0, *sizes], chance):
        what = f"{case.name}, files of {size} bytes at most"
        before = fresh(case, out, inputs)
        if not disturbed(case, case.start(out, inputs, largest=size), out, before, what):
            resumed(case, out, inputs, whole, what)


def small_disks(case, disk, inputs, whole, chance):
    """The disk has so many pages."""
    if not disk.mount("size=64k"):
        skipped.add("small disks (a tmpfs may not be mounted here)")
        return
    try:
        out, older = disk.place / case.place, disk.place / "older"
        pages = sum(1 + len(text) // PAGE for text in whole.values())
        for size in chosen(range(1, pages + 8), chance):
            what = f"{case.name}, a disk of {size} pages"
            disk.mount("size=64M")
            before = fresh(case, out, inputs)
            older.write_bytes(b"older")
            before[older] = b"older"
            used = sum(-(-path.stat().st_size // PAGE) for path in disk.place.rglob("*") if path.is_file())
            if not disk.mount(f"size={(used + size) * PAGE}"):
                continue
            if not disturbed(case, case.start(out, inputs), out, before, what):
                disk.mount("size=64M")
                resumed(case, out, inputs, whole, what)
    finally:
        disk.unmount()


def read_only(cases, disk, inputs):
    """A folder that may not be written to."""
    if not disk.mount("size=1M") or not disk.mount("ro"):
        skipped.add("a read-only disk (a tmpfs may not be mounted here; a folder of the kernel instead)")
    place = disk.place if os.path.ismount(disk.place) else pathlib.Path("/proc/self")
    try:
        for case in cases:
            if case.prepared is None and not case.to_screen:
                what = f"{case.name}, read-only"
                out = place / case.place
                expect(not disturbed(case, case.start(out, inputs), out, {}, what), f"{what}: no error")
    finally:
        disk.unmount()


def taken_away(place, inputs, words):
    """The folder of a run or study is removed, renamed or replaced while it goes on."""
    global faults
    for how in ("removed", "renamed", "replaced"):
        out, other = place / "taken", place / "other"
        for folder in (out, other):
            shutil.rmtree(folder, ignore_errors=True)
        what = f"{words[0]}, its folder {how}"
        command = [CRAWLER, words[0], str(inputs / words[1]), "--output", str(out), *words[2:]]
        with subprocess.Popen(command, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              text=True) as process:
            limit = time.monotonic() + 60
            while not (out / words[-1].split("=")[0]).exists() and not (out / "log.txt").exists() and \
                    process.poll() is None and time.monotonic() < limit:
                time.sleep(0.01)
            time.sleep(0.2)
            expect(process.poll() is None, f"{what}: it is too quick for this test, {process.poll()}")
            if how == "removed":
                while out.exists():
                    shutil.rmtree(out, ignore_errors=True)
            else:
                out.rename(other)
            if how == "replaced":
                out.mkdir()
                (out / "mine").write_text("mine", encoding="utf-8")
            words_at_end = process.communicate(timeout=100)[1]
        faults += 1
        expect(process.returncode == 6 and words_at_end.count("\n") == 1 and str(out) in words_at_end,
               f"{what}: exit code {process.returncode}, {words_at_end[:400]!r}")
        if how == "replaced":
            expect(content(out) == {"mine": b"mine"}, f"{what}: written into the other folder: {list(content(out))}")


def main():
    """All of it."""
    chance = random.Random(1)
    with tempfile.TemporaryDirectory() as name:
        place = pathlib.Path(name)
        inputs = place / "inputs"
        inputs.mkdir()
        for file, text in [("run.prm", RUN), ("quick.prm", QUICK), ("sweep.prm", SWEEP), ("atlas.prm", ATLAS),
                           ("tradeoff.prm", TRADEOFF), ("samples.csv", SAMPLES)]:
            (inputs / file).write_text(text, encoding="utf-8")
        optimize = PRM / "studies" / "optimize_harmonics.prm"
        cases = [Case("run", ["run", "{in}/run.prm", "--output", "{out}", "--quiet"]),
                 Case("run xdmf", ["run", "{in}/run.prm", "--output", "{out}", "--quiet", "--set",
                                   "Output/Snapshot format=xdmf", "--set", "Output/Sensitivities="]),
                 Case("run without a mesh", ["run", "{in}/quick.prm", "--output", "{out}", "--quiet"]),
                 Case("sweep", ["sweep", "{in}/sweep.prm", "--output", "{out}", "--quiet"]),
                 Case("atlas", ["atlas", "{in}/atlas.prm", "--output", "{out}", "--quiet"]),
                 Case("tradeoff", ["tradeoff", "{in}/tradeoff.prm", "--output", "{out}", "--quiet"]),
                 Case("optimize", ["optimize", optimize, "--output", "{out}", "--quiet", "--set", "Optimize/Starts=1"]),
                 Case("report", ["report", "{out}", "--quiet"], resumes=False, prepared="whole_run"),
                 Case("plot", ["plot", "{out}"], resumes=False, prepared="whole_run"),
                 Case("table", ["table", "{in}/samples.csv", "{out}", "--quiet", "--overwrite"], resumes=False,
                      place="out.csv"),
                 Case("init", ["init", "robot", "--output", "{out}"], resumes=False),
                 Case("parameters", ["parameters"], resumes=False, to_screen=True),
                 Case("check", ["check", "{in}/run.prm"], resumes=False, to_screen=True)]
        only = os.environ.get("CASES", "").split(",") if os.environ.get("CASES") else [case.name for case in cases]
        cases = [case for case in cases if case.name in only or case.name == "run"]
        disk = Disk(place / "disk")
        for case in cases:
            begin = time.monotonic()
            out = place / case.place
            fresh(case, out, inputs)
            done = case.start(out, inputs)
            expect(done.returncode == 0, f"{case.name} itself: {done.returncode}, {done.stderr[:500]!r}")
            if done.returncode != 0:
                continue
            whole = content(out) if out.is_dir() else {"": out.read_bytes()}
            if case.name == "run":
                shutil.copytree(out, inputs / "whole_run", dirs_exist_ok=True)
            if case.name not in only:
                continue
            before = faults
            small_files(case, place, inputs, whole, chance)
            small_disks(case, disk, inputs, whole, chance)
            print(f"{case.name}: {faults - before} faults, {time.monotonic() - begin:.1f} s", flush=True)
        read_only(cases, disk, inputs)
        taken_away(place, inputs, ["run", "run.prm", "--set", "Time/End time=60", "--set", "Output/Sensitivities=",
                                   "--set", "Output/Active stress table=", "--set", "Output/Number of snapshots=0",
                                   "--set", "Time/Tolerance=1e-9", "--set", "Time/Cycle stop=off",
                                   "--set", "Time/Checkpoint interval=0.1"])
        taken_away(place, inputs, ["sweep", "sweep.prm", "--set", "Sweep/Axes=Active stress/Prescribed strain/Amplitude "
                                   ": linspace(0.05, 0.3, 20000)", "--set", "Sweep/Keep fields="])
    for one in sorted(skipped):
        print("skip  ", one)
    print(f"{faults} faults")
    sys.exit("\n".join(failures) or 0)


if __name__ == "__main__":
    main()
