#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of a solution on quads, as SVG: picture.py SOLUTION.json PICTURE.svg [TITLE]. Needs Python alone.

SOLUTION.json is a list of elements. Each is a list of its nodes [x, y, z, value] around the element. There are three or four
corners, or four corners and then the four middles of sides.
"""
import json
import os
import sys

COLOURS = [(68, 1, 84), (59, 82, 139), (33, 145, 140), (94, 201, 98), (253, 231, 37)]  # from small to large values
SIDE = 900.0  # of the picture, in pixels
RIGHT, UP, TOWARDS = (0.7071, 0.7071, 0.0), (-0.3536, 0.3536, 0.8660), (0.6124, -0.6124, 0.5)  # directions on paper of a surface in space


def colour(part):
    k = min(int(part * (len(COLOURS) - 1)), len(COLOURS) - 2)
    t = part * (len(COLOURS) - 1) - k
    return "#" + "".join(f"{round(a + t * (b - a)):02x}" for a, b in zip(COLOURS[k], COLOURS[k + 1]))


def mean(nodes, weights):
    return [sum(w * node[k] for w, node in zip(weights, nodes)) for k in range(4)]


def parts(element):
    """Returns four quads for each quad, around its center, so that curved quads are round and colors change less."""
    if len(element) == 3:
        return [element]
    corners = element[:4]
    middles = element[4:] or [mean([corners[k], corners[(k + 1) % 4]], [0.5, 0.5]) for k in range(4)]
    centre = mean(corners + middles, [-0.25] * 4 + [0.5] * 4)
    return [[corners[k], middles[k], centre, middles[k - 1]] for k in range(4)]


def outline(element):
    corners, middles = element[:4], element[4:]
    return [node for pair in zip(corners, middles) for node in pair] if middles else corners


def draw(elements, path, title=""):
    planar = all(node[2] == elements[0][0][2] for element in elements for node in element)

    def flat(node):
        x = node[:3]
        return (x[0], -x[1]) if planar else (sum(map(float.__mul__, x, RIGHT)), -sum(map(float.__mul__, x, UP)))

    def depth(nodes):
        return 0 if planar else sum(sum(map(float.__mul__, node[:3], TOWARDS)) for node in nodes) / len(nodes)

    elements = [[[float(x) for x in node] for node in element] for element in elements]
    places = [flat(node) for element in elements for node in element]
    values = [node[3] for element in elements for node in element]
    low, high = min(values), max(values)
    left, top = min(x for x, _ in places), min(y for _, y in places)
    width, height = max(x for x, _ in places) - left, max(y for _, y in places) - top
    scale = SIDE / max(width, height)

    def polygon(nodes, style):
        points = " ".join(f"{20 + (x - left) * scale:.1f},{50 + (y - top) * scale:.1f}" for x, y in map(flat, nodes))
        return f'<polygon points="{points}" {style}/>'

    shapes = []
    for element in sorted(elements, key=depth):
        for nodes in parts(element):
            value = sum(node[3] for node in nodes) / len(nodes)
            fill = colour((value - low) / (high - low) if high > low else 0.5)
            shapes.append(polygon(nodes, f'fill="{fill}" stroke="{fill}"'))
        shapes.append(polygon(outline(element), 'fill="none" stroke="black" stroke-opacity=".4"'))
    bottom = 70 + height * scale
    bar = [f'<rect x="{20 + 3 * k}" y="{bottom}" width="3.5" height="16" fill="{colour(k / 99)}"/>' for k in range(100)]
    text = [f'<text x="20" y="30" font-size="20">{title}</text>', f'<text x="20" y="{bottom + 36}">{low:.4g}</text>',
            f'<text x="320" y="{bottom + 36}" text-anchor="end">{high:.4g}</text>']
    with open(path, "w", encoding="utf-8") as file:
        file.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{max(360, width * scale + 40):.0f}" height="{bottom + 50:.0f}" '
                   'font-family="sans-serif" font-size="14" stroke-width=".5"><rect width="100%" height="100%" fill="white"/>\n'
                   + "\n".join([*shapes, '<g stroke="none">', *bar, *text, "</g></svg>", ""]))
    print(f"the picture is {os.path.abspath(path)}")


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as solution:
        draw(json.load(solution), *sys.argv[2:])
