#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the pipeline at 10^5, 10^6 and 10^7 triangles: seconds of every stage and peak memory, beside Gmsh.

Meshes the plate with 16 holes by DB (or --word), with one thread and with all cores. Tables have wall-clock and processor seconds; rows
below have the power of the number of triangles by which each stage grows. Gmsh gets the same model and size, up to --gmsh-most triangles
and for --gmsh-seconds. It runs Blossom on one thread after Frontal-Delaunay for quads or, if that fails, Frontal-Delaunay. It is skipped
if it is missing, and so are sizes that need too much memory, with a reason.
"""

import argparse
import json
import math
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from run_measured import run

ROOT = Path(__file__).resolve().parent.parent
MODEL = ROOT / "experiments/models/plate_16_holes.toml"
AREA = 4 - 16 * math.pi * 0.14**2
MOST_BYTES = 800  # bytes of memory for each triangle, required before a size starts
PLATE_GEO = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 2};
For i In {0:15}
  Disk(2 + i) = {.25 + .5 * (i % 4), .25 + .5 * Floor(i / 4), 0, .14};
EndFor
BooleanDifference{ Surface{1}; Delete; }{ Surface{2:17}; Delete; }
"""


def delquad(program, word, size, threads, folder):
    """Returns wall-clock and processor seconds by stage and in total, peak memory in bytes, and the number of merged triangles.
    Returns None if it fails."""
    record = folder / "record.json"
    done = run([program, "mesh", MODEL, "-o", folder / "mesh.msh", "--binary", "--size", repr(size), "--pipeline", word,
                "--threads", str(threads), "--json", record])
    if done is None:
        return None
    result = json.loads(record.read_text())
    clock, cpu = result["seconds"] | {"whole": done[0]}, result["cpu_seconds"] | {"whole": done[1]}
    return clock, cpu, done[2], result["recombination"]["triangles"]


def gmsh(size, algorithm, most_seconds, folder):
    """Returns wall-clock and processor seconds, and peak memory in bytes; None if it fails."""
    geometry = folder / "plate.geo"
    geometry.write_text(PLATE_GEO)
    return run(["timeout", str(most_seconds), "gmsh", geometry, "-2", "-setnumber", "Mesh.Algorithm", str(algorithm), "-setnumber",
                "Mesh.RecombineAll", "1", "-setnumber", "Mesh.RecombinationAlgorithm", "1", "-clmin", repr(size), "-clmax",
                repr(size), "-nt", "1", "-bin", "-v", "1", "-o", folder / "gmsh.msh"])


def powers(rows):
    """Returns, by stage, the slope of the logarithm of its seconds from the first to the last row."""
    (first, *_, n), (last, *_, m) = rows[0], rows[-1]
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
        clock, cpu, memory, triangles = row
        if not rows:
            stages = list(clock)
            print("\n| triangles | threads | seconds | " + " | ".join(stages) + " | bytes a triangle |")
            print("|---:|---:|---" + "|---:" * (len(stages) + 1) + "|")
        rows.append(row)
        for name, seconds, rest in (("clock", clock, f"{memory / triangles:.0f}"), ("processor", cpu, "")):
            print(f"| {triangles} | {threads} | {name} | " + " | ".join(f"{seconds[s]:.3g}" for s in stages) + f" | {rest} |", flush=True)
    if len(rows) > 1:
        power = powers(rows)
        print("| power | | clock | " + " | ".join(f"{power[s]:.2f}" if s in power else "" for s in stages) + " | |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--delquad", type=Path, default=ROOT / "build/release/delquad")
    parser.add_argument("--word", default="DB")
    parser.add_argument("--counts", type=float, nargs="+", default=[1e5, 1e6, 1e7], help="of triangles")
    parser.add_argument("--threads", type=int, nargs="+", default=sorted({1, os.cpu_count()}))
    parser.add_argument("--gmsh-most", type=float, default=1e6, help="triangles that Gmsh is asked for")
    parser.add_argument("--gmsh-seconds", type=int, default=600, help="that each of its runs may take")
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
        print(f"\n| triangles asked for | Gmsh {(version.stdout + version.stderr).strip()} | seconds | CPU s | GiB |\n|---:|---|---:|---:|---:|")
        for count in counts:
            if count > arguments.gmsh_most:
                continue
            for algorithm in (8, 6):
                done = gmsh(math.sqrt(2 * AREA / count), algorithm, arguments.gmsh_seconds, folder)
                times = "failed | | |" if done is None else f"{done[0]:.2f} | {done[1]:.2f} | {done[2] / 2**30:.2f} |"
                print(f"| {count} | Algorithm {algorithm} | {times}", flush=True)
                if done is not None:
                    break


if __name__ == "__main__":
    main()
