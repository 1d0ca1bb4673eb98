#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler sweep: designs, its table in h5py and pandas, resume after kill -9 at random moments and after changes, limits
and bad input.

    python3 sweep.py PATH_TO_CRAWLER MPIRUN
"""
import csv
import fcntl
import json
import math
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

ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1",
                   OPENBLAS_NUM_THREADS="1")
CHI, P = "Active stress/Optimal wave/Perturbation parameter", "Body/Anchoring exponent"
BASE = """
set Accuracy = 1e-4
subsection Active stress
  subsection Optimal wave
    set Choose wave by = wave speed
  end
end
"""
KILLS = 20
failures = 0


def check(condition, what):
    """Prints what was checked and counts failures."""
    global failures
    failures += not condition
    print(f"{'ok    ' if condition else 'FAILED'} {what}", flush=True)


def write(folder, axes, more="", name="sweep.prm"):
    """A parameter file with these axes."""
    text = BASE + f"subsection Sweep\n  set Axes = {axes}\n  {more}\nend\n"
    pathlib.Path(folder, name).write_text(text, encoding="utf-8")


def call(program, folder, *arguments, command=()):
    """Runs the program in the folder."""
    return subprocess.run([*command, program, *arguments], cwd=folder, env=ENVIRONMENT, capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, timeout=300, check=False)


def table(folder):
    """All columns of results.h5."""
    with h5py.File(folder / "results.h5", "r") as file:
        return {bytes(data.attrs["name"]).decode(): (data.asstr()[:] if data.dtype.kind == "S" else data[:])
                for data in file["results"].values()}


def same(one, other, but=("seconds",)):
    """Whether two tables are the same bit for bit, times aside."""
    return one.keys() == other.keys() and all(
        one[name].tobytes() == other[name].tobytes() if one[name].dtype.kind == "f" else list(one[name]) == list(other[name])
        for name in one if name not in but)


def test_grid(program, mpirun, folder):
    """Values, order, error bounds, CSV, pandas."""
    write(folder, f"{P} : 0, 2, 3; {CHI} : 0.1, 0.4")
    result = call(program, folder, "sweep", "sweep.prm", "--output", "grid")
    check(result.returncode == 0, f"a grid finishes with 0 ({result.returncode}) {result.stderr.strip()}")
    rows = table(folder / "grid")
    check(list(rows[P]) == [0, 0, 2, 2, 3, 3] and list(rows[CHI]) == [0.1, 0.4] * 3, "the last axis varies fastest")
    check(all(rows["status"] == "finished"), "every point has a row")
    check(abs(rows["displacement"][3] - 9.0072529800e-2) <= rows["displacement_error.total"][3] <= 1e-4 * 0.0901,
          "Fig. S1 is within its error bar, and the bar within Accuracy")
    with open(folder / "grid" / "results.csv", newline="", encoding="utf-8") as file:
        lines = list(csv.DictReader(file))
    check(len(lines) == 6 and all(float(line["displacement"]) == value
                                  for line, value in zip(lines, rows["displacement"])), "results.csv has the same")
    check(list(lines[0])[:3] == ["index", P, CHI], "columns start with index and axes")
    try:
        import pandas
        frame = pandas.read_csv(folder / "grid" / "results.csv", float_precision="round_trip")
        from_h5 = pandas.DataFrame(rows)
        check(np.array_equal(frame["displacement"], from_h5["displacement"]) and len(frame.columns) == len(from_h5.columns),
              "pandas reads both files")
    except ImportError:
        check(False, "pandas is there (Debian: python3-pandas)")
    single = call(program, folder, "run", "sweep.prm", "--set", f"{P}=3", "--set", f"{CHI}=0.4", "--output", "single", "--set",
                  "Output/Number of snapshots=0")
    summary = json.loads((folder / "single" / "summary.json").read_text(encoding="utf-8"))
    check(single.returncode == 0 and abs(summary["displacement"] - rows["displacement"][5])
          <= summary["displacement_error"]["total"] + rows["displacement_error.total"][5],
          "a point agrees with crawler run within the error bounds")

    def in_summary(key):
        value = summary
        for part in key.split("."):
            value = value[part]
        return value
    apart = []
    for name in (name for name in rows if name.startswith("errors.")):
        key = name.removeprefix("errors.") + (".value" if name.endswith("_stretch") else "")
        if not abs(rows[key][5] - in_summary(key)) <= rows[name][5] + in_summary(name):
            apart.append(key)
    check(not apart, f"so do its works, extreme stretches and gait numbers {apart or ''}")
    two = call(program, folder, "sweep", "sweep.prm", "--output", "two", command=(mpirun, "--oversubscribe", "-n", "2"))
    check(two.returncode == 0 and same(rows, table(folder / "two")), "two ranks give the same table, bit for bit")
    many = call(program, folder, "sweep", "sweep.prm", "--output", "many", command=(mpirun, "--oversubscribe", "-n", "16"))
    check(many.returncode == 0 and same(rows, table(folder / "many")), "so do more ranks than points")
    far = call(program, folder, "sweep", "sweep.prm", "--output", "far", command=(
        mpirun, "--oversubscribe", "-n", "3", "--mca", "btl", "tcp,self", "--mca", "osc", "pt2pt"))
    check(far.returncode == 0 and same(rows, table(folder / "far")), "so do ranks without shared memory")


def test_designs(program, folder):
    """zip, random, Latin hypercube, column of a file, files as an axis."""
    (folder / "values.csv").write_text("name,p,chi\na,2,0.1\nb,3,0.2\n", encoding="utf-8")
    write(folder, f"{P} : column(values.csv, p); {CHI} : column(values.csv, chi)", "set Design = zip")
    call(program, folder, "sweep", "sweep.prm", "--output", "zip")
    rows = table(folder / "zip")
    check(list(rows[P]) == [2, 3] and list(rows[CHI]) == [0.1, 0.2], "zip takes the rows of a CSV file")
    for design in ("random", "latin hypercube"):
        write(folder, f"{P} : uniform(1.5, 4); {CHI} : loguniform(0.01, 0.4)",
              f"set Design = {design}\n set Number of points = 20\n set Seed = 3")
        call(program, folder, "sweep", "sweep.prm", "--output", design[:5], "--overwrite")
        rows = table(folder / design[:5])
        strata = np.sort(np.floor((rows[P] - 1.5) / 2.5 * 20))
        inside = rows[P].min() >= 1.5 and rows[P].max() < 4 and rows[CHI].min() >= 0.01 and rows[CHI].max() < 0.4
        check(inside and len(set(rows[P])) == 20 and (design == "random" or list(strata) == list(range(20))),
              f"{design}: 20 points within the ranges{'' if design == 'random' else ', one in each part of an axis'}")
        call(program, folder, "sweep", "sweep.prm", "--output", "again", "--overwrite")
        check(same(rows, table(folder / "again")), f"{design}: the same seed gives the same table")
    values = ("max(1, s + 0.5)", "2", "1 + 0.1*min(2, s)")
    write(folder, f'Body/Friction profile : {values[0]}, {values[1]}, "{values[2]}"; {CHI} : 0.1')
    result = call(program, folder, "sweep", "sweep.prm", "--output", "formulas")
    rows = table(folder / "formulas")
    check(result.returncode == 0 and tuple(rows["Body/Friction profile"]) == values and
          all(rows["status"] == "finished"), f"formulas with commas are values {result.stderr.strip()}")
    write(folder, 'Active stress/Optimal wave/Sine coefficients : "0.1, 0.05", "0.1, 0"',
          "end\nsubsection Active stress\n subsection Optimal wave\n  set Shape = Fourier\n end")
    result = call(program, folder, "sweep", "sweep.prm", "--output", "lists")
    rows = table(folder / "lists")
    check(result.returncode == 0 and rows["displacement"][0] != rows["displacement"][1] and
          list(rows["Active stress/Optimal wave/Sine coefficients"]) == ["0.1, 0.05", "0.1, 0"],
          f"so are lists in quotes {result.stderr.strip()}")
    (folder / "soft.prm").write_text("subsection Body\n  set Elastic modulus = 1\nend\n", encoding="utf-8")
    (folder / "stiff.prm").write_text("subsection Body\n  set Elastic modulus = 10\nend\n", encoding="utf-8")
    write(folder, f"File : soft.prm, stiff.prm; {CHI} : 0.3")
    result = call(program, folder, "sweep", "sweep.prm", "--output", "files")
    rows = table(folder / "files")
    check(result.returncode == 0 and abs(rows["displacement"][0] - 4.764510e-2) < 1e-5 and
          abs(rows["displacement"][1] - 4.8552305987e-2) < 1e-5, "parameter files are an axis")
    result = call(program, folder, "sweep", "sweep.prm", "--output", "set", "--set", "Body/Elastic modulus=10")
    check(result.returncode == 0 and list(table(folder / "set")["displacement"]) == [rows["displacement"][1]] * 2,
          f"--set is stronger than the files of an axis {result.stderr.strip()}")
    result = call(program, folder, "check", "soft.prm", "--set", f" Sweep / Axes = {CHI} : 0.1, 0.2, 0.3")
    check(result.returncode == 0 and "3 points" in result.stdout, f"blanks in the name of an entry do not matter {result.stderr}")
    result = call(program, folder, "check", "sweep.prm", "--set", "Sweep/Axes=")
    check(result.returncode == 0 and "points" not in result.stdout, f"without axes there is no sweep to check {result.stderr}")


def test_places_of_files(program, folder):
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
        result = call(program, place, "sweep", name, "--output", "from_here", "--set", "Output/Number of snapshots=1")
        check(result.returncode == 0 and same(table(place / "from_here"), table(study / "from_here"))
              and all(table(place / "from_here")["status"] == "finished")
              and (place / "from_here" / "points" / "3" / "summary.json").exists(),
              f"started in {place.name}: {result.returncode} {result.stderr.strip()}")
    result = call(program, folder, "sweep", "a_study/sweep.prm", "--output", "from_here", "--resume")
    check(result.returncode == 2 and "Number of snapshots" in result.stderr, f"resumed: {result.stderr.strip()}")
    shutil.copy(study / "values.csv", folder / "other.csv")
    result = call(program, folder, "sweep", "a_study/sweep.prm", "--output", "with_set", "--set",
                  f"Sweep/Axes={P} : column(other.csv, p)", "--set", "Sweep/Keep fields=")
    check(result.returncode == 0, f"with --set they count from the current folder: {result.stderr.strip()}")


def test_out_of_memory(program, folder):
    """What a run throws is how it ends: with a reason, a summary and exit code 3; in a sweep it is a row."""
    cells = "Discretization/Number of cells"
    limited = ("sh", "-c", 'ulimit -v 1600000; exec "$@"', "sh")
    for tolerance in ((), ("--set", "Time/Tolerance=1e-3")):  # in a pilot run, and in the run itself
        result = call(program, folder, "run", "soft.prm", "--output", "large", "--overwrite", "--quiet", "--set",
                      f"{cells}=10000000", *tolerance, command=limited)
        file = folder / "large" / "summary.json"
        summary = json.loads(file.read_text(encoding="utf-8")) if file.is_file() else {}
        check(result.returncode == 3 and summary.get("status") == "failed" and summary.get("reason") == "out_of_memory" and
              "out_of_memory" in result.stderr, f"a run that needs too much memory says so ({result.returncode}) {result.stderr}")
    write(folder, f"{cells} : 4, 10000000, 5")
    result = call(program, folder, "sweep", "sweep.prm", "--output", "memory", command=limited)
    rows = table(folder / "memory")
    check(result.returncode == 0 and list(rows["reason"]) == ["", "out_of_memory", ""] and
          list(rows["status"]) == ["finished", "failed", "finished"], f"in a sweep it is a row {list(rows['reason'])} {result.stderr}")


def test_rows_that_fail(program, folder):
    """Inverted, refused and slow points are rows; --strict says so; fields are kept."""
    write(folder, f"{P} : 0; Active stress/Optimal wave/Wave speed : -1, 1; {CHI} : 0.6, 0.1", "set Keep fields = 1")
    result = call(program, folder, "sweep", "sweep.prm", "--output", "some")
    rows = table(folder / "some")
    check(result.returncode == 0 and rows["status"][0] == "inverted" and rows["reason"][0] != "" and rows["status"][1] == "finished",
          "a body that inverts is a row")
    check(math.isfinite(rows["inversion.t"][0]) and math.isnan(rows["inversion.t"][1]), "with the time of the inversion")
    check((folder / "some" / "points" / "1" / "solution.pvd").is_file(), "the fields of a point are kept")
    strict = call(program, folder, "sweep", "sweep.prm", "--output", "strict", "--strict")
    check(strict.returncode == 8, f"--strict: exit code 8 ({strict.returncode})")
    write(folder, f"{P} : 2; {CHI} : 0.01, 0.8", "set Time limit per point = 0.3\n set Design = grid")
    result = call(program, folder, "sweep", "sweep.prm", "--output", "slow", "--set", "Accuracy=1e-7", "--set",
                  "Discretization/Formulation=stretch", "--set", "Time/End time=8")
    rows = table(folder / "slow")
    check(result.returncode == 0 and rows["status"][1] == "stopped" and rows["reason"][1] == "time_limit",
          f"a point that takes too long is a row ({rows['status'][1]}, {rows['reason'][1]})")
    again = call(program, folder, "sweep", "sweep.prm", "--output", "slow", "--resume", "--set", "Accuracy=1e-7", "--set",
                 "Discretization/Formulation=stretch", "--set", "Time/End time=8", "--set",
                 "Sweep/Time limit per point=100", "--set", "Sweep/Keep fields=1")
    now = table(folder / "slow")
    check(again.returncode == 0 and now["status"][1] == "finished" and now["seconds"][0] == rows["seconds"][0],
          f"with a larger limit --resume computes it, and nothing else ({again.stderr.strip()})")
    check((folder / "slow" / "points" / "1" / "summary.json").is_file(), "and now its fields are kept")
    (folder / "slow" / "points" / "1" / "mine.txt").write_text("mine", encoding="utf-8")
    call(program, folder, "sweep", "sweep.prm", "--output", "slow", "--overwrite")
    left = sorted(path.name for path in (folder / "slow" / "points").rglob("*"))
    check(left == ["1", "mine.txt"], f"--overwrite removes the fields, and nothing of others ({left})")
    write(folder, "Active stress/Optimal wave/Energy : 0.001, 1", "set Keep fields = 0, 1")
    result = call(program, folder, "sweep", "sweep.prm", "--output", "refused", "--set",
                  "Active stress/Optimal wave/Choose wave by=energy")
    rows = table(folder / "refused")
    kept = [path.name for path in (folder / "refused" / "points").iterdir()]
    check(result.returncode == 0 and rows["reason"][0] == "refused" and "0.5" in rows["message"][0] and kept == ["1"],
          f"values that do not fit together are a row without fields ({rows['reason'][0]}, {kept})")


def refused(program, folder, output, words, what):
    """--resume is refused with one sentence that has these words, and the table stays as it is."""
    before = (folder / output / "results.h5").read_bytes()
    result = call(program, folder, "sweep", "sweep.prm", "--output", output, "--resume")
    lines = result.stderr.splitlines()
    check(result.returncode == 2 and len(lines) == 1 and all(word in lines[0] for word in words) and
          (folder / output / "results.h5").read_bytes() == before, f"{what} is refused: {result.stderr.strip()}")


def test_changed_inputs(program, folder):
    """What changes the answers is noticed by --resume: values of axes, scene files, data files."""
    def resumes(output, what):
        result = call(program, folder, "sweep", "sweep.prm", "--output", output, "--resume")
        check(result.returncode == 0, f"{what} goes on ({result.returncode}) {result.stderr.strip()}")

    (folder / "values.csv").write_text("p,chi\n2,0.1\n3,0.2\n", encoding="utf-8")
    write(folder, f"{P} : column(values.csv, p); {CHI} : column(values.csv, chi)", "set Design = zip")
    call(program, folder, "sweep", "sweep.prm", "--output", "axes")
    (folder / "values.csv").write_text("remark,p,chi\n\"a, b\",2.0,0.1\nc,3,0.20\n", encoding="utf-8")
    resumes("axes", "a CSV file with the same values")
    (folder / "values.csv").write_text("p,chi\n2,0.1\n3.5,0.2\n", encoding="utf-8")
    refused(program, folder, "axes", (f'{P} of point 1 was "3" and is "3.5"',), "a changed value of a CSV file")
    (folder / "values.csv").write_text("p,chi\n2,0.1\n3,0.2\n4,0.2\n", encoding="utf-8")
    refused(program, folder, "axes", ("number of points was 2 and is 3",), "another number of values")

    def scene(name, modulus, more=""):
        (folder / name).write_text(f"{more}\nsubsection Body\n set Elastic modulus = {modulus}\nend\n", encoding="utf-8")

    scene("soft.prm", 5)
    scene("stiff.prm", 10)
    write(folder, f"File : soft.prm, stiff.prm; {CHI} : 0.3")
    call(program, folder, "sweep", "sweep.prm", "--output", "scenes")
    scene("soft.prm", 5, "# a remark")
    resumes("scenes", "a scene file with another comment")
    scene("stiff.prm", 11)
    refused(program, folder, "scenes", ('Body/Elastic modulus in stiff.prm was "10" and is "11"',), "a changed scene file")
    scene("stiff.prm", 10, "set Accuracy = 1e-5")
    refused(program, folder, "scenes", ('Accuracy in stiff.prm was not set and is "1e-5"',), "an entry more in a scene file")

    (folder / "ground.csv").write_text("x,value\n-5,1\n0,2\n2,1.5\n5,1\n", encoding="utf-8")
    (folder / "sweep.prm").write_text(BASE + "subsection Ground\n set Profile = ground.csv\nend\n"
                                      f"subsection Sweep\n set Axes = {CHI} : 0.1, 0.2\nend\n", encoding="utf-8")
    first = call(program, folder, "sweep", "sweep.prm", "--output", "data")
    resumes("data", "a data file that is the same")
    (folder / "ground.csv").write_text("x,value\n-5,1\n0,3\n2,1.5\n5,1\n", encoding="utf-8")
    refused(program, folder, "data", ('/ground.csv" was', "CRC-32"), f"a changed data file ({first.returncode})")


def test_begun(program, folder):
    """What a kill can leave behind before there is a table, or at the end; folders of others; two sweeps at once."""
    write(folder, f"{P} : 2, 3; {CHI} : 0.1, 0.2")
    whole = folder / "begun_whole"
    call(program, folder, "sweep", "sweep.prm", "--output", "begun_whole")
    reference = table(whole)
    check(not (whole / "study.lock").exists(), "no lock stays behind")
    for files in (("study.lock",), ("study.lock", "original.prm.part"),
                  ("study.lock", "original.prm", "parameters.prm", "log.txt", "results.h5.part")):
        begun = folder / "begun"
        shutil.rmtree(begun, ignore_errors=True)
        begun.mkdir()
        for name in files:
            (begun / name).write_bytes((whole / name).read_bytes() if (whole / name).exists() else b"")
        plain = call(program, folder, "sweep", "sweep.prm", "--output", "begun")
        result = call(program, folder, "sweep", "sweep.prm", "--output", "begun", "--resume")
        check(plain.returncode == 2 and result.returncode == 0 and same(reference, table(begun)),
              f"a sweep that had made {files[-1]} begins anew with --resume")
    for name in ("results.csv", "summary.json"):
        (whole / name).rename(whole / (name + ".part"))
    result = call(program, folder, "sweep", "sweep.prm", "--output", "begun_whole", "--resume")
    check(result.returncode == 0 and (whole / "results.csv").is_file() and (whole / "summary.json").is_file() and
          not (whole / "results.csv.part").exists(), "a sweep that was killed while it made results.csv makes it")
    call(program, folder, "run", "sweep.prm", "--output", "not_a_sweep")
    (folder / "of_others").mkdir()
    (folder / "of_others" / "original.prm").write_text("mine", encoding="utf-8")
    for name in ("not_a_sweep", "of_others"):
        before = {file: file.read_bytes() for file in (folder / name).rglob("*") if file.is_file()}
        result = call(program, folder, "sweep", "sweep.prm", "--output", name, "--resume")
        after = {file: file.read_bytes() for file in (folder / name).rglob("*") if file.is_file()}
        check(result.returncode == 2 and before == after, f"--resume leaves {name} alone: {result.stderr.strip()}")
    with open(whole / "study.lock", "wb") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        result = call(program, folder, "sweep", "sweep.prm", "--output", "begun_whole", "--resume")
        check(result.returncode == 2 and "another study writes to" in result.stderr,
              f"two sweeps at once are refused: {result.stderr.strip()}")
        with subprocess.Popen([program, "sweep", "sweep.prm", "--output", "begun_whole", "--resume"], cwd=folder,
                              env=ENVIRONMENT, stdout=subprocess.DEVNULL) as process:
            time.sleep(1)
            fcntl.flock(lock, fcntl.LOCK_UN)
            check(process.wait(timeout=60) == 0, "but one that is about to end is waited for")


def test_signals(program, mpirun, folder):
    """SIGTERM and Ctrl-C while a point takes long; a second signal; a rank that cannot write."""
    write(folder, f"{P} : 2, 3; {CHI} : 0.3", "set Seed = 1")
    long = ("--set", "Time/End time=30000", "--set", "Time/Cycle stop=off", "--set", "Output/Number of snapshots=0")
    for name, signals in (("SIGTERM", [signal.SIGTERM]), ("Ctrl-C", [signal.SIGINT]), ("SIGTERM twice", [signal.SIGTERM] * 2)):
        with subprocess.Popen([program, "sweep", "sweep.prm", "--output", name, *long], cwd=folder,
                              env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            while not (folder / name / "results.h5").exists():
                time.sleep(0.1)
            time.sleep(1)
            start = time.time()
            for number in signals:
                process.send_signal(number)
                time.sleep(0.01)
            code = process.wait(timeout=60)
        expected = (5,) if len(signals) == 1 else (5, -signal.SIGTERM)
        check(code in expected and time.time() - start < 2. and len(table(folder / name)["status"]) == 2,
              f"{name} within a long point: code {code} after {time.time() - start:.2f} s")
    write(folder, f"{P} : linspace(1.5, 4, 40); {CHI} : linspace(0.05, 0.5, 40)")
    one = (program, "sweep", "sweep.prm", "--output", "rank", "--resume")
    # No file of rank 1 may grow beyond 300 blocks of 512 bytes; without the signal that would be an error of write.
    limited = ("sh", "-c", "trap '' XFSZ; ulimit -f 300; exec \"$0\" \"$@\"", *one)
    result = subprocess.run([mpirun, "--oversubscribe", "-n", "1", *one, ":", "-n", "1", *limited], cwd=folder, env=ENVIRONMENT,
                            capture_output=True, text=True, timeout=120, check=False)
    check(result.returncode == 6 and "--resume" in result.stderr, f"a rank that cannot write ends all ({result.returncode}): "
          f"{next((line for line in result.stderr.splitlines() if line.startswith('crawler')), result.stderr[:200])}")
    again = call(*one[:1], folder, *one[1:])
    call(program, folder, "sweep", "sweep.prm", "--output", "rank_whole")
    check(again.returncode == 0 and same(table(folder / "rank_whole"), table(folder / "rank")), "and --resume makes the rest")


def wait_for(mpirun):
    """Until mpirun ends. Killed while it starts, it may wait for ever for ranks that are dead (Open MPI 4.1): not our business."""
    try:
        mpirun.wait(timeout=60)
    except subprocess.TimeoutExpired:
        states = subprocess.run(["ps", "-o", "stat=", "--ppid", str(mpirun.pid)], capture_output=True, text=True, check=False).stdout
        check(all(state.startswith("Z") for state in states.split()), f"a rank goes on after a kill ({states.split()})")
        mpirun.kill()
        mpirun.wait(timeout=60)


def test_kills(program, mpirun, folder):
    """kill -9 of a rank or of mpirun at random moments; SIGTERM; nothing is lost, nothing computed twice."""
    write(folder, f"{P} : linspace(1.5, 4, 16); {CHI} : linspace(0.05, 0.5, 48)")
    whole = call(program, folder, "sweep", "sweep.prm", "--output", "whole")
    check(whole.returncode == 0, "an unbroken sweep")
    reference = table(folder / "whole")
    call(program, folder, "sweep", "sweep.prm", "--output", "accurate", "--set", "Accuracy=1e-8")
    error = np.abs(reference["displacement"] - table(folder / "accurate")["displacement"])
    covered = np.mean(error <= reference["displacement_error.total"])
    wanted = np.all(reference["displacement_error.total"] <= 1e-4 * np.abs(reference["displacement"]))
    check(covered >= 0.99 and wanted, f"{100 * covered:.2f} % of the points are within their error bounds, all bars within Accuracy")
    start = time.time()
    call(program, folder, "sweep", "sweep.prm", "--output", "timed", command=(mpirun, "--oversubscribe", "-n", "2"))
    duration = time.time() - start
    generator, order, lost = random.Random(7), 0, 0
    shutil.rmtree(folder / "killed", ignore_errors=True)
    before, n_killed = {}, 0
    for attempt in range(KILLS):
        victim = generator.choice(("mpirun", "rank", "term"))
        n_ranks = 4 if attempt == KILLS // 2 else 2
        process = subprocess.Popen([mpirun, "--oversubscribe", "-n", str(n_ranks), program, "sweep", "sweep.prm", "--output", "killed",
                                    "--resume"], cwd=folder, env=ENVIRONMENT, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL, start_new_session=True)
        time.sleep(generator.uniform(0.1, 0.7 if attempt % 4 == 0 else 0.5 * duration))
        ranks = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True, check=False).stdout.split()
        if process.poll() is None:
            n_killed += 1
            if victim == "rank" and ranks:
                os.kill(int(generator.choice(ranks)), signal.SIGKILL)
            elif victim == "term":
                process.terminate()
            else:
                process.kill()
        wait_for(process)
        for rank in ranks:  # orphans of a killed mpirun end by themselves; do not wait for them
            try:
                os.kill(int(rank), signal.SIGKILL)
            except ProcessLookupError:
                pass
        time.sleep(0.2)
        if not (folder / "killed" / "results.h5").is_file():
            continue  # killed before there was a table: the next one begins anew
        now = table(folder / "killed")
        done = now["status"] != ""
        order += not all(done[i] for i in before)
        lost += any(now["seconds"][i] != seconds for i, seconds in before.items())
        before = {i: now["seconds"][i] for i in np.flatnonzero(done)}
    check(n_killed >= KILLS // 3, f"{n_killed} of {KILLS} runs were killed or stopped under way")
    check(order == 0 and lost == 0, "after each kill the file is valid, and no row is lost or computed again")
    last = call(program, folder, "sweep", "sweep.prm", "--output", "killed", "--resume",
                command=(mpirun, "--oversubscribe", "-n", "3"))
    check(last.returncode == 0 and same(reference, table(folder / "killed")),
          "the table in the end is that of the unbroken sweep, bit for bit")
    before = table(folder / "killed")
    again = call(program, folder, "sweep", "sweep.prm", "--output", "killed", "--resume")
    check(again.returncode == 0 and same(before, table(folder / "killed"), but=()), "a sweep that is finished stays as it is")
    changed = call(program, folder, "sweep", "sweep.prm", "--output", "killed", "--resume", "--set", "Body/Length=2")
    check(changed.returncode == 2 and 'Body/Length was "1" and is "2"' in changed.stderr,
          "a changed parameter is refused, with the difference")


def test_limits(program, folder):
    """A time limit and a full disk end a sweep in order."""
    write(folder, f"{P} : linspace(1.5, 4, 400); {CHI} : linspace(0.05, 0.5, 100)", "set Time limit = 1.5")
    result = call(program, folder, "sweep", "sweep.prm", "--output", "limit")
    rows = table(folder / "limit")
    check(result.returncode == 5 and 0 < np.count_nonzero(rows["status"] != "") < 40000,
          f"the time limit ends it with exit code 5 ({result.returncode}), with rows")
    write(folder, f"{P} : linspace(1.5, 4, 40); {CHI} : linspace(0.05, 0.5, 40)")
    call(program, folder, "sweep", "sweep.prm", "--output", "empty", "--set", "Sweep/Time limit=0.001")
    disk = folder / "disk"
    disk.mkdir()

    def size(text):
        """A small disk, or the same with another size."""
        mounted = ("-o", f"remount,size={text}") if os.path.ismount(disk) else ("-t", "tmpfs", "-o", f"size={text}", "tmpfs")
        return subprocess.run(["mount", *mounted, disk], capture_output=True, check=False).returncode == 0

    if not size("400k"):
        print("skip   a full disk: only root can make a small one")
        return
    try:
        full = call(program, folder, "sweep", "sweep.prm", "--output", "disk/full")
        check(full.returncode == 6 and "full" in full.stderr,
              f"a full disk is a file error ({full.returncode}): {full.stderr.strip()[:120]}")
        needed = (folder / "empty" / "results.h5").stat().st_size // 1024 + 400  # too little for results.csv
        size(f"{needed}k")
        end = call(program, folder, "sweep", "sweep.prm", "--output", "disk/full", "--resume", "--set", "Sweep/Time limit=100")
        check(end.returncode == 6 and "results.h5 is whole" in end.stderr and all(table(disk / "full")["status"] != ""),
              f"a disk that is full at the end ({end.returncode}): {end.stderr.strip()}")
        size("16M")
        more = call(program, folder, "sweep", "sweep.prm", "--output", "disk/full", "--resume")
        with open(disk / "full" / "results.csv", newline="", encoding="utf-8") as file:
            check(more.returncode == 0 and len(list(csv.reader(file))) == 1601, "and --resume makes results.csv")
    finally:
        subprocess.run(["umount", disk], check=True)


def test_bad_input(program, folder):
    """Wrong names and values are found before the first solve."""
    (folder / "empty.csv").write_text("", encoding="utf-8")
    (folder / "remarks.csv").write_text("# nothing but a remark\n", encoding="utf-8")
    (folder / "names.csv").write_text("p,chi\n", encoding="utf-8")
    (folder / "good.csv").write_text("# a remark\np,chi\n2,0.1\n# another\n2.0,0.2\n", encoding="utf-8")
    (folder / "wide.csv").write_text(",".join(f"name{i}" for i in range(40)) + "\n", encoding="utf-8")
    (folder / "twice.csv").write_text("p,q,p\n1,2,3\n", encoding="utf-8")
    (folder / "short.csv").write_text("p,q\n1,2\n\n3\n", encoding="utf-8")
    (folder / "long.csv").write_text("p,q\n1,2,3\n", encoding="utf-8")
    (folder / "quote.csv").write_text('p,q\n1,"a\nb"\n', encoding="utf-8")
    (folder / "utf16.csv").write_text("p,q\n1,2\n", encoding="utf-16")
    (folder / "binary.csv").write_bytes(bytes(range(256)) * 20)
    (folder / "measured.prm").write_text("set Accuracy = 1e-4\n", encoding="utf-8")
    (folder / "a_folder").mkdir()
    cases = {
        "": ("",),
        "Body/Anchoring exponnt : 1, 2": ("Anchoring exponent",),
        f"{P} : 1, two": ("two",),
        f"{P} : linspace(1, 2)": ("linspace(first, last, count)",),
        f"{P} : linspace(1, 2, 3), 4": ("linspace(1, 2, 3)", "nothing beside it"),
        f"{P} : 4, column(good.csv, p)": ("column(good.csv, p)", "nothing beside it"),
        f"{P} : uniform(1, 2)": ("random",),
        f"{P} : colum(good.csv, p)": ('"colum"', '"linspace", "logspace", "column", "uniform" or "loguniform"',
                                      'the nearest is "column"'),
        f"{P} : uniforms(2, 3)": ('the nearest is "uniform"',),
        "File : uniform(1, 2)": ("uniform(1, 2)", "names of parameter files"),
        "File : linspace(1, 2, 2)": ("linspace(1, 2, 2)", "names of parameter files"),
        f"{P} : max(1, (2), 3": ("as many closing as opening parentheses",),
        f'{P} : "2, 3': ("double quote",),
        f"{P} : 2, 3 Body/Length : 1, 2": ('"3 Body/Length : 1"', "semicolon missing"),
        f"{P} : linspace(2, 3, 2) Body/Length: linspace(1, 2, 2)": ("semicolon missing",),
        f"{P} : 2, 2, 2": ("the value 2 occurs twice",),
        f"{P} : column(good.csv, p)": ("the value 2.0 occurs twice", '"p"', "good.csv"),
        f"{P} : column(nothing.csv, p)": ("nothing.csv", "No such file or directory), but a CSV file"),
        f"{P} : column(god.csv, p)": ('the nearest name is "good.csv"',),
        f"{P} : column(a_folder, p)": ("a_folder", "is a folder"),
        f"{P} : column(empty.csv, p)": ("empty.csv", "is empty"),
        f"{P} : column(remarks.csv, p)": ("remarks.csv", "is empty"),
        f"{P} : column(names.csv, p)": ("names.csv", "no rows"),
        f"{P} : column(good.csv)": ("column(file.csv, name)",),
        f"{P} : column(good.csv, chj)": ('"p" or "chi" is expected', 'the nearest is "chi"'),
        f"{P} : column(wide.csv, nme39)": ('one of 40 columns, "name0"', '"name9", ...', 'the nearest is "name39"'),
        f"{P} : column(twice.csv, p)": ("more than one column",),
        f"{P} : column(short.csv, p)": ("row 4", "1 value,"),
        f"{P} : column(long.csv, p)": ("row 2", "3 values,"),
        f"{P} : column(quote.csv, p)": ("row 2", "not closed"),
        f"{P} : column(utf16.csv, p)": ("row 1", "not text"),
        f"{P} : column(binary.csv, p)": ("row 1", "not text"),
        f"{P} : 1, 2; {P} : 3, 4": ("twice",),
        "Body/Length : 1, -1": ("-1",),
        "Sweep/Seed : 1, 2": ("cannot vary",),
        f"{P} 1, 2": ("VALUES",),
        "File : missing.prm": ("missing.prm", "No such file"),
        "File : measured.prm, mesured.prm": ("mesured.prm", 'the nearest name is "measured.prm"'),
        "File : a_folder": ("a_folder", "is a folder"),
        "Body/Friction profile : 1, 1+x": ("1+x",),
        "Active stress/Generator : optimal wave, plse": ("pulse",),
    }
    for axes, words in cases.items():
        write(folder, axes)
        result = call(program, folder, "sweep", "sweep.prm", "--output", "bad")
        lines = [line for line in result.stderr.splitlines() if line.strip()]
        check(result.returncode == 2 and len(lines) == 1 and all(word in lines[0] for word in words + ("Sweep/Axes",))
              and lines[0].isprintable() and not (folder / "bad").exists(),
              f"\"{axes}\": {result.returncode}, {lines[0] if lines else 'no message'}")


def test_damaged_table(program, folder):
    """--resume refuses what is no table of a sweep, and a part of one."""
    write(folder, f"{P} : 2, 3")
    call(program, folder, "sweep", "sweep.prm", "--output", "damaged")
    file = folder / "damaged" / "results.h5"
    whole = file.read_bytes()
    for content, word in ((whole[:len(whole) // 2], "cannot be read"), (whole[:100], "cannot be read"), (b"", "no HDF5"),
                          (b"garbage" * 1000, "no HDF5"), (whole.replace(b"scene files", b"Scene files"), "no attribute"),
                          (whole.replace(b"results", b"Results"), "results")):
        file.write_bytes(content)
        refused(program, folder, "damaged", ("results.h5", word, "damaged"), f"a table of {len(content)} bytes")
    file.unlink()
    with h5py.File(file, "w") as other:
        other["x"] = 1.
    refused(program, folder, "damaged", ('no group "results"',), "another HDF5 file")


def main():
    """All tests in a folder of their own."""
    program, mpirun = str(pathlib.Path(sys.argv[1]).resolve()), sys.argv[2]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        test_bad_input(program, folder)
        test_damaged_table(program, folder)
        test_grid(program, mpirun, folder)
        test_designs(program, folder)
        test_places_of_files(program, folder)
        test_out_of_memory(program, folder)
        test_rows_that_fail(program, folder)
        test_limits(program, folder)
        test_changed_inputs(program, folder)
        test_begun(program, folder)
        test_signals(program, mpirun, folder)
        if "--quick" in sys.argv:
            sys.exit(failures > 0)
        test_kills(program, mpirun, folder)
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
