#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Disks that are full, files that may not grow, folders that are read-only, removed or replaced: every command ends with
exit code 6 and one sentence with the name of the file, leaves older files as they were and no part of a file, and what
can be resumed gives with --resume the files of an undisturbed command.

    python3 disk.py PATH_TO_CRAWLER PATH_TO_PRM

A small disk is a tmpfs, for which this program must be allowed to mount; the largest file is a limit of the process
(ulimit -f), which always works. Each command has one of both, one behind the other; tests/long/disk.py has many.
"""
import os
import pathlib
import random
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from disk_faults import PAGE, Disk, Faults, content, fresh, prepare, take_folders_away  # noqa: E402
from program import Checks  # noqa: E402

CRAWLER, PRM = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
checks, chance = Checks(), random.Random(1)
faults = Faults(checks)


def disturb(case, disk, has_disk, inputs, whole, older):
    """No file may be as large as one of those that it writes; then the disk is too small for the rest; then there is room."""
    out, marker = disk.place / case.place, disk.place / "older"
    before = fresh(case, out, inputs)
    marker.write_bytes(b"older")
    before[marker] = b"older"
    written = [len(text) for name, text in whole.items() if text != older.get(name) and len(text) > 1 and name != "log.txt"]
    size = chance.choice(written) // 2
    what = f"{case.name}, files of {size} bytes at most"
    checks.expect(not faults.judge(case.start(out, inputs, largest=size), out, before, what), f"{what}: no fault")
    if has_disk:
        if not case.resumes:
            before = {**fresh(case, out, inputs), marker: b"older"}
        pages, used = sum(1 + (len(text) - 1) // PAGE for name, text in whole.items() if text != older.get(name)), disk.used()
        there = used - 1 if case.resumes else 0
        what = f"{case.name}, a disk with {pages - there} pages to be written, half of them there"
        disk.mount(f"size={(used + (pages - there) // 2) * PAGE}")
        done = case.start(out, inputs, ["--resume"] if case.resumes else [])
        checks.expect(not faults.judge(done, out, {marker: b"older"} if case.resumes else before, what), f"{what}: no fault")
        disk.room()
    faults.resumed(case, out, inputs, whole, what)


def read_only(cases, disk, has_disk, inputs):
    """A folder that may not be written to: on a disk, or one of the kernel's."""
    if has_disk:
        disk.mount("remount,ro")
    place = disk.place if has_disk else pathlib.Path("/proc/self")
    for case in cases:
        if case.prepared is None and not case.to_screen:
            out = place / ("new_" + case.place)
            what = f"{case.name}, read-only"
            checks.expect(not faults.judge(case.start(out, inputs), out, {}, what), f"{what}: no fault")


def main(place):
    inputs, disk = place / "inputs", Disk(place / "disk")
    cases = prepare(CRAWLER, PRM, inputs)
    has_disk = disk.room()
    if not has_disk:
        checks.skip("small disks and a read-only one: a tmpfs may not be mounted here")
    try:
        for case in cases:
            out = place / case.place
            older = {str(path.relative_to(out)): text for path, text in fresh(case, out, inputs).items()}
            done = case.start(out, inputs)
            checks.expect(done.returncode == 0, f"{case.name} itself: {done.returncode}, {done.stderr[:500]!r}")
            whole = content(out) if out.is_dir() else {"": out.read_bytes()}
            if case.name == "run":
                shutil.copytree(out, inputs / "whole_run", dirs_exist_ok=True)
            disturb(case, disk, has_disk, inputs, whole, older)
        read_only(cases, disk, has_disk, inputs)
    finally:
        if os.path.ismount(disk.place):
            disk.unmount()
    take_folders_away(CRAWLER, faults, place, inputs)
    print(f"{faults.n} faults")


if __name__ == "__main__":
    checks.run((main,))
