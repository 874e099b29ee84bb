#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# install-packages.sh NAME...: installs the Debian packages that this machine lacks. A NAME is a group of packages.txt, or a package.
set -eu
list=$(dirname "$0")/packages.txt
missing=""
for name in "$@"; do
  packages=$(sed -n "s/^$name: //p" "$list")
  for package in ${packages:-$name}; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
  done
done
[ -n "$missing" ] || exit 0
refuse() {
  echo "These Debian packages are needed and cannot be installed from here ($1):" >&2
  echo " $missing" >&2
  exit 1
}
command -v apt-get >/dev/null || refuse "there is no apt-get"
if [ "$(id -u)" -eq 0 ]; then
  as_root=""
elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
  as_root="sudo"
else
  refuse "not root, and no sudo"
fi
echo "Installing:$missing"
$as_root apt-get update -qq || refuse "apt-get update failed"
# shellcheck disable=SC2086
$as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null ||
  refuse "apt-get install failed"
