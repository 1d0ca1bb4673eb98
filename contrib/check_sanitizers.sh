#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds the unit tests of the lower rooms in Debug mode with the sanitizers for addresses, leaks and undefined behaviour
# (preset "sanitize", folder build-sanitize/), and runs them. What these tests need is installed by contrib/setup.sh tests.
# Arguments go to ctest, e.g. contrib/check_sanitizers.sh -R formula
set -euo pipefail
cd "$(dirname "$0")/.."
echo "Building the tests with sanitizers (Debug) in build-sanitize/"
cmake --preset sanitize >build-sanitize.log 2>&1 || { cat build-sanitize.log >&2; exit 1; }
rm -f build-sanitize.log
cmake --build --preset sanitize --target sanitized_tests
# The sanitizer opens libraries in its own name, so that they are not looked for beside the program.
export LD_LIBRARY_PATH="$PWD/build-sanitize${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
ctest --preset sanitize -L sanitized -LE mpi -j "$(nproc)" "$@" # on one rank: other ranks find the leaks of MPI itself
