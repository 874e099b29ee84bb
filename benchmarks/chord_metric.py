# SPDX-License-Identifier: GPL-3.0-or-later
"""Counts the quads for an error of the surface: sizes by direction from curvature against sizes alone.

    python3 benchmarks/chord_metric.py build/release/delquad MODEL... [--chord 0.0005] [--max 0.05]

Each model is meshed with --metric chord=...,max=..., both in diagonals of the model, then with --size and --curvature. The
elements per turn are changed until middles of quads and edges are equally near to the surface (root mean square). Both
have the same largest size. Distances are in diagonals of the model.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("program")
parser.add_argument("models", nargs="+", help="files")
parser.add_argument("--chord", type=float, default=0.0005)
parser.add_argument("--max", type=float, default=0.05)
parser.add_argument("--runs", type=int, default=5)
arguments = parser.parse_args()


def mesh(model, *options):
    with tempfile.TemporaryDirectory() as folder:
        record = pathlib.Path(folder) / "record.json"
        run = subprocess.run(
            [arguments.program, "mesh", model, "-o", f"{folder}/mesh.msh", "--json", record, "--threads", "1", *options],
            capture_output=True, text=True, timeout=600,
        )
        if run.returncode not in (0, 5) or not record.exists():
            return None, (run.stderr.strip().splitlines() or ["?"])[-1]
        made = json.loads(record.read_text())
    distances = made["surface"]["distances_in_diagonals"]["mesh_to_surface"]
    return {
        "quads": made["metrics"]["n_quads"],
        "rms": distances["rms"],
        "max": distances["max"],
        "sound": run.returncode == 0,
        "metrics": made["metrics"],
    }, ""


def diagonal(model):
    with tempfile.TemporaryDirectory() as folder:
        record = pathlib.Path(folder) / "info.json"
        subprocess.run([arguments.program, "info", model, "--json", record], capture_output=True, check=True)
        return json.loads(record.read_text())["diagonal"]


def as_near(model, size, wanted):
    """Returns the mesh by sizes whose distance is nearest to the wanted one."""
    low, high, turns, best, why = 3.0, 400.0, 24.0, None, ""
    for _ in range(arguments.runs):
        made, why = mesh(model, "--size", f"{size:.6g}", "--curvature", f"{turns:.4g}")
        if made is None:
            high = turns
        else:
            if best is None or abs(made["rms"] / wanted - 1) < abs(best["rms"] / wanted - 1):
                best = {**made, "turns": turns}
            if abs(made["rms"] / wanted - 1) < 0.03:
                break
            low, high = (turns, high) if made["rms"] > wanted else (low, turns)
            # Distances fall with the square of the number.
            turns *= (made["rms"] / wanted) ** 0.5
        if not low < turns < high:
            turns = (low * high) ** 0.5
    return best, why


print("| model | quads by the metric | rms, max | eta_M mean / worst | quads by sizes | rms, max | per turn | share |")
print("|---|---:|---:|---:|---:|---:|---:|---:|")
for model in arguments.models:
    extent = diagonal(model)
    size = arguments.max * extent
    long, why = mesh(model, "--metric", f"chord={arguments.chord * extent:.6g},max={size:.6g}")
    if long is None:
        print(f"| {pathlib.Path(model).stem} | {why} |", flush=True)
        continue
    even, why = as_near(model, size, long["rms"])
    tell = lambda made: f"{made['quads']:.0f}{'' if made['sound'] else ' (not sound)'} | {made['rms']:.1e}, {made['max']:.1e}"
    values = long["metrics"]
    first = f"| {pathlib.Path(model).stem} | {tell(long)} | {values['metric_eta_mean']:.3f} / {values['metric_eta_worst']:.2f} |"
    if even is None:
        print(f"{first} {why} |", flush=True)
        continue
    print(f"{first} {tell(even)} | {even['turns']:.0f} | {long['quads'] / even['quads']:.2f} |", flush=True)
