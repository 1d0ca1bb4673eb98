#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""How the program shows how far it is: a bar and a kymograph in place on a terminal, lines where there is none.

    python3 progress.py PATH_TO_CRAWLER MPIEXEC [alone|several]

The program runs in a pseudo terminal; a small terminal of our own follows its control sequences, so that what stands on
the screen at any time is known. What a bar shows is read until enough of it was seen; the work, which lasts for minutes, is then
stopped by a signal.
"""
import codecs
import fcntl
import os
import pathlib
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import termios

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import PATIENCE, call, checks, environment, expect, on_ranks  # noqa: E402

PROGRAM, MPIEXEC = sys.argv[1:3]
PRM = pathlib.Path(__file__).resolve().parents[2] / "prm"
WIDTH = 100
VERSION = re.compile(r"crawler \d+\.\d+\.\d+ \(revision \S+, deal\.II \S+, PETSc \S+\)")
BAR = re.compile(r"^[█░]{24} ")
LEFT = re.compile(r"^[█░]{24} +(\d+) %  \S+ (ms|s|min) left  ")
POINTS = re.compile(r"(\d+) of (\d+) points, ")


class Screen:
    """The lines of a terminal, as far as the program's control sequences go. Any other is an error."""

    def __init__(self):
        self.rows, self.row, self.column, self.seen = [""], 0, 0, []

    def write(self, text):
        for part in re.findall(r"\x1b\[\d*[A-Za-z]|\r|\n|[^\x1b\r\n]+|\x1b", text):
            if part == "\n":
                self.row += 1
                self.rows += [""] * (self.row + 1 - len(self.rows))
            elif part == "\r":
                self.column = 0
            elif part == "\x1b[K":
                self.rows[self.row] = self.rows[self.row][:self.column]
            elif re.fullmatch(r"\x1b\[\d*A", part):
                self.row -= int(part[2:-1] or 1)
            else:
                if part.startswith("\x1b") or self.row < 0:
                    raise ValueError(f"not expected: {part!r}")
                line = self.rows[self.row].ljust(self.column)
                self.rows[self.row] = line[:self.column] + part + line[self.column + len(part):]
                self.column += len(part)
        self.seen.append([row for row in self.rows if row])


def on_terminal(command, folder, term="xterm", stop=None):
    """The screen, with all that was seen on it, and the exit code. stop: a signal, and what is asked, with the screen, until
    it is to be sent.
    """
    main, inner = pty.openpty()
    fcntl.ioctl(inner, termios.TIOCSWINSZ, struct.pack("HHHH", 40, WIDTH, 0, 0))
    with subprocess.Popen([str(word) for word in command], cwd=folder, stdin=subprocess.DEVNULL, stdout=inner, stderr=inner,
                          env=environment(TERM=term, LC_ALL="C.UTF-8")) as process:
        os.close(inner)
        screen, waiting = Screen(), ""
        decoder = codecs.getincrementaldecoder("utf-8")(errors="replace")
        while True:
            if not select.select([main], [], [], PATIENCE)[0]:
                process.kill()
                raise TimeoutError(f"{command} hangs, with {screen.seen[-1:]}")
            try:
                data = os.read(main, 65536)
            except OSError:  # the other end is closed
                break
            if not data:
                break
            # A piece may end within a character, a control sequence, or a row that is written anew: these wait for their rest.
            text = waiting + decoder.decode(data)
            whole = text[:re.search(r"(\r[^\r\n\x1b]*)?(\x1b(\[\d*)?)?\Z", text).start()]
            waiting = text[len(whole):]
            screen.write(whole.replace("\r\n", "\n\r"))
            if stop and stop[1](screen):
                process.send_signal(stop[0])
                stop = None
        screen.write(waiting + decoder.decode(b"", final=True))
        os.close(main)
    return screen, process.returncode


def shown(screen):
    """All rows that ever were on the screen."""
    return [row for rows in screen.seen for row in rows]


def percents(screen):
    """That the bar showed, as they came, with the time left behind them."""
    return [int(match[1]) for match in map(LEFT.match, shown(screen)) if match]


def run(folder):
    """A bar for pilots and run, which is gone at the end; log.txt has the lines."""
    slow = [PROGRAM, "run", PRM / "examples/earthworm.prm", "--set", "Accuracy=1e-9", "--set", "Time/Engine=petsc"]
    screen, code = on_terminal([*slow, "--output", "bar", "--set", "Time/End time=1e4"], folder,
                               stop=(signal.SIGTERM, lambda screen: len(set(percents(screen))) > 2))
    expect(code == 5 and not any(BAR.match(row) for row in screen.seen[-1]),
           f"a run that is stopped leaves no bar: {code}, {screen.seen[-1]}")
    grows = percents(screen)
    expect(len(set(grows)) > 2 and grows == sorted(grows) and grows[-1] <= 100, f"the bar grows: {grows}")
    expect(max(len(row) for row in shown(screen) if BAR.match(row)) <= WIDTH, "no bar is wider than the terminal")
    expect("\x1b" not in (folder / "bar/log.txt").read_text(), "log.txt has no control sequences")

    quick = [PROGRAM, "run", PRM / "examples/earthworm.prm", "--set", "Output/Number of snapshots=2"]
    screen, code = on_terminal([*quick, "--output", "whole"], folder)
    last = screen.seen[-1]
    expect(code == 0, f"the run finishes {last}")
    expect(VERSION.fullmatch(last[0]) is not None, f"the first line names the version: {last[0]}")
    expect(last[-1].startswith("Results are in whole/"), f"the last line says where the files are: {last[-1]}")
    expect(not any(BAR.match(row) for row in last), "no bar stays")
    tenths = [line for line in (folder / "whole/log.txt").read_text().splitlines() if re.match(r" +\d+ %  t = ", line)]
    expect(len(tenths) >= 8 and not any(line in last for line in tenths), "the lines are in log.txt only")

    plain = call([*quick, "--output", "plain"], folder)
    lines = plain.stdout.splitlines()
    expect(plain.returncode == 0 and "\x1b" not in plain.stdout and "\r" not in plain.stdout, "redirected: plain text")
    expect(VERSION.fullmatch(lines[0]) is not None and lines[-1].startswith("Results are in plain/"),
           "redirected: the version first, the folder last")
    expect(sum(re.match(r" +\d+ %  t = ", line) is not None for line in lines) >= 8, "redirected: a line at each tenth")
    expect(lines == (folder / "plain/log.txt").read_text().splitlines(), "log.txt has the same lines")

    screen, code = on_terminal([*quick, "--output", "dumb"], folder, term="dumb")
    expect(code == 0 and not any(BAR.match(row) for row in shown(screen)) and
           any(re.match(r" +\d+ %  t = ", row) for row in screen.seen[-1]), "a terminal that cannot do it has lines")


def quiet(folder):
    screen, code = on_terminal([PROGRAM, "run", str(PRM / "examples/earthworm.prm"), "--quiet", "--output", "quiet"],
                               folder)
    expect(code == 0 and not any(shown(screen)), "--quiet shows nothing")


def counts(screen):
    """Of points that a bar showed, as they came."""
    return [int(match[1]) for match in map(POINTS.search, shown(screen)) if match]


def sweep(folder):
    """The bar of a sweep counts the points of all ranks."""
    def command(n):
        return [PROGRAM, "sweep", PRM / "studies/sweep_p_chi.prm", "--set",
                f"Sweep/Axes=Body/Anchoring exponent : linspace(1.5, 4, {n}); "
                f"Active stress/Optimal wave/Perturbation parameter : linspace(0.05, 0.45, {n})"]

    two = on_ranks(MPIEXEC, 2)
    # mpirun gives its processes pseudo terminals even if its own output is redirected.
    done = call([*two, *command(20), "--output", "plain_sweep"], folder, variables={"TERM": "xterm"})
    expect(done.returncode == 0 and VERSION.fullmatch(done.stdout.splitlines()[0]) is not None and
           "\x1b" not in done.stdout and "█" not in done.stdout,
           f"a sweep on two ranks, redirected, is plain: {done.returncode} {done.stdout[:200]!r} {done.stderr[:200]!r}")
    for name, ranks in (("one", []), ("two", two)):
        screen, code = on_terminal([*ranks, *command(1000), "--output", name + "_stopped"], folder,
                                   stop=(signal.SIGUSR1, lambda screen: len(set(counts(screen))) > 3))
        found = counts(screen)
        expect(code == 5 and len(set(found)) > 3 and found == sorted(found) and found[-1] < 10**6,
               f"the bar of a sweep on {name} counts points: {code}, {found[:3]} ... {found[-3:]}")
        expect(any(LEFT.match(row) for row in shown(screen)), "it has the time left")
        expect(not any(BAR.match(row) and "mpirun: Forwarding" not in row for row in screen.seen[-1]),
               f"no bar stays: {screen.seen[-1]}")
        screen, code = on_terminal([*ranks, *command(20), "--output", name], folder)
        last = screen.seen[-1]
        expect(code == 0 and VERSION.fullmatch(last[0]) is not None and f"Results are in {name}/" in last[-1] and
               not any(BAR.match(row) for row in last), f"the version first, the folder last: {last[-1]}")


def optimise(folder):
    """The bar of a single start counts its evaluations, with the best so far."""
    def seen(screen):
        return [int(match[1]) for match in map(re.compile(r"(\d+) evaluations, best displacement 0\.\d+").search, shown(screen))
                if match]

    screen, code = on_terminal([PROGRAM, "optimize", str(PRM / "studies/optimize_from_rest.prm"), "--output", "optimised"],
                               folder, stop=(signal.SIGUSR1, lambda screen: len(set(seen(screen))) > 3))
    found = seen(screen)
    expect(code == 5 and len(set(found)) > 3 and found == sorted(found), f"evaluations of a start: {code}, {found}")
    expect(not any("of 1 starts" in row for row in shown(screen)), "a single start is not counted")


checks.run((run, quiet, optimise), (sweep,))
