#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the cells of a volume behind a plane, as SVG: cut_picture.py MESH.msh2 OUT.svg NX,NY,NZ,D keeps cells whose middle x has n.x < D. Hexahedra are blue, pyramids orange, tetrahedra gray."""

import math
import sys
from pathlib import Path

from volumes import CELLS, read_msh

COLORS = {4: (225, 225, 220), 5: (86, 180, 233), 6: (0, 158, 115), 7: (230, 159, 0)}
WIDTH, MARGIN = 640, 4
RIGHT, UP = (math.sqrt(0.5), -math.sqrt(0.5), 0), (0.35, 0.35, math.sqrt(1 - 2 * 0.35 ** 2))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def main():
    mesh, out, plane = sys.argv[1:]
    *normal, limit = map(float, plane.split(","))
    points, elements = read_msh(Path(mesh))
    sides = {}
    for kind, nodes in elements:
        if kind in CELLS and dot(normal, [sum(points[v][k] for v in nodes) / len(nodes) for k in range(3)]) < limit:
            for part in CELLS[kind][1].split():
                side = [nodes[int(k)] for k in part]
                sides.setdefault(frozenset(side), []).append((kind, side))
    toward, drawn = cross(RIGHT, UP), []
    for kind, side in (of[0] for of in sides.values() if len(of) == 1):
        x = [points[v] for v in side]
        n = cross([b - a for a, b in zip(x[0], x[2])], [b - a for a, b in zip(x[1], x[-1])])
        light = dot(n, toward) / max(math.hypot(*n), 1e-300)
        if light > 0:
            color = "".join(f"{round(c * (0.55 + 0.45 * light)):02x}" for c in COLORS[kind])
            drawn.append((sum(dot(p, toward) for p in x) / len(x), [(dot(p, RIGHT), -dot(p, UP)) for p in x], color))
    flat = [p for _, corners, _ in drawn for p in corners]
    low = [min(p[k] for p in flat) for k in range(2)]
    scale = (WIDTH - 2 * MARGIN) / max(p[0] - low[0] for p in flat)
    height = math.ceil(scale * max(p[1] - low[1] for p in flat)) + 2 * MARGIN
    with open(out, "w", encoding="utf-8") as file:
        file.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}"><g stroke="#333" stroke-width=".4" stroke-linejoin="round">\n')
        for _, corners, color in sorted(drawn):
            places = " ".join(f"{MARGIN + scale * (x - low[0]):.1f} {MARGIN + scale * (y - low[1]):.1f}" for x, y in corners)
            file.write(f'<path d="M{places}z" fill="#{color}"/>\n')
        file.write("</g></svg>\n")


if __name__ == "__main__":
    main()
