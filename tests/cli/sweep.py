#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler sweep: designs, its table in h5py and pandas, resume after kills and after changes, limits and bad input.

    python3 sweep.py PATH_TO_CRAWLER MPIRUN [alone|several]

Kills at random places, and what needs many ranks, points or little memory: tests/long/study_kills.py.
"""
import math
import pathlib
import re
import shutil
import signal
import subprocess
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import Paused, call, checks, contents, environment, expect, on_ranks, prm, ranks_that_stop, refused  # noqa: E402
from tables import csv_rows, h5_columns, json_of, number, number_at, same_as_csv, same_columns  # noqa: E402

CHI, P = "Active stress/Optimal wave/Perturbation parameter", "Body/Anchoring exponent"
BASE = prm("Accuracy=1e-4", "Active stress/Optimal wave/Choose wave by=wave speed")
PROGRAM, MPIRUN = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]


def write(folder, axes, more=""):
    """A parameter file with these axes."""
    text = BASE + f"subsection Sweep\n  set Axes = {axes}\n  {more}\nend\n"
    pathlib.Path(folder, "sweep.prm").write_text(text, encoding="utf-8")


def sweep(folder, output, *more, stop_at=None, command=(), file="sweep.prm"):
    """Sweeps in the folder; the command is what stands before it."""
    return call([*command, PROGRAM, "sweep", file, "--output", output, *more], folder, stop_at)


def table(folder):
    """All columns of results.h5."""
    return h5_columns(folder / "results.h5", "results")


def computed(columns):
    """Which points have a row."""
    return np.array([status != "" for status in columns["status"]])


def test_grid(folder):
    """Values, order, error bounds, CSV, pandas, ranks."""
    write(folder, f"{P} : 0, 2, 3; {CHI} : 0.1, 0.4")
    result = sweep(folder, "grid")
    rows = table(folder / "grid")
    expect(result.returncode == 0 and set(rows["status"]) == {"finished"}, f"every point has a row {result.stderr}")
    expect(list(rows[P]) == [0, 0, 2, 2, 3, 3] and list(rows[CHI]) == [0.1, 0.4] * 3, "the last axis varies fastest")
    expect(abs(rows["displacement"][3] - 9.0072529800e-2) <= rows["displacement_error.total"][3] <= 1e-4 * 0.0901,
           "Fig. S1 is within its error bar, and the bar within Accuracy")
    lines = csv_rows(folder / "grid" / "results.csv")
    expect(same_as_csv(rows, lines), "results.csv has the same")
    expect(list(lines[0])[:3] == ["index", P, CHI], "columns start with index and axes")
    try:
        import pandas
        frame = pandas.read_csv(folder / "grid" / "results.csv", float_precision="round_trip")
        from_h5 = pandas.DataFrame(rows)
        expect(np.array_equal(frame["displacement"], from_h5["displacement"]) and len(frame.columns) == len(from_h5.columns),
               "pandas reads both files")
    except ImportError:
        expect(False, "pandas is there (Debian: python3-pandas)")
    single = call([PROGRAM, "run", "sweep.prm", "--set", f"{P}=3", "--set", f"{CHI}=0.4", "--output", "single", "--set",
                   "Output/Number of snapshots=0"], folder)
    summary = json_of(folder / "single" / "summary.json")
    expect(single.returncode == 0 and abs(summary["displacement"] - rows["displacement"][5])
           <= summary["displacement_error"]["total"] + rows["displacement_error.total"][5],
           "a point agrees with crawler run within the error bounds")

    compared = [(name, name.removeprefix("errors.") + (".value" if name.endswith("_stretch") else ""))
                for name in rows if name.startswith("errors.")]
    apart = [key for name, key in compared if not abs(rows[key][5] - number_at(summary, key)) <= rows[name][5] + number_at(summary, name)]
    expect(len(compared) > 5 and not apart, f"so do its works, extreme stretches and gait numbers {apart}")
    for name, n, more in (("two", 2, ()), ("without shared memory", 3, ("--mca", "btl", "tcp,self", "--mca", "osc", "pt2pt"))):
        other = sweep(folder, name, command=[*on_ranks(MPIRUN, n), *more])
        expect(other.returncode == 0 and same_columns(rows, table(folder / name)),
               f"{n} ranks {name}: the same table, bit for bit {other.stderr}")


def test_designs(folder):
    """zip, column of a file, files as an axis (points drawn by chance: unit/sweep_design)."""
    (folder / "values.csv").write_text("name,p,chi\na,2,0.1\nb,3,0.2\n", encoding="utf-8")
    write(folder, f"{P} : column(values.csv, p); {CHI} : column(values.csv, chi)", "set Design = zip")
    sweep(folder, "zip")
    rows = table(folder / "zip")
    expect(list(rows[P]) == [2, 3] and list(rows[CHI]) == [0.1, 0.2], "zip takes the rows of a CSV file")
    many = sweep(folder, "many", command=on_ranks(MPIRUN, 4))
    expect(many.returncode == 0 and same_columns(rows, table(folder / "many")), "more ranks than points give the same table")
    values = ["max(1, s + 0.5)", "2", "1 + 0.1*min(2, s)"]
    write(folder, f'Body/Friction profile : {values[0]}, {values[1]}, "{values[2]}"; {CHI} : 0.1')
    result = sweep(folder, "formulas")
    rows = table(folder / "formulas")
    expect(result.returncode == 0 and rows["Body/Friction profile"] == values and
           set(rows["status"]) == {"finished"}, f"formulas with commas are values {result.stderr}")
    (folder / "soft.prm").write_text("subsection Body\n  set Elastic modulus = 1\nend\n", encoding="utf-8")
    (folder / "stiff.prm").write_text("subsection Body\n  set Elastic modulus = 10\nend\n", encoding="utf-8")
    write(folder, f"File : soft.prm, stiff.prm; {CHI} : 0.3")
    result = sweep(folder, "files")
    rows = table(folder / "files")
    expect(result.returncode == 0 and abs(rows["displacement"][0] - 4.764510e-2) < 1e-5 and
           abs(rows["displacement"][1] - 4.8552305987e-2) < 1e-5, "parameter files are an axis")
    told = re.search(r"results.h5 will have about (\S+) kB", call([PROGRAM, "check", "sweep.prm"], folder).stdout)
    size = (folder / "files/results.h5").stat().st_size
    expect(told and abs(1e3 * float(told[1]) / size - 1) < 0.3, f"check tells the size of the table, {size} bytes {told}")
    result = sweep(folder, "set", "--set", "Body/Elastic modulus=10")
    expect(result.returncode == 0 and list(table(folder / "set")["displacement"]) == [rows["displacement"][1]] * 2,
           f"--set is stronger than the files of an axis {result.stderr}")
    result = call([PROGRAM, "check", "soft.prm", "--set", f" Sweep / Axes = {CHI} : 0.1, 0.2, 0.3"], folder)
    expect(result.returncode == 0 and "3 points" in result.stdout,
           f"blanks in the name of an entry do not matter {result.stderr}")
    result = call([PROGRAM, "check", "sweep.prm", "--set", "Sweep/Axes="], folder)
    expect(result.returncode == 0 and "points" not in result.stdout,
           f"without axes there is no sweep to check {result.stderr}")


def test_places_of_files(folder):
    """Names of files on the axes count from the folder of the parameter file, wherever the program is started."""
    study = folder / "a_study"
    (study / "parts").mkdir(parents=True)
    (study / "values.csv").write_text("p\n2\n3\n", encoding="utf-8")
    (study / "parts" / "scaly.csv").write_text("s,value\n0,1\n0.3,1.2\n0.6,1\n1,1\n", encoding="utf-8")
    (study / "parts" / "soft.prm").write_text("subsection Body\n set Elastic modulus = 2\n"
                                              " set Initial stretch = start.csv\nend\n", encoding="utf-8")
    (study / "parts" / "start.csv").write_text("s,value\n0,1\n0.3,1.01\n0.6,1\n1,1\n", encoding="utf-8")
    axes = f"{P} : column(values.csv, p); Body/Friction profile : 1, parts/scaly.csv; File : parts/soft.prm"
    write(study, axes, "set Keep fields = 3")
    for place, name in ((study, "sweep.prm"), (folder, "a_study/sweep.prm"), (study / "parts", "../sweep.prm")):
        result = sweep(place, "from_here", "--set", "Output/Number of snapshots=1", file=name)
        rows = table(place / "from_here")
        expect(result.returncode == 0 and same_columns(rows, table(study / "from_here"))
               and set(rows["status"]) == {"finished"} and (place / "from_here" / "points" / "3" / "summary.json").exists(),
               f"started in {place.name}: {result.returncode} {result.stderr}")
    refused(sweep(folder, "from_here", "--resume", file="a_study/sweep.prm"), "Number of snapshots")
    shutil.copy(study / "values.csv", folder / "other.csv")
    result = sweep(folder, "with_set", "--set", f"Sweep/Axes={P} : column(other.csv, p)", "--set", "Sweep/Keep fields=",
                   file="a_study/sweep.prm")
    expect(result.returncode == 0, f"with --set they count from the current folder: {result.stderr}")


def test_rows_that_fail(folder):
    """Inverted, refused and slow points are rows; --strict says so; fields are kept."""
    write(folder, f"{P} : 0; Active stress/Optimal wave/Wave speed : -1, 1; {CHI} : 0.6, 0.1", "set Keep fields = 1")
    strict = sweep(folder, "some", "--strict")
    expect(strict.returncode == 8, f"--strict: exit code 8 ({strict.returncode})")
    rows = table(folder / "some")
    expect(rows["status"][:2] == ["inverted", "finished"] and rows["reason"][0] != "", "a body that inverts is a row")
    expect(math.isfinite(rows["inversion.t"][0]) and math.isnan(rows["inversion.t"][1]), "with the time of the inversion")
    expect((folder / "some" / "points" / "1" / "solution.pvd").is_file(), "the fields of a point are kept")
    expect(sweep(folder, "some", "--resume").returncode == 0, "without --strict such a sweep ends with exit code 0")
    write(folder, "Active stress/Optimal wave/Energy : 0.001, 1", "set Keep fields = 0, 1")
    result = sweep(folder, "refused", "--set", "Active stress/Optimal wave/Choose wave by=energy")
    rows = table(folder / "refused")
    kept = [path.name for path in (folder / "refused" / "points").iterdir()]
    expect(result.returncode == 0 and rows["reason"][0] == "refused" and "0.5" in rows["message"][0] and kept == ["1"],
           f"values that do not fit together are a row without fields ({rows['reason'][0]}, {kept})")


def test_time_limits(folder):
    """0.001 s ends a point, or the sweep, at once and in order; 1e6 s never does."""
    write(folder, f"{P} : 2; {CHI} : 0.1, 0.4")
    slow = ("--set", "Accuracy=1e-7", "--set", "Discretization/Formulation=stretch", "--set", "Time/End time=4", "--resume")
    first = sweep(folder, "slow", *slow, "--set", "Sweep/Time limit per point=1e6", stop_at="row:1:TERM")
    one = table(folder / "slow")
    expect(first.returncode == 5 and sorted(one["status"]) == ["", "finished"],
           f"stopped behind one of two points {one['status']}")
    done = one["status"].index("finished")
    result = sweep(folder, "slow", *slow, "--set", "Sweep/Time limit per point=0.001")
    rows = table(folder / "slow")
    expect(result.returncode == 0 and rows["status"][1 - done] == "stopped" and rows["reason"][1 - done] == "time_limit"
           and rows["status"][done] == "finished", f"a point that takes too long is a row ({rows['status']}, {rows['reason']})")
    again = sweep(folder, "slow", *slow, "--set", "Sweep/Time limit per point=1e6", "--set", f"Sweep/Keep fields={1 - done}")
    now = table(folder / "slow")
    expect(again.returncode == 0 and now["status"] == ["finished"] * 2 and now["seconds"][done] == one["seconds"][done],
           f"with a larger limit --resume computes it, and nothing else ({again.stderr})")
    place = folder / "slow" / "points" / f"{1 - done}"
    expect((place / "summary.json").is_file(), "and now its fields are kept")
    (place / "mine.txt").write_text("mine", encoding="utf-8")
    all_of_it = sweep(folder, "slow", "--overwrite", "--set", "Sweep/Time limit=0.001", "--set", "Accuracy=1e-7")
    expect(all_of_it.returncode == 5 and not computed(table(folder / "slow")).any()
           and json_of(folder / "slow" / "summary.json")["reason"] == "time_limit" and "--resume" in all_of_it.stderr,
           f"the limit of the sweep ends it with exit code 5 ({all_of_it.returncode}) {all_of_it.stderr}")
    for name in ("TERM", "INT"):
        within = sweep(folder, "slow", "--overwrite", "--set", "Accuracy=1e-7", stop_at=f"step:20:{name}")
        expect(within.returncode == 5 and table(folder / "slow")["status"] == ["", ""], f"SIG{name} within a point: {within}")
    left = sorted(path.name for path in (folder / "slow" / "points").rglob("*"))
    expect(left == [place.name, "mine.txt"], f"--overwrite removes the fields, and nothing of others ({left})")
    rest = sweep(folder, "slow", "--resume", "--set", "Sweep/Time limit=1e6", "--set", "Accuracy=1e-7")
    expect(rest.returncode == 0 and table(folder / "slow")["status"] == ["finished"] * 2,
           f"--resume computes the rest {rest.stderr}")


def cannot_resume(folder, output, words, what):
    """--resume is refused with one sentence that has these words, and the table stays as it is."""
    before = (folder / output / "results.h5").read_bytes()
    refused(sweep(folder, output, "--resume"), *words)
    expect((folder / output / "results.h5").read_bytes() == before, f"{what}: another table")


def test_changed_inputs(folder):
    """What changes the answers is noticed by --resume: values of axes (scene and data files: sweep_inputs_test.cc)."""
    (folder / "values.csv").write_text("p,chi\n2,0.1\n3,0.2\n", encoding="utf-8")
    write(folder, f"{P} : column(values.csv, p); {CHI} : column(values.csv, chi)", "set Design = zip")
    sweep(folder, "axes")
    (folder / "values.csv").write_text("remark,p,chi\n\"a, b\",2.0,0.1\nc,3,0.20\n", encoding="utf-8")
    result = sweep(folder, "axes", "--resume")
    expect(result.returncode == 0, f"a CSV file with the same values goes on ({result.returncode}) {result.stderr}")
    (folder / "values.csv").write_text("p,chi\n2,0.1\n3.5,0.2\n", encoding="utf-8")
    cannot_resume(folder, "axes", (f'{P} of point 1 was "3" and is "3.5"',), "a changed value of a CSV file")
    (folder / "values.csv").write_text("p,chi\n2,0.1\n3,0.2\n4,0.2\n", encoding="utf-8")
    cannot_resume(folder, "axes", ("number of points was 2 and is 3",), "another number of values")


def test_killed_at_files(folder):
    """What a kill leaves behind before there is a table, and at the end; folders of others."""
    write(folder, f"{P} : 2, 3; {CHI} : 0.1, 0.2")
    sweep(folder, "whole")
    reference = table(folder / "whole")
    expect(not (folder / "whole" / "study.lock").exists(), "no lock stays behind")
    for place, left in (("original.prm", {"original.prm.part"}), ("results.h5", {"parameters.prm", "results.h5.part"}),
                        ("results.csv", {"results.h5", "results.csv.part"}),
                        ("summary.json", {"results.csv", "summary.json.part"})):
        output = folder / f"killed-{place}"
        killed = sweep(folder, output, stop_at=f"write:{place}:KILL")
        names = {path.name for path in output.iterdir()}
        expect(killed.returncode == -signal.SIGKILL and names >= left | {"study.lock"} and place not in names,
               f"killed before {place} has its name: {killed.returncode}, {names}")
        if place in ("original.prm", "results.csv"):
            refused(sweep(folder, output), "--resume continues")
        if place == "results.csv":
            part = output / "results.csv.part"
            part.unlink()
            (part / "is a folder").mkdir(parents=True)
            blocked = sweep(folder, output, "--resume")
            expect(blocked.returncode == 6 and "results.h5 is intact" in blocked.stderr, f"no place for a file: {blocked}")
            shutil.rmtree(part)
        result = sweep(folder, output, "--resume")
        expect(result.returncode == 0 and same_columns(reference, table(output)) and (output / "results.csv").is_file()
               and json_of(output / "summary.json")["status"] == "finished" and not list(output.glob("*.part"))
               and not (output / "study.lock").exists(), f"and --resume makes it: {result.stderr}")
    (folder / "locked_only").mkdir()
    (folder / "locked_only" / "study.lock").touch()
    result = sweep(folder, "locked_only", "--resume")
    expect(result.returncode == 0 and same_columns(reference, table(folder / "locked_only")),
           f"a sweep that had only its lock begins anew with --resume {result.stderr}")
    call([PROGRAM, "run", "sweep.prm", "--output", "not_a_sweep"], folder)
    (folder / "of_others").mkdir()
    (folder / "of_others" / "original.prm").write_text("mine", encoding="utf-8")
    for name in ("not_a_sweep", "of_others"):
        before = contents(folder / name)
        result = sweep(folder, name, "--resume")
        after = contents(folder / name)
        expect(result.returncode == 2 and before and before == after, f"--resume leaves {name} alone: {result.stderr}")


def test_two_at_once(folder):
    """The folder of a sweep that is under way belongs to it; one that is about to end is waited for."""
    write(folder, f"{P} : 2, 3; {CHI} : 0.1, 0.2")
    command = [PROGRAM, "sweep", "sweep.prm", "--output", "shared", "--resume"]

    def waits():
        """A second sweep, from the moment at which it says that it waits (or has said all it says)."""
        process = subprocess.Popen([str(word) for word in command], cwd=folder, env=environment(), stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        expect(any("waiting for" in line for line in process.stdout), "it says that it waits")
        return process

    with Paused(command, "write:summary.json:STOP", folder) as first:
        refused(call([PROGRAM, "run", "sweep.prm", "--output", "shared", "--overwrite"], folder), "a run or study is writing to")
        with waits() as second:  # noted once; then it ends at once
            while second.poll() is None:
                second.terminate()
        expect(second.returncode == -signal.SIGTERM, f"a second signal ends what waits: {second.returncode}")
        with waits() as second:
            ended = first.go_on()
            _, errors = second.communicate()
        expect(ended.returncode == 0 and second.returncode == 0,
               f"one that is about to end is waited for: {ended.stderr} {errors}")
    expect(computed(table(folder / "shared")).all() and not (folder / "shared" / "study.lock").exists(), "and both are done")


def test_rank_that_cannot_write(folder):
    """It ends all, and the rest is computed when it can."""
    write(folder, f"{P} : linspace(1.5, 4, 12); {CHI} : linspace(0.05, 0.5, 16)")
    one = (PROGRAM, "sweep", "sweep.prm", "--output", "rank", "--resume")
    # No file of rank 1 may grow beyond 50 blocks of 512 bytes; without the signal that would be an error of write.
    limited = ("sh", "-c", "trap '' XFSZ; ulimit -f 50; exec \"$0\" \"$@\"", *one)
    result = call([MPIRUN, "--oversubscribe", "-n", 1, *one, ":", "-n", 1, *limited], folder)
    expect(result.returncode == 6 and "--resume" in result.stderr, f"a rank that cannot write ends all ({result.returncode}): "
           f"{next((line for line in result.stderr.splitlines() if line.startswith('crawler')), result.stderr)}")
    again = call(one, folder)
    sweep(folder, "rank_whole")
    expect(again.returncode == 0 and same_columns(table(folder / "rank_whole"), table(folder / "rank")),
           "and --resume computes the rest")


def test_crashes(folder):
    """A fault of the program: the points at work are tried once more, alone, and then given up by name."""
    write(folder, f"{P} : linspace(1.5, 4, 12)")
    expect(sweep(folder, "whole").returncode == 0, "a sweep that does not crash")
    note = folder / "crash" / "crashes.txt"
    first = sweep(folder, "crash", stop_at="row:4:SEGV")
    once = [int(point) for point in note.read_text().split()]
    done = computed(table(folder / "crash"))
    expect(first.returncode == -signal.SIGSEGV and once and np.count_nonzero(done) >= 4,
           f"the first crash: {first.returncode}, points {once}, {np.count_nonzero(done)} rows")
    left = [point for point in once if not done[point]]
    second = sweep(folder, "crash", "--resume", stop_at="step:5:SEGV")
    lines = [[int(point) for point in line.split()] for line in note.read_text().splitlines()]
    expect(second.returncode == -signal.SIGSEGV and len(lines) == 2, f"the second crash: {lines}")
    third = sweep(folder, "crash", "--resume")
    rows, reference = table(folder / "crash"), table(folder / "whole")
    twice = {point for point in lines[1] if point in left}
    given_up = {i for i, reason in enumerate(rows["reason"]) if reason == "crashed"}
    expect(third.returncode == 0 and given_up == twice and computed(rows).all(), f"{given_up}, expected {twice}")
    expect(all(rows["status"][i] == "failed" and np.isnan(rows["displacement"][i]) for i in given_up)
           and all(abs(rows["displacement"][i] - reference["displacement"][i]) <= rows["displacement_error.total"][i]
                   + reference["displacement_error.total"][i] for i in range(12) if i not in given_up),
           "points that crashed once are computed, alone")
    alone = sweep(folder, "crash", "--resume", stop_at="step:5:SEGV")
    expect(alone.returncode == 0, "nothing is left to crash at")
    anew = sweep(folder, "crash", "--overwrite")
    expect(anew.returncode == 0 and not note.exists(), "a new sweep knows nothing of it")


def test_kills(folder):
    """kill -9 of the only process and of one rank of two, SIGTERM and Ctrl-C: nothing is lost, nothing computed twice."""
    write(folder, f"{P} : linspace(1.5, 4, 12); {CHI} : linspace(0.05, 0.5, 12)")
    whole = sweep(folder, "whole", "--overwrite")
    reference = table(folder / "whole")
    expect(whole.returncode == 0 and computed(reference).all(), "an unbroken sweep")
    expect(np.all(reference["displacement_error.total"] <= 1e-4 * np.abs(reference["displacement"])),
           "all bars are within Accuracy")
    begun = sweep(folder, "begun", stop_at="row:8:KILL")
    before = table(folder / "begun")
    done = np.flatnonzero(computed(before))
    expect(begun.returncode == -signal.SIGKILL and 8 <= len(done) < 144 and (folder / "begun" / "study.lock").exists(),
           f"the only process is killed behind {len(done)} rows: {begun.returncode}")
    command = [PROGRAM, "sweep", "sweep.prm", "--output", "killed", "--resume"]
    killed_rank = 128 + signal.SIGKILL  # the exit code of mpirun; rank 0 waits from its first row on, until mpirun ends it
    for what, words, place, code in (
            ("rank 1 of two is killed", ranks_that_stop(MPIRUN, command, "row:1:STOP", "row:5:KILL"), None, killed_rank),
            ("SIGTERM", command, "row:8:TERM", 5),
            ("rank 1 of two gets Ctrl-C", [*on_ranks(MPIRUN, 2), *command], "step:1:INT:1", 5)):
        shutil.rmtree(folder / "killed", ignore_errors=True)
        shutil.copytree(folder / "begun", folder / "killed")
        result = call(words, folder, place)
        now = table(folder / "killed")
        n = np.count_nonzero(computed(now))
        expect(result.returncode == code and n >= len(done) + (8 if "row:8" in str(place) else 0)
               and (n < 144 or "rank" in what) and (folder / "killed" / "study.lock").exists() == (code != 5),
               f"{what}: {result.returncode}, {n} rows {result.stderr}")
        expect(code != 5 or "--resume" in result.stderr and json_of(folder / "killed/summary.json")["reason"] == "signal",
               f"{what}: {result.stderr}")
        again = sweep(folder, "killed", "--resume")
        rest = table(folder / "killed")
        for earlier in (before, now):
            expect(all(rest["seconds"][i] == earlier["seconds"][i] for i in np.flatnonzero(computed(earlier))),
                   f"{what}: no row is computed again")
        expect(again.returncode == 0 and same_columns(reference, rest),
               f"{what}: with --resume the table is that of the unbroken sweep, bit for bit {again.stderr}")
    last = sweep(folder, "begun", "--resume", command=on_ranks(MPIRUN, 3))
    before = table(folder / "begun")
    expect(last.returncode == 0 and same_columns(reference, before), f"three ranks make the rest, bit for bit {last.stderr}")
    again = sweep(folder, "begun", "--resume")
    expect(again.returncode == 0 and same_columns(before, table(folder / "begun"), but=None),
           "a sweep that is finished stays as it is")
    refused(sweep(folder, "begun", "--resume", "--set", "Body/Length=2"), 'Body/Length was "1" and is "2"')


RUNS = ("", "position ", "stretch ", "refined ")


def checked(folder, output, axes, *more, **how):
    """The finished process of a cross-checked sweep, and its rows."""
    write(folder, axes, "set Cross-check = true")
    done = sweep(folder, output, "--set", "Accuracy=1e-3", *more, **how)
    return done, csv_rows(folder / output / "results.csv")


def test_cross_check(folder):
    """Other runs of each point agree with it, and small displacements with the theory, -a chi^2/2."""
    done, rows = checked(folder, "grid", f"{CHI} : 0.1, 0.2, 0.3; {P} : 0, 2")
    expect(done.returncode == 0 and "6 points with two answers at least, 0 silent wrong answers" in done.stdout,
           f"a cross-check: {done}")
    expect({(row["outcome"], row["verdict"], row["explanation"]) for row in rows} == {("finished", "agree", "")},
           f"all answers agree {rows}")
    runs = {"0": ("", "position ", "refined "), "2": RUNS}  # the stretch form is tried for a < 0, p > 1
    expect(all(bool(row[f"{run}status"]) == (run in runs[row[P]]) for row in rows for run in RUNS), "no stretch form where a >= 0")
    expect(all(abs(number(row[f"{run}displacement"]) / ((float(row[P]) - 1) * float(row[CHI]) ** 2 / 2) - 1) < 0.25
               for row in rows for run in runs[row[P]]), "small displacements are those of the theory")
    expect(all(0 <= number(row[f"{run}error ratio"]) <= 1 and abs(
        abs(number(row[f"{run}displacement"]) - number(row["refined displacement"])) / number(row[f"{run}error ratio"])
        / (number(row[f"{run}promised error"]) + number(row["refined promised error"])) - 1) < 1e-9
               for row in rows for run in runs[row[P]][:-1]), "measured errors are below the promised ones")
    summary = json_of(folder / "grid" / "summary.json")["cross_check"]
    expect(summary == {"checked": 6, "silent_wrong_answers": 0, "largest_error_ratio": max(
        number(row[f"{run}error ratio"]) for row in rows for run in runs[row[P]][:-1])}, f"summary.json {summary}")
    single = call([PROGRAM, "run", "sweep.prm", "--output", "single", "--set", "Accuracy=1e-3", "--set", f"{CHI}=0.2", "--set",
                   f"{P}=2", "--set", "Output/Number of snapshots=0"], folder)
    single = json_of(folder / "single" / "summary.json")
    # The lanes of a batch and a run alone add up in another order.
    expect(math.isclose(single["displacement"], number(rows[3]["displacement"]), rel_tol=1e-13)
           and single["steps"] == number(rows[3]["steps"]), "crawler run gives the same answer")
    done, rows = checked(folder, "zip", f"{CHI} : 0.1, 0.3; {P} : 0, 3; Body/Length : 1, 2", "--set", "Sweep/Design=zip")
    expect(done.returncode == 0 and [row["verdict"] for row in rows] == ["agree"] * 2, f"three axes of a zip: {rows}")


def test_what_cannot_be_checked(folder):
    """A scene that makes no sense, ends of stretch 1 - 2 t/k, which invert at t = k/2, a crash, other models."""
    energy = "Active stress/Optimal wave/Energy : 0.4, 0.5"
    done, rows = checked(folder, "refused", f"{energy}; Discretization/Number of cells : 4, 8", "--quiet", "--set",
                         "Discretization/Formulation=position", "--set", "Active stress/Optimal wave/Choose wave by=energy")
    expect(done.returncode == 0 and [row["outcome"] for row in rows] == ["refused"] * 2 + ["finished"] * 2
           and "no wave spends the energy" in rows[0]["message"], f"an inadmissible scene is a row with its reason {done} {rows}")
    expect(not any(row["position status"] + row["stretch status"] for row in rows), "only one form if one is set")
    expect(rows[2]["verdict"] == "unchecked" and not rows[2]["promised error"], "no promise where cells are set")
    expression = ("--set", "Active stress/Generator=expression", "--set", "Active stress/Expression/Active stress=2*t")
    done, rows = checked(folder, "inverted", f"Body/Elastic modulus : 1, 4; {P} : 0, 1", *expression)
    expect(done.returncode == 0 and [row["outcome"] for row in rows] == ["inverted at end"] * 2 + ["finished"] * 2,
           f"outcomes {[row['outcome'] for row in rows]}")
    expect(all(abs(number(row[f"{run}inversion.t"]) - 0.5) < 1e-3 and row["verdict"] == "agree"
               for row in rows[:2] for run in ("", "position ", "refined ")), "the ends invert at t = k/2, and all runs say so")
    write(folder, f"{P} : 2", "set Cross-check = true")
    for _ in range(2):
        sweep(folder, "crashed", "--resume", stop_at="step:5:SEGV")
    done = sweep(folder, "crashed", "--resume")
    rows = csv_rows(folder / "crashed" / "results.csv")
    expect(done.returncode == 0 and rows[0]["outcome"] == "failed: crashed" and not rows[0]["refined status"], f"a crash: {done} {rows}")
    for entry, words in (("Model=kinematic", "Model = nonlinear is expected"),
                         ("Active stress/Generator=strain feedback", "Generator is strain feedback")):
        bad = sweep(folder, "bad", "--set", entry)
        expect(bad.returncode == 2 and words in bad.stderr and not (folder / "bad").exists(), f"{entry}: {bad}")


def test_bad_input(folder):
    """Wrong names and values are found before the first solve."""
    for name, text in {"empty": "", "good": "# a remark\np,chi\n2,0.1\n# another\n2.0,0.2\n", "short": "p,q\n1,2\n\n3\n",
                       "long": "p,q\n1,2,3\n", "remarks": "# nothing but a remark\n", "names": "p,chi\n", "quote": 'p,q\n1,"a\nb"\n',
                       "wide": ",".join(f"name{i}" for i in range(40)) + "\n", "twice": "p,q,p\n1,2,3\n", "mac": "p,q\r1,2\r"}.items():
        (folder / f"{name}.csv").write_text(text, encoding="utf-8")
    (folder / "utf16.csv").write_text("p,q\n1,2\n", encoding="utf-16")
    (folder / "a_folder").mkdir()
    (folder / "measured.prm").write_text("set Accuracy = 1e-4\n", encoding="utf-8")
    cases = {
        "": ("",),
        "Body/Anchoring exponnt : 1, 2": ("Anchoring exponent",),
        f"{P} : uniform(1, 2)": ("random",),
        f"{P} : colum(good.csv, p)": ('"colum"', '"linspace"', '"logspace"', '"column"', '"uniform"', '"loguniform"',
                                      'nearest is "column"'),
        f"{P} : 2, 3 Body/Length : 1, 2": ('"3 Body/Length : 1"', "semicolon missing"),
        f"{P} : column(good.csv, p)": ("the value 2.0 occurs twice", '"p"', "good.csv"),
        f"{P} : column(god.csv, p)": ('nearest name is "good.csv"',),
        f"{P} : column(empty.csv, p)": ("empty.csv", "is empty"),
        f"{P} : column(good.csv, chj)": ('"p" or "chi"', 'nearest is "chi"'),
        f"{P} : column(short.csv, p)": ("row 4", "1 value,"),
        f"{P} : column(utf16.csv, p)": ("row 1", "text in UTF-16"),
        f"{P} : column(mac.csv, p)": ("row 1", "old Mac line ends"),
        f"{P} : column(nothing.csv, p)": ("nothing.csv", "No such file or directory", "CSV file"),
        f"{P} : column(a_folder, p)": ("a_folder", "is a folder"),
        f"{P} : column(remarks.csv, p)": ("remarks.csv", "is empty"),
        f"{P} : column(names.csv, p)": ("names.csv", "no rows"),
        f"{P} : column(good.csv)": ("column(file.csv, name)",),
        f"{P} : column(wide.csv, nme39)": ("40 columns", '"name0"', '"name9", ...', 'nearest is "name39"'),
        f"{P} : column(twice.csv, p)": ("more than one column",),
        f"{P} : column(long.csv, p)": ("row 2", "3 values,"),
        f"{P} : column(quote.csv, p)": ("row 2", "not closed"),
        f"{P} : 1, 2; {P} : 3, 4": ("twice",),
        "File : measured.prm, mesured.prm": ("mesured.prm", 'nearest name is "measured.prm"'),
        "File : linspace(1, 2, 2)": ("linspace(1, 2, 2)", "names of parameter files"),
        "File : missing.prm": ("missing.prm", "No such file"),
        "File : a_folder": ("a_folder", "is a folder"),
        "Body/Friction profile : 1, 1+x": ("1+x",),
        "Active stress/Generator : optimal wave, plse": ("pulse",),
    }
    for axes, words in cases.items():
        write(folder, axes)
        result = sweep(folder, "bad")
        refused(result, *words, "Sweep/Axes")
        expect(result.stderr.strip().isprintable() and not (folder / "bad").exists(), f"\"{axes}\": {result.stderr!r}")


checks.run((test_bad_input, test_places_of_files, test_rows_that_fail, test_time_limits,
            test_changed_inputs, test_killed_at_files, test_two_at_once, test_crashes, test_cross_check,
            test_what_cannot_be_checked), (test_grid, test_designs, test_rank_that_cannot_write, test_kills))
