#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens meshes in another program and prints its findings, a line of JSON for each mesh.

read_mesh.py READER FILE... [--dealii PROGRAM]

READER: meshio, gmsh, dolfinx, dealii, ccx or vtk. Prints "refused" and why, or "points", "lines", "triangles", "quads" and "names", if
the reader tells them. Names are listed by dimension, each with the number of its elements. Exit code 77: the reader is not
installed, see needs.py.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import traceback

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import needs  # noqa: E402

SECONDS = 300  # after which another program hangs


def run(command, folder=None):
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=SECONDS, errors="replace")
    if result.returncode != 0:
        raise RuntimeError(f"{command[0]}: exit code {result.returncode}\n{result.stdout[-2000:]}\n{result.stderr[-2000:]}")
    return result.stdout


def read_meshio(path, _):
    meshio = needs.module("meshio", "python3-meshio")
    mesh = meshio.read(path)
    found = {"points": len(mesh.points), "lines": 0, "triangles": 0, "quads": 0, "names": {}}
    kinds = {"line": "lines", "triangle": "triangles", "quad": "quads"}
    for block in mesh.cells:
        found[kinds[block.type]] += len(block.data)
    if path.endswith(".msh"):
        groups = mesh.cell_data["gmsh:physical"]
        assert len(groups) == len(mesh.cells)
        sizes = {}
        for block, tags in zip(mesh.cells, groups):
            for tag in tags.tolist():
                key = (1 if block.type == "line" else 2, tag)
                sizes[key] = sizes.get(key, 0) + 1
        for name, (tag, dim) in mesh.field_data.items():
            found["names"].setdefault(str(dim), {})[name] = sizes[(dim, tag)]
    if path.endswith(".vtu"):
        kinds = {"curve": "1", "region": "2"}
        for title, tags in mesh.field_data.items():
            kind, name = title.split(" ", 1)
            cells = [t for block in mesh.cell_data[kind] for t in block.tolist()]
            found["names"].setdefault(kinds[kind], {})[name] = sum(t in set(tags.tolist()) for t in cells)
    if path.endswith(".inp"):
        sizes = {name: sum(len(part) for part in parts) for name, parts in mesh.cell_sets.items() if name[0] != "_"}
        found["names"]["2"] = sizes
        found["node_sets"] = {name: len(part) for name, part in mesh.point_sets.items()}
        del found["lines"]
    if path.endswith(".obj"):
        del found["lines"]  # which meshio leaves out
    if path.endswith((".obj", ".mesh")):
        del found["names"]
    return found


def read_msh22(path):
    """The contents of Gmsh's file: every element once for each of its groups."""
    found = {"lines": 0, "triangles": 0, "quads": 0, "names": {}}
    kinds = {"1": "lines", "2": "triangles", "3": "quads"}
    names, sizes = {}, {}
    with open(path, encoding="utf-8", errors="replace") as lines:
        for line in lines:
            section = line.strip()
            if section not in ("$PhysicalNames", "$Nodes", "$Elements"):
                continue
            for _ in range(int(next(lines))):
                words = next(lines).split(maxsplit=2 if section == "$PhysicalNames" else -1)
                if section == "$PhysicalNames":
                    names[(words[0], words[1])] = words[2].strip().strip('"')
                if section == "$Nodes":
                    found["points"] = found.get("points", 0) + 1
                if section == "$Elements" and words[1] in kinds:
                    found[kinds[words[1]]] += 1
                    key = ("1" if words[1] == "1" else "2", words[3])
                    sizes[key] = sizes.get(key, 0) + 1
    for key, name in names.items():
        found["names"].setdefault(key[0], {})[name] = sizes[key]
    return found


def read_gmsh(path, _):
    needs.program("gmsh", "gmsh")
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out.msh")
        log = run(["gmsh", path, "-save", "-format", "msh22", "-o", out])
        assert "Error" not in log and "Warning" not in log, log
        found = read_msh22(out)
    if not path.endswith(".msh"):
        del found["names"]
    return found


def read_dolfinx(path, _):
    gmshio = needs.module("dolfinx.io.gmshio", "python3-dolfinx")
    gmsh = needs.module("gmsh", "python3-gmsh")
    from mpi4py import MPI  # dolfinx has both
    import numpy

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.merge(path)
    mesh, cells, facets = gmshio.model_to_mesh(gmsh.model, MPI.COMM_WORLD, 0, gdim=3)
    gmsh.finalize()
    quads = mesh.topology.index_map(2).size_local
    tags = {tag: int(numpy.sum(cells.values == tag)) for tag in set(cells.values.tolist())}
    found = {"points": mesh.topology.index_map(0).size_local, "quads": quads, "tags": {"2": tags}}
    if facets is not None:
        found["lines"] = len(facets.values)
        found["tags"]["1"] = {tag: int(numpy.sum(facets.values == tag)) for tag in set(facets.values.tolist())}
    return found


def read_dealii(path, options):
    if not options.dealii or not os.path.exists(options.dealii):
        needs.skip("libdeal.ii-dev: the program that opens meshes in deal.II was not built")
    return json.loads(run([options.dealii, path]))


def sets_of(path):
    """Names of the sets of an INP file by keyword."""
    sets = {"ELSET": [], "NSET": [], "SURFACE": []}
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            match = re.match(r"\*(ELSET|NSET), (?:ELSET|NSET)=(.*)|\*(SURFACE), NAME=([^,]*)", line)
            if match:
                sets[match[1] or match[3]].append((match[2] or match[4]).strip())
    return sets


def ccx_deck(path, planar):
    """All nodes fixed: only what was read is asked for."""
    sets = sets_of(path)
    regions = [name for name in sets["ELSET"] if re.fullmatch(r"region_\d+", name)]
    deck = [f"*INCLUDE, INPUT={os.path.basename(path)}", "*ELSET, ELSET=ALL_OF_IT", *regions, "*NSET, NSET=ALL_NODES", *regions,
            "*MATERIAL, NAME=STEEL", "*ELASTIC", "210000., .3",
            f"*{'SOLID' if planar else 'SHELL'} SECTION, ELSET=ALL_OF_IT, MATERIAL=STEEL", "1e-3", "*STEP", "*STATIC", "*BOUNDARY",
            "ALL_NODES, 1, 3"]
    for name in sets["ELSET"]:
        deck += [f"*EL PRINT, ELSET={name}, TOTALS=ONLY", "EVOL"]
    for name in sets["NSET"]:
        deck += [f"*NODE PRINT, NSET={name}, TOTALS=ONLY", "RF"]
    return "\n".join(deck + ["*NODE FILE, OUTPUT=2D", "U", "*END STEP", ""])


def run_ccx(folder, name):
    log = run(["ccx", "-i", name], folder)
    assert "*ERROR" not in log and "*WARNING" not in log, log[-3000:]
    return log


def read_frd(path):
    """Coordinates by node, and the number of elements by their number of nodes."""
    nodes, elements, section = {}, {}, ""
    with open(path, encoding="latin-1") as lines:
        for line in lines:
            if line.startswith("    2C") or line.startswith("    3C"):
                section = line.strip()[:2]
            elif line.startswith(" -3"):
                section = ""
            elif section == "2C" and line.startswith(" -1"):
                nodes[int(line[3:13])] = [float(line[13 + 12 * k:25 + 12 * k]) for k in range(3)]
            elif section == "3C" and line.startswith(" -2"):
                n = len(line[3:].split())
                elements[n] = elements.get(n, 0) + 1
    return nodes, elements


def inp_nodes(path):
    nodes, inside = {}, False
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            if line.startswith("*"):
                inside = line.startswith("*NODE")
            elif inside:
                number, *xyz = line.split(",")
                nodes[int(number)] = [float(x) for x in xyz]
                assert all(len(x.strip()) <= 20 for x in xyz), line
    return nodes


def read_ccx(path, _):
    needs.program("ccx", "calculix-ccx")
    with open(path, encoding="utf-8") as text:
        planar = "TYPE=CPS" in text.read()
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(path, folder)
        with open(os.path.join(folder, "deck.inp"), "w", encoding="utf-8") as deck:
            deck.write(ccx_deck(path, planar))
        run_ccx(folder, "deck")
        nodes, elements = read_frd(os.path.join(folder, "deck.frd"))
    written = inp_nodes(path)
    largest = max(abs(x) for xyz in written.values() for x in xyz)
    for number, xyz in written.items():  # .frd has six digits
        assert all(abs(a - b) <= 1e-5 * largest for a, b in zip(xyz, nodes[number])), (number, xyz, nodes[number])
    return {"points": len(nodes), "triangles": elements.get(3, 0), "quads": elements.get(4, 0)}


def read_vtk(path, _):
    vtk = needs.module("vtk", "python3-vtk9")
    reader = vtk.vtkXMLUnstructuredGridReader() if path.endswith(".vtu") else vtk.vtkOBJReader()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *event: errors.append(str(event)))
    reader.SetFileName(path)
    reader.Update()
    assert not errors, errors
    mesh = reader.GetOutput()
    counts = {}
    for i in range(mesh.GetNumberOfCells()):
        counts[mesh.GetCellType(i)] = counts.get(mesh.GetCellType(i), 0) + 1
    lines = counts.get(3, 0) + counts.get(4, 0)
    found = {"points": mesh.GetNumberOfPoints(), "lines": lines, "triangles": counts.get(5, 0), "quads": counts.get(9, 0)}
    if not path.endswith(".vtu"):
        return found
    found["names"] = {}
    fields = mesh.GetFieldData()
    for k in range(fields.GetNumberOfArrays()):
        kind, name = fields.GetArrayName(k).split(" ", 1)
        tags = {fields.GetArray(k).GetValue(i) for i in range(fields.GetArray(k).GetNumberOfTuples())}
        of_cells = mesh.GetCellData().GetArray(kind)
        n = sum(of_cells.GetValue(i) in tags for i in range(of_cells.GetNumberOfTuples()))
        found["names"].setdefault("1" if kind == "curve" else "2", {})[name] = n
    return found


READERS = {"meshio": (read_meshio, ["msh", "bin.msh", "vtu", "obj", "inp", "mesh"]),
           "gmsh": (read_gmsh, ["msh", "bin.msh", "mesh"]),
           "dolfinx": (read_dolfinx, ["msh", "bin.msh"]),
           "dealii": (read_dealii, ["msh", "boundary.msh"]),
           "ccx": (read_ccx, ["inp"]),
           "vtk": (read_vtk, ["vtu", "obj"])}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("reader", choices=READERS)
    parser.add_argument("files", nargs="+")
    parser.add_argument("--dealii", help="the program built from dealii_grid.cpp")
    options = parser.parse_args()
    for file in options.files:
        try:
            found = READERS[options.reader][0](os.path.abspath(file), options)
        except Exception:
            found = {"refused": traceback.format_exc(limit=-3)[-1500:]}
        print("\n" + json.dumps(found), flush=True)  # the program may have left a line open


if __name__ == "__main__":
    main()
