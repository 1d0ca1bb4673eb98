#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Release notes (Markdown) of a version from doc/changes.md: what is new, improved, fixed and removed.

    contrib/release_notes.py                  # those of the newest version
    contrib/release_notes.py 1.2.0            # those of this one
    contrib/release_notes.py --check          # nothing but a check of the file: exit status 1 if it has another form
    contrib/release_notes.py --debian 1.2.0   # a Debian changelog of all versions, the newest under this number
"""
import argparse
import datetime
import email.utils
import pathlib
import re
import sys
import textwrap

CHANGES = pathlib.Path(__file__).resolve().parents[1] / "doc/changes.md"
KINDS = ("New", "Improved", "Fixed", "Removed")


def versions():
    """[number, date, [(kind, sentence), ...]] of each version, the newest first; ValueError names a wrong line."""
    found = []
    for number, line in enumerate(CHANGES.read_text(encoding="utf-8").splitlines(), 1):
        try:
            if line.startswith("## "):
                version, date = re.fullmatch(r"## (\d+\.\d+\.\d+) \((\d{4}-\d\d-\d\d)\)", line).groups()
                found.append([version, datetime.date.fromisoformat(date), []])
            elif found and line:
                found[-1][2].append(re.fullmatch(rf"- ({'|'.join(KINDS)}): (\S.*[.!?)])", line).groups())
        except (AttributeError, ValueError):
            raise ValueError(f'doc/changes.md, line {number}: "{line[:40]}" is neither "## X.Y.Z (YYYY-MM-DD)" nor "- KIND: '
                             f'SENTENCE." with one of the kinds {", ".join(KINDS)}') from None
    return found


def markdown(changes):
    """The changes by their kinds."""
    parts = []
    for kind in KINDS:
        lines = ["- " + sentence for one, sentence in changes if one == kind]
        if lines:
            parts.append(f"## {kind}\n\n" + "\n".join(lines))
    return "\n\n".join(parts)


def debian(version, date, changes):
    """An entry of a Debian changelog."""
    lines = [textwrap.fill(f"{kind}: {sentence}", 78, initial_indent="  * ", subsequent_indent="    ",
                           break_long_words=False) for kind, sentence in changes]
    time = datetime.datetime.combine(date, datetime.time(), datetime.timezone.utc)
    return (f"crawler ({version}) unstable; urgency=medium\n\n" + "\n".join(lines)
            + f"\n\n -- The authors of crawler <crawler@localhost>  {email.utils.format_datetime(time)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("version", nargs="?")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--debian", metavar="VERSION")
    arguments = parser.parse_args()
    try:
        found = versions()
    except ValueError as error:
        sys.exit(str(error))
    wanted = [one for one in found if arguments.version in (None, one[0])]
    if not wanted:
        sys.exit(f"doc/changes.md has no version {arguments.version}")
    if arguments.debian:
        found[0][0] = arguments.debian
        print("\n\n".join(debian(*one) for one in found))
    elif not arguments.check:
        print(markdown(wanted[0][2]))


if __name__ == "__main__":
    main()
