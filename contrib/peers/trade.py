#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures what accuracy costs, with crawler and with other tools, and draws it (doc/images/trade.png, doc/numerics.md).

    contrib/peers/trade.py [build] [--picture FILE] [--only NAME ...]

Left: one body, Fig. S1; of the peers (compare.py) and of crawler's engine the cheapest setting that a search finds for
each error, and what `Accuracy` delivers, with the bound of its error. Right: a point of `crawler sweep` on the 1000
points of SWEEP, with all files, less the start of the program; its error is the largest of all points. Times are of the
processor. Prints the numbers of crawler as a table. Takes 4 minutes.
"""
import argparse
import math
import os
import pathlib
import sys
import tempfile

import compare

ACCURACIES = [f"1e-{i}" for i in range(1, 11)]
MAX_SWEEP = 6  # exponent of the smallest Accuracy of the sweep: its true displacements are known to some 1e-7
PEER_ERRORS = [f"1e-{i}" for i in range(2, 10)]


def measure_peers(only, exact):
    """{name: [(error, seconds)]} of the peers that are installed and in `only` (all, if that is None)."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for peer in compare.peers():
            if only is not None and peer.name not in only:
                continue
            if not peer.start(folder):
                print(f"{peer.name} is not installed: skipped", flush=True)
                continue
            measured = ((float(error), compare.measure_case(peer, "s1", float(error), exact)) for error in PEER_ERRORS)
            found[f"{peer.name} {peer.words}"] = [(error, result[0]) for error, result in measured if result]
            print(f"{peer.name}: {len(found[f'{peer.name} {peer.words}'])} of {len(PEER_ERRORS)} errors reached", flush=True)
            peer.process.kill()
            peer.process.wait()
    return found


def measure_crawler(build, exact):
    """Rows {accuracy, engine [s], delivered [s], error, bound; for the sweep point [s], point_error}, for each Accuracy."""
    import benchmark
    found = benchmark.measure(str(build / "tests/benchmark/crawler_benchmark"), "^front/", 3)
    rows = []
    for i, accuracy in enumerate(ACCURACIES, start=1):
        engine, answer = found[f"front/engine/{accuracy}"], found[f"front/answer/{accuracy}"]
        row = {"accuracy": float(accuracy), "engine": engine["seconds"], "engine_error": engine["error"],
               "delivered": answer["seconds"], "error": answer["error"], "bound": answer["bound"], "point": math.nan,
               "point_error": math.nan}
        if i <= MAX_SWEEP:
            row["point"], row["point_error"] = compare.delivered_sweep(build / "crawler", accuracy, exact)
        rows.append(row)
    return rows


def table(rows):
    """The Markdown."""
    lines = ["| Accuracy | error | bound | delivered [ms] | engine alone [ms] | a point of SWEEP [ms] | largest error of a point |",
             "|---|---|---|---|---|---|---|"]
    for row in rows:
        point = ("-", "-") if math.isnan(row["point"]) else (f"{1e3 * row['point']:.2g}", f"{row['point_error']:.0e}")
        lines.append(f"| {row['accuracy']:.0e} | {row['error']:.0e} | {row['bound']:.0e} | {1e3 * row['delivered']:.2g} | "
                     f"{1e3 * row['engine']:.2g} | {point[0]} | {point[1]} |")
    return "\n".join(lines)


def draw(peers, rows, picture):
    """Writes the picture."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, (left, right, words) = plt.subplots(1, 3, figsize=(10, 3.6), sharex=True, sharey=True, layout="constrained",
                                                width_ratios=(4, 4, 1.7))
    for name, points in peers.items():
        left.loglog(*zip(*points), marker=".", lw=1, label=name)
    left.loglog([r["engine_error"] for r in rows], [r["engine"] for r in rows], "k.--", lw=1, label="crawler, engine alone")
    for axes, seconds, error in ((left, "delivered", "error"), (right, "point", "point_error")):
        axes.loglog([r[error] for r in rows], [r[seconds] for r in rows], "ko-", lw=2, ms=4,
                    label="crawler, delivered with\nbounds for this Accuracy" if axes is left else None)
        for row in rows[1::2]:
            if not math.isnan(row[seconds]):
                axes.annotate(f"{row['accuracy']:.0e}".replace("e-0", "e-"), (row[error], row[seconds]), xytext=(3, 5),
                              textcoords="offset points", fontsize=7)
        axes.set(xlabel="true relative error")
        axes.grid(which="major", alpha=0.3)
    left.invert_xaxis()
    words.axis("off")
    words.legend(*left.get_legend_handles_labels(), loc="center", fontsize=8, frameon=False)
    left.set(title="one body, Fig. S1", ylabel="processor time [s]")
    right.set(title="a point of a sweep (1000 points)")
    figure.savefig(picture, dpi=130)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=pathlib.Path, default=compare.SOURCE / "build")
    parser.add_argument("--picture", type=pathlib.Path, default=compare.SOURCE / "doc/images/trade.png")
    parser.add_argument("--only", nargs="+", choices=[peer.name for peer in compare.peers()], help="names of peers")
    o = parser.parse_args()
    program = o.build / "tests/benchmark/crawler_benchmark"
    if not program.exists():
        sys.exit(f"{program} does not exist: cmake --build {o.build} --target studies makes it")
    os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    try:
        exact, certainty = compare.references(["s1", "sweep"])
    except ImportError as missing:
        sys.exit(f"the true displacements need NumPy and SciPy (Debian: python3-scipy): {missing}")
    print(f"displacements of the sweep are known to {certainty:.0e}", flush=True)
    if not certainty < 10.0 ** -(MAX_SWEEP + 0.5):
        sys.exit(f"that is not enough for Accuracy 1e-{MAX_SWEEP}")
    rows = measure_crawler(o.build, exact)
    print(table(rows), flush=True)
    draw(measure_peers(o.only, exact), rows, o.picture)


if __name__ == "__main__":
    main()
