#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""doc/changes.md has the form that contrib/release_notes.py needs, another form is refused with its line, notes are those
of a version, the newest by default; and the version of the program is that of the last tag.

    python3 release_notes.py CMAKE
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from program import call, checks, expect  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]


def ended(*words, folder):
    end = call(words, folder)
    return end.returncode, end.stdout + end.stderr


def git(folder, *words):
    code, out = ended("git", "-c", "user.name=t", "-c", "user.email=t@localhost", *words, folder=folder)
    expect(code == 0, f"git {words}: {out}")


def version(folder):
    """CRAWLER_VERSION, CRAWLER_NUMBERS of a folder."""
    script = folder / "print.cmake"
    script.write_text(f'include("{ROOT}/contrib/package/version.cmake")\ncrawler_version("{folder}" 0.1.0)\n'
                      'message(STATUS "${CRAWLER_VERSION} ${CRAWLER_NUMBERS} ${CRAWLER_REVISION}")\n')
    code, out = ended(sys.argv[1], "-P", script, folder=folder)
    script.unlink()
    expect(code == 0, out)
    return out.strip().splitlines()[-1].split()[1:]


code, out = ended(ROOT / "contrib/release_notes.py", "--check", folder=ROOT)
expect(code == 0 and out == "", f"doc/changes.md: {out}")

def main(folder):
    (folder / "contrib").mkdir()
    (folder / "doc").mkdir()
    script, changes = folder / "contrib/release_notes.py", folder / "doc/changes.md"
    script.write_text((ROOT / "contrib/release_notes.py").read_text())
    TEXT = ("# Changes\n\n## 1.3.0 (2026-01-02)\n\n- Fixed: The second.\n- New: The third.\n\n"
            "## 1.2.3 (2026-01-01)\n\n- New: The first.\n")
    changes.write_text(TEXT)

    def notes(*arguments):
        return ended(sys.executable, script, *arguments, folder=folder)

    expect(version(folder) == ["0.1.0", "0.1.0", "unknown"], "the version without git")
    git(folder, "init", "-q")
    git(folder, "add", ".")
    git(folder, "commit", "-qm", "First")
    expect(version(folder)[:2] == ["0.1.0", "0.1.0"], "the version without a tag")
    git(folder, "tag", "v1.2.3")
    expect(version(folder)[:2] == ["1.2.3", "1.2.3"], "the version at a tag")
    git(folder, "commit", "-qm", "Second", "--allow-empty")
    expect(version(folder)[:2] == ["1.2.3+1", "1.2.3"], "the version after a tag")
    (folder / "inside").mkdir()
    expect(version(folder / "inside") == ["0.1.0", "0.1.0", "unknown"], "the version of a folder in another repository")

    expect(notes() == (0, "## New\n\n- The third.\n\n## Fixed\n\n- The second.\n"), f"notes: {notes()}")
    expect(notes("1.2.3") == (0, "## New\n\n- The first.\n"), "notes of an older version")
    code, out = notes("7.0.0")
    expect(code == 1 and "no version 7.0.0" in out, "notes of a version that does not exist")
    code, out = notes("--debian", "1.3.1")
    expect(code == 0 and out.startswith("crawler (1.3.1) unstable; urgency=medium\n\n  * Fixed: The second.")
           and "crawler (1.2.3) unstable" in out and "Thu, 01 Jan 2026" in out, f"Debian's changelog: {out}")
    for line in ("- Added: A thing.", "- New: A sentence over\ntwo lines.", "- New: no end", "## 1.2 (2026-01-01)",
                 "## 1.2.0 (2026-13-01)", "- New:", "A sentence."):
        changes.write_text(TEXT + line + "\n")
        code, out = notes("--check")
        expect(code == 1 and "line 11" in out and line.splitlines()[0][:40] in out, f"{line} is not refused: {out}")


checks.run((main,))
