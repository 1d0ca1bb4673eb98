#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler plot and paper: pick the script that fits a folder, pass options on, find a Python that can draw, and say what is
missing. Each picture must have names, symbols and units on its axes, and a part of the time must be that part.

    python3 plot.py PATH_TO_CRAWLER

Each script is called by the program once; in most checks of pictures it runs in a fork of this process, which has loaded
matplotlib already.
"""
import os
import pathlib
import re
import shutil
import sys
import tempfile

import matplotlib.image

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from pictures import draw, words  # noqa: E402
from program import NO_PICTURES, call, checks, expect, prm, refused  # noqa: E402
from tables import csv_rows, json_of  # noqa: E402

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]
STUDY = prm("Accuracy=1e-3", "Time/End time=0.5",
            "Sweep/Axes=Body/Anchoring exponent : 2, 3; Body/Elastic modulus : 1, 2, 4",
            "Tradeoff/Formulations=position", "Tradeoff/Meshes=uniform", "Tradeoff/Engines=fused", "Tradeoff/Degrees=4",
            "Tradeoff/Tolerances=1e-3, 1e-6", "Tradeoff/Repetitions=1")
CALIBRATION = "accuracy,true_error,reported_error,wanted_error,reference_bar\n" + "".join(
    f"{accuracy},{0.1 * accuracy * size},{0.3 * accuracy * size * spread},{accuracy * size},{1e-9 * accuracy}\n"
    for accuracy in (1e-3, 1e-6) for size in (0.1, 1) for spread in (0.5, 1, 2))
# Folder: command, arguments, the pictures in the folder, what stands in them.
STUDIES = {
    "run": ("run", "prm/paper/fig_2.prm", ["--set", "Time/End time=3", "--set", "Output/Sensitivities=Body/Length",
                                           "--set", "Active stress/Optimal wave/Choose wave by=wave speed"],
            ["kymograph.png"]),
    "sweep": ("sweep", "study.prm", [], ["results.png", "results.svg"]),
    "checked": ("sweep", "study.prm", ["--set", "Sweep/Cross-check=true"], ["results.png", "results.svg"]),
    "tradeoff": ("tradeoff", "study.prm", [], ["tradeoff.png", "tradeoff.svg"]),
    "optimum": ("optimize", "prm/studies/optimize_harmonics.prm", [], ["optimize.png"]),
    "scaling": ("sweep", "prm/studies/scaling.prm", [], ["results.png", "results.svg"])}
# Folder, options, what stands in the picture.
WORDS = [
    ("run", [], [r"position $\zeta$ [length]", "material coordinate $s$ [length]", "time $t$ [time]", "stretch $w$ [1]",
                 "$D$ [length]"]),
    ("run", ["--stress"], ["active stress $m$ [force]", "stretch $w$ [1]"]),
    ("run", ["--kind", "sensitivity"], ["material coordinate $s$ [length]", "time $t$ [time]", "change of the displacement $D$ [%]",
                                        r"$\partial D/\partial m(s,t)$ [1/(force time)]"]),
    ("sweep", [], ["Anchoring exponent $p$ [1]", "Elastic modulus $k$ [force]", "displacement $D$ [length]"]),
    ("sweep", ["--lines", "--value", "stress_power"], ["stress power $W$ [force length]"]),
    ("checked", [], ["Anchoring exponent $p$ [1]", "Elastic modulus $k$ [force]", "finished: 6"]),
    ("checked", ["--value", "error ratio"], ["error ratio [1]"]),
    ("tradeoff", [], ["processor time of a run [s]", "relative error of the displacement $D$ [1]"]),
    ("optimum", [], ["strain $w-1$ [1]", "active stress $m$ [force]", "merit [1]", "time $t$ [time]"]),
    ("scaling", ["--kind", "scaling"], ["mass $M$ [g]", r"stride frequency $\nu$ [1/s]", "speed $U L$ [mm/s]"]),
    ("calibration.csv", [], ["true error / displacement $D$ [1]", "reported error / true error [1]"])]
# The script of a folder or file; with --kind it is that one.
SCRIPTS = {"run": "kymograph", "named": "kymograph", "no_stride": "kymograph", "sweep": "sweep", "checked": "sweep", "tradeoff": "tradeoff",
           "unreadable": "tradeoff", "optimum": "optimize", "scaling": "sweep", "calibration.csv": "calibration"}
# Arguments of crawler plot, exit code, what the one sentence has.
REFUSED = [
    ([], 2, "the folder is missing"), (["nowhere"], 2, '"nowhere" is not a folder'), (["--output", "picture", "run"], 2, '"--output" is before the folder'),
    (["empty"], 2, "has nothing to draw"), (["run", "--kind", "kymogaph"], 2, '"kymograph"'),
    (["run", "--", "-ts_monitor"], 2, "takes no PETSc options"), (["run", "--lastt-stride"], 2, "--lastt-stride"),
    (["many.csv"], 2, '"many.csv" has 4 columns, but s, t and m (or strain) are expected'),
    (["run", "--output", "no/picture.png"], 6, "no/picture.png")]
# The same of scripts.
REFUSED_BY_SCRIPTS = [
    (["run", "--kind", "sweep"], 2, "results.h5"), (["sweep", "--kind", "kymograph"], 2, "has two rows at least"),
    (["run", "--from", "soon"], 2, "soon"), (["run", "--from", "2", "--to", "1"], 2, "from 2 to 1"),
    (["run", "--to", "4"], 2, "from 0 to 4"), (["run", "--from", "1", "--to", "1.001"], 2, "has 1 times"),
    (["run", "--last-stride", "--to", "1"], 2, "only one of the two"), (["no_stride", "--last-stride"], 2, "has no stride"),
    (["run", "--output", "picture.doc"], 2, ".png, .svg or .pdf"),
    (["sweep", "--kind", "tradeoff"], 2, "the output folder of crawler tradeoff is expected"), (["unreadable", "--kind", "tradeoff"], 6, "cannot read"),
    (["optimum", "--optimum", "2"], 2, "the number of a case is expected: 1"), (["calibration.csv", "--value", "x"], 2, "--value")]


def crawler(*arguments, **variables):
    return call([PROGRAM, *arguments], variables=variables)


def drawn(folder, *options):
    """What crawler plot would start: its exit code and what it printed."""
    options = list(options)
    kind = SCRIPTS[folder]
    if "--kind" in options:
        at = options.index("--kind")
        kind = options[at + 1]
        del options[at:at + 2]
    end = draw(f"{kind}.py", folder, *options)
    return end.returncode, end.stdout + end.stderr


def make_folders():
    pathlib.Path("study.prm").write_text(STUDY, encoding="utf-8")
    pathlib.Path("many.csv").write_text("t,a,b,c\n0,1,2,3\n", encoding="utf-8")
    pathlib.Path("calibration.csv").write_text(CALIBRATION, encoding="utf-8")
    pathlib.Path("empty").mkdir()
    pathlib.Path("unreadable/tradeoff.csv").mkdir(parents=True)
    for folder, (command, file, more, _) in STUDIES.items():
        path = ROOT / file if (ROOT / file).is_file() else file
        end = crawler(command, path, "--output", folder, "--quiet", *more, **NO_PICTURES)
        expect(end.returncode == 0, f"crawler {command} {file}: {end.returncode} {end.stderr.strip()}")
    end = crawler("run", ROOT / "prm/examples/expression.prm", "--output", "no_stride", "--quiet", "--set", "Time/End time=0.4")
    expect(end.returncode == 0, f"a run without a stride: {end.stderr.strip()}")


def test_pictures():
    """By default into the folder; with the right words."""
    for folder, (_, _, _, pictures) in STUDIES.items():
        for picture in pictures:
            pathlib.Path(folder, picture).unlink(missing_ok=True)
        end = crawler("plot", folder)
        said = [f"wrote {folder}/{picture}" for picture in pictures]
        expect(end.returncode == 0 and end.stdout.splitlines()[: len(said)] == said, f"plot {folder}: {end.stdout} {end.stderr}")
        image = matplotlib.image.imread(f"{folder}/{pictures[0]}")[:, :, :3]
        expect(image.shape[1] > 700 and image.std() > 0.05, f"{folder}/{pictures[0]} is not blank: {image.shape}, {image.std():.2f}")
        expect(folder != "run" or "--kind sensitivity" in end.stdout, "the other picture of a run is named")
    end = crawler("plot", "calibration.csv")
    expect(end.returncode == 0 and pathlib.Path("calibration.png").is_file(), f"calibration.png lies beside its table {end.stderr}")
    for folder, options, wanted in WORDS:
        own = STUDIES.get(folder, ((), (), (), ()))[3]
        if not options and f"{own[-1:]}".count(".svg"):  # it has been drawn already
            code, printed, texts = 0, "", words(f"{folder}/{own[-1]}")
        else:
            code, printed = drawn(folder, *options, "--output", "picture.svg")
            texts = words("picture.svg") if code == 0 else []
        missing = [word for word in wanted if not any(word in text for text in texts)]
        expect(code == 0 and not missing, f"plot {folder} {' '.join(options)}: without {missing} {printed}")


def test_times():
    """Numbers at the axes belong to the chosen part."""
    for options, there, away in ((["--last-stride"], ("2.2", "2.8"), ("0.5", "1.5")),
                                 (["--from", "0.5", "--to", "1.5"], ("0.6", "1.4"), ("2.0", "2.5")),
                                 (["--to", "2"], ("0.5", "1.5"), ("2.5", "3.0"))):
        for kind in ("kymograph", "sensitivity"):
            code, printed = drawn("run", "--kind", kind, *options, "--output", "part.svg")
            texts = words("part.svg") if code == 0 else []
            numbers = {float(text) for text in texts if re.fullmatch(r"[\d.]+", text)}
            expect(code == 0 and all(float(number) in numbers for number in there),
                   f"{kind} {' '.join(options)} has the times {there}: {printed}")
            if kind == "kymograph":
                expect(not any(number in texts for number in away), f"{kind} {' '.join(options)} has not the times {away}")


def test_units():
    """Units that the user has named stand at the axes."""
    shutil.copytree("run", "named")
    path = pathlib.Path("named/parameters.prm")
    before, units = path.read_text(encoding="utf-8").split("subsection Units")
    for word, name in (("length", "mm"), ("time", "s"), ("force", "mN")):
        units = re.sub(rf"= {word}\b", f"= {name}", units)
    path.write_text(f"{before}subsection Units{units}", encoding="utf-8")
    code, printed = drawn("named", "--stress", "--output", "named.svg")
    texts = " ".join(words("named.svg")) if code == 0 else ""
    expect(code == 0 and all(word in texts for word in ("[mm]", "time $t$ [s]", "active stress $m$ [mN]")) and "[time]" not in texts,
           f"units of the user: {texts} {printed}")
    end = crawler("paper", "named")
    expect("\ndisplacement,mm," in pathlib.Path("named/paper/numbers.csv").read_text(encoding="utf-8"), f"units of numbers.csv: {end.stderr}")


def test_copied_program():
    """A copy of the program alone says where its scripts are looked for."""
    shutil.copy(PROGRAM, "copied")
    end = call(["./copied", "plot", "run"])
    refused(end, "__main__.py is neither ", f"{pathlib.Path.cwd()}/python/crawler/__main__.py")
    pathlib.Path("copied").unlink()


def test_screen():
    """ParaView's scripts say that there is no screen, where VTK would abort; both are played here."""
    for path, text in (("paraview/__init__.py", ""), ("paraview/simple.py", ""), ("vtkmodules/__init__.py", ""),
                       ("vtkmodules/vtkRenderingCore.py", "class vtkRenderWindow:\n    def GetClassName(self):\n"
                                                          "        return 'vtkXOpenGLRenderWindow'\n")):
        pathlib.Path("played", path).parent.mkdir(parents=True, exist_ok=True)
        pathlib.Path("played", path).write_text(text, encoding="utf-8")
    folders = f"{pathlib.Path.cwd()}/played:{ROOT / 'contrib/paraview'}"
    for display, word in (("", "DISPLAY is not set"), (":4711", "DISPLAY=:4711 does not answer")):
        end = call(["/usr/bin/python3", "-B", "-c", "import ctypes.util; assert ctypes.util.find_library('X11'), 'no X11'\n"
                    "import crawler_view; crawler_view.new_view([640, 480])"], variables={"PYTHONPATH": folders, "DISPLAY": display})
        expect("no X11" in end.stderr or (end.returncode == 2 and word in end.stderr and "xvfb-run -a pvbatch" in end.stderr
                                          and end.stderr.count("\n") == 1), f"no screen: {end.returncode} {end.stderr.strip()}")


def test_part_of_its_own():
    """The picture of a part leaves that of the whole as it is; the program passes on the options."""
    before = pathlib.Path("run/kymograph.png").read_bytes()
    end = crawler("plot", "run", "--last-stride")
    expect(end.returncode == 0 and pathlib.Path("run/kymograph_last_stride.png").is_file(), f"--last-stride: {end.stderr}")
    code, printed = drawn("run", "--from", "0.5", "--to", "1.5")
    expect(code == 0 and pathlib.Path("run/kymograph_from_0.5_to_1.5.png").is_file(), f"--from 0.5 --to 1.5: {printed}")
    end = crawler("plot", "run", "--kind", "sensitivity", "--output", "passed.svg")
    expect(end.returncode == 0 and any("change of the displacement" in text for text in words("passed.svg")),
           f"--kind: {end.stderr}")
    expect(pathlib.Path("run/kymograph.png").read_bytes() == before, "the picture of the whole run stays")


def test_bad_input():
    """One sentence, and nothing is drawn."""
    for arguments, code, word in REFUSED:
        end = crawler("plot", *arguments)
        refused(end, "crawler: ", word, code=code)
        expect("wrote" not in end.stdout, f"plot {' '.join(arguments)}: {end.stdout}")
    for arguments, code, word in REFUSED_BY_SCRIPTS:
        found, printed = drawn(*arguments)
        expect(found == code and printed.count("\n") == 1 and word in printed and re.match(r"\w+\.py: ", printed),
               f"{' '.join(arguments)}: {found} {printed[-300:]}")
    for arguments, word in (([], "--kind"), (["sweep"], "--where")):
        end = crawler("plot", *arguments, "--help")
        expect(end.returncode == 0 and word in end.stdout, f"plot {' '.join(arguments)} --help tells of {word}")
    code, printed = drawn("run", "--help")
    expect(code == 0 and "--last-stride" in printed, f"help of a run: {printed}")


def test_paper():
    """crawler paper: size and fonts of the figure, numbers with their bounds."""
    summary = json_of("run/summary.json")
    for words, width, height in ((["run"], 86, 80), (["run", "--columns", "2", "--last-stride", "--stress", "--height", "90"], 178, 90),
                                 (["sweep", "--lines", "--value", "stress_power"], 86, 80), (["checked", "--columns", "2"], 178, 70)):
        shutil.rmtree("printed", ignore_errors=True)
        end = crawler("paper", *words, "--output", "printed")
        expect(end.returncode == 0 and end.stdout.splitlines() == [f"wrote printed/{name}" for name in ("figure.pdf", "numbers.csv", "numbers.tex")],
               f"paper {' '.join(words)}: {end.returncode} {end.stdout} {end.stderr}")
        figure = pathlib.Path("printed/figure.pdf").read_bytes()
        box = [float(number) * 25.4 / 72 for number in re.search(rb"/MediaBox \[ 0 0 (\S+) (\S+) \]", figure).groups()]
        expect(max(abs(box[0] - width), abs(box[1] - height)) < 0.1, f"the figure has {box} mm, expected {width} x {height}")
        expect(b"/FontFile2" in figure and b"/Type3" not in figure, "fonts are embedded, as outlines")
        rows = csv_rows("printed/numbers.csv")
        table = pathlib.Path("printed/numbers.tex").read_text(encoding="utf-8")
        cells = [line.removesuffix(r" \\").split(" & ") for line in table.splitlines() if line.endswith(r" \\")]
        expect(len(cells) == len(rows) + 1 and len({len(line) for line in cells}) == 1, f"rows of the table: {len(cells)}, of the CSV file {len(rows)}")
        if words[0] == "run":
            known = {row["number"]: (float(row["value"]), float(row["bound"])) for row in rows}
            expect(known["displacement"] == (summary["displacement"], summary["displacement_error"]["total"]) and
                   known["gait.speed"] == (summary["gait"]["speed"], summary["errors"]["gait"]["speed"]), f"numbers of summary.json: {known}")
            expect(all(round_trip(line[1], *known[row["number"]]) for line, row in zip(cells[1:], rows)), f"numbers for LaTeX: {cells}")
            expect(cells[1][0] == "displacement $D$ [length]", f"names and units: {cells[1][0]}")
        elif words[0] == "sweep":
            points = [(float(row["stress_power"]), float(row["errors.stress_power"])) for row in csv_rows("sweep/results.csv")]
            found = [(float(row["stress_power"]), float(row["bound"])) for row in rows]
            expect(len(found) == 6 and all(abs(one / other - 1) < 1e-6 for mine, theirs in zip(found, points) for one, other in zip(mine, theirs)), f"values of the sweep: {found}")
            expect(all(round_trip(line[-1], *one) for line, one in zip(cells[1:], found)), f"points for LaTeX: {cells}")
        else:
            expect([line[-1] for line in cells] == ["outcome", *["finished"] * 6], f"outcomes: {cells}")
    for arguments, code, word in (([], 2, "DIR missing"), (["nowhere"], 2, '"nowhere" is not a folder'), (["empty"], 2, "summary.json"),
                                  (["optimum"], 2, "an optimisation, but that of a run or sweep"), (["run", "--columns", "3"], 2, "one of 1, 2"),
                                  (["run", "--height", "5"], 2, "from 20 to 250"), (["run", "--lastt-stride"], 2, '"--last-stride"'),
                                  (["sweep", "--value", "nothing"], 2, "nearest"), (["run", "--output", "no/where"], 6, "no/where")):
        end = crawler("paper", *arguments)
        refused(end, "crawler: ", word, code=code)
        expect("wrote" not in end.stdout, f"paper {' '.join(arguments)}: {end.stdout}")


def round_trip(text, value, bound):
    """Whether a number for LaTeX is this value, and its bound this one, to the digits that the bound leaves."""
    match = re.fullmatch(r"\$\(?(-?[\d.]+) \\pm ([\d.]+)\)?(?: \\times 10\^{(-?\d+)})?\$", text)
    scale = 10.0 ** int(match[3] or 0) if match else 1
    return bool(match) and abs(float(match[1]) * scale - value) <= 0.06 * bound and abs(float(match[2]) * scale / bound - 1) <= 0.06


def test_python(folder):
    """A Python without modules hands over to Debian's; if that lacks one too, both are named."""
    expect(call([sys.executable, "-m", "venv", "--without-pip", "bare"]).returncode == 0, "a Python without modules is made")
    bare = f"{folder}/bare/bin"
    pathlib.Path("run/kymograph.png").unlink()
    end = crawler("plot", "run", PATH=f"{bare}:{os.environ['PATH']}")
    expect(end.returncode == 0 and pathlib.Path("run/kymograph.png").is_file() and end.stderr == "",
           f"a Python without modules comes first: {end.stderr.strip()}")
    pathlib.Path("blind").mkdir()
    pathlib.Path("blind/h5py.py").write_text("raise ImportError\n", encoding="utf-8")
    end = crawler("plot", "sweep", PATH=f"{bare}:{os.environ['PATH']}", PYTHONPATH=f"{folder}/blind")
    refused(end, f"{bare}/python3 has no numpy and no matplotlib; /usr/bin/python3 has no h5py "
            "(on Debian: apt install python3-h5py)")
    end = crawler("plot", "run", PYTHONPATH=f"{folder}/blind")
    expect(end.returncode == 0, f"a run needs no h5py: {end.stderr.strip()}")
    for script in sorted((ROOT / "contrib/python/crawler/plot").glob("*.py")):
        first = script.read_text(encoding="utf-8").splitlines()[0]
        expect(script.name == "plotting.py" or first == "#!/usr/bin/env python3", f"{script.name} runs with any Python: {first}")


def main():
    with tempfile.TemporaryDirectory(suffix=" $(x); 'y'") as folder:
        os.chdir(folder)
        make_folders()
        test_pictures()
        test_times()
        test_part_of_its_own()
        test_units()
        test_copied_program()
        test_screen()
        test_bad_input()
        test_paper()
        test_python(folder)
        os.chdir("/")
    checks.end()


main()
