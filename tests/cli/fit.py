#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler fit: its files, its picture, the scene it writes, the comparison of scenes, what stops and resumes, and refusals.

    python3 fit.py PATH_TO_CRAWLER
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

import matplotlib.image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, environment, expect, refused, sets  # noqa: E402
from tables import answer_in, csv_rows, json_of  # noqa: E402

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
STUDIES = pathlib.Path(__file__).resolve().parents[2] / "prm/studies"
TRUTH = {"Body/Anchoring exponent": 2.4, "Body/Elastic modulus": 1.3, "Active stress/Travelling wave/Amplitude": 0.25}
# Arguments, exit code, what the one sentence has.
REFUSED = [
    ([], 2, "FILE"), (["nowhere.prm"], 6, "nowhere.prm"), (["fit_worm.prm"], 2, "--overwrite"), (["fit_worm.prm", "--data", "no.csv"], 2, "no.csv"),
    (["fit_worm.prm", "--outptu", "x"], 2, "--output"), (["fit_worm.prm", "--set", "Body/Length"], 2, "Section/Entry=value"),
    (["fit_worm.prm", "--set", "Body/Lenght=3"], 2, "Length"), (["fit_worm.prm", "--unit-of-s", "1000"], 2, '"--unit-of-s"'),
    (["fit_worm.prm", "--columns", "x=x1"], 2, '"--columns" has "x=x1"'),
    (["fit_worm.prm", "--unit-of-t", "1000"], 2, "Time/End time"),
    (["fit_worm.prm", "--output", "fit_worm.prm"], 6, "is a file"), (["fit_worm.prm", "--output", "other", "--overwrite"], 2, "not the folder of a fit"),
    (["fit_worm.prm", "--workers", "0"], 2, "from 1"), (["fit_worm.prm", "--workers", "two"], 2, "whole number"),
    (["fit_worm.prm", "three.prm", "--output", "output-fit_worm"], 2, "not empty"),
    (["fit_worm.prm", "other/fit_worm.prm"], 2, '"fit_worm.prm" and "other/fit_worm.prm" have the same name'),
    (["fit_worm.prm", "three.prm", "--set", "Fit/Variables="], 2, 'fit_worm.prm: --set "Fit/Variables=": "Fit/Variables" is empty')]
THREE = ("fit", "three.prm")


def crawler(*arguments, stop_at=None):
    return call([PROGRAM, *arguments], os.getcwd(), stop_at)


def contents(folder):
    """The files of a fit but for picture and page, those of its starts too."""
    return answer_in(folder, ".png", ".html")


def compares_only_what_is_weighed_alike():
    """Scenes of which the data are weighed differently have no common likelihood."""
    data = pathlib.Path("fit_worm.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    pathlib.Path("fewer.csv").write_text("".join(data[:-9]), encoding="utf-8")
    for entry, value in (("Standard deviation", "0.02"), ("Standard deviation", "automatic"), ("Origin", "tail"), ("First time", "0"),
                         ("Place deviation", "0.01"), ("Data", "fewer.csv")):
        pathlib.Path("weighed.prm").write_text(f"include fit_worm.prm\nsubsection Fit\n  set {entry} = {value}\nend\n", encoding="utf-8")
        refused(crawler("fit", "fit_worm.prm", "weighed.prm", "--output", "weighed"),
                "same data" if entry == "Data" else f"Fit/{entry}", '"fit_worm.prm"', '"weighed.prm"')
        expect(not pathlib.Path("weighed").exists(), f"{entry} = {value} in one of two: there is a folder")


def fits_two_kinds_together():
    """Tracks and the path of the centre of mass, each with its deviation: screen, files, picture and page, what is resumed and compared."""
    ended = crawler("run", "fit_worm.prm", "--output", "truth", *sets(TRUTH))
    rows = csv_rows("truth/statistics.csv")
    kept = [(float(row["time [time]"]), 7 + 1.5 + float(row["displacement [length]"])) for row in rows[::max(1, len(rows) // 50)]]  # tracks count from 7
    pathlib.Path("centre.csv").write_text("t,centre\n" + "".join(f"{t!r},{x + 1e-3 * (-1) ** i!r}\n" for i, (t, x) in enumerate(kept)), encoding="utf-8")
    words = ("fit", "fit_worm.prm", "--data", "fit_worm.csv", "--data", "centre.csv", "--set", "Fit/Standard deviation=0.01, 0.001", "--output", "two")
    ended = crawler(*words)
    expect(ended.returncode == 0 and "of markers: 540 data" in ended.stdout and f"of centre: {len(kept)} data" in ended.stdout, f"two kinds: {ended.stdout}{ended.stderr}")
    summary = json_of("two/summary.json")
    expect([one["kind"] for one in summary["goodness"]["series"]] == ["markers", "centre"] and summary["goodness"]["n_data"] == 540 + len(kept)
           and [pathlib.Path(name).name for name in summary["measured"]["files"]] == ["fit_worm.csv", "centre.csv"], f"two kinds: {summary['goodness']}")
    for name, value in TRUTH.items():
        expect(abs(summary["variables"][name]["value"] - value) < 4 * summary["variables"][name]["deviation"], f"two kinds: {name} = {summary['variables'][name]['value']}")
    expect({row["kind"] for row in csv_rows("two/residuals.csv")} == {"markers", "centre"}, "residuals.csv of two kinds")
    again = crawler("fit", "two/fitted.prm", "--set", "Fit/Standard deviation=0.01, 0.001", "--output", "two again")
    expect(again.returncode == 0 and "of centre" in again.stdout and crawler("report", "two").returncode == 0, f"the scene that was written: {again.stderr}")
    both = crawler(*words[:2], "three.prm", *words[2:-1], "both kinds")
    expect(both.returncode == 0 and crawler("report", "both kinds").returncode == 0, f"a comparison with two kinds: {both.stderr}")
    lines = pathlib.Path("centre.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    pathlib.Path("fewer.csv").write_text("".join(lines[:-1]), encoding="utf-8")
    for more, phrase in ((("--data", "fit_worm.csv", "--data", "centre.csv"), "2 of them are expected, separated by commas"),
                         (("--data", "fit_worm.csv", "--data", "centre.csv", "--set", "Fit/Standard deviation=0.01, automatic"), 'deviation of "centre.csv" is not known'),
                         (("--data", "fit_worm.csv", "centre.csv"), '"--data" is expected before each'),
                         (("--set", "Fit/Data=centre.csv; fit_worm.csv; centre.csv"), "one file of each kind is expected"),
                         ((*words[2:4], "--resume"), "deviation was"), ((*words[2:5], "fewer.csv", *words[6:-2], "--resume"), "other data")):
        refused(crawler("fit", "fit_worm.prm", *more, "--output", "two" if "--resume" in more else "refused"), phrase)


def resumes():
    """A fit that is stopped or killed leaves what it has found, and goes on to the result of an undisturbed one, as does one on
    several processes; nothing else is gone on with."""
    pathlib.Path("three.prm").write_text("include fit_worm.prm\nsubsection Fit\n  set Variables = Body/Anchoring exponent : 0.5 to 5\n  set Starts = 3\nend\n",
                                         encoding="utf-8")
    ended = crawler(*THREE, "--output", "whole")
    expect(ended.returncode == 0, f"three starts end with {ended.returncode}: {ended.stderr}")
    whole = contents("whole")
    n_steps = 1200  # in the third start
    for place, code, status in ((f"step:{n_steps}:TERM", 5, "stopped"), ("step:200:USR1", 5, "stopped"), (f"step:{n_steps}:KILL", 3, None),
                                ("step:1:TERM", 5, "stopped")):
        shutil.rmtree("part", ignore_errors=True)
        ended = crawler(*THREE, "--output", "part", stop_at=place)
        expect(ended.returncode == code and ended.stderr.count("\n") == 1, f"{place}: {ended.returncode}, {ended.stderr}")
        summary = pathlib.Path("part/summary.json")
        left = json_of(summary) if summary.exists() else {"status": None}
        expect(left["status"] == status and ("--resume continues" in ended.stderr or code == 3), f"{place} leaves {left['status']}: {ended.stderr}")
        if status and str(n_steps) in place:
            expect(len(left["starts"]) == 2 and all(one["value"] is not None and one["deviation"] is None for one in left["variables"].values())
                   and "(so far)" in ended.stdout, f"{place}: {left}")
        for command in ("report", "plot") if status else ():
            ended, has_values = crawler(command, "part"), "variables" in left
            expect(ended.returncode == 0 if has_values or command == "report" else ended.returncode == 2 and left["message"] in ended.stderr,
                   f"{command} of a fit that was stopped: {ended.stderr}")
        refused(crawler(*THREE, "--output", "part"), "--resume continues")
        ended = crawler(*THREE, "--output", "part", "--resume")
        expect(ended.returncode == 0 and contents("part") == whole, f"{place} and --resume: {ended.stderr}")
        expect(("2 of 3 starts" in ended.stdout) == (str(n_steps) in place), f"{place}: --resume searches again: {ended.stdout}")
    ended = crawler(*THREE, "--output", "shared", "--workers", "2", stop_at="step:700:KILL")  # in a second start
    expect(ended.returncode == 5 and json_of("shared/summary.json")["message"] in ended.stderr
           and "--resume continues" in ended.stderr, f"a process that is killed: {ended.returncode}, {ended.stderr}")
    ended = crawler(*THREE, "--output", "shared", "--workers", "2", "--resume")
    expect(ended.returncode == 0 and contents("shared") == whole, f"two processes find something else: {ended.stderr}")
    with subprocess.Popen([PROGRAM, *THREE, "--output", "orphan"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        while "start 1 of 3" not in process.stdout.readline():
            expect(process.poll() is None, "three starts end before the first")
        process.kill()
        process.stdout.read()  # comes to its end when the part in Python has ended, too
    summary = pathlib.Path("orphan/summary.json")
    expect(not summary.exists() or json_of(summary)["status"] == "stopped", "a program that is killed leaves its fit behind")
    ended = crawler(*THREE, "--output", "orphan", "--resume")
    expect(ended.returncode == 0 and contents("orphan") == whole, f"--resume behind a program that was killed: {ended.stderr}")
    with subprocess.Popen([PROGRAM, *THREE, "--output", "early"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        children = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
        while process.poll() is None and not children.read_text(encoding="ascii"):
            pass
        process.kill()  # before the part in Python looks for the program
        process.stdout.read()
    early = pathlib.Path("early/summary.json")
    expect(not early.exists() or json_of(early)["status"] == "stopped", "a program that is killed at once leaves its fit behind")
    for workers in ("1", "2"):  # processes that wait, and cannot end in order, hold the folder no longer than the program lives
        shutil.rmtree("held", ignore_errors=True)
        held = (*THREE, "--output", "held", "--workers", workers)
        with subprocess.Popen([PROGRAM, *held], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment("step:200:STOP")) as process:
            while process.poll() is None and not pathlib.Path("held/inputs.json").exists():
                pass
            process.kill()
            process.wait()
            ended = crawler(*held, "--resume")
            expect(ended.returncode == 0 and contents("held") == whole, f"--resume at once behind a kill, {workers} processes: {ended.returncode}, {ended.stderr}")
            process.stdout.read()  # comes to its end if no process is left
    pathlib.Path("part/starts/1.json").write_text("{", encoding="utf-8")
    pathlib.Path("part/summary.json").unlink()
    ended = crawler(*THREE, "--output", "part", "--resume")
    expect(ended.returncode == 0 and "2 of 3" in ended.stdout and contents("part") == whole, f"a damaged start: {ended.stderr}")
    ended = call(["bash", "-c", f"'{PROGRAM}' {' '.join(THREE)} --output unread | head -n 1; exit ${{PIPESTATUS[0]}}"], os.getcwd())
    expect(ended.returncode == 0 and not ended.stderr and contents("unread") == whole, f"a reader that leaves: {ended.returncode}, {ended.stderr}")
    ended = call(["bash", "-c", f"'{PROGRAM}' {' '.join(THREE)} --output unread --resume > /dev/full"], os.getcwd())
    expect(ended.returncode == 6 and "standard output" in ended.stderr and contents("unread") == whole, f"no place for the text: {ended.stderr}")
    fewer = crawler("fit", "three.prm", "--set", "Fit/Starts=2", "--output", "part", "--resume")
    expect(fewer.returncode == 0 and "start 3" not in fewer.stdout and "2 of 2" in fewer.stdout, f"fewer starts: {fewer.stdout}{fewer.stderr}")
    lines = pathlib.Path("fit_worm.csv").read_text(encoding="utf-8").splitlines(keepends=True)
    pathlib.Path("other.csv").write_text("".join(lines[:-1]), encoding="utf-8")
    shutil.copy("fit_worm.csv", "same.csv")
    expect(crawler(*THREE, "--output", "part", "--resume", "--data", "same.csv", "--quiet").returncode == 0, "the same data in another file are refused")
    for arguments, phrase in ((("--set", "Body/Length=3.1"), "Body/Length was 3 and is 3.1"), (("--data", "other.csv"), "other data"),
                              (("--overwrite",), "contradict"), (("--output", "run"), "no fit that can be resumed")):
        refused(crawler(*THREE, "--output", "part", "--resume", *arguments), phrase)


def resumes_a_comparison():
    """One that is stopped in the second scene says which is finished; nothing foreign is written over."""
    words = ("fit", "three.prm", "fit_worm.prm", "--set", "Fit/Starts=1", "--output", "stopped")
    ended = crawler(*words, stop_at="step:1500:TERM")
    expect(ended.returncode == 5 and "fit_worm.prm:" in ended.stdout, f"stopped in the second: {ended.stdout}{ended.stderr}")
    for command in ("report", "plot"):
        refused(crawler(command, "stopped"), "finished: three.prm,", "fit_worm.prm", "--resume")
    refused(crawler(*words), "--resume continues")
    ended = crawler(*words, "--resume")
    expect(ended.returncode == 0 and "1 of 1 starts" in ended.stdout and crawler("plot", "stopped").returncode == 0, f"--resume of a comparison: {ended.stderr}")
    for option, phrase in ((None, "not empty"), ("--overwrite", "not the folder of a comparison"), ("--resume", "no comparison that can be resumed")):
        ended = crawler("fit", "fit_worm.prm", "three.prm", "--output", "other", *filter(None, [option]))
        expect(ended.returncode == 2 and phrase in ended.stderr and not pathlib.Path("other/three").exists(), f"a comparison beside a foreign file: {ended.stderr}")
    ended = crawler("fit", "fit_worm.prm", "three.prm", "--output", "new", "--set", "Active stress/Travelling wave/Amplitude=3",
                    "--set", "Fit/Variables=Active stress/Travelling wave/Amplitude : 3 to 4")
    expect(ended.returncode == 2 and "fit_worm.prm: the scene cannot be run" in ended.stderr and not pathlib.Path("new").exists(), f"no scene runs: {ended.stderr}")


STOPPER = """import os, signal, sys
class Stopper:
    def find_spec(self, name, path=None, target=None):
        if name == os.environ["STOP_AT"] and ("--multiprocessing-fork" in sys.orig_argv) == (os.environ["STOP_IN"] == "worker"):
            number = getattr(signal, os.environ["STOP_BY"])
            if os.environ["STOP_IN"] == "dead":
                signal.pthread_sigmask(signal.SIG_UNBLOCK, [number])
                signal.signal(number, signal.SIG_DFL)
                os.kill(os.getpid(), number)
            os.killpg(0, number)
sys.meta_path.insert(0, Stopper())
"""


def stops_while_it_loads():
    """A signal to the whole group while modules are loaded, in the program's Python or in its workers, ends a fit in order; so does
    the death of Python by one."""
    pathlib.Path("stopper").mkdir()
    pathlib.Path("stopper/sitecustomize.py").write_text(STOPPER + "Stopper().find_spec('sitecustomize')\n", encoding="utf-8")
    for module in ("sitecustomize", "argparse", "scipy.stats", "crawler.fitting.starts"):
        for where, names in (("main", ("SIGINT", "SIGTERM", "SIGUSR1")), ("worker", ("SIGINT", "SIGUSR1")), ("dead", ("SIGINT",))):
            for name in names if where != "worker" or module in ("argparse", "crawler.fitting.starts") else ():
                ended = call([PROGRAM, *THREE, "--output", "early", "--workers", "2"], os.getcwd(), start_new_session=True, restore_signals=True,
                             variables={"PYTHONPATH": os.path.abspath("stopper"), "STOP_AT": module, "STOP_BY": name, "STOP_IN": where})
                expect(ended.returncode == 5 and ended.stderr.count("\n") == 1 and "stopped by a signal" in ended.stderr and "\\x0a" not in ended.stderr,
                       f"{name} while {module} is loaded ({where}): {ended.returncode}, {ended.stderr}")
                shutil.rmtree("early", ignore_errors=True)


def overwrites():
    """Earlier results are lost when new ones are there, not before: a refusal, a stop or a kill brings them back or leaves them aside."""
    no_run = sets({"Active stress/Travelling wave/Amplitude": 0.79, "Body/Elastic modulus": 0.31})
    both = (*THREE, "fit_worm.prm")
    for words, place, inner in ((THREE, "step:700:TERM", "."), (both, "step:1500:TERM", "three")):
        ended = crawler(*words, "--output", "kept", "--set", "Fit/Starts=2")
        whole = contents("kept")
        for name in whole:
            os.utime(pathlib.Path("kept", name), (0, 0))  # as of another day: the files themselves come back
        def is_kept():
            return not list(pathlib.Path("kept").rglob("replaced*")) and contents("kept") == whole and pathlib.Path("kept/summary.json").stat().st_mtime == 0
        again = (*words, "--output", "kept", "--set", "Fit/Starts=3")
        ended = crawler(*again, *no_run, "--overwrite")
        expect(ended.returncode == 2 and ended.stderr.count("\n") == 1 and is_kept(), f"--overwrite without a run: {ended.returncode}, {ended.stderr}")
        ended = crawler(*words, "--output", "kept", "--set", "Fit/Starts=1", *no_run, "--overwrite")
        expect(ended.returncode == 2 and "cannot be run at the start" in ended.stderr and "inverted" not in ended.stdout and is_kept(), f"a start without a run: {ended.stdout}{ended.stderr}")
        ended = crawler(*again, "--overwrite", stop_at="step:1:TERM")
        expect(ended.returncode == 5 and "the earlier results stay" in ended.stderr and is_kept(), f"--overwrite and a stop: {ended.returncode}, {ended.stderr}")
        ended = crawler(*again, "--overwrite", stop_at=place)
        expect(ended.returncode == 5 and contents(f"kept/{inner}/replaced") == contents_of(whole, inner), f"--overwrite and a stop behind values: {ended.returncode}, {ended.stderr}")
        expect(('"kept/replaced"' in ended.stderr) == (words is THREE), f"it is not said where the earlier results are: {ended.stderr}")
        ended = crawler(*again, *no_run, "--overwrite")
        expect(ended.returncode == 2 and is_kept(), f"--overwrite without a run, behind a stop: {ended.returncode}, {ended.stderr}")
        ended = crawler(*again, "--overwrite", stop_at=place.replace("TERM", "KILL"))
        expect(ended.returncode == 3 and contents(f"kept/{inner}/replaced") == contents_of(whole, inner), f"--overwrite and a kill: {ended.returncode}, {ended.stderr}")
        ended = crawler(*again, "--resume")
        expect(ended.returncode == 0 and not list(pathlib.Path("kept").rglob("replaced*")) and len(json_of(f"kept/{inner}/summary.json")["starts"]) == 3, f"--resume behind a kill: {ended.stderr}")
        shutil.rmtree("kept")
    crawler(*THREE, "--output", "kept")
    whole = contents("kept")
    pathlib.Path("kept/replaced.part").mkdir()
    for name in ("summary.json", "inputs.json", "starts"):
        pathlib.Path("kept", name).rename(pathlib.Path("kept/replaced.part", name))
    ended = crawler(*THREE, "--output", "kept", "--resume")
    expect(ended.returncode == 0 and "3 of 3 starts" in ended.stdout and contents("kept") == whole, f"a move that was interrupted: {ended.stdout}{ended.stderr}")


def contents_of(whole, inner):
    """Those of contents() that are in a folder within it."""
    return whole if inner == "." else {name.removeprefix(f"{inner}/"): content for name, content in whole.items() if name.startswith(f"{inner}/")}


def refuses():
    """Every mistake is one sentence and a code, and nothing is lost."""
    pathlib.Path("other").mkdir()
    pathlib.Path("other/kept.txt").write_text("mine", encoding="utf-8")
    shutil.copy("fit_worm.prm", "other")
    before = pathlib.Path("output-fit_worm/summary.json").read_bytes()
    for arguments, code, phrase in REFUSED:
        more = [] if "--output" in arguments or code == 2 and "--overwrite" in phrase else ["--output", "new"]
        ended = crawler("fit", *arguments, *more)
        refused(ended, phrase, code=code)
    for variables, code, phrase in (("Body/Elastic modulus : 0.3 to 4", 0, "Fit: 1 unknown, from"), ("Body/Friction profile[1] : 0.3 to 4", 2, "numbers at equally spaced places")):
        ended = crawler("check", "fit_worm.prm", "--set", f"Fit/Variables={variables}")
        expect(ended.returncode == code and phrase in ended.stdout + ended.stderr, f"check of {variables}: {ended.stdout}{ended.stderr}")
    expect(pathlib.Path("output-fit_worm/summary.json").read_bytes() == before and pathlib.Path("other/kept.txt").exists()
           and not pathlib.Path("new").exists(), "a refusal changes something")


def main(folder):
    os.chdir(folder)
    for name in ("fit_worm.prm", "fit_worm.csv"):
        shutil.copy(STUDIES / name, name)
    ended = crawler("fit", "fit_worm.prm")
    expect(ended.returncode == 0, f"the example ends with {ended.returncode}: {ended.stderr}")
    summary = json_of("output-fit_worm/summary.json")
    for name, value in TRUTH.items():
        one = summary["variables"][name]
        expect(abs(one["value"] - value) < 4 * one["deviation"] and one["interval_95"][0] < one["value"] < one["interval_95"][1],
               f"{name} = {one}, but {value} made the data")
        expect(f"{name} " in ended.stdout and f"{one['value']:.6g} +- {one['deviation']:.2g}" in ended.stdout, f"{name} is not printed")
    rows = csv_rows("output-fit_worm/residuals.csv")
    squares = sum(float(row["residual"]) ** 2 for row in rows) / 0.01 ** 2
    expect(len(rows) == summary["goodness"]["n_data"] and abs(squares / summary["goodness"]["chi_square"] - 1) < 1e-4, "residuals and chi-square differ")
    expect(matplotlib.image.imread("output-fit_worm/fit.png").shape[0] > 300, "there is no picture")
    pathlib.Path("output-fit_worm/fit.png").unlink()
    expect(crawler("plot", "output-fit_worm").returncode == 0 and pathlib.Path("output-fit_worm/fit.png").exists(), "plot draws no fit")
    again = crawler("fit", "output-fit_worm/fitted.prm", "--output", "again")  # it starts where the first one ended
    other = json_of("again/summary.json")["variables"]
    expect(again.returncode == 0 and all(abs(other[name]["value"] - summary["variables"][name]["value"]) < 0.02 * other[name]["deviation"] for name in TRUTH),
           "the scene that was written fits otherwise")
    refuses()
    compares_only_what_is_weighed_alike()
    pathlib.Path("plain.prm").write_text("include fit_worm.prm\nsubsection Body\n  set Anchoring exponent = 0\nend\nsubsection Fit\n"
                                         "  set Variables = Body/Elastic modulus : 0.3 to 4; Active stress/Travelling wave/Amplitude : 0.02 to 0.8\nend\n",
                                         encoding="utf-8")
    both = crawler("fit", "plain.prm", "fit_worm.prm", "--output", "both")
    order = re.findall(r"^(plain|fit_worm)\.prm +\d", both.stdout, re.M)
    expect(both.returncode == 0 and order == ["fit_worm", "plain"] and "does not fit" in both.stdout, f"the comparison is {order}: {both.stderr}")
    rows = csv_rows("both/comparison.csv")
    summary = json_of("both/summary.json")
    inner = json_of("both/plain/summary.json")
    expect([one["scene"] for one in rows] == ["fit_worm.prm", "plain.prm"] and float(rows[1]["aic"]) == inner["information"]["aic"]
           and float(rows[0]["bic_less_least"]) == 0 and summary["comparison"][1]["chi_square"] == inner["goodness"]["chi_square"], f"its table is {rows}")
    expect(all({"seconds", "versions", "command_line"} <= one.keys() and "crawler" in one["versions"] for one in (summary, inner)), "what was run is not said")
    pathlib.Path("both/comparison.png").unlink()
    for arguments, code, phrase in ((("plot", "both"), 0, "comparison.png"), (("report", "both"), 0, "comparison"), (("plot", "both", "--output", "x.xyz"), 2, ".xyz"),
                                    (("fit", "plain.prm", "again/fitted.prm", "--output", "both"), 2, "--overwrite")):
        ended = crawler(*arguments)
        expect(ended.returncode == code and phrase in ended.stdout + ended.stderr, f"{arguments}: {ended.returncode}, {ended.stderr}")
    expect(matplotlib.image.imread("both/comparison.png").shape[0] > 200, "there is no picture of the comparison")
    quiet = crawler("fit", "fit_worm.prm", "--overwrite", "--quiet")
    expect(quiet.returncode == 0 and quiet.stdout == "", "--quiet prints")
    ended = crawler("run", "fit_worm.prm", "--output", "run")
    expect(ended.returncode == 0 and 'section "Fit" has no effect with "crawler run"' in ended.stdout, f"a run does not note section Fit: {ended.stdout}")
    resumes()
    stops_while_it_loads()
    overwrites()
    resumes_a_comparison()
    fits_two_kinds_together()


checks.run((main,))
