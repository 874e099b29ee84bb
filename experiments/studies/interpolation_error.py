#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the error of interpolation: interpolation_error.py MESH.msh SOLUTION prints {"l2": ..., "h1": ...}.

SOLUTION is a name below, with any text behind an underscore, or a formula of x and y. Its values at the nodes are interpolated
bilinearly on quads, linearly on triangles. Both errors are norms over the mesh by 5 x 5 Gauss points for each quad. The H1 error
is the error of the gradient alone.
"""
import json
import math
import sys

GAUSS = ((-0.9061798459386640, 0.2369268850561891), (-0.5384693101056831, 0.4786286704993665), (0.0, 0.5688888888888889),
         (0.5384693101056831, 0.4786286704993665), (0.9061798459386640, 0.2369268850561891))
SOLUTIONS = {
    "shock": "tanh(50*(x^2+y^2-0.5))",
    "mmg": "tanh(10*(sin(5*y)-2*x))+x^2*y+y^3",
    "thin": "tanh(500*(x^2+y^2-0.5))",
    "s-shock": "0.75*tanh(4*sin(10*y-5)-24*x+12)",
    "layers": "(x+(exp(x/0.005)-1)/(1-exp(1/0.005)))*(y+(exp(y/0.005)-1)/(1-exp(1/0.005)))",
}
STEP = 1e-6  # of the central differences of the exact gradient


def read_msh(path):
    """Returns the points and the planar elements of a text MSH file, version 2.2 or 4.1."""
    tokens = iter(open(path).read().split())
    points, elements, version = {}, [], ""
    for token in tokens:
        if token == "$MeshFormat":
            version = next(tokens)
        elif token == "$Nodes" and version.startswith("2"):
            for _ in range(int(next(tokens))):
                tag = int(next(tokens))
                points[tag] = (float(next(tokens)), float(next(tokens)))
                next(tokens)
        elif token == "$Nodes":
            blocks = int(next(tokens))
            for _ in range(3):
                next(tokens)
            for _ in range(blocks):
                for _ in range(3):
                    next(tokens)
                tags = [int(next(tokens)) for _ in range(int(next(tokens)))]
                for tag in tags:
                    points[tag] = (float(next(tokens)), float(next(tokens)))
                    next(tokens)
        elif token == "$Elements" and version.startswith("2"):
            for _ in range(int(next(tokens))):
                next(tokens)
                kind, n_tags = int(next(tokens)), int(next(tokens))
                for _ in range(n_tags):
                    next(tokens)
                add_element(kind, tokens, elements)
        elif token == "$Elements":
            blocks = int(next(tokens))
            for _ in range(3):
                next(tokens)
            for _ in range(blocks):
                next(tokens), next(tokens)
                kind = int(next(tokens))
                for _ in range(int(next(tokens))):
                    next(tokens)
                    add_element(kind, tokens, elements)
    return points, elements


def add_element(kind, tokens, elements):
    n = {15: 1, 1: 2, 2: 3, 3: 4}.get(kind)
    if n is None:
        sys.exit(f"elements of type {kind}: expected points, lines, triangles and quads")
    nodes = [int(next(tokens)) for _ in range(n)]
    if n == 3:
        nodes.append(nodes[2])  # a quad with a side without length
    if n > 2:
        elements.append(nodes)


def main(path, solution):
    formula = SOLUTIONS.get(solution.split("_")[0], solution)
    u = eval("lambda x, y: " + formula.replace("^", "**"), vars(math).copy())  # the experiment's own
    points, elements = read_msh(path)
    value = {tag: u(*p) for tag, p in points.items()}
    l2 = h1 = 0.0
    for nodes in elements:
        (xa, ya), (xb, yb), (xc, yc), (xd, yd) = (points[n] for n in nodes)
        ua, ub, uc, ud = (value[n] for n in nodes)
        for r, wr in GAUSS:
            for s, ws in GAUSS:
                a, b, c, d = (1 - r) * (1 - s) / 4, (1 + r) * (1 - s) / 4, (1 + r) * (1 + s) / 4, (1 - r) * (1 + s) / 4
                ar, br, cr, dr = -(1 - s) / 4, (1 - s) / 4, (1 + s) / 4, -(1 + s) / 4
                as_, bs, cs, ds = -(1 - r) / 4, -(1 + r) / 4, (1 + r) / 4, (1 - r) / 4
                x, y = a * xa + b * xb + c * xc + d * xd, a * ya + b * yb + c * yc + d * yd
                xr, xs = ar * xa + br * xb + cr * xc + dr * xd, as_ * xa + bs * xb + cs * xc + ds * xd
                yr, ys = ar * ya + br * yb + cr * yc + dr * yd, as_ * ya + bs * yb + cs * yc + ds * yd
                ur, us = ar * ua + br * ub + cr * uc + dr * ud, as_ * ua + bs * ub + cs * uc + ds * ud
                det = xr * ys - xs * yr
                weight = wr * ws * abs(det)
                l2 += weight * (a * ua + b * ub + c * uc + d * ud - u(x, y)) ** 2
                if det == 0:
                    continue
                gx, gy = (ur * ys - us * yr) / det, (us * xr - ur * xs) / det
                ex = (u(x + STEP, y) - u(x - STEP, y)) / (2 * STEP)
                ey = (u(x, y + STEP) - u(x, y - STEP)) / (2 * STEP)
                h1 += weight * ((gx - ex) ** 2 + (gy - ey) ** 2)
    n = len({node for nodes in elements for node in nodes})
    print(json.dumps({"l2": math.sqrt(l2), "h1": math.sqrt(h1), "l2_constant": math.sqrt(l2) * n,
                      "h1_constant": h1 * n}))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
