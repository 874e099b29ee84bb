#!/usr/bin/python3
"""Solves by FreeFem++ on halved quads and on triangles that follow the solution: adapt.py [--vertices N] [--meshes M]

Poisson's equation for atan(60 (r - pi/3)), r from (1.25, -0.25), a layer along an arc. FreeFem++ knows no quads: each is halved
along its shorter diagonal. Beside them are the meshes of its own adaptmesh, all with about N vertices and linear elements. Needs
FreeFem++ (Debian: freefem++) and the Python module delquad.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

try:
    import delquad
    import numpy as np
except ImportError as error:
    sys.exit(f"{error.name} is not installed (delquad: see docs/python.md)")

HERE = pathlib.Path(__file__).resolve().parent


def write_halves(mesh, path):
    a, b, c, d = mesh.quads.T
    length = np.linalg.norm(mesh.points[[a, b]] - mesh.points[[c, d]], axis=2)
    first = np.where(length[0] <= length[1], [a, b, c, d], [b, c, d, a])  # from which the shorter diagonal goes
    triangles = np.concatenate([first[[0, 1, 2]].T, first[[0, 2, 3]].T])
    rows = {"Vertices": mesh.points[:, :2], "Edges": mesh.lines + 1, "Triangles": triangles + 1}
    with open(path, "w", encoding="utf-8") as file:
        file.write("MeshVersionFormatted 2\nDimension 2\n")
        for keyword, values in rows.items():
            file.write(f"{keyword}\n{len(values)}\n" + "".join(" ".join(map(repr, row)) + " 1\n" for row in values.tolist()))
        file.write("End\n")


def solve(mesh, meshes=0, vertices=1, isotropic=False):
    """Triangles, vertices, errors and seconds of this mesh and of those of adaptmesh after it, and the values on the last one."""
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        write_halves(mesh, folder / "given.mesh")
        shutil.copy(HERE / "adapt.edp", folder)
        settings = f"int meshes = {meshes};\nreal vertices = {vertices};\nbool isotropic = {str(isotropic).lower()};\n"
        (folder / "settings.idp").write_text(settings)
        solved = subprocess.run(["FreeFem++", "-nw", "-ne", "-v", "0", "adapt.edp"], cwd=folder, capture_output=True, text=True)
        if solved.returncode != 0:
            sys.exit(f"FreeFem++ failed: {solved.stdout[-2000:]}{solved.stderr[-2000:]}")
        return [[float(word) for word in line.split()] for line in solved.stdout.splitlines()], np.loadtxt(folder / "values.txt")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vertices", type=int, default=1000)
    parser.add_argument("--meshes", type=int, default=6)
    options = parser.parse_args()
    if not shutil.which("FreeFem++"):
        sys.exit("FreeFem++ is not installed: expected FreeFem++ on the PATH (Debian: freefem++)")
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
    for loop, isotropic in (("adaptmesh, iso", True), ("adaptmesh", False)):
        for row in solve(delquad.mesh(square, quads=options.vertices), options.meshes, options.vertices, isotropic)[0][1:]:
            show(loop, "", row, row[4])


if __name__ == "__main__":
    main()
