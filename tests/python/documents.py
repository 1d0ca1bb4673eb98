# SPDX-License-Identifier: LGPL-2.1-or-later
"""The examples of doc/python.md run, one after the other as they stand, and notebooks find what they say: the tutorial an
optimum better than its neighbours, and the spread that the first-order uncertainty predicts; with "all" that of the measured
animal the displacement of the true strain, that of the fitted one what made its tracks, and that of the robot a better gait on no more work than it may do.

    python3 documents.py FOLDER_OF_THE_PACKAGE [all | --write]

Notebooks are stored with what they print and draw, for readers who run nothing; "--write" stores it anew, without it what they
print must be the same but for the last digits.
"""
import contextlib
import io
import json
import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import checks, expect  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = pathlib.Path(sys.argv[1]).resolve()
LARGEST = 200_000  # bytes of a notebook, with its pictures


def check_document():
    text = (ROOT / "doc/python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.S)
    screen = io.StringIO()
    with contextlib.redirect_stdout(screen):
        exec("\n".join(blocks), {})
    printed = screen.getvalue()
    for line in ("<crawler.Result: finished at t = 1, displacement 0.09007253", "3 0.0555", "(81, 201)", "{'finished'}",
                 "(the numerics)", 'unknown entry "Lenght"'):
        expect(line in printed, f'doc/python.md: "{line}" is not in\n{printed}')
    expect(len(blocks) > 7, "doc/python.md has no examples")


def texts_of(cells):
    """What the cells of a notebook print."""
    return "".join("".join(output.get("text", "")) for cell in cells for output in cell.get("outputs", []))


def are_alike(one, other):
    """Are two texts the same but for the last digits of their numbers?"""
    number = r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
    pairs = list(zip(*(map(float, re.findall(number, text)) for text in (one, other))))
    return re.sub(number, "#", one) == re.sub(number, "#", other) and all(abs(a - b) <= 0.02 * abs(a) + 1e-3 for a, b in pairs)


def printed_by(name, folder, least_pictures):
    """What a notebook prints, as it is stored; it draws and warns of nothing."""
    place = ROOT / f"contrib/notebooks/{name}.ipynb"
    stored = json.loads(place.read_text(encoding="utf-8"))
    environment = dict(os.environ, PYTHONPATH=str(PACKAGE), PATH="/usr/bin:/bin", JUPYTER_CONFIG_DIR=str(folder),
                       IPYTHONDIR=str(folder), JUPYTER_RUNTIME_DIR=str(folder))
    ended = subprocess.run(["jupyter-nbconvert", "--to", "notebook", "--execute", "--output-dir", folder,
                            place], env=environment, capture_output=True, text=True)
    if not expect(ended.returncode == 0, f"{name} does not run: {ended.stderr[-3000:]}"):
        return ""
    cells = json.loads((folder / f"{name}.ipynb").read_text(encoding="utf-8"))["cells"]
    outputs = [output for cell in cells if cell["cell_type"] == "code" for output in cell["outputs"]]
    pictures = [output["data"]["image/png"] for output in outputs if "image/png" in output.get("data", {})]
    expect(len(pictures) >= least_pictures and all(len(picture) > 5000 for picture in pictures), f"{name}: {len(pictures)} pictures")
    expect(not any(output["output_type"] == "stream" and output["name"] == "stderr" for output in outputs), f"{name}: warnings")
    if "--write" in sys.argv:
        for cell, fresh in zip(stored["cells"], cells):
            if cell["cell_type"] == "code":
                cell["outputs"] = [{**output, "execution_count": None} if "execution_count" in output else output for output in fresh["outputs"]]
        place.write_text(json.dumps(stored, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    expect(are_alike(texts_of(stored["cells"]), texts_of(cells)), f"{name} prints something else than what is stored (--write): {texts_of(cells)}")
    expect(place.stat().st_size < LARGEST, f"{name} has {place.stat().st_size} bytes, more than {LARGEST}")
    return texts_of(cells)


def check_tutorial(folder):
    text = printed_by("tutorial", folder, 3)
    if not text:
        return
    best, *others = map(float, re.search(r"cost ([\d.]+) at the optimum, ([\d.]+) and ([\d.]+) beside it", text).groups())
    expect(best < min(others), f"the optimum costs {best}, its neighbours {others}")
    predicted, found = map(float, re.search(r"predicted ([\d.]+), of \d+ bodies ([\d.]+)", text).groups())
    expect(abs(found / predicted - 1) < 0.2, f"uncertainty: predicted {predicted}, found {found}")


def check_others(folder):
    text = printed_by("measured_animal", folder, 1)
    found, spread, expected = map(float, re.search(r"displacement (\S+) mm \+- (\S+) .* gives (\S+)", text).groups())
    expect(abs(found - expected) < 4 * spread, f"measured animal: {found} +- {spread}, expected {expected}")
    text = printed_by("fitted_animal", folder, 1)
    for value, deviation, truth in re.findall(r": (\S+) \+- (\S+), 95 %.*truth (\S+)", text):
        expect(abs(float(value) - float(truth)) < 4 * float(deviation), f"fitted animal: {value} +- {deviation}, but {truth} made the tracks")
    expect(text.count("truth") == 3 and "common factor" in text and float(re.search(r"fit: (\S+);", text)[1]) > 10, f"fitted animal: {text}")
    text = printed_by("robot_design", folder, 2)
    start, work, best, used = map(float, re.search(r"displacement (\S+) on a work of (\S+) .*, (\S+) on (\S+) at", text).groups())
    expect(best > 2 * start and work < used <= 0.0501, f"robot: {start} on {work}, {best} on {used}")


def main(folder):
    sys.path.insert(0, str(PACKAGE))
    os.chdir(folder)
    os.symlink(ROOT / "prm", "prm")
    check_document()
    check_tutorial(folder)
    if {"all", "--write"} & set(sys.argv):
        check_others(folder)


checks.run((main,))
