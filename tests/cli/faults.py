#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Folders, files and texts that would do harm: each is answered with one sentence and the right exit code, in time, and
nothing outside of the output folder is touched.

    python3 faults.py PATH_TO_CRAWLER PATH_TO_PRM
"""
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

CRAWLER, PRM = sys.argv[1], pathlib.Path(sys.argv[2])
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
QUICK = """set Model = kinematic
subsection Active stress
  set Generator = prescribed strain
  subsection Prescribed strain
    set Given by = wave
  end
end
subsection Sweep
  set Axes = Active stress/Prescribed strain/Amplitude : linspace(0.05, 0.3, 16)
end
"""
failures = []


def expect(condition, what):
    """Notes what is wrong."""
    if not condition:
        failures.append(what)


def crawler(*arguments, seconds=60, **options):
    """The finished process."""
    return subprocess.run([CRAWLER, *map(str, arguments)], env=ENVIRONMENT, capture_output=True, text=True,
                          timeout=seconds, check=False, **options)


def refused(done, code, words, what):
    """One short sentence, and this exit code."""
    expect(done.returncode == code and words in done.stderr and done.stderr.count("\n") == 1 and len(done.stderr) < 3000,
           f"{what}: exit code {done.returncode}, {done.stderr[:500]!r}")


def damaged_tables(place, scene):
    """results.h5 that is not what sweep wrote."""
    whole = place / "whole"
    expect(crawler("sweep", scene, "--output", whole).returncode == 0, "the sweep itself")
    reference = (whole / "results.csv").read_text()
    for name, harm in [
            ("many_dimensions", lambda file: replaced(file["results"], "displacement", np.zeros((2,) * 30, "i1"))),
            ("huge", lambda file: replaced(file["results"], "displacement", shape=(1 << 60,), dtype="f8", chunks=(1024,))),
            ("array_attribute", lambda file: file["results"]["displacement"].attrs.create("unit", np.zeros(1 << 16, "S64"))),
            ("variable_texts", lambda file: replaced(file["results"], "status", ["a", "b"], dtype=h5py.string_dtype())),
            ("no_group", lambda file: file.move("results", "swept"))]:
        folder = place / name
        shutil.copytree(whole, folder)
        with h5py.File(folder / "results.h5", "r+") as file:
            attributes = dict(file["results"]["displacement"].attrs)
            harm(file)
            if "results" in file and "displacement" in file["results"] and not file["results"]["displacement"].attrs:
                for key, value in attributes.items():
                    file["results"]["displacement"].attrs[key] = value
        refused(crawler("sweep", scene, "--output", folder, "--resume"), 2, "results.h5", name)
        expect(not (folder / "study.lock").exists(), f"{name}: a refused study leaves its lock")

    # Flipped bits: the rows that they are in are computed anew, so the table is that of the first time.
    chance = random.Random(1)
    values = whole / "results.h5"
    with h5py.File(values) as file:
        places = [file["results"][name].id.get_offset() for name in ("displacement", "stress_power", "gait.efficiency")]
    for attempt in range(12):
        folder = place / f"flipped_{attempt}"
        shutil.copytree(whole, folder)
        data = bytearray((folder / "results.h5").read_bytes())
        data[chance.choice(places) + chance.randrange(8 * 16)] ^= 1 << chance.randrange(8)
        (folder / "results.h5").write_bytes(data)
        done = crawler("sweep", scene, "--output", folder, "--resume")
        expect(done.returncode == 0 and "was damaged" in done.stderr and without_times(reference)
               == without_times((folder / "results.csv").read_text()), f"flipped bit {attempt}: {done.stderr}")


def replaced(group, name, data=None, **options):
    """Another dataset in the place of one."""
    del group[name]
    group.create_dataset(name, data=data, **options)


def without_times(text):
    """A table without its columns of wall times."""
    rows = [line.split(",") for line in text.splitlines()]
    kept = [i for i, name in enumerate(rows[0]) if not name.startswith("seconds")]
    return [[row[i] for i in kept] for row in rows]


def links(place, scene):
    """Nothing is written or removed through a link."""
    outside = place / "outside"
    (outside / "snapshots").mkdir(parents=True)
    (outside / "snapshots" / "mine.vtu").write_text("mine")
    (outside / "file").write_text("mine")
    for name in ("original.prm.part", "parameters.prm.part", "summary.json.part", "results.csv.part", "results.h5.part"):
        for command in ("run", "sweep"):
            folder = place / f"link_{command}_{name}"
            folder.mkdir()
            (folder / name).symlink_to(outside / "file")
            crawler(command, scene, "--output", folder, "--overwrite")
            expect((outside / "file").read_text() == "mine", f"{command} writes through the link {name}")
    for name in ("solution", "points", "best"):
        folder = place / f"link_{name}"
        folder.mkdir()
        (folder / name).symlink_to(outside / "snapshots")
        refused(crawler("run", scene, "--output", folder, "--overwrite"), 6, "is a link", f"the link {name}")
        expect((outside / "snapshots" / "mine.vtu").exists(), f"files behind the link {name} are gone")


def texts(place):
    """Parameter files that never end, and texts that steer terminals."""
    bomb = place / "bomb"
    bomb.mkdir()
    for level in range(9):
        (bomb / f"{level}.prm").write_text(f"include {level + 1}.prm\n" * 10)
    (bomb / "9.prm").write_text("# nothing\n")
    refused(crawler("check", bomb / "0.prm", seconds=20), 2, "at most 1000", "ten includes of ten files")
    nested = place / "nested.prm"
    nested.write_text("subsection a\n" * 100000 + "end\n" * 100000)
    refused(crawler("check", nested, seconds=20), 2, "more than 100 deep", "nested sections")
    many = place / "many.prm"
    many.write_text("".join(f"set Entry {i} = 1\n" for i in range(100000)))
    refused(crawler("check", many, seconds=20), 2, "Entry 0", "many entries")
    long = place / "long.prm"
    long.write_text("subsection Active stress\n set Generator = expression\n subsection Expression\n  set Active stress = "
                    + "1+" * 500000 + "x\n end\nend\n")
    refused(crawler("check", long, seconds=20), 2, "characters)", "a long formula")
    steering = place / "steering.prm"
    steering.write_text("subsection Body\n set Length = \x1b[31mred\nend\n")
    done = crawler("check", steering)
    expect(done.returncode == 2 and "\x1b" not in done.stderr and "\\x1b[31m" in done.stderr, f"escapes: {done.stderr!r}")


def two_at_once(place):
    """Two runs in one folder: one of them is refused."""
    folder, scene = place / "both", PRM / "paper" / "fig_2.prm"
    formula = "0.2*sin(2*pi*s+2*pi*t+0.1*sin(1.234*t))-0.2*sin(2*pi*s)"  # that repeats itself never
    command = [CRAWLER, "run", str(scene), "--output", str(folder), "--set", "Time/End time=1000",
               "--set", "Output/Number of snapshots=10000", "--set", "Active stress/Generator=expression",
               "--set", "Active stress/Expression/Active stress=" + formula]
    first = subprocess.Popen(command, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    limit = time.monotonic() + 60
    while not (folder / "solution").exists() and first.poll() is None and time.monotonic() < limit:
        time.sleep(0.01)
    expect(first.poll() is None, "the first run is too quick for this test")
    refused(crawler("run", scene, "--output", folder, "--overwrite"), 2, "writes to", "a second run in the same folder")
    first.send_signal(signal.SIGTERM)
    first.communicate(timeout=60)
    expect(first.returncode in (0, 5) and not (folder / "study.lock").exists(), "the first run leaves its lock")


with tempfile.TemporaryDirectory() as directory:
    directory = pathlib.Path(directory)
    quick = directory / "quick.prm"
    quick.write_text(QUICK)
    damaged_tables(directory, quick)
    links(directory, quick)
    texts(directory)
    two_at_once(directory)

sys.exit("\n".join(failures) or 0)
