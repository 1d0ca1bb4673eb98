#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""The size and the structure of the program in numbers, as a Markdown table.

    contrib/house.py [COMMIT]

Counts what is in include/ and source/: lines for each room, files that include each other in circles, long functions
and headers; of the present files, and of COMMIT beside them. Needs git for COMMIT only.
"""
import collections
import os
import re
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import check_layers  # noqa: E402

LONG_FUNCTION, LONG_HEADER, MANY_MEMBERS = 60, 250, 15


def files_now():
    """Path and text of each file."""
    for path in [*check_layers.files_below("include/crawler"), *check_layers.files_below("source")]:
        with open(os.path.join(check_layers.ROOT, path), encoding="utf-8") as file:
            yield path, file.read()


def files_of(commit):
    """The same of a commit."""
    def git(*arguments):
        return subprocess.run(["git", "-C", check_layers.ROOT, *arguments], check=True, capture_output=True, text=True).stdout
    for path in git("ls-tree", "-r", "--name-only", commit, "include/crawler", "source").splitlines():
        if re.search(r"\.(h|cc|h\.in)$", path):
            yield path, git("show", f"{commit}:{path}")


def blocks(text):
    """Name, kind and lines of each function and class; the braces stand on lines of their own. Texts of programs in other
    languages (raw strings) do not count."""
    lines, opened = re.sub(r'R"([^\s(]*)\(.*?\)\1"', '""', text, flags=re.DOTALL).split("\n"), []
    for number, line in enumerate(lines):
        indent = len(line) - len(line.lstrip())
        if line.strip() == "{":
            head, above = [], number - 1
            while above >= 0 and lines[above].strip() and not re.search(r"[;{}]$|^\s*(//|\*|/\*|#|public:|private:)", lines[above]):
                head.insert(0, lines[above].strip())
                above -= 1
            opened.append((indent, number, " ".join(head)))
        elif re.fullmatch(r"}[;,]?(\s*//.*)?", line.strip()) and opened and opened[-1][0] == indent:
            _, start, head = opened.pop()
            if re.match(r"(inline )?namespace\b", head):
                continue
            if re.search(r"\b(class|struct)\b", head) and "(" not in head:
                yield re.search(r"\b(?:class|struct) (\w+)", head + " struct _")[1], "class", lines[start + 1:number]
            elif "(" in head and not re.match(r"(if|for|while|switch|else|do|catch)\b", head):
                yield (re.search(r"([\w:~]+|operator\S+)\s*\(", head) or [head])[0].rstrip("( "), "function", lines[start + 1:number]


def n_members(body):
    """Number of the data members that the lines of a class declare."""
    depths = [len(line) - len(line.lstrip()) for line in body if line.strip()]
    has_labels = any(re.fullmatch(r"\s*(public|private|protected):", line) for line in body)
    depth, count, open_braces = min(depths, default=0) + 2 * has_labels, 0, 0
    for line in body:
        code = re.sub(r"//.*|\"(\\.|[^\"])*\"", "", line)
        if open_braces == 0 and re.match(r" {%d}[\w:]" % depth, line) and code.rstrip().endswith(";"):
            names = re.sub(r"=[^,;]*", "", re.sub(r"<.*>|\{.*\}", "", code))
            if "(" not in names and not re.match(r"\s*(using|return|friend|static|class|struct|enum|template)\b", names):
                count += names.count(",") + 1
        open_braces += code.count("{") - code.count("}")
    return count


def measure(files):
    """All numbers of some files."""
    rooms, arrows, long_functions, long_headers, many = collections.Counter(), {}, [], [], []
    for path, text in files:
        unit = check_layers.unit_of(path)
        room = check_layers.room_of(unit) or unit.split("/")[0]
        rooms[room.split("/")[0]] += text.count("\n")
        others = {check_layers.unit_of(name) for name in re.findall(r"#\s*include <crawler/([^>]+)>", text)}
        arrows.setdefault(unit, set()).update(others - {unit})
        if path.endswith(".h") and text.count("\n") > LONG_HEADER:
            long_headers.append(os.path.basename(path))
        for name, kind, body in blocks(text):
            if kind == "function" and len(body) > LONG_FUNCTION:
                long_functions.append(name)
            if kind == "class" and n_members(body) > MANY_MEMBERS:
                many.append(f"{name} ({n_members(body)})")
    for unit in {other for others in arrows.values() for other in others} - set(arrows):
        arrows[unit] = set()
    return rooms, check_layers.circles(arrows), long_functions, long_headers, many


def main():
    """Prints the table."""
    measured = ([measure(files_of(sys.argv[1]))] if len(sys.argv) > 1 else []) + [measure(files_now())]
    names = (["before"] if len(sys.argv) > 1 else []) + ["now"]
    rows = [["", *names]]
    for room in sorted({room for one in measured for room in one[0]}):
        rows.append([f"lines of {room}", *(str(one[0][room] or "") for one in measured)])
    rows.append(["lines in all", *(str(sum(one[0].values())) for one in measured)])
    rows.append(["files that include each other in circles", *(str(sum(map(len, one[1]))) for one in measured)])
    for label, index in ((f"functions above {LONG_FUNCTION} lines", 2), (f"headers above {LONG_HEADER} lines", 3),
                         (f"classes with more than {MANY_MEMBERS} data members", 4)):
        rows.append([label, *(str(len(one[index])) for one in measured)])
    for number, row in enumerate(rows):
        print("| " + " | ".join(row) + " |")
        if number == 0:
            print("|---|" + "---|" * len(names))
    print("\n".join(f"{label}: {', '.join(sorted(measured[-1][index])) or 'none'}" for label, index in
                    (("Long functions", 2), ("Long headers", 3), ("Large classes", 4))), file=sys.stderr)


if __name__ == "__main__":
    main()
