#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures volume meshes of closed examples, and of named CAD files, at two numbers of quads: shares of hexahedra, scaled Jacobians, processor time."""

import argparse
import json
import os
import re
import statistics
import subprocess
import tempfile
from pathlib import Path

EXAMPLES = ["bracket", "sphere", "torus", "blended_tee", "cross_drilled", "elbow", "fins", "loft", "thin_box"]


def measure(delquad, model, quads, folder):
    """Returns the cells of a table row after the model's name, and the share of the volume, or why there are none."""
    before = os.times()
    done = subprocess.run([delquad, "volume", model, "--quads", str(quads), "--threads", "1", "-q", "--no-cache", "-o", "v.vtu", "--json", "v.json"],
                          cwd=folder, capture_output=True, text=True)
    after = os.times()
    if done.returncode != 0:
        return [str(quads), f"failed with {done.returncode}"] + [""] * 5, None
    record = json.loads((folder / "v.json").read_text())
    hexahedra = record["shapes"].get("hexahedra", {"number": 0, "volume": 0, "least_scaled_jacobian": 1, "mean_scaled_jacobian": 1})
    cells = sum(shape["number"] for shape in record["shapes"].values())
    share = 100 * hexahedra["volume"] / record["volume"]
    seconds = after.children_user + after.children_system - before.children_user - before.children_system
    return [str(quads), str(cells), f"{share:.1f}", f"{100 * hexahedra['number'] / cells:.0f}",
            f"{hexahedra['least_scaled_jacobian']:.2f}, {hexahedra['mean_scaled_jacobian']:.2f}", f"{record['least_scaled_jacobian']:.3f}", f"{seconds:.1f}"], share


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("models", nargs="*", type=Path, help="CAD files of closed bodies, besides the examples")
    parser.add_argument("--delquad", default=Path(__file__).resolve().parent.parent / "build/release/delquad")
    parser.add_argument("--quads", nargs="+", type=int, default=[1200, 3500])
    given = parser.parse_args()
    print("commit " + re.search(r"commit (\w+)", subprocess.check_output([given.delquad, "--version"], text=True))[1] + "\n")
    print("| model | quads | cells | hexahedra, % of volume | % of cells | their scaled Jacobian | least of all | s |\n|---|---|---|---|---|---|---|---|")
    shares = {quads: [] for quads in given.quads}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        examples = [folder / f"{example}.step" for example in EXAMPLES]
        for example in examples:
            subprocess.run([given.delquad, "example", example.stem, "-o", example], check=True, capture_output=True)
        for model in examples + [m.resolve() for m in given.models]:
            for quads in given.quads:
                row, share = measure(given.delquad, model, quads, folder)
                shares[quads] += [] if share is None else [share]
                print(f"| {model.stem} | {' | '.join(row)} |", flush=True)
    for quads, of in shares.items():
        print(f"| median of {len(of)} | {quads} | | {statistics.median(of):.1f} | | | | |")


if __name__ == "__main__":
    main()
