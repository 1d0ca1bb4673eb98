# SPDX-License-Identifier: LGPL-2.1-or-later
"""The examples of doc/python.md run, one after the other as they stand, and the tutorial runs as a notebook and finds
what it says: an optimum better than its neighbours, and the spread that the first-order uncertainty predicts.

    python3 documents.py FOLDER_OF_THE_PACKAGE
"""
import contextlib
import io
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = pathlib.Path(sys.argv[1]).resolve()
failures = []


def expect(condition, what):
    """Notes what is wrong."""
    if not condition:
        failures.append(what)


def check_document():
    text = (ROOT / "doc/python.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.S)
    screen = io.StringIO()
    with contextlib.redirect_stdout(screen):
        exec("\n".join(blocks), {})
    printed = screen.getvalue()
    for line in ("<crawler.Result: finished at t = 1, displacement 0.09007253", "3.0 ", "(81, 201)", "{'finished'}",
                 "(the numerics)", 'unknown entry "Lenght"'):
        expect(line in printed, f'doc/python.md: "{line}" is not in\n{printed}')
    expect(len(blocks) > 7, "doc/python.md has no examples")


def check_notebook(folder):
    environment = dict(os.environ, PYTHONPATH=str(PACKAGE), PATH="/usr/bin:/bin", JUPYTER_CONFIG_DIR=str(folder),
                       IPYTHONDIR=str(folder), JUPYTER_RUNTIME_DIR=str(folder))
    ended = subprocess.run(["jupyter-nbconvert", "--to", "notebook", "--execute", "--output-dir", folder,
                            ROOT / "contrib/notebooks/tutorial.ipynb"], env=environment, capture_output=True, text=True)
    if ended.returncode != 0:
        failures.append(f"the tutorial does not run: {ended.stderr[-3000:]}")
        return
    cells = json.loads((folder / "tutorial.ipynb").read_text(encoding="utf-8"))["cells"]
    outputs = [output for cell in cells if cell["cell_type"] == "code" for output in cell["outputs"]]
    text = "".join("".join(output.get("text", "")) for output in outputs)
    pictures = [output["data"]["image/png"] for output in outputs if "image/png" in output.get("data", {})]
    expect(len(pictures) >= 3 and all(len(picture) > 5000 for picture in pictures), f"{len(pictures)} pictures")
    expect(not any(output["output_type"] == "stream" and output["name"] == "stderr" for output in outputs), "warnings")
    best, *others = map(float, re.search(r"cost ([\d.]+) at the optimum, ([\d.]+) and ([\d.]+) beside it", text).groups())
    expect(best < min(others), f"the optimum costs {best}, its neighbours {others}")
    predicted, found = map(float, re.search(r"predicted ([\d.]+), of \d+ bodies ([\d.]+)", text).groups())
    expect(abs(found / predicted - 1) < 0.2, f"uncertainty: predicted {predicted}, found {found}")
    stored = json.loads((ROOT / "contrib/notebooks/tutorial.ipynb").read_text(encoding="utf-8"))["cells"]
    expect(not any(cell.get("outputs") for cell in stored), "the notebook is stored with outputs")


def main():
    sys.path.insert(0, str(PACKAGE))
    with tempfile.TemporaryDirectory() as name:
        os.chdir(name)
        os.symlink(ROOT / "prm", "prm")
        check_document()
        check_notebook(pathlib.Path(name))
        os.chdir("/")
    sys.exit("\n".join(failures) or 0)


if __name__ == "__main__":
    main()
