#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Installs a Debian package of crawler (contrib/package/package.sh) in a bare Debian 12, uses it as another user than
# root, and removes it: nothing may be left. Needs root and debootstrap, some 2 GB and a few minutes.
#   tests/package/try_package.sh [build/package/crawler_*.deb]
set -euo pipefail
cd "$(dirname "$0")/../.."
. tests/package/chroot.sh
package=${1:-$(ls build/package/*.deb)}
root=$(mktemp -d)
trap 'remove_chroot "$root"' EXIT
make_chroot "$root"
cp "$package" "$root/root/crawler.deb"
in_chroot "$root" root 'apt-get update -qq && apt-get install -y -qq man-db bash-completion >/dev/null && useradd -m user'
find "$root"/{usr,etc,opt,var/lib/crawler} -xdev 2>/dev/null | grep crawler && { echo "crawler is there before"; exit 1; }
SECONDS=0
in_chroot "$root" root 'apt-get install -y -qq ./crawler.deb >/dev/null'
echo "== installed in $SECONDS s"
cp tests/package/use.sh "$root/home/user/"
in_chroot "$root" user 'mkdir try && cd try && bash ../use.sh'
in_chroot "$root" root 'apt-get purge -y -qq crawler >/dev/null'
left=$(find "$root"/{usr,etc,opt,var} -xdev -name '*crawler*')
[ -z "$left" ] || { echo "left behind: $left"; exit 1; }
echo "== used and removed: nothing is left"
