#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""What tests/cli/disk.py does, with disks of many sizes and many limits of the largest file, chosen at random, for each
command.

    python3 disk.py PATH_TO_CRAWLER PATH_TO_PRM [FAULTS [SEED [COMMAND...]]]

FAULTS: so many sizes of the disk, and as many of the largest file, for each command (default: 12).
"""
import pathlib
import random
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from disk_faults import PAGE, Disk, Faults, content, fresh, prepare, take_folders_away  # noqa: E402
from program import Checks  # noqa: E402

CRAWLER, PRM = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
FAULTS = int(sys.argv[3]) if len(sys.argv) > 3 else 12
SEED = int(sys.argv[4]) if len(sys.argv) > 4 else 1
checks, chance = Checks(), random.Random(SEED)
faults = Faults(checks)


def chosen(sizes):
    """FAULTS of the sizes, always the smallest and the largest."""
    sizes = sorted(set(sizes))
    if len(sizes) <= FAULTS:
        return sizes
    return sorted({sizes[0], sizes[-1], *chance.sample(sizes[1:-1], max(0, FAULTS - 2))})


def small_files(case, place, inputs, whole):
    """No file may be larger than ..."""
    out = place / case.place
    sizes = [size for text in whole.values() for size in (len(text) - 1, len(text) // 2) if size >= 0]
    for size in chosen([0, *sizes]):
        what = f"{case.name}, files of {size} bytes at most"
        before = fresh(case, out, inputs)
        if not faults.judge(case.start(out, inputs, largest=size), out, before, what):
            faults.resumed(case, out, inputs, whole, what)


def small_disks(case, disk, inputs, whole):
    """The disk has so many pages."""
    if not disk.room():
        checks.skip("small disks: a tmpfs may not be mounted here")
        return
    try:
        out, older = disk.place / case.place, disk.place / "older"
        pages = sum(1 + len(text) // PAGE for text in whole.values())
        for size in chosen(range(1, pages + 8)):
            what = f"{case.name}, a disk of {size} pages"
            disk.room()
            before = fresh(case, out, inputs)
            older.write_bytes(b"older")
            before[older] = b"older"
            if not disk.mount(f"size={(disk.used() + size) * PAGE}"):
                continue
            if not faults.judge(case.start(out, inputs), out, before, what):
                disk.room()
                faults.resumed(case, out, inputs, whole, what)
    finally:
        disk.unmount()


def main(place):
    print(f"seed {SEED}", flush=True)
    inputs, disk = place / "inputs", Disk(place / "disk")
    cases, only = prepare(CRAWLER, PRM, inputs), sys.argv[5:]
    for case in cases:
        out = place / case.place
        fresh(case, out, inputs)
        if only and case.name not in ["run", *only]:
            continue
        done = case.start(out, inputs)
        checks.expect(done.returncode == 0, f"{case.name} itself: {done.returncode}, {done.stderr[:500]!r}")
        whole = content(out) if out.is_dir() else {"": out.read_bytes()}
        if case.name == "run":
            shutil.copytree(out, inputs / "whole_run", dirs_exist_ok=True)
        before = faults.n
        small_files(case, place, inputs, whole)
        small_disks(case, disk, inputs, whole)
        print(f"{case.name}: {faults.n - before} faults", flush=True)
        checks.expect(faults.n > before, f"{case.name}: no fault")
    take_folders_away(CRAWLER, faults, place, inputs)
    print(f"{faults.n} faults")


if __name__ == "__main__":
    checks.run((main,))
