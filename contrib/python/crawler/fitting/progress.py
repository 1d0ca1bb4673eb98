# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines on the screen that say what a fit does: each beginning and end, and in between one every few seconds."""
import time

EVERY = 5.0  # [s]


class Progress:
    """Lines of a fit, whose runs it counts."""

    def __init__(self, say):
        """Constructor. say: called with each line."""
        self.say, self.doing, self.n_runs, self.last = say, "", 0, time.monotonic()

    def __call__(self, text):
        """Says a line."""
        self.say(text)
        self.last = time.monotonic()

    def begin(self, doing):
        """Names what the following runs are for."""
        self.doing, self.n_runs = doing, 0

    def ran(self, n, words=lambda: ""):
        """Counts n runs, and says so every few seconds; words: what there is so far."""
        self.n_runs += n
        if time.monotonic() - self.last >= EVERY:
            self(f"{self.doing}: {self.n_runs} runs{words()}")
