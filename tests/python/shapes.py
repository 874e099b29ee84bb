"""Models that the tests share."""

import numpy as np

import delquad

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


def square():
    return delquad.polygons([SQUARE])


def octahedron():
    """Points and triangles of a closed surface."""
    points = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], dtype=float)
    triangles = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    return points, np.array(triangles)


def area(mesh):
    """Of the quads, by their diagonals."""
    a, b, c, d = (mesh.points[mesh.quads[:, k]] for k in range(4))
    return np.linalg.norm(np.cross(c - a, d - b), axis=1).sum() / 2
