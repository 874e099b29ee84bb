#!/bin/sh
# Gmsh's triangles by one of its algorithms, merged by Blossom: gmsh.sh ALGORITHM INPUT.geo OUTPUT.msh
algorithm=$1 input=$2 output=$3
shift 3
version=$(gmsh --version 2>&1) || { echo "gmsh is not installed"; exit 77; }
case $version-$algorithm in
  [0-3].*-11 | 4.[0-8].*-11) echo "Gmsh $version has no algorithm 11, which came with 4.9"; exit 77 ;;
  4.[0-8].*-8) set -- -setnumber Mesh.CrossFieldClosestPoint 0 ;; # 4.8.4 crashes where it is on
esac
exec gmsh "$input" -2 -o "$output" -format msh41 -nt 1 -setnumber Mesh.Algorithm "$algorithm" \
  -setnumber Mesh.RecombineAll 1 -setnumber Mesh.RecombinationAlgorithm 1 "$@"
