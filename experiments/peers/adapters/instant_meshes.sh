#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Instant Meshes in its batch mode: instant_meshes.sh INPUT.obj OUTPUT.obj SIZE; --version: its digest, for it tells none
for name in instant-meshes "Instant Meshes" InstantMeshes; do
  program=$(command -v "$name") && break
done
[ -n "$program" ] || { echo "Instant Meshes is not installed"; exit 77; }
[ "$1" != --version ] || { sha1sum < "$program"; exit; }
exec "$program" -d -b -c 40 -s "$3" -o "$2" "$1"
