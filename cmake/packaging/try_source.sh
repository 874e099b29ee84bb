#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# try_source.sh [--all] [--resume] [--keep] [--roots FOLDER] [STEP ...]
# Tries README's commands on a clone of HEAD in a Debian 12 with git, make and ca-certificates alone. Needs root and debootstrap.
#   STEP       first-mesh, which is README's first block with `delquad mesh`, or words after `make`: test, "build -n";
#              without any: build first-mesh test paper
#   --all      adds the other targets of the Makefile that README.md, CONTRIBUTING.md and docs name
#   --resume   goes on in the system that an earlier try left, on HEAD as it is now; without STEP it leaves out steps that succeeded
#   --keep     leaves the system there after a success, too
#   --roots    folder of the systems (build/roots); logs are in its folder source.logs
# Goes on after a step that failed, and then ends with exit code 1.
set -eu
here=$(realpath "$(dirname "$0")")
roots=build/roots all="" resume="" keep="" skip="" failed=0
while [ $# -gt 0 ]; do
  case $1 in
  --all) all=1 ;;
  --resume) resume=1 ;;
  --keep) keep=1 ;;
  --roots) roots=${2:?--roots needs a folder}; shift ;;
  -*) sed -n '2,/^set/s/^# \?//p' "$0" >&2; exit 2 ;;
  *) break ;;
  esac
  shift
done
# shellcheck source-path=SCRIPTDIR source=roots.sh
. "$here/roots.sh"
root=$roots/source clone=$roots/source/root/delquad logs=$roots/source.logs

if [ -z "$resume" ]; then
  rm -rf "$logs"
  mkdir "$logs"
  copy_root bookworm "$root"
  [ ! -d /usr/local/share/ca-certificates ] || cp -r /usr/local/share/ca-certificates "$root/usr/local/share"
  enter "$root" sh -c 'apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends git make ca-certificates' \
    >"$logs/system.log" 2>&1 || { echo "git, make and ca-certificates cannot be installed in $root: see $logs/system.log" >&2; exit 1; }
  git clone -q "$here/../.." "$clone"
elif [ -d "$clone" ]; then
  git -C "$clone" pull -q --ff-only "$here/../.." HEAD
else
  echo "$root has nothing to resume: leave out --resume" >&2
  exit 1
fi
cd "$clone"
commit=$(git rev-parse --short=8 HEAD)

if [ $# -eq 0 ]; then
  skip=$resume
  set -- build first-mesh test paper
  for target in ${all:+$(sed -n 's/^\.PHONY://p' Makefile)}; do
    case $target in
    build | test | paper) continue ;;
    esac
    grep -qE "\bmake $target\b" README.md CONTRIBUTING.md docs/*.md || continue
    [ "$target" != fuzz ] || target="fuzz SECONDS=20"
    set -- "$@" "$target"
  done
fi

first_mesh() {
  awk '/^    / { block = block substr($0, 5) "\n"; next } block ~ /delquad mesh/ { exit } { block = "" }
       END { printf "%s", block ? block : "echo README.md has no block with delquad mesh; false" }' README.md
}
packages() { dpkg-query --admindir="$root/var/lib/dpkg" -W -f '${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p' | sort; }
log_of() { echo "$logs/$1" | sed 's/[ =]/_/g'; }

# try STEP: runs it, and leaves its log and its row of the table.
try() {
  log=$(log_of "$1")
  case $1 in
  first-mesh) commands=$(first_mesh) ;;
  *) commands="make $1" ;;
  esac
  packages >"$log.before"
  began=$(date +%s) code=0
  enter "$root" bash -exc "cd /root/delquad; $commands" >"$log.log" 2>&1 </dev/null || code=$?
  tenths=$((($(date +%s) - began + 3) / 6))
  [ $code -eq 0 ] || failed=1
  packages | comm -13 "$log.before" - >"$log.packages"
  rm "$log.before"
  printf '%5d.%d  %4d  %8d  %s  %-16s  %s\n' $((tenths / 10)) $((tenths % 10)) $code "$(wc -l <"$log.packages")" "$commit" "$1" \
    "$(grep . "$log.log" | tail -n 1 | cut -c 1-120)" | tee "$log.row"
  fmt -w 120 "$log.packages" | sed 's/^/    /'
}

head='minutes  exit  packages  commit    step              last line of its log'
echo "$head"
for step; do
  if [ -z "$skip" ] || ! grep -qs '^ *[0-9.]*  *0 ' "$(log_of "$step").row"; then try "$step"; fi
done
echo
echo "$head"
for step; do cat "$(log_of "$step").row"; done
[ $failed -ne 0 ] || [ -n "$keep" ] || rm -rf "$root"
exit $failed
