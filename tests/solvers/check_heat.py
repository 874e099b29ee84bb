#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Conduction of heat in a ball, of hexahedra, prisms, pyramids and tetrahedra: check_heat.py DELQUAD

Errors in L2 of linear elements must fall with order 2; linear fields are exact. The solver is our own, and shares nothing with the program
but the files. Exit code 77: numpy, scipy or meshio are missing.
"""
import pathlib
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import needs  # noqa: E402

np = needs.module("numpy", "python3-numpy")
meshio = needs.module("meshio", "python3-meshio")
linalg = needs.module("scipy.sparse.linalg", "python3-scipy")
sparse = needs.module("scipy.sparse", "python3-scipy")

SIGNS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])


def at_places(kind, x):
    """Values and gradients of the shape functions at places x of the reference element: (places, nodes), (places, nodes, 3)."""
    if kind == "tetra":
        values = np.column_stack([1 - x.sum(axis=1), x])
        slopes = np.tile(np.vstack([[-1, -1, -1], np.eye(3)]), (len(x), 1, 1))
        return values, slopes
    s, t, z = (x[:, k, None] for k in range(3))
    if kind == "wedge":
        linear, flat = np.hstack([1 - s - t, s, t]), np.tile([[-1.0, 1, 0], [-1, 0, 1]], (len(x), 1, 1))
        values, along_s, along_t = (np.hstack([p * (1 - z), p * z]) for p in (linear, flat[:, 0], flat[:, 1]))
        return values, np.stack([along_s, along_t, np.hstack([-linear, linear])], axis=2)
    a, b = SIGNS[:, 0], SIGNS[:, 1]
    if kind == "hexahedron":
        parts = [(1 + a * s) * (1 + b * t) / 4, a * (1 + b * t) / 4, b * (1 + a * s) / 4]
        values, along_s, along_t = (np.hstack([p * (1 - z), p * z]) for p in parts)
        return values, np.stack([along_s, along_t, np.hstack([-parts[0], parts[0]])], axis=2)
    one, zero, r = np.ones_like(z), np.zeros_like(z), 1 - z  # a pyramid: bilinear on its base, linear on its triangles
    values = np.hstack([((1 + a * s) * (1 + b * t) - z + a * b * s * t * z / r) / 4, z])
    along_s = np.hstack([(a * (1 + b * t) + a * b * t * z / r) / 4, zero])
    along_t = np.hstack([(b * (1 + a * s) + a * b * s * z / r) / 4, zero])
    return values, np.stack([along_s, along_t, np.hstack([(-1 + a * b * s * t / r ** 2) / 4, one])], axis=2)


def quadrature(kind, n=4):
    """Places and weights of a rule for this kind, from one of a cube."""
    at, weights = np.polynomial.legendre.leggauss(n)
    u, v, w = (grid.ravel() for grid in np.meshgrid(at, at, (at + 1) / 2, indexing="ij"))
    of_all = np.einsum("i,j,k->ijk", weights, weights, weights / 2).ravel()
    if kind == "hexahedron":
        return np.column_stack([u, v, w]), of_all
    if kind == "pyramid":
        return np.column_stack([u * (1 - w), v * (1 - w), w]), of_all * (1 - w) ** 2
    if kind == "wedge":
        p = (u + 1) / 2
        return np.column_stack([p, (v + 1) / 2 * (1 - p), w]), of_all / 4 * (1 - p)
    p, q = (u + 1) / 2 * (1 - w), (v + 1) / 2
    return np.column_stack([p, q * (1 - w - p), w]), of_all / 4 * (1 - w) * (1 - w - p)


def on_cells(mesh):
    """For each kind of cells: nodes, values, gradients in space, weights and places, at all places of quadrature."""
    for block in mesh.cells:
        if block.type not in ("hexahedron", "wedge", "pyramid", "tetra"):
            assert block.type in ("vertex", "line", "quad", "triangle"), block.type
            continue
        x, weights = quadrature(block.type)
        values, slopes = at_places(block.type, x)
        corners = mesh.points[block.data]
        jacobian = np.einsum("qni,cnj->cqij", slopes, corners)
        det = np.linalg.det(jacobian)
        assert det.min() > 0
        yield block.data, values, np.einsum("cqij,qnj->cqni", np.linalg.inv(jacobian), slopes), det * weights, np.einsum("qn,cnj->cqj", values, corners)


def solve(mesh, exact, source):
    """Temperatures at the nodes, with the exact ones on the skin."""
    n, rows, columns, entries, load = len(mesh.points), [], [], [], np.zeros(len(mesh.points))
    for nodes, values, gradients, weights, places in on_cells(mesh):
        entries.append(np.einsum("cq,cqni,cqmi->cnm", weights, gradients, gradients).ravel())
        rows.append(np.repeat(nodes, nodes.shape[1], axis=1).ravel())
        columns.append(np.tile(nodes, (1, nodes.shape[1])).ravel())
        np.add.at(load, nodes, np.einsum("cq,qn,cq->cn", weights, values, source(*np.moveaxis(places, 2, 0))))
    matrix = sparse.csr_matrix((np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))), (n, n))
    skin = np.unique(np.concatenate([block.data.ravel() for block in mesh.cells if block.type in ("quad", "triangle")]))
    free = np.setdiff1d(np.unique(np.concatenate(rows)), skin)
    u = exact(*mesh.points.T)
    found, state = linalg.cg(matrix[free][:, free], load[free] - matrix[free][:, skin] @ u[skin], tol=1e-12)
    assert state == 0
    u[free] = found
    return u


def l2_error(mesh, u, exact):
    return sum((weights * (np.einsum("qn,cn->cq", values, u[nodes]) - exact(*np.moveaxis(places, 2, 0))) ** 2).sum()
               for nodes, values, _, weights, places in on_cells(mesh)) ** 0.5


def main():
    delquad = sys.argv[1]
    counts, errors, good = [], [], True
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([delquad, "example", "sphere", "-o", "ball.step"], cwd=folder, check=True, capture_output=True)
        for quads in (150, 500, 1700):
            subprocess.run([delquad, "-q", "volume", "ball.step", "--quads", str(quads), "-o", "a.msh2"], cwd=folder, check=True)
            mesh = meshio.read(f"{folder}/a.msh2", file_format="gmsh")
            mesh.points /= abs(mesh.points).max()
            u = solve(mesh, lambda x, y, z: 1 + 2 * x - 3 * y + z, lambda x, y, z: 0 * x)
            good &= abs(u - (1 + 2 * mesh.points[:, 0] - 3 * mesh.points[:, 1] + mesh.points[:, 2])).max() < 1e-9
            exact = lambda x, y, z: np.sin(2 * x) * np.cos(y) * np.exp(z)
            u = solve(mesh, exact, lambda x, y, z: 4 * exact(x, y, z))
            counts.append(len(mesh.points))
            errors.append(l2_error(mesh, u, exact))
    order = np.polyfit(-np.log(counts) / 3, np.log(errors), 1)[0]
    print(f"{counts} points, errors {' '.join(f'{e:.3g}' for e in errors)}: order {order:.3f}, a linear field is {'exact' if good else 'not exact'}")
    return 0 if good and order > 1.8 else 1


if __name__ == "__main__":
    sys.exit(main())
