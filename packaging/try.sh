#!/bin/sh
# try.sh [PACKAGES [FOLDER]]: tries what `make package` made in PACKAGES (build/packages) in clean roots under FOLDER (build/roots), of
# Debian 12 and 13 without a compiler: installs, meshes, imports, solves. Needs root and debootstrap; ends with an error when something
# fails, and says what it did not try.
set -eu
here=$(realpath "$(dirname "$0")")
packages=$(realpath "${1:-build/packages}")
roots=${2:-build/roots}
mkdir -p "$roots"
roots=$(realpath "$roots")
mirror=${MIRROR:-http://deb.debian.org/debian}
"$here/../cmake/install-packages.sh" debootstrap
failed=0

# try ROOT NAME: what stands in tries.sh under NAME, in a copy of the root.
try() {
  [ -d "$roots/$1" ] || { debootstrap --variant=minbase "$1" "$roots/$1.new" "$mirror" >"$roots/$1.log" && mv "$roots/$1.new" "$roots/$1"; }
  root=$roots/try
  rm -rf "$root"
  cp -a "$roots/$1" "$root"
  cp /etc/resolv.conf "$root/etc"
  cp -r "$packages" "$root/packages"
  cp -r "$here/../examples/solvers" "$here/tries.sh" "$root"
  echo "== $2 in $1"
  # shellcheck disable=SC2016
  unshare -m sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 sh /tries.sh "$1" "$2"' "$root" "$2" "$mirror" ||
    { echo "FAILED: $2 in $1"; failed=1; }
  rm -rf "$root"
}

try bookworm debian
try bookworm archive
try bookworm wheel
try trixie archive
try trixie wheel
exit $failed
