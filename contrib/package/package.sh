#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Installs what is missing, builds crawler with its Python package, and packs crawler_VERSION_ARCHITECTURE.deb in
# build/package (doc/install.md).
set -euo pipefail
cd "$(dirname "$0")/../.."
contrib/setup.sh package
rm -rf build/package
cpack -G DEB --config build/CPackConfig.cmake -B build/package >build/package.log || { cat build/package.log >&2; exit 1; }
rm -rf build/package/_CPack_Packages
ls build/package/*.deb
