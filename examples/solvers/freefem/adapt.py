#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves by FreeFem++ on halved quads and on triangles that follow the solution: adapt.py [--vertices N] [--meshes M] [-o PICTURE.svg]

Solves Poisson's equation for atan(60 (r - pi/3)), r from (1.25, -0.25), a layer along an arc. FreeFem++ has no quads, so each is
halved along its shorter diagonal. The table compares with the meshes of its own adaptmesh. All have about N vertices and linear
elements. Needs FreeFem++ (Debian: freefem++) and the Python module delquad.
"""
import pathlib
import sys
import tempfile
import time

try:
    import delquad
    import numpy as np
except ImportError as error:
    sys.exit(f"{error.name} is not installed (delquad: see docs/python.md)")

import run


def solve(mesh, meshes=0, vertices=1, isotropic=False):
    """Returns triangles, vertices, errors and seconds of this mesh and of the meshes of adaptmesh after it, and the last values."""
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        lines, quads = ([[*row, 1] for row in (nodes + 1).tolist()] for nodes in (mesh.lines, mesh.quads))
        run.write_medit(folder / "given.mesh", mesh.points[:, :2].tolist(), lines, quads)
        settings = f"int meshes = {meshes};\nreal vertices = {vertices};\nbool isotropic = {str(isotropic).lower()};\n"
        (folder / "settings.idp").write_text(settings)
        printed = run.solve("adapt.edp", folder)
        return [[float(word) for word in line.split()] for line in printed.splitlines()], np.loadtxt(folder / "values.txt")


def main():
    options = run.driver.parser(__doc__, "adapt.svg", vertices=1000, meshes=6).parse_args()
    square = delquad.polygons([[(0, 0), (1, 0), (1, 1), (0, 1)]])
    print("loop                 quads  triangles  vertices   L2 error   H1 error  seconds")

    def show(loop, quads, row, seconds):
        print(f"{loop:20} {quads:>5}{row[0]:11.0f}{row[1]:10.0f}{row[2]:11.3e}{row[3]:11.3e}{seconds:9.1f}")

    for loop, isotropic in (("squares", True), ("stretched", False)):
        mesh = delquad.mesh(square, quads=options.vertices)
        for k in range(options.meshes + 1):
            began = time.perf_counter()
            if k > 0:
                quads = options.vertices * len(mesh.quads) / len(mesh.points)
                mesh, _ = delquad.adapt(mesh, u, quads=quads, model=square, isotropic=isotropic)
            rows, u = solve(mesh)
            show(loop, len(mesh.quads), rows[0], time.perf_counter() - began)
    run.driver.draw(mesh, u, options.output, "solution")
    for loop, isotropic in (("adaptmesh, iso", True), ("adaptmesh", False)):
        for row in solve(delquad.mesh(square, quads=options.vertices), options.meshes, options.vertices, isotropic)[0][1:]:
            show(loop, "", row, row[4])


if __name__ == "__main__":
    main()
