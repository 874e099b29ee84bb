#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Mmg's triangles merged by Delquad: mmg.sh INPUT.mesh OUTPUT.msh SIZES.sol; --version: of both
set -e
for name in mmgs_O3 delquad; do
  command -v $name > /dev/null || { echo "$name is not on the PATH"; exit 77; }
done
[ "$1" != --version ] || { mmg=$(mmgs_O3 -h | sed -n 's/.*MMGS, Release *//p'); echo "${mmg:?no release}, $(delquad --version)"; exit; }
# By its documentation, the distance that it may keep from the boundary is meant for an object of extent 1.
set -- "$@" $(awk '$1 == "Vertices" { getline n; min = 1e300; max = -min
      for (i = 0; i < n; ++i) { getline; for (k = 1; k <= 3; ++k) { if ($k < min) min = $k; if ($k > max) max = $k } }
      print .01 * (max - min) }' "$1")
mmgs_O3 -in "$1" -sol "$3" -hausd "$4" -hgrad -1 -out mmg.mesh
delquad improve mmg.mesh --pipeline B --allow-triangles --allow-unsound -q -o "$2"
