#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a constant state stays constant on a curved mesh: Trixi's UnstructuredMesh2D, in a few lines.

check_free_stream.py PROGRAM

Reads ISM-V2 as HOHQMesh's documentation has it ("The HOHQMesh Mesh File Formats"), and maps elements by transfinite interpolation of their
sides. Takes the residual of a constant flux in the strong form of the discontinuous Galerkin method at Legendre-Gauss-Lobatto points.
Normals come from the first element of each edge alone (Kopriva [2009], chapters 6 and 8). Exit code 1 where it is above 1e-12, 77 when
numpy is not installed.
"""
import os
import subprocess
import sys
import tempfile

from read_mesh import needs

np = needs.module("numpy", "python3-numpy")

MODEL = """loop = [
  { rectangle = [[0, 0], [3, 2]], boundary = ["bottom wall", "outflow", "top", "inflow"], region = "gas" },
  { circle = { centre = [1.1, 0.9], radius = 0.4 }, boundary = "cylinder", hole = true },
]
size = 0.35
"""
INTERNAL = "---"


def lobatto(n):
    """Points of degree n: -1, the zeros of P_n', 1."""
    inner = np.polynomial.legendre.Legendre.basis(n).deriv().roots() if n > 1 else []
    return np.array([-1, *sorted(np.real(inner)), 1])


def interpolation(nodes, points):
    return np.array([[np.prod([(x - b) / (a - b) for b in nodes if b != a]) for a in nodes] for x in points])


def derivative(nodes):
    """Rows that sum up to zero, so that constants have none (Kopriva [2009], algorithm 37)."""
    gaps = nodes[:, None] - nodes + np.eye(len(nodes))
    d = np.prod(gaps, 1)[:, None] / np.prod(gaps, 1) / gaps
    np.fill_diagonal(d, 0)
    return d - np.diag(d.sum(1))


def read_ism(path):
    """Edges, and of each element its degree + 1 points of four sides, as its coordinates run, and their names."""
    with open(path, encoding="utf-8") as text:
        rows = [line.split() for line in text]
    assert rows.pop(0) == ["ISM-V2"]
    n_nodes, n_edges, n_elements, degree = map(int, rows.pop(0))
    corners = np.array(rows[:n_nodes], float)[:, :2]
    edges = np.array(rows[n_nodes:n_nodes + n_edges], int)
    rows = iter(rows[n_nodes + n_edges:])
    chebyshev = -np.cos(np.pi * np.arange(degree + 1) / degree)
    elements = []
    for _ in range(n_elements):
        block = [next(rows), next(rows)]
        nodes, sides = np.array(block[0], int) - 1, []
        for flag, (a, b) in zip(block[1], ((0, 1), (1, 2), (3, 2), (0, 3))):
            ends = corners[nodes[[a, b]]]
            sides.append(np.outer(1 - chebyshev, ends[0]) / 2 + np.outer(1 + chebyshev, ends[1]) / 2)
            if flag == "1":
                block += [next(rows) for _ in chebyshev]
                sides[-1] = np.array(block[-len(chebyshev):], float)[:, :2]
                assert np.array_equal(sides[-1][[0, -1]], ends)
        elements.append((nodes, sides, next(rows), block))
    assert next(rows, None) is None
    return chebyshev, edges, elements


def agrees(path, abaqus):
    """Whether the comments of HOHQMesh's Abaqus have the same elements, and names in p4est's order of sides: -x, +x, -y, +y."""
    _, _, elements = read_ism(path)
    with open(abaqus, encoding="utf-8") as text:
        lines = text.read().splitlines()
    assert lines[1] == " File created by HOHQMesh"
    rows = [line[2:].split() for line in lines[lines.index("** ***** HOHQMesh boundary information ***** **") + 1:]]
    return rows[1:] == [row for *_, block in elements for row in block] + [[names[k] for k in (3, 1, 0, 2)] for _, _, names, _ in elements]


def place_of(sides, xi):
    """Points [i, j] at (xi_i, xi_j): the sides' Gordon-Hall map."""
    s, t = (xi[:, None, None] + 1) / 2, (xi[None, :, None] + 1) / 2
    bottom, right, top, left = sides
    bottom, top, left, right = bottom[:, None], top[:, None], left[None], right[None]
    corner = (1 - s) * (1 - t) * bottom[:1] + s * (1 - t) * bottom[-1:] + s * t * top[-1:] + (1 - s) * t * top[:1]
    return (1 - t) * bottom + t * top + (1 - s) * left + s * right - corner


def residuals(path):
    """The greatest residual over flux by size of the element, the least Jacobian over the element's largest, and the names of the boundary."""
    chebyshev, edges, elements = read_ism(path)
    xi = lobatto(len(chebyshev) - 1)
    weights = 2 / (len(xi) * (len(xi) - 1) * np.polynomial.legendre.Legendre.basis(len(xi) - 1)(xi) ** 2)
    d, to_xi = derivative(xi), interpolation(chebyshev, xi)
    flux = np.array([0.7, -1.3])
    normals, inside, least = [], [], np.inf
    for _, sides, _, _ in elements:
        x = place_of([to_xi @ (side - sides[0][0]) for side in sides], xi)  # near 0, where less is rounded
        x_s, x_t = np.einsum("ik,kjc->ijc", d, x), np.einsum("jk,ikc->ijc", d, x)
        a_s, a_t = np.stack([x_t[..., 1], -x_t[..., 0]], -1), np.stack([-x_s[..., 1], x_s[..., 0]], -1)
        jacobian = x_s[..., 0] * x_t[..., 1] - x_s[..., 1] * x_t[..., 0]
        least = min(least, jacobian.min() / jacobian.max())
        inside.append((d @ (a_s @ flux) + (a_t @ flux) @ d.T, jacobian))
        normals.append((-a_t[:, 0], a_s[-1], a_t[:, -1], -a_s[0]))
    named = {}
    for start, end, first, second, side, other in edges:
        nodes, _, names, _ = elements[first - 1]
        assert [start, end] == [nodes[k] + 1 for k in ((0, 1), (1, 2), (3, 2), (0, 3))[side - 1]]
        assert (second == 0) == (other == 0) == (names[side - 1] != INTERNAL)
        if second == 0:
            named[names[side - 1]] = named.get(names[side - 1], 0) + 1
            continue
        # What goes out of the first goes into the second, whose own normal is taken for what is inside.
        n = normals[first - 1][side - 1][::-1 if other < 0 else 1]
        mismatch = (-n - normals[second - 1][abs(other) - 1]) @ flux / weights[0]
        at = ((slice(None), 0), (-1, slice(None)), (slice(None), -1), (0, slice(None)))[abs(other) - 1]
        inside[second - 1][0][at] += mismatch
    return max(np.abs(r / np.sqrt(j)).max() for r, j in inside) / np.linalg.norm(flux), least, named


def main():
    program, failed = sys.argv[1], 0
    with tempfile.TemporaryDirectory() as folder:
        model = os.path.join(folder, "model.toml")
        with open(model, "w", encoding="utf-8") as file:
            file.write(MODEL)
        for order in (1, 2, 3, 4):
            path, abaqus = os.path.join(folder, "mesh.ism"), os.path.join(folder, "mesh.abq")
            for out in (path, abaqus):
                subprocess.run([program, "mesh", model, "-q", "-o", out, "--order", str(order)], check=True, capture_output=True)
            residual, least, named = residuals(path)
            good = agrees(path, abaqus) and residual < 1e-12 and least > 0 and set(named) == {"bottom_wall", "outflow", "top", "inflow", "cylinder"}
            print(f"order {order}: residual {residual:.1e}, least Jacobian {least:.2f}, {named}{'' if good else ': wrong'}")
            failed += not good
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
