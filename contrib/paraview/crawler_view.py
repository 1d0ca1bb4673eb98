# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the scripts of this folder share: the command line's errors, a view, films. Needs ParaView's Python."""
import ctypes
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

try:
    from paraview import simple
    from vtkmodules.vtkRenderingCore import vtkRenderWindow
except ImportError:
    sys.exit(f"{sys.argv[0]}: this Python has no ParaView; call the script with pvbatch or pvpython (Debian: "
             f"apt install paraview python3-paraview): pvbatch {sys.argv[0]} RUN")

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python/crawler/plot"))
from plotting import unit_names, with_own_units  # noqa: E402

UNITS = {"stretch": "1", "position": "length", "displacement": "length", "velocity": "length/time",
         "active_stress": "force", "elastic_stress": "force", "friction_force": "force/length"}
TEXT = [0.1, 0.1, 0.1]


def fail(problem):
    """Ends with a sentence and the exit code of bad input."""
    print(f"{pathlib.Path(sys.argv[0]).name}: {problem}", file=sys.stderr)
    sys.exit(2)


def size(text):
    """Pixels like 1280x400, even as films want them."""
    match = re.fullmatch(r"(\d+)x(\d+)", text)
    if not match or min(int(match[1]), int(match[2])) < 16:
        raise ValueError(text)
    return [int(match[1]) // 2 * 2, int(match[2]) // 2 * 2]


def require_screen():
    """Ends in a sentence where VTK would abort: a ParaView that draws in windows of X11 needs a display that answers."""
    if vtkRenderWindow().GetClassName() != "vtkXOpenGLRenderWindow":
        return
    open_display = ctypes.CDLL("libX11.so.6").XOpenDisplay
    open_display.restype = ctypes.c_void_p
    if not open_display(None):
        display = os.environ.get("DISPLAY")
        fail(f"there is no screen to draw on ({f'DISPLAY={display} does not answer' if display else 'DISPLAY is not set'}"
             f"); xvfb-run draws without one (Debian: apt install xvfb): xvfb-run -a pvbatch {sys.argv[0]} ...")


def new_view(pixels):
    """A white view of these pixels, without axes."""
    require_screen()
    view = simple.CreateView("RenderView")
    view.ViewSize = pixels
    view.UseColorPaletteForBackground = 0
    view.Background = [1.0, 1.0, 1.0]
    view.OrientationAxesVisibility = 0
    view.CenterAxesVisibility = 0
    view.CameraParallelProjection = 1
    return view


def look_at(view, x, y, height):
    """Puts the middle of the view at x and y; it is as high as told."""
    view.CameraPosition = [x, y, 1.0]
    view.CameraFocalPoint = [x, y, 0.0]
    view.CameraViewUp = [0.0, 1.0, 0.0]
    view.CameraParallelScale = height / 2


def colour(display, view, field, limits, run):
    """Colours by a field of a run, with a bar that names it and its unit; grey is what does not deform."""
    simple.ColorBy(display, ("POINTS", field))
    display.Ambient, display.Diffuse = 1.0, 0.0  # colours as in the bar, without light
    table = simple.GetColorTransferFunction(field)
    low, high = limits
    if not high > low:
        low, high = low - 0.5, high + 0.5
    middle = 1.0 if field == "stretch" else 0.0
    half = max(high - middle, middle - low)
    table.ApplyPreset("Cool to Warm (Extended)" if low < middle < high else "Viridis (matplotlib)", True)
    table.RescaleTransferFunction(*((middle - half, middle + half) if low < middle < high else (low, high)))
    bar = simple.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = with_own_units(f"{field.replace('_', ' ')} [{UNITS[field]}]", unit_names(run)), ""
    bar.TitleColor = bar.LabelColor = TEXT
    bar.Orientation, bar.WindowLocation = "Horizontal", "Upper Right Corner"
    bar.ScalarBarLength, bar.ScalarBarThickness = 0.3, 12
    bar.TitleFontSize, bar.LabelFontSize = 14, 12
    bar.RangeLabelFormat = "%.3g"  # the longer one of ParaView runs into its neighbour
    bar.Visibility = 1
    return bar


def label(view, text, place):
    """Writes a text into a corner."""
    source = simple.Text(Text=text)
    display = simple.Show(source, view)
    display.WindowLocation, display.Color, display.FontSize = place, TEXT, 14
    return source


def save(view, file, pixels):
    """Writes the view as a picture."""
    simple.SaveScreenshot(str(file), view, ImageResolution=pixels)


def film(file, n_frames, per_second, draw):
    """Makes an mp4 or gif of n_frames pictures; draw(i, path) makes one of them."""
    if shutil.which("ffmpeg") is None:
        fail("a film needs ffmpeg, which was not found (Debian: apt install ffmpeg); --time T with --output "
             "picture.png makes one picture")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for i in range(n_frames):
            draw(i, folder / f"{i:06}.png")
            print(f"\r{i + 1} of {n_frames} frames", end="", file=sys.stderr, flush=True)
        print(file=sys.stderr)
        coding = (["-filter_complex", "split[a][b];[a]palettegen[p];[b][p]paletteuse"] if file.suffix == ".gif" else
                  ["-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "20", "-movflags", "+faststart"])
        done = subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-framerate", str(per_second), "-i",
                               str(folder / "%06d.png"), *coding, str(file)], check=False)
    if done.returncode != 0:
        print(f"ffmpeg could not write {file}", file=sys.stderr)
        sys.exit(6)
