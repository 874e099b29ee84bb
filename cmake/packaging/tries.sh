#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# tries.sh NAME MIRROR: run by try.sh as root of a clean system, with /packages and /solvers.
set -eu
export DEBIAN_FRONTEND=noninteractive
cd /tmp

# step WHAT COMMAND...: says how long it took, and what it printed when it failed.
step() {
  what=$1
  shift
  began=$(date +%s%N)
  "$@" >log 2>&1 || { cat log; echo "  failed: $what"; exit 1; }
  printf '  %6.1f s  %s\n' "$(awk -v ns=$(($(date +%s%N) - began)) 'BEGIN { print ns / 1e9 }')" "$what"
}
install() { apt-get install -qq -y --no-install-recommends "$@"; }
first_mesh() {
  "$1" example bracket -o bracket.step && "$1" mesh bracket.step -o bracket.vtu --size 2 && test -s bracket.vtu
}
# CalculiX computes the stress at a hole, within 1 % of Howland's.
solve() {
  if ! apt-cache policy calculix-ccx | grep -q 'Candidate: [0-9]'; then
    echo "  skipped: CalculiX, of which this system has no package"
    return
  fi
  step "apt-get install calculix-ccx python3" install calculix-ccx python3
  step "solve with CalculiX" python3 /solvers/calculix/run.py strip --delquad "$1" -o strip.svg
}
import() {
  "$1" -c '
import time
began = time.perf_counter()
import delquad
print("import: %.2f s" % (time.perf_counter() - began))
import ctypes, hashlib, ssl, zlib, xml.parsers.expat  # the libraries of the system, beside ours
mesh = delquad.mesh(delquad.example("bracket"), size=2)
assert mesh.sound and len(mesh.quads) > 1000
mesh.write("bracket.msh")
mesh.write("bracket.med")
mesh.write("bracket.cgns")'
}
without_gdal() {
  printf '{"type": "Polygon", "coordinates": []}' >coast.shp
  ! "$1" mesh coast.shp -o coast.msh --size 1 2>message && grep -q "install them (Debian: gdal-bin)" message
}

case $1 in
debian)
  step "apt-get update" apt-get update -qq
  step "apt-get install delquad" install /packages/delquad_*.deb
  step "first mesh" first_mesh delquad
  solve delquad
  step "apt-get install python3-delquad" install /packages/python3-delquad_*.deb
  step "import, mesh, write" import python3
  grep import log
  step "apt-get install libdelquad-dev" install /packages/libdelquad-dev_*.deb
  echo "  skipped: a program against libdelquad-dev, as there is no compiler; the test install.ProgramsOfOthers builds some"
  ;;
archive)
  step "apt-get update, xz-utils" sh -c "apt-get update -qq && apt-get install -qq -y --no-install-recommends xz-utils"
  step "unpack" tar xf /packages/delquad-*.tar.xz -C /opt
  mkdir "/srv/another place"
  mv /opt/delquad-* "/srv/another place/delquad"
  step "first mesh" first_mesh "/srv/another place/delquad/bin/delquad"
  step "what is without GDAL says so" without_gdal "/srv/another place/delquad/bin/delquad"
  solve "/srv/another place/delquad/bin/delquad"
  ;;
wheel)
  echo "  skipped: numpy from PyPI, which may be out of reach: Debian's is taken"
  if ! grep -q bookworm /etc/os-release; then
    echo "  skipped: this system's own Python, as the wheel is for 3.11: that of bookworm is taken"
    echo "deb $2 bookworm main" >/etc/apt/sources.list.d/bookworm.list
    printf 'Package: *python3* python-*\nPin: release n=bookworm\nPin-Priority: 990\n' >/etc/apt/preferences.d/bookworm
  fi
  step "apt-get update" apt-get update -qq
  step "apt-get install python3-venv python3-numpy" install python3-venv python3-numpy
  step "python3 -m venv" python3 -m venv --system-site-packages venv
  step "pip install" venv/bin/pip install --no-index /packages/*.whl
  step "import, mesh, write" import venv/bin/python3
  grep import log
  ;;
esac
