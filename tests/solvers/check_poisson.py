#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Poisson's equation on curved meshes, with conditions by the names of curves: check_poisson.py DELQUAD PROBLEM

PROBLEM: annulus or plate. Errors in L2 must fall with order p + 1 of the elements' order p on curved elements. They must not where the
sides of the same elements are straight. Linear fields are exact. Exit code 77: numpy, scipy or meshio are missing.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import needs  # noqa: E402

np = needs.module("numpy", "python3-numpy")
fe = needs.module("finite_elements", "python3-scipy, python3-meshio")

INNER, OUTER = 0.5, 1.0
ANNULUS = """loop = [
  { circle = { centre = [0, 0], radius = 1 }, boundary = "outside" },
  { circle = { centre = [0, 0], radius = 0.5 }, boundary = "inside", hole = true },
]
"""
HOLES = [(0.6, 0.5, 0.2), (1.3, 0.55, 0.25)]
PLATE = """loop = [
  { rectangle = [[0, 0], [2, 1]], boundary = ["bottom", "right", "top", "left"] },
  { circle = { centre = [0.6, 0.5], radius = 0.2 }, boundary = "small hole", hole = true },
  { circle = { centre = [1.3, 0.55], radius = 0.25 }, boundary = "large hole", hole = true },
]
"""


def annulus():
    """Harmonic: zero on the inside; through the outside comes as much as is given there."""
    def exact(x, y):
        r = np.hypot(x, y)
        return (r ** 2 - INNER ** 4 / r ** 2) * (x * x - y * y) / r ** 2

    def flux(x, y):
        return (2 * OUTER + 2 * INNER ** 4 / OUTER ** 3) * (x * x - y * y) / (x * x + y * y)

    return {"model": ANNULUS, "exact": exact, "source": lambda x, y: 0 * x, "fixed": {"inside": 0}, "flux": {"outside": flux}}


def plate():
    """Zero on all sides and holes: the product of functions that are zero on one each."""
    factors = [lambda x, y: (x, 1, 0, 0), lambda x, y: (2 - x, -1, 0, 0), lambda x, y: (y, 0, 1, 0), lambda x, y: (1 - y, 0, -1, 0)]
    for a, b, r in HOLES:
        factors.append(lambda x, y, a=a, b=b, r=r: ((x - a) ** 2 + (y - b) ** 2 - r * r, 2 * (x - a), 2 * (y - b), 4))

    def exact(x, y):
        return 10 * np.prod([f(x, y)[0] for f in factors], axis=0)

    def source(x, y):
        value, along_x, along_y, laplacian = 1, 0, 0, 0
        for f in factors:  # the product's rule
            v, fx, fy, fl = f(x, y)
            laplacian = laplacian * v + 2 * (along_x * fx + along_y * fy) + value * fl
            value, along_x, along_y = value * v, along_x * v + value * fx, along_y * v + value * fy
        return -10 * laplacian

    names = ["bottom", "right", "top", "left", "small hole", "large hole"]
    return {"model": PLATE, "exact": exact, "source": source, "fixed": dict.fromkeys(names, 0), "flux": {}}


def make_mesh(delquad, folder, model, size, order, form):
    toml, out = os.path.join(folder, "model.toml"), os.path.join(folder, f"mesh.{form}")
    with open(toml, "w", encoding="utf-8") as file:
        file.write(model)
    subprocess.run([delquad, "-q", "mesh", toml, "-o", out, "--size", str(size), "--order", str(order)], check=True)
    return fe.read_msh(out) if form == "msh" else fe.read_vtu(out)


def error_on(mesh, problem):
    u = fe.solve_poisson(mesh, problem["source"], problem["fixed"], problem["flux"])
    return fe.l2_error(mesh, u, problem["exact"])


def measured_order(counts, errors):
    """Slope of the line of least squares through the errors over the mean size of quads, both as logarithms."""
    return np.polyfit(-np.log(counts) / 2, np.log(errors), 1)[0]


# Order of elements: sizes of the meshes, and how far the measured order of errors may be from the expected one. Meshes of different sizes
# are not alike, which the coarser ones of higher orders show most.
SIZES = {1: ([0.03, 0.015], 0.05), 2: ([0.056, 0.04, 0.028, 0.02, 0.014], 0.1),
         3: ([0.1, 0.07, 0.05, 0.035], 0.5), 4: ([0.11, 0.08, 0.056], 0.8)}
STRAIGHT = 2.4  # the most that straight sides have, for any order of elements


def check_orders(delquad, name, problem):
    good = True
    for order, (sizes, tolerance) in SIZES.items():
        if order > 2 and name != "plate":
            continue
        counts, errors, straight = [], [], []
        for size in sizes:
            with tempfile.TemporaryDirectory() as folder:
                mesh = make_mesh(delquad, folder, problem["model"], size, order, "msh")
            assert mesh.order == order, mesh.order
            counts.append(len(mesh.quads))
            errors.append(error_on(mesh, problem))
            if order == 2:
                straight.append(error_on(mesh.straightened(), problem))
        found = measured_order(counts, errors)
        print(f"{name}, order {order}: {counts} quads, errors {' '.join(f'{e:.3g}' for e in errors)}: order {found:.3f}")
        good &= abs(found - order - 1) < tolerance
        if straight:
            found = measured_order(counts, straight)
            print(f"  with straight sides: errors {' '.join(f'{e:.3g}' for e in straight)}: order {found:.3f}")
            good &= found < STRAIGHT
    return good


def check_patch(delquad, name, problem):
    """A linear solution, given on all curves but one straight side, through which it flows: exact to rounding, by MSH and VTU."""
    def linear(x, y):
        return 1 + 2 * x - 3 * y

    good = True
    for order in SIZES:
        for form in ("msh", "vtu"):
            with tempfile.TemporaryDirectory() as folder:
                mesh = make_mesh(delquad, folder, problem["model"], 0.1, order, form)
            straight = {"left": lambda x, y: -2 + 0 * x} if name == "plate" else {}  # whose normal is the same everywhere
            fixed = {curve: linear for curve in mesh.lines if curve not in straight}
            u = fe.solve_poisson(mesh, lambda x, y: 0 * x, fixed, straight)
            off = np.abs(u - linear(*mesh.points.T)).max()
            print(f"{name}, order {order}, {form}: {len(mesh.quads)} quads, a linear field is {off:.1e} off")
            good &= off < 1e-10
    return good


def main():
    delquad, name = sys.argv[1:]
    problem = {"annulus": annulus, "plate": plate}[name]()
    good = check_orders(delquad, name, problem)
    return 0 if check_patch(delquad, name, problem) and good else 1


if __name__ == "__main__":
    sys.exit(main())
