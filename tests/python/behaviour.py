# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Python package as a guest in someone's process: the sentences of its errors, Ctrl-C, threads, memory that does
not grow, nothing on the screen.

    python3 behaviour.py PATH_TO_CRAWLER FOLDER_OF_THE_PACKAGE
"""
import contextlib
import io
import os
import pathlib
import sys
import threading

PROGRAM, PACKAGE = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])
sys.path[:0] = [PACKAGE, str(pathlib.Path(__file__).resolve().parents[1] / "support")]
import crawler  # noqa: E402
import numpy as np  # noqa: E402
from program import call, checks, expect, warnings_of  # noqa: E402

FILE = pathlib.Path(__file__).resolve().parents[2] / "prm/paper/fig_s1.prm"
K = "Body/Elastic modulus"
LONG = {"Accuracy": 1e-9, "Active stress": {"Generator": "expression",
                                            "Expression": {"Active stress": "0.3*sin(2*pi*(s+t))*cos(0.1*t)"}},
        "Time": {"End time": 10000}}
INVERTS = {"Active stress": {"Generator": "expression", "Expression": {"Active stress": "3*sin(2*pi*(s+t))"}}}


def python(script, stop_at=None, **variables):
    """Another interpreter that has the package; it ends at os._exit, whatever its threads do."""
    return call([sys.executable, "-c", script], stop_at=stop_at, variables={"PYTHONPATH": PACKAGE, **variables})


def raises(action, kind, *words):
    """The action raises this error, whose text has these words."""
    try:
        action()
    except kind as error:
        for word in words:
            expect(word in str(error), f'"{word}" is not in "{error}"')
        return error
    expect(False, f"not refused: {words}")
    return None


def check_errors(folder):
    bad = folder / "bad.prm"
    bad.write_text("subsection Body\n  set Lenght = 2\nend\n")
    error = raises(lambda: crawler.run(bad), crawler.InputError, f"{bad}, line 2", "Lenght", '"Length"')
    ended = call([PROGRAM, "check", bad])
    expect(ended.stderr.strip() == f"crawler: {error}", f"the program says {ended.stderr}, Python {error}")
    expect(isinstance(error, ValueError), "InputError is not a ValueError")
    raises(lambda: crawler.run({"Body": {"Lenght": 2}}), crawler.InputError, "scene, line 2", "Lenght")
    raises(lambda: crawler.run(FILE, set={K: -1}), crawler.InputError, f'--set "{K}=-1"', "a positive number")
    raises(lambda: crawler.run(FILE, set={K: [1, 2]}), crawler.InputError, K, "1, 2")
    raises(lambda: crawler.run(FILE, set={K: None}), crawler.InputError, K, "None", "a number")
    raises(lambda: crawler.run(FILE, set={"Output/Sensitivities": "a # b"}), crawler.InputError, "comment")
    raises(lambda: crawler.run("no.prm"), crawler.FileError, "no.prm", "there is no such file")
    expect(issubclass(crawler.FileError, OSError), "FileError is not an OSError")
    raises(lambda: crawler.run(3), crawler.InputError, '"scene" is 3, but a text, a path or a dict is expected')
    for action, words in ((lambda: crawler.run({3: 2}), "the entry 3 is set"), (lambda: crawler.run(FILE, set={3: 2}), "the entry 3 is set"),
                          (lambda: crawler.run(FILE, set=["a"]), "\"set\" is ['a'], but a dict or None is expected"),
                          (lambda: crawler.run(FILE, fields="yes"), "\"fields\" is 'yes', but True or False or a list"),
                          (lambda: crawler.run(FILE, check="x"), '"check" is'), (lambda: crawler.run(FILE, output=3), '"output" is 3'),
                          (lambda: crawler.batch(3), '"scenes" is 3'), (lambda: crawler.batch("x"), '"scenes" is'), (lambda: crawler.sweep(FILE, [K]), '"axes" is'),
                          (lambda: crawler.run(FILE, fields=["a"]), "a list of numbers"), (lambda: crawler.run(FILE, fields=[0.5], places=[True]), "a list of numbers"), (lambda: crawler.run(FILE, fields=[0.5], places=[]), "a list of numbers"),
                          (lambda: crawler.run(FILE, fields=np.array(0.5)), '"fields" is array(0.5)'), (lambda: crawler.sweep(FILE, {3: [1]}), "the entry 3 is set"),
                          (lambda: crawler.sweep(FILE, {K: {1: 2}}), "a number, a text"), (lambda: crawler.to_prm({"Body": 3, "Body/Length": 2}), "is no section"),
                          (lambda: crawler.to_prm({"Body": {"Length": 1}, "Body/Length": 2}), "is set twice"), (lambda: crawler.run(FILE, output=""), '"output" is empty'),
                          (lambda: crawler.read(None), '"folder" is None'), (lambda: crawler.to_prm("a"), '"scene" is'),
                          (lambda: crawler.plot(folder / "no"), "is not a folder"), (lambda: crawler.plot(folder, kind="map"), '"--kind" is "map"'),
                          (lambda: crawler.report(folder / "no"), "does not exist"), (lambda: crawler.paper(folder / "no"), "no")):
        raises(action, crawler.InputError, words)
    raises(lambda: crawler.gradient(FILE, K, of="foo"), crawler.InputError, '"foo"', "displacement, stress_power", "gait.speed")
    raises(lambda: crawler.run({}), crawler.InputError, "sets nothing")
    raises(lambda: crawler.run(FILE, elastic_modul=2), crawler.InputError, "elastic_modul", '"elastic_modulus"')
    raises(lambda: crawler.run(FILE, amplitude=2), crawler.InputError, "amplitude", '"Active stress/', "full name")
    for times in ([0, 2], [0.5, 0.5], [-1], [float("nan")]):
        raises(lambda: crawler.run(FILE, fields=times), crawler.InputError, "times of the fields", "end time 1 ")
    raises(lambda: crawler.run(FILE, fields=[0.5], output=folder / "x"), crawler.InputError, '"output"')
    raises(lambda: crawler.run(FILE, output=folder), crawler.InputError, str(folder), "not empty")
    raises(lambda: crawler.run(FILE, output="/proc/x"), crawler.FileError, "/proc/x")
    raises(lambda: crawler.sweep(FILE), crawler.InputError, "Sweep/Axes")
    raises(lambda: crawler.sweep(FILE, {"Body/Lenght": [1]}), crawler.InputError, "Lenght")
    raises(lambda: crawler.sweep(FILE, {"Body/Friction profile": ['"']}), crawler.InputError, "double quotes")
    raises(lambda: crawler.batch([FILE, {"Body/Length": -1}]), crawler.InputError, "scenes[1]", "Body/Length")
    raises(lambda: crawler.run(FILE, set={"Body/Friction profile": [[1, 2], [3, 4]]}), crawler.InputError, "a list in a list")
    raises(lambda: crawler.batch({"Body/Length": 1}), crawler.InputError, "a list of scenes is expected")
    raises(lambda: crawler.check(FILE, set={"Model": "linear"}), crawler.InputError, "linear")
    raises(lambda: crawler.read(folder), crawler.FileError, "summary.json")
    raises(lambda: crawler.run(FILE, fields=False).gait.spede, AttributeError, "spede", "speed")
    (folder / "summary.json").write_text('{"status": ')
    raises(lambda: crawler.read(folder), crawler.FileError, "summary.json", "is damaged")
    (folder / "summary.json").write_text('{"status": "finished"}')
    (folder / "kymograph.vts").write_text("<no/>")
    raises(lambda: crawler.read(folder), crawler.FileError, "kymograph.vts", "not a kymograph")
    expect(crawler.check(FILE)["Accuracy"] == 1e-6, "check() gives other entries")


def check_numbers():
    """Numbers, lists and names of numpy are as good as those of Python, and nested entries as full names."""
    same = crawler.run(FILE, set={"Body": {"Elastic modulus": np.array(2.0)}}, fields=np.bool_(False))
    expect(same.displacement == crawler.run(FILE, elastic_modulus=np.float64(2), fields=False).displacement, "nested entries")
    at = crawler.run(FILE, fields=np.array([0.5, 1]), places=np.linspace(0, 1, 3)).fields
    expect(at.stretch.shape == (2, 3), f"fields at times of an array {at.stretch.shape}")
    expect(len(crawler.gradient(FILE, np.array([K])).derivatives) == 1 and crawler.gradient(FILE, "elastic_modulus").value != 0, "names of an array, a keyword")


def check_pictures(folder):
    """plot, report and paper return the paths of the files that their commands make."""
    run = folder / "drawn"
    crawler.run(FILE, output=run)
    made = [*crawler.plot(run), *crawler.plot(run, output=folder / "part.svg", to=0.5), crawler.report(run), *crawler.paper(run, columns=2)]
    names = ["kymograph.png", "part.svg", "report.html", "figure.pdf", "numbers.csv", "numbers.tex"]
    expect([path.name for path in made] == names and all(path.stat().st_size > 100 for path in made), f"files {made}")
    raises(lambda: crawler.plot(run, output="no/where.png"), crawler.FileError, "no/where.png")
    raises(lambda: crawler.plot(run, kind="tradeoff"), crawler.InputError, "tradeoff.csv")
    os.environ["CRAWLER_PROGRAM"] = sys.executable  # as commands in this process leave it
    expect(crawler.report(run).exists(), "a report after another command")
    del os.environ["CRAWLER_PROGRAM"]
    expect(callable(crawler.report) and set(crawler.__all__) <= set(dir(crawler)) | {"measured"}, "names of the package")


def check_axes():
    """An element of a list is a value of the axis, whatever is in it."""
    for values in (["1, 0.05", "0.9, 0.02"], [[1, 0.05], [0.9, 0.02]]):
        table = crawler.sweep(FILE, {"Active stress/Optimal wave/Sine coefficients": values})
        expect(len(table["displacement"]) == 2, f"{len(table['displacement'])} points of {values}")
    table = crawler.sweep(FILE, {"Body/Friction profile": ["max(1, 2*s)", "1"], "Body/Elastic modulus": "linspace(1, 2, 3)"})
    expect(len(table["displacement"]) == 6, f"{len(table['displacement'])} points")


def check_ends():
    """A body that inverts is a result; with check=True it is an error with that result."""
    result = crawler.run(INVERTS)
    expect(result.status == "inverted" and result.inversion.t > 0 and result.reason and result.message, f"{result!r}")
    expect(result.end_time <= result.inversion.t, f"displacement of t = {result.end_time}, inverted at {result.inversion.t}")
    error = raises(lambda: crawler.run(INVERTS, check=True), crawler.RunFailed, result.reason, "t = ")
    expect(error.result == result or error.result.status == "inverted", "RunFailed has no result")
    expect([one.status for one in crawler.batch([FILE, INVERTS])] == ["finished", "inverted"], "a batch of both")
    raises(lambda: crawler.batch([FILE, INVERTS], check=True), crawler.RunFailed)
    cut = crawler.run(FILE, set={"Time/Wall time limit": 1e-9})
    expect((cut.status, cut.reason) == ("stopped", "time_limit") and "Time/Wall time limit, 1e-09 s" in cut.message, f"{cut!r}: {cut.message}")
    whole = crawler.run(FILE, set={"Time/Wall time limit": 1000})
    expect(whole.status == "finished" and whole.displacement == crawler.run(FILE).displacement, f"{whole!r}")
    texts, _ = warnings_of(lambda: crawler.batch([FILE], set={"Time/Wall time limit": 1e-9}))
    expect(any("Wall time limit\" has no effect" in text for text in texts), f"{texts}")


def check_signals(folder):
    """Ctrl-C in the middle of whatever computes is a KeyboardInterrupt; afterwards all is as before."""
    script = """
import crawler, signal
signal.signal(signal.SIGINT, signal.default_int_handler)  # whoever started the test may ignore it
handler = signal.getsignal(signal.SIGINT)
try:
    {action}
    print("it came to its end")
except KeyboardInterrupt:
    pass
assert signal.getsignal(signal.SIGINT) is handler, "the handler of signals is another one"
try:
    signal.raise_signal(signal.SIGINT)
    print("no KeyboardInterrupt in Python")
except KeyboardInterrupt:
    pass
assert crawler.run({file!r}, fields=False).status == "finished", "no run after Ctrl-C"
"""
    output = str(folder / "stopped")
    for action, step in ((f"crawler.run({LONG}, fields=False)", 50), (f"crawler.run({LONG}, fields=False)", 2000),
                         (f"crawler.batch([{LONG}] * 4)", 500), (f"crawler.sweep({LONG}, {{{K!r}: 'linspace(1, 2, 100)'}})", 500),
                         (f"crawler.run({LONG}, fields=False, output={output!r})", 50)):
        ended = python(script.format(action=action, file=str(FILE)), f"step:{step}:INT")
        expect((ended.returncode, ended.stdout) == (0, ""), f"Ctrl-C at step {step} of {action[:13]}: {ended}")


def check_threads():
    """Python goes on while a run computes, and runs of several threads wait for each other."""
    # The run is far from its end when it tells the main thread that it has come to its 50th step.
    script = f"""
import crawler, os, signal, threading
begun, tell = os.pipe()
os.set_blocking(tell, False)
signal.signal(signal.SIGUSR1, lambda *_: None)
signal.set_wakeup_fd(tell)
thread = threading.Thread(target=lambda: crawler.run({dict(LONG, Time={"End time": 1e7})}, fields=False), daemon=True)
thread.start()
os.read(begun, 1)
print("alive" if thread.is_alive() else "over", flush=True)
os._exit(0)
"""
    ended = python(script, "step:50:USR1")
    expect((ended.returncode, ended.stdout) == (0, "alive\n"), f"Python stands still while a run computes: {ended}")
    results = []
    threads = [threading.Thread(target=lambda: results.append(crawler.run(FILE).displacement)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    expect(len(results) == 4 and len(set(results)) == 1, f"threads: {results}")


def check_memory():
    """What runs leave behind: less than 200 bytes each, as the allocator counts them."""
    script = f"""
import crawler, ctypes, gc
class Info(ctypes.Structure):
    _fields_ = [(name, ctypes.c_size_t) for name in ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks",
                                                     "uordblks", "fordblks", "keepcost")]
mallinfo2 = ctypes.CDLL(None).mallinfo2
mallinfo2.restype = Info
def used(n):
    for i in range(n):
        crawler.run({str(FILE)!r}, fields=i % 10 == 0, set={{{K!r}: 1 + 1e-4 * i}})
    gc.collect()
    return mallinfo2().uordblks + mallinfo2().hblkhd
used(100)
print(used(10), used(100))
"""
    ended = python(script, PYTHONMALLOC="malloc")
    before, after = map(int, ended.stdout.split() or (0, 10**9))
    expect(0 < before and after - before < 200 * 100, f"100 runs leave {after - before} bytes behind, {ended.stderr}")


def check_silence():
    """Nothing is printed, not by the C++ part either; --verbose prints through Python, where notebooks see it."""
    script = (f"import crawler; f = {str(FILE)!r}; crawler.run(f); crawler.batch([f]); "
              f"crawler.sweep(f, {{{K!r}: [1, 2]}})")
    ended = python(script)
    expect((ended.returncode, ended.stdout, ended.stderr) == (0, "", ""), f"it prints {ended}")
    text = io.StringIO()
    with contextlib.redirect_stdout(text):
        crawler.run(FILE, verbose=True)
    expect("displacement      0.0900725" in text.getvalue(), f"verbose prints {text.getvalue()}")


def check_imports():
    """What reads only needs no library of the program; the libraries of others may come before or after."""
    script = """
import crawler, sys
libraries = open("/proc/self/maps").read()
assert "libmpi" not in libraries and "libdeal.ii" not in libraries, "import crawler loads libraries"
{before}
assert crawler.run({file!r}, fields=False).status == "finished"
{after}
"""
    for before, after in (("import h5py, pandas", ""), ("", "import h5py, pandas, scipy.optimize")):
        ended = python(script.format(before=before, after=after, file=str(FILE)))
        expect(ended.returncode == 0, f"{before} {after}: {ended.stderr}")
    small = FILE.parents[1] / "examples/small_wave.prm"
    script = (f"import crawler, ctypes; r = crawler.run({str(small)!r}, set={{'Model': 'perturbation', 'Accuracy': 0.01}}); "
              "flag = ctypes.c_int(); ctypes.CDLL('libmpi.so.40').MPI_Initialized(ctypes.byref(flag)); "
              "assert r.model == 'perturbation' and not flag.value, 'MPI was started'")
    ended = python(script)
    expect(ended.returncode == 0, f"the series: {ended.stderr}")


def main(folder):
    os.chdir(folder)
    check_errors(folder)
    check_pictures(folder)
    check_axes()
    check_numbers()
    check_ends()
    check_signals(folder)
    check_threads()
    check_silence()
    check_imports()
    check_memory()


checks.run((main,))
