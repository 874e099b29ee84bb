#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Gmsh by one of its algorithms of triangles and one of recombination: gmsh.sh VERSION ALGORITHM RECOMBINATION INPUT.geo OUTPUT.msh
version=$1 algorithm=$2 recombination=$3 input=$4 output=$5
shift 5
case $version-$algorithm in
  [0-3].*-11 | 4.[0-8].*-11) echo "Gmsh $version has no algorithm 11, which came with 4.9"; exit 77 ;;
  4.[0-8].*-8) set -- "$@" -setnumber Mesh.CrossFieldClosestPoint 0 ;; # 4.8.4 crashes where it is on
esac
set -- "$input" -2 -o "$output" -format msh41 -nt 1 -setnumber Mesh.Algorithm "$algorithm" \
  -setnumber Mesh.RecombineAll 1 -setnumber Mesh.RecombinationAlgorithm "$recombination" "$@"
[ "$recombination" = 3 ] || exec gmsh "$@"
code=0
said=$(gmsh "$@" 2>&1) || code=$?
echo "$said"
case $said in
  *"Full-quad recombination not ready"*) echo "Gmsh $version has no full-quad recombination of periodic surfaces"; exit 77 ;;
esac
exit $code
