#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# From a fresh Debian 12 to a moving crawler: installs what is missing, builds, and runs the paper's Fig. 2 crawler.
# Results: output-fig_2/ (solution.pvd opens in ParaView). Run it again at any time; it does only what is left to do.
set -euo pipefail
cd "$(dirname "$0")/.."
contrib/setup.sh
echo "Running prm/paper/fig_2.prm"
build/crawler run prm/paper/fig_2.prm --overwrite
