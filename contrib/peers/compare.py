#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures crawler and short programs of our own with other tools on the same work, and prints
the table of doc/peers.md with the settings.

    contrib/peers/compare.py [build] [--only NAME ...] [--cases NAME ...]

NAME of a peer: IDA, PETSc, SciPy, FEniCSx, Octave, crawler; of a case: s1, fig2, stiff, sweep. A peer that is not
installed is skipped by name; SIGINT skips the rest of one. Every peer takes the cheapest setting that a search over its
methods, degrees, cells and tolerances finds, whose true error is below the wanted one; tolerances of 0.5 and 0.25 times
its own must reach the error as well, so that none wins by luck. Times are of the processor, without the start of the program. The true
displacements are those of contrib/reference/crawler_reference.py, in the sweep those of fine runs by SciPy.
"""
import argparse
import dataclasses
import datetime
import math
import os
import pathlib
import platform
import re
import resource
import signal
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
sys.path += [str(SOURCE / "contrib"), str(SOURCE / "contrib/reference")]
sys.dont_write_bytecode = True
ERRORS = ("1e-4", "1e-6", "1e-9")
CASES = {"s1": (-1, 0.4, 1, 1), "fig2": (-1, 0.4, 1, 20), "stiff": (-1, 0.3, 100, 1)}  # a, chi, k, T
ROWS = [("s1", error) for error in ERRORS] + [("fig2", "1e-6"), ("stiff", "1e-6"), ("sweep", "1e-4"), ("sweep", "1e-6")]
TITLES = {"s1": "Fig. S1", "fig2": "Fig. 2", "stiff": "STIFF", "sweep": "SWEEP"}
EXPONENTS, CHIS = [-3 + 2.5 * i / 39 for i in range(40)], [0.05 + 0.4 * i / 24 for i in range(25)]
SMALLEST = 0.004  # tolerance that is tried, relative to the wanted error
FLAGS = "-O3 -march=native -fno-math-errno -fno-trapping-math -fno-signed-zeros -fassociative-math".split()
ELEMENTS = [(q, n) for q in (4, 5, 6) for n in (2, 3, 4, 5, 6, 8, 12, 16)]  # degree, cells
POINTS = [(q, 1) for q in (8, 10, 12, 14, 16, 20, 24, 28, 34, 40, 48, 56)]


@dataclasses.dataclass
class Peer:
    """How a peer is made and asked; see body.h for the lines."""
    name: str
    methods: tuple
    sizes: list
    command: list
    build: tuple = ()
    version: tuple = ()
    end: str = "\n"  # of a line
    process: subprocess.Popen = None
    words: str = ""

    def start(self, folder):
        """Whether it is installed: it is built, started, and solves a small body."""
        self.command = [word.replace("FOLDER", str(folder)) for word in self.command]
        try:
            if self.build:
                subprocess.run([word.replace("FOLDER", str(folder)) for word in self.build], check=True, capture_output=True)
            self.words = subprocess.run(self.version, check=True, capture_output=True, text=True).stdout.split("\n")[0].strip()
            self.process = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                            text=True)
            return math.isfinite(self.ask(self.methods[0], CASES["stiff"], self.sizes[3], 1e-4)[0])
        except (OSError, subprocess.CalledProcessError):
            return False

    def ask(self, method, body, size, tolerance, repeat=1):
        """Displacement and seconds of one run; not a number if it fails."""
        self.process.stdin.write(" ".join(map(repr, body)).join((method + " ", f" {size[0]} {size[1]} {tolerance:.6g} {repeat}{self.end}")))
        self.process.stdin.flush()
        answer = self.process.stdout.readline().split()
        return (float(answer[0]), float(answer[1])) if len(answer) == 2 else (math.nan, math.inf)


def peers():
    """All of them."""
    petsc = ("sh", "-c", f"mpicc {' '.join(FLAGS)} {HERE}/petsc.c -o FOLDER/petsc $(pkg-config --cflags --libs PETSc) -lm")
    python = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else sys.executable  # Debian's, which has the packages
    return [
        Peer("IDA", ("ida",), ELEMENTS, ["FOLDER/ida"],
             ("cc", *FLAGS, str(HERE / "ida.c"), "-o", "FOLDER/ida", "-lsundials_ida", "-lsundials_nvecserial", "-lm"),
             ("sh", "-c", "echo '#include <sundials/sundials_config.h>\nSUNDIALS_VERSION' | cc -E -P - | tail -1 | tr -d '\"'")),
        Peer("PETSc", ("bdf5", "bdf4"), ELEMENTS, ["FOLDER/petsc"], petsc,
             ("pkg-config", "--modversion", "PETSc")),
        Peer("SciPy", ("lsoda", "bdf", "radau"), POINTS, [python, str(HERE / "scipy_peer.py")], (),
             (python, "-c", "import scipy; print(scipy.__version__)")),
        Peer("FEniCSx", ("bdf5",), [size for size in ELEMENTS if size[0] in (4, 6)],
             [python, str(HERE / "fenicsx_peer.py")], (), (python, "-c", "import dolfinx; print(dolfinx.__version__)")),
        Peer("Octave", ("lsode", "ode15s"), POINTS, ["octave-cli", "-q", "--no-history", str(HERE / "octave_peer.m")], (),
             ("octave-cli", "-q", "--eval", "disp(version)"), end="\n\n")]  # fgetl waits for what follows a line


def in_words(setting):
    """For the table."""
    method, (degree, cells), tolerance = setting
    return f"{method}, {f'degree {degree}, {cells} cells' if cells > 1 else f'{degree + 1} points'}, tolerance {tolerance:.1e}"


def leading_order(body):
    """The displacement of the series in a stride, which sets the scale of tolerances."""
    return abs(body[0]) / 2 * body[1] ** 2


def try_setting(peer, bodies, exact, setting):
    """Largest relative error and seconds of all bodies; the tolerance is relative to the displacement of leading order."""
    method, size, tolerance = setting
    worst = seconds = 0.0
    for body in bodies:
        value, time = peer.ask(method, body, size, tolerance * leading_order(body))
        error = abs(value / exact[body] - 1)
        if not error < math.inf:
            return math.inf, math.inf
        worst, seconds = max(worst, error), seconds + time
    return worst, seconds


def candidates(peer, bodies, exact, wanted):
    """(seconds, setting) of settings that reach the error, the cheapest first."""
    found, best = [], math.inf
    for method in peer.methods:
        for size in sorted(peer.sizes, key=math.prod):
            tolerance, passed = 30 * wanted, []
            if try_setting(peer, bodies, exact, (method, size, tolerance))[1] > 1.3 * best:
                continue  # smaller tolerances would be slower still
            if try_setting(peer, bodies, exact, (method, size, SMALLEST * wanted))[0] > wanted:
                continue  # too coarse in space
            while tolerance > SMALLEST * wanted:
                error, seconds = try_setting(peer, bodies, exact, (method, size, tolerance))
                if seconds > 1.3 * best:
                    break
                passed = passed + [(seconds, (method, size, tolerance))] if error <= wanted else []
                if len(passed) == 3:
                    found.append(passed[0])
                    best = min(best, passed[0][0])
                    break
                tolerance *= 0.5
    return sorted(found)


def fastest(peer, bodies, exact, setting):
    """Seconds a run, the best of three."""
    return min(try_setting(peer, bodies, exact, setting)[1] for _ in range(3)) / len(bodies)


def measure_case(peer, case, wanted, exact):
    """Seconds a run and the setting, or None."""
    bodies = [CASES[case]]
    found = []
    for _, setting in candidates(peer, bodies, exact, wanted)[:3]:
        method, size, tolerance = setting
        once = try_setting(peer, bodies, exact, setting)[1]
        repeat = max(1, int(0.3 / once))
        found.append((min(peer.ask(method, bodies[0], size, tolerance * leading_order(bodies[0]), repeat)[1] for _ in range(3)), setting))
    return min(found) if found else None


def measure_sweep(peer, wanted, exact):
    """Each half of the chi has its setting, as the engine has: found with some of the scenes, made finer until it is true
    for all of them."""
    seconds, settings = 0.0, []
    for half in (CHIS[:12], CHIS[12:]):
        bodies = [(a, chi, 1, 1) for a in EXPONENTS for chi in half]
        some = [(a, chi, 1, 1) for a in (EXPONENTS[0], EXPONENTS[20], EXPONENTS[-1]) for chi in (half[0], half[-1])]
        settings_found = (found for aim in (1, 0.5, 0.25) for found in candidates(peer, some, exact, aim * wanted)[:20])
        for _, (method, size, tolerance) in settings_found:
            error, time = try_setting(peer, bodies, exact, (method, size, tolerance))
            if error <= wanted:
                break
        else:
            return None
        seconds += min(time, try_setting(peer, bodies, exact, (method, size, tolerance))[1])
        settings.append((method, size, tolerance))
    return seconds / (len(EXPONENTS) * len(CHIS)), settings


def references(cases):
    """The true displacements, and how certain those of the sweep are."""
    import crawler_reference
    import scipy_peer
    exact = {CASES[case]: crawler_reference.reference(crawler_reference.optimal_wave(chi, 1, elastic_modulus=k), a, T, k)["displacement"]
             for case, (a, chi, k, T) in CASES.items() if case in cases}
    if "sweep" not in cases:
        return exact, None
    bodies = [(a, chi, 1, 1) for a in EXPONENTS for chi in CHIS]
    fine, finer = ({body: scipy_peer.run("lsoda", *body, degree, 1e-10 * leading_order(body)) for body in bodies} for degree in (56, 64))
    for a, chi, k, T in bodies[::-666]:  # by another method
        value = crawler_reference.reference(crawler_reference.optimal_wave(chi, 1), a, T)["displacement"]
        fine[a, chi, k, T] = fine[a, chi, k, T] if abs(value / finer[a, chi, k, T] - 1) < 1e-7 else math.nan
    differences = [abs(fine[body] / finer[body] - 1) for body in bodies]
    return exact | finer, max(differences) if all(map(math.isfinite, differences)) else math.inf


def delivered_sweep(crawler, wanted, exact):
    """`crawler sweep` of the points less that of one point: seconds of the processor a run, and the largest true error."""
    import csv
    scene = f"set Accuracy = {wanted}\nsubsection Active stress\n subsection Optimal wave\n  set Choose wave by = wave speed\n end\nend\n"
    chi, p = "Active stress/Optimal wave/Perturbation parameter", "Body/Anchoring exponent"
    seconds = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, axes in (("one", f"{p} : 2; {chi} : 0.1"), ("all", f"{p} : linspace(1.5, 4, 40); {chi} : linspace(0.05, 0.45, 25)")):
            file = pathlib.Path(folder, name + ".prm")
            file.write_text(scene + f"subsection Sweep\n set Axes = {axes}\nend\n", encoding="utf-8")
            times = []
            for _ in range(3):
                before = resource.getrusage(resource.RUSAGE_CHILDREN)
                subprocess.run([crawler, "sweep", file, "--output", f"{folder}/{name}", "--overwrite", "--quiet"], check=True)
                after = resource.getrusage(resource.RUSAGE_CHILDREN)
                times.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
            seconds[name] = min(times)
        with open(f"{folder}/all/results.csv", newline="", encoding="utf-8") as table:
            rows = list(csv.DictReader(table))
    known = sorted(exact)
    nearest = lambda row: min((b for b in known if b[2:] == (1, 1)),
                              key=lambda b: abs(b[0] - 1 + float(row[p])) + abs(b[1] - float(row[chi])))
    error = max(abs(float(row["displacement"]) / exact[nearest(row)] - 1) for row in rows)
    return (seconds["all"] - seconds["one"]) / (len(rows) - 1), error


def measure_crawler(build, cases, exact):
    """{row: {"engine, one body", "engine, side by side", "delivered": (seconds, words)}} by crawler_benchmark and crawler sweep."""
    import benchmark
    places = {"s1": ("run/fused/{}", "run/batch/{}", "answer/run/{}"), "stiff": ("case/stiff/{}/fused", "case/stiff/{}/batch", "answer/stiff/{}"),
              "fig2": ("case/fig2/{}/fused", "case/fig2/{}/batch", "answer/fig2/{}"), "sweep": (None, "sweep/{}", None)}
    wanted = {(case, error): [name and name.format(error) for name in places[case]] for case, error in ROWS if case in cases}
    names = "|".join(name for row in wanted.values() for name in row if name)
    found = benchmark.measure(str(build / "tests/benchmark/crawler_benchmark"), f"^({names})$", 3)
    results = {}
    for (case, error), row in wanted.items():
        results[case, error] = {column: (1 / found[name]["rate"], f"{found[name]['label']}; true error {found[name]['error']:.0e}")
                                for column, name in zip(("one body", "side by side", "delivered"), row) if name}
        if case == "sweep":
            seconds, true = delivered_sweep(build / "crawler", error, exact)
            results[case, error]["delivered"] = (seconds, f"crawler sweep; largest true error {true:.0e}")
    return results


def processor():
    """Its name."""
    text = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
    return re.search(r"model name\s*:\s*(.*)", text).group(1)


def number(seconds):
    """Two digits."""
    return "-" if seconds is None else f"{seconds:.1e}".replace("e-0", "e-")


def table(results, names):
    """The Markdown."""
    columns = [name for name in names if name != "crawler"] + ["crawler, one body", "crawler, side by side", "crawler, delivered"]
    lines = ["| case, relative error | " + " | ".join(columns) + " |", "|---" * (len(columns) + 1) + "|"]
    for case, error in results:
        row = results[case, error]
        lines.append(f"| {TITLES[case]}, {error} | " + " | ".join(number(row[c][0] if row.get(c) else None) for c in columns) + " |")
    lines += ["", "The settings, and for crawler the errors that they reach:", "", "| case, relative error | program | setting |", "|---|---|---|"]
    for (case, error), row in results.items():
        lines += [f"| {TITLES[case]}, {error} | {name} | {row[name][1]} |" for name in columns if row.get(name)]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=pathlib.Path, default=SOURCE / "build")
    parser.add_argument("--only", nargs="+", choices=[*(peer.name for peer in peers()), "crawler"], help="names of programs")
    parser.add_argument("--cases", nargs="+", choices=[*CASES, "sweep"])
    o = parser.parse_args()
    os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    signal.signal(signal.SIGINT, signal.default_int_handler)  # in the background, too
    cases = o.cases or [*CASES, "sweep"]
    try:
        exact, certainty = references(cases)
    except ImportError as missing:
        sys.exit(f"the true displacements need NumPy and SciPy (Debian: python3-scipy): {missing}")
    if certainty is not None:
        print(f"displacements of the sweep are known to {certainty:.0e}", flush=True)
        if not certainty < 1e-7:
            sys.exit("that is not enough for errors of 1e-6")
    results, names, skipped = {row: {} for row in ROWS if row[0] in cases}, [], []
    with tempfile.TemporaryDirectory() as folder:
        for peer in peers():
            if o.only and peer.name not in o.only:
                continue
            if not peer.start(folder):
                skipped.append(peer.name)
                print(f"{peer.name} is not installed: skipped", flush=True)
                continue
            names.append(f"{peer.name} {peer.words}".strip())
            try:
                for case, error in results:
                    found = measure_sweep(peer, float(error), exact) if case == "sweep" else measure_case(peer, case, float(error), exact)
                    if found:
                        words = "; ".join(map(in_words, found[1])) if case == "sweep" else in_words(found[1])
                        results[case, error][names[-1]] = (found[0], words)
                    print(f"{names[-1]}, {case}, {error}: {f'{found[0]:.3g} s' if found else 'not reached'}", flush=True)
            except (KeyboardInterrupt, OSError):  # OSError: it has ended
                print(f"{names[-1]}: the rest is skipped", flush=True)
            peer.process.kill()
            peer.process.wait()
    program = o.build / "tests/benchmark/crawler_benchmark"
    if (not o.only or "crawler" in o.only) and program.exists():
        for row, columns in measure_crawler(o.build, cases, exact).items():
            results[row].update({f"crawler, {column}": value for column, value in columns.items()})
    elif not program.exists():
        print(f"{program} does not exist: crawler is skipped (cmake --build build --target studies makes it)")
    made = (f"Seconds of processor time a run on one core of {processor()}, {platform.freedesktop_os_release()['PRETTY_NAME']}, "
            f"{datetime.date.today()}." + (f" Not installed: {', '.join(skipped)}." if skipped else ""))
    text = made + "\n\n" + table(results, names)
    print("\n" + text)


if __name__ == "__main__":
    main()
