# SPDX-License-Identifier: LGPL-2.1-or-later
"""Comparison of several scenes by the same data: a folder in which each fit has a folder of its own."""
import csv
import io
import pathlib

import numpy as np

from ..needs import FileError, InputError, write_whole
from .earlier import Earlier
from .folder import bytes_of, drawn, is_finished, require_usable

TABLE, SUMMARY, PAGES = "comparison.csv", "summary.json", ("comparison.png", "report.html")
# Entries that weigh the data.
WEIGHED_BY = tuple(f"Fit/{name}" for name in ("Standard deviation", "Place deviation", "Origin", "First time"))


class Comparison:
    """Files of a comparison."""

    def __init__(self, path, options):
        """Constructor; writes nothing yet. Raises InputError if the folder has content that must not be replaced or
        resumed."""
        self.path, self.files, self.was_finished = path, options.files, False
        self.earlier = Earlier(path, (TABLE, SUMMARY, *PAGES))
        require_usable(path, "comparison", (TABLE,), options.resume, options.overwrite)

    def begin(self):
        """Makes the folder with a mark that the comparison has not ended. Raises FileError."""
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            self.earlier.recover()
            self.was_finished = is_finished(self.path)
            self.earlier.move_aside(self.was_finished)
        except OSError as error:
            raise FileError(f'cannot write to "{self.path}": {error.strerror or error}') from None
        write_whole(self.path / TABLE, b"scene,folder\n")
        self.note([])

    def note(self, finished):
        """Records in words which scenes are finished, for readers of a comparison that was interrupted."""
        there = f"finished: {', '.join(finished)}, each in a folder of its own" if finished else "none of them is finished"
        write_whole(self.path / SUMMARY, bytes_of({"status": "stopped", "reason": "signal", "comparison": [], "message":
                                                   f"the comparison of {', '.join(self.files)} has not ended ({there}); --resume continues"}))

    def leave(self):
        """Removes the folder if no scene has left anything in it."""
        if any((self.path / pathlib.Path(name).stem).exists() for name in self.files):
            return
        for name in (TABLE, SUMMARY):
            (self.path / name).unlink(missing_ok=True)
        if self.path.is_dir() and not any(self.path.iterdir()):
            self.path.rmdir()

    def written(self, fits, origin):
        """Writes the files and returns lines for the screen. Scenes whose search did not end are left out of the table.
        fits: {name of a parameter file: Fit}; origin: further entries of summary.json."""
        rows = compared({name: found for name, found in fits.items() if found.status == "finished"})
        open_ends = [name for name, found in fits.items() if found.status != "finished"]
        message = f"the search did not end for {', '.join(open_ends)}: not in the comparison" if open_ends else ""
        summary = {"status": "failed" if open_ends else "finished", "reason": "no_convergence" if open_ends else "converged",
                   "message": message, "comparison": rows, **origin}
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows([rows[0] if rows else ["scene"], *(row.values() for row in rows)])
        write_whole(self.path / TABLE, text.getvalue().encode())
        write_whole(self.path / SUMMARY, bytes_of(summary))
        self.earlier.drop()
        return [*(table_of(rows) if rows else ()), *filter(None, [message, rows and drawn(self.path)]), f"Files in {self.path}/"]


def require_comparable(models):
    """Raises InputError unless all scenes are judged by the same numbers in the same way: only then do the likelihoods,
    and with them the criteria, refer to the same data. models: {name of a parameter file: Model}."""
    (first, one), *others = models.items()
    for name, other in others:
        for entry in WEIGHED_BY:
            here, there = (model.parameters[entry] for model in (one, other))
            if here != there:
                raise InputError(f'"{entry}" is {_text(here)} in "{first}", but {_text(there)} in "{name}"; the same is expected of all scenes that are compared, '
                                 "as the data are weighed by it")
        series = [(here, there) for here in one.data.series for there in other.data.series if here.kind == there.kind]
        if not len(series) == len(one.data.series) == len(other.data.series) or any(
                not np.array_equal(getattr(here, key), getattr(there, key), equal_nan=key != "deviation")
                for here, there in series for key in ("t", "values", "relative", "deviation")):
            raise InputError(f'"{first}" and "{name}" are not fitted to the same data, which is expected of scenes that are compared (--data gives them for all)')


def _text(value):
    return f"{value:g}" if isinstance(value, (int, float)) else value


def compared(fits):
    """Scenes in the order in which the data prefer them (Akaike), a list of dicts: folder, chi-square, the criteria of
    Akaike and Bayes, and their differences to the least."""
    best = {key: min((found.information[key] for found in fits.values()), default=0.0) for key in ("aic", "bic")}
    return [{"scene": name, "folder": pathlib.Path(name).stem, "variables": len(found.variables), "chi_square": found.goodness.chi_square,
             "degrees_of_freedom": found.goodness.degrees_of_freedom, **found.information,
             **{f"{key}_less_least": found.information[key] - best[key] for key in best}}
            for name, found in sorted(fits.items(), key=lambda one: one[1].information.aic)]


def table_of(rows):
    """Rows of compared() as lines."""
    width = max(len(row["scene"]) for row in rows)
    yield f"{'scene':{width}}  variables  chi-square  AIC - least  BIC - least"
    for row in rows:
        yield f"{row['scene']:{width}}  {row['variables']:9}  {row['chi_square']:10.5g}  {row['aic_less_least']:11.4g}  {row['bic_less_least']:11.4g}"
