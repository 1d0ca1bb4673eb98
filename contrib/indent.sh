#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Formats all C++ files as .clang-format says.
set -euo pipefail
cd "$(dirname "$0")/.."
find source include tests contrib/live contrib/one_process contrib/python contrib/wheel -name '*.cc' -o -name '*.h' | sort | xargs clang-format -i
