#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns a planar model in Gmsh's language into a model file: geo.py MODEL.geo OUT.toml CURVE, where CURVE is polyline or spline.

Line n becomes curve cn, surface n region sn. Reads only `Point`, `Line`, `Line Loop` and `Plane Surface` of plain numbers.
"""
import pathlib
import re
import sys

ENTITY = re.compile(r"^(Point|Line|Line Loop|Plane Surface) *\( *(\d+) *\) *= *\{([^}]*)\}", re.MULTILINE)


def main(source, target, curve):
    entities = {"Point": {}, "Line": {}, "Line Loop": {}, "Plane Surface": {}}
    for kind, tag, values in ENTITY.findall(pathlib.Path(source).read_text()):
        entities[kind][int(tag)] = [float(value) for value in values.split(",")]
    points, lines, loops, surfaces = entities.values()
    text = ["curve = ["]
    for tag, line in lines.items():
        key = curve if len(line) > 2 else "polyline"
        text.append(f'  {{ name = "c{tag}", {key} = {[points[point][:2] for point in line]} }},')
    text += ["]", "loop = ["]
    for tag, (outline, *_) in surfaces.items():
        names = ", ".join(f'"c{abs(line):.0f}"' for line in loops[outline])
        text.append(f'  {{ curves = [{names}], region = "s{tag}" }},')
    pathlib.Path(target).write_text("\n".join(text + ["]", ""]))


if __name__ == "__main__":
    main(*sys.argv[1:])
