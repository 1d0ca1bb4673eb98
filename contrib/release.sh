#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Makes all files of a release from what is committed, in build/release: the Debian package, the wheel of the Python
# package, the live page (not without emscripten), the source code, and SHA256SUMS (doc/install.md).
set -euo pipefail
cd "$(dirname "$0")/.."
release=build/release
if [ -n "$(git status --porcelain)" ]; then
  echo "release.sh: there are changes that are not committed, but a release is made from what is committed" >&2
  exit 2
fi
rm -rf "$release"
mkdir -p "$release"
contrib/package/package.sh
cp build/package/*.deb "$release"
cp "$(contrib/wheel/build.sh)" "$release"
version=$(cat build/wheel/version.txt)
code=0
page=$(contrib/live/build.sh) || code=$?
case $code in
  0) cp "$page" "$release" ;;
  77) echo "release.sh: without the live page" >&2 ;;
  *) echo "release.sh: the live page cannot be built, see above" >&2; exit 3 ;;
esac
git archive --prefix="crawler-$version/" --output="$release/crawler-$version.tar.gz" HEAD
(cd "$release" && sha256sum -- * >SHA256SUMS && cat SHA256SUMS)
