# SPDX-License-Identifier: LGPL-2.1-or-later
"""Program as started, stopped and resumed by scripts of the tests.

A stop happens at a place of the work, not at a time: the environment variable CRAWLER_STOP_AT (see
include/crawler/base/stop_place.h) raises a signal when the program gets there. So no test reads a clock; PATIENCE only
ends hanging programs.
"""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import warnings

PATIENCE = 600  # [s]
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1",
               "OPENBLAS_NUM_THREADS": "1"}
ENVIRONMENT.pop("CRAWLER_STOP_AT", None)
# Environment of studies that need no picture: their Python does nothing.
NO_PICTURES = {"PATH": f"{pathlib.Path(__file__).resolve().parent / 'no_pictures'}:{os.environ['PATH']}"}


class Checks:
    """Counts failures: `expect` notes them, `run` or `end` closes the script with the exit code."""

    def __init__(self):
        self.n, self.failures, self.skipped = 0, [], []

    def expect(self, condition, what):
        """Prints @p what, the expectation in words, if the condition is false. Returns the condition."""
        self.n += 1
        if not condition:
            self.failures.append(what)
            print(f"FAILED {what}", flush=True)
        return bool(condition)

    def refused(self, done, *words, code=2):
        """Expects that a command ended with this exit code and one short sentence that has these words. Returns whether it did."""
        return self.expect(done.returncode == code and done.stderr.count("\n") == 1 and len(done.stderr) < 3000
                           and all(word in done.stderr for word in words),
                           f"{' '.join(done.args)}: exit code {done.returncode}, {done.stderr[:800]!r}, but {words} are expected")

    def skip(self, what):
        """Notes a check that this machine cannot do, and why; the last line counts it."""
        self.skipped.append(what)
        print(f"SKIPPED {what}", flush=True)

    def run(self, alone, several=()):
        """Runs tests, each in a folder of its own, and ends. If the last argument of the script is "alone",
        only those that start no ranks; if it is "several", only the others, for which ctest reserves processors.
        """
        part = sys.argv[-1]
        with tempfile.TemporaryDirectory() as name:
            for test in (*(alone if part != "several" else ()), *(several if part != "alone" else ())):
                folder = pathlib.Path(name, test.__name__)
                folder.mkdir()
                test(folder)
        self.end()

    def end(self):
        """Exits with code 0 only if something was checked, and all of it is right."""
        print(f"{self.n} checks, {len(self.failures)} failed, {len(self.skipped)} skipped")
        sys.exit(1 if self.failures or self.n == 0 else 0)


checks = Checks()  # of the script
expect, refused, skip = checks.expect, checks.refused, checks.skip


def environment(stop_at=None, **more):
    """Environment of the program: one thread, Open MPI as root, and the place of the stop, if any."""
    return {**ENVIRONMENT, **({"CRAWLER_STOP_AT": stop_at} if stop_at else {}), **more}


def call(command, folder=None, stop_at=None, variables=None, **more):
    """Runs a command to its end; returns its exit code (negative: the signal that killed it) and its output.

    The variables are added to its environment; more are arguments of subprocess.run, such as the text of its input.
    """
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **({} if "input" in more else {"stdin": subprocess.DEVNULL})}
    return subprocess.run([str(word) for word in command], cwd=folder, env=environment(stop_at, **(variables or {})),
                          text=True, timeout=PATIENCE, check=False, **{**streams, **more})


def warnings_of(action):
    """What an action warns of, and the files it names as those of its caller."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        action()
    return [str(one.message) for one in caught], {one.filename for one in caught}


def sets(settings):
    """Words of the command line that set entries: texts like "Entry=value", or a dictionary of values."""
    if isinstance(settings, dict):
        settings = [f"{entry}={value}" for entry, value in settings.items()]
    return [word for setting in settings for word in ("--set", setting)]


def prm(*settings):
    """Text of a parameter file that sets entries: texts like "Section/Entry=value"."""
    lines = []
    for setting in settings:
        path, _, value = setting.partition("=")
        *sections, name = path.split("/")
        lines += [*("subsection " + section for section in sections), f"set {name} = {value}", *["end"] * len(sections)]
    return "\n".join(lines) + "\n"


def contents(folder):
    """Contents of all files, and names of all folders, by their paths."""
    return {path: path.read_bytes() if path.is_file() else None for path in folder.rglob("*")}


def on_ranks(mpirun, n):
    """Words before a command that n ranks run; none for one rank."""
    return [mpirun, "--oversubscribe", "-n", n] if n > 1 else []


class Places:
    """Random places of the work: a kind (step, row), or a file that is written, and a number up to the most of these.
    Those that a program did not come to are followed by earlier ones."""

    def __init__(self, chance, kinds, files, most):
        self.chance, self.kinds, self.files, self.most = chance, kinds, files, most

    def next(self):
        """Kind or file, and the place."""
        what = self.chance.choice(self.kinds)
        if what == "write":
            what = self.chance.choice(self.files)
        place = what if what in self.kinds else f"write:{what}"
        return what, f"{place}:{int(self.most.get(what, 1) ** self.chance.random())}"

    def too_late(self, what):
        """A program did not come there."""
        if what in self.most:
            self.most[what] = max(1, self.most[what] * 2 // 3)


def ranks_that_stop(mpirun, command, *places):
    """Command on as many ranks as places, each of which stops at its own (None: nowhere).

    Where one rank is to be killed in the middle of its work, another that waits from then on (STOP) leaves it enough
    work, on any machine; mpirun ends that one, too.
    """
    words = [mpirun, "--oversubscribe"]
    for i, place in enumerate(places):
        words += [":"] * (i > 0) + ["-n", 1] + (["env", f"CRAWLER_STOP_AT={place}"] if place else []) + list(command)
    return words


class Paused:
    """Command that waits at a place (its stop_at has the signal STOP) while the `with` block runs; `go_on` lets it end.

    Raises AssertionError if it ended before it came there.
    """

    def __init__(self, command, stop_at, folder=None):
        assert ":STOP" in stop_at, stop_at
        self.process = subprocess.Popen([str(word) for word in command], cwd=folder, env=environment(stop_at),
                                        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        _, status = os.waitpid(self.process.pid, os.WUNTRACED)
        if not os.WIFSTOPPED(status):
            self.process.returncode = os.waitstatus_to_exitcode(status)
            raise AssertionError(f"{command} ended before {stop_at}: {status}, {self.process.stderr.read()}")

    def go_on(self, *signals):
        """Sends these signals, then lets it go on to its end. Returns its exit code and output."""
        for number in signals:
            self.process.send_signal(number)
        self.process.send_signal(signal.SIGCONT)
        out, errors = self.process.communicate(timeout=PATIENCE)
        return subprocess.CompletedProcess(self.process.args, self.process.returncode, out, errors)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.communicate()
