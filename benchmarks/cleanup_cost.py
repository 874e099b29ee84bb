#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Times every step of DBCO for each quad, the growth of treatment, C and O, and the gain of a second thread.

Runs `delquad mesh` with DBCO (or --words) on a plane and on a CAD model, over a range of sizes, with one thread and with two. Times of the
steps are processor microseconds for each quad on one thread, from one run. The row below has their ratios to insertion, which are valid on
a busy machine, too. The third row has the gain of two threads: wall-clock seconds of one thread over theirs. It needs a quiet machine, and
is meaningful for the plane, which is one patch. The last line of each model has the power of the number of quads by which steps grow.
"meshing" is wall-clock seconds from the boundary to the mesh. A missing model is skipped with a reason.
"""

import argparse
import json
import math
import subprocess
import tempfile
from pathlib import Path

COUNTS = [5000, 10000, 20000, 40000, 80000, 250000]
STEPS = ["insertion", "smoothing", "matching", "treatment", "clean-up", "optimisation", "lifting", "projection", "metrics", "soundness", "write"]
GROWING = ["treatment", "clean-up", "optimisation"]
ROOT = Path(__file__).resolve().parent.parent


def mesh(delquad, model, word, size, threads):
    """Returns the record of a run."""
    with tempfile.TemporaryDirectory() as folder:
        record = Path(folder) / "record.json"
        subprocess.run([delquad, "mesh", model, "-o", Path(folder) / "mesh.msh", "--size", repr(size), "--pipeline", word,
                        "--threads", str(threads), "--json", record], check=True, capture_output=True)
        return json.loads(record.read_text())


def power(rows, column):
    """Returns the power of the number of quads by which a column grows, by least squares of logarithms."""
    x, y = ([math.log(row[i]) for row in rows] for i in (0, column))
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def print_ratios(name, one, two):
    """Returns the rows below the times of a mesh: over insertion's, and one thread over two."""
    cpu, clock, clock_two = one["cpu_seconds"], one["seconds"], two["seconds"]
    rows = [("/ insertion", lambda s: cpu[s] / cpu["insertion"]), ("two threads", lambda s: clock[s] / max(clock_two[s], 1e-9))]
    for title, ratio in rows:
        cells = (f" {ratio(s):.2f} |" if s in cpu and s in clock_two else " |" for s in STEPS)
        print(f"| {name} | {title} |" + "".join(cells) + " | | |", flush=True)


def print_table(delquad, name, model, word, size, counts):
    rows = []
    for count in counts:
        size *= math.sqrt((rows[-1][0] if rows else count) / count)
        while True:  # sizes near features have their own rules
            one = mesh(delquad, model, word, size, 1)
            quads = one["metrics"]["n_quads"]
            if abs(quads / count - 1) < 0.1:
                break
            size *= math.sqrt(quads / count)
        two = mesh(delquad, model, word, size, 2)
        seconds = [one["cpu_seconds"].get(step, 0) for step in STEPS]
        rows.append([quads] + [seconds[STEPS.index(step)] for step in GROWING])
        clock = one["meshing_seconds"], two["meshing_seconds"]
        print(f"| {name} | {quads:.0f} |" + "".join(f" {1e6 * s / quads:.2f} |" for s in seconds) +
              f" {clock[0]:.2f} | {clock[1]:.2f} | {clock[0] / clock[1]:.2f} |", flush=True)
        print_ratios(name, one, two)
    if len(rows) > 1:
        print(f"{name}, power: " + ", ".join(f"{step} {power(rows, i + 1):.2f}" for i, step in enumerate(GROWING) if all(row[i + 1] for row in rows)),
              flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--delquad", type=Path, default=ROOT / "build/release/delquad")
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared/data")
    parser.add_argument("--words", nargs="+", default=["DBCO"])
    parser.add_argument("--counts", type=int, nargs="+", default=COUNTS, help="numbers of quads")
    arguments = parser.parse_args()
    if not arguments.delquad.exists():
        return print(f"skipped: {arguments.delquad} is not built")
    header = ["model", "quads", *STEPS, "meshing, s", "two threads", "ratio"]
    print("| " + " | ".join(header) + " |\n|---|" + "---:|" * (len(header) - 1))
    for name, model, size in (("plate", ROOT / "experiments/models/plate_16_holes.toml", 0.0247),
                              ("part.step", arguments.data / "cad/part.step", 3.1)):
        if not model.exists():
            print(f"| {name} | skipped: {model} not found |")
            continue
        for word in arguments.words:
            print_table(arguments.delquad, f"{name} {word}", model, word, size, arguments.counts)


if __name__ == "__main__":
    main()
