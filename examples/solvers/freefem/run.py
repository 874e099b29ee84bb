#!/usr/bin/python3
"""Conducts heat through the plate of ../heat.toml by FreeFem++: run.py [--delquad PROGRAM] [-o PICTURE.svg]

FreeFem++ knows no quads: each is halved along its shorter diagonal, so that this computes with triangles. Needs FreeFem++
(Debian: freefem++).
"""
import argparse
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
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


def write_for_freefem(folder):
    vertices, edges, quads, names = read_medit(folder / "quads.mesh")
    xy = [[float(row[0]), float(row[1])] for row in vertices]
    labels = {name: k + 1 for k, name in enumerate(sorted(set(names.values())))}
    sections = {"Vertices": [[x, y, 0] for x, y in xy], "Edges": [[a, b, labels[names[int(curve)]]] for a, b, curve in edges],
                "Triangles": [half for quad in quads for half in halves(quad, xy)]}
    with open(folder / "heat.mesh", "w", encoding="utf-8") as file:
        file.write("MeshVersionFormatted 2\nDimension 2\n")
        for keyword, rows in sections.items():
            file.write(f"{keyword}\n{len(rows)}\n" + "".join(" ".join(map(str, row)) + "\n" for row in rows))
        file.write("End\n")
    (folder / "labels.idp").write_text("".join(f"int {name} = {label};\n" for name, label in labels.items()))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--delquad", default="delquad", help="the program")
    parser.add_argument("-o", "--output", default="heat.svg")
    options = parser.parse_args()
    if not shutil.which("FreeFem++"):
        sys.exit("FreeFem++ is not installed: expected FreeFem++ on the PATH (Debian: freefem++)")
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        subprocess.run([options.delquad, "-q", "mesh", HERE.parent / "heat.toml", "-o", folder / "quads.mesh"], check=True)
        write_for_freefem(folder)
        shutil.copy(HERE / "heat.edp", folder)
        solved = subprocess.run(["FreeFem++", "-nw", "-ne", "heat.edp"], cwd=folder, capture_output=True, text=True)
        if solved.returncode != 0:
            sys.exit(f"FreeFem++ failed: {solved.stdout[-2000:]}{solved.stderr[-2000:]}")
        print(solved.stdout.strip())
        picture.draw(json.loads((folder / "heat.json").read_text()), options.output, "temperature")
    print(f"the picture is {os.path.abspath(options.output)}")


if __name__ == "__main__":
    main()
