#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pulls a plate with a round hole by CalculiX, on meshes that follow its stresses: adapt.py [--quads N] [--meshes M] [-o PICTURE.svg]

The model is a quarter of a plate that is ten times as wide as the hole. Its outer sides move like an endless plate. So the stress at
the hole is three times the stress far away (Kirsch, 1898). Elements are straight CPS4. Prints the stress for loops of M meshes of N
quads. M uniform meshes follow, whose sides are as long as the radius, half as long, and so on. Needs ccx (Debian: calculix-ccx)
and the Python module delquad.
"""
import math
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

WIDTH, YOUNG, POISSON = 10.0, 210e3, 0.3
DECK = f"""*INCLUDE, INPUT=mesh.inp
*MATERIAL, NAME=STEEL
*ELASTIC
{YOUNG}, {POISSON}
*SOLID SECTION, ELSET=plate, MATERIAL=STEEL
.01
*STEP
*STATIC
*EL FILE, OUTPUT=2D
S
*BOUNDARY
x_axis, 2
y_axis, 1
"""


def plate():
    corners = [(1, 0), (WIDTH, 0), (WIDTH, WIDTH), (0, WIDTH), (0, 1)]
    names = ["x axis", "outer", "outer", "y axis"]
    sides = [delquad.segment(*corners[k : k + 2], name) for k, name in enumerate(names)]
    return delquad.planar([delquad.loop([*sides, delquad.arc((0, 0), 1, math.pi / 2, 0, "hole")], "plate")])


def kirsch(points):
    """Displacements in plane stress under a stress of 1 along x."""
    r, t = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
    k = (3 - POISSON) / (1 + POISSON)
    x = r * (k + 1) * np.cos(t) + 2 / r * ((1 + k) * np.cos(t) + np.cos(3 * t)) - 2 / r**3 * np.cos(3 * t)
    y = r * (k - 3) * np.sin(t) + 2 / r * ((1 - k) * np.sin(t) + np.sin(3 * t)) - 2 / r**3 * np.sin(3 * t)
    return np.stack([x, y], axis=1) * (1 + POISSON) / (4 * YOUNG)


def solve(mesh):
    """The stresses xx, yy and xy at the points."""
    outer = np.unique(mesh.lines[[mesh.curves[k][1] == ["outer"] for k in mesh.line_curve]])
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        mesh.write(folder / "mesh.inp")
        moves = [f"{n + 1}, {d}, {d}, {u:.12g}\n" for n, both in zip(outer, kirsch(mesh.points[outer, :2])) for d, u in enumerate(both, 1)]
        (folder / "deck.inp").write_text(DECK + "".join(moves) + "*END STEP\n")
        stress = run.solve(folder)["STRESS"]
    return np.array([[stress[n + 1][k] for k in (0, 1, 3)] for n in range(len(mesh.points))])


def main():
    options = run.driver.parser(__doc__, "adapt.svg", quads=400, meshes=5).parse_args()
    print("loop        quads  stress     error  seconds")
    for loop, settings in (("uniform", None), ("squares", {"isotropic": True}), ("stretched", {})):
        for k in range(options.meshes):
            began = time.perf_counter()
            if settings is None:
                mesh = delquad.mesh(plate(), size=2.0**-k)
            elif k == 0:
                mesh = delquad.mesh(plate(), quads=options.quads)
            else:
                mesh, _ = delquad.adapt(mesh, stresses, quads=options.quads, model=plate(), **settings)
            stresses = solve(mesh)
            at = stresses[np.argmin(np.hypot(mesh.points[:, 0], mesh.points[:, 1] - 1)), 0]
            print(f"{loop:10}{len(mesh.quads):7}{at:8.4f}{100 * (at / 3 - 1):+8.2f} %{time.perf_counter() - began:9.1f}", flush=True)
    run.driver.draw(mesh, stresses[:, 0], options.output, "stress along x")


if __name__ == "__main__":
    main()
