# SPDX-License-Identifier: LGPL-2.1-or-later
"""Command-line options for reading a file of samples or tracks: of crawler table and crawler fit."""
import argparse

TEXT, NUMBER, WHOLE = {"metavar": "TEXT"}, {"metavar": "NUMBER", "type": float}, {"metavar": "WHOLE NUMBER", "type": int}
READING = (("quantity", TEXT, "m, strain, stretch or markers (default: by the names of columns)"),
           ("columns", TEXT, 'other names of columns: "t=Frame time, x=X"'),
           ("animal", TEXT, "which one of several is read"),
           ("head", TEXT, "the marker at the head (default: that with the largest x)"),
           ("decimal", TEXT, "comma or point: the decimal separator, where a comma may also group thousands"),
           ("confidence", NUMBER, "markers with less confidence are gaps (default: 0)"),
           ("unit-of-s", TEXT, "factor of s and x, or the unit they are converted into: mm"),
           ("unit-of-t", TEXT, "the same for t; 1/30: frames of a film of 30 a second"),
           ("unit-of-m", TEXT, "the same for m (may be negative) or strain"),
           ("shift-s", TEXT, 'number that is added to s; "first": the first s becomes 0'),
           ("shift-t", TEXT, "the same for t"))


def add_options(parser, options):
    """Adds options that are absent unless they are set."""
    for name, kind, help_text in options:
        parser.add_argument(f"--{name}", help=help_text, default=argparse.SUPPRESS, **kind)


def add_reading_options(parser):
    """Adds the options of read_samples()."""
    add_options(parser, READING)


def parts_of(options, names):
    """Options with these names."""
    return {name: value for name, value in vars(options).items() if name in names}


def reading_of(options):
    """Arguments of read_samples() that are set."""
    return parts_of(options, {name.replace("-", "_") for name, _, _ in READING})


def words_of(reading):
    """Result of reading_of() as words of a command line."""
    return [word for name, value in reading.items() for word in (f"--{name.replace('_', '-')}", str(value))]
