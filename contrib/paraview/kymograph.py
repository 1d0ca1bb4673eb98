# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws the kymograph of a run of crawler in ParaView: a field over s/L and t/T.

    pvbatch contrib/paraview/kymograph.py RUN [--output picture.png] [--colour velocity] [--state view.pvsm]

RUN is the output folder of a run; the picture is RUN/kymograph.png unless --output names another one. Without a
screen: xvfb-run -a pvbatch ...  --state also keeps the view as a state, which ParaView opens: paraview view.pvsm
"""
import argparse
import os
import pathlib
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import crawler_view as look  # noqa: E402
from paraview import servermanager, simple  # noqa: E402

FIELDS = ("stretch", "velocity", "active_stress", "friction_force", "displacement")


def main():
    """Draws the picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=pathlib.Path, metavar="RUN")
    parser.add_argument("--output", type=pathlib.Path, help="a png")
    parser.add_argument("--colour", choices=FIELDS, default="stretch", help="field of the colours")
    parser.add_argument("--size", type=look.size, default=[900, 800], help="pixels, like 900x800")
    parser.add_argument("--state", type=pathlib.Path, help="keeps the view as a ParaView state (.pvsm)")
    options = parser.parse_args()
    file = options.run.resolve() / "kymograph.vts"
    if not file.is_file():
        look.fail(f"{file} does not exist; the output folder of a run with Output/Kymograph = true and snapshots is "
                  "expected")
    output = options.output or options.run / "kymograph.png"
    if output.suffix != ".png":
        look.fail(f"--output {output}: a name with .png is expected")
    source = simple.XMLStructuredGridReader(FileName=[str(file)])
    simple.UpdatePipeline(proxy=source)
    grid = servermanager.Fetch(source)
    names = {axis: grid.GetFieldData().GetAbstractArray(f"AxisTitleFor{axis}").GetValue(0) for axis in "XY"}
    units = {name: grid.GetFieldData().GetArray(name).GetValue(0) for name in ("L", "T")}
    view = look.new_view(options.size)
    display = simple.Show(source, view)
    display.Representation = "Surface"
    shown = grid.GetFieldData().GetArray(f"shown_{options.colour}")
    look.colour(display, view, options.colour, [shown.GetValue(i) for i in range(2)], options.run)
    axes = view.AxesGrid
    axes.Visibility = 1
    axes.XTitle, axes.YTitle, axes.ZTitle = f"{names['X']} (L = {units['L']:g})", f"{names['Y']} (T = {units['T']:g})", ""
    for part in ("Title", "Label"):
        for axis in "XY":
            setattr(axes, f"{axis}{part}Color", look.TEXT)
            setattr(axes, f"{axis}{part}FontSize", 16 if part == "Title" else 13)
    axes.AxesToLabel = 3  # below and on the left
    look.look_at(view, 0.48, 0.53, 1.35)
    if options.state:
        simple.SaveState(str(options.state))
    look.save(view, output, options.size)
    print(output)


if __name__ in ("__main__", "__vtkconsole__"):
    main()
