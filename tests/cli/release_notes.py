#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every file of doc/changes has the form that contrib/release_notes.py needs, other forms are refused by name, notes
have the newest change first and, with a tag, only what came after it; and the version is that of the last tag.

    python3 release_notes.py CMAKE
"""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
failures = []


def expect(condition, what):
    if not condition:
        failures.append(what)


def call(*words, folder):
    end = subprocess.run([str(word) for word in words], cwd=folder, capture_output=True, text=True, check=False)
    return end.returncode, end.stdout + end.stderr


def git(folder, *words):
    code, out = call("git", "-c", "user.name=t", "-c", "user.email=t@localhost", *words, folder=folder)
    expect(code == 0, f"git {words}: {out}")


def version(folder):
    """CRAWLER_VERSION, CRAWLER_NUMBERS of a folder."""
    script = folder / "print.cmake"
    script.write_text(f'include("{ROOT}/contrib/package/version.cmake")\ncrawler_version("{folder}" 0.1.0)\n'
                      'message(STATUS "${CRAWLER_VERSION} ${CRAWLER_NUMBERS} ${CRAWLER_REVISION}")\n')
    code, out = call(sys.argv[1], "-P", script, folder=folder)
    script.unlink()
    expect(code == 0, out)
    return out.strip().splitlines()[-1].split()[1:]


code, out = call(ROOT / "contrib/release_notes.py", "--check", folder=ROOT)
expect(code == 0 and out == "", f"doc/changes: {out}")

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    (folder / "contrib").mkdir()
    (folder / "doc/changes").mkdir(parents=True)
    script = folder / "contrib/release_notes.py"
    script.write_text((ROOT / "contrib/release_notes.py").read_text())

    def notes(*arguments):
        return call(sys.executable, script, *arguments, folder=folder)

    def change(topic, text):
        (folder / "doc/changes" / topic).write_text(text)

    expect(version(folder) == ["0.1.0", "0.1.0", "unknown"], "the version without git")
    git(folder, "init", "-q")
    change("20260101_first", "New: The first.\n")
    git(folder, "add", ".")
    git(folder, "commit", "-qm", "First")
    expect(version(folder)[:2] == ["0.1.0", "0.1.0"], "the version without a tag")
    git(folder, "tag", "v1.2.3")
    expect(version(folder)[:2] == ["1.2.3", "1.2.3"], "the version at a tag")
    change("20260102_second", "Fixed: The second.\nNew: The third.\n")
    git(folder, "add", ".")
    git(folder, "commit", "-qm", "Second")
    expect(version(folder)[:2] == ["1.2.3+1", "1.2.3"], "the version after a tag")
    (folder / "inside").mkdir()
    expect(version(folder / "inside") == ["0.1.0", "0.1.0", "unknown"], "the version of a folder in another repository")

    expect(notes() == (0, "## New\n\n- The third.\n- The first.\n\n## Fixed\n\n- The second.\n"), f"notes: {notes()}")
    expect(notes("v1.2.3") == (0, "## New\n\n- The third.\n\n## Fixed\n\n- The second.\n"), "notes since a tag")
    code, out = notes("v7.0.0")
    expect(code == 1 and "does not know the tag v7.0.0" in out, "notes since a tag that does not exist")
    expect(notes("--debian", "1.2.3")[1].startswith("crawler (1.2.3) unstable; urgency=medium\n\n  * Fixed: The second."),
           "Debian's changelog")
    for topic, text in (("20260103_kind", "Added: A thing.\n"), ("20260103_lines", "New: A sentence over\ntwo lines.\n"),
                        ("20260103_end", "New: no end\n"), ("20261303_month", "New: A.\n"), ("20260103_name.md", "New: A.\n")):
        change(topic, text)
        code, out = notes("--check")
        expect(code == 1 and topic in out, f"{topic} is not refused: {out}")
        (folder / "doc/changes" / topic).unlink()

sys.exit("\n".join(failures) or 0)
