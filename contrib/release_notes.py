#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Release notes (Markdown) from the files of doc/changes: what is new, improved and fixed, the newest first.

    contrib/release_notes.py             # all changes
    contrib/release_notes.py v1.2.0      # those since this tag
    contrib/release_notes.py --check     # nothing but a check of the files: exit status 1 if one has another form
    contrib/release_notes.py --debian 1.2.0   # a Debian changelog of all changes, as of that version
"""
import argparse
import datetime
import email.utils
import pathlib
import re
import subprocess
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[1]
KINDS = ("New", "Improved", "Fixed")


def changes_of(path):
    """Date, kind and sentence of each line of a file; ValueError if the file has another form."""
    if not re.fullmatch(r"20\d{6}_[a-z0-9_]+", path.name):
        raise ValueError(f"doc/changes/{path.name}: the name is not of the form YYYYMMDD_topic (small letters)")
    try:
        date = datetime.datetime.strptime(path.name[:8], "%Y%m%d").date()
    except ValueError:
        raise ValueError(f"doc/changes/{path.name}: the name does not begin with a date") from None
    for line in path.read_text(encoding="utf-8").splitlines():
        kind, colon, sentence = line.partition(": ")
        if not colon or kind not in KINDS or not sentence.strip().endswith((".", "!", "?", ")")):
            raise ValueError(f"doc/changes/{path.name}: \"{line[:40]}...\" is not a sentence after "
                             + ", ".join(kind + ":" for kind in KINDS[:-1]) + f" or {KINDS[-1]}: (on one line)")
        yield date, kind, sentence.strip()


def all_changes(names=None):
    """The changes of these files (default: all), the newest first, and what is wrong with files."""
    found, wrong = [], []
    for path in sorted((ROOT / "doc/changes").iterdir(), reverse=True):
        if names is None or path.name in names:
            try:
                found += changes_of(path)
            except ValueError as error:
                wrong.append(str(error))
    return found, wrong


def names_since(tag):
    """Names of the files of doc/changes that came after a tag."""
    git = subprocess.run(["git", "diff", "--name-only", "--diff-filter=A", tag, "--", "doc/changes"], cwd=ROOT,
                         capture_output=True, text=True, check=False)
    if git.returncode != 0:
        sys.exit(f"git does not know the tag {tag}: {git.stderr.splitlines()[0]}")
    return {pathlib.Path(line).name for line in git.stdout.splitlines()}


def markdown(found):
    """The notes as Markdown."""
    parts = []
    for kind in KINDS:
        lines = ["- " + sentence for date, one, sentence in found if one == kind]
        if lines:
            parts.append(f"## {kind}\n\n" + "\n".join(lines))
    return "\n\n".join(parts)


def debian(found, version):
    """The notes as a Debian changelog."""
    lines = [textwrap.fill(f"{kind}: {sentence}", 78, initial_indent="  * ", subsequent_indent="    ",
                           break_long_words=False) for date, kind, sentence in found]
    date = datetime.datetime.combine(max(date for date, _, _ in found), datetime.time(), datetime.timezone.utc)
    return (f"crawler ({version}) unstable; urgency=medium\n\n" + "\n".join(lines)
            + f"\n\n -- The authors of crawler <crawler@localhost>  {email.utils.format_datetime(date)}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tag", nargs="?")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--debian", metavar="VERSION")
    arguments = parser.parse_args()
    found, wrong = all_changes(names_since(arguments.tag) if arguments.tag else None)
    if wrong:
        sys.exit("\n".join(wrong))
    if not found:
        sys.exit("There are no changes" + (f" since {arguments.tag}" if arguments.tag else ""))
    if not arguments.check:
        print(debian(found, arguments.debian) if arguments.debian else markdown(found))


if __name__ == "__main__":
    main()
