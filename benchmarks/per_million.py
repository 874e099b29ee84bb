#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures process seconds per million quads, and quality: Delquad's qualities beside Gmsh, QuadriFlow and Instant Meshes.

Each program makes about --quads quads on a plate with holes, on a closed triangulation and on a CAD model, with one thread. It runs
--runs times in turn, from the file read to the file written; the least time counts, or the first above --once seconds. `delquad
metrics` measures its mesh. Gmsh makes quads by frontal-Delaunay for quads and Blossom (8), which leaves triangles. It makes nothing but
quads by halving quads of twice the size (6); a triangle counts as half a quad. QuadriFlow and Instant Meshes begin with a triangulation.
For a CAD model and the plate this is Delquad's F at the same size, whose time does not count. Settings are as in
experiments/peers/adapters. Instant Meshes divides its quads in four, so it gets twice the size. QuadriFlow has
its default flow, since the other one (-mcf) may not end. Missing programs are skipped with a line. --figure draws the seconds on
a logarithmic axis.
"""

import argparse
import itertools
import json
import math
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from run_measured import run
from scale import AREA, MODEL, PLATE_GEO, ROOT

SURFACE_GEO = 'Merge "{}";\nClassifySurfaces{{40 * Pi / 180, 1, 1, Pi}};\nCreateGeometry;\n'
TAKEN = 'ulimit -t "$0"; "$@"; [ $? -le 1 ]'  # 1: Gmsh complained; its mesh is measured
COLOURS = {"delquad": "#0b6e99", "gmsh": "#c2571a", "quadriflow": "#5b8c2a", "instant-meshes": "#7a4fa3"}


def text_of(command):
    done = subprocess.run(command, capture_output=True, text=True)
    return (done.stdout + done.stderr).strip().splitlines()[0]


class Model:
    """A model in the format of each program."""

    def __init__(self, name, path, delquad, folder):
        self.name, self.path, self.delquad, self.folder, self.area = name, path, delquad, folder, AREA
        if name == "plate":
            self.geometry = folder / "plate.geo"
            self.geometry.write_text(PLATE_GEO)
            return
        subprocess.run([delquad, "info", path, "--json", folder / "info.json"], check=True, capture_output=True)
        self.area = json.loads((folder / "info.json").read_text())["area"]
        self.geometry = path
        if name == "surface":
            subprocess.run([delquad, "convert", path, folder / "surface.mesh"], check=True, capture_output=True)
            subprocess.run([delquad, "convert", path, folder / "surface.obj"], check=True, capture_output=True)
            self.geometry = folder / "surface.geo"
            self.geometry.write_text(SURFACE_GEO.format(folder / "surface.mesh"))

    def triangles(self, size):
        if self.name == "surface":
            return self.folder / "surface.obj"
        path = self.folder / f"{self.name}_{size:.6g}.obj"
        if not path.exists():
            subprocess.run([self.delquad, "mesh", self.path, "-o", path, "--size", repr(size), "--pipeline", "F", "--allow-triangles"],
                           check=True, capture_output=True)
        return path


def commands(model, quads, programs, folder):
    """Returns, by the name of a program and its mode, the command and the mesh that it writes."""
    size, out = math.sqrt(model.area / quads), {}
    for program in programs["delquad"]:
        for quality in "fast", "good", "best":
            mesh = folder / f"delquad_{quality}.msh"
            out[f"delquad {quality}"] = [program, "mesh", model.path, "-o", mesh, "--binary", "--size", repr(size), "--quality", quality,
                                         "--threads", "1"], mesh
    for program in programs["gmsh"]:
        version = text_of([program, "--version"])
        for way, algorithm, factor in ("Blossom", "8", 1), ("halved", "6", 2):
            mesh = folder / f"gmsh_{version}_{way}.msh"
            extra = ["-setnumber", "Mesh.SubdivisionAlgorithm", "1"] if way == "halved" else []
            if version.startswith("4.8."):  # crashes where that is on
                extra += ["-setnumber", "Mesh.CrossFieldClosestPoint", "0"]
            out[f"gmsh {version} {way}"] = [program, model.geometry, "-2", "-o", mesh, "-format", "msh41", "-bin", "-nt", "1", "-v", "1",
                                            "-setnumber", "Mesh.Algorithm", algorithm, "-setnumber", "Mesh.RecombineAll", "1",
                                            "-setnumber", "Mesh.RecombinationAlgorithm", "1", "-clmin", repr(factor * size), "-clmax",
                                            repr(factor * size), *extra], mesh
    for program in programs["quadriflow"]:
        if model.name != "plate":  # it does not hold boundaries in the plane
            mesh = folder / "quadriflow.obj"
            out["quadriflow"] = [program, "-sharp", "-boundary", "-f", str(quads), "-i", model.triangles(size), "-o", mesh], mesh
    for program in programs["instant-meshes"]:
        mesh = folder / "instant_meshes.obj"
        out["instant-meshes"] = [program, "-t", "1", "-d", "-b", "-c", "40", "-s", repr(2 * size), "-o", mesh, model.triangles(size)], mesh
    return out


def measure(delquad, mesh, folder):
    done = subprocess.run([delquad, "metrics", mesh, "--json", folder / "metrics.json"], capture_output=True)
    return json.loads((folder / "metrics.json").read_text())["metrics"] if done.returncode == 0 else None


def rows(model, quads, programs, arguments, folder):
    """Returns, by program, seconds, number of runs and measures of its mesh, or the reason of failure."""
    jobs, times, result = commands(model, quads, programs, folder), {}, {}
    for turn in range(arguments.runs):
        for name, (command, mesh) in jobs.items():
            if turn > 0 and (not times[name] or times[name][0] > arguments.once):
                continue
            mesh.unlink(missing_ok=True)
            done = run(["sh", "-c", TAKEN, str(arguments.most), *command])
            times.setdefault(name, []).extend([done[1]] if done else [])
    for name, (_, mesh) in jobs.items():
        metrics = measure(programs["delquad"][0], mesh, folder) if times[name] and mesh.exists() else None
        if metrics is None:
            result[name] = None if times[name] else "failed"
            continue
        made = metrics["n_quads"] + metrics["n_triangles"] / 2
        result[name] = {"model": model.name, "asked": quads, "program": name, "runs": len(times[name]), "seconds": min(times[name]),
                        "per_million": 1e6 * min(times[name]) / made} | {k: metrics[k] for k in (
                            "n_quads", "n_triangles", "eta_mean", "eta_worst", "n_irregular", "n_inverted")}
    return result


def figure(path, records):
    """Draws seconds per million quads: a row for each program, a box for each model; dots grow with the mesh."""
    models, names = list(dict.fromkeys(r["model"] for r in records)), list(dict.fromkeys(r["program"] for r in records))
    low = math.floor(math.log10(min(r["per_million"] for r in records)))
    high = math.ceil(math.log10(max(r["per_million"] for r in records)))
    width, left, step, right = 560, 190, 20, 20
    box = step * len(names) + 44
    counts = sorted({r["asked"] for r in records})
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{left + width + right}" height="{box * len(models) + 34}" font-family="sans-serif" '
           f'font-size="12"><rect width="100%" height="100%" fill="white"/>']

    def x(seconds):
        return left + width * (math.log10(seconds) - low) / (high - low)

    for at, model in enumerate(models):
        top = at * box + 28
        svg.append(f'<text x="{left}" y="{top - 8}" font-weight="bold">{model}</text>')
        for power in range(low, high + 1):
            for k in range(1, 10 if power < high else 2):
                grey = "#999" if k == 1 else "#eee"
                svg.append(f'<path d="M{x(k * 10**power):.1f} {top}v{box - 44}" stroke="{grey}"/>')
            svg.append(f'<text x="{x(10**power):.1f}" y="{top + box - 31}" text-anchor="middle">{10**power:g}</text>')
        for row, name in enumerate(names):
            y = top + step * (row + .5)
            svg.append(f'<text x="{left - 8}" y="{y + 4}" text-anchor="end">{name}</text>')
            for r in records:
                if (r["model"], r["program"]) == (model, name):
                    fill = COLOURS.get(name.split()[0], "#333")
                    svg.append(f'<circle cx="{x(r["per_million"]):.1f}" cy="{y}" r="{4 + 2 * counts.index(r["asked"])}" fill="{fill}" '
                               f'fill-opacity=".6" stroke="{fill}"><title>{r["per_million"]:.3g} s, eta {r["eta_mean"]:.3f}</title></circle>')
    svg.append(f'<text x="{left + width / 2}" y="{box * len(models) + 22}" text-anchor="middle">seconds of process time per million quads '
               f'(dots: {", ".join(f"{c:,}".replace(",", " ") for c in counts)} quads)</text></svg>')
    path.write_text("\n".join(svg) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--delquad", type=Path, default=ROOT / "build/release/delquad")
    parser.add_argument("--gmsh", nargs="*", default=["gmsh"], help="programs: several versions stand side by side")
    parser.add_argument("--quadriflow", default="quadriflow")
    parser.add_argument("--instant-meshes", default="instant-meshes")
    parser.add_argument("--models", nargs="+", default=["plate", "surface", "cad"], choices=["plate", "surface", "cad"])
    parser.add_argument("--surface", type=Path, help="a closed triangulation; default: bunny_adaptive.off of ../shared/data, else a torus")
    parser.add_argument("--cad", type=Path, help="a CAD file; default: the example 'bracket'")
    parser.add_argument("--quads", type=int, nargs="+", default=[50_000, 200_000])
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--once", type=float, default=120, help="seconds: what takes longer is run once")
    parser.add_argument("--most", type=int, default=900, help="processor seconds that a run may take")
    parser.add_argument("--figure", type=Path, help="SVG to draw")
    parser.add_argument("--json", type=Path, help="all numbers")
    arguments = parser.parse_args()
    programs = {"delquad": [arguments.delquad], "gmsh": arguments.gmsh, "quadriflow": [arguments.quadriflow],
                "instant-meshes": [arguments.instant_meshes]}
    for name, paths in programs.items():
        programs[name] = [found for path in paths if (found := shutil.which(path)) or print(f"{name}: skipped, there is no {path}")]
    if not programs["delquad"]:
        return
    delquad, records, os.environ["OMP_NUM_THREADS"] = programs["delquad"][0], [], "1"
    print(f"{text_of([delquad, '--version'])}; {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}, one thread, least of {arguments.runs}\n")
    print("| model | quads asked for | program | seconds a million quads | seconds | runs | quads | triangles | eta mean | eta worst "
          "| irregular | inverted |\n|---|---:|---" + "|---:" * 9 + "|")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        bunny = ROOT.parent / "shared/data/bunny_adaptive.off"
        paths = {"plate": MODEL, "surface": arguments.surface or (bunny if bunny.exists() else folder / "torus.obj"),
                 "cad": arguments.cad or folder / "bracket.step"}
        for example, path in ("bracket", paths["cad"]), ("torus", paths["surface"]):
            if not path.exists():
                subprocess.run([delquad, "example", example, "-o", folder / f"{example}.step"], check=True, capture_output=True)
        if not paths["surface"].exists():
            subprocess.run([delquad, "mesh", folder / "torus.step", "-o", paths["surface"], "--size", ".5", "--pipeline", "F",
                            "--allow-triangles"], check=True, capture_output=True)
        models = [Model(m, paths[m], delquad, folder) for m in arguments.models]
        for quads, model in itertools.product(arguments.quads, models):
            for program, r in rows(model, quads, programs, arguments, folder).items():
                if not isinstance(r, dict):
                    print(f"| {model.name} | {quads} | {program} | {r or 'its mesh cannot be read'} |" + " |" * 8, flush=True)
                    continue
                records.append(r)
                print(f"| {model.name} | {quads} | {program} | {r['per_million']:.3g} | {r['seconds']:.2f} | {r['runs']} |"
                      f" {r['n_quads']:.0f} | {r['n_triangles']:.0f} | {r['eta_mean']:.3f} | {r['eta_worst']:.3f} |"
                      f" {r['n_irregular']:.0f} | {r['n_inverted']:.0f} |", flush=True)
            if arguments.json:
                arguments.json.write_text(json.dumps(records, indent=1) + "\n")
            if arguments.figure and records:
                figure(arguments.figure, records)


if __name__ == "__main__":
    main()
