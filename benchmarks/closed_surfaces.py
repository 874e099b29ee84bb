#!/usr/bin/env python3
"""Meshes smooth closed surfaces with delquad and with QuadriFlow, as it is in Blender, at equal numbers of quads.

A torus and a sphere are made here; scans are from the data folder. delquad has the size-aware field, as --quality best. Its size is tuned until
the first word makes the wanted number of quads, within 3 %; QuadriFlow is asked for as many faces as that made. `delquad metrics` measures all meshes
alike. Seconds are on the clock: of delquad meshing, of QuadriFlow the remeshing alone. "before": irregular vertices before Q ran once more with other
cuts. What is missing is skipped with a reason.
"""

import argparse
import json
import math
import shutil
import subprocess
import tempfile
from pathlib import Path
from statistics import mean

MEASURES = ("n_quads", "n_irregular", "eta_mean", "eta_worst", "n_inverted", "d4", "tau")
ROOT = Path(__file__).resolve().parent.parent
CASES = [  # name, file in the data folder or None
    ("torus", None),
    ("sphere", None),
    ("bunny", "bunny_adaptive.off"),
    ("cow", "hard/igl_cow.off"),
]
REMESH = """
import bpy, sys, time
source, target, count = sys.argv[-3:]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.obj(filepath=source, axis_forward="Y", axis_up="Z")
bpy.context.view_layer.objects.active = bpy.context.selected_objects[0]
start = time.perf_counter()
bpy.ops.object.quadriflow_remesh(mode="FACES", target_faces=int(count), use_preserve_sharp=True, use_preserve_boundary=True)
print("seconds", time.perf_counter() - start)
bpy.ops.export_scene.obj(filepath=target, use_materials=False, use_normals=False, use_uvs=False, axis_forward="Y", axis_up="Z")
"""


def torus(rings=96, sides=40, radius=1.0, tube=0.4):
    def point(i, j):
        u, v = 2 * math.pi * i / rings, 2 * math.pi * j / sides
        r = radius + tube * math.cos(v)
        return r * math.cos(u), r * math.sin(u), tube * math.sin(v)
    points = [point(i, j) for i in range(rings) for j in range(sides)]
    triangles = []
    for i in range(rings):
        for j in range(sides):
            a, b, c, d = (k % rings * sides + l % sides for k, l in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
            triangles += [(a, b, c), (a, c, d)]
    return points, triangles


def sphere(rounds=4):
    """An icosahedron, whose triangles are divided in four."""
    g = (1 + math.sqrt(5)) / 2
    points = [p for s in (1, -1) for t in (g, -g) for p in ((0, s, t), (s, t, 0), (t, 0, s))]
    near = lambda p, q: math.dist(p, q) < 2.1
    triangles = []
    for a, p in enumerate(points):
        for b in range(a + 1, 12):
            for c in range(b + 1, 12):
                q, r = points[b], points[c]
                if near(p, q) and near(q, r) and near(r, p):
                    out = (p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) + p[2] * (q[0] * r[1] - q[1] * r[0])) > 0
                    triangles.append((a, b, c) if out else (a, c, b))
    for _ in range(rounds):
        middles, finer = {}, []
        def middle(a, b):
            if (key := (min(a, b), max(a, b))) not in middles:
                middles[key] = len(points)
                points.append(tuple((x + y) / 2 for x, y in zip(points[a], points[b])))
            return middles[key]
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        triangles = finer
    return [tuple(x / math.hypot(*p) for x in p) for p in points], triangles


def read_off(path):
    numbers = iter(" ".join(line.split("#")[0] for line in path.read_text().splitlines()).split()[1:])
    n_points, n_faces, _ = (int(next(numbers)) for _ in range(3))
    points = [tuple(float(next(numbers)) for _ in range(3)) for _ in range(n_points)]
    return points, [tuple(int(next(numbers)) for _ in range(int(next(numbers)))) for _ in range(n_faces)]


def write_obj(path, points, triangles):
    path.write_text("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points)
                    + "".join("f " + " ".join(str(v + 1) for v in t) + "\n" for t in triangles))


class Case:
    def __init__(self, delquad, model, folder, options):
        self.delquad, self.model, self.folder = delquad, model, folder
        self.options = [a for option in options for a in ("--set", option)]

    def run(self, word, size):
        """The record of a word; None where it made no sound mesh."""
        record = self.folder / "record.json"
        record.unlink(missing_ok=True)
        subprocess.run([self.delquad, "mesh", self.model, "-o", self.folder / "mesh.obj", "--size", repr(size), "--pipeline", word,
                        "--cross", "size-aware", *self.options, "--threads", "1", "--json", record], capture_output=True)
        if not record.exists():
            return None
        return json.loads(record.read_text())

    def tuned_size(self, word, wanted, area):
        size = math.sqrt(area / wanted)
        for _ in range(4):
            record = self.run(word, size)
            quads = record["metrics"]["n_quads"] if record else wanted
            if abs(quads / wanted - 1) < 0.03:
                break
            size *= math.sqrt(quads / wanted)
        return size

    def quadriflow(self, wanted):
        script, target = self.folder / "remesh.py", self.folder / "quadriflow.obj"
        script.write_text(REMESH)
        target.unlink(missing_ok=True)
        run = subprocess.run(["blender", "-b", "--python", script, "--", self.model, target, str(wanted)], capture_output=True, text=True)
        if not target.exists():
            return None, None
        seconds = [float(line.split()[1]) for line in run.stdout.splitlines() if line.startswith("seconds ")]
        return target, seconds[0] if seconds else math.nan

    def metrics(self, mesh, size):
        record = self.folder / "metrics.json"
        subprocess.run([self.delquad, "metrics", mesh, "--size", repr(size), "--json", record], capture_output=True, check=True)
        return json.loads(record.read_text())["metrics"]


def area_of(points, triangles):
    total = 0
    for a, b, c in triangles:
        u, w = ([points[k][i] - points[a][i] for i in range(3)] for k in (b, c))
        total += math.hypot(u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]) / 2
    return total


def row(name, program, values, seconds, before=""):
    print(f"| {name} | {program} | {values['n_quads']:.0f} | {before} | {values['n_irregular']:.0f} | {values['eta_mean']:.3f} | {values['eta_worst']:.2f} |"
          f" {values['n_inverted']:.0f} | {values['d4']:.1f} | {values['tau']:.1f} | {seconds:.1f} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--delquad", type=Path, default=ROOT / "build/release/delquad")
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared/data")
    parser.add_argument("--quads", type=int, nargs="+", default=[2000, 8000])
    parser.add_argument("--words", nargs="+", default=["DBCO", "DBCQO", "DLBCO"])
    parser.add_argument("--cases", nargs="+", default=[name for name, _ in CASES])
    parser.add_argument("--sizes", type=int, default=1, help="means over so many sizes, each 3 %% larger than the one before")
    parser.add_argument("--set", nargs="+", default=[], metavar="OPTION=VALUE", help="options of delquad")
    parser.add_argument("--alone", action="store_true", help="without QuadriFlow")
    arguments = parser.parse_args()
    arguments.delquad = arguments.delquad.resolve()
    if not arguments.delquad.exists():
        return print(f"skipped: {arguments.delquad} is not built")
    has_blender = not arguments.alone and shutil.which("blender") is not None
    if not has_blender and not arguments.alone:
        print("QuadriFlow is skipped: blender is not installed\n")
    print("| surface | program | quads | before | irregular | eta mean | eta worst | inverted | d4 | tau | seconds |")
    print("|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|")
    for name, file in CASES:
        if name not in arguments.cases:
            continue
        path = arguments.data / file if file else None
        if path and not path.exists():
            print(f"| {name} | skipped: {path} not found |")
            continue
        surface = read_off(path) if path else {"torus": torus, "sphere": sphere}[name]()
        with tempfile.TemporaryDirectory() as folder:
            model = Path(folder) / "model.obj"
            write_obj(model, *surface)
            case = Case(arguments.delquad, model, Path(folder), arguments.set)
            for wanted in arguments.quads:
                size = case.tuned_size(arguments.words[0], wanted, area_of(*surface))
                made = wanted
                for word in arguments.words:
                    records = [case.run(word, size * 1.03**k) for k in range(arguments.sizes)]
                    if None in records:
                        print(f"| {name} | {word} | failed |")
                        continue
                    values = {key: mean(record["metrics"][key] for record in records) for key in MEASURES}
                    before = [record["across_cuts"]["irregular_before"] for record in records if "across_cuts" in record]
                    row(name, word, values, mean(record["meshing_seconds"] for record in records), f"{mean(before):.0f}" if before else "")
                    if word == arguments.words[0]:
                        made = round(values["n_quads"])
                if has_blender:
                    mesh, seconds = case.quadriflow(made)
                    if mesh is None:
                        print(f"| {name} | QuadriFlow | failed |")
                    else:
                        row(name, "QuadriFlow", case.metrics(mesh, size), seconds)


if __name__ == "__main__":
    main()
