# SPDX-License-Identifier: LGPL-2.1-or-later
"""Earlier results in a folder: moved aside for new ones, removed when these are there, and moved back if they are not."""
import os
import pathlib
import shutil

ASIDE = "replaced"
NAMES = (ASIDE, f"{ASIDE}.part")  # the latter has a part of the earlier results; the rest is still in its place


def remove(path, names):
    """Removes files, and folders with all that is in them; the last ones first, as the first ones tell whose they are."""
    for name in reversed(names):
        if (path / name).is_dir():
            shutil.rmtree(path / name)
        else:
            (path / name).unlink(missing_ok=True)


class Earlier:
    """Earlier results, files and folders with these names. A kill at any time loses none of them."""

    def __init__(self, path, names):
        """Constructor; changes nothing yet."""
        self.path, self.names, self.has_made_place = pathlib.Path(path), names, False
        self.aside, self.moving = (self.path / name for name in NAMES)

    def are_aside(self):
        """Returns True if there are earlier results that have been moved aside."""
        return self.aside.is_dir()

    def recover(self):
        """Undoes a move that was interrupted."""
        if self.moving.is_dir():
            for file in self.moving.iterdir():
                os.replace(file, self.path / file.name)
            self.moving.rmdir()

    def move_aside(self, is_over):
        """Makes place for new results. is_over: those that are aside already have been replaced; otherwise it is the
        newer ones, which were not finished, that are removed."""
        there = [name for name in self.names if (self.path / name).exists()]
        if self.are_aside() and not is_over:
            remove(self.path, self.names)
        elif there:
            self.drop()
            self.moving.mkdir()
            for name in there:
                os.replace(self.path / name, self.moving / name)
            self.moving.rename(self.aside)
        self.has_made_place = True

    def move_back(self):
        """Removes new results, if there was made place for them, and moves the earlier ones back."""
        if self.has_made_place:
            remove(self.path, self.names)
            if self.are_aside():
                self.aside.rename(self.moving)
        self.recover()

    def drop(self):
        """Removes the earlier results for good."""
        remove(self.path, [ASIDE])
