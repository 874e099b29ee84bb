#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Netgen's quad-dominated meshes: netgen_quads.py INPUT.mesh OUTPUT.obj SIZE

INPUT: triangles of a planar domain, from whose boundary edges it starts.
"""
import sys

try:
    import meshio
    from netgen.geom2d import SplineGeometry
except ImportError as error:
    sys.exit(print(error) or 77)

source, output, size = sys.argv[1:4]
mesh = meshio.read(source)
left = {}  # region on the left of a triangle's side
for triangle, region in zip(mesh.cells_dict["triangle"], mesh.cell_data_dict["medit:ref"]["triangle"]):
    for a, b in zip(triangle, triangle[[1, 2, 0]]):
        left[a, b] = 1 + int(region)
borders = [(a, b) for a, b in left if left[a, b] > left.get((b, a), 0)]
geometry = SplineGeometry()
number = {v: geometry.AppendPoint(*mesh.points[v][:2]) for v in sorted({v for side in borders for v in side})}
for a, b in borders:
    geometry.Append(["line", number[a], number[b]], leftdomain=left[a, b], rightdomain=left.get((b, a), 0))
result = geometry.GenerateMesh(maxh=float(size), quad_dominated=True)
with open(output, "w") as out:
    out.writelines("v %.17g %.17g 0\n" % tuple(p.p[:2]) for p in result.Points())
    out.writelines("f " + " ".join(str(v.nr) for v in e.vertices) + "\n" for e in result.Elements2D())
