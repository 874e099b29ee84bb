#!/usr/bin/python3
"""Netgen's quad-dominated meshes: netgen_quads.py INPUT OUTPUT.obj SIZE POINTS.

INPUT: triangles (.mesh) of a planar domain, whose boundary is kept, or STEP. POINTS: lines "x y z size".
"""
import sys

try:
    import meshio
    from netgen import NgOCC, geom2d
    from netgen.meshing import MeshingParameters, MeshingStep
except ImportError as error:
    sys.exit(print(error) or 77)


def planar(path):
    """Lines between regions, and between a region and the outside."""
    mesh = meshio.read(path)
    left = {}
    for triangle, region in zip(mesh.cells_dict["triangle"], mesh.cell_data_dict["medit:ref"]["triangle"]):
        for a, b in zip(triangle, triangle[[1, 2, 0]]):
            left[a, b] = 1 + region
    geometry = geom2d.SplineGeometry()
    borders = [(a, b) for a, b in left if left[a, b] > left.get((b, a), 0)]
    number = {v: geometry.AppendPoint(*mesh.points[v][:2]) for v in sorted({v for e in borders for v in e})}
    for a, b in borders:
        geometry.Append(["line", number[a], number[b]], leftdomain=int(left[a, b]), rightdomain=int(left.get((b, a), 0)))
    return geometry


source, output, size, points = sys.argv[1:5]
if not source.lower().endswith((".mesh", ".step", ".stp")):
    sys.exit(print("Netgen is given triangles in the plane and STEP only") or 77)
lines = [line for line in open(points)]
open("size.msz", "w").write(f"{len(lines)}\n{''.join(lines)}0\n")
how = MeshingParameters(maxh=float(size), quad_dominated=True, perfstepsend=MeshingStep.MESHSURFACE, meshsizefilename="size.msz")
mesh = (planar(source) if source.endswith(".mesh") else NgOCC.LoadOCCGeometry(source)).GenerateMesh(mp=how)
with open(output, "w") as out:
    out.writelines("v %.17g %.17g %.17g\n" % tuple(p.p) for p in mesh.Points())
    out.writelines("f " + " ".join(str(v.nr) for v in e.vertices) + "\n" for e in mesh.Elements2D())
