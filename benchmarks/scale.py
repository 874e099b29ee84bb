#!/usr/bin/env python3
"""The whole word at 10^5, 10^6 and 10^7 triangles: seconds of every stage and peak memory, beside Gmsh.

Meshes the plate with 16 holes by DB (or --word), with one thread and with all cores, and prints a table; rows below it have the power
of the number of triangles by which each stage grows. Gmsh (Frontal-Delaunay for quads, Blossom, one thread) gets the same
model and size, up to --gmsh-most triangles; it is skipped where it is not installed. Sizes for which the machine has too
little memory are skipped with a reason.
"""

import argparse
import json
import math
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from compare_gmsh import run

ROOT = Path(__file__).resolve().parent.parent
MODEL = ROOT / "experiments/models/plate_16_holes.toml"
AREA = 4 - 16 * math.pi * 0.14**2
MOST_BYTES = 800  # of memory that a triangle may take: what is asked for before a size is begun
PLATE_GEO = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 2};
For i In {0:15}
  Disk(2 + i) = {.25 + .5 * (i % 4), .25 + .5 * Floor(i / 4), 0, .14};
EndFor
BooleanDifference{ Surface{1}; Delete; }{ Surface{2:17}; Delete; }
"""


def delquad(program, word, size, threads, folder):
    """Seconds by stage and of the whole program, peak memory in bytes, triangles that were merged; None when it fails."""
    record = folder / "record.json"
    done = run([program, "mesh", MODEL, "-o", folder / "mesh.msh", "--binary", "--size", repr(size), "--pipeline", word,
                "--threads", str(threads), "--json", record])
    if done is None:
        return None
    result = json.loads(record.read_text())
    return result["seconds"] | {"whole": done[0]}, done[2], result["recombination"]["triangles"]


def gmsh(size, folder):
    """Seconds and peak memory in bytes; None when it fails."""
    geometry = folder / "plate.geo"
    geometry.write_text(PLATE_GEO)
    done = run(["gmsh", geometry, "-2", "-setnumber", "Mesh.Algorithm", "8", "-setnumber",
                "Mesh.RecombineAll", "1", "-setnumber", "Mesh.RecombinationAlgorithm", "1", "-clmin", repr(size), "-clmax",
                repr(size), "-nt", "1", "-bin", "-v", "1", "-o", folder / "gmsh.msh"])
    return done and (done[0], done[2])


def powers(rows):
    """By stage, the slope of the logarithm of its seconds from the first to the last row."""
    (first, _, n), (last, _, m) = rows[0], rows[-1]
    return {stage: math.log(last[stage] / first[stage]) / math.log(m / n) for stage in first
            if stage in last and min(first[stage], last[stage]) > 0}


def print_rows(program, word, counts, threads, folder):
    rows = []
    for count in counts:
        free = os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        if free < MOST_BYTES * count:
            print(f"| {count} | skipped: {free / 2**30:.1f} GiB of memory are too few |")
            continue
        row = delquad(program, word, math.sqrt(2 * AREA / count), threads, folder)
        if row is None:
            continue
        seconds, memory, triangles = row
        if not rows:
            stages = list(seconds)
            print("\n| triangles | threads | " + " | ".join(stages) + " | bytes a triangle |")
            print("|---:" * (len(stages) + 3) + "|")
        rows.append(row)
        print(f"| {triangles} | {threads} | " + " | ".join(f"{seconds[s]:.3g}" for s in stages)
              + f" | {memory / triangles:.0f} |", flush=True)
    if len(rows) > 1:
        power = powers(rows)
        print("| power | | " + " | ".join(f"{power[s]:.2f}" if s in power else "" for s in stages) + " | |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--delquad", type=Path, default=ROOT / "build/release/delquad")
    parser.add_argument("--word", default="DB")
    parser.add_argument("--counts", type=float, nargs="+", default=[1e5, 1e6, 1e7], help="of triangles")
    parser.add_argument("--threads", type=int, nargs="+", default=sorted({1, os.cpu_count()}))
    parser.add_argument("--gmsh-most", type=float, default=1e6, help="triangles that Gmsh is asked for")
    arguments = parser.parse_args()
    if not arguments.delquad.exists():
        return print(f"skipped: {arguments.delquad} is not built")
    counts = [round(count) for count in arguments.counts]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for threads in arguments.threads:
            print_rows(arguments.delquad, arguments.word, counts, threads, folder)
        if shutil.which("gmsh") is None:
            return print("\nGmsh: skipped, it is not installed")
        version = subprocess.run(["gmsh", "--version"], capture_output=True, text=True)
        print(f"\n| triangles asked for | Gmsh {(version.stdout + version.stderr).strip()}, seconds | GiB |\n|---:|---:|---:|")
        for count in counts:
            if count > arguments.gmsh_most:
                continue
            done = gmsh(math.sqrt(2 * AREA / count), folder)
            print(f"| {count} | failed | |" if done is None else f"| {count} | {done[0]:.2f} | {done[1] / 2**30:.2f} |", flush=True)


if __name__ == "__main__":
    main()
