#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""crawler plot: picks the script that fits a folder, passes options on, finds a Python that can draw, and says what is
missing. Each picture must have names, symbols and units on its axes, and a part of the time must be that part.

    python3 plot.py PATH_TO_CRAWLER
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import matplotlib.image

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]
STUDY = """
set Accuracy = 1e-3
subsection Sweep
  set Axes = Body/Anchoring exponent : 2, 3; Body/Elastic modulus : 1, 2, 4
end
subsection Atlas
  set First axis = Body/Anchoring exponent : 2, 3
  set Second axis = Body/Elastic modulus : 1, 2
end
subsection Tradeoff
  set Formulations = position
  set Meshes       = uniform
  set Engines      = fused
  set Degrees      = 4
  set Tolerances   = 1e-3, 1e-6
  set Repetitions  = 1
end
"""
CALIBRATION = "accuracy,true_error,reported_error,wanted_error,reference_bar\n" + "".join(
    f"{accuracy},{0.1 * accuracy * size},{0.3 * accuracy * size * spread},{accuracy * size},{1e-9 * accuracy}\n"
    for accuracy in (1e-3, 1e-6) for size in (0.1, 1) for spread in (0.5, 1, 2))
# Folder: command, arguments, the pictures in the folder, what stands in them.
STUDIES = {
    "run": ("run", "prm/paper/fig_2.prm", ["--set", "Time/End time=3", "--set", "Output/Sensitivities=Body/Length",
                                           "--set", "Active stress/Optimal wave/Choose wave by=wave speed"],
            ["kymograph.png"]),
    "sweep": ("sweep", "study.prm", [], ["results.png", "results.svg"]),
    "atlas": ("atlas", "study.prm", [], ["atlas.png", "atlas.svg"]),
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
    ("atlas", [], ["Anchoring exponent $p$ [1]", "Elastic modulus $k$ [force]", "measured error / reported error [1]"]),
    ("tradeoff", [], ["processor time of a run [s]", "relative error of the displacement $D$ [1]"]),
    ("optimum", [], ["strain $w-1$ [1]", "active stress $m$ [force]", "merit [1]", "time $t$ [time]"]),
    ("scaling", ["--kind", "scaling"], ["mass $M$ [g]", r"stride frequency $\nu$ [1/s]", "speed $U L$ [mm/s]"]),
    ("calibration.csv", [], ["true error / displacement $D$ [1]", "reported error / true error [1]"])]
# Arguments of crawler plot, exit code, what the one sentence has.
REFUSED = [
    ([], 2, "the folder is missing"), (["nowhere"], 2, '"nowhere" is not a folder'),
    (["empty"], 2, "has nothing to draw"), (["run", "--kind", "kymogaph"], 2, '"kymograph"'),
    (["run", "--kind", "sweep"], 2, "results.h5"), (["sweep", "--kind", "kymograph"], 2, "kymograph.vts"),
    (["run", "--lastt-stride"], 2, "--lastt-stride"), (["run", "--from", "soon"], 2, "soon"),
    (["run", "--from", "2", "--to", "1"], 2, "from 2 to 1"), (["run", "--to", "4"], 2, "from 0 to 4"),
    (["run", "--from", "1", "--to", "1.001"], 2, "has 1 times"), (["run", "--last-stride", "--to", "1"], 2, "one of the two ways"),
    (["no_stride", "--last-stride"], 2, "has no stride"),
    (["run", "--output", "picture.doc"], 2, ".png, .svg or .pdf"), (["run", "--output", "no/picture.png"], 6, "no/picture.png"),
    (["optimum", "--optimum", "2"], 2, "the number of a case is expected: 1"), (["run", "--", "-ts_monitor"], 2, "no use for PETSc options"),
    (["calibration.csv", "--value", "x"], 2, "--value")]
failures = []


def check(condition, what):
    """Prints what was checked and keeps failures."""
    if not condition:
        failures.append(what)
    print(f"{'ok    ' if condition else 'FAILED'} {what}", flush=True)


def crawler(*arguments, **environment):
    """Runs the program."""
    return subprocess.run([PROGRAM, *map(str, arguments)], env={**os.environ, **environment}, capture_output=True, text=True,
                          timeout=300, check=False)


def words(picture):
    """The texts of a picture in SVG (matplotlib leaves them as comments)."""
    return re.findall(r"<!-- (.*?) -->", pathlib.Path(picture).read_text(encoding="utf-8"), re.DOTALL)


def make_folders():
    """One of each kind."""
    pathlib.Path("study.prm").write_text(STUDY, encoding="utf-8")
    pathlib.Path("calibration.csv").write_text(CALIBRATION, encoding="utf-8")
    pathlib.Path("empty").mkdir()
    for folder, (command, file, more, _) in STUDIES.items():
        path = ROOT / file if (ROOT / file).is_file() else file
        end = crawler(command, path, "--output", folder, "--quiet", *more)
        check(end.returncode == 0, f"crawler {command} {file}: {end.returncode} {end.stderr.strip()}")
    end = crawler("run", ROOT / "prm/examples/expression.prm", "--output", "no_stride", "--quiet", "--set", "Time/End time=0.4")
    check(end.returncode == 0, f"a run without a stride: {end.stderr.strip()}")


def test_pictures():
    """By default into the folder; with the right words."""
    for folder, (_, _, _, pictures) in STUDIES.items():
        for picture in pictures:
            pathlib.Path(folder, picture).unlink(missing_ok=True)
        end = crawler("plot", folder)
        said = [f"wrote {folder}/{picture}" for picture in pictures]
        check(end.returncode == 0 and end.stdout.splitlines()[: len(said)] == said, f"plot {folder}: {end.stdout} {end.stderr}")
        image = matplotlib.image.imread(f"{folder}/{pictures[0]}")[:, :, :3]
        check(image.shape[1] > 700 and image.std() > 0.05, f"{folder}/{pictures[0]} is not blank: {image.shape}, {image.std():.2f}")
    check("--kind sensitivity" in crawler("plot", "run").stdout, "the other picture of a run is named")
    end = crawler("plot", "calibration.csv")
    check(end.returncode == 0 and pathlib.Path("calibration.png").is_file(), f"calibration.png lies beside its table {end.stderr}")
    for folder, options, wanted in WORDS:
        end = crawler("plot", folder, *options, "--output", "picture.svg")
        texts = words("picture.svg") if end.returncode == 0 else []
        missing = [word for word in wanted if not any(word in text for text in texts)]
        check(end.returncode == 0 and not missing, f"plot {folder} {' '.join(options)}: without {missing} {end.stderr.strip()}")


def test_times():
    """Numbers at the axes belong to the chosen part."""
    for options, there, away in ((["--last-stride"], ("2.2", "2.8"), ("0.5", "1.5")),
                                 (["--from", "0.5", "--to", "1.5"], ("0.6", "1.4"), ("2.0", "2.5")),
                                 (["--to", "2"], ("0.5", "1.5"), ("2.5", "3.0"))):
        for kind in ("kymograph", "sensitivity"):
            end = crawler("plot", "run", "--kind", kind, *options, "--output", "part.svg")
            texts = words("part.svg") if end.returncode == 0 else []
            numbers = {float(text) for text in texts if re.fullmatch(r"[\d.]+", text)}
            check(end.returncode == 0 and all(float(number) in numbers for number in there),
                  f"{kind} {' '.join(options)} has the times {there}: {end.stderr}")
            if kind == "kymograph":
                check(not any(number in texts for number in away), f"{kind} {' '.join(options)} has not the times {away}")


def test_part_of_its_own():
    """The picture of a part leaves that of the whole as it is."""
    crawler("plot", "run")
    before = pathlib.Path("run/kymograph.png").read_bytes()
    for options, name in ((["--last-stride"], "kymograph_last_stride.png"),
                          (["--from", "0.5", "--to", "1.5"], "kymograph_from_0.5_to_1.5.png")):
        end = crawler("plot", "run", *options)
        check(end.returncode == 0 and pathlib.Path("run", name).is_file(), f"{' '.join(options)} is {name}: {end.stderr}")
    check(pathlib.Path("run/kymograph.png").read_bytes() == before, "the picture of the whole run stays")


def test_bad_input():
    """One sentence, and nothing is drawn."""
    for arguments, code, word in REFUSED:
        end = crawler("plot", *arguments)
        lines = end.stderr.splitlines()
        check(end.returncode == code and len(lines) == 1 and word in lines[0] and lines[0].startswith("crawler: ")
              and "wrote" not in end.stdout, f"plot {' '.join(arguments)}: {end.returncode} {end.stderr.strip()[-300:]}")
    for arguments, word in (([], "--kind"), (["run"], "--last-stride"), (["sweep"], "--where")):
        end = crawler("plot", *arguments, "--help")
        check(end.returncode == 0 and word in end.stdout, f"plot {' '.join(arguments)} --help tells of {word}")


def test_python(folder):
    """A Python without modules hands over to Debian's; if that lacks one too, both are named."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", "bare"], check=True)
    bare = f"{folder}/bare/bin"
    pathlib.Path("run/kymograph.png").unlink()
    end = crawler("plot", "run", PATH=f"{bare}:{os.environ['PATH']}")
    check(end.returncode == 0 and pathlib.Path("run/kymograph.png").is_file() and end.stderr == "",
          f"a Python without modules comes first: {end.stderr.strip()}")
    pathlib.Path("blind").mkdir()
    pathlib.Path("blind/h5py.py").write_text("raise ImportError\n", encoding="utf-8")
    end = crawler("plot", "sweep", PATH=f"{bare}:{os.environ['PATH']}", PYTHONPATH=f"{folder}/blind")
    check(end.returncode == 2 and f"{bare}/python3 has no numpy and no h5py and no matplotlib; /usr/bin/python3 has no h5py "
          "(on Debian: apt install python3-h5py)" in end.stderr and end.stderr.count("\n") == 1,
          f"which Python lacks what: {end.stderr.strip()}")
    end = crawler("plot", "run", PYTHONPATH=f"{folder}/blind")
    check(end.returncode == 0, f"a run needs no h5py: {end.stderr.strip()}")
    for script in sorted((ROOT / "contrib" / "plot").glob("*.py")):
        first = script.read_text(encoding="utf-8").splitlines()[0]
        check(script.name == "plotting.py" or first == "#!/usr/bin/env python3", f"{script.name} runs with any Python: {first}")


def main():
    """In a folder of its own, with a name that a shell would stumble over."""
    with tempfile.TemporaryDirectory(suffix=" $(x); 'y'") as folder:
        os.chdir(folder)
        make_folders()
        test_pictures()
        test_times()
        test_part_of_its_own()
        test_bad_input()
        test_python(folder)
        os.chdir("/")
    sys.exit("\n".join(failures) or 0)


if __name__ == "__main__":
    main()
