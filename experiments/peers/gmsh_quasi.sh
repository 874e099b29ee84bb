#!/bin/sh
# Gmsh's quasi-structured quads: algorithm 11, from version 4.9 on. gmsh_quasi.sh INPUT.geo OUTPUT.msh
version=$(gmsh --version 2>&1) || { echo "gmsh is not installed"; exit 77; }
case $version in
  4.[0-8].* | [0-3].*) echo "Gmsh $version has no algorithm 11, which came with 4.9"; exit 77 ;;
esac
exec gmsh "$1" -2 -o "$2" -format msh41 -nt 1 -setnumber Mesh.Algorithm 11 -setnumber Mesh.RecombineAll 1
