#!/bin/sh
# Builds the program, meshes ../heat.toml, solves and draws heat.svg: run.sh [DELQUAD]. Needs deal.II 9.4 (Debian: libdeal.ii-dev).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
delquad=${1:-delquad}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake -S "$here" -B "$work/build" > "$work/log" || { cat "$work/log"; exit 1; }
cmake --build "$work/build" > "$work/log" || { cat "$work/log"; exit 1; }
"$delquad" -q mesh "$here/../heat.toml" -o "$work/heat.msh"
"$work/build/heat" "$work/heat.msh" "$work/heat.json"
python3 "$here/../picture.py" "$work/heat.json" heat.svg temperature
echo "the picture is $PWD/heat.svg"
