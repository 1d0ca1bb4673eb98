#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Installs from Debian what is missing (as root or with sudo), and builds crawler in Release mode into build/.
# No package that is there is removed.
# Usage: contrib/setup.sh [tests|verify|package|live|fuzz]   with "tests": also what the tests need, and the tests
#                                           themselves; with "verify": the same, and what contrib/verify.sh needs;
#                                           with "package": also what makes a Debian package;
#                                           with "live": the live page, in build/live (doc/live_page.md), by
#                                           emscripten (some 1 GB);
#                                           with "fuzz": the programs of tests/fuzz, in build-fuzz (contrib/fuzz.sh).
set -euo pipefail
cd "$(dirname "$0")/.."

packages=(g++ cmake ninja-build git libdeal.ii-dev libcli11-dev nlohmann-json3-dev libfmt-dev openmpi-bin
  python3-dev pybind11-dev python3-numpy python3-scipy python3-h5py python3-matplotlib libjs-chart.js)
[ "${1:-}" = package ] && packages+=(dpkg-dev file)
[ "${1:-}" = live ] && packages+=(emscripten)
[ "${1:-}" = fuzz ] && packages+=(libclang-rt-dev)
is_installed() { dpkg-query -W -f '${db:Status-Abbrev}' "$1" 2>/dev/null | grep -q '^ii'; }
if [ "${1:-}" = tests ] || [ "${1:-}" = verify ]; then
  packages+=(jupyter-nbconvert python3-ipykernel libgtest-dev libbenchmark-dev
    python3-pandas python3-jsonschema zsh groff-base chromium clang-format clang-tidy doxygen
    texlive-binaries)
  # ParaView brings VTK for Python; Debian has the two not beside each other.
  is_installed python3-paraview || packages+=(python3-vtk9)
fi
[ "${1:-}" = verify ] &&
  packages+=(emscripten python3-venv iproute2 ffmpeg xvfb octave libsundials-dev libclang-rt-dev stress-ng dpkg-dev file)

missing=()
for package in "${packages[@]}"; do
  is_installed "$package" || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  echo "Installing from Debian: ${missing[*]}"
  as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "Please install these packages, or sudo, as root: ${missing[*]}" >&2; exit 1; }
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-remove --no-install-recommends "${missing[@]}" >/dev/null
fi

[ "${1:-}" = live ] && exec contrib/live/build.sh
if [ "${1:-}" = fuzz ]; then
  cmake --preset fuzz >build-fuzz.log 2>&1 || { cat build-fuzz.log >&2; exit 1; }
  rm -f build-fuzz.log
  exec cmake --build --preset fuzz
fi

with_tests=OFF
if [ "${1:-}" = tests ] || [ "${1:-}" = verify ]; then
  with_tests=ON
elif [ -f build/CMakeCache.txt ] && grep -q '^CRAWLER_TESTS:BOOL=ON' build/CMakeCache.txt; then
  with_tests=ON # keep what is there
fi
targets=(crawler crawler_python)
[ "${1:-}" = tests ] || [ "${1:-}" = verify ] && targets=(all)
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCRAWLER_TESTS=$with_tests >build.log 2>&1 ||
  { cat build.log >&2; exit 1; }
rm -f build.log
echo "Building crawler (Release) in build/"
cmake --build build --target "${targets[@]}"
