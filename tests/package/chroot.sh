# SPDX-License-Identifier: LGPL-2.1-or-later
# Bare Debian 12 systems in folders; to be sourced. Needs root and debootstrap; takes Debian's mirror from this machine.

if [ "$(id -u)" -ne 0 ] || ! command -v debootstrap >/dev/null; then
  echo "Skipped: this needs root and debootstrap (apt install debootstrap)" >&2
  exit 77
fi
: "${MIRROR:=$(cat /etc/apt/sources.list.d/*.sources /etc/apt/sources.list 2>/dev/null | awk '/^URIs:/{print $2; exit} /^deb /{print $2; exit}')}"

# make_chroot FOLDER: a new, bare system there.
make_chroot()
{
  debootstrap --variant=minbase --include=ca-certificates bookworm "$1" "$MIRROR" >"$1.log" 2>&1 ||
    { tail -5 "$1.log" >&2; return 1; }
  rm "$1.log"
  chmod 755 "$1"
  cp /etc/resolv.conf /etc/hosts "$1/etc/"
  cp -r /etc/ssl/certs/. "$1/etc/ssl/certs/"
  grep -lsi '^acquire' /etc/apt/apt.conf.d/* | xargs -r cp -t "$1/etc/apt/apt.conf.d/" # how this machine reaches the mirror
  mount -t proc proc "$1/proc"
  mount --rbind /dev "$1/dev"
  mount --make-rslave "$1/dev"
}

# in_chroot FOLDER USER COMMAND: a shell command as this user in its home.
in_chroot()
{
  chroot "$1" /usr/bin/env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
    OMP_NUM_THREADS=1 DEBIAN_FRONTEND=noninteractive su -p "$2" -s /bin/bash -c "export HOME=~$2; cd; $3" </dev/null
}

# remove_chroot FOLDER
remove_chroot()
{
  for mounted in dev proc; do
    ! mountpoint -q "$1/$mounted" || umount -l "$1/$mounted"
  done
  rm -rf --one-file-system "$1"
}
