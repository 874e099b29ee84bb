#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""CalculiX solves small problems with the sets and surfaces of INP files: solve_ccx.py DELQUAD. Exit code 77: no ccx."""
import math
import os
import re
import subprocess
import sys
import tempfile

from read_mesh import inp_nodes, needs, run_ccx, sets_of

YOUNG, POISSON, THICKNESS = 210000.0, 0.3, 0.5


def mesh(delquad, folder, model, name, size):
    subprocess.run([delquad, "mesh", os.path.join(folder, model), "-o", os.path.join(folder, name), "--size", size], check=True,
                   capture_output=True, timeout=120)


def solve(folder, inp, section, lines):
    """The printed results: a list of rows for each request."""
    deck = [f"*INCLUDE, INPUT={inp}", "*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG}, {POISSON}", *section, str(THICKNESS),
            "*STEP", "*STATIC", *lines, "*END STEP", ""]
    with open(os.path.join(folder, "deck.inp"), "w", encoding="utf-8") as file:
        file.write("\n".join(deck))
    run_ccx(folder, "deck")
    blocks = []
    with open(os.path.join(folder, "deck.dat"), encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if line.strip() and not re.match(r"\s*[-0-9]", line):
                blocks.append([])
            elif words:
                blocks[-1].append([float(word) for word in words])
    return [block for block in blocks if block]


def near(found, wanted, part, what):
    assert abs(found - wanted) <= part * abs(wanted), f"{what}: {found}, expected {wanted} up to {part:.0%}"


def stretched_plate(delquad, folder):
    """Pulled at one side: strains are the same everywhere, which linear elements hold exactly."""
    with open(os.path.join(folder, "plate.toml"), "w", encoding="utf-8") as file:
        file.write('loop = { rectangle = [[0, 0], [2, 1]], boundary = ["bottom", "far right", "top", "left"], region = "steel plate" }\n')
    mesh(delquad, folder, "plate.toml", "plate.inp", ".2")
    pull = 100.0
    blocks = solve(folder, "plate.inp", ["*SOLID SECTION, ELSET=steel_plate, MATERIAL=STEEL"],
                   ["*BOUNDARY", "left, 1", "bottom, 2", "*DSLOAD", f"far_right, P, {-pull}", "*NODE PRINT, NSET=steel_plate", "U"])
    nodes = inp_nodes(os.path.join(folder, "plate.inp"))
    assert len(blocks[0]) == len(nodes)
    for number, ux, uy, _ in blocks[0]:
        x, y, _ = nodes[int(number)]
        assert abs(ux - pull / YOUNG * x) < 1e-5 * pull / YOUNG, (number, ux)
        assert abs(uy + POISSON * pull / YOUNG * y) < 1e-5 * pull / YOUNG, (number, uy)


def holed_plate(delquad, folder):
    """The stress concentration at a hole: 3 in an infinite plate, a little more in a wide one."""
    with open(os.path.join(folder, "holed.toml"), "w", encoding="utf-8") as file:
        file.write('loop = [{ rectangle = [[0, 0], [20, 20]], boundary = ["bottom", "right", "top", "left"] },\n'
                   ' { circle = { centre = [10, 10], radius = 1 }, boundary = "hole", hole = true }]\n')
    mesh(delquad, folder, "holed.toml", "holed.inp", "min(0.5, 0.08 + 0.1 * (sqrt((x - 10)^2 + (y - 10)^2) - 1))")
    sides = [name for name in sets_of(os.path.join(folder, "holed.inp"))["ELSET"] if name.startswith("_hole_S")]
    lines = ["*BOUNDARY", "left, 1", "bottom, 2", "*DSLOAD", "right, P, -1"]
    for name in sides:
        lines += [f"*EL PRINT, ELSET={name}", "S"]
    blocks = solve(folder, "holed.inp", ["*SOLID SECTION, ELSET=domain, MATERIAL=STEEL"], lines)
    peak = max(row[2] for block in blocks for row in block)  # element, point, stresses
    near(peak, 3.05, 0.15, "stress at the hole")


def pulled_pipes(delquad, folder):
    """A shell: what pulls at an open end arrives at the fixed one. Loads at edges take sets of elements."""
    subprocess.run([delquad, "example", "pipe_tee", "-o", os.path.join(folder, "tee.step")], check=True, capture_output=True)
    mesh(delquad, folder, "tee.step", "tee.inp", "4")
    path = os.path.join(folder, "tee.inp")
    nodes, sets = inp_nodes(path), sets_of(path)
    ends = {}  # curve: nodes of its surface
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("*"):
                match = re.match(r"\*SURFACE, NAME=(curve_\d+), TYPE=NODE", line)
                end = ends.setdefault(match[1], []) if match else None
            elif end is not None:
                end.append(int(line))
    assert len(ends) > 1, ends
    fixed, pulled = sorted(ends)[:2]
    points = [nodes[n] for n in ends[pulled]]
    middle = [sum(p[k] for p in points) / len(points) for k in range(3)]
    radius = max(math.dist(p, middle) for p in points)
    lines = ["*BOUNDARY", f"{fixed}, 1, 6", "*DLOAD"]
    for name in sets["ELSET"]:
        match = re.fullmatch(f"_{pulled}_E([1-4])", name)
        if match:
            lines.append(f"{name}, EDNOR{match[1]}, -3.")
    blocks = solve(folder, "tee.inp", ["*ELSET, ELSET=ALL_OF_IT", *[n for n in sets["ELSET"] if re.fullmatch(r"region_\d+", n)],
                                       "*SHELL SECTION, ELSET=ALL_OF_IT, MATERIAL=STEEL"],
                   lines + [f"*NODE PRINT, NSET={fixed}, TOTALS=ONLY", "RF"])
    near(math.hypot(*blocks[0][0][:3]), 3 * 2 * math.pi * radius, 0.03, "reaction at the fixed end")


def main():
    needs.program("ccx", "calculix-ccx")
    for problem in (stretched_plate, holed_plate, pulled_pipes):
        with tempfile.TemporaryDirectory() as folder:
            problem(sys.argv[1], folder)
        print(f"{problem.__name__}: good")


if __name__ == "__main__":
    main()
