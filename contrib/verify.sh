#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Computes the numbers of the documents anew and prints what has drifted: contrib/verify.py, which has the usage.
set -euo pipefail
exec python3 "$(dirname "$0")/verify.py" "$@"
