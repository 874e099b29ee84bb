#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# try.sh [PACKAGES [FOLDER]]: tries what `make package` made in PACKAGES (build/packages) in clean roots under FOLDER (build/roots), of
# Debian 12 and 13 without a compiler: installs, meshes, imports, solves. Needs root and debootstrap; ends with an error when something
# fails, and says what it did not try.
set -eu
here=$(realpath "$(dirname "$0")")
packages=$(realpath "${1:-build/packages}")
roots=${2:-build/roots}
# shellcheck source-path=SCRIPTDIR source=roots.sh
. "$here/roots.sh"
failed=0

# try SUITE NAME: runs NAME of tries.sh in a copy of the bare system.
try() {
  root=$roots/try
  copy_root "$1" "$root"
  cp -r "$packages" "$root/packages"
  cp -r "$here/../../examples/solvers" "$here/tries.sh" "$root"
  echo "== $2 in $1"
  enter "$root" LC_ALL=C.UTF-8 sh /tries.sh "$2" "$mirror" || { echo "FAILED: $2 in $1"; failed=1; }
  rm -rf "$root"
}

try bookworm debian
try bookworm archive
try bookworm wheel
try trixie archive
try trixie wheel
exit $failed
