# SPDX-License-Identifier: LGPL-2.1-or-later
"""The Python package as a guest in someone's process: the sentences of its errors, Ctrl-C, threads, memory that does
not grow, nothing on the screen; and that it runs where it is installed.

    python3 behaviour.py PATH_TO_CRAWLER FOLDER_OF_THE_PACKAGE CMAKE
"""
import contextlib
import io
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import warnings

PROGRAM, PACKAGE = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:3])
sys.path.insert(0, PACKAGE)
import crawler  # noqa: E402

ENVIRONMENT = dict(os.environ, PYTHONPATH=PACKAGE)
FILE = pathlib.Path(__file__).resolve().parents[2] / "prm/paper/fig_s1.prm"
K = "Body/Elastic modulus"
LONG = {"Accuracy": 1e-9, "Active stress": {"Generator": "expression",
                                            "Expression": {"Active stress": "0.3*sin(2*pi*(s+t))*cos(0.1*t)"}},
        "Time": {"End time": 10000}}
INVERTS = {"Active stress": {"Generator": "expression", "Expression": {"Active stress": "3*sin(2*pi*(s+t))"}}}
failures = []


def expect(condition, what):
    """Notes what is wrong."""
    if not condition:
        failures.append(what)


def refused(action, kind, *words):
    """The action raises this error, whose text has these words."""
    try:
        action()
    except kind as error:
        for word in words:
            expect(word in str(error), f'"{word}" is not in "{error}"')
        return error
    failures.append(f"not refused: {words}")


def check_errors(folder):
    bad = folder / "bad.prm"
    bad.write_text("subsection Body\n  set Lenght = 2\nend\n")
    error = refused(lambda: crawler.run(bad), crawler.InputError, f"{bad}, line 2", "Lenght", '"Length"')
    ended = subprocess.run([PROGRAM, "check", bad], capture_output=True, text=True)
    expect(ended.stderr.strip() == f"crawler: {error}", f"the program says {ended.stderr}, Python {error}")
    expect(isinstance(error, ValueError), "InputError is not a ValueError")
    refused(lambda: crawler.run({"Body": {"Lenght": 2}}), crawler.InputError, "scene, line 2", "Lenght")
    refused(lambda: crawler.run(FILE, set={K: -1}), crawler.InputError, f'--set "{K}=-1"', "a positive number")
    refused(lambda: crawler.run(FILE, set={K: [1, 2]}), crawler.InputError, K, "1, 2")
    refused(lambda: crawler.run(FILE, set={K: None}), crawler.InputError, K, "None", "a number")
    refused(lambda: crawler.run(FILE, set={"Output/Sensitivities": "a # b"}), crawler.InputError, "comment")
    refused(lambda: crawler.run("no.prm"), crawler.FileError, "no.prm", "there is no such file")
    expect(issubclass(crawler.FileError, OSError), "FileError is not an OSError")
    refused(lambda: crawler.run(3), crawler.InputError, "the scene is 3")
    refused(lambda: crawler.run({}), crawler.InputError, "sets nothing")
    refused(lambda: crawler.run(FILE, elastic_modul=2), crawler.InputError, "elastic_modul", '"elastic_modulus"')
    refused(lambda: crawler.run(FILE, amplitude=2), crawler.InputError, "amplitude", '"Active stress/', "full name")
    for times in ([0, 2], [0.5, 0.5], [-1], [float("nan")]):
        refused(lambda: crawler.run(FILE, fields=times), crawler.InputError, "times of the fields", "end time 1 ")
    refused(lambda: crawler.run(FILE, fields=[0.5], output=folder / "x"), crawler.InputError, '"output"')
    refused(lambda: crawler.run(FILE, output=folder), crawler.InputError, str(folder), "not empty")
    refused(lambda: crawler.run(FILE, output="/proc/x"), crawler.FileError, "/proc/x")
    refused(lambda: crawler.sweep(FILE), crawler.InputError, "Sweep/Axes")
    refused(lambda: crawler.sweep(FILE, {"Body/Lenght": [1]}), crawler.InputError, "Lenght")
    refused(lambda: crawler.sweep(FILE, {"Body/Friction profile": ['"']}), crawler.InputError, "double quotes")
    refused(lambda: crawler.batch([FILE, {"Body/Length": -1}]), crawler.InputError, "Body/Length")
    refused(lambda: crawler.batch({"Body/Length": 1}), crawler.InputError, "a list of scenes is expected")
    refused(lambda: crawler.check(FILE, set={"Model": "linear"}), crawler.InputError, "linear")
    refused(lambda: crawler.read(folder), crawler.FileError, "summary.json")
    refused(lambda: crawler.run(FILE, fields=False).gait.spede, AttributeError, "spede", "speed")
    (folder / "summary.json").write_text('{"status": "finished"}')
    (folder / "kymograph.vts").write_text("<no/>")
    refused(lambda: crawler.read(folder), crawler.FileError, "kymograph.vts", "not a kymograph")
    expect(crawler.check(FILE)["Accuracy"] == 1e-6, "check() gives other entries")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        crawler.run(FILE, fields=False, set={"Active stress/Expression/Active stress": "sin(t)"})
    expect(len(caught) == 1 and "has no effect" in str(caught[0].message) and caught[0].filename == __file__,
           f"warnings {[str(one) for one in caught]}")


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
    error = refused(lambda: crawler.run(INVERTS, check=True), crawler.RunFailed, result.reason, "t = ")
    expect(error.result == result or error.result.status == "inverted", "RunFailed has no result")
    expect([one.status for one in crawler.batch([FILE, INVERTS])] == ["finished", "inverted"], "a batch of both")
    refused(lambda: crawler.batch([FILE, INVERTS], check=True), crawler.RunFailed)


def interrupts(action):
    """Seconds from Ctrl-C to KeyboardInterrupt."""
    threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    start = time.perf_counter()
    try:
        action()
    except KeyboardInterrupt:
        return time.perf_counter() - start - 0.5
    return float("nan")


def check_signals(folder):
    handler = signal.getsignal(signal.SIGINT)
    for name, action in (("run", lambda: crawler.run(LONG, fields=False)),
                         ("batch", lambda: crawler.batch([LONG] * 4)),
                         ("sweep", lambda: crawler.sweep(LONG, {K: "linspace(1, 2, 100)"})),
                         ("run with files", lambda: crawler.run(LONG, fields=False, output=folder / "stopped"))):
        seconds = interrupts(action)
        expect(-0.1 < seconds < 5, f"Ctrl-C in {name}: KeyboardInterrupt after {seconds} s")
    expect(signal.getsignal(signal.SIGINT) is handler, "the handler of signals is another one")
    seconds = interrupts(lambda: time.sleep(3))  # the handler is Python's again
    expect(seconds < 1, f"Ctrl-C in Python: {seconds}")
    expect(crawler.run(FILE, fields=False).status == "finished", "no run after Ctrl-C")


def check_threads():
    """Python goes on while a run computes, and runs of several threads wait for each other."""
    count, results = [0], []
    threads = [threading.Thread(target=lambda: results.append(crawler.run(FILE).displacement)) for _ in range(4)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        count[0] += 1
        time.sleep(1e-4)
    expect(len(results) == 4 and len(set(results)) == 1, f"threads: {results}")
    expect(count[0] > 5, "Python stands still while a run computes")


def resident():
    """MiB."""
    pages = int(pathlib.Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def check_memory():
    """2000 runs: what a leak of 1 kB in each would add is seen."""
    sizes = []
    for n in range(2001):
        crawler.run(FILE, fields=n % 10 == 0, set={K: 1 + 1e-4 * n})
        if n % 500 == 0:
            sizes.append(resident())
    expect(sizes[-1] - sizes[1] < 1.5, f"memory after 0, 500, ... runs: {sizes} MiB")


def check_silence():
    """Nothing is printed, not by the C++ part either; --verbose prints through Python, where notebooks see it."""
    script = (f"import crawler; f = {str(FILE)!r}; crawler.run(f); crawler.batch([f]); "
              f"crawler.sweep(f, {{{K!r}: [1, 2]}})")
    ended = subprocess.run([sys.executable, "-c", script], env=ENVIRONMENT, capture_output=True, text=True)
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
        ended = subprocess.run([sys.executable, "-c", script.format(before=before, after=after, file=str(FILE))],
                               env=ENVIRONMENT, capture_output=True, text=True)
        expect(ended.returncode == 0, f"{before} {after}: {ended.stderr}")
    small = FILE.parents[1] / "examples/small_wave.prm"
    script = (f"import crawler, ctypes; r = crawler.run({str(small)!r}, set={{'Model': 'perturbation', 'Accuracy': 0.01}}); "
              "flag = ctypes.c_int(); ctypes.CDLL('libmpi.so.40').MPI_Initialized(ctypes.byref(flag)); "
              "assert r.model == 'perturbation' and not flag.value, 'MPI was started'")
    ended = subprocess.run([sys.executable, "-c", script], env=ENVIRONMENT, capture_output=True, text=True)
    expect(ended.returncode == 0, f"the series: {ended.stderr}")


def check_installed(folder):
    subprocess.run([sys.argv[3], "--install", pathlib.Path(PACKAGE).parent, "--prefix", folder / "there", "--component",
                    "python"], check=True, stdout=subprocess.DEVNULL)
    (place,) = (folder / "there").glob("lib/python3.*/dist-packages")
    script = f"import crawler; assert crawler.__file__.startswith({str(folder)!r}); print(crawler.run({str(FILE)!r}))"
    ended = subprocess.run([sys.executable, "-c", script], env=dict(os.environ, PYTHONPATH=str(place)),
                           capture_output=True, text=True)
    expect(ended.stdout.startswith("<crawler.Result: finished"), f"installed: {ended}")


def main():
    with tempfile.TemporaryDirectory() as name:
        os.chdir(name)
        check_errors(pathlib.Path(name))
        check_axes()
        check_ends()
        check_signals(pathlib.Path(name))
        check_threads()
        check_silence()
        check_imports()
        check_installed(pathlib.Path(name))
        check_memory()
        os.chdir("/")
    sys.exit("\n".join(failures) or 0)


if __name__ == "__main__":
    main()
