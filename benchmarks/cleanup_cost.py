#!/usr/bin/env python3
"""Time of clean-up and optimisation (C, O) against insertion, over a range of sizes, and how it grows.

Runs `delquad mesh` with DBCO and one thread on a plane and on a CAD model. Times come from the same run, so that their
ratio means something on a busy machine, too; the last line of each model has the power of the number of quads by which
each grows. A model that is missing is skipped with a reason.
"""

import argparse
import json
import math
import subprocess
import tempfile
from pathlib import Path

COUNTS = [5000, 10000, 20000, 40000, 80000]
ROOT = Path(__file__).resolve().parent.parent


def mesh(delquad, model, size):
    """Number of quads, and seconds of insertion and of C and O."""
    with tempfile.TemporaryDirectory() as folder:
        record = Path(folder) / "record.json"
        subprocess.run([delquad, "mesh", model, "-o", Path(folder) / "mesh.msh", "--size", repr(size), "--pipeline", "DBCO",
                        "--threads", "1", "--json", record], check=True, capture_output=True)
        result = json.loads(record.read_text())
    seconds = result["seconds"]
    return result["metrics"]["n_quads"], seconds["insertion"], seconds["clean-up"], seconds["optimisation"]


def power(rows, column):
    """Slope of the logarithm of a column against that of the number of quads, by least squares."""
    x, y = ([math.log(row[i]) for row in rows] for i in (0, column))
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def print_table(delquad, name, model, size):
    rows = []
    for count in COUNTS:
        size *= math.sqrt((rows[-1][0] if rows else count) / count)
        while True:  # sizes near features follow rules of their own
            row = mesh(delquad, model, size)
            if abs(row[0] / count - 1) < 0.1:
                break
            size *= math.sqrt(row[0] / count)
        rows.append(row)
        quads, insertion, cleanup, optimisation = row
        print(f"| {name} | {quads:.0f} | {insertion:.3f} | {cleanup:.2f} | {optimisation:.2f} | {(cleanup + optimisation) / insertion:.0f} |",
              flush=True)
    print(f"| {name}, power | | {power(rows, 1):.2f} | {power(rows, 2):.2f} | {power(rows, 3):.2f} | |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--delquad", type=Path, default=ROOT / "build/release/delquad")
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared/data")
    arguments = parser.parse_args()
    if not arguments.delquad.exists():
        return print(f"skipped: {arguments.delquad} is not built")
    print("| model | quads | insertion, s | C, s | O, s | (C + O) / insertion |\n|---|---:|---:|---:|---:|---:|")
    for name, model, size in (("plate", ROOT / "experiments/models/plate_16_holes.toml", 0.0247),
                              ("part.step", arguments.data / "cad/part.step", 3.1)):
        if model.exists():
            print_table(arguments.delquad, name, model, size)
        else:
            print(f"| {name} | skipped: {model} not found |")


if __name__ == "__main__":
    main()
