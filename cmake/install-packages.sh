#!/bin/sh
# Installs the Debian packages of packages.txt (and those given as arguments) that this machine lacks.
set -eu
here=$(dirname "$0")
missing=""
for package in $(cat "$here/packages.txt") "$@"; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
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
