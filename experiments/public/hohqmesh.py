#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns control files of HOHQMesh into model files: hohqmesh.py FILE.control... OUT writes OUT/FILE.toml for planar models.

Splines go through the same knots, with our end conditions. Sizes come from the background grid and refinement regions. Along curves
they are a third of the radius of curvature, so that circles have about as many edges as in HOHQMesh. `quads` of a case scales all.
"""
import json
import math
import pathlib
import sys

OF_RADIUS, GROWTH = 1 / 3, 0.3  # sizes on curves, by the radius of curvature; how they grow from there, by length
SAMPLES = 40  # of a curve
STEP = 1e-3  # of a curve's parameter, for its curvature
IN_SPACE = {"SIMPLE_EXTRUSION", "SIMPLE_ROTATION", "SWEEP_ALONG_CURVE"}


def read_block(lines):
    """Returns [(name, text, or rows of numbers, or block), ...] up to the block's end."""
    block = []
    for line in lines:
        line = line.split("%")[0].strip()
        if line.startswith("\\begin{"):
            block.append((line[7:-1].strip(), read_block(lines)))
        elif line.startswith("\\end{"):
            break
        elif "=" in line:
            block.append(tuple(part.strip() for part in line.split("=", 1)))
        elif line:
            block.append(("row", [float(x) for x in line.split()]))
    return block


def find(block, *names):
    """Returns all entries with the last of these names, in the first block of the name before it, and so on."""
    for name in names[:-1]:
        block = next((value for key, value in block if key == name), [])
    return [value for key, value in block if key == names[-1]]


def vector(block, key):
    return [float(x) for x in find(block, key)[0].strip("[]").split(",")]


def place(block, key):
    return vector(block, key)[:2]


def number(block, key, absent=0.0):
    return float((find(block, key) or [absent])[0])


def shape(kind, block, folder):
    """Returns a curve's key in a model file, its value, and triples of points along it that tell its curvature."""
    if kind == "END_POINTS_LINE":
        return "segment", [place(block, "xStart"), place(block, "xEnd")], []
    if kind == "SPLINE_CURVE":
        rows = find(block, "SPLINE_DATA", "row")
        if not rows:
            text = (folder / pathlib.Path(find(block, "file")[0]).name).read_text()
            rows = [[float(x) for x in line.split()] for line in text.splitlines()[1:]]
        points = [row[1:3] for row in rows]
        return "spline", points, zip(points, points[1:], points[2:])
    if kind == "PARAMETRIC_EQUATION_CURVE":
        x, y = (find(block, key)[0].split("=", 1)[1].strip() for key in ("xEqn", "yEqn"))
        first, last = 0.0, 1.0
    elif kind in ("CIRCULAR_ARC", "ELLIPTIC_ARC"):
        unit = 1.0 if find(block, "units") == ["radians"] else math.pi / 180
        first, last, turn = (unit * number(block, key) for key in ("start angle", "end angle", "rotation"))
        a, b = (number(block, key, number(block, "radius")) for key in ("xRadius", "yRadius"))
        (x0, y0), c, s = place(block, "center"), math.cos(turn), math.sin(turn)
        x = f"{x0!r} + {a * c!r}*cos(t) - {b * s!r}*sin(t)"
        y = f"{y0!r} + {a * s!r}*cos(t) + {b * c!r}*sin(t)"
    else:
        sys.exit(f"curve of kind {kind}: expected a line, an arc, a spline or equations")
    at = eval(f"lambda t: ({x}, {y})".replace("^", "**"), vars(math).copy())  # the benchmark's own
    step = STEP * (last - first)
    middle = [first + (k + 0.5) / SAMPLES * (last - first) for k in range(SAMPLES)]
    return "expression", {"x": x, "y": y, "from": first, "to": last}, [(at(t - step), at(t), at(t + step)) for t in middle]


def radius(a, b, c):
    """Returns the radius of the circle through three points."""
    doubled = abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    return math.dist(a, b) * math.dist(b, c) * math.dist(c, a) / (2 * doubled) if doubled > 0 else math.inf


def refinement(block, base):
    """Returns a source from the size h to the background size, which is reached at the distance d with h 3^(d / w)."""
    if find(block, "type") != ["smooth"]:
        sys.exit(f"refinement of type {find(block, 'type')}: expected smooth")
    ends = {name: place(block, key) for name, key in (("at", "x0"), ("to", "x1")) if find(block, key)}
    h, w = number(block, "h"), number(block, "w")
    return ends | {"near": h, "far": base, "radius_far": w * math.log(base / h, 3)}


def toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def convert(file):
    """Returns the text of a model file, or None for a model in space."""
    text = read_block(iter(file.read_text().splitlines()))
    control = find(text, "CONTROL_INPUT")[0]
    if any(name in IN_SPACE for name, _ in control):
        return None
    model = find(text, "MODEL")[0]
    grid = find(control, "BACKGROUND_GRID")[0]
    given = find(grid, "background grid size")
    base = max(place(grid, "background grid size" if given else "dx"))
    sources = [refinement(block, base) for _, block in (find(control, "REFINEMENT_REGIONS") or [[]])[0]]
    curves, loops = [], []

    def add_loop(parts, **keys):
        names = []
        for kind, block in parts:
            if isinstance(block, str):
                continue
            key, value, bends = shape(kind, block, file.parent)
            names.append(f"c{len(curves) + 1}")
            curves.append({"name": names[-1], "boundary": find(block, "name")[0], key: value})
            for bend in bends:
                size = OF_RADIUS * radius(*bend)
                if size < base:
                    sources.append({"at": bend[1], "near": size, "far": base, "radius_far": (base - size) / GROWTH})
        loops.append({"curves": names} | keys)

    if outer := find(model, "OUTER_BOUNDARY"):
        add_loop(outer[0], region="domain")
    else:
        low = place(grid, "x0")
        high = [x + n * dx for x, n, dx in zip(low, vector(grid, "N"), place(grid, "dx"))]
        loops.append({"rectangle": [low, high], "region": "domain"})
    for kind, keys in (("INNER_BOUNDARIES", {"hole": True}), ("INTERFACE_BOUNDARIES", {})):
        for part in (find(model, kind) or [[]])[0]:
            chain = part[1] if part[0] == "CHAIN" else [part]
            add_loop(chain, **(keys or {"region": find(chain, "name")[0]}))
    lines = [f"size.base = {base!r}"]
    for key, tables in (("size.source", sources), ("curve", curves), ("loop", loops)):
        lines += [f"{key} = ["] + [f"  {toml(table)}," for table in tables] + ["]"]
    return "\n".join(lines) + "\n"


def main(*files_and_folder):
    *files, folder = map(pathlib.Path, files_and_folder)
    folder.mkdir(parents=True, exist_ok=True)
    for file in files:
        if text := convert(file):
            (folder / f"{file.stem}.toml").write_text(text)


if __name__ == "__main__":
    main(*sys.argv[1:])
