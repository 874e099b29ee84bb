#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""CalculiX computes with the meshes in INP files: check_calculix.py DELQUAD PROBLEM [WRITER]. Exit code 77: no ccx.

PROBLEM: patch, shell_patch, strip, shell, periodic, materials, kept_deck, midsurface, tee or joints, whose models WRITER writes.

CalculiX prints seven digits of each number. A zero of the exact solution is printed with its size, so that it can be checked to rounding.
Forces on nodes inside of a patch are zero to 1e-10 of forces on its boundary. All else is checked to seven digits.
"""
import math
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "readers"))
from read_mesh import inp_nodes, needs, run_ccx, sets_of  # noqa: E402

YOUNG, POISSON = 210000.0, 0.3
ZERO = 1e-10  # what rounding leaves, as a part of what is not zero
PRINTED = 1e-6  # seven digits, and what the solver's rounding adds to them

PLATE = """loop = [
  { rectangle = [[0, 0], [2, 1]], boundary = ["bottom", "right", "top", "left"], region = "plate" },
  { circle = { centre = [0.6, 0.5], radius = 0.2 }, boundary = "small hole", hole = true },
  { circle = { centre = [1.3, 0.55], radius = 0.25 }, boundary = "large hole", hole = true },
]
"""


def mesh(delquad, folder, model, text, name, *arguments):
    """Writes the model's text and meshes it; the path of the mesh."""
    path, out = os.path.join(folder, model), os.path.join(folder, name)
    if text:
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    subprocess.run([delquad, "-q", "mesh", path, "-o", out, *arguments], check=True)
    return out


def solve(folder, inp, section, lines, thickness=1.0):
    """Returns the printed tables: for each request its title and rows of numbers."""
    deck = [f"*INCLUDE, INPUT={os.path.basename(inp)}", "*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG}, {POISSON}",
            f"*{section}, MATERIAL=STEEL", str(thickness), "*STEP", "*STATIC", *lines, "*END STEP", ""]
    with open(os.path.join(folder, "deck.inp"), "w", encoding="utf-8") as file:
        file.write("\n".join(deck))
    run_ccx(folder, "deck")
    blocks = []
    with open(os.path.join(folder, "deck.dat"), encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if words and not re.match(r"[-0-9]", words[0]):
                blocks.append([])
            elif words:
                blocks[-1].append([float(word) for word in words if word[0] != "_"])  # a shell's name behind its numbers
    return [block for block in blocks if block]


def elements_of(inp):
    """Rows of nodes by the type of elements."""
    found, rows = {}, None
    with open(inp, encoding="utf-8") as file:
        for line in file:
            if line.startswith("*"):
                kind = re.match(r"\*ELEMENT, TYPE=(\w+)", line)
                rows = found.setdefault(kind[1], []) if kind else None
            elif rows is not None:
                rows.append([int(word) for word in line.split(",")[1:]])
    return found


def members(inp, keyword, name):
    """Numbers in a set."""
    found, inside = [], False
    with open(inp, encoding="utf-8") as file:
        for line in file:
            if line.startswith("*"):
                inside = line.strip() == f"*{keyword}, {keyword}={name}"
            elif inside:
                found += [int(word) for word in line.split(",") if word.strip()]
    return found


class Patch:
    """A linear displacement in a plane that `turn` (rows: its axes in space) puts into space, and the stress that belongs to it."""

    STRAIN = ((1e-3, 2e-3), (-0.5e-3, 0.7e-3))

    def __init__(self, turn):
        def in_space(a):
            return [[sum(turn[k][i] * a[k][m] * turn[m][j] for k in (0, 1) for m in (0, 1)) for j in range(3)] for i in range(3)]

        (xx, xy), (yx, yy) = self.STRAIN
        e = YOUNG / (1 - POISSON ** 2)
        shear = YOUNG / (2 * (1 + POISSON)) * (xy + yx)
        self.gradient = in_space(self.STRAIN)
        s = in_space(((e * (xx + POISSON * yy), shear), (shear, e * (yy + POISSON * xx))))
        self.stress = [s[0][0], s[1][1], s[2][2], s[0][1], s[0][2], s[1][2]]

    def at(self, point):
        return [sum(g * x for g, x in zip(row, point)) for row in self.gradient]


def largest(rows):
    return max(abs(x) for row in rows for x in row)


def check_patch(folder, inp, section, patch, label, exact=True):
    """The displacement at all nodes: no forces inside. The displacement at the boundary: the same inside. The stress is one everywhere."""
    nodes, sets = inp_nodes(inp), sets_of(inp)
    on_boundary = {n for name in sets["NSET"] if re.fullmatch(r"curve_\d+", name) for n in members(inp, "NSET", name)}
    free = [n for n in nodes if n not in on_boundary]
    assert on_boundary and free
    regions = [name for name in sets["ELSET"] if re.fullmatch(r"region_\d+", name)]
    together = ["*ELSET, ELSET=ALL_OF_IT", *regions, "*NSET, NSET=ALL_NODES", *regions]
    include = os.path.join(folder, "sets.inp")
    with open(include, "w", encoding="utf-8") as file:
        file.write("\n".join([f"*INCLUDE, INPUT={os.path.basename(inp)}", *together, ""]))
    request = ["*NODE PRINT, NSET=ALL_NODES", "U, RF", "*EL PRINT, ELSET=ALL_OF_IT, GLOBAL=YES", "S"]
    dimensions = range(2 if section.startswith("SOLID") else 3)

    def given(numbers):
        return ["*BOUNDARY", *(f"{n}, {i + 1}, {i + 1}, {patch.at(nodes[n])[i]:.13e}" for n in numbers for i in dimensions)]

    _, forces, stresses = solve(folder, include, f"{section}, ELSET=ALL_OF_IT", given(nodes) + request)
    force = {int(row[0]): row[1:] for row in forces}
    inside = largest(force[n] for n in free) / largest(forces_on for n, forces_on in force.items() if n in on_boundary)
    print(f"{label}: {len(nodes)} nodes, forces inside {inside:.1e} of those on the boundary", end="")
    moved, _, stresses_of_it = solve(folder, include, f"{section}, ELSET=ALL_OF_IT", given(on_boundary) + request)
    scale = largest(patch.at(p) for p in nodes.values())
    assert len(moved) == len(nodes)
    off = max(abs(u - v) for n, *row in moved for u, v in zip(row, patch.at(nodes[int(n)]))) / scale
    stress = max(abs(s - t) for row in stresses + stresses_of_it for s, t in zip(row[2:], patch.stress)) / largest([patch.stress])
    print(f", displacements {off:.1e} and stresses {stress:.1e} from exact")
    return (inside < ZERO and off < PRINTED and stress < PRINTED) if exact else off < 0.01


def patch(delquad, folder):
    good = True
    for order in "12":
        inp = mesh(delquad, folder, "plate.toml", PLATE, "plate.inp", "--size", ".1", "--order", order)
        kind = {"1": "CPS4", "2": "CPS8"}[order]
        assert list(elements_of(inp)) == [kind], elements_of(inp).keys()
        good &= check_patch(folder, inp, "SOLID SECTION", Patch([[1, 0, 0], [0, 1, 0]]), kind)
    return good


# Axes of a plane in space.
TILTED = [[2 / 3, 2 / 3, 1 / 3], [-2 / 3, 1 / 3, 2 / 3]]


def tilt(path, out):
    """Wavefront's triangles of a planar mesh, in space."""
    with open(path, encoding="utf-8") as read, open(out, "w", encoding="utf-8") as write:
        for line in read:
            if line.startswith("v "):
                x, y, _ = map(float, line.split()[1:])
                line = "v " + " ".join(repr(x * a + y * b) for a, b in zip(*TILTED)) + "\n"
            if not line.startswith("l "):
                write.write(line)


def shell_patch(delquad, folder):
    """S8R, and S4 on a grid. The S4 of CalculiX 2.20 (a brick with incompatible modes) does not hold a linear field on distorted quads.
    CPS4 holds it on the same ones: there it must be near."""
    good = True
    grid = 'loop = { rectangle = [[0, 0], [2, 1]], region = "plate" }\n'
    for name, text, order, arguments in (("holes", PLATE, "2", []), ("grid", grid, "1", ["--mapped", "auto"]), ("holes", PLATE, "1", [])):
        tilt(mesh(delquad, folder, "plate.toml", text, "plate.obj", "--size", ".1"), os.path.join(folder, "tilted.obj"))
        inp = mesh(delquad, folder, "tilted.obj", "", "tilted.inp", "--size", ".1", "--order", order, *arguments)
        kind = {"1": "S4", "2": "S8R"}[order]
        assert list(elements_of(inp)) == [kind], elements_of(inp).keys()
        good &= check_patch(folder, inp, "SHELL SECTION", Patch(TILTED), f"{kind}, {name}", kind == "S8R" or name == "grid")
    return good


def read_nodes(path, kind):
    """The last result of a kind at the nodes, of a .frd file: values by number."""
    rows, inside = {}, False
    with open(path, encoding="latin-1") as file:
        for line in file:
            if line.startswith(" -4"):
                inside = line.split()[1] == kind
            elif line.startswith(" -3"):
                inside = False
            elif line.startswith(" -1") and inside:
                rows[int(line[3:13])] = [float(line[at:at + 12]) for at in range(13, len(line.rstrip()), 12)]
    return rows


# A quarter of a strip of width 10 with a hole of diameter 2. Stress at the hole over that far away, by
# R. C. J. Howland, On the stresses in the neighborhood of a circular hole in a strip under tension, 1930.
STRIP = """curve = [
  { name = "axis", segment = [[1, 0], [15, 0]] },
  { name = "end", segment = [[15, 0], [15, 5]] },
  { name = "side", segment = [[15, 5], [0, 5]] },
  { name = "middle", segment = [[0, 5], [0, 1]] },
  { name = "hole", arc = { centre = [0, 0], radius = 1, from = 90, to = 0 } },
]
loop = { curves = ["axis", "end", "side", "middle", "hole"], region = "strip" }
size = "min(0.17, 0.014 + 0.055 * (sqrt(x^2 + y^2) - 1))"
"""
HOWLAND = 3.14
THIN = 0.01  # CalculiX makes bricks of plane elements: what varies along the plane must not vary over their thickness


def strip(delquad, folder):
    """As plane stress, by CPS8, and as a shell, by S8R of the same mesh."""
    plane = mesh(delquad, folder, "strip.toml", STRIP, "plane.inp", "--order", "2")
    with open(plane, encoding="utf-8") as file:
        text = file.read()
    shell = os.path.join(folder, "shell.inp")
    with open(shell, "w", encoding="utf-8") as file:
        file.write(text[:text.index("*SURFACE")].replace("TYPE=CPS8", "TYPE=S8R"))
    ends = [name for name in sets_of(plane)["ELSET"] if name.startswith("_end_S")]
    on_shell = ["*DLOAD", *(f"{name}, EDNOR{name[-1]}, {-THIN}" for name in ends)]  # force by length
    good = True
    for kind, inp, section, load in (("CPS8", plane, "SOLID SECTION", ["*DSLOAD", "end, P, -1."]),
                                     ("S8R", shell, "SHELL SECTION", ["strip, 3", *on_shell])):
        solve(folder, inp, f"{section}, ELSET=strip",
              ["*BOUNDARY", "middle, 1", "axis, 2", *load, "*NODE FILE, OUTPUT=2D", "U", "*EL FILE", "S"], THIN)
        stress = read_nodes(os.path.join(folder, "deck.frd"), "STRESS")
        most = max(stress, key=lambda n: stress[n][0])
        x, y, _ = inp_nodes(inp)[most]
        off = stress[most][0] / HOWLAND - 1
        print(f"{kind}: {len(elements_of(inp)[kind])} quads, stress {stress[most][0]:.5g} at ({x:g}, {y:g}): {off:+.2%} from Howland's")
        good &= abs(off) < 0.01 and math.dist((x, y), (0, 1)) < 1e-9
    return good


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def total(rows):
    return [math.fsum(row[k] for row in rows) for k in range(3)]


LOAD = [2.0, 3.0, 5.0]


def shell(delquad, folder):
    """Two pipes, held at the ends of one: what pulls at the other arrives there, with its moment; pressure acts along normals."""
    subprocess.run([delquad, "-q", "example", "pipe_tee", "-o", os.path.join(folder, "tee.step")], check=True, capture_output=True)
    good = True
    for order in "12":
        inp = mesh(delquad, folder, "tee.step", "", "tee.inp", "--size", "6", "--order", order)
        nodes = inp_nodes(inp)
        pulled = members(inp, "NSET", "curve_6")
        each = [x / len(pulled) for x in LOAD]
        held = ["*BOUNDARY", "curve_2, 1, 3", "curve_3, 1, 3"]
        with open(os.path.join(folder, "sets.inp"), "w", encoding="utf-8") as file:
            file.write("*INCLUDE, INPUT=tee.inp\n*ELSET, ELSET=ALL_OF_IT\nregion_1\nregion_2\n*NSET, NSET=ENDS\ncurve_2\ncurve_3\n")
        section, forces = "SHELL SECTION, ELSET=ALL_OF_IT", ["*NODE PRINT, NSET=ENDS", "RF"]
        pull = ["*CLOAD", *(f"{n}, {k + 1}, {each[k]:.13e}" for n in pulled for k in range(3))]
        rows, = solve(folder, os.path.join(folder, "sets.inp"), section, held + pull + forces)
        off = max(abs(a + b) for a, b in zip(total([row[1:] for row in rows]), LOAD)) / max(LOAD)
        moment = total([cross(nodes[n], each) for n in pulled])
        against = total([cross(nodes[int(row[0])], row[1:]) for row in rows])
        turning = max(abs(a + b) for a, b in zip(against, moment)) / max(map(abs, moment))
        rows, = solve(folder, os.path.join(folder, "sets.inp"), section, held + ["*DLOAD", "ALL_OF_IT, P, 1."] + forces, 0.1)
        found, wanted = total([row[1:] for row in rows]), math.pi * 15 ** 2
        print(f"order {order}: forces {off:.1e} and moments {turning:.1e} out of balance, pressure holds {found}, a disc {wanted:.6g}")
        # Circles are polygons at order 1; at the sharp curve the bricks that CalculiX makes of shells overlap, however thin they are.
        good &= off < PRINTED and turning < 10 * PRINTED
        good &= math.dist(found, (0, 0, wanted)) < {"1": 0.04, "2": 0.006}[order] * wanted
    return good


def cell_model(x, periodic):
    """A cell with a hole around (x, 0.5)."""
    text = f"""loop = [
  {{ rectangle = [[0, 0], [2, 1]], boundary = ["bottom", "periodic_1", "top", "left"], region = "cell" }},
  {{ circle = {{ centre = [{x}, 0.5], radius = 0.2 }}, boundary = "hole", hole = true }},
]
size = 0.05
order = 2
"""
    return text + periodic * 'periodic = [{ from = "left", to = "periodic_1", translate = [2, 0] }]\n'


def periodic(delquad, folder):
    """A row of cells, pulled: where the hole is in its cell makes no difference to the force. One cell has equations for its pairs of
    nodes, the other has its hole in the middle, and sides that stay straight. A curve has the name that the pairs' set would have."""
    pull, found = 1e-3, {}
    for x, has_pairs in ((0.5, True), (1.0, False)):
        inp = mesh(delquad, folder, "cell.toml", cell_model(x, has_pairs), "cell.inp")
        nodes = inp_nodes(inp)
        far, lines = max(nodes) + 1, []  # a node whose displacement is the stretch of the cell
        if has_pairs:
            with open(inp, encoding="utf-8") as file:
                pairs = re.findall(r"^\*\* PERIODIC_1_2: (\d+), (\d+)$", file.read(), re.MULTILINE)
            images = members(inp, "NSET", "PERIODIC_1_2")
            assert sorted(int(n) for n, _ in pairs) == images == members(inp, "NSET", "periodic_1") and len(images) > 30
            assert sorted(int(n) for _, n in pairs) == members(inp, "NSET", "PERIODIC_1_MASTER")
            lines = ["*NODE", f"{far}, 0., 0., 0."]
            for node, master in pairs:
                assert math.dist(nodes[int(node)], nodes[int(master)]) == 2 and nodes[int(node)][0] == 2
                lines += ["*EQUATION", "3", f"{node}, 1, 1., {master}, 1, -1., {far}, 1, -1."]
                lines += ["*EQUATION", "2", f"{node}, 2, 1., {master}, 2, -1."]
            fixed = [f"{pairs[0][1]}, 1, 2", f"{far}, 1, 1, {pull}"]
        else:
            fixed = ["left, 1", "periodic_1, 1, 1, %r" % pull, f"{members(inp, 'NSET', 'left')[0]}, 2"]
        with open(os.path.join(folder, "pairs.inp"), "w", encoding="utf-8") as file:
            file.write("\n".join(["*INCLUDE, INPUT=cell.inp", *lines, ""]))
        rows, = solve(folder, os.path.join(folder, "pairs.inp"), "SOLID SECTION, ELSET=cell",
                      ["*BOUNDARY", *fixed, "*NODE PRINT, NSET=left", "RF"], THIN)
        found[has_pairs] = -math.fsum(row[1] for row in rows)
    off = found[True] / found[False] - 1
    print(f"force of a cell with equations {found[True]:.7g}, by symmetry {found[False]:.7g}: {off:+.1e}")
    return abs(off) < 1e-4


BAR = """loop = [
  { rectangle = [[0, 0], [1, 1]], boundary = ["", "", "", "left"], region = "steel" },
  { rectangle = [[1, 0], [2, 1]], boundary = ["", "right", "", "weld"], region = "half as stiff" },
]
embed = [{ point = [0.55, 0.4], name = "sensor" }]
size = 0.11
"""


def materials(delquad, folder):
    """A bar of two materials between smooth walls, pulled: a linear displacement in each, which a sensor and the weld show. Plane
    strain, as a change of types makes it: in plane stress CalculiX's nodes at the weld have one thickness for both materials."""
    good, pull = True, 100.0
    unit = pull * (1 + POISSON) * (1 - 2 * POISSON) / (1 - POISSON) / YOUNG
    for order in "12":
        inp = mesh(delquad, folder, "bar.toml", BAR, "bar.inp", "--order", order)
        with open(inp, encoding="utf-8") as file:
            text = file.read()
        with open(inp, "w", encoding="utf-8") as file:
            file.write(text.replace("TYPE=CPS", "TYPE=CPE"))
        deck = os.path.join(folder, "second.inp")
        with open(deck, "w", encoding="utf-8") as file:
            file.write(f"*INCLUDE, INPUT=bar.inp\n*MATERIAL, NAME=SECOND\n*ELASTIC\n{YOUNG / 2}, {POISSON}\n"
                       f"*SOLID SECTION, ELSET=half_as_stiff, MATERIAL=SECOND\n{THIN}\n")
        names = ["sensor", "weld", "right"]
        blocks = solve(folder, deck, "SOLID SECTION, ELSET=steel",
                       ["*BOUNDARY", "left, 1", "steel, 2", "half_as_stiff, 2", "*DSLOAD", f"right, P, {-pull}",
                        *(line for name in names for line in (f"*NODE PRINT, NSET={name}", "U"))], THIN)
        off = max(abs(row[1] / (x * unit) - 1) for rows, x in zip(blocks, (0.55, 1, 3)) for row in rows)
        print(f"order {order}: {' '.join(str(len(rows)) for rows in blocks)} nodes, displacements {off:.1e} from exact")
        good &= off < PRINTED and len(blocks[0]) == 1 and len(blocks[1]) == len(blocks[2]) > 5
    return good


def pressed(nodes, quads):
    """Forces at the nodes under unit pressure, and the area. The normal of a bilinear quad is bilinear, too: two points a
    direction integrate exactly."""
    forces, area = {}, []
    for quad in quads:
        x = [nodes[n] for n in quad]
        for u in (-3 ** -0.5, 3 ** -0.5):
            for v in (-3 ** -0.5, 3 ** -0.5):
                signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
                along = [math.fsum(s * (1 + t * v) / 4 * p[k] for (s, t), p in zip(signs, x)) for k in range(3)]
                across = [math.fsum(t * (1 + s * u) / 4 * p[k] for (s, t), p in zip(signs, x)) for k in range(3)]
                normal = cross(along, across)
                area.append(math.hypot(*normal))
                for (s, t), n in zip(signs, quad):
                    share = (1 + s * u) * (1 + t * v) / 4
                    forces[n] = [f + share * c for f, c in zip(forces.get(n, (0, 0, 0)), normal)]
    return forces, math.fsum(area)


def outline_of_one_region(inp, elements):
    """Nodes on free edges of the region that has most of these."""
    count = {}
    for quad in elements:
        for i in range(4):
            edge = frozenset((quad[i], quad[i - 1]))
            count[edge] = count.get(edge, 0) + 1
    free = {edge for edge, n in count.items() if n == 1}
    regions = [set(members(inp, "NSET", name)) for name in sets_of(inp)["NSET"] if re.fullmatch(r"region_\d+", name)]
    nodes = max(regions, key=lambda region: sum(edge <= region for edge in free))
    return sorted({n for edge in free if edge <= nodes for n in edge})


def joints(delquad, folder, writer):
    """Glued shells under pressure, held at the outline of one face: the sum of the reactions is pressure times area. The pressure is put on
    as forces at nodes, integrated over the shells' middle surfaces. CalculiX makes bricks of shells, which overlap where shells meet at an
    angle. Its own pressure acts on the outsides of these, whose area differs by as much as a percent."""
    models = subprocess.run([writer, folder], check=True, capture_output=True, text=True).stdout.split("\n")
    good, worst = True, [0.0, 0.0]
    for name, exact, is_flat in (line.split() for line in models if line):
        for kind in ("step", "iges", "brep"):
            inp = mesh(delquad, folder, f"{name}.{kind}", "", "glued.inp", "--glue", "--size", "0.8", "--pipeline", "DB")
            with open(inp, encoding="utf-8") as file:
                text = file.read()
            with open(inp, "w", encoding="utf-8") as file:
                file.write(text.replace("TYPE=CPS4", "TYPE=S4"))  # a model in one plane
            nodes, quads = inp_nodes(inp), elements_of(inp)["S4"]
            forces, area = pressed(nodes, quads)
            held = outline_of_one_region(inp, quads)
            regions = [of for of in sets_of(inp)["ELSET"] if re.fullmatch(r"region_\d+", of)]
            with open(os.path.join(folder, "sets.inp"), "w", encoding="utf-8") as file:
                file.write("\n".join(["*INCLUDE, INPUT=glued.inp", "*ELSET, ELSET=ALL_OF_IT", *regions, "*NSET, NSET=HELD",
                                      *map(str, held), ""]))
            rows, = solve(folder, os.path.join(folder, "sets.inp"), "SHELL SECTION, ELSET=ALL_OF_IT",
                          ["*BOUNDARY", "HELD, 1, 3", "*CLOAD", *(f"{n}, {k + 1}, {f[k]:.13e}" for n, f in forces.items() for k in range(3)),
                           "*NODE PRINT, NSET=HELD", "RF"], 0.1)
            # What is put on held nodes themselves is no reaction to CalculiX.
            reaction = total([row[1:] for row in rows] + [[-f for f in forces[n]] for n in held])
            load = total(forces.values())
            off = math.dist(reaction, [-f for f in load]) / area
            too_large = abs(area / float(exact) - 1) if is_flat == "1" else 0
            if off > PRINTED or too_large > PRINTED:
                print(f"{name}.{kind}: reaction {reaction}, load {load}, area {area}, exact {exact}")
                good = False
            worst = [max(worst[0], off), max(worst[1], too_large)]
    print(f"reactions {worst[0]:.1e} of pressure times area off, plane areas {worst[1]:.1e}")
    return good and worst[0] > 0


def plate_deck(path, move):
    """A clamped plate of 10 x 4 by another program, with numbers of its own; inner nodes are off a grid by `move` of its cells."""
    columns, rows, nodes, elements = 20, 8, [], []
    number = lambda i, j: 101 + 3 * (j * (columns + 1) + i)  # noqa: E731
    for j in range(rows + 1):
        for i in range(columns + 1):
            off = move if 0 < i < columns and 0 < j < rows else 0
            nodes.append(f"{number(i, j)}, {(i + off * math.sin(7 * i + 3 * j)) / 2:.9g}, {(j + off * math.cos(5 * i - 4 * j)) / 2:.9g}, 0.")
            if i < columns and j < rows:
                elements.append(f"{1001 + j * columns + i}, {number(i, j)}, {number(i + 1, j)}, {number(i + 1, j + 1)}, {number(i, j + 1)}")
    deck = ["*NODE, NSET=ALL", *nodes, "*ELEMENT, TYPE=S4, ELSET=PLATE", *elements, "*NSET, NSET=CLAMP, GENERATE",
            f"{number(0, 0)}, {number(0, rows)}, {3 * (columns + 1)}", "*NSET, NSET=TIP, GENERATE",
            f"{number(columns, 0)}, {number(columns, rows)}, {3 * (columns + 1)}", "*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG}, {POISSON}",
            "*SHELL SECTION, ELSET=PLATE, MATERIAL=STEEL", "0.2", "*BOUNDARY", "CLAMP, 1, 6"]
    for load in (["*CLOAD", "TIP, 3, -0.1"], ["*CLOAD, OP=NEW", "*DLOAD", "PLATE, P, 0.01"]):
        deck += ["*STEP", "*STATIC", *load, "*NODE PRINT, NSET=CLAMP, TOTALS=ONLY", "RF", "*NODE PRINT, NSET=TIP", "U", "*END STEP"]
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join([*deck, ""]))


def kept_deck(delquad, folder):
    """`improve` changes the mesh in a deck, and no load: the reactions stay, and the tip sinks as far as on a grid. Moved nodes make
    CalculiX's S4 stiffer, so that the given deck sinks less."""
    found = {}
    for name, move in (("grid", 0), ("moved", 0.25)):
        plate_deck(os.path.join(folder, f"{name}.inp"), move)
    subprocess.run([delquad, "-q", "improve", os.path.join(folder, "moved.inp"), "-o", os.path.join(folder, "better.inp")], check=True)
    for name in ("grid", "moved", "better"):
        run_ccx(folder, name)
        with open(os.path.join(folder, f"{name}.dat"), encoding="utf-8") as file:
            rows = [[float(word) for word in line.split()] for line in file if re.match(r" +-?[0-9]", line)]
        tips = [row[3] for row in rows if len(row) == 4]
        found[name] = [row[2] for row in rows if len(row) == 3] + [sum(tips[:9]) / 9, sum(tips[9:]) / 9]
        print(f"{name}: reactions {found[name][:2]}, tip {found[name][2:]}")
    off = {name: [abs(a / b - 1) for a, b in zip(values, found["grid"])] for name, values in found.items()}
    return max(off["better"][:2]) < 1e-3 and max(off["better"][2:]) < 0.02 < min(off["moved"][2:]) < 0.1


def angle_pairs(thickness, radius=5, length=50, height=25, steps=12):
    """Points of an angle's profile, along it: on its outer side and on its inner side."""
    middle = [((x, 0), (0, 1)) for x in range(0, length, 10)]
    for k in range(steps + 1):
        a = math.pi / 2 * k / steps
        middle.append(((length + radius * math.sin(a), radius * (1 - math.cos(a))), (-math.sin(a), math.cos(a))))
    middle += [((length + radius, radius + z), (-1, 0)) for z in (10, height - radius)]
    return [[(x + side * thickness / 2 * nx, z + side * thickness / 2 * nz) for side in (-1, 1)] for (x, z), (nx, nz) in middle]


def write_angle(path, pairs, width):
    """Triangles of the angle as a solid."""
    points = [(x, y, z) for y in (0, width) for pair in pairs for x, z in pair]
    n = 2 * len(pairs)
    quads = [(0, 1, n + 1, n), (n - 2, 2 * n - 2, 2 * n - 1, n - 1)]
    for i in range(0, n - 2, 2):
        quads += [(i, i + n, i + n + 2, i + 2), (i + 1, i + 3, i + n + 3, i + n + 1), (i, i + 2, i + 3, i + 1),
                  (i + n, i + n + 1, i + n + 3, i + n + 2)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    write_off(path, points, triangles)


def write_off(path, points, triangles):
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"OFF\n{len(points)} {len(triangles)} 0\n")
        file.writelines(" ".join(map(repr, p)) + "\n" for p in points)
        file.writelines("3 " + " ".join(map(str, t)) + "\n" for t in triangles)


def midsurface(delquad, folder):
    """An angle, held at one end: the force that moves the other end by 1, by its mid-surface and by C3D20R, four through the thickness."""
    width, pairs = 20, angle_pairs(2.0)
    write_angle(os.path.join(folder, "angle.off"), pairs, width)
    ends = [[sum(p[k] for p in pairs[i]) / 2 for k in (0, 1)] for i in (0, -1)]
    names = ", ".join(f'{{ as = "{name}", at = [{x}, {width / 2}, {z}] }}' for name, (x, z) in zip(("clamp", "tip"), ends))
    text = f'model = "angle.off"\nsize = 2.5\nsurface = {{ midsurface = true, name = [{names}] }}\n'
    mesh(delquad, folder, "angle.toml", text, "shell.inp")
    outline = [("outer", [p[0] for p in pairs]), ("tip", pairs[-1]), ("inner", [p[1] for p in pairs[::-1]]), ("clamp", pairs[0][::-1])]
    text = "".join(f'[[curve]]\nname = "{name}"\npolyline = {[list(p) for p in line]}\n' for name, line in outline)
    loop = 'size = 0.5\nloop = { curves = ["outer", "tip", "inner", "clamp"] }\ndivide = [{ name = "clamp", edges = 4 }, { name = "tip", edges = 4 }]\n'
    mesh(delquad, folder, "profile.toml", loop + text, "profile.msh")
    extrude(delquad, folder, width, 8)
    return forces_agree(folder, "clamp, 1, 6", "tip, 1, 1, 1.0", "clamp, 1, 3", "tip, 1, 1, 1.0")


def extrude(delquad, folder, length, layers):
    subprocess.run([delquad, "-q", "extrude", os.path.join(folder, "profile.msh"), "--along", f"0,0,{length}", "--layers", str(layers),
                    "--element", "C3D20R", "-o", os.path.join(folder, "solid.inp")], check=True)


def forces_agree(folder, held, moved, solid_held, solid_moved):
    """Whether the forces that move the tip agree to 2 %, of shell.inp and of solid.inp."""
    found = {}
    for name, section, lines in (("shell", [], [held, moved]),
                                 ("solid", ["*SOLID SECTION, ELSET=Eall, MATERIAL=SHEET"], [solid_held, solid_moved])):
        deck = ["*MATERIAL, NAME=SHEET", "*ELASTIC", f"{YOUNG}, {POISSON}", f"*INCLUDE, INPUT={name}.inp", *section, "*BOUNDARY", *lines,
                "*STEP", "*STATIC", f"*NODE PRINT, NSET={lines[1].split(',')[0]}, TOTALS=ONLY", "RF", "*END STEP", ""]
        with open(os.path.join(folder, f"{name}_deck.inp"), "w", encoding="utf-8") as file:
            file.write("\n".join(deck))
        run_ccx(folder, f"{name}_deck")
        with open(os.path.join(folder, f"{name}_deck.dat"), encoding="utf-8") as file:
            rows = [[float(word) for word in line.split()] for line in file if re.match(r" +-?[0-9]", line)]
        found[name] = max(map(abs, rows[0]))
    print(f"forces {found}: that of the shell is {found['shell'] / found['solid']:.4f} of that of the solid")
    return abs(found["shell"] / found["solid"] - 1) < 0.02


def tee(delquad, folder):
    """A beam with the profile of a T, held at one end: the force that moves the other end by 1, against C3D20R."""
    outline, length = [(-10, 0), (10, 0), (10, 2), (1, 2), (1, 17), (-1, 17), (-1, 2), (-10, 2)], 80
    points = [(x, y, z) for y in (0, length) for x, z in outline]
    ends = [(0, 1, 7), (1, 2, 7), (2, 3, 7), (3, 6, 7), (3, 4, 6), (4, 5, 6)]
    triangles = ends + [(c + 8, b + 8, a + 8) for a, b, c in ends]
    for i in range(8):
        j = (i + 1) % 8
        triangles += [(j, i, i + 8), (j, i + 8, j + 8)]
    write_off(os.path.join(folder, "tee.off"), points, triangles)
    names = ", ".join(f'{{ as = "{name}", at = [0, {y}, 8] }}' for name, y in (("clamp", 0), ("tip", length)))
    mesh(delquad, folder, "tee.toml", f'model = "tee.off"\nsize = 1.5\nsurface = {{ midsurface = true, name = [{names}] }}\n', "shell.inp")
    text = f'size = 0.5\nloop = {{ polygon = {[list(p) for p in outline]}, boundary = "outline", region = "tee" }}\n'
    mesh(delquad, folder, "profile.toml", text, "profile.msh")
    extrude(delquad, folder, length, 16)
    return forces_agree(folder, "clamp, 1, 6", "tip, 3, 3, 1.0", "tee_start, 1, 3", "tee_end, 2, 2, 1.0")


PROBLEMS = {f.__name__: f for f in (patch, shell_patch, strip, shell, periodic, materials, kept_deck, midsurface, tee, joints)}


def main():
    needs.program("ccx", "calculix-ccx")
    with tempfile.TemporaryDirectory() as folder:
        return 0 if PROBLEMS[sys.argv[2]](os.path.abspath(sys.argv[1]), folder, *sys.argv[3:]) else 1


if __name__ == "__main__":
    sys.exit(main())
