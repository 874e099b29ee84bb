#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes models, opens what was written in another program and compares numbers of points, elements and names.

check_readers.py --delquad PROGRAM --reader NAME[,NAME] [--dealii PROGRAM] [--size PART] [--mesh ARGUMENT]... [MODEL]...

Without models, some are made: planar with named and with unnamed curves, CAD with and without names, a closed surface. The option
--size is a part of the diagonal; --patience is the seconds after which meshing a model is given up. Prints a line for each file.
Exit code 1 if a file was not opened as it was written, 77 if the reader is not installed.
"""
import argparse
import collections
import json
import os
import subprocess
import sys
import tempfile

from read_mesh import READERS, needs

SECONDS = 330  # a little more than read_mesh.py waits itself


def plate(named):
    names = ', boundary = ["bottom side", "right", "top", "left"], region = "steel"' if named else ""
    hole = ', boundary = "hole", region = "inclusion"' if named else ""
    return f"loop = [{{ rectangle = [[0, 0], [2, 1]]{names} }}, {{ circle = {{ centre = [0.8, 0.5], radius = 0.2 }}{hole} }}]\nsize = 0.1\n"


def tetrahedron():
    points = [(0, 0, 0), (3, 0, 0), (0, 2, 0), (0, 0, 1)]
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    return "OFF\n4 4 6\n" + "".join("%g %g %g\n" % p for p in points) + "".join("3 %d %d %d\n" % f for f in faces)


def make_models(delquad, folder):
    """Names of files with the arguments to mesh them."""
    models = []
    for name, text in (("planar_named.toml", plate(True)), ("planar_unnamed.toml", plate(False)), ("closed.off", tetrahedron())):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
        models.append((os.path.join(folder, name), [] if name.endswith(".toml") else ["--size", ".3"]))
    for example, name, size in (("bracket", "cad_named.STEP", "6"), ("pipe_tee", "cad_unnamed.brep", "6"), ("bracket", "cad_closed.brep", "6")):
        path = os.path.join(folder, name)
        if subprocess.run([delquad, "example", example, "-o", path], capture_output=True, check=False).returncode == 0:
            models.append((path, ["--size", size]))
    return models


def diagonal(delquad, model):
    with tempfile.TemporaryDirectory() as folder:
        record = os.path.join(folder, "info.json")
        subprocess.run([delquad, "info", model, "--json", record], capture_output=True, check=True, timeout=SECONDS)
        with open(record, encoding="utf-8") as text:
            return json.load(text)["diagonal"]


def expected(path):
    """Returns the contents of an MSH file in text, read by hand; further names count for other formats."""
    found = {"points": 0, "lines": 0, "triangles": 0, "quads": 0}
    groups, entities, sizes, more = {}, {}, collections.Counter(), []
    with open(path, encoding="utf-8") as text:
        sections = {part.split("\n", 1)[0]: part.split("\n") for part in text.read().split("\n$")}
    for line in sections.get("PhysicalNames", ["", ""])[2:]:
        dim, tag, name = line.split(" ", 2)
        groups[(dim, tag)] = name.strip('"')
    lines = iter(sections["Entities"][2:])
    for line in lines:
        words = line.split()
        assert words[7] == "1", line
        entities.setdefault("raw", []).append((words[0], words[8]))
    n_curves = int(sections["Entities"][1].split()[1])
    group_of = {("1" if k < n_curves else "2", tag): group for k, (tag, group) in enumerate(entities["raw"])}
    found["points"] = int(sections["Nodes"][1].split()[1])
    rows = iter(sections["Elements"][2:])
    for row in rows:
        dim, tag, kind, n = row.split()
        found[{"1": "lines", "2": "triangles", "3": "quads"}[kind]] += int(n)
        sizes[(dim, group_of[(dim, tag)])] += int(n)
        for _ in range(int(n)):
            next(rows)
    found["names"], found["tags"] = {}, {}
    for (dim, tag), name in groups.items():
        found["names"].setdefault(dim, {})[name] = sizes[(dim, tag)]
        found["tags"].setdefault(dim, {})[tag] = sizes[(dim, tag)]
    return found


def differences(kind, wanted, found, everything):
    """Returns the differences from the written file. Files other than MSH have all lines, and every name."""
    result = []
    for key in ("points", "triangles", "quads", "lines"):
        reference = wanted if kind.endswith("msh") else everything
        if key in found and found[key] != reference[key]:
            result.append(f"{found[key]} {key} for {reference[key]}")
    if "tags" in found:
        for dim, tags in wanted["tags"].items():
            if found["tags"].get(dim, {}) != tags:
                result.append(f"tags of dimension {dim}: {found['tags'].get(dim)} for {tags}")
    if "names" in found and kind.endswith("msh") and found["names"] != wanted["names"]:
        result.append(f"names {found['names']} for {wanted['names']}")
    if "names" in found and kind == "vtu":
        for dim, names in wanted["names"].items():
            for name, n in names.items():
                unnamed = name.startswith(("curve_", "region_"))
                if not unnamed and found["names"].get(dim, {}).get(name, 0) < n:
                    result.append(f"name '{name}' of dimension {dim} in {found['names'].get(dim)}")
    if kind == "inp" and "node_sets" in found:
        for dim, sets in (("1", found["node_sets"]), ("2", found["names"]["2"])):
            n = len([s for s in sets if s.startswith("curve_" if dim == "1" else "region_")])
            if n != everything["entities"][dim]:
                result.append(f"{n} sets of dimension {dim} for {everything['entities'][dim]}")
    return result


def entities(path):
    with open(path, encoding="utf-8") as text:
        for line in text:
            if line.startswith("$Entities"):
                _, curves, regions, _ = next(text).split()
                return {"1": int(curves), "2": int(regions)}
    return {}


def read_files(options, reader, paths):
    """Starts the reader once for all files, and returns its report of each. If it ends early, the rest counts as refused."""
    command = [sys.executable, os.path.join(os.path.dirname(os.path.abspath(__file__)), "read_mesh.py"), reader, *paths]
    if options.dealii:
        command += ["--dealii", options.dealii]
    try:
        result = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False)
        printed, end = result.stdout, result.returncode and f"exit code {result.returncode} {result.stderr.strip()[-1500:]}"
    except subprocess.TimeoutExpired as error:
        printed, end = (error.stdout or b"").decode(), "it hangs"
    else:
        if result.returncode == needs.SKIPPED:
            print(printed.strip())
            sys.exit(needs.SKIPPED)
    found = [json.loads(line) for line in printed.splitlines() if line.startswith("{")]
    if end:
        found = found[:len(paths) - 1]
    return found + [{"refused": end}] * (len(paths) - len(found))


def check_model(options, model, arguments, folder):
    """Whether every file was opened; None: the model was not meshed."""
    stem, name = os.path.join(folder, "mesh"), os.path.basename(model)
    kinds = {"all.msh": ["--curves", "all"], "boundary.msh": ["--curves", "boundary"], "bin.msh": ["--binary"],
             "msh": [], "vtu": [], "obj": [], "inp": [], "mesh": []}
    needed = {"msh", "all.msh", "boundary.msh"} | {k for reader in options.reader.split(",") for k in READERS[reader][1]}
    for kind in sorted(needed):
        command = [options.delquad, "mesh", model, "-o", f"{stem}.{kind}", *arguments, *kinds[kind], *options.mesh]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=options.patience)
        if done.returncode not in (0, 3, 4):
            print(f"{name}: not meshed: {(done.stderr.strip().splitlines() or ['?'])[-1][-200:]}")
            return None
    wanted, boundary, everything = (expected(f"{stem}.{kind}") for kind in ("msh", "boundary.msh", "all.msh"))
    everything["entities"] = entities(f"{stem}.all.msh")
    good = True
    for reader in options.reader.split(","):
        opened = []
        for kind in READERS[reader][1]:
            if reader in ("dolfinx", "dealii") and wanted["triangles"] > 0:
                print(f"{name} {reader} {kind}: skipped, takes no triangles beside quads")
                continue
            if reader == "dealii" and kind == "msh" and wanted["lines"] > boundary["lines"]:
                print(f"{name} {reader} {kind}: skipped, takes no named lines inside the mesh")
                continue
            opened.append(kind)
        for kind, found in zip(opened, read_files(options, reader, [f"{stem}.{kind}" for kind in opened]) if opened else [], strict=True):
            reference = boundary if kind == "boundary.msh" else wanted
            problem = found["refused"] if "refused" in found else "; ".join(differences(kind, reference, found, everything))
            print(f"{name} {reader} {kind}: {problem or 'good'}", flush=True)
            good = good and not problem
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--delquad", required=True)
    parser.add_argument("--reader", required=True)
    parser.add_argument("--dealii")
    parser.add_argument("--size", type=float, default=0.05)
    parser.add_argument("--mesh", action="append", default=["--quality", "fast", "--allow-triangles"])
    parser.add_argument("--patience", type=float, default=120, help="seconds for a mesh")
    parser.add_argument("models", nargs="*")
    options = parser.parse_args()
    good = True
    with tempfile.TemporaryDirectory() as folder:
        if options.models:
            models = []
            for model in options.models:
                try:
                    models.append((model, ["--size", str(options.size * diagonal(options.delquad, model))]))
                except (subprocess.SubprocessError, KeyError) as error:
                    print(f"{os.path.basename(model)}: not read: {str(error)[-200:]}")
        else:
            models = make_models(options.delquad, folder)
        for model, arguments in models:
            try:
                checked = check_model(options, model, arguments, folder)
            except subprocess.TimeoutExpired:
                print(f"{os.path.basename(model)}: not meshed in time")
                checked = None
            # Models of others may be too much; those that are made here are not.
            good = good and (checked or checked is None and bool(options.models))
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
