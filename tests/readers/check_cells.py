#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens meshes of cells in another program: check_cells.py DELQUAD READER [PROGRAM]. Exit code 77: the reader is not installed, see needs.py.

READER: meshio, gmsh, vtk or h5py, or text, which reads SU2 and MFEM by itself. They compare cells of all shapes in three cubes with sides 1.
dolfinx and dealii open a cube of hexahedra and one of tetrahedra. The PROGRAM of dealii is made of dealii_grid.cpp. ccx pulls at the cube of
tetrahedra, with nodes in the middle of edges.
"""
import json
import os
import subprocess
import sys
import tempfile

from check_formats import meshio, numpy
from read_mesh import inp_nodes, needs
from solve_ccx import POISSON, solve

POINTS = [(x, y, z) for z in (0, 1, 2) for y in (0, 1) for x in (0, 1, 2)]
POINTS[14] = (1.5, 0.5, 0.5)
HEXAHEDRON = [(0, 1, 4, 3, 6, 7, 10, 9)]
PRISMS = [(6, 13, 7, 9, 16, 10), (6, 12, 13, 9, 15, 16)]
PYRAMIDS = [(1, 2, 5, 4, 14), (7, 10, 11, 8, 14), (1, 7, 8, 2, 14), (4, 5, 11, 10, 14), (1, 4, 10, 7, 14)]
TETRAHEDRA = [(2, 8, 5, 14), (5, 8, 11, 14)]
SHAPES = {"hexahedron": (5, HEXAHEDRON), "wedge": (6, PRISMS), "pyramid": (7, PYRAMIDS), "tetra": (4, TETRAHEDRA)}  # with the types of Gmsh


def convert(delquad, folder, name):
    source, path = (os.path.join(folder, n) for n in ("mixed.msh", name))
    if not os.path.exists(source):
        cells = [(kind, nodes) for kind, all_nodes in SHAPES.values() for nodes in all_nodes]
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "1", '3 1 "body"', "$EndPhysicalNames", "$Nodes", str(len(POINTS))]
        lines += [f"{i} {x} {y} {z}" for i, (x, y, z) in enumerate(POINTS, 1)]
        lines += ["$EndNodes", "$Elements", str(len(cells))]
        lines += [f"{i} {kind} 2 1 1 {' '.join(str(v + 1) for v in nodes)}" for i, (kind, nodes) in enumerate(cells, 1)]
        with open(source, "w", encoding="utf-8") as file:
            file.write("\n".join(lines + ["$EndElements", ""]))
    subprocess.run([delquad, "convert", source, path], check=True, capture_output=True, timeout=120)
    return path


def volume(kind, points):
    """The volume of a cell in the order of Gmsh with flat sides; negative if it is inverted."""
    sides = {"tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)),
             "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
             "wedge": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
             "hexahedron": ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))}[kind]
    return sum(numpy.linalg.det([points[side[0]], points[side[k]], points[side[k + 1]]]) / 6 for side in sides for k in range(1, len(side) - 1))


def expect_cells(cells, points, orders=None, name=""):
    """`cells`: nodes by shape; `orders`: the nodes of each shape in the order of Gmsh."""
    total = 0.0
    for kind, (_, expected) in SHAPES.items():
        rows = [row for shape, row in cells if shape == kind]
        assert len(rows) == len(expected), (name, kind, len(rows))
        volumes = [volume(kind, points[[row[k] for k in (orders or {}).get(kind, range(len(row)))]]) for row in rows]
        assert min(volumes) > 0, (name, kind, volumes)
        total += sum(volumes)
    assert abs(total - 3) < 1e-9, (name, total)


VTK_ORDER = {"wedge": (0, 2, 1, 3, 5, 4)}


def by_meshio(delquad, folder):
    for name, orders in (("a.msh", None), ("a.vtu", None), ("a.e", None), ("a.su2", VTK_ORDER), ("a.ugrid", None), ("a.b8.ugrid", None)):
        try:
            mesh = meshio.read(convert(delquad, folder, name))
        except ImportError as error:  # of a format's library
            needs.leave_out(f"{name} by python3-meshio: {error}")
            continue
        cells = [(block.type, row) for block in mesh.cells for row in block.data]
        expect_cells(cells, mesh.points, orders, name)
        if name != "a.e":
            assert sum(kind in ("quad", "triangle") for kind, _ in cells) == 17, name


def by_gmsh(delquad, folder):
    gmsh = needs.module("gmsh", "python3-gmsh")
    for name in ("a.msh", "a.msh2"):
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.merge(convert(delquad, folder, name))
        _, places, _ = gmsh.model.mesh.getNodes()
        tags = {tag: i for i, tag in enumerate(gmsh.model.mesh.getNodes()[0])}
        kinds = {kind: shape for shape, (kind, _) in SHAPES.items()}
        cells = []
        for kind, _, nodes in zip(*gmsh.model.mesh.getElements(3)):
            n = len(SHAPES[kinds[kind]][1][0])
            cells += [(kinds[kind], [tags[v] for v in row]) for row in numpy.reshape(nodes, (-1, n))]
        groups = [gmsh.model.getPhysicalName(*group) for group in gmsh.model.getPhysicalGroups(3)]
        gmsh.finalize()
        expect_cells(cells, numpy.reshape(places, (-1, 3)), None, name)
        assert groups == ["body"], groups


def by_vtk(delquad, folder):
    vtk = needs.module("vtk", "python3-vtk9")
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(convert(delquad, folder, "a.vtu"))
    reader.Update()
    grid = reader.GetOutput()
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    volumes = sizes.GetOutput().GetCellData().GetArray("Volume")
    solids = [i for i in range(grid.GetNumberOfCells()) if grid.GetCell(i).GetCellDimension() == 3]
    assert abs(sum(volumes.GetValue(i) for i in solids) - 3) < 1e-9
    for i in solids:  # the faces of each cell look outwards
        cell = grid.GetCell(i)
        points = numpy.array([cell.GetPoints().GetPoint(k) for k in range(cell.GetNumberOfPoints())])
        for f in range(cell.GetNumberOfFaces()):
            a, b, c = [numpy.array(cell.GetFace(f).GetPoints().GetPoint(k)) for k in range(3)]
            assert numpy.dot(numpy.cross(b - a, c - a), a - points.mean(axis=0)) > 0, (cell.GetClassName(), f)


def by_h5py(delquad, folder):
    h5py = needs.module("h5py", "python3-h5py")
    med = {"HE8": ("hexahedron", (0, 3, 2, 1, 4, 7, 6, 5)), "PE6": ("wedge", (0, 2, 1, 3, 5, 4)), "PY5": ("pyramid", (0, 3, 2, 1, 4)),
           "TE4": ("tetra", (0, 2, 1, 3))}
    with h5py.File(convert(delquad, folder, "a.med"), "r") as file:
        mesh = next(iter(next(iter(file["ENS_MAA"].values())).values()))
        points = numpy.array(mesh["NOE/COO"]).reshape(3, -1).T
        cells = [(shape, row - 1) for key, (shape, _) in med.items() for row in numpy.array(mesh["MAI"][key]["NOD"]).reshape(len(med[key][1]), -1).T]
    expect_cells(cells, points, dict(med.values()), "a.med")
    cgns = {17: "hexahedron", 14: "wedge", 12: "pyramid", 10: "tetra"}
    with h5py.File(convert(delquad, folder, "a.cgns"), "r") as file:
        zone = file["Base/Zone1"]
        points = numpy.stack([numpy.array(zone[f"GridCoordinates/Coordinate{axis}/ data"]) for axis in "XYZ"], axis=1)
        cells = []
        for node in zone.values():
            if node.attrs.get("label", b"") != b"Elements_t" or node[" data"][0] not in cgns:
                continue
            shape = cgns[node[" data"][0]]
            cells += [(shape, row - 1) for row in numpy.array(node["ElementConnectivity/ data"]).reshape(-1, len(SHAPES[shape][1][0]))]
    expect_cells(cells, points, None, "a.cgns")


def numbers_after(path, *keys):
    """The rows of numbers behind lines that begin with each key, without empty lines and comments."""
    with open(path, encoding="utf-8") as file:
        lines = [line.strip() for line in file if line.strip() and line[0] not in "%#"]
    for key in keys:
        at = next(i for i, line in enumerate(lines) if line.startswith(key)) + 1
        rows = []
        while at < len(lines) and not lines[at][0].isalpha():
            rows.append([float(word) for word in lines[at].split()])
            at += 1
        yield rows


def by_text(delquad, folder):
    path = convert(delquad, folder, "a.su2")
    kinds = {12: "hexahedron", 13: "wedge", 14: "pyramid", 10: "tetra"}
    cells, points = numbers_after(path, "NELEM=", "NPOIN=")
    assert [int(row[-1]) for row in cells + points] == [*range(len(cells)), *range(len(points))]
    rows = [(kinds[int(row[0])], [int(v) for v in row[1:-1]]) for row in cells]
    expect_cells(rows, numpy.array(points)[:, :3], VTK_ORDER, "a.su2")
    with open(path, encoding="utf-8") as file:
        assert sum(int(line.split()[1]) for line in file if line.startswith("MARKER_ELEMS=")) == 17

    cells, sides, points = numbers_after(convert(delquad, folder, "a.mfem"), "elements", "boundary", "vertices")
    kinds = {5: "hexahedron", 6: "wedge", 7: "pyramid", 4: "tetra", 3: "quad", 2: "triangle"}
    assert (cells.pop(0), sides.pop(0), points[:2]) == ([10], [17], [[17], [3]])
    rows = [(kinds[int(row[1])], [int(v) for v in row[2:]]) for row in cells]
    points = numpy.array(points[2:])
    expect_cells(rows, points, None, "a.mfem")
    skin = [points[[int(v) for v in row[2:]]] for row in sides]  # looks outwards and is closed
    assert abs(sum(numpy.linalg.det([x[0], x[k], x[k + 1]]) / 6 for x in skin for k in range(1, len(x) - 1)) - 3) < 1e-9


def cube(delquad, folder, name, *options, n=3):
    """A cube with sides 1, n quads along each edge, that is filled."""
    path, index = os.path.join(folder, "cube.obj"), {}
    faces = []
    for axis in range(3):
        for end in (0, n):
            for i in range(n):
                for j in range(n):
                    corners = [(end, i, j), (end, i + 1, j), (end, i + 1, j + 1), (end, i, j + 1)]
                    turned = [corner[3 - axis:] + corner[:3 - axis] for corner in corners]
                    faces.append([index.setdefault(corner, len(index) + 1) for corner in (turned if end else turned[::-1])])
    with open(path, "w", encoding="utf-8") as file:
        file.writelines("v {} {} {}\n".format(*(x / n for x in corner)) for corner in index)
        file.writelines("f {} {} {} {}\n".format(*face) for face in faces)
    subprocess.run([delquad, "volume", "--from", path, "-o", os.path.join(folder, name), *options], check=True, capture_output=True, timeout=120)
    return os.path.join(folder, name)


def single_kinds(delquad, folder):
    """Files of one kind of cells, and how many cells and sides on the skin they have."""
    yield cube(delquad, folder, "hexahedra.msh"), 27, 54
    tetrahedra = cube(delquad, folder, "tetrahedra.msh", "--cells", "tets")
    yield tetrahedra, sum(len(block.data) for block in meshio.read(tetrahedra).cells if block.type == "tetra"), 108


def by_dolfinx(delquad, folder):
    gmsh = needs.module("gmsh", "python3-gmsh")
    gmshio = needs.module("dolfinx.io.gmshio", "python3-dolfinx")
    import ufl  # dolfinx has these
    from dolfinx import fem
    from mpi4py import MPI
    for path, n_cells, n_sides in single_kinds(delquad, folder):
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.merge(path)
        mesh, cells, sides = gmshio.model_to_mesh(gmsh.model, MPI.COMM_WORLD, 0, gdim=3)
        gmsh.finalize()
        assert (len(cells.values), len(sides.values)) == (n_cells, n_sides), path
        volume = fem.assemble_scalar(fem.form(fem.Constant(mesh, 1.0) * ufl.dx))
        assert abs(volume - 1) < 1e-9, (path, volume)


def by_dealii(delquad, folder, program=""):
    if not os.path.exists(program):
        needs.skip("libdeal.ii-dev: the program that opens meshes in deal.II was not built")
    for path, n_cells, n_sides in single_kinds(delquad, folder):
        done = subprocess.run([program, path, "3"], check=True, capture_output=True, text=True, timeout=120)
        found = json.loads(done.stdout)
        assert (found["quads"], sum(found["tags"]["1"].values())) == (n_cells, n_sides), (path, found)


def by_ccx(delquad, folder):
    path = cube(delquad, folder, "cube.inp", "--cells", "tets", "--element", "C3D10")
    nodes = inp_nodes(path)
    near = [[number for number, x in nodes.items() if x[axis] < 1e-9] for axis in range(3)]
    far = [number for number, x in nodes.items() if x[0] > 1 - 1e-9]
    lines = [f"*BOUNDARY\n{number}, {axis + 1}" for axis in range(3) for number in near[axis]] + [f"*BOUNDARY\n{number}, 1, 1, 0.01" for number in far]
    blocks = solve(folder, "cube.inp", ["*SOLID SECTION, ELSET=Eall, MATERIAL=STEEL"], [*lines, "*NODE PRINT, NSET=Nall", "U"])
    assert len(blocks[0]) == len(nodes)
    for number, *u in blocks[0]:  # a bar that is pulled: the field is linear
        x = nodes[int(number)]
        assert all(abs(u[k] - (0.01 if k == 0 else -0.01 * POISSON) * x[k]) < 1e-7 for k in range(3)), (number, u)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        {"meshio": by_meshio, "gmsh": by_gmsh, "vtk": by_vtk, "h5py": by_h5py, "text": by_text, "dolfinx": by_dolfinx, "dealii": by_dealii,
         "ccx": by_ccx}[sys.argv[2]](sys.argv[1], work, *sys.argv[3:])
    print("as written")
