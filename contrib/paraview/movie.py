# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes a film of a run of crawler: the body on its ground, and the forces that hold and push it.

    pvbatch contrib/paraview/movie.py RUN [--output film.mp4|film.gif|picture.png] [options]

RUN is the output folder of a run with snapshots in either format. The film is RUN/movie.mp4 unless --output names
another one. The camera follows the body; --whole shows the whole path. Without a screen: xvfb-run -a pvbatch ...
--state view.pvsm also keeps the view as a state, which ParaView opens: paraview view.pvsm
"""
import argparse
import os
import pathlib
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import crawler_view as look  # noqa: E402
from paraview import servermanager, simple  # noqa: E402


def command_line():
    """The options of the user."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=pathlib.Path, metavar="RUN")
    parser.add_argument("--output", type=pathlib.Path, help="mp4, gif, or png with --time")
    parser.add_argument("--time", type=float, help="one picture of the frame next to this time")
    parser.add_argument("--from", dest="first", type=float, default=-1e300, help="leaves out what is before")
    parser.add_argument("--to", dest="last", type=float, default=1e300, help="leaves out what is after")
    parser.add_argument("--colour", choices=sorted(look.UNITS), default="stretch", help="field of the colours")
    parser.add_argument("--whole", action="store_true", help="show the whole path instead of following the body")
    parser.add_argument("--size", type=look.size, default=[1280, 360], help="pixels, like 1280x360")
    parser.add_argument("--rate", type=int, default=25, help="frames per second")
    parser.add_argument("--state", type=pathlib.Path, help="keeps the view as a ParaView state (.pvsm)")
    options = parser.parse_args()
    if options.output is None:
        options.output = options.run / ("movie.mp4" if options.time is None else "picture.png")
    wanted = (".mp4", ".gif") if options.time is None else (".png",)
    if options.output.suffix not in wanted:
        look.fail(f"--output {options.output}: a name with {' or '.join(wanted)} is expected "
                  f"{'for a film' if options.time is None else 'with --time'}")
    if options.rate < 1:
        look.fail(f"--rate {options.rate}: a whole number from 1 on is expected")
    return options


def open_run(folder):
    """The reader of the animation in the folder."""
    for name, reader in (("solution.pvd", simple.PVDReader), ("solution.xdmf", simple.XDMFReader)):
        path = folder.resolve() / name
        if path.is_file():
            source = reader(FileName=str(path)) if name.endswith("pvd") else reader(FileNames=[str(path)])
            source.UpdatePipelineInformation()
            return source
    look.fail(f"{folder} has neither solution.pvd nor solution.xdmf; the output folder of a run with snapshots is "
              "expected")


def parts_of(data):
    """Body, grip, ground and scale of a frame: its data sets in the order in which the files have them."""
    found, parts = [], data.NewIterator()
    parts.InitTraversal()
    while not parts.IsDoneWithTraversal():
        found.append(parts.GetCurrentDataObject())
        parts.GoToNextItem()
    return dict(zip(("body", "grip", "ground", "scale"), found))


def main():
    """Makes the view, then a picture or a film."""
    options = command_line()
    source = open_run(options.run)
    times = [time for time in source.TimestepValues if options.first <= time <= options.last]
    if not times:
        look.fail(f"{options.run} has no frames from {options.first:g} to {options.last:g}")
    if options.time is not None:
        times = [min(times, key=lambda time: abs(time - options.time))]
    first = parts_of(servermanager.Fetch(source))
    view = look.new_view(options.size)
    display = simple.Show(source, view)
    display.Representation = "Surface"
    display.SetScalarBarVisibility(view, False)
    limits = first["scale"].GetPointData().GetArray(options.colour).GetRange()
    look.colour(display, view, options.colour, limits, options.run)
    display.AmbientColor = display.DiffuseColor = [0.35, 0.35, 0.35]
    clock = look.label(view, "", "Upper Left Corner")

    ground = first["ground"].GetBounds()
    length = first["body"].GetPointData().GetArray("s").GetRange()[1]
    stretches = first["scale"].GetPointData().GetArray("stretch").GetRange()
    # From below the arrows, without the scale, to above the thickest body and the words in the corners.
    bottom, top = -0.12 * length, length * min(0.1 / max(stretches[0], 0.1), 1.0) * 1.15

    def show(time):
        view.ViewTime = time
        source.UpdatePipeline(time)
        body = parts_of(servermanager.Fetch(source))["body"].GetBounds()
        clock.Text = f"t = {time:.4g}"
        middle = (ground[0] + ground[1]) / 2 if options.whole else (body[0] + body[1]) / 2
        width = ground[1] - ground[0] if options.whole else 1.6 * length
        height = max(width * options.size[1] / options.size[0], top - bottom)
        look.look_at(view, middle, bottom + height / 2, height)

    show(times[0])
    if options.state:
        simple.SaveState(str(options.state))
    if options.time is not None:
        look.save(view, options.output, options.size)
    else:
        def draw(i, path):
            show(times[i])
            look.save(view, path, options.size)
        look.film(options.output, len(times), options.rate, draw)
    print(options.output)


if __name__ in ("__main__", "__vtkconsole__"):
    main()
