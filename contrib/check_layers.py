#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tests the structure of the program (doc/developer_guide.md, "Rooms"): a file includes only its own room or earlier
ones, header and source files mirror each other, and no files include each other in a circle (a header and its source
file count as one). Unit tests of a room include no later room. Exit status 1, and one line for each fault."""
import os
import re
import sys

# From the lowest room to the highest.
ROOMS = ["base", "parameters", "formula", "scene", "mesh", "deal_ii", "time", "equation", "lanes", "reduced_models", "output", "run",
         "adjoint", "accuracy", "studies/core", "studies/run", "studies/sweep", "studies/tradeoff", "studies/optimize", "app"]
# What else may not enter: a pattern of includes, and the rooms.
FORBIDDEN = [(r"<deal\.II", [room for room in ROOMS if room != "deal_ii"]),
             (r"<petsc", ["formula", "scene", "mesh", "equation", "lanes", "reduced_models", "run", "adjoint", "accuracy"]),
             (r"<crawler/scene/", ["time"])]
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")


def files_below(folder):
    for directory, folders, names in os.walk(os.path.join(ROOT, folder)):
        folders.sort()
        for name in sorted(names):
            if re.search(r"\.(h|cc|h\.in)$", name):
                yield os.path.relpath(os.path.join(directory, name), ROOT)


def unit_of(path):
    """Header and source file of the same name are one unit: "mesh/discretization"."""
    return re.sub(r"^(include/crawler|source)/|\.(h|cc|h\.in)$", "", path)


def room_of(path):
    return next((room for room in sorted(ROOMS, key=len, reverse=True) if path.startswith(room + "/")), None)


def includes_of(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            if re.match(r"\s*#\s*include", line):
                yield number, line.strip()


def circles(arrows):
    """The strongly connected components of more than one unit (Tarjan)."""
    number, low, stack, found = {}, {}, [], []

    def visit(unit):
        number[unit] = low[unit] = len(number)
        stack.append(unit)
        for other in sorted(arrows[unit]):
            if other not in number:
                visit(other)
                low[unit] = min(low[unit], low[other])
            elif other in stack:
                low[unit] = min(low[unit], number[other])
        if low[unit] == number[unit]:
            circle = stack[stack.index(unit):]
            del stack[stack.index(unit):]
            if len(circle) > 1:
                found.append(circle)

    sys.setrecursionlimit(10000)
    for unit in sorted(arrows):
        if unit not in number:
            visit(unit)
    return found


def main():
    faults, arrows = [], {}
    for path in [*files_below("include/crawler"), *files_below("source")]:
        unit = unit_of(path)
        arrows.setdefault(unit, set())
        if unit == "main":
            continue
        room = room_of(unit)
        if room is None:
            faults.append(f"{path}: its folder is none of the rooms")
            continue
        for number, line in includes_of(path):
            for pattern, rooms in FORBIDDEN:
                if re.search(pattern, line) and room in rooms:
                    faults.append(f"{path}:{number}: {line}: may not enter {room}")
            if match := re.search(r"<crawler/([^>]+)>", line):
                other = unit_of(match[1])
                if other != unit:
                    arrows[unit].add(other)
                if room_of(other) is None or ROOMS.index(room_of(other)) > ROOMS.index(room):
                    faults.append(f"{path}:{number}: {line}: a later room than {room}")
    for unit in {other for others in arrows.values() for other in others} - set(arrows):
        faults.append(f"{unit}: included, but not there")
        arrows[unit] = set()
    faults += [f"include each other in a circle: {', '.join(circle)}" for circle in circles(arrows)]
    for path in files_below("tests/unit"):
        room = room_of(os.path.relpath(path, "tests/unit"))
        for number, line in includes_of(path):
            if match := re.search(r"<crawler/([^>]+)>", line):
                other = room_of(unit_of(match[1]))
                if room is None or other is None or ROOMS.index(other) > ROOMS.index(room):
                    faults.append(f"{path}:{number}: {line}: a later room than {room}")
    print("\n".join(faults) or "rooms: no include points to a later room, no circles")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
