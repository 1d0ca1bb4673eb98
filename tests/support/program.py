# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program as scripts of the tests start, stop and continue it.

A stop happens at a place of the work, not at a time: the environment variable CRAWLER_STOP_AT (see
include/crawler/base/stop_place.h) raises a signal when the program gets there. So no test reads a clock; PATIENCE only
ends what hangs.
"""
import os
import pathlib
import signal
import subprocess
import sys

PATIENCE = 600  # seconds
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1",
               "OPENBLAS_NUM_THREADS": "1"}
ENVIRONMENT.pop("CRAWLER_STOP_AT", None)
# For studies that need no picture: their Python does nothing.
NO_PICTURES = {"PATH": f"{pathlib.Path(__file__).resolve().parent / 'no_pictures'}:{os.environ['PATH']}"}


class Checks:
    """Counts what is wrong: `expect` notes it, `end` closes the script with the exit code."""

    def __init__(self):
        self.n, self.failures, self.skipped = 0, [], []

    def expect(self, condition, what):
        """What is to be, in words; printed if it is not. Returns whether it is."""
        self.n += 1
        if not condition:
            self.failures.append(what)
            print(f"FAILED {what}", flush=True)
        return bool(condition)

    def skip(self, what):
        """What this machine cannot check, and why; the last line counts it."""
        self.skipped.append(what)
        print(f"SKIPPED {what}", flush=True)

    def end(self):
        """Exit code 0 only if something was checked, and all of it is right."""
        print(f"{self.n} checks, {len(self.failures)} failed, {len(self.skipped)} skipped")
        sys.exit(1 if self.failures or self.n == 0 else 0)


def environment(stop_at=None, **more):
    """Of the program: one thread, Open MPI as root, and where it is to stop, if anywhere."""
    return {**ENVIRONMENT, **({"CRAWLER_STOP_AT": stop_at} if stop_at else {}), **more}


def call(command, folder=None, stop_at=None, variables=None, **more):
    """Runs a command to its end, and gives its exit code (negative: the signal that killed it) and what it printed.

    The variables are added to its environment; more are arguments of subprocess.run, such as the text of its input.
    """
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **({} if "input" in more else {"stdin": subprocess.DEVNULL})}
    return subprocess.run([str(word) for word in command], cwd=folder, env=environment(stop_at, **(variables or {})),
                          text=True, timeout=PATIENCE, check=False, **{**streams, **more})


def on_ranks(mpirun, n):
    """What stands before a command that n ranks run; nothing for one."""
    return [mpirun, "--oversubscribe", "-n", n] if n > 1 else []


def tests_of_part(alone, several):
    """The tests of this call of a script, whose last argument may be "alone": those that start no ranks; or "several": those
    that do, which ctest gives the processors that they need. Without either: all.
    """
    part = sys.argv[-1]
    return (*(alone if part != "several" else ()), *(several if part != "alone" else ()))


def ranks_that_stop(mpirun, command, *places):
    """This command on as many ranks as places, each of which stops at its own (None: nowhere).

    Where one rank is to be killed in the middle of its work, another that waits from then on (STOP) leaves it enough of it,
    on any machine; mpirun ends that one, too.
    """
    words = [mpirun, "--oversubscribe"]
    for i, place in enumerate(places):
        words += [":"] * (i > 0) + ["-n", 1] + (["env", f"CRAWLER_STOP_AT={place}"] if place else []) + list(command)
    return words


class Paused:
    """A command that waits at a place (its stop_at has the signal STOP) while the `with` block runs; `go_on` lets it end.

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
        """These signals are sent, then it goes on to its end. Gives its exit code and what it printed."""
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
