#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures a mesh as other programs do: verdict.py MESH.msh prints means over the quads of a planar mesh.

The shape is the least 2 J / (a^2 + b^2) over the corners, with the cross product J of the sides a and b there. The aspect is the
longest side times the sum of the sides over four times the area [stimpson2007]. Angles are in degrees.
The measure libmesh_shape is MOOSE's shape: the harmonic mean over the corners, and a mean by area over the quads.
"""
import json
import math
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "studies"))
from interpolation_error import read_msh  # noqa: E402


def measure(corners):
    sides = [(b[0] - a[0], b[1] - a[1]) for a, b in zip(corners, corners[1:] + corners[:1])]
    length = [math.hypot(*side) for side in sides]
    cross = [sides[k - 1][0] * sides[k][1] - sides[k - 1][1] * sides[k][0] for k in range(4)]
    dot = [-sides[k - 1][0] * sides[k][0] - sides[k - 1][1] * sides[k][1] for k in range(4)]
    angles = [math.degrees(math.atan2(c, d)) % 360 for c, d in zip(cross, dot)]
    shapes = [2 * c / (length[k - 1] ** 2 + length[k] ** 2) for k, c in enumerate(cross)]
    area = sum(cross) / 4
    return (min(shapes), min(angles), max(angles), max(length) * sum(length) / (4 * area), area,
            area * 4 / sum(1 / s for s in shapes))


def main(path):
    points, elements = read_msh(path)
    quads = [measure([points[n] for n in nodes]) for nodes in elements if nodes[2] != nodes[3]]
    shape, least, largest, aspect, area, weighted = zip(*quads)
    n = len(quads)
    print(json.dumps({"shape_mean": sum(shape) / n, "shape_min": min(shape), "least_angle": sum(least) / n,
                      "largest_angle": sum(largest) / n, "aspect": sum(aspect) / n, "libmesh_shape": sum(weighted) / sum(area)}))


if __name__ == "__main__":
    main(sys.argv[1])
