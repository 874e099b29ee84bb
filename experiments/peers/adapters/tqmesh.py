#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""TQMesh's quads: tqmesh.py INPUT.mesh OUTPUT.obj SIZE

INPUT: triangles of a planar domain, from whose boundary edges it starts.
"""
import shutil
import subprocess
import sys

import meshio

shutil.which("TQMesh") or sys.exit(print("TQMesh is not on the PATH") or 77)
source, output, size = sys.argv[1:4]
mesh = meshio.read(source)
sides = {(a, b) for t in mesh.cells_dict["triangle"] for a, b in zip(t, t[[1, 2, 0]])}
border = [(a, b) for a, b in sides if (b, a) not in sides]
after = dict(border)
len(after) == len(border) or sys.exit(print("its outlines touch in a node: TQMesh wants loops that do not") or 77)
text = f"""Define mesh:\nElement size: {size}\nElement color: 1\nMeshing algorithm: Tri-to-Quad
Number of quad refinements: 1\nNumber of smoothing iterations: 3\nOutput file format: TXT\nOutput file prefix: ./out\n"""
while after:  # loops with the domain on their left, as TQMesh wants them
    loop = [next(iter(after))]
    while loop[-1] in after:
        loop.append(after.pop(loop[-1]))
    x, y = mesh.points[loop, :2].T
    kind = "exterior" if (x[:-1] * y[1:] - x[1:] * y[:-1]).sum() > 0 else "interior"
    text += f"Define {kind} boundary:\n" + "".join("%.17g, %.17g, 1\n" % p for p in zip(x[:-1], y)) + f"End {kind} boundary\n"
with open("mesh.para", "w") as out:
    out.write(text + "End mesh\n")
subprocess.run(["TQMesh", "mesh.para"], check=True)
told = open("out.txt")
with open(output, "w") as out:
    for line in told:
        key, *count = line.split()
        if key in ("VERTICES", "QUADS", "TRIANGLES"):
            for row in (next(told).strip().split(",") for _ in range(int(count[0]))):
                print(*(["v", *row, 0] if key == "VERTICES" else ["f", *(int(v) + 1 for v in row[:-1])]), file=out)
