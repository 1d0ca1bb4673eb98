#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Commands that compute nothing: templates, lists of entries, completion, manual page, help, and their errors.

    python3 command_line.py PATH_TO_CRAWLER PATH_TO_SHELL_FILES MPIEXEC
"""
import json
import os
import pathlib
import pty
import re
import select
import subprocess
import sys

import jsonschema

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import PATIENCE, call, checks, environment, expect, on_ranks, refused  # noqa: E402

PROGRAM, SHELL_FILES, MPIEXEC = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3]
PRM = pathlib.Path(__file__).resolve().parents[2] / "prm"
# MPI_Init ends a program in which Open MPI is told to use what does not exist.
BROKEN_MPI = {"OMPI_MCA_pml": "none_such", "OMPI_MCA_btl": "none_such"}


def crawler(*arguments, launcher=(), **more):
    return call([*launcher, PROGRAM, *arguments], **more)


def printed(*arguments):
    """What a call prints that must succeed."""
    done = crawler(*arguments)
    expect(done.returncode == 0 and done.stderr == "", f"crawler {' '.join(arguments)} succeeds")
    return done.stdout


def templates(folder):
    """Each template is short and has comments, is in order, and runs."""
    for name in ("samples", "tracks"):
        (folder / f"{name}.csv").write_text(printed("init", name))
    names = re.search(r"TEMPLATE TEXT REQUIRED\s+(.*)", printed("init", "--help"))[1].split(", ")
    expect({"robot", "earthworm", "snail", "larva", "table", "samples", "sweep", "optimize", "fit", "tracks"} == set(names),
           "the help names all templates")
    for name in names:
        text = printed("init", name)
        if name in ("samples", "tracks"):
            continue
        expect(10 <= len(text.splitlines()) <= 24 and "# " in text and "Expect" not in text, f"{name} is short")
        (folder / f"{name}.prm").write_text(text)
        done = crawler("check", f"{name}.prm", folder=folder)
        expect(done.returncode == 0 and "is valid" in done.stdout, f"{name} is valid {done.stderr}")
        command = name if name in ("sweep", "optimize", "fit") else "run"
        quick = ["--set", "Output/Number of snapshots=2"] if command == "run" else []
        done = crawler(command, f"{name}.prm", *quick, folder=folder)
        expect(done.returncode == 0 and (folder / f"output-{name}" / "summary.json").exists(),
               f"{name} runs {done.stderr}")
    expect(crawler("init", "snail", "--output", "my.prm", folder=folder).returncode == 0 and
           (folder / "my.prm").read_text() == (folder / "snail.prm").read_text(), "init --output writes the template")
    again = crawler("init", "robot", "--output", "my.prm", folder=folder)
    expect(again.returncode == 2 and '"my.prm" already exists' in again.stderr and
           (folder / "my.prm").read_text() == (folder / "snail.prm").read_text(), "init never overwrites a file")
    refused(crawler("init", "robbot"), 'the nearest is "robot"')
    refused(crawler("init", "robot", "--output", "none/my.prm", folder=folder), "none/my.prm", code=6)


def sections(_):
    """One section alone is a part of the list of all, and a parameter file."""
    whole = printed("parameters").splitlines()
    body = printed("parameters", "Body").splitlines()
    expect(10 < len(body) < len(whole) / 4 and all(line in whole for line in body) and
           [line for line in body if line.startswith("subsection")] == ["subsection Body"],
           "parameters Body prints this section")
    inner = printed("parameters", "Active stress/Pulse")
    expect("subsection Active stress" in inner and "set Repetition period" in inner and "Duty cycle" not in inner,
           "parameters prints a section within another one")
    done = crawler("check", "-", input=inner)
    expect(done.returncode == 0, f"it is a parameter file {done.stderr}")
    one = json.loads(printed("parameters", "Body/Length", "--format", "json"))
    expect([entry["entry"] for entry in one] == ["Body/Length"], "parameters prints one entry")
    refused(crawler("parameters", "Bodi"), 'unknown section "Bodi"', '"Body"')


def assignments(text):
    """[(sections, entry, value)] of a parameter file."""
    path, found = [], []
    for line in text.replace("\\\n", " ").splitlines():
        line = line.split("#")[0].strip()
        if line.startswith("subsection "):
            path.append(line.removeprefix("subsection ").strip())
        elif line == "end":
            path.pop()
        elif line.startswith("set "):
            entry, value = line.removeprefix("set ").split("=", 1)
            found.append((list(path), entry.strip(), value.strip()))
    return found


def place_in(schema, section):
    """The schema of a section within another one."""
    for pattern, inner in schema.get("patternProperties", {}).items():
        if re.search(pattern, section):
            return inner
    return schema["properties"][section]


def converted(value, schema):
    """A value of a parameter file as the schema wants it."""
    if "anyOf" in schema:
        return value if value == "automatic" else converted(value, schema["anyOf"][0])
    if schema.get("type") in ("number", "integer"):
        return json.loads(value) if re.fullmatch(r"-?\d+", value) else float(value)
    if schema.get("type") == "array":
        return [float(number) for number in value.split(",")] if value else []
    return value == "true" if schema.get("type") == "boolean" else value


def schema(_):
    """All files of the repository satisfy the schema, and wrong values do not."""
    rules = json.loads(printed("parameters", "--format", "schema"))
    jsonschema.Draft202012Validator.check_schema(rules)
    validator = jsonschema.Draft202012Validator(rules)

    def as_json(text):
        root = {}
        for path, entry, value in assignments(text):
            place, inner = root, rules
            for section in path:
                place, inner = place.setdefault(section, {}), place_in(inner, section)
            place[entry] = converted(value, inner["properties"][entry])
        return root

    texts = {str(path.relative_to(PRM)): path.read_text() for path in sorted(PRM.rglob("*.prm"))}
    expect(len(texts) > 30, "there are files")
    texts["default.prm"] = printed("parameters")
    for name, text in texts.items():
        errors = [error.message for error in validator.iter_errors(as_json(text))]
        expect(not errors, f"{name} satisfies the schema {errors[:3]}")
    for text, what in (("subsection Body\nset Length = -1\nend", "a range"), ("set Model = none", "a choice"),
                       ("subsection Time\nset Order = 2.5\nend", "a type"), ("set Accuracy = 0", "an open range")):
        expect(not validator.is_valid(as_json(text)), f"the schema knows {what}")
    expect(not validator.is_valid({"Body": {"Lenght": 1}}), "the schema knows the names")
    listed = json.loads(printed("parameters", "--format", "json"))
    for entry in listed:
        inner = rules
        for section in entry["entry"].split("/")[:-1]:
            inner = place_in(inner, section)
        inner = inner["properties"][entry["entry"].split("/")[-1]]
        expect(inner["description"] == entry["documentation"] and inner.get("unit", "") == entry["unit"] and
               converted(entry["default"], inner) == inner["default"] and
               jsonschema.Draft202012Validator(inner).is_valid(inner["default"]), f"{entry['entry']} is in the schema")


def bash(folder, *words):
    """What the Tab key gives behind these words."""
    script = ('source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _crawler; '
              'printf "%s\\n" "${COMPREPLY[@]}"')
    done = call(["bash", "-c", script, "bash", SHELL_FILES / "crawler", "crawler", *words], folder)
    expect(done.stderr == "", f"bash completes {words} {done.stderr}")
    return [line for line in done.stdout.splitlines() if line]


def zsh(folder, *lines):
    """What each of these lines is behind the Tab key, in a zsh in a pseudo terminal; a key of ours prints it."""
    main, inner = pty.openpty()
    shell = subprocess.Popen(["zsh", "-f", "-i"], cwd=folder, stdin=inner, stdout=inner, stderr=inner,
                             start_new_session=True, env=environment(TERM="dumb", ZDOTDIR=str(folder)))
    os.close(inner)

    def read_until(mark):
        text = ""
        while not re.search(mark, text):
            if not select.select([main], [], [], PATIENCE)[0]:
                raise TimeoutError(f"zsh hangs behind {text!r}")
            text += os.read(main, 65536).decode("utf-8", errors="replace")
        return text

    os.write(main, f"unsetopt zle_bracketed_paste; autoload -U compinit bashcompinit; compinit -D -u; "
                   f"bashcompinit; source {SHELL_FILES}/crawler; "
                   "tell() { print -r -- \"<<$BUFFER>>\"; BUFFER= }; zle -N tell; bindkey '^X' tell; echo rea''dy\n".encode())
    read_until("ready")
    found = []
    for line in lines:
        os.write(main, f"{line}\t\x18".encode())
        found.append(re.search("<<(.*?)>>", read_until("<<.*?>>"))[1])
    shell.kill()
    shell.wait()
    os.close(main)
    return found


def completion(folder):
    """The files that are installed: commands, options, files, entries; quoted or not."""
    expect(printed("completion", "bash") == (SHELL_FILES / "crawler").read_text(), "the file for bash is up to date")
    (folder / "scene.prm").touch()
    (folder / "notes.txt").touch()
    (folder / "inner").mkdir()
    expect(bash(folder, "s") == ["sweep"], "bash completes commands")
    expect({"run", "plot", "init", "--version"} <= set(bash(folder, "")), "bash lists commands")
    expect(set(bash(folder, "sweep", "--s")) == {"--set", "--strict"}, "bash completes the options of a command")
    expect(bash(folder, "run", "") == ["inner", "scene.prm"], "bash completes parameter files and folders")
    expect(bash(folder, "report", "") == bash(folder, "paper", "") == ["inner"], "bash completes folders")
    expect(bash(folder, "run", "scene.prm", "--set", "Body/Le") == ["Body/Length="], "bash completes entries")
    expect(bash(folder, "run", "--set", '"Active stress/Pulse/Wid') == ["Active stress/Pulse/Width="],
           "bash completes entries in quotes")
    expect(bash(folder, "run", "--set", "Active\\ stress/Pulse/Wid") == ["Active\\ stress/Pulse/Width="],
           "bash completes entries with blanks")
    expect(bash(folder, "init", "r") == ["robot"] and bash(folder, "parameters", "--format", "s") == ["schema"] and
           bash(folder, "plot", "--kind", "tr") == ["tradeoff"] and bash(folder, "parameters", "Bo") == ["Body"],
           "bash completes words")
    found = zsh(folder, "crawler opt", "crawler run scene.prm --set Body/Le", "crawler check sc")
    expect([line.strip() for line in found] == ["crawler optimize", "crawler run scene.prm --set Body/Length=",
                                                "crawler check scene.prm"], f"zsh completes commands, entries and files: {found}")
    refused(crawler("completion", "fish"), '"bash" is expected')


def manual(_):
    """The manual page is well formed and has all commands, options and exit codes."""
    page = printed("man")
    expect(page == (SHELL_FILES / "crawler.1").read_text(), "the page that is installed is up to date")
    done = call(["groff", "-man", "-Tascii", "-ww", "-P-cbou"], input=page)
    expect(done.returncode == 0 and done.stderr == "", f"groff sets the page {done.stderr}")
    words = " ".join(done.stdout.split())
    for word in ("crawler run FILE", "--set ENTRY=VALUE", "crawler parameters [SECTION]", "EXIT STATUS",
                 "self-check failed", "crawler init earthworm > worm.prm", "--check-gradient"):
        expect(word in words, f"the page has {word}")


def helps(_):
    """Help has examples and the exit codes of the user guide."""
    for arguments, words in (("--version", "crawler 0, deal.II, PETSc"), ("--help", "run, check, parameters, --version, PETSc"),
                             ("run --help", "FILE, --set, --output, --overwrite, --quiet"), ("check --help", "FILE, --set"),
                             ("parameters --help", "--format, prm, json, markdown")):
        text = printed(*arguments.split())
        expect(all(word in text for word in words.split(", ")), f"{arguments} has {words}: {text}")
    text = printed("--help")
    guide = (PRM.parent / "doc/user_guide.md").read_text()
    rows = re.findall(r"^\| (\d) \| (.*?) \|", guide.split("\n## Exit codes\n")[1].split("\n## ")[0], re.M)
    expect(len(rows) == 8 and all(f"  {code}  {meaning}\n" in text for code, meaning in rows), "help has all exit codes")
    expect("crawler init earthworm > worm.prm" in text, "help has examples")
    expect("crawler sweep sweep.prm --resume" in printed("sweep", "--help"), "the help of a command has its examples")


def without_mpi(_):
    """What computes nothing does not start MPI."""
    for arguments in (["--version"], ["--help"], ["run", "--help"], ["parameters"], ["init", "robot"], ["man"],
                      ["completion", "bash"], ["plot", "--help"]):
        done = crawler(*arguments, variables=BROKEN_MPI)
        expect(done.returncode == 0 and done.stdout and not done.stderr, f"{arguments} starts no MPI {done.stderr}")
    for arguments in ([], ["runn"], ["run"], ["run", "a.prm", "--sett", "x"], ["init", "x"], ["parameters", "x"]):
        refused(crawler(*arguments, variables=BROKEN_MPI), "crawler: ")
    expect(crawler("check", "none.prm", variables=BROKEN_MPI).returncode not in (0, 2), "MPI can be broken")


def several_processes(_):
    two = on_ranks(MPIEXEC, 2)
    expect(crawler("--version", launcher=two).stdout.count("deal.II") == 1, "two processes print the version once")
    wrong = crawler("runn", launcher=two)
    expect(wrong.returncode == 2 and wrong.stderr.count("unknown command") == 1, "two processes complain once")


def full_disk(folder):
    """Text that is lost is an error, but not if its reader has left."""
    prm = str(PRM / "examples/small_wave.prm")
    for arguments in (["parameters"], ["check", prm], ["--help"], ["--version"], ["man"], ["init", "robot"],
                      ["run", prm, "--output", str(folder / "full")]):
        with open("/dev/full", "w", encoding="utf-8") as full:
            done = crawler(*arguments, stdout=full)
        refused(done, "No space left", code=6)
    expect(json.loads((folder / "full/summary.json").read_text())["status"] == "finished", "the results are there")
    for arguments in (["parameters"], ["run", prm, "--output", str(folder / "left")]):
        reader, writer = os.pipe()
        os.close(reader)
        done = crawler(*arguments, stdout=writer)
        os.close(writer)
        expect(done.returncode == 0 and done.stderr == "", f"the reader of {arguments[0]} may leave {done.stderr}")
    expect(json.loads((folder / "left/summary.json").read_text())["status"] == "finished", "the run goes on without its reader")


def without_scratch(folder):
    """Programs that start and end at the same time share no scratch folder: none is needed."""
    (folder / "file").write_text("")
    done = crawler("check", str(PRM / "examples/small_wave.prm"), variables={"TMPDIR": str(folder / "file")})
    expect(done.returncode == 0 and done.stderr == "", f"no scratch folder is needed: {done.stderr[:200]}")


checks.run((templates, sections, schema, completion, manual, helps, without_mpi, several_processes, full_disk, without_scratch))
