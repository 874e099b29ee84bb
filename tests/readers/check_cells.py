#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens a mesh of cells of all shapes in another program: check_cells.py DELQUAD READER. Exit code 77: the reader is not installed, see needs.py.

READER: meshio, gmsh, vtk or h5py; they compare numbers and volumes of three cubes with sides 1.
"""
import os
import subprocess
import sys
import tempfile

from check_formats import meshio, numpy
from read_mesh import needs

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


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        {"meshio": by_meshio, "gmsh": by_gmsh, "vtk": by_vtk, "h5py": by_h5py}[sys.argv[2]](sys.argv[1], work)
    print("as written")
