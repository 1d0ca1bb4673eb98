#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
#
# Builds the live page (doc/live_page.md): one HTML file that needs no network and no server.
#
#     contrib/live/build.sh [BUILD_FOLDER]      default: build/live; the page is BUILD_FOLDER/crawler_live.html
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=${1:-$here/../../build/live}
toolchain=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake
if ! command -v em++ > /dev/null || [ ! -e "$toolchain" ]; then
  echo "emscripten is missing: contrib/setup.sh live installs it (some 1 GB)" >&2
  exit 77
fi
export NODE_PATH="${NODE_PATH:+$NODE_PATH:}/usr/share/nodejs" # emscripten's scripts, with a node of another origin
cmake -S "$here" -B "$build" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$toolchain" > /dev/null
cmake --build "$build" >&2
python3 "$here/page.py" "$build/crawler_live.js" "$build/crawler_live.html" >&2
echo "$build/crawler_live.html"
