#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes meshes in the formats of solvers and reads them by their libraries. Compares nodes, elements and names with the MSH file of the
same mesh.

check_formats.py PROGRAM

Models: planar with two materials and a sensor, at orders 1 and 2, and a closed surface. Exit code 1 when one differs, 77 when meshio is not installed. Formats whose library is not installed are left out.
"""
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

from read_mesh import needs

numpy = needs.module("numpy", "python3-numpy")
meshio = needs.module("meshio", "python3-meshio")

PLATE = """loop = [
  { rectangle = [[0, 0], [2, 1]], boundary = ["bottom side", "right", "top (free)", "left absorbing"], region = "steel" },
  { circle = { centre = [0.8, 0.5], radius = 0.2 }, boundary = "interface", region = "a name of a region that is longer than thirty-two letters" },
]
embed = [{ point = [1.5, 0.5], name = "sensor" }]
size = 0.2
"""
CURVES = ("bottom side", "right", "top (free)", "left absorbing", "interface")
TETRAHEDRON = "OFF\n4 4 6\n0 0 0\n3 0 0\n0 2 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"


class Found:
    """Points, elements of four to nine nodes, lines of two or three, and items by name: what a file holds."""

    def __init__(self, points):
        points = numpy.asarray(points, float)
        self.points = points if points.shape[1] == 3 else numpy.c_[points, numpy.zeros(len(points))]
        self.elements, self.lines, self.points_of = {}, {}, {}
        self.some_lines = False  # the format has only some of the names

    def add(self, kind, name, nodes):
        kind.setdefault(name, []).extend(tuple(int(v) for v in row) for row in nodes)


def read_msh(path):
    mesh = meshio.read(path)
    found = Found(mesh.points)
    name_of = {(dim, tag): name for name, (tag, dim) in mesh.field_data.items()}
    for block, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
        dim = {"vertex": 0, "line": 1, "line3": 1}.get(block.type, 2)
        for row, tag in zip(block.data, tags):
            found.add((found.points_of, found.lines, found.elements)[dim], name_of[(dim, tag)], [row])
    return found


def read_exodus(path):
    netCDF4 = needs.module("netCDF4", "python3-netcdf4")
    data = netCDF4.Dataset(path)

    def names(variable, n):
        return [bytes(row.compressed()).decode().strip("\0") for row in data.variables[variable][:]] if n else []

    found = Found(numpy.array([data.variables["coord" + axis][:] for axis in "xyz" if "coord" + axis in data.variables]).T)
    numbers = []
    for k, name in enumerate(names("eb_names", True)):
        connect = data.variables[f"connect{k + 1}"]
        assert connect.elem_type.startswith("QUAD"), connect.elem_type
        numbers += [row - 1 for row in connect[:]]
        found.add(found.elements, name, connect[:] - 1)
    for k, name in enumerate(names("ns_names", "ns_names" in data.variables)):
        found.points_of[name] = sorted((int(v),) for v in data.variables[f"node_ns{k + 1}"][:] - 1)
    for k, name in enumerate(names("ss_names", "ss_names" in data.variables)):
        for element, side in zip(data.variables[f"elem_ss{k + 1}"][:] - 1, data.variables[f"side_ss{k + 1}"][:] - 1):
            row = numbers[element]
            ends = [row[side], row[(side + 1) % 4]] + ([row[4 + side]] if len(row) > 4 else [])
            found.add(found.lines, name, [ends])
    return found


def read_cgns(path):
    h5py = needs.module("h5py", "python3-h5py")
    data = h5py.File(path)["Base"]["Zone1"]
    found = Found(numpy.array([data["GridCoordinates"]["Coordinate" + axis][" data"][:] for axis in "XYZ"
                               if "Coordinate" + axis in data["GridCoordinates"]]).T)
    kinds = {3: ("lines", 2), 4: ("lines", 3), 7: ("elements", 4), 9: ("elements", 9), 17: ("elements", 8)}
    for name, section in data.items():
        if section.attrs.get("label", b"").decode() != "Elements_t":
            continue
        kind, n = kinds[int(section[" data"][0])]
        found.add(getattr(found, kind), name, section["ElementConnectivity"][" data"][:].reshape(-1, n) - 1)
    for name, condition in data["ZoneBC"].items() if "ZoneBC" in data else []:
        if isinstance(condition, h5py.Group) and "PointList" in condition:
            found.points_of[name] = [(int(v) - 1,) for v in condition["PointList"][" data"][:].ravel()]
    return found


def read_med(path):
    h5py = needs.module("h5py", "python3-h5py")
    file = h5py.File(path)
    step = next(iter(file["ENS_MAA"]["mesh"].values()))
    n = int(step["NOE"]["COO"].attrs["NBR"])
    found = Found(step["NOE"]["COO"][:].reshape(-1, n).T)
    names = {}
    for families in file["FAS"]["mesh"].values():
        for family in families.values() if "NUM" not in families.attrs else []:
            text = bytes(numpy.asarray(family["GRO"]["NOM"][0], numpy.int8).view(numpy.uint8)).split(b"\0")[0].decode().strip()
            names[int(family.attrs["NUM"])] = text
    for v, family in enumerate(step["NOE"]["FAM"][:]):
        if family:
            found.add(found.points_of, names[int(family)], [(v,)])
    for kind, cells in step["MAI"].items():
        count = int(cells["NOD"].attrs["NBR"])
        rows = cells["NOD"][:].reshape(-1, count).T - 1
        for row, family in zip(rows, cells["FAM"][:]):
            found.add(found.lines if kind.startswith("SE") else found.elements, names[int(family)], [row])
    return found


def read_xdmf(path):
    h5py = needs.module("h5py", "python3-h5py")
    tree = xml.etree.ElementTree.parse(path)
    names = {info.get("Name"): info.get("Value") for info in tree.iter("Information")}

    def item(node):
        file, name = node.find("DataItem").text.split(":")
        return h5py.File(os.path.join(os.path.dirname(path), file))[name][:]

    found = None
    for grid in tree.iter("Grid"):
        found = found or Found(item(grid.find("Geometry")))
        attribute = grid.find("Attribute")
        kind = found.lines if attribute.get("Name") == "curve" else found.elements
        for row, number in zip(item(grid.find("Topology")), item(attribute)):
            found.add(kind, names[f"{attribute.get('Name')} {number}"], [row])
    return found


def read_vtk(path):
    vtk = needs.module("vtk", "python3-vtk9")
    reader = vtk.vtkUnstructuredGridReader()
    reader.SetFileName(path)
    reader.ReadAllFieldsOn()
    reader.ReadAllScalarsOn()
    reader.Update()
    grid = reader.GetOutput()
    found = Found([grid.GetPoint(i) for i in range(grid.GetNumberOfPoints())])
    fields, names = grid.GetFieldData(), {}
    for k in range(fields.GetNumberOfArrays()):
        kind, name = fields.GetArrayName(k).split("_", 1)
        names[(kind, int(fields.GetArray(k).GetTuple1(0)))] = name
    for i in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(i)
        kind = "curve" if cell.GetCellDimension() == 1 else "region"
        tag = int(grid.GetCellData().GetArray(kind).GetTuple1(i))
        row = [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]
        found.add(found.lines if kind == "curve" else found.elements, names.get((kind, tag), f"{kind}_{tag}"), [row])
    return found


def named_comments(path, pattern):
    with open(path, encoding="utf-8") as text:
        return {key: name for key, name in re.findall(pattern, text.read(), re.MULTILINE)}


def read_su2(path):
    mesh = meshio.read(path)
    found = Found(mesh.points)
    with open(path, encoding="utf-8") as text:
        tags = re.findall(r"MARKER_TAG= (.*)\nMARKER_ELEMS= (\d+)\n((?:3 .*\n)*)", text.read())
    for tag, n, rows in tags:
        assert int(n) == rows.count("\n")
        found.add(found.lines, tag, [row.split()[1:] for row in rows.splitlines()])
    for block in mesh.cells:
        if block.type == "quad":
            found.add(found.elements, "", block.data)
    return found


def read_2dm(path):
    """By Aquaveo's description of the format: cards of a letter code, and node strings whose last node is negative."""
    with open(path, encoding="utf-8") as text:
        cards = [line.split(maxsplit=1) for line in text]
    assert cards[0] == ["MESH2D"]
    found = Found([[float(x) for x in rest.split()[1:]] for card, *rest in cards if card == "ND" for rest in rest])
    materials = {number: word(name.strip()[1:-1]) for card, *rest in cards if card == "MAT" for number, name in [rest[0].split(maxsplit=1)]}
    for card, *rest in cards:
        if card in ("E3T", "E4Q"):
            _, *nodes, material = rest[0].split()
            assert len(nodes) == int(card[1])
            found.add(found.elements, materials[material], [[int(v) - 1 for v in nodes]])
        if card == "NS":
            *nodes, last, name = rest[0].split()
            nodes = [int(v) - 1 for v in nodes] + [-int(last) - 1]
            found.add(found.lines, name, zip(nodes, nodes[1:]))
    return found


def read_gr3(path):
    """By SCHISM's manual, "Horizontal grid": Fortran reads the first numbers of each line."""
    with open(path, encoding="utf-8") as text:
        lines = text.read().splitlines()[1:]
    rows = iter(lines)
    n_elements, n_nodes = (int(word) for word in next(rows).split())
    found = Found([[float(x) for x in next(rows).split()[1:4]] for _ in range(n_nodes)])
    for _ in range(n_elements):
        _, n, *nodes = (int(word) for word in next(rows).split())
        assert n == len(nodes)
        found.add(found.elements, "", [[v - 1 for v in nodes]])
    for _ in ("open", "land"):
        n_pieces, n_all = int(next(rows).split()[0]), int(next(rows).split()[0])
        for _ in range(n_pieces):
            head = next(rows)
            n = int(head.split()[0])
            nodes = [int(next(rows)) - 1 for _ in range(n)]
            n_all -= n
            found.add(found.lines, head.split(" boundary ")[1], zip(nodes, nodes[1:] + nodes[:1] if "island" in head else nodes[1:]))
        assert n_all == 0
    assert next(rows, None) is None
    return found


def read_ugrid(path):
    """By the UGRID conventions 1.0: everything that the topology variable names is there, and edges are edges of faces."""
    netCDF4 = needs.module("netCDF4", "python3-netcdf4")
    data = netCDF4.Dataset(path)
    assert "UGRID-1.0" in data.Conventions
    topology, = (v for v in data.variables.values() if getattr(v, "cf_role", "") == "mesh_topology")
    assert topology.topology_dimension == 2

    def connectivity(role, dimension):
        variable = data.variables[getattr(topology, role)]
        assert variable.cf_role == role and variable.dimensions[0] == dimension and variable.start_index == 1
        return [[int(v) - 1 for v in row.compressed()] for row in numpy.ma.asarray(variable[:])]

    def names(variable):
        meanings = dict(zip(variable.flag_values.tolist(), variable.flag_meanings.split(" ")))
        assert variable.mesh == topology.name and len(meanings) == len(variable.flag_values)
        return [meanings[v] for v in variable[:].tolist()]

    coordinates = [data.variables[name] for name in topology.node_coordinates.split()]
    assert [v.standard_name for v in coordinates] == ["projection_x_coordinate", "projection_y_coordinate"]
    assert all(v.dimensions == (topology.node_dimension,) and v.units for v in coordinates)
    found = Found(numpy.array([v[:] for v in coordinates]).T)
    faces, edges, beside = (connectivity(role, dimension) for role, dimension in (("face_node_connectivity", topology.face_dimension), (
        "edge_node_connectivity", topology.edge_dimension), ("edge_face_connectivity", topology.edge_dimension)))
    sides = {}
    for f, face in enumerate(faces):
        for a, b in zip(face, face[1:] + face[:1]):
            sides.setdefault(frozenset((a, b)), []).append(f)
    assert {frozenset(edge): sorted(at) for edge, at in zip(edges, beside)} == sides and len(edges) == len(sides)
    for face, name in zip(faces, names(data.variables["mesh2d_face_region"])):
        found.add(found.elements, name, [face])
    for edge, name in zip(edges, names(data.variables["mesh2d_edge_curve"])):
        if name != "none":
            found.add(found.lines, name, [edge])
    for v, name in enumerate(names(data.variables["mesh2d_node_point"])):
        if name != "none":
            found.add(found.points_of, name, [(v,)])
    return found


def read_re2(path):
    """By Nek5000's reader (core/reader_re2.f): a header of 80 letters, a tag for the order of bytes, and 8 bytes for each number or code."""
    with open(path, "rb") as file:
        header, tag, data = file.read(80).decode(), file.read(4), file.read()
    n, dim, n_fluid = int(header[5:14]), int(header[14:17]), int(header[17:26])
    assert header[:5] == "#v002" and dim == 2 and n == n_fluid and abs(numpy.frombuffer(tag, numpy.float32)[0] - 6.54321) < 1e-6
    corners = numpy.frombuffer(data, float, 9 * n).reshape(n, 9)[:, 1:].reshape(n, 2, 4).transpose(0, 2, 1)
    at, sides = 72 * n, []
    for _ in ("curves", "conditions"):
        count = int(numpy.frombuffer(data, float, 1, at)[0])
        rows = numpy.frombuffer(data, "7f8, S8", count, at + 8)
        sides.append({(int(row[0]) - 1, int(row[1]) - 1): (row[2:], code.decode().rstrip()) for row, code in rows})
        at += 8 + 64 * count
    assert at == len(data)
    curves, conditions = sides
    points = [list(corners[e]) + [curves[e, k][0][:2] if (e, k) in curves else (corners[e, k] + corners[e, (k + 1) % 4]) / 2 for k in range(4)] for e in range(n)]
    assert all(code == "m" for _, code in curves.values())
    found = Found(numpy.array(points).reshape(-1, 2))
    found.add(found.elements, "", numpy.arange(8 * n).reshape(n, 8)[:, :8 if curves else 4])
    for (e, k), (values, code) in conditions.items():
        row = [8 * e + k, 8 * e + (k + 1) % 4] + ([8 * e + 4 + k] if curves else [])
        found.add(found.lines, f"{code} {values[4]:.0f}", [row])
    # Conditions have numbers in the place of names: the numbers of the names in the order of the mesh.
    found.lines = {word(name): rows for name, (_, rows) in zip(CURVES[:4], sorted(found.lines.items()), strict=True)}
    return found


def read_specfem(path):
    """By SPECFEM2D's reader (meshfem2D/read_external_mesh_files.F90)."""
    with open(path, encoding="utf-8") as text:
        keys = dict(line.split(" = ") for line in text.read().splitlines() if not line.startswith("#"))

    def rows(key):
        with open(os.path.join(os.path.dirname(path), keys[key].removeprefix("./DATA/")), encoding="utf-8") as text:
            return [[float(item) for item in line.split()] for line in text]

    def counted(key):
        (count,), *rest = rows(key)
        assert count == len(rest)
        return rest

    found = Found(counted("nodes_coords_file"))
    found.some_lines = True
    names = named_comments(path, r"^# material (\d+): (.*)$")
    elements = [[int(v) - 1 for v in row] for row in counted("mesh_file")]
    assert {len(row) for row in elements} == {int(keys["NGNOD"])}
    for row, (material,) in zip(elements, rows("materials_file"), strict=True):
        found.add(found.elements, names[str(int(material))], [row])
    for key, name in (("free_surface_file", "top (free)"), ("absorbing_surface_file", "left absorbing")):
        assert counted(key)
        for e, two, a, b, *side in counted(key):
            assert two == 2 and {a - 1, b - 1} <= set(elements[int(e) - 1][:4]) and side in ([], [4])
            found.add(found.lines, name, [[int(a) - 1, int(b) - 1]])
    return found


def read_foam(path):
    """By VTK: cells one thick, of which the lower faces are the elements, and patches, of which the lower edges are lines."""
    vtk = needs.module("vtk", "python3-vtk9")
    reader = vtk.vtkOpenFOAMReader()
    reader.SetFileName(path)
    reader.UpdateInformation()
    reader.EnableAllPatchArrays()
    reader.ReadZonesOn()
    reader.Update()
    found, pieces = None, []

    def visit(block, name):
        for k in range(block.GetNumberOfBlocks()):
            piece, label = block.GetBlock(k), block.GetMetaData(k).Get(vtk.vtkCompositeDataSet.NAME())
            if piece is None:
                continue
            if piece.IsA("vtkMultiBlockDataSet"):
                visit(piece, label)
            else:
                pieces.append((name, label, piece))

    visit(reader.GetOutput(), "")
    points = []
    for _, label, piece in pieces:
        first, lowest = len(points), piece.GetBounds()[4]
        points += [piece.GetPoint(i) for i in range(piece.GetNumberOfPoints())]
        found = found or Found([[0, 0]])
        for i in range(piece.GetNumberOfCells()):
            cell = piece.GetCell(i)
            row = [first + cell.GetPointId(k) for k in range(cell.GetNumberOfPoints()) if abs(piece.GetPoint(cell.GetPointId(k))[2] - lowest) < 1e-9]
            volume = cell.GetCellDimension() == 3
            assert len(row) * 2 == cell.GetNumberOfPoints() or label == "frontAndBack"
            if label != "frontAndBack":
                found.add(found.elements if volume else found.lines, label, [row])
    found.points = numpy.array(points)
    return found


def read_bdf(path):
    mesh = meshio.read(path, file_format="nastran")
    found = Found(mesh.points)
    names = named_comments(path, r"^\$ property (\d+): (.*)$")
    for block, properties in zip(mesh.cells, mesh.cell_data["nastran:ref"]):
        for row, number in zip(block.data, properties):
            found.add(found.elements, names[str(int(number))], [row])
    return found


def read_mfem(path):
    """By MFEM's description of its format: attribute, kind, corners; places of corners or, of all elements, of their nodes."""
    with open(path, encoding="utf-8") as text:
        content = text.read()
    regions, curves = named_comments(path, r"^# attribute (\d+): (.*)$"), named_comments(path, r"^# boundary attribute (\d+): (.*)$")
    words = iter(re.sub(r"#.*", "", content).split("\n\n", 1)[1].split())
    sections = {"elements": [], "boundary": []}
    corners, points = 0, None
    for word in words:
        if word in sections:
            for _ in range(int(next(words))):
                attribute, kind = int(next(words)), int(next(words))
                sections[word].append((attribute, [int(next(words)) for _ in range({1: 2, 3: 4}[kind])]))
        elif word == "vertices":
            corners = int(next(words))
            if "\nnodes\n" not in content:
                dim = int(next(words))
                points = [[float(next(words)) for _ in range(dim)] for _ in range(corners)]
        elif word == "Ordering:":
            next(words)
            values = [float(word) for word in words]
            dim = int(re.search(r"VDim: (\d)", content)[1])
            rows = numpy.array(values).reshape(len(sections["elements"]), -1, dim)
            order = int(round(rows.shape[1] ** .5)) - 1
            # Nodes that elements share have the same place.
            places, index = numpy.unique(rows.reshape(-1, dim), axis=0, return_inverse=True)
            index = index.reshape(len(rows), -1)
            corner = [0, order, -1, -1 - order]
            place_of = {v: index[e][corner[k]] for e, (_, row) in enumerate(sections["elements"]) for k, v in enumerate(row)}
            found = Found(places)
            square = [0, 2, 8, 6, 1, 5, 7, 3, 4]
            for e, (attribute, _) in enumerate(sections["elements"]):
                found.add(found.elements, regions[str(attribute)], [index[e][square]])
            for attribute, row in sections["boundary"]:
                found.add(found.lines, curves[str(attribute)], [[place_of[v] for v in row]])
            return found
    found = Found(points)
    for attribute, row in sections["elements"]:
        found.add(found.elements, regions[str(attribute)], [row])
    for attribute, row in sections["boundary"]:
        found.add(found.lines, curves[str(attribute)], [row])
    return found


def read_k(path):
    with open(path, encoding="utf-8") as text:
        parts = [part.splitlines() for part in text.read().split("*")]
    cards = {}
    for part in parts:
        if part:
            cards.setdefault(part[0], []).append([line for line in part[1:] if not line.startswith("$")])
    nodes = cards["NODE"][0]
    found = Found([[float(line[8 + 16 * k:24 + 16 * k]) for k in range(3)] for line in nodes])
    names = {int(lines[1]): lines[0] for lines in cards["PART"]}
    for line in cards["ELEMENT_SHELL"][0]:
        _, part, *row = [int(line[8 * k:8 * k + 8]) for k in range(6)]
        found.add(found.elements, names[part], [[v - 1 for v in row]])
    for lines in cards.get("SET_NODE_LIST_TITLE", []):
        found.points_of[lines[0]] = sorted((int(line[10 * k:10 * k + 10]) - 1,) for line in lines[2:] for k in range(len(line) // 10))
    return found


def read_unv(path):
    datasets = {}
    with open(path, encoding="utf-8") as file:
        for part in file.read().split("    -1\n"):
            if part.strip():
                first, *lines = part.splitlines()
                datasets[int(first)] = lines
    numbers = lambda line: [int(line[k:k + 10]) for k in range(0, len(line), 10)]  # noqa: E731
    nodes = datasets[2411]
    assert [numbers(line)[0] for line in nodes[::2]] == list(range(1, len(nodes) // 2 + 1))
    found = Found([[float(line[k:k + 25]) for k in (0, 25, 50)] for line in nodes[1::2]])
    rows, lines = {}, iter(datasets[2412])
    for line in lines:
        number, kind, _, _, _, n = numbers(line)
        if kind == 11:
            next(lines)
        rows[number] = [v - 1 for v in numbers(next(lines))]
        assert (kind, n) in ((11, 2), (91, 3), (94, 4), (115, 8)) and len(rows[number]) == n
    lines = iter(datasets[2467])
    for line in lines:
        name, n, items = next(lines), numbers(line)[7], []
        while len(items) < 4 * n:
            items += numbers(next(lines))
        for kind, number in zip(items[::4], items[1::4]):
            if kind == 7:
                found.add(found.points_of, name, [(number - 1,)])
            else:
                found.add(found.lines if len(rows[number]) == 2 else found.elements, name, [rows[number]])
    return found


def places(found, rows, digits):
    """Sorted places of the nodes of each element, rounded: the same whatever the numbering."""
    return sorted(tuple(sorted(tuple(numpy.round(found.points[v], digits) + 0.0) for v in row)) for row in rows)


def differences(found, wanted, planar_boundary_only, digits, label):
    result = []
    for kind in ("elements", "lines"):
        have, want = getattr(found, kind), getattr(wanted, kind)
        if kind == "lines" and not have:
            continue  # the format has node sets in their place
        for name, rows in want.items():
            text = label(name)
            if kind == "lines" and (planar_boundary_only and name == "interface" or found.some_lines and text not in have):
                continue
            mine = have.get(text, have.get("")) if kind == "elements" else have.get(text)
            if "" in have and kind == "elements":
                rows = [row for all_rows in want.values() for row in all_rows]
            if mine is None:
                result.append(f"no {kind} '{text}' in {sorted(have)}")
                continue
            n = min(len(mine[0]), len(rows[0]))
            twice = kind == "lines" and len(mine) == 2 * len(rows)  # a side of both elements
            a = places(found, [row[:n] for row in mine], digits)
            b = places(wanted, [row[:n] for row in rows], digits)
            if twice:
                a = a[::2]
            if a != b:
                result.append(f"{kind} '{text}' are others: {len(mine)} for {len(rows)}")
    for name, rows in wanted.points_of.items():
        if found.points_of and places(found, rows[:0], digits) != places(found, found.points_of.get(label(name), [None])[:0], digits):
            result.append(f"point '{name}'")
        if found.points_of and places(found, found.points_of[label(name)], digits) != places(wanted, rows, digits):
            result.append(f"point '{name}' is elsewhere")
    return result


def plain(name):
    return re.sub(r"[^A-Za-z0-9_]", "_", name)


def word(name):
    return re.sub(r"[^A-Za-z0-9_.+@-]", "_", name)


def cut(name):
    return name[:22]


# Reader, whether it has order 2, digits of coordinates, how names are changed, whether it has lines of the boundary alone.
FORMATS = {"e": (read_exodus, True, 12, str, False), "cgns": (read_cgns, True, 12, cut, False), "med": (read_med, True, 12, str, False),
           "xdmf": (read_xdmf, True, 12, str, False), "vtk": (read_vtk, True, 12, lambda name: name.replace(" ", "_"), False),
           "su2": (read_su2, False, 12, plain, True), "bdf": (read_bdf, True, 9, str, False),
           "mfem": (read_mfem, True, 12, str, True), "unv": (read_unv, False, 12, lambda name: word(name)[:30], False), "k": (read_k, False, 6, str, False),
           "2dm": (read_2dm, False, 12, word, False), "gr3": (read_gr3, False, 12, str, True), "nc": (read_ugrid, False, 12, word, False),
           "re2": (read_re2, True, 12, word, True), "specfem": (read_specfem, True, 12, str, True), "foam": (read_foam, False, 5, plain, True)}
PLANAR = ("su2", "2dm", "gr3", "nc", "re2", "specfem", "foam")


def mesh(program, model, out, arguments, order):
    """Meshes the model; returns the error of the program, empty if it made the mesh."""
    made = subprocess.run([program, "mesh", model, "-o", out, "--order", str(order), *arguments], capture_output=True, text=True, check=False)
    return made.stderr.strip() if made.returncode else ""


def check(program, folder, model, arguments, order, kind, wanted):
    """Returns the differences to the written mesh; None if the format cannot hold it."""
    reader, has_curved, digits, label, boundary_only = FORMATS[kind]
    if order > 1 and not has_curved or kind in PLANAR and model.endswith(".off"):
        return None
    path = os.path.join(folder, f"{os.path.splitext(os.path.basename(model))[0]}_{order}.{kind}")
    failure = mesh(program, model, path, arguments, order)
    if "built without the library" in failure:
        return needs.leave_out(failure)
    if failure:
        return "not made: " + failure
    try:
        return "; ".join(differences(reader(path), wanted, boundary_only, digits, label))
    except SystemExit:  # which says why
        return None


def main():
    program, failed = sys.argv[1], 0
    with tempfile.TemporaryDirectory() as folder:
        for name, text, arguments in (("plate.toml", PLATE, []), ("closed.off", TETRAHEDRON, ["--size", ".5"])):
            model = os.path.join(folder, name)
            with open(model, "w", encoding="utf-8") as file:
                file.write(text)
            for order in (1, 2):
                reference = os.path.join(folder, "reference.msh")
                failure = mesh(program, model, reference, arguments, order)
                if failure:
                    sys.exit(failure)
                for kind in FORMATS:
                    wrong = check(program, folder, model, arguments, order, kind, read_msh(reference))
                    if wrong is None:
                        continue
                    print(f"{name}, order {order}, {kind}: {wrong or 'as it was written'}")
                    failed += bool(wrong)
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
