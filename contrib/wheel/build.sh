#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
#
# Builds the wheel of the Python package (doc/install.md): its compiled part needs no library but those of C and C++, and
# muParser, which the wheel brings.
#
#     contrib/wheel/build.sh [BUILD_FOLDER]     default: build/wheel; prints the name of the wheel, which is there
#
# PYTHON: the Python that the wheel is for (default: /usr/bin/python3).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=${1:-$here/../../build/wheel}
python=${PYTHON:-/usr/bin/python3}
cmake -S "$here" -B "$build" -G Ninja -DPython_EXECUTABLE="$python" > /dev/null
cmake --build "$build" >&2
rm -f "$build"/crawler-*.whl
"$python" "$here/wheel.py" "$build"/_core.*.so "$(cat "$build/version.txt")" "$build"
