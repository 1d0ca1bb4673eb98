# SPDX-License-Identifier: LGPL-2.1-or-later
"""The film of a run: the body on the ground, as thick as its stretch leaves it, and its centre of mass over time."""
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image  # comes with matplotlib
from plotting import NAMES, FileError, colour_limits

STRIDES, FRAMES_EACH, RINGS = 5, 20, 16
THICKNESS = 0.12  # of the unstretched body


class Film:
    """A figure whose body, centre of mass and time are moved from frame to frame."""

    def __init__(self, run, last):
        self.run, self.moved = run, run.fields["displacement"].mean(axis=1)
        self.figure, (self.ground, below) = plt.subplots(2, 1, figsize=(5.6, 3.3), dpi=85, layout="constrained",
                                                         height_ratios=(1.15, 1))
        self.look = colour_limits(run["active_stress"], "active_stress")
        position = run["position"][: last + 1]
        self.ground.set(xlim=(position.min() - 0.05, position.max() + 0.05), ylim=(-3 * THICKNESS, 3 * THICKNESS), yticks=[],
                        xlabel=NAMES["position"], title="the body (thickness 1/stretch) and its centre of mass")
        self.figure.colorbar(plt.cm.ScalarMappable(plt.Normalize(self.look["vmin"], self.look["vmax"]), self.look["cmap"]),
                             ax=self.ground, label="active\nstress $m$\n[force]", pad=0.01, ticks=(-0.5, 0, 0.5))
        below.plot(run.t[: last + 1], self.moved[: last + 1], color="0.75", linewidth=1)
        self.past, = below.plot([], [], color="black", linewidth=1.4)
        self.now, = below.plot([], [], "o", color="black", markersize=5, clip_on=False)
        below.set(xlim=(0, run.t[last]), ylim=(-0.02, 1.08 * self.moved[: last + 1].max()), xlabel=NAMES["t"],
                  ylabel="$D$ [length]")
        self.figure.canvas.draw()
        self.figure.set_layout_engine("none")  # all stays where it is
        self.body = []

    def frame(self, row):
        """The picture of a snapshot. The volume of each part is kept, so a part is 1/stretch as thick."""
        for artist in self.body:
            artist.remove()
        x, stress = (np.vstack([self.run[name][row]] * 2) for name in ("position", "active_stress"))
        y = np.outer((-0.5, 0.5), THICKNESS / self.run["stretch"][row])
        rings = range(0, x.shape[1], (x.shape[1] - 1) // RINGS)
        self.body = [self.ground.pcolormesh(x, y, stress, shading="gouraud", **self.look),
                     *self.ground.plot(x.T, y.T, color="black", linewidth=0.8),
                     *self.ground.plot(x[:, rings], y[:, rings], color="black", linewidth=0.5),
                     self.ground.axvline(x[0].mean(), color="black", linewidth=0.9, linestyle=":")]
        self.past.set_data(self.run.t[: row + 1], self.moved[: row + 1])
        self.now.set_data(self.run.t[row: row + 1], self.moved[row: row + 1])
        self.figure.canvas.draw()
        return Image.fromarray(np.asarray(self.figure.canvas.buffer_rgba())[:, :, :3])


def movie(run, path):
    """An animated GIF of the first strides of a run."""
    last = int(np.argmin(np.abs(run.t - STRIDES)))
    film = Film(run, last)
    frames = [film.frame(int(np.argmin(np.abs(run.t - time)))) for time in np.linspace(0, STRIDES, STRIDES * FRAMES_EACH + 1)]
    plt.close(film.figure)
    colours = frames[len(frames) // 2].quantize(64, Image.Quantize.MAXCOVERAGE, kmeans=1)  # the same for all: no flicker
    small = [one.quantize(palette=colours, dither=Image.Dither.NONE) for one in frames]
    try:
        small[0].save(path, save_all=True, append_images=small[1:], duration=80, loop=0, optimize=False)
    except OSError as error:
        raise FileError(f"cannot write {path}: {error.strerror}") from None
    print(f"wrote {path}")
