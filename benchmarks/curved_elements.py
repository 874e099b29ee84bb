#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures proven bounds and costs of curved elements on whole models.

Meshes CAD models of ../shared/data and built-in examples with straight and with curved elements. Sizes are parts of the models' diagonals.
The table has quads, processor seconds of the whole program with straight and with curved elements, and their ratio. Then come the least
proven scaled Jacobian, and the least outside of narrow corners of the model. Numbers of elements below 0.1 and of those in such corners
follow. Last are elements without proof (in corners, elsewhere), quads that got a ring, and rounds of remeshing. An unsound mesh counts; the
last column tells it. Missing models are skipped with a reason.
"""

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

from run_measured import run

ROOT = Path(__file__).resolve().parent.parent
HEADER = ["model", "part", "order", "quads", "straight, s", "curved, s", "ratio", "least", "least elsewhere", "below .1", "in corners", "unproven",
          "of these elsewhere", "rings", "rounds", ""]


def models(delquad, data, folder, only):
    """Returns pairs of a name and a file."""
    found = [(path.name, path) for path in sorted((data / "cad").glob("*"))]
    if not found:
        print(f"skipped: no models in {data / 'cad'}")
    listed = subprocess.run([delquad, "example", "--list"], check=True, capture_output=True, text=True).stdout
    for line in listed.splitlines():
        name = line.split()[0]
        found.append((name, folder / f"{name}.step"))
    for name, path in found:
        if not only or any(word in name for word in only):
            if not path.exists():
                subprocess.run([delquad, "example", name, "-o", path], check=True, capture_output=True)
            yield name, path


def diagonal(delquad, model, folder):
    record = folder / "info.json"
    subprocess.run([delquad, "info", model, "--json", record], check=True, capture_output=True)
    return json.loads(record.read_text())["diagonal"]


def mesh(delquad, model, size, order, folder, arguments):
    """Returns processor seconds and the record; None if it fails."""
    record = folder / "record.json"
    done = run([delquad, "mesh", model, "-o", folder / "mesh.vtu", "--size", repr(size), "--order", str(order), "--allow-unsound", "--json", record,
                "--threads", str(arguments.threads), *arguments.options])
    return None if done is None else (done[1], json.loads(record.read_text()))


def row(name, part, order, straight, curved):
    start = [name, f"/{part}", order]
    if straight is None or curved is None:
        return start + [""] * (len(HEADER) - 4) + ["failed"]
    (before, _), (after, record) = straight, curved
    curving = record.get("curving", {})
    get = lambda key: curving.get(key, "")
    reasons = "; ".join(record.get("unsound", []))
    return start + [f"{record['metrics']['n_quads']:.0f}", f"{before:.1f}", f"{after:.1f}", f"{after / before:.1f}",
                    *(f"{get(key):.3g}" if get(key) != "" else "" for key in ("least_jacobian", "least_elsewhere")), get("below"), get("in_corners"),
                    get("unproven"), get("unproven_elsewhere"), get("rings"), record.get("refine_unsound", {}).get("rounds", 0), reasons]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--delquad", type=Path, default=ROOT / "build/release/delquad")
    parser.add_argument("--data", type=Path, default=ROOT.parent / "shared/data")
    parser.add_argument("--parts", type=int, nargs="+", default=[20, 60], help="edges along the diagonal")
    parser.add_argument("--orders", type=int, nargs="+", default=[2, 3])
    parser.add_argument("--only", nargs="+", help="models whose name has one of these")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--options", nargs=argparse.REMAINDER, default=[], help="more options of `delquad mesh`, last")
    arguments = parser.parse_args()
    if not arguments.delquad.exists():
        return print(f"skipped: {arguments.delquad} is not built")
    print("| " + " | ".join(HEADER) + " |\n|---|" + "---:|" * (len(HEADER) - 2) + "---|", flush=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for label, path in models(arguments.delquad, arguments.data, folder, arguments.only):
            size = diagonal(arguments.delquad, path, folder)
            for part in arguments.parts:
                straight = mesh(arguments.delquad, path, size / part, 1, folder, arguments)
                for order in arguments.orders:
                    curved = mesh(arguments.delquad, path, size / part, order, folder, arguments)
                    print("| " + " | ".join(map(str, row(label, part, order, straight, curved))) + " |", flush=True)


if __name__ == "__main__":
    main()
