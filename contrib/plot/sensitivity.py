#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws what matters in a run of crawler: by how much its displacement changes with the entries of the parameter file,
with a change of the body at one place, and with a push of the active stress at one place and time.

    contrib/plot/sensitivity.py OUTPUT_FOLDER [--output picture.png]

The picture is sensitivity.png in the folder, unless --output names another one.

Reads summary.json, sensitivity_body.csv and sensitivity_stress.csv of the folder, which are there with
Output/Sensitivities; needs matplotlib (Debian: python3-matplotlib).
"""
import argparse
import csv
import json
import pathlib
import sys


class Problem(Exception):
    """What to tell the user."""


def read_table(path):
    """The columns of a CSV file, without its header."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))[1:]
    try:
        return [list(column) for column in zip(*([float(number) for number in row] for row in rows), strict=True)]
    except ValueError as error:
        raise Problem(f"{path} is not a table of crawler ({error})") from None


def draw(folder, picture):
    """Reads the files and writes the picture."""
    try:
        import matplotlib
    except ImportError:
        raise Problem("matplotlib is missing; install it (Debian: apt install python3-matplotlib)") from None
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    summary = folder / "summary.json"
    entries = json.loads(summary.read_text(encoding="utf-8")).get("sensitivities") if summary.is_file() else None
    if not entries:
        raise Problem(f"{summary} has no sensitivities; the output folder of a finished run with Output/Sensitivities is "
                      "expected")
    if not (folder / "sensitivity_body.csv").is_file():
        reason = next((one["reason"] for one in entries.values() if "reason" in one), "the run did not finish")
        raise Problem(f"no sensitivity is known: {reason}")
    known = [(name, one["elasticity"]) for name, one in entries.items() if one["elasticity"] is not None]
    s, modulus, friction = read_table(folder / "sensitivity_body.csv")
    with_stress = (folder / "sensitivity_stress.csv").is_file()  # not for very many steps

    plt.rcParams.update({"font.size": 10, "axes.titlesize": 10, "axes.labelsize": 10, "xtick.labelsize": 9,
                         "ytick.labelsize": 9, "axes.linewidth": 0.7})
    figure, panels = plt.subplots(1, 3 if with_stress else 2, figsize=(12 if with_stress else 8, 4), layout="constrained",
                                  width_ratios=(1, 1.1, 1.1)[:3 if with_stress else 2])
    bars, local = panels[0], panels[1]
    known = known[:10][::-1]
    bars.barh([name.split("/")[-1] for name, _ in known], [value for _, value in known],
              color=["tab:blue" if value > 0 else "tab:orange" for _, value in known])
    bars.axvline(0, color="black", linewidth=0.7)
    bars.set(title="what matters", xlabel="% of displacement\nfor 1 % more of the entry")
    local.plot(s, modulus, label="elastic modulus", color="tab:blue")
    local.plot(s, friction, label="friction", color="tab:orange", linestyle="--")
    local.axhline(0, color="black", linewidth=0.7)
    local.set(title="where the body matters", xlabel="$s$ [length]",
              ylabel="displacement for a relative change\nalong a length [1]", xlim=(s[0], s[-1]))
    local.legend(frameon=False)
    if with_stress:
        places, times, push = read_table(folder / "sensitivity_stress.csv")
        n = len(s)
        rows = [push[i:i + n] for i in range(0, len(push), n)]
        largest = sorted(map(abs, push))[int(0.995 * len(push))] or 1  # thin layers would hide the rest
        mesh = panels[2].pcolormesh(places[:n], times[::n], rows, shading="gouraud", cmap="PuOr_r", rasterized=True,
                                    vmin=-largest, vmax=largest)
        panels[2].set(title="where and when active stress pushes", xlabel="$s$ [length]", ylabel="$t$ [time]")
        figure.colorbar(mesh, ax=panels[2], extend="both", label=r"$\partial D/\partial m(s,t)$ [1/(force time)]")
    try:
        figure.savefig(picture, dpi=100)
    except (OSError, ValueError) as error:
        raise Problem(f"cannot write {picture}: {error}") from None


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=pathlib.Path, help="output folder of crawler run")
    parser.add_argument("--output", type=pathlib.Path,
                        help="the picture (.png, .pdf, .svg); sensitivity.png in the folder if it is not given")
    options = parser.parse_args()
    picture = options.output or options.folder / "sensitivity.png"
    try:
        if not options.folder.is_dir():
            raise Problem(f"{options.folder} is not a folder; the output folder of a run is expected")
        draw(options.folder, picture)
    except (Problem, OSError) as problem:
        sys.exit(f"sensitivity.py: {problem}")
    print(f"wrote {picture}")


if __name__ == "__main__":
    main()
