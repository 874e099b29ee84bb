#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes random sets of embedded lines and points, cracks, and adjacent regions, and checks each mesh by independent code.

    python3 benchmarks/random_lines.py --kinds square cracks regions sphere part --sets 100 --sizes .05 .02 .01

* square: 5 to 60 segments and points in the unit square. They cross, or end on each other, on the square's sides or in one point. Separate features keep
  a tenth of the size apart, and lines that meet have an angle of at least 10 degrees (--least-angle).
* cracks: 5 to 30 such features; every third segment is a crack.
* regions: the unit square cut into 2 to 30 polygons, by slanted cuts that end on each other, or by cells of random points.
* sphere: 3 to 20 lines and points on the unit sphere, with 4 times the given sizes.
* part: the same on the CAD model *pump_carter* of --data, with 80 times the given sizes.

The same seeds make the same sets on any machine. Each kind and size has a line:

* sound: exit code 0, and a passed check. There are only quads, with corners that turn the right way by exact arithmetic. Every edge has two quads or is on
  the outline, and areas are the model's to 1e-12.
* paths: edges cover all segments, all points are nodes (planar: to 1e-9; surfaces: named lines), and cracks are open except at tips.
* refused: exit code 2. Reasons, and all failures, are listed below the table.
* eta: mean over the sets, for the mesh, for one without lines, and for a disc of equal area. "away" is over quads without line or point. "bound" is
  possible if corners between lines and the fewest irregular vertices are the only loss.
* time: processor seconds from model to mesh on one thread, over seconds without lines: mean and largest; "by disc" is over seconds of the disc.
"""

import argparse
import collections
import json
import math
import random
import re
import subprocess
import sys
import tempfile
from fractions import Fraction
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NEAR = 1e-9
KINDS = ["square", "cracks", "regions", "sphere", "part"]
SQUARE = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]


# Planes


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def along(a, b, t):
    return tuple(x + t * (y - x) for x, y in zip(a, b))


def turn(a, b, c):
    """Returns twice the area of a triangle; its sign is exact."""
    left, right = (b[0] - a[0]) * (c[1] - a[1]), (b[1] - a[1]) * (c[0] - a[0])
    if abs(left - right) > 1e-15 * (abs(left) + abs(right)):
        return left - right
    ax, ay, bx, by, cx, cy = map(Fraction, (*a, *b, *c))
    exact = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (exact > 0) - (exact < 0)


def foot(p, a, b):
    """Returns the parameter of the nearest place on a segment, and its distance."""
    d = minus(b, a)
    t = min(1.0, max(0.0, dot(minus(p, a), d) / dot(d, d)))
    return t, math.dist(p, along(a, b, t))


def crossing(a, b, c, d):
    """Returns the point where the insides of two segments cross, if they do."""
    ta, tb, tc, td = turn(c, d, a), turn(c, d, b), turn(a, b, c), turn(a, b, d)
    return along(a, b, ta / (ta - tb)) if ta * tb < 0 and tc * td < 0 else None


def angle_between(u, v):
    return math.atan2(abs(u[0] * v[1] - u[1] * v[0]), dot(u, v))


class Drawing:
    """Segments and points in the unit square that keep apart unless they meet."""

    def __init__(self, apart, least_angle):
        self.apart, self.least_angle = apart, least_angle
        self.segments = list(zip(SQUARE, SQUARE[1:] + SQUARE[:1]))
        self.nodes = list(SQUARE)  # ends, points, crossings

    def add(self, a, b):
        """Returns whether there was space."""
        nodes = [] if a == b else self.new_nodes(a, b)
        if nodes is None:
            return False
        nodes += [a, b] if a != b else [a]
        fresh = [p for p in nodes if all(math.dist(p, q) > 1e-12 for q in self.nodes)]
        for i, p in enumerate(fresh):
            if any(math.dist(p, q) < self.apart for q in self.nodes + fresh[:i]):
                return False
            if any(1e-12 < foot(p, *s)[1] < self.apart for s in self.segments):
                return False
        if a != b:
            if any(1e-12 < foot(q, a, b)[1] < self.apart for q in self.nodes):
                return False
            if any(min(angle_between(minus(b, a), minus(d, c)), angle_between(minus(b, a), minus(c, d))) < self.least_angle
                   for c, d in self.segments if self.meet((a, b), (c, d))):
                return False
            self.segments.append((a, b))
        elif not fresh or any(foot(a, *s)[1] < self.apart for s in self.segments):
            return False
        self.nodes += fresh
        return True

    def new_nodes(self, a, b):
        """Returns the crossings with the other segments."""
        if not all(0 <= x <= 1 for x in (*a, *b)):
            return None
        return [x for s in self.segments for x in [crossing(a, b, *s)]
                if x and all(math.dist(x, e) > 1e-12 for e in (a, b, *s))]

    @staticmethod
    def meet(s, r):
        return crossing(*s, *r) or any(foot(p, *r)[1] < 1e-12 for p in s) or any(foot(p, *s)[1] < 1e-12 for p in r)


def draw(rng, size, least_angle, least, most):
    """Returns segments (pairs of distinct points) and points (pairs of equal ones)."""
    drawing, features = Drawing(size / 10, least_angle), []
    wanted = rng.randint(least, most)
    for _ in range(200 * wanted):
        if len(features) == wanted:
            break

        def place():
            kind = rng.random()
            inner = drawing.segments[4:]
            if kind < 0.15 and inner:
                return along(*rng.choice(inner), rng.random())
            if kind < 0.22 and inner:
                return rng.choice(rng.choice(inner))
            if kind < 0.27:
                side = rng.randrange(4)
                x = rng.random()
                return [(x, 0.0), (1.0, x), (x, 1.0), (0.0, x)][side]
            return rng.random(), rng.random()

        if rng.random() < 0.2:
            a = b = (rng.random(), rng.random())
        else:
            a, b = place(), place()
            length = rng.uniform(0.02, 0.5)
            if rng.random() < 0.7:  # else its length stays
                direction = rng.uniform(0, 2 * math.pi)
                b = (a[0] + length * math.cos(direction), a[1] + length * math.sin(direction))
            if math.dist(a, b) < size / 10:
                continue
        if drawing.add(a, b):
            features.append((a, b))
    return features


def clip(polygon, p, normal):
    """Returns the part of a convex polygon beyond a line through p."""
    result = []
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        ha, hb = dot(minus(a, p), normal), dot(minus(b, p), normal)
        if ha >= 0:
            result.append(a)
        if ha * hb < 0:
            result.append(along(a, b, ha / (ha - hb)))
    return result


def area(polygon):
    return math.fsum(a[0] * b[1] - a[1] * b[0] for a, b in zip(polygon, polygon[1:] + polygon[:1])) / 2


def has_room(polygons, apart, least_angle):
    """Returns whether corners keep apart from each other and from other sides."""
    corners = [c for p in polygons for c in p]
    for p in polygons:
        for a, b, c in zip(p, p[1:] + p[:1], p[2:] + p[:2]):
            if math.dist(a, b) < apart or angle_between(minus(a, b), minus(c, b)) < least_angle:
                return False
            if any(1e-9 < math.dist(q, a) < apart or 1e-9 < foot(q, a, b)[1] < apart for q in corners):
                return False
    return True


def cut_square(rng, size, least_angle):
    """Returns 2 to 30 convex polygons."""
    wanted = rng.randint(2, 30)
    by_cuts = rng.random() < 0.5
    while True:
        polygons = [SQUARE]
        if by_cuts:
            for _ in range(50 * wanted):
                if len(polygons) == wanted:
                    break
                largest = max(range(len(polygons)), key=lambda i: area(polygons[i]) * rng.uniform(0.3, 1))
                polygon = polygons[largest]
                weights = [rng.random() for _ in polygon]
                p = tuple(dot(weights, x) / sum(weights) for x in zip(*polygon))
                direction = rng.uniform(0, 2 * math.pi)
                normal = math.cos(direction), math.sin(direction)
                parts = [clip(polygon, p, normal), clip(polygon, p, (-normal[0], -normal[1]))]
                trial = polygons[:largest] + parts + polygons[largest + 1:]
                if has_room(trial, size / 10, least_angle):
                    polygons = trial
        else:
            seeds = [(rng.random(), rng.random()) for _ in range(wanted)]
            polygons = []
            for a in seeds:
                cell = SQUARE
                for b in seeds:
                    if b != a:
                        cell = clip(cell, along(a, b, 0.5), minus(a, b))
                polygons.append(cell)
        if has_room(polygons, size / 10, least_angle):
            return polygons


# Models


def toml_square(features, is_crack):
    rows = []
    for k, (a, b) in enumerate(features):
        if a == b:
            rows.append(f'  {{ point = [{a[0]!r}, {a[1]!r}], name = "f{k}" }},')
        else:
            crack = ", crack = true" if is_crack(k) else ""
            rows.append(f'  {{ segment = [[{a[0]!r}, {a[1]!r}], [{b[0]!r}, {b[1]!r}]], name = "f{k}"{crack} }},')
    embed = "embed = [\n" + "\n".join(rows) + "\n]\n" if rows else ""
    return embed + "[[loop]]\nrectangle = [[0, 0], [1, 1]]\n"


def toml_regions(polygons):
    return "".join(f'[[loop]]\npolygon = [{", ".join(f"[{x!r}, {y!r}]" for x, y in p)}]\nregion = "r{k}"\n'
                   for k, p in enumerate(polygons))


def toml_surface(model, features):
    rows = [f'  {{ point = {list(f[0])}, name = "f{k}" }},' if len(f) == 1 else
            f'  {{ polyline = {[list(x) for x in f]}, name = "f{k}" }},' for k, f in enumerate(features)]
    return f'model = "{model}"\n' + ("embed = [\n" + "\n".join(rows) + "\n]\n" if rows else "")


def write_sphere(path, steps=5):
    """Returns the divided triangles of an icosahedron."""
    g = (1 + math.sqrt(5)) / 2
    points = [tuple(x / math.hypot(1, g) for x in p) for p in
              [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
                 (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(steps):
        middle, parts = {}, []

        def between(a, b):
            key = min(a, b), max(a, b)
            if key not in middle:
                x = along(points[a], points[b], 0.5)
                middle[key] = len(points)
                points.append(tuple(c / math.hypot(*x) for c in x))
            return middle[key]

        for a, b, c in triangles:
            ab, bc, ca = between(a, b), between(b, c), between(c, a)
            parts += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = parts
    path.write_text(f"OFF\n{len(points)} {len(triangles)} 0\n" + "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in points) +
                    "".join(f"3 {a} {b} {c}\n" for a, b, c in triangles))


def lines_on_sphere(rng):
    def at():
        while True:
            x = [rng.gauss(0, 1) for _ in range(3)]
            if math.hypot(*x) > 0.1:
                return tuple(c / math.hypot(*x) for c in x)

    features = []
    for _ in range(rng.randint(3, 20)):
        a, b = at(), at()
        b = along(a, b, rng.uniform(0.05, 0.6))
        b = tuple(c / math.hypot(*b) for c in b)
        features.append((a,) if rng.random() < 0.25 else (a, b))
    return features


def lines_on_part(rng, plain, reach):
    """Returns features between nodes inside a face of the mesh without lines."""
    on_line = {v for line in plain.lines for v in line[0]}
    inner = sorted({(v, region) for quad, region in zip(plain.quads, plain.regions) for v in quad if v not in on_line})
    features = []
    for _ in range(rng.randint(3, 20)):
        v, region = rng.choice(inner)
        a = plain.points[v]
        others = [w for w, r in inner if r == region and 0 < math.dist(plain.points[w], a) < reach]
        features.append((a,) if rng.random() < 0.25 or not others else (a, plain.points[rng.choice(others)]))
    return features


# Meshes


class MshFile:
    """Reads points, quads and lines of a file in Gmsh's format 4.1, by physical names."""

    def __init__(self, path):
        text = path.read_text().split("\n")
        at = {line: i for i, line in enumerate(text) if line.startswith("$")}
        names = {}
        if "$PhysicalNames" in at:
            i = at["$PhysicalNames"] + 1
            for row in text[i + 1:i + 1 + int(text[i])]:
                dim, tag, name = row.split(" ", 2)
                names[int(dim), int(tag)] = name.strip('"')
        i = at["$Entities"] + 1
        counts = [int(x) for x in text[i].split()]
        group = {}
        i += 1
        for dim, count in enumerate(counts):
            for row in text[i:i + count]:
                words = row.split()
                first = 4 if dim == 0 else 7
                groups = int(words[first])
                if groups:
                    group[dim, int(words[0])] = names.get((dim, int(words[first + 1])), "")
            i += count
        self.points, tags = [], {}
        i = at["$Nodes"] + 1
        blocks = int(text[i].split()[0])
        i += 1
        for _ in range(blocks):
            count = int(text[i].split()[3])
            for row, place in zip(text[i + 1:i + 1 + count], text[i + 1 + count:i + 1 + 2 * count]):
                tags[int(row)] = len(self.points)
                self.points.append(tuple(float(x) for x in place.split()[:3]))
            i += 1 + 2 * count
        self.quads, self.regions, self.lines, self.triangles, self.named = [], [], [], 0, []
        i = at["$Elements"] + 1
        blocks = int(text[i].split()[0])
        i += 1
        for _ in range(blocks):
            dim, entity, kind, count = (int(x) for x in text[i].split())
            name = group.get((dim, entity), "")
            for row in text[i + 1:i + 1 + count]:
                element = tuple(tags[int(x)] for x in row.split()[1:])
                if kind == 3:
                    self.quads.append(element)
                    self.regions.append(name)
                elif kind == 1:
                    self.lines.append((element, name))
                elif kind == 15:
                    self.named.append((element[0], name))
                else:
                    self.triangles += 1
            i += 1 + count
        self.flat = [p[:2] for p in self.points]


def eta(corners):
    worst = 0
    for k in range(4):
        u, v = minus(corners[k - 1], corners[k]), minus(corners[(k + 1) % 4], corners[k])
        cosine = dot(u, v) / math.sqrt(dot(u, u) * dot(v, v))
        worst = max(worst, abs(math.pi / 2 - math.acos(max(-1, min(1, cosine)))))
    return max(0, 1 - 2 / math.pi * worst)


def sides_of(mesh):
    """Returns the quads at each edge; None if an edge runs the same way in two quads."""
    seen, sides = set(), collections.defaultdict(list)
    for q, quad in enumerate(mesh.quads):
        for k in range(4):
            a, b = quad[k - 1], quad[k]
            if (a, b) in seen:
                return None
            seen.add((a, b))
            sides[min(a, b), max(a, b)].append(q)
    return sides


def unsound_plane(mesh, areas):
    """Returns the defect of a mesh, or None; `areas` are by region."""
    if mesh.triangles:
        return "triangles"
    p = mesh.flat
    for quad in mesh.quads:
        if any(turn(p[quad[k - 2]], p[quad[k - 1]], p[quad[k]]) <= 0 for k in range(4)):
            return f"a quad is inverted or reflex at {p[quad[0]]}"
    if sides_of(mesh) is None:
        return "an edge has two quads on one side"
    measured = collections.defaultdict(list)
    for quad, region in zip(mesh.quads, mesh.regions):
        a, b, c, d = (p[v] for v in quad)
        measured[region if len(areas) > 1 else ""].append(((c[0] - a[0]) * (d[1] - b[1]) - (c[1] - a[1]) * (d[0] - b[0])) / 2)
    for region, wanted in areas.items():
        if abs(math.fsum(measured[region]) - wanted) > 1e-12:
            return f"area of region '{region}' is {math.fsum(measured[region])!r} for {wanted!r}"
    return None


def open_edges(mesh):
    return [edge for edge, quads in sides_of(mesh).items() if len(quads) == 1]


def is_on_outline(a, b):
    return any(all(abs(x[k] - side) <= NEAR for x in (a, b)) for k in (0, 1) for side in (0, 1))


def nodes_on(mesh, a, b):
    """Returns the nodes on a segment in order, grouped by place."""
    lows, highs = [min(x) - NEAR for x in zip(a, b)], [max(x) + NEAR for x in zip(a, b)]
    found = [(foot(p, a, b)[0], v) for v, p in enumerate(mesh.flat)
             if lows[0] <= p[0] <= highs[0] and lows[1] <= p[1] <= highs[1] and foot(p, a, b)[1] <= NEAR]
    places, last = [], None
    for t, v in sorted(found):
        if last is None or math.dist(mesh.flat[v], mesh.flat[last]) > NEAR:
            places.append([])
        places[-1].append(v)
        last = v
    return places


def missing_in_plane(mesh, features, is_crack):
    """Returns the first feature that is no path of edges or no node."""
    sides = sides_of(mesh)
    on_crack = set()
    for k, (a, b) in enumerate(features):
        if a == b:
            if not any(math.dist(p, a) <= NEAR for p in mesh.flat):
                return f"point f{k} is no node"
            continue
        places = nodes_on(mesh, a, b)
        if len(places) < 2 or any(math.dist(mesh.flat[places[i][0]], x) > NEAR for i, x in ((0, a), (-1, b))):
            return f"an end of f{k} is no node"
        for left, right in zip(places, places[1:]):
            edges = [sides[min(v, w), max(v, w)] for v in left for w in right if (min(v, w), max(v, w)) in sides]
            if sum(map(len, edges)) != (1 if is_on_outline(a, b) else 2):
                return f"f{k} is no path of edges between {mesh.flat[left[0]]} and {mesh.flat[right[0]]}"
            if is_crack(k):
                on_crack.add(tuple(sorted((mesh.flat[left[0]], mesh.flat[right[0]]))))
                if len(edges) != 2:
                    return f"crack f{k} is not open"
    for a, b in open_edges(mesh):
        p, q = mesh.flat[a], mesh.flat[b]
        if not is_on_outline(p, q) and tuple(sorted((p, q))) not in on_crack:
            return f"the mesh is open between {p} and {q}"
    return None


def unsound_surface(mesh, n_open):
    if mesh.triangles:
        return "triangles"
    sides = sides_of(mesh)
    if sides is None:
        return "an edge has two quads on one side"
    if sum(len(quads) == 1 for quads in sides.values()) != n_open:
        return "open edges"
    for quad in mesh.quads:
        x = [mesh.points[v] for v in quad]
        normals = []
        for k in range(4):
            u, v = minus(x[(k + 1) % 4], x[k]), minus(x[k - 1], x[k])
            normals.append((u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]))
        mean = tuple(map(sum, zip(*normals)))
        if any(dot(n, mean) <= 0 for n in normals):
            return f"a quad is inverted or reflex at {x[0]}"
    return None


def missing_on_surface(mesh, features, near, is_round):
    sides = sides_of(mesh)
    lines = collections.defaultdict(list)
    for line, name in mesh.lines:
        lines[name].append(line)
    for k, feature in enumerate(features):
        if len(feature) == 1:
            if not any(math.dist(mesh.points[v], feature[0]) <= near for v, name in mesh.named if name == f"f{k}"):
                return f"point f{k} is no node"
            continue
        uses = collections.Counter(v for line in lines[f"f{k}"] for v in line)
        ends = [v for v, n in uses.items() if n == 1]
        if len(ends) != 2 or any(n > 2 for n in uses.values()) or len(uses) != len(lines[f"f{k}"]) + 1:
            return f"f{k} is no path of lines"
        if any(min(math.dist(mesh.points[v], x) for v in ends) > near for x in feature):
            return f"f{k} does not end where it should"
        if any((min(line), max(line)) not in sides for line in lines[f"f{k}"]):
            return f"a line of f{k} is no edge"
        if is_round:
            a, b = feature
            normal = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
            if any(abs(dot(mesh.points[v], normal)) > near * math.hypot(*normal) for v in uses):
                return f"f{k} leaves its great circle"
    return None


def eta_away(mesh, features):
    """Returns the mean eta of quads without a node on a feature."""
    near = {v for a, b in features if a != b for place in nodes_on(mesh, a, b) for v in place}
    near |= {v for a, b in features if a == b for v, p in enumerate(mesh.flat) if math.dist(p, a) <= NEAR}
    away = [eta([mesh.flat[v] for v in quad]) for quad in mesh.quads if near.isdisjoint(quad)]
    return sum(away) / len(away) if away else math.nan


class PlanarMap:
    """Faces of the square between segments."""

    def __init__(self, segments):
        segments = segments + list(zip(SQUARE, SQUARE[1:] + SQUARE[:1]))
        places = [x for s in segments for x in s]
        places += [x for i, s in enumerate(segments) for r in segments[:i] for x in [crossing(*s, *r)] if x]
        self.at, number = [], {}
        for x in places:
            key = tuple(round(c, 9) for c in x)
            if key not in number:
                number[key] = len(self.at)
                self.at.append(x)
        pairs = set()
        for a, b in segments:
            on = sorted((foot(x, a, b)[0], v) for v, x in enumerate(self.at) if foot(x, a, b)[1] < 1e-9)
            pairs |= {pair for (_, v), (_, w) in zip(on, on[1:]) for pair in ((v, w), (w, v))}
        around = collections.defaultdict(list)
        for v, w in pairs:
            around[v].append(w)
        for v, ends in around.items():
            ends.sort(key=lambda w: math.atan2(self.at[w][1] - self.at[v][1], self.at[w][0] - self.at[v][0]))
        self.cycles, left = [], set(pairs)
        while left:
            side = first = min(left)
            cycle = []
            while True:
                left.discard(side)
                cycle.append(side[0])
                v, w = side
                ends = around[w]
                side = w, ends[ends.index(v) - 1]
                if side == first:
                    break
            self.cycles.append(cycle)

    def angles(self, cycle):
        for u, v, w in zip(cycle, cycle[1:] + cycle[:1], cycle[2:] + cycle[:2]):
            out, back = minus(self.at[w], self.at[v]), minus(self.at[u], self.at[v])
            angle = math.atan2(out[0] * back[1] - out[1] * back[0], dot(out, back)) % (2 * math.pi)
            yield angle if angle > 1e-9 else 2 * math.pi

    def faces(self):
        """Yields the corner angles and the Euler characteristic of each face."""
        polygons = [[self.at[v] for v in cycle] for cycle in self.cycles]
        areas = [area(polygon) for polygon in polygons]
        inside = collections.defaultdict(list)
        for k, polygon in enumerate(polygons):
            if areas[k] > 1e-14:
                continue
            around = [i for i, outline in enumerate(polygons) if areas[i] > max(1e-14, -areas[k] + 1e-14)
                      and not set(self.cycles[i]) & set(self.cycles[k]) and contains(outline, polygon[0])]
            if around:
                inside[min(around, key=lambda i: areas[i])].append(k)
        for k in range(len(polygons)):
            if areas[k] > 1e-14:
                cycles = [k] + inside[k]
                yield [a for c in cycles for a in self.angles(self.cycles[c])], 2 - len(cycles)


def contains(polygon, x):
    inside = False
    for p, q in zip(polygon, polygon[1:] + polygon[:1]):
        if (p[1] > x[1]) != (q[1] > x[1]) and x[0] < p[0] + (x[1] - p[1]) / (q[1] - p[1]) * (q[0] - p[0]):
            inside = not inside
    return inside


def eta_bound(segments, n_quads):
    """Returns the largest possible mean eta. A corner with n quads loses n |1 - angle / (90 n)|, and an inner vertex of valence v loses |4 - v|.
    In a face, the sum of 2 - n over corners and of 4 - v inside is four times its Euler characteristic. The best n are taken."""
    most, lost = 12, 0
    for angles, characteristic in PlanarMap(segments).faces():
        best = {0: 0.0}  # least loss by the sum over the corners so far
        for angle in angles:
            costs = [(2 - n, n * min(1, abs(1 - angle / n / (math.pi / 2)))) for n in range(1, 6)]
            least = min(cost for _, cost in costs)
            costs = [(change, cost) for change, cost in costs if cost < least + 2]
            following = {}
            for total, cost in best.items():
                for change, more in costs:
                    key = total + change
                    if cost + more < following.get(key, math.inf):
                        following[key] = cost + more
            floor = min(following.values())
            best = {total: cost for total, cost in following.items() if cost < floor + most}
        lost += min(cost + abs(4 * characteristic - total) for total, cost in best.items())
    return 1 - lost / n_quads


# Runs


class Run:
    def __init__(self, delquad, model, size, limit, keep=None):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "mesh.msh"
            try:
                done = subprocess.run([delquad, "mesh", model, "-o", path, "--size", repr(size), "--threads", "1", "--json", Path(folder) / "record.json"],
                                      capture_output=True, text=True, timeout=limit)
                self.code, self.message = done.returncode, done.stderr.strip()
            except subprocess.TimeoutExpired:
                self.code, self.message = "time", f"no end after {limit} s"
            self.mesh = self.record = None
            if self.code == 0:
                self.mesh, self.record = MshFile(path), json.loads((Path(folder) / "record.json").read_text())
                self.eta, self.seconds = self.record["metrics"]["eta_mean"], sum(self.record["cpu_seconds"].values())
                self.quads = len(self.mesh.quads)


def reason(message):
    """Returns a message without names, numbers and places."""
    line = next((row for row in message.split("\n") if "error" in row.lower()), message.split("\n")[-1])
    line = re.sub(r"\S*/\S+\.toml:?", "", line)
    line = re.sub(r"'[^']*'", "'..'", line)
    return re.sub(r"-?\d+(\.\d+)?(e-?\d+)?", "#", line)[:150]


class Table:
    """Runs one kind at one size."""

    def __init__(self, arguments, kind, size):
        self.arguments, self.kind, self.size = arguments, kind, size
        self.reasons, self.failures = collections.Counter(), []
        self.sound = self.paths = self.refused = self.sets = 0
        self.rows = []

    def run(self, folder):
        arguments, kind = self.arguments, self.kind
        size = self.size * {"sphere": 4, "part": 80}.get(kind, 1)
        model = folder / f"{kind}.toml"
        if kind == "sphere":
            write_sphere(folder / "sphere.off")
        part = next(iter(sorted((arguments.data / "cad").glob("*pump_carter*"))), None)
        if kind == "part" and part is None:
            return print(f"| part | {size:g} | skipped: no model |")
        base = {"sphere": "sphere.off", "part": part and part.resolve()}.get(kind)
        model.write_text(toml_surface(base, []) if base else toml_square([], None))
        plain = Run(arguments.delquad, model, size, arguments.limit)
        least_angle = math.radians(arguments.least_angle)
        disc = None
        if not base:
            model.write_text(f"[[loop]]\ncircle = {{ centre = [0, 0], radius = {math.sqrt(1 / math.pi)!r} }}\n")
            disc = Run(arguments.delquad, model, size, arguments.limit)
        n_open = len(open_edges(plain.mesh)) if base else 0
        near = 1e-3 * 2 * math.sqrt(3) if kind == "sphere" else 0.2
        for k in range(arguments.sets):
            if arguments.only is not None and k != arguments.only:
                continue
            rng = random.Random(f"{arguments.seed} {kind} {k}")
            is_crack = lambda i: kind == "cracks" and i % 3 == 0
            areas = {"": 1.0}
            features = []
            if kind in ("square", "cracks"):
                features = draw(rng, size, least_angle, 5, 60 if kind == "square" else 30)
                model.write_text(toml_square(features, is_crack))
            elif kind == "regions":
                polygons = cut_square(rng, size, least_angle)
                areas = {f"r{i}": area(p) for i, p in enumerate(polygons)}
                features = [(a, b) for p in polygons for a, b in zip(p, p[1:] + p[:1])]
                features = [(a, b) for i, (a, b) in enumerate(features)
                            if not any(max(math.dist(a, d), math.dist(b, c)) < 1e-9 for c, d in features[:i])]
                model.write_text(toml_regions(polygons))
            else:
                features = lines_on_sphere(rng) if kind == "sphere" else lines_on_part(rng, plain.mesh, 3 * size)
                model.write_text(toml_surface(base, features))
            run = Run(arguments.delquad, model, size, arguments.limit)
            self.sets += 1
            if run.code == 2:
                self.refused += 1
                self.reasons[reason(run.message)] += 1
            elif run.code != 0:
                self.failures.append((k, f"exit code {run.code}: {run.message[-200:]}"))
            else:
                wrong = unsound_surface(run.mesh, n_open) if base else unsound_plane(run.mesh, areas)
                self.sound += wrong is None
                missing = "" if wrong else (missing_on_surface(run.mesh, features, near, kind == "sphere") if base else
                                            missing_in_plane(run.mesh, features, is_crack))
                self.paths += missing is None
                if wrong or missing:
                    self.failures.append((k, wrong or missing))
                away = bound = math.nan
                if not base:
                    away = eta_away(run.mesh, features)
                    bound = eta_bound([f for f in features if f[0] != f[1]], run.quads)
                if k % 10 == 9:  # so that times are of the same state of the machine
                    model.write_text(toml_surface(base, []) if base else toml_square([], None))
                    again = Run(arguments.delquad, model, size, arguments.limit)
                    plain.seconds = again.seconds
                self.rows.append((run.eta, away, bound, run.seconds / plain.seconds, run.quads / plain.quads))
                if arguments.verbose:
                    print(kind, size, k, len(features), "eta %.3f away %.3f bound %.3f time %.2f quads %.2f" % self.rows[-1], wrong or missing or "",
                          {s: round(t, 3) for s, t in run.record["cpu_seconds"].items() if t > 0.005}, file=sys.stderr)
            if arguments.keep and (self.failures and self.failures[-1][0] == k or run.code == 2 or arguments.only is not None):
                arguments.keep.mkdir(parents=True, exist_ok=True)
                text = model.read_text() if run.code else ""
                (arguments.keep / f"{kind}_{self.size:g}_{k}.toml").write_text(
                    text or (toml_surface(base, features) if base else toml_regions(polygons) if kind == "regions" else toml_square(features, is_crack)))
        self.print(size, plain, disc)

    def print(self, size, plain, disc):
        n = max(1, len(self.rows))
        mean = [math.fsum(x for x in column if not math.isnan(x)) / n for column in zip(*self.rows)] or [math.nan] * 5
        worst = max((row[3] for row in self.rows), default=math.nan)
        planar = ["", "", "", ""]
        if disc:
            planar = [f"{x:.3f}" for x in (disc.eta, mean[1], mean[2])] + [f"{mean[3] * plain.seconds / disc.seconds:.2f}"]
        cells = [self.kind, f"{size:g}", self.sets, self.sound, self.paths, self.refused, f"{mean[0]:.3f}", f"{plain.eta:.3f}", *planar[:3],
                 f"{mean[4]:.2f}", f"{mean[3]:.2f}", f"{worst:.2f}", planar[3]]
        print("| " + " | ".join(map(str, cells)) + " |", flush=True)

    def print_failures(self):
        for text, count in self.reasons.most_common():
            print(f"{self.kind} {self.size:g}: refused {count} times: {text}")
        for k, text in self.failures:
            print(f"{self.kind} {self.size:g}, set {k}: {text}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--delquad", type=Path, default=ROOT / "build/release/delquad")
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared/data")
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    parser.add_argument("--sizes", nargs="+", type=float, default=[0.05, 0.02, 0.01])
    parser.add_argument("--sets", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--least-angle", type=float, default=10, help="degrees between lines that meet, in the plane")
    parser.add_argument("--only", type=int, help="this set alone")
    parser.add_argument("--limit", type=float, default=120, help="seconds for one mesh")
    parser.add_argument("--keep", type=Path, help="folder for the models that fail, or that of --only")
    parser.add_argument("-v", "--verbose", action="store_true", help="a line for each set")
    arguments = parser.parse_args()
    if not arguments.delquad.exists():
        return print(f"skipped: {arguments.delquad} is not built")
    header = ["kind", "size", "sets", "sound", "paths", "refused", "eta", "without", "disc", "away", "bound", "quads", "time", "at most", "by disc"]
    print("| " + " | ".join(header) + " |\n|---|" + "---:|" * (len(header) - 1), flush=True)
    tables = []
    with tempfile.TemporaryDirectory() as folder:
        for kind in arguments.kinds:
            for size in arguments.sizes:
                tables.append(Table(arguments, kind, size))
                tables[-1].run(Path(folder))
    for table in tables:
        table.print_failures()


if __name__ == "__main__":
    main()
