# SPDX-License-Identifier: LGPL-2.1-or-later
"""The figures of the paper, each with the numbers it must show; make_figures.py calls them."""
import argparse
import math

import matplotlib.pyplot as plt
import numpy as np
import scaling
from kymograph import read_statistics
from movie import movie
from plotting import COLOURS, DOTS, LINES, NAMES, Kymograph, draw_body, read_rows, save

SOLVER, EXACT, SERIES = "independent solver", "exact", "series"


def finish(figure, picture, dpi=100):
    """Writes a small picture."""
    save(figure, picture, dpi=dpi, few_colours=True)
    plt.close(figure)


def fig_1a(results, numbers, out):
    """Friction over stretch: the curves of the law, and what the runs met, as dots."""
    figure, panels = plt.subplots(1, 2, figsize=(8.4, 3.9), layout="constrained", sharex=True)
    stretch = np.linspace(0.3, 1.7, 200)
    for i, p in enumerate((-1, 0, 1, 2, 4)):
        run = Kymograph(results.folder / f"friction_{p}", "stretch", "velocity", "friction_force")
        w, v, f = (run[name][1:] for name in ("stretch", "velocity", "friction_force"))
        moves = np.abs(v) > 0.1 * np.abs(v).max()
        w, g = w[moves], np.abs(f[moves] / v[moves])  # friction coefficient gamma = 1
        exponent = np.polyfit(np.log(w), np.log(g), 1)[0]
        numbers.require("Fig. 1a", f"exponent of the friction met by a body with p = {p}, 1 - p", 1 - p, exponent, 1e-5, EXACT)
        some = np.argsort(w)[:: max(1, len(w) // 14)]
        for axes, power, values in ((panels[0], -p, g / w), (panels[1], 1 - p, g)):
            axes.plot(stretch, stretch**power, color=COLOURS[i], linestyle=LINES[i], linewidth=1.6)
            axes.plot(w[some], values[some], DOTS[i], color=COLOURS[i], markersize=4, markerfacecolor="white")
    for axes, title, name in ((panels[0], "per present length", r"$w^{-p}$"), (panels[1], "per reference length", "$w^{1-p}$")):
        axes.set(title=f"friction {title}, {name}", xlabel=NAMES["stretch"], ylim=(0, 4), xlim=(0.3, 1.7),
                 ylabel=r"friction force / ($\gamma v$) [1]")
        axes.axvline(1, color="0.7", linewidth=0.7, zorder=0)
    handles = [plt.Line2D([], [], color=COLOURS[i], linestyle=LINES[i], marker=DOTS[i], markersize=4,
                          markerfacecolor="white", label=f"$p = {p}$") for i, p in enumerate((-1, 0, 1, 2, 4))]
    panels[1].legend(handles=handles, loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False, fontsize=9)
    finish(figure, out / "fig_1a.png")


def displacement_at(folder, time):
    """Of the centre of mass, at a snapshot."""
    times, travelled = read_statistics(folder)
    return float(travelled[np.argmin(np.abs(times - time))])


def fig_2a(results, numbers, out):
    """Snapshots of active stress, strain and centre of mass of the retrograde crawler."""
    folder, summary = results.folder / "fig_2", results.summary("fig_2")
    known = numbers.reference(-1, 0.4, 1, 20)
    first = numbers.reference(-1, 0.4, 1, 1)["displacement"]
    last = summary["displacement"] - displacement_at(folder, 19)
    inverted = results.summary("fig_2_largest")["inversion"]["t"]
    require = lambda *words: numbers.require("Fig. 2a", *words)  # noqa: E731
    require("displacement D after 20 strides", known["displacement"], summary["displacement"], 1e-8, SOLVER)
    require("after the first stride", first, displacement_at(folder, 1), 1e-8, SOLVER)
    require("in the last stride", (known["displacement"] - first) / 19, last, 1e-7, SOLVER, 6)
    require("work W", known["stress_power"], summary["stress_power"], 1e-7, SOLVER)
    require("smallest stretch", known["min_stretch"], summary["min_stretch"]["value"], summary["errors"]["min_stretch"],
            f"{SOLVER}; to the error that the run reports", 3)
    require("time at which the wave c = 0.05 of the printed rule inverts an end", (math.pi + math.asin(0.125)) / (0.1 * math.pi),
            inverted, 1e-5, EXACT)

    figure, panels = plt.subplots(1, 3, figsize=(11, 3.7), layout="constrained", width_ratios=(1, 1, 1.25))
    run = Kymograph(folder, "stretch", "displacement", "active_stress")
    for i, time in enumerate((3, 8.25, 13.5, 18.75)):
        row = np.argmin(np.abs(run.t - time))
        for axes, name in zip(panels, ("active_stress", "strain")):
            axes.plot(run.s, run[name][row], color=COLOURS[i], linestyle=LINES[i], linewidth=1.6, label=f"$t$ = {time:g}")
            axes.set(title=NAMES[name].split(" $")[0], xlabel=NAMES["s"], ylabel=NAMES[name], xlim=(0, 1))
            axes.axhline(0, color="0.7", linewidth=0.7, zorder=0)
        panels[2].plot(time, displacement_at(folder, time), DOTS[i], color=COLOURS[i], markersize=6, zorder=3)
    times, travelled = read_statistics(folder)
    panels[2].plot(times, travelled, color="black", linewidth=1.2, label="equation")
    panels[2].plot(times, [series(0.4, t) for t in times], color="0.55", linewidth=1.0, linestyle="--",
                   label=r"series, order $\chi^2$")
    panels[2].set(title=f"centre of mass, D(20) = {summary['displacement']:.6f}", xlabel=NAMES["t"],
                  ylabel=NAMES["displacement"], xlim=(0, 20), ylim=(0, None), xticks=range(0, 21, 4))
    panels[2].grid(color="0.9", linewidth=0.6)
    panels[0].legend(fontsize=8, frameon=False, loc="lower left")
    panels[2].legend(fontsize=9, frameon=False)
    finish(figure, out / "fig_2a.png")
    movie(run, out / "movie.gif")


def series(chi, time, a=-1, c=1):
    """Displacement of the optimal wave to order chi^2 (doc/theory.md, section 3); L = a_1 = 1."""
    return chi**2 * (-a * time / (2 * c) + a / (4 * math.pi * c**2) * math.sin(2 * math.pi * c * time))


def fig_2b(results, numbers, out):
    """Retrograde and prograde side by side, and where the direction changes."""
    figure, panels = plt.subplots(1, 3, figsize=(11, 4.2), layout="constrained", width_ratios=(1, 1, 0.9))
    mesh = None
    for axes, name, a, word in ((panels[0], "fig_2", -1, "retrograde"), (panels[1], "fig_2_prograde", 1, "prograde")):
        one = numbers.reference(a, 0.4, -a, 1)["displacement"]
        numbers.require("Fig. 2b", f"displacement D of the first stride, a = {a:+d}, c = {-a:+d}", one,
                        displacement_at(results.folder / name, 1), 1e-8, SOLVER)
        wave = results.summary(name)["gait"]["wave"]
        numbers.require("Fig. 2b", f"speed of the wave of strain along s, a = {a:+d} ({word})", a, wave["speed"], 0.02,
                        "-c, within 2 %", 2)
        if wave["direction"] != word:
            numbers.wrong.append(f"Fig. 2b: the wave is {wave['direction']}, but {word} is expected")
        run = Kymograph(results.folder / name, "stretch", "displacement")
        run.keep(0, 4)
        mesh = draw_body(axes, run)
        axes.set(title=f"$a$ = {a:+d}, {word}", xlim=(-0.15, 1.55))
        crest = run.s[np.argmax(run["stretch"], axis=1)]
        for stride in range(4):  # where the body is longest
            some = (run.t > stride + 0.3) & (run.t < stride + 0.7)
            places = [np.interp(s, run.s, row) for s, row in zip(crest[some], run["position"][some])]
            axes.plot(places, run.t[some], color="#D40000", linewidth=1.8)
    figure.colorbar(mesh, ax=panels[:2], label=NAMES["stretch"], pad=0.01)
    rows = read_rows(results.folder / "direction" / "results.csv")
    p, moved = (np.array([float(row[name]) for row in rows]) for name in ("Body/Anchoring exponent", "displacement"))
    numbers.require("Fig. 2b", "displacement D at p = 1 (a = 0)", 0, float(moved[p == 1][0]), 1e-14, EXACT)
    crossing = float(np.interp(0, moved, p)) if (np.diff(moved) > 0).all() else math.nan
    numbers.require("Fig. 2b", "p at which the direction changes", 1, crossing, 1e-6, EXACT, 5)
    panels[2].axhline(0, color="black", linewidth=0.7)
    panels[2].axvline(1, color="0.6", linewidth=0.9, linestyle="--")
    panels[2].plot(p, moved, "o-", color=COLOURS[0], markersize=4)
    panels[2].annotate("direction changes\nat $p$ = 1", (1, 0), (1.35, -0.03), fontsize=9, va="center",
                       arrowprops={"arrowstyle": "->", "linewidth": 0.8})
    panels[2].set(title=r"one stride, $c$ = +1, $\chi$ = 0.3", xlabel="anchoring exponent $p$ [1]", ylabel=NAMES["displacement"])
    panels[2].grid(color="0.9", linewidth=0.6)
    finish(figure, out / "fig_2b.png")


def fig_3(results, numbers, out):
    """Speed and cost of transport over mass and frequency, with the paper's fit."""
    options = argparse.Namespace(folder=results.folder / "scaling", table=scaling.TABLE)
    figure, laws = scaling.draw(options)
    for family, what, tolerance in (("mass", "similar worms", 1e-5), ("material", "worms of the same material", 3.3e-3)):
        numbers.require("Fig. 3", f"speed over mass, exponent, {what}", 1 / 3, laws[family, "speed"][1], tolerance, "scaling law", 4)
    numbers.require("Fig. 3", "speed of a worm of 1 g [mm/s], the paper's fit", 3.8, laws["mass", "speed"][0], 0.02, "paper, fit", 3)
    for y in ("U", "COT"):
        numbers.require("Fig. 3", f"{y} over stride frequency, exponent, similar worms", 1, laws["similar", y][1], 1e-5,
                        "scaling law", 4)
    finish(figure, out / "fig_3.png")


def fig_s1(results, numbers, out):
    """The whole equation against the series, at the end and over time."""
    figure, panels = plt.subplots(1, 2, figsize=(9.6, 4.3), layout="constrained")
    chis = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5)
    computed = {chi: results.summary(f"fig_s1_{chi:g}")["displacement"] for chi in (*chis, -0.1, -0.4)}
    for chi, found in computed.items():
        must = numbers.reference(-1, chi, 1, 1)["displacement"]
        numbers.require("Fig. S1", f"displacement D, chi = {chi:g} (series: {chi**2 / 2:.4g})", must, found, 1e-8, SOLVER)
    odd = (computed[0.1] - computed[-0.1]) / 2 / 0.1**3
    numbers.require("Fig. S1", "odd part of D at chi = 0.1, over chi^3", -0.0115, odd, 3e-4, SOLVER, 3)
    fine = np.linspace(0, 0.52, 100)
    panels[0].plot(fine, fine**2 / 2, "--", color="0.45", label=r"series, $\chi^2/2$")
    for i, chi in enumerate(chis):
        panels[0].plot(chi, computed[chi], DOTS[i], color=COLOURS[i], markersize=7)
        panels[0].annotate(f"{100 * (computed[chi] / (chi**2 / 2) - 1):+.2g} %", (chi, computed[chi]), fontsize=8,
                           ha="center", xytext=(0, 22) if chi == 0.1 else (0, 9) if chi < 0.1 else (-20, 6),
                           textcoords="offset points")
        times, travelled = read_statistics(results.folder / f"fig_s1_{chi:g}")
        panels[1].plot(times, travelled, color=COLOURS[i], label=rf"$\chi$ = {chi:g}")
        panels[1].plot(times, [series(chi, t) for t in times], "--", color=COLOURS[i], linewidth=1.0)
    panels[0].plot([], [], "o", color="0.2", label="equation, and how far it is off the series")
    panels[0].set(title="displacement of one stride", xlabel=r"perturbation parameter $\chi$ [1]", ylabel=NAMES["displacement"],
                  xlim=(0, 0.54), ylim=(-0.004, 0.175))
    panels[1].set(title="over time: equation (line), series (dashed)", xlabel=NAMES["t"], ylabel=NAMES["displacement"], xlim=(0, 1))
    for axes in panels:
        axes.grid(color="0.9", linewidth=0.6)
        axes.legend(fontsize=9, frameon=False, loc="upper left")
    finish(figure, out / "fig_s1.png")


ALL = (fig_1a, fig_2a, fig_2b, fig_3, fig_s1)
