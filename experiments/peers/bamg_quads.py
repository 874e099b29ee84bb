#!/usr/bin/python3
"""BAMG's quads: bamg_quads.py INPUT.mesh OUTPUT.obj SIZES.sol

INPUT: triangles of a planar domain, whose boundary is kept. SIZES: at the points of SIZES.mesh, its background.
"""
import shutil
import subprocess
import sys

import meshio

if not shutil.which("ffbamg"):
    sys.exit(print("ffbamg of freefem++ is not installed") or 77)
source, output, sizes = sys.argv[1:4]
mesh = meshio.read(source)
delta = open(sizes).read().split("1 1\n")[1].split("End")[0].split()
with open("background.mesh", "w") as out:
    out.write(f"MeshVersionFormatted 0\nDimension 2\nVertices {len(mesh.points)}\n")
    out.writelines("%.17g %.17g 1\n" % tuple(p[:2]) for p in mesh.points)
    for name, key in ("Edges", "line"), ("Triangles", "triangle"):
        cells, tags = mesh.cells_dict[key], mesh.cell_data_dict["medit:ref"][key]
        out.write(f"{name} {len(cells)}\n")
        out.writelines(" ".join(map(str, [*(c + 1), r + 1])) + "\n" for c, r in zip(cells, tags))
    out.write(f"RequiredEdges {len(mesh.cells_dict['line'])}\n")
    out.writelines(f"{i + 1}\n" for i in range(len(mesh.cells_dict["line"])))
    out.write("End\n")
open("background.mtr", "w").write(f"{len(delta)} 1\n" + "\n".join(delta) + "\n")
subprocess.run(["ffbamg", "-b", "background.mesh", "-M", "background.mtr", "-noKeepBackVertices", "-thetaquad", "45", "-oftq", "out.ftq"], check=True)
numbers = open("out.ftq").read().split()
n_points, n_faces = int(numbers[0]), int(numbers[1])
at = 4
with open(output, "w") as out:
    for _ in range(n_faces):
        n = int(numbers[at])
        out.write("f " + " ".join(numbers[at + 1 : at + 1 + n]) + "\n")
        at += n + 2
    for i in range(n_points):
        out.write(f"v {numbers[at + 3 * i]} {numbers[at + 3 * i + 1]} 0\n")
