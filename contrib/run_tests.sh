#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Installs what the tests need, builds everything in Release mode, and runs all tests; then the unit tests of the lower
# rooms once more in Debug mode with sanitizers. Arguments go to ctest, and leave out the latter:
# contrib/run_tests.sh -L unit
set -euo pipefail
cd "$(dirname "$0")/.."
contrib/setup.sh tests
ctest --test-dir build --output-on-failure -j "$(nproc)" "$@"
[ $# -gt 0 ] || contrib/check_sanitizers.sh
