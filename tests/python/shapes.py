# SPDX-License-Identifier: GPL-3.0-or-later
"""Models that the tests share."""

import importlib

import numpy as np
import pytest

import delquad

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


def needed(name):
    """The module; the test is skipped where it is missing, or lacks a library or another module."""
    try:
        return importlib.import_module(name)
    except (ImportError, OSError) as error:
        pytest.skip(f"{name} cannot be imported: {error}", allow_module_level=True)


def square():
    return delquad.polygons([SQUARE])


def octahedron():
    """Points and triangles of a closed surface."""
    points = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)], dtype=float)
    triangles = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    return points, np.array(triangles)


def prism():
    """Points, triangles and their regions, of which 0 and 1 are the square ends z = 0 and 2."""
    points = np.array([(x, y, z) for z in (0, 2) for x, y in SQUARE], dtype=float)
    triangles = [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7)]
    for i in range(4):
        j = (i + 1) % 4
        triangles += [(i, j, j + 4), (i, j + 4, i + 4)]
    return points, np.array(triangles), np.array([0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5])


def area(mesh):
    """Sizes of the quads, by their diagonals."""
    a, b, c, d = (mesh.points[mesh.quads[:, k]] for k in range(4))
    return np.linalg.norm(np.cross(c - a, d - b), axis=1).sum() / 2
