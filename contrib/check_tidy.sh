#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs clang-tidy with the checks of .clang-tidy; fails, naming the lines, if it finds something.
# Usage: contrib/check_tidy.sh                    all headers, and the sources that differ from the branch main
#        contrib/check_tidy.sh --since COMMIT     the same for another commit
#        contrib/check_tidy.sh --headers          all headers (a minute)
#        contrib/check_tidy.sh FILE|FOLDER...     these sources (5 s each)
# Compile commands are those of the build folder BUILD (default: build).
set -euo pipefail
cd "$(dirname "$0")/.."
build=${BUILD:-build}
[ -f "$build/compile_commands.json" ] || { echo "There is no build in $build/: run contrib/setup.sh" >&2; exit 1; }

headers=yes files=()
case "${1:---since}" in
  --headers) ;;
  --since) mapfile -t files < <(git diff --name-only --diff-filter=d "${2:-main}" -- 'source/*.cc' 'tests/*.cc') ;;
  *) headers=no; mapfile -t files < <(find "$@" -name '*.cc' | sort) ;;
esac

work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
cp .clang-tidy "$work"
if [ $headers = yes ]; then
  # One source includes all headers but those of the lanes, which lanes.cc includes.
  (cd include; find crawler -name '*.h' -exec grep -L 'crawler::CRAWLER_INSTRUCTION_SET' {} +) | sort |
    sed 's/.*/#include <&>/' >"$work/headers.cc"
  files+=("$work/headers.cc" source/lanes/lanes.cc)
fi
# The compile commands without the options of g++ that clang does not know. Sources that are compiled together with others
# of their room take the command of these, headers.cc that of main.cc.
python3 - "$build/compile_commands.json" "$work" "${files[@]}" <<'END'
import json, os, re, sys
commands = json.load(open(sys.argv[1]))
main = next(c for c in commands if c["file"].endswith("source/main.cc"))
known = {c["file"] for c in commands}
together = {file: c for c in commands if "/Unity/" in c["file"] and os.path.exists(c["file"])
            for file in re.findall(r'#include "(/.*)"', open(c["file"]).read())}
for file in map(os.path.abspath, sys.argv[3:]):
    if file not in known:
        own = together.get(file, main)
        commands.append(own | {"file": file, "command": own["command"].replace(own["file"], file)})
lanes = [c for c in commands if c["file"].endswith("/lanes.cc")]
commands = [c for c in commands if c not in lanes[1:]]  # of one instruction set
for c in commands:
    words = re.sub(r"-include \S+/cmake_pch.hxx", "", c["command"]).split()  # headers that g++ has compiled
    only_gcc = "-fcx-limited-range", "-funroll-all-loops", "-fno-unroll-all-loops", "-fno-ipa-cp-clone", "-fpch-preprocess"
    c["command"] = " ".join(w for w in words if w not in only_gcc)
json.dump(commands, open(sys.argv[2] + "/compile_commands.json", "w"))
END
echo "clang-tidy: ${#files[@]} sources"
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 4 \
  clang-tidy --quiet -p "$work" --warnings-as-errors='*' \
  --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wno-unknown-attributes 2>/dev/null
echo "clang-tidy: nothing found"
