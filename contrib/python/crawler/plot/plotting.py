# SPDX-License-Identifier: LGPL-2.1-or-later
"""Common parts of the scripts of this folder: the files of crawler, times, names of axes, colours, and how pictures are
written. This file is no script itself; needs.py describes how scripts end.
"""
import argparse
import io
import json
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from needs import FileError, InputError, Parser, need, number, read_rows, run_script, script, write_whole  # noqa: E402, F401

# Colours of Okabe and Ito, safe for colour-blind readers, with a line and a marker each for grey print.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
LINES = ("-", "--", "-.", ":", "-", "--", "-.")
DOTS = ("o", "s", "^", "D", "v", "P", "X")
INK = "0.15"                                # dark grey
SIZES, SIGNED = "cividis", "PuOr_r"         # colour maps: of positive numbers, of numbers of both signs

# Name, symbol (doc/theory.md, "Nomenclature") and unit of the fields in pictures.
NAMES = {"s": "material coordinate $s$ [length]", "t": "time $t$ [time]", "position": r"position $\zeta$ [length]",
         "displacement": "displacement $D$ [length]", "stretch": "stretch $w$ [1]", "strain": "strain $w-1$ [1]",
         "active_stress": "active stress $m$ [force]", "work": "work $W$ [force length]"}
SYMBOLS = {"Body/Length": "L", "Body/Elastic modulus": "k", "Body/Friction coefficient": r"\gamma",
           "Body/Anchoring exponent": "p", "Time/End time": "T",
           "Active stress/Optimal wave/Perturbation parameter": r"\chi", "Active stress/Optimal wave/Wave speed": "c",
           "Active stress/Optimal wave/Energy": "H", "displacement": "D", "stress_power": "W", "dissipation": "Q",
           "gait.displacement": r"\Delta", "gait.period": "P", "gait.frequency": r"\nu", "gait.speed": "U",
           "gait.wave.speed": "c", "min_stretch.value": "w", "max_stretch.value": "w"}


def root_folder():
    """Folder that contains prm: of the source code or of an installed program."""
    here = pathlib.Path(__file__).resolve()
    return next((folder for folder in here.parents if (folder / "prm").is_dir()), here.parents[2])


def parser(doc, output="", time=False):
    """Parser of a command line that begins with a folder. @p output describes the picture; @p time: options for a part
    of the run."""
    own = Parser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    own.add_argument("folder", type=pathlib.Path, metavar="OUTPUT_FOLDER")
    if output:
        own.add_argument("--output", type=pathlib.Path, metavar="PICTURE",
                         help=f"the picture, .png, .svg or .pdf (default: {output} in the folder)")
    if time:
        own.add_argument("--from", dest="begin", type=float, metavar="TIME", help="draws from this time on")
        own.add_argument("--to", dest="end", type=float, metavar="TIME", help="draws up to this time")
        own.add_argument("--last-stride", action="store_true", help="draws the last stride only")
    return own


def picture_of(options, name):
    """Path of the picture: the name given, or this one in the folder; a part of the run has a name of its own, so that
    the picture of the whole run is kept."""
    if options.output:
        return options.output
    stem, suffix = name.rsplit(".", 1)
    if options.last_stride:
        stem += "_last_stride"
    for word, time in (("from", options.begin), ("to", options.end)):
        if time is not None:
            stem += f"_{word}_{time:g}"
    return options.folder / f"{stem}.{suffix}"


def existing(path, what):
    """Path of a file, which must exist. @p what: description of the file, for the error message."""
    if not path.parent.is_dir():
        raise InputError(f'"{path.parent}" is not a folder; {what} is expected')
    if not path.is_file():
        raise InputError(f'"{path}" does not exist; {what} is expected')
    return path


def read_summary(folder, what):
    """Content of summary.json of a folder, as a dictionary."""
    path = existing(folder / "summary.json", what)
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise FileError(f"{path} is not a summary of crawler ({error})") from None


def results():
    """Module crawler.results, which reads the files of folders; it needs numpy."""
    folder = str(pathlib.Path(__file__).resolve().parents[2])
    if folder not in sys.path:
        sys.path.append(folder)
    sys.modules.setdefault("crawler.needs", sys.modules["needs"])  # exceptions of the package are those of this script
    import crawler.results
    return crawler.results


def parameters(path):
    """Values of a file parameters.prm, by the full names of entries, e.g. "Body/Length"."""
    return results().parameters_of(path.read_text(encoding="utf-8"))


def unit_names(folder):
    """Names of the user for length, time and force in a study (section Units); these words where unknown."""
    path = folder / "parameters.prm"
    known = parameters(path) if path.is_file() else {}
    names = {word: str(known.get(f"Units/{word.capitalize()}", word)) for word in ("length", "time", "force")}
    return names if all(word == name for word, name in names.items()) else \
        {**names, "energy": f"{names['force']} {names['length']}"}


def with_own_units(text, names):
    """Text with units in brackets, "time $t$ [time]", replaced by those of the user."""
    return re.sub(r"\[[^\[\]]*\]", lambda unit: re.sub(r"[a-z]+", lambda word: names.get(word[0], word[0]), unit[0]), text)


def label(entry, unit, short=None):
    """Name of an axis: the last words of an entry or result, its symbol and its unit."""
    words = short or entry.split("/")[-1].replace("_", " ").replace(".", ", ")
    symbol = f" ${SYMBOLS[entry]}$" if entry in SYMBOLS else ""
    return words + symbol + (f" [{unit}]" if unit else "")


class Kymograph:
    """Fields over body and time of a run: s [length], t [time], and under their names arrays with a row for each t."""

    def __init__(self, folder, *names):
        what = "the output folder of a run that was not stopped and has two rows at least, with Output/Kymograph = true and snapshots,"
        path = existing(folder / "kymograph.vts", what)
        self.folder, entries = folder, parameters(existing(folder / "parameters.prm", what))
        self.length, self.duration = (entries.get(name) for name in ("Body/Length", "Time/End time"))
        if not isinstance(self.length, (int, float)) or not isinstance(self.duration, (int, float)):
            raise InputError(f"{folder / 'parameters.prm'} has no number Body/Length or no number Time/End time")
        try:
            arrays = results().read_kymograph(path)
            self.fields = {name: arrays[name] for name in names}
        except (OSError, KeyError) as error:
            raise InputError(f"{path} is not a kymograph of crawler ({error})") from None
        self.s, self.t = self.length * arrays["places"], self.duration * arrays["times"]

    def __getitem__(self, name):
        """Field by name. The position is that of the points on the ground, the strain the stretch minus 1."""
        if name == "position":
            return self.s + self.fields["displacement"]
        return self.fields["stretch"] - 1 if name == "strain" else self.fields[name]

    def last_stride(self):
        """Begin and end of the last stride."""
        period = (read_summary(self.folder, "the output folder of a finished run").get("gait") or {}).get("period")
        if not period:
            raise InputError(f"{self.folder} has no stride (gait/period in summary.json is null); --from and --to choose a "
                          "part of its time")
        return max(self.t[-1] - period, 0.0), self.t[-1]

    def keep(self, begin, end, last_stride=False):
        """Keeps the times of the command line; returns begin and end. None stands for the begin or end of the run."""
        if last_stride and (begin is not None or end is not None):
            raise InputError("--last-stride is given with --from or --to, but only one of the two is expected")
        if last_stride:
            begin, end = self.last_stride()
        begin = self.t[0] if begin is None else begin
        end = self.t[-1] if end is None else end
        slack = 1e-9 * self.duration
        if not self.t[0] - slack <= begin < end <= self.t[-1] + slack:
            raise InputError(f"found the times from {begin:g} to {end:g}, but a part of the run, which lasts from "
                          f"{self.t[0]:g} to {self.t[-1]:g}, is expected")
        some = (self.t >= begin - slack) & (self.t <= end + slack)
        if some.sum() < 3:
            raise InputError(f"between {begin:g} and {end:g} {self.folder / 'kymograph.vts'} has {some.sum()} times, but 3 or "
                          "more are expected (Output/Number of snapshots)")
        self.t, self.fields = self.t[some], {name: field[some] for name, field in self.fields.items()}
        return begin, end


def colour_limits(field, name):
    """Colour map and limits of a field of this name; limits of fields of both signs are symmetric."""
    if name in ("stretch", "position"):
        low, high = float(field.min()), float(field.max())
        margin = 0 if high > low else 0.01 * abs(high) or 1.0
        return dict(cmap=SIZES, vmin=low - margin, vmax=high + margin)
    largest = float(abs(field).max()) or 1.0
    return dict(cmap=SIGNED, vmin=-largest, vmax=largest)


def draw_field(axes, kymograph, name):
    """Draws a field over s and t, with its axes named; returns the input of a colour bar."""
    field = kymograph[name]
    mesh = axes.pcolormesh(kymograph.s, kymograph.t, field, shading="gouraud", rasterized=True,
                           **colour_limits(field, name))
    axes.set(title=NAMES[name].split(" $")[0], xlabel=NAMES["s"], ylabel=NAMES["t"])
    return mesh


def draw_body(axes, kymograph, name="stretch", parts=8):
    """Draws the body on the ground over time, coloured by a field, and some of its points; returns the input of a
    colour bar."""
    import numpy as np
    field, position = kymograph[name], kymograph["position"]
    times = np.broadcast_to(kymograph.t[:, None], position.shape)
    mesh = axes.pcolormesh(position, times, field, shading="gouraud", rasterized=True, **colour_limits(field, name))
    for part in range(parts + 1):  # paths of material points, the ends thicker
        i, at_end = part * (len(kymograph.s) - 1) // parts, part in (0, parts)
        axes.plot(position[:, i], kymograph.t, color="black", linewidth=1.0 if at_end else 0.5,
                  alpha=1.0 if at_end else 0.5)
    margin = 0.03 * (position.max() - position.min())
    axes.set(xlabel=NAMES["position"], ylabel=NAMES["t"], ylim=(kymograph.t[0], kymograph.t[-1]),
             xlim=(position.min() - margin, position.max() + margin))
    return mesh


def save(figure, *pictures, study=None, dpi=160, few_colours=False):
    """Writes a figure under each of the names, with the units of the study's folder if there is one. With few colours a
    .png is less than half as large."""
    if study is not None:
        from matplotlib.text import Text
        names = unit_names(study)
        for text in figure.findobj(Text):
            if "[" in text.get_text():
                text.set_text(with_own_units(text.get_text(), names))
    for picture in map(pathlib.Path, pictures):
        known = figure.canvas.get_supported_filetypes()
        if picture.suffix[1:].lower() not in known:
            raise InputError(f'found the picture "{picture}", but a name that ends in .png, .svg or .pdf is expected')
        memory = io.BytesIO()
        figure.savefig(memory, format=picture.suffix[1:].lower(), dpi=dpi,
                       metadata={".svg": {"Date": None}, ".pdf": {"CreationDate": None}}.get(picture.suffix))
        if few_colours and picture.suffix == ".png":
            from PIL import Image  # comes with matplotlib
            coloured, memory = memory, io.BytesIO()
            Image.open(coloured).convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE, kmeans=1,
                                                         dither=Image.Dither.NONE).save(memory, "png", optimize=True)
        write_whole(picture, memory.getvalue())
        print(f"wrote {picture}")
