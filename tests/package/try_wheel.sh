#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Builds the wheel of the Python package (contrib/wheel), installs it by pip without a network into a new environment, and
# compares it with the program of a build folder (tests/package/use_wheel.py).
#   tests/package/try_wheel.sh [BUILD]          in an environment of this machine's Python; default: build
#   tests/package/try_wheel.sh [BUILD] bare     in a bare Debian 12 without a compiler, too; needs root and debootstrap
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
build=$(cd "${1:-$root/build}" && pwd)
scene=$root/prm/paper/fig_s1.prm
place=$(mktemp -d)
bare=
remove_all() { [ -z "$bare" ] || remove_chroot "$bare"; rm -rf "$place"; }
trap remove_all EXIT
wheel=$("$root/contrib/wheel/build.sh" "$build/wheel")
echo "== $(basename "$wheel"): $(stat -c %s "$wheel") bytes"
"$build/crawler" run "$scene" --quiet --output "$place/run"
cp -r "$root/tests/package/use_wheel.py" "$root/prm" "$scene" "$place"
PYTHONPATH=$build/python /usr/bin/python3 "$place/use_wheel.py" "$place/prm"
/usr/bin/python3 -m venv --system-site-packages "$place/python"
"$place/python/bin/pip" install --quiet --no-index "$wheel"
(cd "$place" && env -u PYTHONPATH python/bin/python use_wheel.py fig_s1.prm run prm)
[ "${2:-}" = bare ] || exit 0
. "$root/tests/package/chroot.sh"
bare=$(mktemp -d)
make_chroot "$bare"
in_chroot "$bare" root 'apt-get update -qq && apt-get install -y -qq --no-install-recommends python3-venv python3-numpy >/dev/null && useradd -m user'
rm -f "$place/run/report.html"
cp -r "$wheel" "$place"/{use_wheel.py,fig_s1.prm,run,prm} "$bare/home/user/"
in_chroot "$bare" root 'chown -R user: /home/user; ! command -v cc'
in_chroot "$bare" user 'python3 -m venv --system-site-packages python && python/bin/pip install --quiet --no-index ./*.whl &&
  time python/bin/python -c "import crawler; print(crawler.run(\"fig_s1.prm\"))" && python/bin/python use_wheel.py fig_s1.prm run prm'
echo "== the wheel works in a bare Debian 12"
