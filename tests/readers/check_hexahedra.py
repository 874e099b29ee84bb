#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens swept hexahedra in another program: check_hexahedra.py DELQUAD READER. Exit code 77: the reader is not installed, see needs.py.

READER: gmsh, meshio, vtk or h5py compare numbers, names and volumes; ccx pulls at a bar by its named faces.
"""
import os
import subprocess
import sys
import tempfile

from check_formats import cut, meshio, numpy, read_cgns, read_med, read_unv, word
from read_mesh import needs, run_ccx
from solve_ccx import POISSON, YOUNG, near

MODEL = """loop = [
  { rectangle = [[0, 0], [2, 1]], boundary = ["floor", "joint", "roof", "left"], region = "steel" },
  { rectangle = [[2, 0], [3, 1]], boundary = ["floor", "far", "roof", "joint"], region = "copper" },
]
embed = [{ point = [2.5, 0.5], name = "sensor" }]
size = 0.25
"""
LAYERS, HEIGHT = 6, 4.0


def sweep(delquad, folder, name, *options):
    """The file, and how many elements its names have, by dimension."""
    model, section, path = (os.path.join(folder, n) for n in ("model.toml", "section.msh", name))
    if not os.path.exists(section):
        with open(model, "w", encoding="utf-8") as file:
            file.write(MODEL)
        subprocess.run([delquad, "mesh", model, "-o", section], check=True, capture_output=True, timeout=120)
    subprocess.run([delquad, "extrude", section, "--along", f"0,0,{HEIGHT}", "--layers", str(LAYERS), "--growth", "1.2", "-o", path, *options],
                   check=True, capture_output=True, timeout=120)
    return path


EXPECTED = {  # by dimension; a side of length 1 has 4 edges
    1: {"sensor": LAYERS},
    2: {"floor": 12 * LAYERS, "roof": 12 * LAYERS, "left": 4 * LAYERS, "far": 4 * LAYERS, "joint": 4 * LAYERS, "steel start": 32, "copper start": 16, "steel end": 32,
        "copper end": 16},
    3: {"steel": 32 * LAYERS, "copper": 16 * LAYERS},
}


def by_gmsh(delquad, folder):
    gmsh = needs.module("gmsh", "python3-gmsh")
    for name, options in (("text.msh", []), ("bytes.msh", ["--binary"])):
        path = sweep(delquad, folder, name, *options)
        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(path)
        found = {1: {}, 2: {}, 3: {}}
        for dim, tag in gmsh.model.getPhysicalGroups():
            entities = gmsh.model.getEntitiesForPhysicalGroup(dim, tag)
            found[dim][gmsh.model.getPhysicalName(dim, tag)] = sum(len(t) for e in entities for t in gmsh.model.mesh.getElements(dim, e)[1])
        kinds = [int(kind) for kind in gmsh.model.mesh.getElements(3)[0]]
        gmsh.finalize()
        assert found == EXPECTED, found
        assert kinds == [5], kinds
    path = sweep(delquad, folder, "a.unv")
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(path)
    volumes = gmsh.model.mesh.getJacobians(5, [0, 0, 0])[1]
    gmsh.finalize()
    assert len(volumes) == 48 * LAYERS and min(volumes) > 0, volumes


def by_meshio(delquad, folder):
    for name in ("a.msh", "a.vtu", "a.inp", "a.e", "a.su2", "a.bdf"):
        try:
            mesh = meshio.read(sweep(delquad, folder, name))
        except ImportError as error:  # of a format's library
            needs.leave_out(f"{name} by python3-meshio: {error}")
            continue
        cells = {}
        for block in mesh.cells:
            cells[block.type] = cells.get(block.type, 0) + len(block.data)
        assert cells["hexahedron"] == 48 * LAYERS, cells
        if name in ("a.msh", "a.vtu"):
            assert cells["quad"] == sum(EXPECTED[2].values()) and cells["line"] == LAYERS, cells
        if name == "a.su2":  # the boundary
            assert cells["quad"] == sum(n for face, n in EXPECTED[2].items() if face != "joint"), cells
        if name == "a.e":
            assert set(mesh.point_sets) == {*EXPECTED[1], *EXPECTED[2]}, mesh.point_sets
            check_side_sets(os.path.join(folder, name), mesh)


SIDES = ((0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (0, 4, 7, 3), (0, 3, 2, 1), (4, 5, 6, 7))  # of HEX8 in Exodus


def check_side_sets(path, mesh):
    """Their sides have the nodes of the node sets of the same names."""
    import netCDF4

    hexahedra = [nodes for block in mesh.cells for nodes in block.data]
    with netCDF4.Dataset(path) as file:
        names = [b"".join(name.compressed()).decode() for name in file["ss_names"][:]]
        assert set(names) == set(EXPECTED[2]), names
        for k, name in enumerate(names, 1):
            sides = list(zip(file[f"elem_ss{k}"][:], file[f"side_ss{k}"][:]))
            nodes = {hexahedra[element - 1][i] for element, side in sides for i in SIDES[side - 1]}
            assert len(sides) == EXPECTED[2][name] * (2 if name == "joint" else 1), name
            assert nodes == set(mesh.point_sets[name]), name


def by_vtk(delquad, folder):
    vtk = needs.module("vtk", "python3-vtk9")
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(sweep(delquad, folder, "a.vtu"))
    reader.Update()
    grid = reader.GetOutput()
    volume, least, counts = 0.0, 1.0, {}
    for i in range(grid.GetNumberOfCells()):
        kind = grid.GetCellType(i)
        counts[kind] = counts.get(kind, 0) + 1
        if kind == vtk.VTK_HEXAHEDRON:
            volume += vtk.vtkMeshQuality.HexVolume(grid.GetCell(i))
            own, theirs = grid.GetCellData().GetArray("scaled Jacobian").GetValue(i), vtk.vtkMeshQuality.HexScaledJacobian(grid.GetCell(i))
            assert abs(own - theirs) < 1e-12, (own, theirs)
            least = min(least, own)
    near(volume, 3 * HEIGHT, 1e-12, "volume")
    assert least > 0.99, least
    assert counts == {vtk.VTK_HEXAHEDRON: 48 * LAYERS, vtk.VTK_QUAD: sum(EXPECTED[2].values()), vtk.VTK_LINE: LAYERS}, counts
    for dim, kind in ((1, "curve"), (2, "face"), (3, "volume")):
        tags = grid.GetCellData().GetArray(kind)
        for name, n in EXPECTED[dim].items():
            of_name = grid.GetFieldData().GetArray(f"{kind} {name}")
            wanted = {of_name.GetValue(i) for i in range(of_name.GetNumberOfTuples())}
            assert sum(tags.GetValue(i) in wanted for i in range(grid.GetNumberOfCells())) == n, name

    if not hasattr(vtk, "vtkCGNSReader"):
        return needs.leave_out("python3-vtk9: it was built without CGNS")
    cgns = vtk.vtkCGNSReader()
    cgns.SetFileName(sweep(delquad, folder, "a.cgns"))
    cgns.UpdateInformation()
    cgns.EnableAllBases()
    cgns.Update()
    grid = cgns.GetOutput().NewIterator().GetCurrentDataObject()
    quality = [vtk.vtkMeshQuality.HexScaledJacobian(grid.GetCell(i)) for i in range(grid.GetNumberOfCells())]
    assert len(quality) == 48 * LAYERS and min(quality) > 0.99, quality


def by_h5py(delquad, folder):
    needs.module("h5py", "python3-h5py")
    # MED counts the first side the other way round.
    for name, read, order in (("a.cgns", read_cgns, range(8)), ("a.unv", read_unv, range(8)), ("a.med", read_med, (0, 3, 2, 1, 4, 7, 6, 5))):
        found = read(sweep(delquad, folder, name))
        rows = {n: [] for n in (2, 4, 8)}
        for group in (found.lines, found.elements):
            for label, of_name in group.items():
                for row in of_name:
                    rows[len(row)].append((label, [int(v) for v in row]))
        for dim, n in ((1, 2), (2, 4), (3, 8)):
            counts = {}
            for label, _ in rows[n]:
                counts[label] = counts.get(label, 0) + 1
            assert counts == {(word if name == "a.unv" else cut)(label): count for label, count in EXPECTED[dim].items()}, (name, counts)
        sides = set()
        volume = 0.0
        for _, row in rows[8]:
            v = [row[k] for k in order]
            p = found.points[v]
            box = numpy.linalg.det([p[1] - p[0], p[3] - p[0], p[4] - p[0]])
            assert box > 0, (name, v)
            volume += box  # all are boxes, or nearly so
            sides |= {frozenset(row[k] for k in side) for side in SIDES}
        assert abs(volume - 3 * HEIGHT) < 0.05 * 3 * HEIGHT, volume
        assert all(frozenset(row) in sides for _, row in rows[4]), name


def by_ccx(delquad, folder):
    needs.program("ccx", "calculix-ccx")
    for element in ("C3D8", "C3D8I", "C3D20"):
        pull_at_bar(delquad, folder, element)


def pull_at_bar(delquad, folder, element):
    path = sweep(delquad, folder, "bar.inp", "--element", element)
    pull = 100.0
    with open(os.path.join(folder, "deck.inp"), "w", encoding="utf-8") as file:
        file.write(f"""*INCLUDE, INPUT={os.path.basename(path)}
*MATERIAL, NAME=M
*ELASTIC
{YOUNG}, {POISSON}
*SOLID SECTION, ELSET=steel, MATERIAL=M
*SOLID SECTION, ELSET=copper, MATERIAL=M
*BOUNDARY
steel_start, 3, 3
copper_start, 3, 3
left, 1, 1
floor, 2, 2
*STEP
*STATIC
*DSLOAD
steel_end, P, {-pull}
copper_end, P, {-pull}
*NODE PRINT, NSET=far
U
*NODE PRINT, NSET=copper_end
U
*END STEP
""")
    run_ccx(folder, "deck")
    blocks = []
    with open(os.path.join(folder, "deck.dat"), encoding="utf-8") as file:
        for line in file:
            if "displacements" in line:
                blocks.append([])
            elif line.strip():
                blocks[-1].append([float(word) for word in line.split()])
    # A side of 4 edges and LAYERS, and one of 4 by 4.
    expected = [5 * (LAYERS + 1), 25] if element != "C3D20" else [5 * (LAYERS + 1) + 4 * (LAYERS + 1) + 5 * LAYERS, 25 + 40]
    assert [len(b) for b in blocks] == expected, [len(b) for b in blocks]
    for _, x, _, _ in blocks[0]:
        near(x, -POISSON * pull / YOUNG * 3, 1e-5, "contraction")
    for _, _, _, z in blocks[1]:
        near(z, pull / YOUNG * HEIGHT, 1e-5, "stretch")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        {"gmsh": by_gmsh, "meshio": by_meshio, "vtk": by_vtk, "h5py": by_h5py, "ccx": by_ccx}[sys.argv[2]](sys.argv[1], work)
    print("as written")
