#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Fails, naming the lines, if a C++ file is not formatted as .clang-format says (repair: contrib/indent.sh).
set -euo pipefail
cd "$(dirname "$0")/.."
find source include tests contrib/live contrib/one_process contrib/python contrib/wheel -name '*.cc' -o -name '*.h' | sort | xargs clang-format --dry-run -Werror
