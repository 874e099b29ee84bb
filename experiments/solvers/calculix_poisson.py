# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of CalculiX for the planar solution of 'solver = ["poisson"]', as JSON: calculix_poisson.py MESH.msh

Heat is conducted in one layer of bricks over the quads. Needs ccx, python3-meshio and python3-numpy.
"""
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import meshio
import numpy as np

CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])


class Cells:
    """Bilinear quads at the points of a Gauss rule: shapes (points, 4), positions, gradients, weights."""

    def __init__(self, xy, quads, n):
        s, w = np.polynomial.legendre.leggauss(n)
        r = np.array([(a, b) for a in s for b in s])
        self.shapes = np.prod(1 + r[:, None] * CORNERS, axis=2) / 4
        local = CORNERS * (1 + r[:, None] * CORNERS)[:, :, ::-1] / 4
        corners = xy[quads]
        self.at = np.einsum("qi,cix->cqx", self.shapes, corners)
        jacobian = np.einsum("qid,cix->cqxd", local, corners)
        self.weights = np.linalg.det(jacobian) * np.outer(w, w).ravel()
        self.gradients = np.einsum("qid,cqdx->cqix", local, np.linalg.inv(jacobian))


def wave(xy, quads):
    """sin(pi/2 r^2) and its gradient, with r the distance from the centroid in radii of gyration."""
    cells = Cells(xy, quads, 3)
    area = cells.weights.sum()
    centre = np.einsum("cq,cqx->x", cells.weights, cells.at) / area
    radius2 = np.einsum("cq,cqx->", cells.weights, (cells.at - centre) ** 2) / area

    def phase(x):
        return np.pi / 2 * ((x - centre) ** 2).sum(-1) / radius2

    return lambda x: np.sin(phase(x)), lambda x: np.pi / radius2 * np.cos(phase(x))[..., None] * (x - centre)


def deck(xy, quads, flux, boundary, values):
    n = len(xy)
    layers = [(1, 0), (n + 1, 1)]  # number of the first node, height
    # It reads twenty characters of a number.
    nodes = [f"{first + i}, {x:.12e}, {y:.12e}, {z}" for first, z in layers for i, (x, y) in enumerate(xy)]
    bricks = [", ".join(map(str, [c + 1, *(q + 1), *(q + n + 1)])) for c, q in enumerate(quads)]
    fixed = [f"{first + i}, 11, 11, {u:.12e}" for first, _ in layers for i, u in zip(boundary, values)]
    sources = [f"{first + i}, 11, {f / 2:.12e}" for first, _ in layers for i, f in enumerate(flux)]
    return "\n".join(["*NODE, NSET=ALL", *nodes, "*NSET, NSET=PLANE, GENERATE", f"1, {n}", "*ELEMENT, TYPE=C3D8, ELSET=ALL", *bricks,
                      "*MATERIAL, NAME=M", "*CONDUCTIVITY", "1.", "*SOLID SECTION, ELSET=ALL, MATERIAL=M",
                      "*INITIAL CONDITIONS, TYPE=TEMPERATURE", "ALL, 0.", "*STEP", "*HEAT TRANSFER, STEADY STATE", "1., 1.",
                      "*BOUNDARY", *fixed, "*CFLUX", *sources, "*NODE PRINT, NSET=PLANE", "NT", "*END STEP", ""])


def solve(text, n):
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "deck.inp").write_text(text)
        log = subprocess.run(["ccx", "-i", "deck"], cwd=folder, capture_output=True, text=True).stdout
        rows = [line.split() for line in Path(folder, "deck.dat").read_text().splitlines()]
    found = {int(row[0]): float(row[1]) for row in rows if len(row) == 2 and row[0].isdigit()}
    if len(found) != n:
        sys.exit(f"ccx gave {len(found)} temperatures, expected {n}: {log[-500:]}")
    return np.array([found[i + 1] for i in range(n)])


def main(path):
    if not shutil.which("ccx"):
        sys.exit("CalculiX is not installed: expected ccx on the PATH (Debian: calculix-ccx)")
    mesh = meshio.read(path)
    if "quad" not in mesh.cells_dict or "triangle" in mesh.cells_dict or np.ptp(mesh.points[:, 2]) > 0:
        sys.exit(f"{path}: expected a planar mesh of quads only")
    used, quads = np.unique(mesh.cells_dict["quad"], return_inverse=True)
    xy, quads = mesh.points[used, :2], quads.reshape(-1, 4)
    u, gradient = wave(xy, quads)
    sides = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    sides, count = np.unique(sides, axis=0, return_counts=True)
    boundary = np.unique(sides[count == 1])
    two, three = Cells(xy, quads, 2), Cells(xy, quads, 3)
    load = np.einsum("cq,cqx,cqix->ci", two.weights, gradient(two.at), two.gradients)
    flux = np.bincount(quads.ravel(), load.ravel(), len(xy))
    found = solve(deck(xy, quads, flux, boundary, u(xy[boundary])), len(xy))[quads]

    def norm(value, exact):
        return np.sqrt(np.einsum("cq,cqx->", three.weights, (value - exact) ** 2))

    value, exact = np.einsum("qi,ci->cq", three.shapes, found)[..., None], u(three.at)[..., None]
    slope, exact_slope = np.einsum("cqix,ci->cqx", three.gradients, found), gradient(three.at)
    print(json.dumps({"l2": norm(value, exact) / norm(0, exact), "h1": norm(slope, exact_slope) / norm(0, exact_slope)}))


if __name__ == "__main__":
    main(sys.argv[1])
