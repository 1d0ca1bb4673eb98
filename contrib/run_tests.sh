#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Installs what the tests need, builds everything in Release mode, and runs all tests. Arguments go to ctest, e.g.
# contrib/run_tests.sh -L unit. What takes hours is in contrib/verify.sh.
set -euo pipefail
cd "$(dirname "$0")/.."
contrib/setup.sh tests
ctest --test-dir build --output-on-failure -j "$(nproc)" "$@"
