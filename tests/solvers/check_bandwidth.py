#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers of nodes as solvers meet them in files: check_bandwidth.py DELQUAD MODEL

The half bandwidth (the largest difference of numbers in an element) of the plate with 16 holes, at sizes h and h / 2. A front that
runs across the plate has about width / h nodes: twice that is allowed. Without renumbering it is near the number of nodes.
"""
import os
import re
import subprocess
import sys
import tempfile

WIDTH = 2.0  # of the plate


def rows_of_inp(path):
    """The numbers of nodes, element by element."""
    rows, inside = [], False
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("*"):
                inside = line.startswith("*ELEMENT")
            elif inside:
                rows.append([int(word) for word in line.split(",")[1:]])
    return rows


def rows_of_msh(path):
    rows = []
    with open(path, encoding="utf-8") as file:
        lines = iter(re.search(r"\$Elements\n(.*?)\$EndElements", file.read(), re.DOTALL)[1].splitlines()[1:])
    for head in lines:
        dim, _, _, count = map(int, head.split())
        block = [[int(word) for word in next(lines).split()[1:]] for _ in range(count)]
        rows += block if dim == 2 else []
    return rows


def bandwidth(rows):
    return max(max(row) - min(row) for row in rows)


def main():
    delquad, model = sys.argv[1:]
    good = True
    with tempfile.TemporaryDirectory() as folder:
        for size, form, arguments in ((0.02, "inp", []), (0.02, "msh", []), (0.01, "inp", []), (0.02, "inp", ["--keep-numbers"])):
            path = os.path.join(folder, f"plate.{form}")
            subprocess.run([delquad, "-q", "mesh", model, "-o", path, "--size", str(size), "--quality", "fast", *arguments], check=True)
            rows = (rows_of_inp if form == "inp" else rows_of_msh)(path)
            found, most = bandwidth(rows), 2 * WIDTH / size
            print(f"{len(rows)} quads, {form} {' '.join(arguments)}: half bandwidth {found}; a front has up to {most:.0f} nodes")
            good &= found > len(rows) / 2 if arguments else found <= most
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
