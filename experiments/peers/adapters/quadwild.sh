#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# QuadWild-BiMDF: quadwild.sh INPUT.obj OUTPUT.obj SIZE; --version: the digest of its programs, for they tell none
set -e
programs=$QUADWILD/build/Build/bin config=$QUADWILD/config
[ -n "$QUADWILD" ] && [ -x "$programs/quadwild" ] || { echo "QUADWILD names no folder with QuadWild-BiMDF"; exit 77; }
if [ "$1" = --version ]; then
  cat "$programs/quadwild" "$programs/quad_from_patches" | sha1sum
  exit
fi
grep -v "^l " "$1" > mesh.obj # it takes lines for faces
"$programs/quadwild" mesh.obj 2 "$config/prep_config/basic_setup_Mechanical.txt"
# Its size is a factor of the mean edge of its own triangles.
edge=$(awk '$1 == "v" { x[++n] = $2; y[n] = $3; z[n] = $4 }
  $1 == "f" { for (k = 2; k <= 4; ++k) { split($k, a, "/"); split($(k < 4 ? k + 1 : 2), b, "/"); i = a[1]; j = b[1]
      sum += sqrt((x[i] - x[j])^2 + (y[i] - y[j])^2 + (z[i] - z[j])^2); ++count } }
  END { print sum / count }' mesh_rem_p0.obj)
factor=$(awk -v size="$3" -v edge="$edge" 'BEGIN { print size / edge }')
sed "s/^scaleFact .*/scaleFact $factor/" "$config/main_config/flow_noalign_lemon.txt" > main.txt
"$programs/quad_from_patches" mesh_rem_p0.obj 123 main.txt
cp mesh_rem_p0_123_quadrangulation_smooth.obj "$2"
