#!/usr/bin/env python3
"""Times delquad beside Gmsh (Frontal-Delaunay and Blossom) on whole models.

For each model Gmsh's size is tuned until both make as many elements, within 1 % where it can. Then all programs run in
turn, several times, from the file read to the file written; the table shows medians, and how many times as long Gmsh takes
with as many threads. CPU seconds count all threads and are what to look at on a busy machine. What is missing is skipped
with a reason; inf: a program that crashed in most of its runs.
"""

import argparse
import math
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

GMSH_OPTIONS = ["-2", "-algo", "front2d", "-setnumber", "Mesh.RecombineAll", "1",
                "-setnumber", "Mesh.RecombinationAlgorithm", "1", "-v", "1"]
MIRROR_Z = 0.272342  # the Falcon's plane of symmetry
CASES = [  # name, file, delquad's size
    ("part of section 8.1", "cad/pump_carter.stp", 1.915),
    ("the same, coarser", "cad/pump_carter.stp", 3.2),
    ("whole Falcon, uniform", "falcon_half.msh", 0.0827),
]
FALCON_TOML = """model = "{path}"
[surface]
weld_tolerance = 1e-5
mirror = {{ point = [0, 0, {z}], normal = [0, 0, 1], tolerance = 5e-5, join = false }}
compound = [[2, 15], [18, 30], [4, 6], [19, 21], [7, 8], [22, 23]]
"""
FALCON_GEO = """Merge "{path}";
ClassifySurfaces{{40 * Pi / 180, 1, 1, Pi}};
CreateGeometry;
"""


def run(command):
    """Wall and CPU seconds and the peak memory in bytes, of all that the command starts; none when it fails."""
    start = time.perf_counter()
    with open(os.devnull, "w") as nowhere:
        child = subprocess.Popen(command, stdout=nowhere, stderr=nowhere)
        _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        print(f"failed with {child.returncode}: {' '.join(map(str, command))}", file=sys.stderr)
        return None
    return time.perf_counter() - start, usage.ru_utime + usage.ru_stime, 1024 * usage.ru_maxrss


def mirrored(half, whole):
    """Writes both halves of an MSH 2.2 triangulation: nodes and tags of the other one follow."""
    lines = half.read_text().splitlines()
    nodes_at, elements_at = lines.index("$Nodes") + 1, lines.index("$Elements") + 1
    nodes = [line.split() for line in lines[nodes_at + 1:nodes_at + 1 + int(lines[nodes_at])]]
    elements = [line.split() for line in lines[elements_at + 1:elements_at + 1 + int(lines[elements_at])]]
    triangles = [(int(e[3 + int(e[2]) - 1]), [int(v) for v in e[-3:]]) for e in elements if e[1] == "2"]
    shift, tags = max(int(n[0]) for n in nodes), max(tag for tag, _ in triangles)
    out = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(2 * len(nodes))]
    out += [" ".join(n) for n in nodes]
    out += [f"{int(n[0]) + shift} {n[1]} {n[2]} {2 * MIRROR_Z - float(n[3])!r}" for n in nodes]
    out += ["$EndNodes", "$Elements", str(2 * len(triangles))]
    both = triangles + [(tag + tags, [a + shift, c + shift, b + shift]) for tag, (a, b, c) in triangles]
    out += [f"{i} 2 2 {tag} {tag} {a} {b} {c}" for i, (tag, (a, b, c)) in enumerate(both, 1)]
    whole.write_text("\n".join(out + ["$EndElements", ""]))


class Comparison:
    def __init__(self, delquad, name, path, size, folder):
        self.delquad, self.name, self.size, self.folder = delquad, name, size, folder
        self.model = self.gmsh_model = path
        if path.suffix == ".msh":
            self.model, self.gmsh_model = folder / "falcon.toml", folder / "falcon.geo"
            self.model.write_text(FALCON_TOML.format(path=path, z=MIRROR_Z))
            mirrored(path, folder / "falcon.msh")
            self.gmsh_model.write_text(FALCON_GEO.format(path=folder / "falcon.msh"))

    def delquad_command(self, threads, quality="fast"):
        return [self.delquad, "mesh", self.model, "-o", self.folder / "delquad.msh", "--size", str(self.size),
                "--threads", str(threads), "--quality", quality]

    def gmsh_command(self, size, threads, extra=()):
        return ["gmsh", self.gmsh_model, *GMSH_OPTIONS, "-clmin", repr(size), "-clmax", repr(size), "-nt", str(threads),
                "-o", self.folder / "gmsh.msh", *extra]

    def delquad_elements(self):
        text = subprocess.run(self.delquad_command(1), check=True, capture_output=True, text=True).stdout
        return sum(map(int, re.search(r"(\d+) quads, (\d+) triangles", text).groups()))

    def gmsh_elements(self, size):
        if run(self.gmsh_command(size, 1, ["-format", "msh22"])) is None:
            sys.exit("gmsh cannot mesh this model")
        with open(self.folder / "gmsh.msh") as mesh:
            return sum(line.split(maxsplit=2)[1:2] in (["2"], ["3"]) for line in mesh if line.count(" ") > 5)

    def tune(self):
        """Elements wanted, and of Gmsh with its best size: its counts jump, so that 1 % may be out of reach."""
        wanted, size, low, high, tries = self.delquad_elements(), self.size, 0, math.inf, []
        for _ in range(8):
            elements = self.gmsh_elements(size)
            tries.append((abs(elements - wanted), elements, size))
            if tries[-1][0] <= 0.01 * wanted:
                break
            low, high = (size, high) if elements > wanted else (low, size)
            size *= (elements / wanted) ** 0.5
            if not low < size < high:
                size = (low + high) / 2
        return (wanted, *min(tries)[1:])

    def print_table(self, runs):
        wanted, elements, size = self.tune()
        commands = {(f"delquad {quality}", n): self.delquad_command(n, quality) for quality in ("fast", "good") for n in (1, 2)}
        commands |= {("gmsh", n): self.gmsh_command(size, n) for n in (1, 2)}
        times = {key: [] for key in commands}
        for _ in range(runs):
            for key, command in commands.items():
                times[key].append(run(command) or (math.inf, math.inf))
        wall, cpu = ({key: statistics.median(t[i] for t in times[key]) for key in times} for i in (0, 1))
        for program, n in commands:
            key = (program, n)
            print(f"| {self.name} | {program} | {n} | {elements if program == 'gmsh' else wanted} | {wall[key]:.2f} | {cpu[key]:.2f} |"
                  f" {wall['gmsh', n] / wall[key]:.1f} | {cpu['gmsh', n] / cpu[key]:.1f} | {wall[program, 1] / wall[key]:.2f} |",
                  flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    root = Path(__file__).resolve().parent.parent
    parser.add_argument("--delquad", type=Path, default=root / "build/release/delquad")
    parser.add_argument("--data", type=Path, default=root.parent / "shared/data")
    parser.add_argument("--runs", type=int, default=5)
    arguments = parser.parse_args()
    if shutil.which("gmsh") is None:
        return print("skipped: gmsh is not installed")
    if not arguments.delquad.exists():
        return print(f"skipped: {arguments.delquad} is not built")
    version = subprocess.run(["gmsh", "--version"], capture_output=True, text=True)
    print(f"gmsh {(version.stdout + version.stderr).strip()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f},"
          f" medians of {arguments.runs} runs in turn\n")
    print("| model | program | threads | elements | seconds | CPU s | gmsh / it | gmsh / it, CPU | one thread / it |")
    print("|---|---|---:|---:|---:|---:|---:|---:|---:|")
    for name, file, size in CASES:
        path = (arguments.data / file).resolve()
        if not path.exists():
            print(f"| {name} | skipped: {path} not found |")
            continue
        with tempfile.TemporaryDirectory() as folder:
            Comparison(arguments.delquad, name, path, size, Path(folder)).print_table(arguments.runs)


if __name__ == "__main__":
    main()
