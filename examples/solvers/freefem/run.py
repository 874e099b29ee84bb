#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Conducts heat through the plate of ../heat.toml by FreeFem++: run.py [--delquad PROGRAM] [-o PICTURE.svg]

FreeFem++ has no quads, so each is halved along its shorter diagonal. Needs FreeFem++ (Debian: freefem++).
"""
import json
import math
import pathlib
import shutil
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import driver  # noqa: E402
import picture  # noqa: E402


def read_medit(path):
    """Vertices, edges and quads, each a row of numbers with the curve's or region's at the end, and the curves' names."""
    sections, names = {}, {}
    lines = iter(path.read_text(encoding="utf-8").splitlines())
    for line in lines:
        if line.startswith("# curve "):
            number, name = line[8:].split(": ", 1)
            names[int(number)] = name
        elif line in ("Vertices", "Edges", "Quadrilaterals"):
            sections[line] = [next(lines).split() for _ in range(int(next(lines)))]
    return sections["Vertices"], sections["Edges"], sections["Quadrilaterals"], names


def halves(quad, xy):
    a, b, c, d, region = quad
    short = math.dist(xy[int(a) - 1], xy[int(c) - 1]) <= math.dist(xy[int(b) - 1], xy[int(d) - 1])
    return [[a, b, c, region], [a, c, d, region]] if short else [[a, b, d, region], [b, c, d, region]]


def write_medit(path, xy, edges, quads):
    """Quads by halves; nodes count from 1, and edges and quads end with a label."""
    sections = {"Vertices": [[x, y, 0] for x, y in xy], "Edges": edges, "Triangles": [half for quad in quads for half in halves(quad, xy)]}
    with open(path, "w", encoding="utf-8") as file:
        file.write("MeshVersionFormatted 2\nDimension 2\n")
        for keyword, rows in sections.items():
            file.write(f"{keyword}\n{len(rows)}\n" + "".join(" ".join(map(str, row)) + "\n" for row in rows))
        file.write("End\n")


def solve(script, folder):
    """Returns the output of a script that runs in a folder."""
    shutil.copy(HERE / script, folder)
    return driver.run(["FreeFem++", "-nw", "-ne", "-v", "0", script], "Debian: freefem++", folder)


def write_for_freefem(folder):
    vertices, edges, quads, names = read_medit(folder / "quads.mesh")
    xy = [[float(row[0]), float(row[1])] for row in vertices]
    labels = {name: k + 1 for k, name in enumerate(sorted(set(names.values())))}
    write_medit(folder / "heat.mesh", xy, [[a, b, labels[names[int(curve)]]] for a, b, curve in edges], quads)
    (folder / "labels.idp").write_text("".join(f"int {name} = {label};\n" for name, label in labels.items()))


def main():
    parser = driver.parser(__doc__, "heat.svg")
    parser.add_argument("--delquad", default="delquad", help="the program")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        driver.run([options.delquad, "-q", "mesh", HERE.parent / "heat.toml", "-o", folder / "quads.mesh"], "see README.md")
        write_for_freefem(folder)
        print(solve("heat.edp", folder).strip())
        picture.draw(json.loads((folder / "heat.json").read_text()), options.output, "temperature")


if __name__ == "__main__":
    main()
