# SPDX-License-Identifier: LGPL-2.1-or-later
"""Is the documentation up to date?  documentation.py PATH_TO_CRAWLER

Fails, naming file and line, if a generated file differs from what the program prints, if a relative link in a
Markdown file points to nothing or two headings of a file are alike, if a text names an entry "Section/Entry" that does
not exist, or if a parameter file shown in a block marked "prm" is refused by "crawler check"; if a document or a
comment in the code names a heading (doc/theory.md, "Energies") or a publication (@cite) that does not exist.
"""
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
GENERATED = (("prm/default.prm", "prm"),)
SKIPPED = re.compile(r"build.*|output.*|\..*|__pycache__")
# `Section/Entry`, `Section/Sub section/Entry` and `Section/Entry = value`; paths of files begin in lower case.
ENTRY = re.compile(r"([A-Z][\w ]*(?:/[A-Z][\w ]*)+)(?: ?=.*)?")
OVERRIDE = re.compile(r"--set[ =]\\?\"([^\"=\\]+)=")


def ask(program, *arguments, text=None):
    """What the program prints; its errors if it refuses."""
    result = subprocess.run([program, *arguments], input=text or "", capture_output=True, encoding="utf-8", check=False)
    if result.returncode != 0:
        raise RuntimeError(result.stderr.strip())
    return result.stdout


def markdown_files():
    """All Markdown files of the repository."""
    for path in sorted(ROOT.rglob("*.md")):
        if not any(SKIPPED.fullmatch(part) for part in path.relative_to(ROOT).parts[:-1]):
            yield path


def split_blocks(text):
    """Lines (number, text) outside of fenced blocks, and the blocks (first line's number, language, text)."""
    lines, blocks, fence = [], [], None
    for number, line in enumerate(text.splitlines(), 1):
        mark = re.match(r"\s*```(\w*)", line)
        if mark and fence is None:
            fence = [number + 1, mark.group(1), []]
        elif mark:
            blocks.append((fence[0], fence[1], "\n".join(fence[2]) + "\n"))
            fence = None
        elif fence is not None:
            fence[2].append(line)
        else:
            lines.append((number, line))
    return lines, blocks


def anchors(path):
    """The names that links to headings of a Markdown file use."""
    names = set()
    for _, line in split_blocks(path.read_text(encoding="utf-8"))[0]:
        if line.startswith("#"):
            heading = re.sub(r"[^\w\- ]", "", line.lstrip("#").strip().lower())
            names.add(heading.replace(" ", "-"))
    return names


def bad_links(path, lines):
    """Relative links to files or headings that do not exist."""
    for number, line in lines:
        if line.startswith("    "):
            continue
        for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", line)):
            if re.match(r"[a-z]+:", target):
                continue
            file, _, anchor = target.partition("#")
            other = (path.parent / file).resolve() if file else path
            if not other.exists():
                yield number, f"the link \"{target}\" points to nothing"
            elif anchor and other.suffix == ".md" and anchor not in anchors(other):
                yield number, f"the link \"{target}\" points to no heading"


def repeated_headings(lines):
    """Headings that a link could not tell apart."""
    seen = set()
    for number, line in lines:
        if line.startswith("#") and line.lstrip("#") in seen:
            yield number, f"a second heading \"{line.lstrip('# ')}\""
        elif line.startswith("#"):
            seen.add(line.lstrip("#"))


def bad_references():
    """Headings and publications that comments and documents name and that do not exist."""
    keys = set(re.findall(r"@\w+\{([^,]+),", (ROOT / "doc/references.bib").read_text(encoding="utf-8")))
    places = {path.stem: path.read_text(encoding="utf-8") for path in (ROOT / "doc").glob("*.md")}
    # A heading, or the bold beginning of a paragraph.
    places = {stem: re.findall(r"^(?:#+ (?:\d+\. )?|\W*\*\*)(.*)", text, re.M) for stem, text in places.items()}
    code = [p for folder in ("include", "source", "tests") for end in ("h", "cc") for p in (ROOT / folder).rglob(f"*.{end}")]
    for path in sorted([*code, *markdown_files()]):
        text = re.sub(r"\n *(?:\*|///?)(?= )", "\n", path.read_text(encoding="utf-8"))  # without marks of comments
        for match in re.finditer(r"\b(\w+)\.md,\s+\"([^\"]+)\"", text):
            words = " ".join(match.group(2).split())
            if not any(place.startswith(words) for place in places.get(match.group(1), [])):
                yield path, text.count("\n", 0, match.start()) + 1, f"{match.group(1)}.md has no \"{words}\""
        for match in re.finditer(r"[@\\]cite (\w+)", text):
            if match.group(1) not in keys:
                yield path, text.count("\n", 0, match.start()) + 1, f"references.bib has no \"{match.group(1)}\""


def bad_entries(text, names):
    """Entries that the program does not have."""
    for number, line in enumerate(text.splitlines(), 1):
        spans = [m.group(1) for m in map(ENTRY.fullmatch, re.findall(r"`([^`]+)`", line)) if m]
        for name in spans + OVERRIDE.findall(line):
            if name.strip() not in names and name.strip() != "Section/Entry":
                yield number, f"the program has no entry \"{name.strip()}\""


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    problems = []
    for file, form in GENERATED:
        command = f"crawler parameters --format {form} > {file}"
        path = ROOT / file
        if not path.exists() or path.read_text(encoding="utf-8") != ask(program, "parameters", "--format", form):
            problems.append(f"{file} is out of date; run {command}")
    names = set()
    for entry in json.loads(ask(program, "parameters", "--format", "json")):
        words = entry["entry"].split("/")
        names.update("/".join(words[:n]) for n in range(1, len(words) + 1))  # sections may be named as well
        if not entry["expected"] or not entry["documentation"]:
            problems.append(f"the entry {entry['entry']} does not say what it means and what is expected")
    for path in markdown_files():
        text = path.read_text(encoding="utf-8")
        lines, blocks = split_blocks(text)
        found = [*bad_links(path, lines), *repeated_headings(lines), *bad_entries(text, names)]
        for number, language, block in blocks:
            if language == "prm":
                try:
                    ask(program, "check", "-", text=block)
                except RuntimeError as error:
                    found.append((number, f"the program refuses this parameter file: {error}"))
        problems += [f"{path.relative_to(ROOT)}, line {number}: {problem}" for number, problem in sorted(found)]
    problems += [f"{path.relative_to(ROOT)}, line {number}: {problem}" for path, number, problem in bad_references()]
    print("\n".join(problems) if problems else "the documentation is up to date")
    return len(problems)


if __name__ == "__main__":
    sys.exit(1 if main() else 0)
