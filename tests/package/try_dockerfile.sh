#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs the lines of contrib/containers/Dockerfile in bare Debian 12 systems, without Docker, then uses the program as the
# container's user does. Needs root and debootstrap, some 6 GB, and as long as a build. What is not committed is left out.
set -euo pipefail
cd "$(dirname "$0")/../.."
. tests/package/chroot.sh
stages=()
environment= user=root folder=/
remove_all() { for stage in "${stages[@]}"; do remove_chroot "$stage"; done; }
trap remove_all EXIT

# step INSTRUCTION WORDS...: one line of the Dockerfile.
step()
{
  local instruction=$1 root=
  [ ${#stages[@]} -eq 0 ] || root=${stages[-1]}
  shift
  case "$instruction $*" in
    "FROM debian:12"*) stages+=("$(mktemp -d)"); make_chroot "${stages[-1]}" ;;
    "COPY --from=build "*) cp -r "${stages[0]}$2" "$root$3" ;;
    "COPY . "*) git clone -q . "$root$2" ;;
    RUN*) in_chroot "$root" "$user" "cd $folder; $environment $*" ;;
    ENV*) environment="export $*;" ;;
    USER*) user=$1 ;;
    WORKDIR*) folder=$1 ;;
    ENTRYPOINT*) [ "$*" = '["crawler"]' ] ;;
    *) echo "This script does not know: $instruction $*" >&2; return 1 ;;
  esac
}

while read -r line; do
  case "$line" in "#"* | "") continue ;; esac
  echo "== $line" >&2
  read -ra words <<<"$line"
  step "${words[@]}"
done <contrib/containers/Dockerfile
cp tests/package/use.sh "${stages[-1]}/tmp/"
in_chroot "${stages[-1]}" "$user" "cd $folder; $environment bash /tmp/use.sh"
echo "== the Dockerfile's lines work, and so does the program in its last stage ($(du -sxh "${stages[-1]}" | cut -f1))"
