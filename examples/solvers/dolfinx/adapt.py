#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves by dolfinx in a loop of meshes that follow the solution: adapt.py [--quads N] [--doublings D] [-o PICTURE.svg] [PROBLEM ...]

The problem shock is Poisson's equation for atan(60 (r - pi/3)), r from (1.25, -0.25), a layer along an arc. The problem advection
goes along (1, 1) with diffusion 0.005, which makes layers at two sides, by SUPG. Each loop has three meshes of N quads, then D meshes with twice as
many each; the picture shows the last one. The order is the order of the error in the mean size of quads. Needs dolfinx (0.5, as in
Debian 12: python3-dolfinx) and the Python module delquad.
"""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import driver  # noqa: E402

try:
    import delquad
    import numpy as np
    import ufl
    from dolfinx import fem
    from dolfinx.fem.petsc import LinearProblem
    from dolfinx.mesh import create_mesh, exterior_facet_indices
    from mpi4py import MPI
except ImportError as error:
    sys.exit(f"{error.name} is not installed (Debian: python3-dolfinx; delquad: see docs/python.md)")

EPSILON = 0.005
PLACES = {"quadrature_degree": 16}  # the layers of the true solution within one quad of a coarse mesh


def shock(x, u, v):
    """The true solution and the equation."""
    true = ufl.atan(60 * (ufl.sqrt((x[0] - 1.25) ** 2 + (x[1] + 0.25) ** 2) - math.pi / 3))
    return true, ufl.inner(ufl.grad(u), ufl.grad(v)) * ufl.dx + ufl.div(ufl.grad(true)) * v * ufl.dx(metadata=PLACES)


def advection(x, u, v):
    """Returns a product of factors in x and in y, each of which is advected and diffused under a source of 1."""
    fx, fy = (s - (ufl.exp((s - 1) / EPSILON) - math.exp(-1 / EPSILON)) / (1 - math.exp(-1 / EPSILON)) for s in (x[0], x[1]))
    along = ufl.as_vector((1, 1))
    residual = ufl.dot(along, ufl.grad(u)) - EPSILON * ufl.div(ufl.grad(u)) - fx - fy
    inverse = 2 * ufl.JacobianInverse(x.ufl_domain())  # of the map from the square of side 2
    metric = inverse.T * inverse
    time_scale = 1 / ufl.sqrt(ufl.dot(along, metric * along) + 9 * EPSILON**2 * ufl.inner(metric, metric))
    galerkin = EPSILON * ufl.inner(ufl.grad(u), ufl.grad(v)) + (ufl.dot(along, ufl.grad(u)) - fx - fy) * v
    return fx * fy, (galerkin + time_scale * residual * ufl.dot(along, ufl.grad(v))) * ufl.dx(metadata=PLACES)


PROBLEMS = {"shock": shock, "advection": advection}


def solve(quads, problem):
    """Values at the points of a mesh, its quads, and errors: of the solution and of its gradient, in L2."""
    cell = ufl.VectorElement("Lagrange", "quadrilateral", 1)
    mesh = create_mesh(MPI.COMM_SELF, quads.quads[:, [0, 1, 3, 2]].astype(np.int64), quads.points[:, :2], ufl.Mesh(cell))
    space = fem.FunctionSpace(mesh, ("Lagrange", 1))
    true, form = problem(ufl.SpatialCoordinate(mesh), ufl.TrialFunction(space), ufl.TestFunction(space))
    held = fem.Function(space)
    held.interpolate(fem.Expression(true, space.element.interpolation_points()))
    mesh.topology.create_connectivity(1, 2)
    rim = fem.locate_dofs_topological(space, 1, exterior_facet_indices(mesh.topology))
    options = {"ksp_type": "preonly", "pc_type": "lu"}
    u = LinearProblem(*ufl.system(form), bcs=[fem.dirichletbc(held, rim)], petsc_options=options).solve()
    parts = [ufl.inner(e, e) * ufl.dx(metadata=PLACES) for e in (u - true, ufl.grad(u - true))]
    values = np.zeros(len(quads.points))
    values[np.array(mesh.geometry.input_global_indices)[mesh.geometry.dofmap.array]] = u.x.array[space.dofmap.list.array]
    return values, len(quads.quads), [fem.assemble_scalar(fem.form(part)) ** 0.5 for part in parts]


def main():
    parser = driver.parser(__doc__, "adapt.svg", quads=500, doublings=3)
    parser.add_argument("problems", nargs="*", metavar="PROBLEM", default=["shock", "advection"], help="shock, advection")
    options = parser.parse_args()
    square = delquad.polygons([[(0, 0), (1, 0), (1, 1), (0, 1)]])

    def next_mesh(mesh, u, quads, isotropic):
        return delquad.adapt(mesh, u, quads=quads, model=square, isotropic=isotropic)[0]

    for name in options.problems:
        last = driver.compare(name, options.quads, options.doublings, lambda n: delquad.mesh(square, quads=n), next_mesh,
                              lambda mesh: solve(mesh, PROBLEMS[name]))
    driver.draw(*last, options.output, name)


if __name__ == "__main__":
    main()
