# SPDX-License-Identifier: GPL-3.0-or-later
"""Poisson's equation on planar quads of any order: a small solver of our own, that shares nothing with the program but the files.

Elements are Lagrange's, with equidistant nodes, on the places that the file's nodes give them (isoparametric).
"""
import re

import meshio
import numpy as np
import scipy.sparse
import scipy.sparse.linalg


def gmsh_order(order):
    """Places (i, j), 0 to order, of the nodes of a quad as Gmsh numbers them: corners, sides, then the same inside."""
    if order <= 0:
        return [(0, 0)] if order == 0 else []
    n = order
    places = [(0, 0), (n, 0), (n, n), (0, n)]
    places += [(i, 0) for i in range(1, n)] + [(n, i) for i in range(1, n)]
    places += [(i, n) for i in range(n - 1, 0, -1)] + [(0, i) for i in range(n - 1, 0, -1)]
    return places + [(i + 1, j + 1) for i, j in gmsh_order(n - 2)]


def vtk_order(order):
    """The same of VTK's Lagrange quads: opposite sides run the same way, rows inside."""
    n = order
    sides = [(i, 0) for i in range(1, n)] + [(n, i) for i in range(1, n)] + [(i, n) for i in range(1, n)] + [(0, i) for i in range(1, n)]
    return [(0, 0), (n, 0), (n, n), (0, n), *sides, *((i, j) for j in range(1, n) for i in range(1, n))]


def lagrange(order, at):
    """Values and slopes of the polynomials of the nodes k / order at places in [0, 1]: (points, nodes) each."""
    coefficients = np.linalg.inv(np.vander(np.linspace(0, 1, order + 1), increasing=True))
    powers = np.vander(at, order + 1, increasing=True)
    slopes = np.zeros_like(powers)
    slopes[:, 1:] = powers[:, :-1] * np.arange(1, order + 1)
    return powers @ coefficients, slopes @ coefficients


def gauss(n):
    at, weights = np.polynomial.legendre.leggauss(n)
    return (at + 1) / 2, weights / 2


class Mesh:
    """Points in the plane, quads (rows of nodes in Gmsh's order), lines by name."""

    def __init__(self, points, quads, lines):
        self.points, self.quads, self.lines = points, quads, lines
        self.order = round(quads.shape[1] ** 0.5) - 1

    def nodes_on(self, name):
        return np.unique(self.lines[name])

    def straightened(self):
        """The same with nodes between corners in the middle: straight sides."""
        points = self.points.copy()
        for k, (i, j) in enumerate(gmsh_order(self.order)):
            x, y = i / self.order, j / self.order
            weights = [(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y]
            points[self.quads[:, k]] = sum(w * self.points[self.quads[:, c]] for c, w in enumerate(weights))
        return Mesh(points, self.quads, self.lines)


def read_msh(path):
    """By meshio, which needs no line of ours."""
    mesh = meshio.read(path)
    assert np.ptp(mesh.points[:, 2]) == 0, "expected a planar mesh"
    names = {tag: name for name, (tag, dim) in mesh.field_data.items() if dim == 1}
    quads, lines = [], {}
    for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
        if block.type.startswith("quad"):
            quads.append(block.data)
        elif block.type.startswith("line"):
            for row, tag in zip(block.data, tags):
                lines.setdefault(names[tag], []).append(row)
        else:
            raise AssertionError(f"expected quads and lines, found {block.type}")
    return Mesh(mesh.points[:, :2], np.concatenate(quads), {name: np.array(rows) for name, rows in lines.items()})


def read_vtu(path):
    """By meshio; names of curves are field data."""
    mesh = meshio.read(path)
    quads, lines = [], {}
    names = {int(t): title.split(" ", 1)[1] for title, tags in mesh.field_data.items() if title.startswith("curve ") for t in tags}
    for block, tags in zip(mesh.cells, mesh.cell_data["curve"]):
        if re.match("quad|VTK_LAGRANGE_QUAD", block.type):
            quads.append(block.data)
        else:
            for row, tag in zip(block.data, tags):
                lines.setdefault(names[int(tag)], []).append(row)
    quads = np.concatenate(quads)
    order = round(quads.shape[1] ** 0.5) - 1
    if order > 2:
        places = vtk_order(order)
        quads = quads[:, [places.index(place) for place in gmsh_order(order)]]
    return Mesh(mesh.points[:, :2], quads, {name: np.array(rows) for name, rows in lines.items()})


class Elements:
    """Shapes, places, gradients and weights at the points of a Gauss rule: arrays (quads, points, ...)."""

    def __init__(self, mesh, n):
        at, weights = gauss(n)
        values, slopes = lagrange(mesh.order, at)
        places = gmsh_order(mesh.order)
        x = np.array([[a, b] for a in range(n) for b in range(n)])
        self.shapes = np.array([[values[a, i] * values[b, j] for i, j in places] for a, b in x])
        local = np.array([[[slopes[a, i] * values[b, j], values[a, i] * slopes[b, j]] for i, j in places] for a, b in x])
        nodes = mesh.points[mesh.quads]
        self.at = np.einsum("qi,cix->cqx", self.shapes, nodes)
        jacobian = np.einsum("qid,cix->cqxd", local, nodes)
        determinants = np.linalg.det(jacobian)
        assert determinants.min() > 0, "an element is inverted"
        self.weights = determinants * np.array([weights[a] * weights[b] for a, b in x])
        self.gradients = np.einsum("qid,cqdx->cqix", local, np.linalg.inv(jacobian))


def line_load(mesh, name, flux):
    """Integrals of flux(x, y) times the shape functions along lines of a name."""
    load = np.zeros(len(mesh.points))
    at, weights = gauss(mesh.order + 2)
    values, slopes = lagrange(mesh.order, at)
    along = [0, mesh.order, *range(1, mesh.order)]  # ends first
    values, slopes = values[:, along], slopes[:, along]
    rows = mesh.lines[name]
    nodes = mesh.points[rows]
    lengths = np.linalg.norm(np.einsum("qi,lix->lqx", slopes, nodes), axis=2)
    x = np.einsum("qi,lix->lqx", values, nodes)
    np.add.at(load, rows, np.einsum("lq,q,qi,lq->li", lengths, weights, values, flux(x[..., 0], x[..., 1])))
    return load


def solve_poisson(mesh, source, fixed, flux=None):
    """Nodal values of -laplace u = source. `fixed`: value at nodes, by name; `flux`: by name, du/dn as a function."""
    cells = Elements(mesh, mesh.order + 2)
    n = len(mesh.points)
    flat = (cells.gradients * np.sqrt(cells.weights)[..., None, None]).transpose(0, 2, 1, 3).reshape(*mesh.quads.shape, -1)
    stiffness = flat @ flat.transpose(0, 2, 1)
    rows = np.repeat(mesh.quads, mesh.quads.shape[1], axis=1).ravel()
    columns = np.tile(mesh.quads, mesh.quads.shape[1]).ravel()
    matrix = scipy.sparse.csr_matrix((stiffness.ravel(), (rows, columns)), shape=(n, n))
    load = np.zeros(n)
    np.add.at(load, mesh.quads, np.einsum("cq,qi,cq->ci", cells.weights, cells.shapes, source(cells.at[..., 0], cells.at[..., 1])))
    for name, function in (flux or {}).items():
        load += line_load(mesh, name, function)
    u, free = np.zeros(n), np.ones(n, bool)
    for name, value in fixed.items():
        nodes = mesh.nodes_on(name)
        u[nodes] = value(*mesh.points[nodes].T) if callable(value) else value
        free[nodes] = False
    right = (load - matrix @ u)[free]
    factors = scipy.sparse.linalg.splu(matrix[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    u[free] = factors.solve(right)
    return u


def l2_error(mesh, u, exact):
    """By a rule that is two points richer than the rule of the matrix."""
    cells = Elements(mesh, mesh.order + 4)
    difference = np.einsum("qi,ci->cq", cells.shapes, u[mesh.quads]) - exact(cells.at[..., 0], cells.at[..., 1])
    return np.sqrt(np.sum(cells.weights * difference ** 2))
