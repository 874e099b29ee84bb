#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves Poisson's equation and adapts the mesh to the solution, in a loop: adapt_poisson.py [--quads N] [--meshes M] [-o PICTURE.svg]

The solution is tanh(50 (x^2 + y^2 - 1/2)) on the unit square: a layer along a circle. Elements are bilinear. Prints the errors of
each mesh: of stretched quads, of squares, and of a uniform mesh. Needs numpy, scipy and the Python module delquad.
"""

import time

import delquad
import numpy as np
import scipy.sparse
import scipy.sparse.linalg

import driver


def solution(x, y):
    """u, its gradient and -Laplace(u)."""
    u = np.tanh(50 * (x**2 + y**2 - 0.5))
    s = 100 * (1 - u**2)
    return u, s * x, s * y, -2 * s * (1 - 100 * u * (x**2 + y**2))


def places(mesh, n):
    """Gauss's n x n places of all quads: shape functions, their slopes in the plane, points and weights."""
    nodes, weights = np.polynomial.legendre.leggauss(n)
    corners = mesh.points[mesh.quads, :2]
    for s, ws in zip((1 + nodes) / 2, weights / 2):
        for t, wt in zip((1 + nodes) / 2, weights / 2):
            shape = np.array([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])
            slope = np.array([[t - 1, 1 - t, t, -t], [s - 1, -s, s, 1 - s]])
            jacobian = np.einsum("ak,ekb->eab", slope, corners)
            area = np.linalg.det(jacobian)
            yield shape, np.linalg.solve(jacobian, np.broadcast_to(slope, (len(area), 2, 4))), np.einsum("k,ekb->eb", shape, corners), ws * wt * area


def solve(mesh):
    n = len(mesh.points)
    stiffness, load = np.zeros((len(mesh.quads), 4, 4)), np.zeros(n)
    for shape, slopes, at, weight in places(mesh, 4):
        stiffness += np.einsum("e,eak,eal->ekl", weight, slopes, slopes)
        np.add.at(load, mesh.quads, np.outer(weight * solution(*at.T)[3], shape))
    rows, columns = np.repeat(mesh.quads, 4, axis=1), np.tile(mesh.quads, 4)
    matrix = scipy.sparse.csr_matrix((stiffness.ravel(), (rows.ravel(), columns.ravel())), (n, n))
    u = np.zeros(n)
    held = np.unique(mesh.lines)
    free = np.setdiff1d(np.arange(n), held)
    u[held] = solution(*mesh.points[held, :2].T)[0]
    u[free] = scipy.sparse.linalg.spsolve(matrix[free][:, free], (load - matrix @ u)[free])
    return u


def errors(mesh, u):
    """Returns the errors of u in L2, and of its gradient."""
    of_u = of_gradient = 0
    for shape, slopes, at, weight in places(mesh, 6):
        true, dx, dy, _ = solution(*at.T)
        of_u += weight @ (u[mesh.quads] @ shape - true) ** 2
        gradient = np.einsum("eak,ek->ea", slopes, u[mesh.quads])
        of_gradient += weight @ ((gradient - np.stack([dx, dy], axis=1)) ** 2).sum(axis=1)
    return of_u**0.5, of_gradient**0.5


def main():
    arguments = driver.parser(__doc__, "adapt.svg", quads=2000, meshes=6).parse_args()
    square = delquad.polygons([[(0, 0), (1, 0), (1, 1), (0, 1)]])
    last = {}
    print("loop        mesh  quads  vertices  L2 error   H1 error  estimated L2   H1     seconds")
    for loop, settings in (("stretched", {}), ("aspect 8", {"aspect": 8}), ("squares", {"isotropic": True})):
        mesh = delquad.mesh(square, quads=arguments.quads)
        for k in range(arguments.meshes + 1):
            began = time.perf_counter()
            u = solve(mesh)
            solved = time.perf_counter() - began
            l2, h1 = errors(mesh, u)
            guess = delquad.estimate_error(mesh, u)
            made = 0 if k == 0 else seconds
            name = "uniform" if k == 0 else loop
            print(
                f"{name:10} {k:5} {len(mesh.quads):6} {len(mesh.points):9} {l2:9.3e} {h1:10.4f} {guess['interpolation']:13.3e}"
                f" {guess['gradient']:8.4f} {made:5.2f} + {solved:.2f}"
            )
            last[name] = len(mesh.points), l2, h1
            if k == arguments.meshes and loop == "stretched":
                driver.draw(mesh, u, arguments.output, loop)
            if k < arguments.meshes:
                began = time.perf_counter()
                mesh, _ = delquad.adapt(mesh, u, quads=arguments.quads, model=square, **settings)
                seconds = time.perf_counter() - began
    for loop in ("stretched", "aspect 8"):
        n, l2, h1 = last[loop]
        for other in ("squares", "uniform"):
            m, other_l2, other_h1 = last[other]
            print(f"vertices at equal error, {other} over {loop}: {other_l2 * m / (l2 * n):.1f} (L2), {(other_h1 / h1) ** 2 * m / n:.1f} (H1)")


if __name__ == "__main__":
    main()
