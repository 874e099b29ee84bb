#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes MODEL.toml, solves MODEL.inp by CalculiX and draws the result: run.py MODEL [--delquad PROGRAM] [-o PICTURE.svg]

MODEL is strip or bracket, or one of your own beside them. Needs ccx (Debian: calculix-ccx).
"""
import math
import pathlib
import shutil
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import driver  # noqa: E402
import picture  # noqa: E402


def read_mesh(path):
    """Nodes by number, and the elements' rows of numbers."""
    nodes, elements, keyword = {}, [], ""
    for line in path.read_text(encoding="utf-8").splitlines():
        words = line.split(",")
        if line.startswith("*"):
            keyword = words[0]
        elif keyword == "*NODE":
            nodes[int(words[0])] = [float(x) for x in words[1:]]
        elif keyword == "*ELEMENT":
            elements.append([int(word) for word in words[1:]])
    return nodes, elements


def read_results(path):
    """The last result of each kind at the nodes: kind -> number -> values."""
    results, rows = {}, None
    for line in path.read_text(encoding="latin-1").splitlines():
        if line.startswith(" -4"):
            rows = results[line.split()[1]] = {}
        elif line.startswith(" -3"):
            rows = None
        elif line.startswith(" -1") and rows is not None:
            rows[int(line[3:13])] = [float(line[at:at + 12]) for at in range(13, len(line), 12)]
    return results


def solve(folder):
    """The results of deck.inp in a folder."""
    log = driver.run(["ccx", "-i", "deck"], "Debian: calculix-ccx", folder)
    if "*ERROR" in log or not (folder / "deck.frd").exists():
        sys.exit(f"ccx failed: {log[-2000:]}")
    return read_results(folder / "deck.frd")


def main():
    parser = driver.parser(__doc__, None)
    parser.add_argument("model")
    parser.add_argument("--delquad", default="delquad", help="the program")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        driver.run([options.delquad, "-q", "mesh", HERE / f"{options.model}.toml", "-o", folder / "mesh.inp"], "see README.md")
        shutil.copy(HERE / f"{options.model}.inp", folder / "deck.inp")
        results = solve(folder)
        nodes, elements = read_mesh(folder / "mesh.inp")
    print(f"{len(elements)} elements, {len(nodes)} nodes")
    if "STRESS" in results:
        title, values = "stress along x", {n: row[0] for n, row in results["STRESS"].items()}
    else:
        title, values = "displacement", {n: math.hypot(*row[:3]) for n, row in results["DISP"].items()}
    print(f"{title}: {min(values.values()):.6g} to {max(values.values()):.6g}")
    output = options.output or f"{options.model}.svg"
    picture.draw([[[*nodes[n], values[n]] for n in row] for row in elements], output, f"{options.model}: {title}")


if __name__ == "__main__":
    main()
