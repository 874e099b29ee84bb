#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""BAMG's quads: bamg_quads.py INPUT.mesh OUTPUT.obj SIZES.sol [ANGLE]

INPUT: triangles of a planar domain, whose boundary is kept. SIZES: at the points of INPUT, its background: numbers or
tensors. ANGLE: by which corners of quads may differ from 90 degrees (45); 0: triangles stay.
"""
import shutil
import subprocess
import sys

import meshio

if not shutil.which("ffbamg"):
    sys.exit(print("ffbamg of freefem++ is not installed") or 77)
source, output, sizes, angle = [*sys.argv[1:], "45"][:4]
mesh = meshio.read(source)
head, values = open(sizes).read().split("SolAtVertices\n")[1].split("\n1 ")
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
open("background.mtr", "w").write(head + " " + values.split("End")[0])
quads = ["-thetaquad", angle] if angle != "0" else []
subprocess.run(["ffbamg", "-b", "background.mesh", "-M", "background.mtr", "-noKeepBackVertices", *quads, "-oftq", "out.ftq"], check=True)
numbers = open("out.ftq").read().split()
faces, at = [], 4
for _ in range(int(numbers[1])):
    n = int(numbers[at])
    faces.append("f " + " ".join(numbers[at + 1 : at + 1 + n]) + "\n")
    at += n + 2
with open(output, "w") as out:
    out.writelines(f"v {x} {y} 0\n" for x, y in zip(numbers[at::3], numbers[at + 1 :: 3]))
    out.writelines(faces)
