#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Poisson's equation on an annulus by dolfinx: check_dolfinx.py DELQUAD. Exit code 77: it is not installed.

Meshes come by MSH and by XDMF, conditions by names of curves. Errors in L2 must fall with order 2 and, on curved elements of 9
nodes, 3. A linear displacement that is given on the curves is exact inside.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import needs  # noqa: E402

gmsh = needs.module("gmsh", "python3-gmsh")
LinearProblem = needs.module("dolfinx.fem.petsc", "python3-dolfinx").LinearProblem
import numpy as np  # noqa: E402
import ufl  # noqa: E402
from check_poisson import ANNULUS, INNER, OUTER, SIZES  # noqa: E402
from dolfinx import fem  # noqa: E402
from dolfinx.io import XDMFFile, gmshio  # noqa: E402
from mpi4py import MPI  # noqa: E402


def read_msh(path):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.merge(path)
    tags = {gmsh.model.getPhysicalName(dim, tag): tag for dim, tag in gmsh.model.getPhysicalGroups(1)}
    mesh, _, lines = gmshio.model_to_mesh(gmsh.model, MPI.COMM_WORLD, 0, gdim=2)
    gmsh.finalize()
    return mesh, lines, tags


def read_xdmf(path):
    with XDMFFile(MPI.COMM_WORLD, path, "r") as file:
        mesh = file.read_mesh(name="mesh")
        mesh.topology.create_connectivity(1, 0)
        lines = file.read_meshtags(mesh, name="lines")
    tags = {info.get("Value"): int(info.get("Name").split()[1]) for info in xml.etree.ElementTree.parse(path).iter("Information")
            if info.get("Name").startswith("curve ")}
    return mesh, lines, tags


def error_on(mesh, lines, tags, order):
    """Harmonic: zero on the inside; through the outside comes as much as is given there."""
    x = ufl.SpatialCoordinate(mesh)
    r2, c = x[0] ** 2 + x[1] ** 2, x[0] ** 2 - x[1] ** 2
    exact, flux = (1 - INNER ** 4 / r2 ** 2) * c, (2 * OUTER + 2 * INNER ** 4 / OUTER ** 3) * c / r2
    space = fem.FunctionSpace(mesh, ("Lagrange", order))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    ds = ufl.Measure("ds", domain=mesh, subdomain_data=lines)(tags["outside"])
    cold = fem.dirichletbc(0.0, fem.locate_dofs_topological(space, 1, lines.find(tags["inside"])), space)
    found = LinearProblem(ufl.inner(ufl.grad(u), ufl.grad(v)) * ufl.dx, flux * v * ds, bcs=[cold],
                          petsc_options={"ksp_type": "preonly", "pc_type": "lu"}).solve()
    return np.sqrt(fem.assemble_scalar(fem.form((found - exact) ** 2 * ufl.dx(metadata={"quadrature_degree": 8}))))


def make(delquad, folder, size, order, form):
    model, out = os.path.join(folder, "model.toml"), os.path.join(folder, f"mesh.{form}")
    with open(model, "w", encoding="utf-8") as file:
        file.write(ANNULUS)
    subprocess.run([delquad, "-q", "mesh", model, "-o", out, "--size", str(size), "--order", str(order)], check=True)
    return (read_msh if form == "msh" else read_xdmf)(out)


def patch_error(mesh, lines, tags, order):
    """Plane stress, with a displacement that is linear and given on both circles: how far it is off at the nodes inside."""
    def linear(x):
        return np.array([1e-3 * x[0] + 2e-3 * x[1], -0.5e-3 * x[0] + 0.7e-3 * x[1]])

    space = fem.VectorFunctionSpace(mesh, ("Lagrange", order))
    exact = fem.Function(space)
    exact.interpolate(linear)
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)

    def strain(w):
        return ufl.sym(ufl.grad(w))

    stress = 0.7 * strain(u) + 0.3 * ufl.tr(strain(u)) * ufl.Identity(2)
    ends = np.concatenate([lines.find(tags[name]) for name in ("inside", "outside")])
    fixed = fem.dirichletbc(exact, fem.locate_dofs_topological(space, 1, ends))
    nothing = fem.Constant(mesh, (0.0, 0.0))
    found = LinearProblem(ufl.inner(stress, strain(v)) * ufl.dx, ufl.inner(nothing, v) * ufl.dx, bcs=[fixed],
                          petsc_options={"ksp_type": "preonly", "pc_type": "lu"}).solve()
    return np.abs(found.x.array - exact.x.array).max() / np.abs(exact.x.array).max()


def main():
    good = True
    for order in (1, 2):
        sizes, tolerance = SIZES[order]
        counts, errors = [], []
        for size in sizes:
            with tempfile.TemporaryDirectory() as folder:
                mesh, lines, tags = make(sys.argv[1], folder, size, order, "msh")
                errors.append(error_on(mesh, lines, tags, order))
                counts.append(mesh.topology.index_map(2).size_local)
        with tempfile.TemporaryDirectory() as folder:
            parts = make(sys.argv[1], folder, sizes[0], order, "xdmf")
            by_xdmf, off = error_on(*parts, order), patch_error(*parts, order)
        found = np.polyfit(-np.log(counts) / 2, np.log(errors), 1)[0]
        print(f"order {order}: {counts} quads, errors {' '.join(f'{e:.3g}' for e in errors)}: order {found:.3f}; by XDMF {by_xdmf:.3g}; "
              f"a linear displacement is {off:.1e} off")
        good &= abs(found - order - 1) < tolerance and abs(by_xdmf / errors[0] - 1) < 1e-6 and off < 1e-10
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
