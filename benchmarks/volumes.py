#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares strategies that fill closed examples, and named CAD files: shares of hexahedra, scaled Jacobians, tau, valences, sides that do not conform, processor time."""

import argparse
import json
import math
import os
import re
import statistics
import subprocess
import tempfile
from collections import Counter
from pathlib import Path

EXAMPLES = ["bracket", "sphere", "torus", "blended_tee", "cross_drilled", "elbow", "fins", "loft", "thin_box"]
KINDS = ["hexahedra", "pyramids", "tetrahedra"]
COLUMNS = ["model", "quads", "strategy", "cells", "points inside", "hexahedra, % of volume", "% of cells", "their scaled Jacobian", "of pyramids", "of tetrahedra",
           "least of all", "tau", "regular points, %", "sides alone", "s"]
# By the type of cells in MSH: edges, sides.
CELLS = {4: ("01 12 20 03 13 23", "021 013 123 203"), 5: ("01 12 23 30 45 56 67 74 04 15 26 37", "0321 4567 0154 1265 2376 3047"),
         6: ("01 12 20 34 45 53 03 14 25", "021 345 0143 1254 2035"), 7: ("01 12 23 30 04 14 24 34", "0321 014 124 234 304")}
# Points along directions, recombined as in [baudouin2014hex].
GMSH = "Mesh.MeshSizeMin={0}; Mesh.MeshSizeMax={0}; Mesh.Algorithm=8; Mesh.RecombineAll=1; Mesh.Algorithm3D=9; Mesh.Recombine3DAll=1;"


def read_msh(path):
    """Returns the points by number, and (type, points) of elements, of a file of version 2.2."""
    text = path.read_text()
    block = lambda name: [line.split() for line in re.search(rf"\${name}\n(.*?)\$End", text, re.S)[1].splitlines()[1:]]
    points = {row[0]: tuple(map(float, row[1:4])) for row in block("Nodes")}
    return points, [(int(row[1]), row[3 + int(row[2]):]) for row in block("Elements")]


def shape_of(path):
    """Returns points inside, tau of edges, percent of points inside in eight hexahedra alone, sides that do not conform, and the size.

    The size is the mean edge of the skin.
    """
    points, elements = read_msh(path)
    edges, skin, sides, hexahedra, others, around = set(), set(), Counter(), Counter(), set(), set()
    for kind, nodes in elements:
        if kind in (2, 3):
            sides[frozenset(nodes)] += 1
            around.update(nodes)
            skin.update(frozenset((nodes[k - 1], nodes[k])) for k in range(len(nodes)))
        elif kind in CELLS:
            of_edges, of_sides = ([[nodes[int(k)] for k in part] for part in parts.split()] for parts in CELLS[kind])
            edges.update(map(frozenset, of_edges))
            sides.update(map(frozenset, of_sides))
            hexahedra.update(nodes if kind == 5 else ())
            others.update(nodes if kind != 5 else ())
    length = lambda edge: math.dist(*(points[v] for v in edge))
    size = statistics.mean(map(length, skin))
    tau = 100 * math.exp(statistics.mean(min(length(edge) / size, size / length(edge)) - 1 for edge in edges))
    inside = (hexahedra.keys() | others) - around
    regular = sum(hexahedra[v] == 8 and v not in others for v in inside)
    return len(inside), tau, 100 * regular / max(len(inside), 1), sum(n == 1 for n in sides.values()), size


def measure(delquad, model, quads, strategy, folder, size):
    """Returns the cells of a row after the model's name, the share of the volume (None: no mesh), and the size of the skin."""
    mesh, record, before = folder / "v.msh2", folder / "v.json", os.times()
    mesh.unlink(missing_ok=True)
    if strategy == "gmsh":
        (folder / "v.geo").write_text(f'Merge "{model}";\n{GMSH.format(size)}\n')
        command = ["gmsh", "-3", "v.geo", "-nt", "1", "-format", "msh22", "-o", mesh]
    else:
        command = [delquad, "volume", model, "--quads", str(quads), "--threads", "1", "-q", "--no-cache", "--strategy", strategy, "-o", mesh]
    done = subprocess.run(command, cwd=folder, capture_output=True, timeout=900)
    after = os.times()
    if done.returncode != 0 or not mesh.exists():
        why = "refused" if done.returncode > 0 else f"crashed with signal {-done.returncode}"
        return [str(quads), strategy, "", "", why] + [""] * (len(COLUMNS) - 6), None, size
    subprocess.run([delquad, "metrics", mesh, "-q", "--json", record], cwd=folder, capture_output=True)
    read = json.loads(record.read_text())
    inside, tau, regular, alone, edge = shape_of(mesh)
    cells = sum(shape["number"] for shape in read["shapes"].values())
    hexahedra = read["shapes"].get("hexahedra", {"number": 0, "volume": 0})
    jacobians = [f"{shape['least_scaled_jacobian']:.2f}, {shape['mean_scaled_jacobian']:.2f}" if (shape := read["shapes"].get(kind)) else "" for kind in KINDS]
    share = 100 * hexahedra["volume"] / read["volume"]
    seconds = after.children_user + after.children_system - before.children_user - before.children_system
    return [str(quads), strategy, str(cells), str(inside), f"{share:.1f}", f"{100 * hexahedra['number'] / cells:.0f}", *jacobians,
            f"{read['least_scaled_jacobian']:.3f}", f"{tau:.1f}", f"{regular:.0f}", str(alone), f"{seconds:.1f}"], share, edge


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("models", nargs="*", type=Path, help="CAD files of closed bodies, besides the examples")
    parser.add_argument("--delquad", default=Path(__file__).resolve().parent.parent / "build/release/delquad")
    parser.add_argument("--quads", nargs="+", type=int, default=[1200, 3500])
    parser.add_argument("--strategies", nargs="+", default=["DBCO"], help="of 'delquad volume --strategy', and 'gmsh' after one of them, at its size")
    given = parser.parse_args()
    print("commit " + re.search(r"commit (\w+)", subprocess.check_output([given.delquad, "--version"], text=True))[1] + "\n")
    print(f"| {' | '.join(COLUMNS)} |\n|{'---|' * len(COLUMNS)}")
    shares = {(strategy, quads): [] for strategy in given.strategies for quads in given.quads}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        examples = [folder / f"{example}.step" for example in EXAMPLES]
        for example in examples:
            subprocess.run([given.delquad, "example", example.stem, "-o", example], check=True, capture_output=True)
        for model in examples + [m.resolve() for m in given.models]:
            for quads in given.quads:
                size = None
                for strategy in given.strategies:
                    row, share, size = measure(given.delquad, model, quads, strategy, folder, size)
                    shares[strategy, quads] += [] if share is None else [share]
                    print(f"| {model.stem} | {' | '.join(row)} |", flush=True)
    for (strategy, quads), of in shares.items():
        if of:
            print(f"| median of {len(of)} | {quads} | {strategy} | | | {statistics.median(of):.1f} |{' |' * (len(COLUMNS) - 6)}")


if __name__ == "__main__":
    main()
