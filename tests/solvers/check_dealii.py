#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bilinear elements of deal.II on our meshes: check_dealii.py DELQUAD POISSON. The error in L2 falls with order 2.

POISSON: the program built from experiments/solvers/dealii_poisson.cpp, which says the relative error on a mesh.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import needs  # noqa: E402

PLATE = """loop = [
  { rectangle = [[0, 0], [2, 1]], boundary = ["bottom", "right", "top", "left"] },
  { circle = { centre = [0.6, 0.5], radius = 0.2 }, boundary = "small hole", hole = true },
  { circle = { centre = [1.3, 0.55], radius = 0.25 }, boundary = "large hole", hole = true },
]
"""
SIZES = [0.03, 0.015]


def main():
    np = needs.module("numpy", "python3-numpy")
    delquad, poisson = sys.argv[1:]
    counts, errors = [], []
    with tempfile.TemporaryDirectory() as folder:
        def path(name):
            return os.path.join(folder, name)

        def error_on(mesh):
            return json.loads(subprocess.run([poisson, mesh], check=True, capture_output=True, text=True).stdout)["l2"]

        model, mesh, record = path("plate.toml"), path("plate.msh"), path("plate.json")
        with open(model, "w", encoding="utf-8") as file:
            file.write(PLATE)
        for size in SIZES:
            subprocess.run([delquad, "-q", "mesh", model, "-o", mesh, "--size", str(size), "--json", record], check=True)
            with open(record, encoding="utf-8") as file:
                counts.append(round(json.load(file)["metrics"]["n_quads"]))
            errors.append(error_on(mesh))
    found = np.polyfit(-np.log(counts) / 2, np.log(errors), 1)[0]
    print(f"{counts} quads, errors {' '.join(f'{e:.3g}' for e in errors)}: order {found:.3f}")
    return 0 if abs(found - 2) < 0.05 else 1


if __name__ == "__main__":
    sys.exit(main())
