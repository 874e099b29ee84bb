# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh disable=SC2154
# roots.sh: sourced by try.sh and try_source.sh, with $here and $roots: bare Debian systems under $roots. Needs root and debootstrap.
mkdir -p "$roots"
roots=$(realpath "$roots")
"$here/../install-packages.sh" debootstrap
# shellcheck disable=SC2016
mirror=${MIRROR:-$(apt-get indextargets --format '$(REPO_URI)' 'Identifier: Packages' 'Release: bookworm' | head -n 1)}
mirror=${mirror:-http://deb.debian.org/debian}

# copy_root SUITE FOLDER: makes FOLDER a bare Debian, with this machine's network. The first of a suite is made, later ones are copies.
copy_root() {
  if [ ! -d "$roots/$1" ]; then
    rm -rf "$roots/$1.new"
    debootstrap --variant=minbase "$1" "$roots/$1.new" "$mirror" >"$roots/$1.log" 2>&1 ||
      { echo "debootstrap made no $1 from $mirror: see $roots/$1.log; MIRROR=... takes another mirror" >&2; exit 1; }
    mv "$roots/$1.new" "$roots/$1"
  fi
  rm -rf "$2"
  cp -a "$roots/$1" "$2"
  cp /etc/resolv.conf /etc/hosts "$2/etc"
  apt-config dump | grep -iE '^Acquire::(https?|Check-)' >"$2/etc/apt/apt.conf.d/99machine" || :
}

# enter FOLDER COMMAND...: runs it as root of that system, with /proc, without /dev/pts and /sys.
enter() {
  # shellcheck disable=SC2016
  unshare -m sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root "$@"' "$@"
}
