#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The memory of a Python process does not grow in 2000 runs: a leak of 1 kB in each would be seen.

    python3 python_memory.py FOLDER_OF_THE_PACKAGE [RUNS]
"""
import os
import pathlib
import sys

sys.path[:0] = [str(pathlib.Path(sys.argv[1]).resolve()), str(pathlib.Path(__file__).resolve().parents[1] / "support")]
import crawler  # noqa: E402
from program import Checks  # noqa: E402

FILE = pathlib.Path(__file__).resolve().parents[2] / "prm/paper/fig_s1.prm"


def resident():
    pages = int(pathlib.Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def main():
    n, sizes, checks = int(sys.argv[2]) if len(sys.argv) > 2 else 2000, [], Checks()
    for i in range(n + 1):
        crawler.run(FILE, fields=i % 10 == 0, set={"Body/Elastic modulus": 1 + 1e-4 * i})
        if i % (n // 4) == 0:
            sizes.append(resident())
    print("MiB after each quarter of the runs:", *(f"{size:.1f}" for size in sizes))
    checks.expect(sizes[-1] - sizes[1] < n * 0.75e-3, f"memory after 0, {n // 4}, ... runs: {sizes} MiB")
    checks.end()


if __name__ == "__main__":
    main()
