#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Folders, files and texts that would do harm: each is answered with one sentence and the right exit code, and nothing
outside of the output folder is touched.

    python3 faults.py PATH_TO_CRAWLER [EVERY]

EVERY: of what is tried in many ways, only so much (default: 1, all; contrib/verify.sh tries all).
"""
import json
import pathlib
import random
import re
import resource
import shutil
import sys

import h5py
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect, prm, refused  # noqa: E402
from tables import csv_rows, without_columns  # noqa: E402

CRAWLER = sys.argv[1]
EVERY = int(sys.argv[2]) if len(sys.argv) > 2 else 1
QUICK = prm("Model=kinematic", "Active stress/Generator=prescribed strain",
            "Active stress/Prescribed strain/Given by=wave",
            "Sweep/Axes=Active stress/Prescribed strain/Amplitude : linspace(0.05, 0.3, 16)")


def some(things):
    """Not all of them, if that is asked for."""
    return list(things)[::EVERY]


def crawler(*arguments, **options):
    return call([CRAWLER, *arguments], **options)


def damaged_tables(place, scene):
    """results.h5 that is not what sweep wrote."""
    whole = place / "whole"
    expect(crawler("sweep", scene, "--output", whole).returncode == 0, "the sweep itself")
    reference = (whole / "results.csv").read_text()
    for name, words, harm in [
            ("many_dimensions", "not a column of a table",
             lambda file: replaced(file["results"], "displacement", np.zeros((2,) * 30, "i1"))),
            ("huge", "not a column of a table",
             lambda file: replaced(file["results"], "displacement", shape=(1 << 60,), dtype="f8", chunks=(1024,))),
            ("array_attribute", 'attribute "unit" that is not text',
             lambda file: file["results"]["displacement"].attrs.create("unit", np.zeros(1 << 16, "S64"))),
            ("variable_texts", 'no attribute "name"',
             lambda file: replaced(file["results"], "status", ["a", "b"], dtype=h5py.string_dtype())),
            ("no_group", 'no group "results"',
             lambda file: file.move("results", "swept"))]:
        folder = place / name
        shutil.copytree(whole, folder)
        with h5py.File(folder / "results.h5", "r+") as file:
            attributes = dict(file["results"]["displacement"].attrs)
            harm(file)
            if "results" in file and "displacement" in file["results"] and not file["results"]["displacement"].attrs:
                for key, value in attributes.items():
                    file["results"]["displacement"].attrs[key] = value
        before = (folder / "results.h5").read_bytes()
        refused(crawler("sweep", scene, "--output", folder, "--resume"), words)
        expect((folder / "results.h5").read_bytes() == before, f"{name}: a refused table is another one")
        expect(not (folder / "study.lock").exists(), f"{name}: a refused study leaves its lock")

    text = place / "text"
    shutil.copytree(whole, text)
    (text / "results.h5").write_text("no table\n", encoding="utf-8")
    refused(crawler("sweep", scene, "--output", text, "--resume"), "HDF5 file")

    # Flipped bits: the rows that they are in are computed anew, so the table is that of the first time.
    chance = random.Random(1)
    values = whole / "results.h5"
    with h5py.File(values) as file:
        places = [file["results"][name].id.get_offset() for name in ("displacement", "stress_power", "gait.efficiency")]
    for attempt in some(range(12)):
        folder = place / f"flipped_{attempt}"
        shutil.copytree(whole, folder)
        data = bytearray((folder / "results.h5").read_bytes())
        data[chance.choice(places) + chance.randrange(8 * 16)] ^= 1 << chance.randrange(8)
        (folder / "results.h5").write_bytes(data)
        done = crawler("sweep", scene, "--output", folder, "--resume")
        expect(done.returncode == 0 and "was damaged" in done.stderr and without_columns(reference, "seconds")
               == without_columns((folder / "results.csv").read_text(), "seconds"), f"flipped bit {attempt}: {done.stderr}")


def replaced(group, name, data=None, **options):
    """Another dataset in the place of one."""
    del group[name]
    group.create_dataset(name, data=data, **options)


def links(place, scene):
    """Nothing is written or removed through a link."""
    outside = place / "outside"
    (outside / "snapshots").mkdir(parents=True)
    (outside / "snapshots" / "mine.vtu").write_text("mine")
    (outside / "file").write_text("mine")
    for command, code, names in (("run", 0, ("original.prm", "parameters.prm", "summary.json", "results.csv", "kymograph.vts")),
                                 ("sweep", 0, ("original.prm", "parameters.prm", "summary.json", "results.csv")),
                                 ("run", 6, ["results.h5"]), ("sweep", 6, ["results.h5"])):
        folder = place / f"link_{command}_{code}"
        folder.mkdir()
        for name in names:
            (folder / f"{name}.part").symlink_to(outside / "file")
        done = crawler(command, scene, "--output", folder, "--overwrite")
        expect(done.returncode == code and (outside / "file").read_text() == "mine",
               f"{command} writes through the links of {names}: {done.returncode}, {done.stderr!r}")
    for name in ("study.lock", "summary.json", "results.csv", "results.h5", "log.txt", "statistics.csv"):
        folder = place / f"link_{name}"
        folder.mkdir()
        (folder / name).symlink_to(outside / "file")
        for command in ("run", "sweep"):
            for option in some(("--overwrite", "--resume") if command == "run" else ("--resume", "--overwrite")):
                done = crawler(command, scene, "--output", folder, option)
                expect(done.returncode in (2, 6) and (outside / "file").read_text() == "mine" and
                       (folder / name).is_symlink(), f"{command} {option} follows the link {name}: {done.stderr!r}")
    folder = place / "link_picture"
    expect(crawler("run", scene, "--output", folder).returncode == 0, "the run of a picture")
    for name in ("kymograph.png", "report.html"):
        (folder / name).symlink_to(outside / "file")
    expect(crawler("plot", folder).returncode == 0 and crawler("report", folder).returncode == 0 and
           (outside / "file").read_text() == "mine", "a picture or report is written through a link")
    for name in ("solution", "points", "best"):
        folder = place / f"link_{name}"
        folder.mkdir()
        (folder / name).symlink_to(outside / "snapshots")
        refused(crawler("run", scene, "--output", folder, "--overwrite"), "is a link", code=6)
        expect((outside / "snapshots" / "mine.vtu").exists(), f"files behind the link {name} are gone")


def texts(place):
    """Parameter files that never end, and texts that steer terminals."""
    bomb = place / "bomb"
    bomb.mkdir()
    for level in range(9):
        (bomb / f"{level}.prm").write_text(f"include {level + 1}.prm\n" * 10)
    (bomb / "9.prm").write_text("# nothing\n")
    refused(crawler("check", bomb / "0.prm"), "at most 1000")
    nested = place / "nested.prm"
    nested.write_text("subsection a\n" * 100000 + "end\n" * 100000)
    refused(crawler("check", nested), "more than 100 deep")
    many = place / "many.prm"
    many.write_text("".join(f"set Entry {i} = 1\n" for i in range(100000)))
    refused(crawler("check", many), "Entry 0")
    long = place / "long.prm"
    long.write_text("subsection Active stress\n set Generator = expression\n subsection Expression\n  set Active stress = "
                    + "1+" * 500000 + "x\n end\nend\n")
    refused(crawler("check", long), "characters)")
    steering = place / "steering.prm"
    steering.write_text("subsection Body\n set Length = \x1b[31mred\nend\n")
    done = crawler("check", steering)
    expect(done.returncode == 2 and "\x1b" not in done.stderr and "\\x1b[31m" in done.stderr, f"escapes: {done.stderr!r}")


def endless(place):
    """Files without an end, or with too much in them."""
    for name in some(("/dev/zero", "/dev/urandom")):
        refused(crawler("check", name), "is a device", code=6)
        (place / "endless.prm").write_text(f"include {name}\n")
        refused(crawler("check", place / "endless.prm"), "is a device", code=6)
        refused(crawler("table", name, place / "out.csv"), "is a device", code=6)
        for generator, section in (("table", "Table"), ("prescribed strain", "Prescribed strain")):
            done = crawler("check", "-", "--set", f"Active stress/Generator={generator}", "--set",
                           f"Active stress/{section}/File={name}", "--set", "Active stress/Prescribed strain/Given by=table",
                           input="set Accuracy = 1e-3\n")
            refused(done, "is a device")
    (place / "dash.prm").write_text("include -\n")
    refused(crawler("check", "dash.prm", folder=place, input="set Accuracy = 1\n"), "no such file", code=6)
    with open(place / "big.prm", "wb") as file:
        file.truncate(1 << 40)
    refused(crawler("check", place / "big.prm"), "4 GiB", code=6)
    (place / "part.prm").write_text(("#" * 99 + "\n") * 200000)
    (place / "whole.prm").write_text("include part.prm\n" * 900)
    refused(crawler("check", place / "whole.prm"), "at most 64 MB")


def counts(scene):
    """Whole numbers that nobody has memory for."""
    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))

    entries = json.loads(crawler("parameters", "--format", "schema").stdout)
    names = []

    def walk(node, path):
        for key, value in node.get("properties", {}).items():
            if value.get("type") == "integer" or "integer" in str(value.get("anyOf", "")):
                names.append("/".join([*path, key]))
            walk(value, [*path, key])

    walk(entries, [])
    expect(len(names) > 10, f"only {len(names)} entries are whole numbers")
    for name, value in some((name, value) for name in names for value in ("1e18", "2147483648")):
        done = crawler("check", scene, "--set", f"{name}={value}", preexec_fn=limit)
        expect(done.returncode in (0, 2) and done.stderr.count("\n") <= 1,
               f"{name} = {value}: exit code {done.returncode}, {done.stderr[:300]!r}")
    for axes in ("Body/Length : linspace(1, 2, 1e18)", "Body/Length : linspace(1, 2, 1e5); Body/Elastic modulus : "
                 "linspace(1, 2, 1e5); Body/Anchoring exponent : linspace(1, 2, 1e5)"):
        done = crawler("check", scene, "--set", f"Sweep/Axes={axes}", preexec_fn=limit)
        refused(done, "Sweep/Axes")


def names_and_cells(place, scene):
    """Names that steer terminals or shells, and cells that spreadsheets would compute."""
    for word in ("a\nb", "a\x1b[2Jb", "a\rb", "a\tb"):
        refused(crawler("run", scene, "--output", place / word), "control character")
        expect(not (place / word).exists(), f"a folder {word!r} is there")
        refused(crawler("run", place / f"{word}.prm"), "control character")
    done = crawler("run", place / "a\xc2\x9b31mb.prm".encode("latin-1").decode("utf-8"))
    refused(done, "\\xc2\\x9b31m", code=6)
    for name in some(("$(touch pwned) `touch pwned`; touch pwned; a b' \" &", "$(touch pwned)", "`touch pwned`",
                      "; touch pwned;", "a b' \" &")):
        folder = place / "names" / name
        for words in (["run", scene, "--output", folder], ["plot", folder], ["report", folder]):
            done = crawler(*words, folder=place)
            expect(done.returncode == 0, f"{words[0]} in {name}: {done.returncode}, {done.stderr!r}")
    expect(not list(place.rglob("pwned")), "a name was given to a shell")
    # A sweep over words: texts of the user in cells.
    words = ["-0.1*sin(2*pi*(s+t))", "+0.1*sin(2*pi*(s+t))", "0.1*sin(2*pi*(s+t))"]
    (place / "cells.prm").write_text("subsection Active stress\n set Generator = expression\nend\nsubsection Sweep\n "
                                     f"set Axes = Active stress/Expression/Active stress : {', '.join(words)}\nend\n")
    done = crawler("sweep", place / "cells.prm", "--output", place / "cells")
    cells = [row["Active stress/Expression/Active stress"] for row in csv_rows(place / "cells" / "results.csv")]
    expect(done.returncode == 0 and cells == ["'" + words[0], "'" + words[1], words[2]], f"cells of a table: {cells}")


def no_shell():
    """No source file starts a shell: programs are started with lists of words."""
    root = pathlib.Path(__file__).resolve().parents[2]
    call = re.compile(r"::system\s*\(|\bsystem\s*\(\s*\"|\bpopen\s*\(|\bexecl[pe]?\s*\(|shell\s*=\s*True|os\.(?:system|popen)")
    n_files = 0
    for folder in ("source", "include", "contrib/python/crawler/plot", "contrib/python"):
        for path in (root / folder).rglob("*"):
            if path.suffix in (".cc", ".h", ".py", ".in"):
                n_files += 1
                found = call.search(path.read_text(encoding="utf-8"))
                expect(found is None, f"{path.relative_to(root)} starts a shell: {found and found.group()}")
    expect(n_files > 300, f"only {n_files} source files were looked at")


def main(folder):
    quick = folder / "quick.prm"
    quick.write_text(QUICK)
    damaged_tables(folder, quick)
    links(folder, quick)
    texts(folder)
    endless(folder)
    counts(quick)
    names_and_cells(folder, quick)
    no_shell()


checks.run((main,))
