# SPDX-License-Identifier: LGPL-2.1-or-later
"""Code for instruction sets that the processor may not have stays among itself.

    lane_symbols.py NM NAMESPACE=OBJECT...

What an object file defines for others is in crawler::NAMESPACE: a function that is inline somewhere else as well could be
given to the whole program by the linker, which keeps one of many. And nothing of it runs before the program asks what the
processor can do. Of two objects one must fail for the other's name, or this test sees nothing.
"""
import re
import subprocess
import sys


def strangers(nm, namespace, path):
    """Symbols that a linker may use for other files, and constructors that run at the start."""
    own = re.compile(rf"_Z(GVN|T[VTIS]N|Z?N)K?7crawler{len(namespace)}{namespace}")
    found = []
    for line in subprocess.run([nm, "--defined-only", "--format=posix", path], capture_output=True, text=True, check=True).stdout.splitlines():
        name, kind = line.split()[:2]
        is_shared = kind.isupper() or kind in "uvwi"
        if (is_shared and not own.match(name)) or "_GLOBAL__sub_I" in name:
            found.append(f"{kind} {name}")
    return found


def main():
    nm, *arguments = sys.argv[1:]
    objects = dict(argument.split("=", 1) for argument in arguments)
    bad = False
    for namespace, path in objects.items():
        for symbol in strangers(nm, namespace, path):
            print(f"{path} defines {symbol[:200]}")
            bad = True
        for other in objects:
            if other != namespace and not strangers(nm, other, path):
                print(f"{path}: nothing is found to be outside of crawler::{other}")
                bad = True
    print(f"{len(objects)} objects looked at")
    return 1 if bad or len(objects) < 2 else 0


sys.exit(main())
