#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes solver_reference.inc: what a dense solver, made apart from the project's, says of one small mesh.

Usage: make_solver_reference.py > solver_reference.inc. Needs numpy. Moments of the domain come from its outline, matrices are dense,
eigenvalues LAPACK's, and triangles have formulas of their own.
"""
import numpy as np

NX, NY = 5, 4
GAUSS2 = ([-(1 / 3) ** 0.5, (1 / 3) ** 0.5], [1, 1])
GAUSS3 = ([-(0.6**0.5), 0, 0.6**0.5], [5 / 9, 8 / 9, 5 / 9])


def mesh():
    """A skewed grid on [0, 2] x [0, 1], its inner nodes moved; the first cell is two triangles. As in test_solve.cpp."""
    points = []
    for j in range(NY + 1):
        for i in range(NX + 1):
            x, y = 2 * i / NX, j / NY
            bump = np.sin(np.pi * i / NX) * np.sin(np.pi * j / NY)
            points.append((x + 0.1 * bump * np.sin(5 * x + 3 * y), y + 0.1 * bump * np.cos(4 * x - y)))
    cells = [(j * (NX + 1) + i, j * (NX + 1) + i + 1, (j + 1) * (NX + 1) + i + 1, (j + 1) * (NX + 1) + i)
             for j in range(NY) for i in range(NX)]
    a, b, c, d = cells[0]
    return np.array(points), [(a, b, c), (a, c, d)] + cells[1:]


def outline_frame():
    """Center and radius of gyration of the rectangle."""
    return np.array([1, 0.5]), np.sqrt((2**2 + 1**2) / 12)


def shapes(corners, r, s):
    """Values, gradients and density of the bilinear map at (r, s)."""
    values = np.array([(1 - r) * (1 - s), (1 + r) * (1 - s), (1 + r) * (1 + s), (1 - r) * (1 + s)]) / 4
    local = np.array([[s - 1, 1 - s, 1 + s, -1 - s], [r - 1, -1 - r, 1 + r, 1 - r]]) / 4
    jacobian = local @ corners
    return values, np.linalg.solve(jacobian, local), np.linalg.det(jacobian)


def rule(corners, n):
    """Points of the element: weight, place, values, gradients. Triangles: the square's rule, collapsed."""
    at, weights = GAUSS2 if n == 2 else GAUSS3
    if len(corners) == 4:
        for s, v in zip(at, weights):
            for r, w in zip(at, weights):
                values, gradients, density = shapes(corners, r, s)
                yield v * w * density, values @ corners, values, gradients
        return
    a, b, c = corners
    two_area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    turned = [(c - b), (a - c), (b - a)]
    gradients = np.array([[-t[1] for t in turned], [t[0] for t in turned]]) / two_area
    for s, v in zip(at, weights):
        for r, w in zip(at, weights):
            third = (1 + s) / 2
            second = (1 + r) / 2 * (1 - third)
            values = np.array([1 - second - third, second, third])
            yield v * w * two_area * (1 - third) / 4, values @ corners, values, gradients


def poisson_exact(x):
    centre, radius = outline_frame()
    p = (x - centre) / radius
    d = p @ p
    return np.array([np.sin(np.pi / 2 * d)]), np.array([np.pi * np.cos(np.pi / 2 * d) * p / radius])


def elastic_exact(x):
    """Its gradient by complex steps."""
    centre, radius = outline_frame()

    def u(x):
        p = (x - centre) / radius
        d = p[0] ** 2 + p[1] ** 2
        f, g = np.sin(np.pi / 2 * d), np.cos(np.pi / 2 * d)
        return radius * np.array([f * p[0] - g * p[1], f * p[1] + g * p[0]])

    step = 1e-30
    columns = [u(x + 1j * step * e).imag / step for e in np.eye(2)]
    return u(x), np.array(columns).T


def poisson_flux(g):
    return g


def stress(g):
    """By the matrix of plane stress in Voigt's notation: E = 1, nu = 0.3."""
    nu = 0.3
    matrix = np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]]) / (1 - nu**2)
    xx, yy, xy = matrix @ np.array([g[0, 0], g[1, 1], g[0, 1] + g[1, 0]])
    return np.array([[xx, xy], [xy, yy]])


def preconditioned_cg(matrix, right, scale):
    x, residual, steps = np.zeros_like(right), right.copy(), 0
    inverse = 1 / scale
    direction = inverse * residual
    rho = residual @ direction
    while np.linalg.norm(residual) > 1e-8 * np.linalg.norm(right):
        image = matrix @ direction
        alpha = rho / (direction @ image)
        x += alpha * direction
        residual -= alpha * image
        old, rho = rho, residual @ (inverse * residual)
        direction = inverse * residual + rho / old * direction
        steps += 1
    return steps


def solve(components, exact, flux):
    points, elements = mesh()
    n = components * len(points)
    matrix, load = np.zeros((n, n)), np.zeros(n)
    for element in elements:
        for weight, at, _, gradients in rule(points[list(element)], 2):
            wanted = flux(exact(at)[1])
            for i, node in enumerate(element):
                load[components * node : components * (node + 1)] += weight * wanted @ gradients[:, i]
                for j, other in enumerate(element):
                    for b in range(components):
                        unit = np.zeros((components, 2))
                        unit[b] = gradients[:, j]
                        column = weight * flux(unit) @ gradients[:, i]
                        matrix[components * node : components * (node + 1), components * other + b] += column
    grid = [(k % (NX + 1), k // (NX + 1)) for k in range(len(points))]
    inner = [k for k, (i, j) in enumerate(grid) if 0 < i < NX and 0 < j < NY]
    free = np.array([components * k + c for k in inner for c in range(components)])
    fixed = np.setdiff1d(np.arange(n), free)
    u = np.concatenate([exact(p)[0] for p in points])
    right = load[free] - matrix[np.ix_(free, fixed)] @ u[fixed]
    inside = matrix[np.ix_(free, free)]
    u[free] = np.linalg.solve(inside, right)
    off = whole = steep_off = steep = 0
    for element in elements:
        ours = u.reshape(-1, components)[list(element)]
        for weight, at, values, gradients in rule(points[list(element)], 3):
            value, gradient = exact(at)
            off += weight * np.sum((value - values @ ours) ** 2)
            whole += weight * np.sum(value**2)
            steep_off += weight * np.sum((gradient - (gradients @ ours).T) ** 2)
            steep += weight * np.sum(gradient**2)
    scale = np.repeat(np.diag(inside).reshape(-1, components).mean(axis=1), components)
    root = np.sqrt(scale)
    eigenvalues = np.linalg.eigvalsh(inside / np.outer(root, root))
    return [np.sqrt(off / whole), np.sqrt(steep_off / steep), eigenvalues[-1] / eigenvalues[0],
            preconditioned_cg(inside, right, scale)]


def main():
    print("// Made by make_solver_reference.py: L2, H1, condition, iterations.")
    for name, result in [("Poisson", solve(1, poisson_exact, poisson_flux)), ("Elasticity", solve(2, elastic_exact, stress))]:
        print(f"constexpr double k{name}[] = {{{', '.join(f'{x:.17g}' for x in result)}}};")


if __name__ == "__main__":
    main()
