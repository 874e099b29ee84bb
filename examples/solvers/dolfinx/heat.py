#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Conducts heat through the plate of ../heat.toml by dolfinx: heat.py [--delquad PROGRAM] [--order P] [-o PICTURE.svg]

Elements are curved, of 9 nodes, unless another order is given. Needs dolfinx (0.5, as in Debian 12: python3-dolfinx) and
python3-gmsh, by which it reads MSH files.
"""
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import driver  # noqa: E402
import picture  # noqa: E402

try:
    import gmsh
    import ufl
    from dolfinx import fem
    from dolfinx.fem.petsc import LinearProblem
    from dolfinx.io import gmshio
    from dolfinx.plot import create_vtk_mesh
    from mpi4py import MPI
except ImportError as error:
    sys.exit(f"{error.name} is not installed (Debian: python3-dolfinx, python3-gmsh)")


def read(path):
    """The mesh, its lines by tag, and the tags by name."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.merge(str(path))
    tags = {gmsh.model.getPhysicalName(dim, tag): tag for dim, tag in gmsh.model.getPhysicalGroups(1)}
    mesh, _, lines = gmshio.model_to_mesh(gmsh.model, MPI.COMM_WORLD, 0, gdim=2)
    gmsh.finalize()
    return mesh, lines, tags


def solve(mesh, lines, tags, order):
    space = fem.FunctionSpace(mesh, ("Lagrange", order))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    fixed = [fem.dirichletbc(value, fem.locate_dofs_topological(space, 1, lines.find(tags[name])), space)
             for name, value in (("hot", 1.0), ("cold", 0.0))]
    options = {"ksp_type": "preonly", "pc_type": "lu"}
    zero = fem.Constant(mesh, 0.0)
    return LinearProblem(ufl.inner(ufl.grad(u), ufl.grad(v)) * ufl.dx, zero * v * ufl.dx, bcs=fixed, petsc_options=options).solve()


def main():
    parser = driver.parser(__doc__, "heat.svg")
    parser.add_argument("--delquad", default="delquad", help="the program")
    parser.add_argument("--order", type=int, choices=(1, 2), default=2)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        path = pathlib.Path(work, "heat.msh")
        driver.run([options.delquad, "-q", "mesh", HERE.parent / "heat.toml", "-o", path, "--order", str(options.order)], "see README.md")
        mesh, lines, tags = read(path)
    u = solve(mesh, lines, tags, options.order)
    # Between a difference of temperatures of one, the heat that flows is the energy.
    heat = fem.assemble_scalar(fem.form(ufl.inner(ufl.grad(u), ufl.grad(u)) * ufl.dx))
    print(f"{mesh.topology.index_map(2).size_local} elements of order {options.order}")
    print(f"heat from hot to cold: {heat:.10g}")
    cells, _, points = create_vtk_mesh(u.function_space)
    nodes = cells.reshape(mesh.topology.index_map(2).size_local, -1)[:, 1:9]
    picture.draw([[[*points[n], u.x.array[n]] for n in row] for row in nodes], options.output, "temperature")


if __name__ == "__main__":
    main()
