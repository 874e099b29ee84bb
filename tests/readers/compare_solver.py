# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares another solver's errors of Poisson's equation on a mesh with the program's.

Usage: compare_solver.py DELQUAD TOLERANCE COMMAND... The command gets the mesh. Exit code 77: it is not installed, see needs.py.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

from read_mesh import needs

MODEL = """
loop = [{ rectangle = [[0, 0], [3, 2]] }, { circle = { centre = [1, 1], radius = 0.4 } }]
size = "0.1 + 0.05*x"
"""


def compare(delquad, tolerance, command, folder):
    (folder / "model.toml").write_text(MODEL)
    mesh, record = folder / "mesh.msh", folder / "metrics.json"
    subprocess.run([delquad, "mesh", folder / "model.toml", "-o", mesh, "--pipeline", "DB"], check=True)
    subprocess.run([delquad, "metrics", mesh, "--solve", "poisson", "--json", record], check=True)
    ours = json.loads(record.read_text())["metrics"]
    solved = subprocess.run([*command, mesh], capture_output=True, text=True)
    missing = re.search(r".*is not installed.*|No module named .*", solved.stderr)
    if missing:
        needs.skip(missing[0])
    theirs = json.loads(solved.stdout) if solved.returncode == 0 else sys.exit(solved.stderr)
    for name in ("l2", "h1"):
        a, b = ours[f"poisson_{name}"], theirs[name]
        print(f"{name}: {a!r} ours, {b!r} theirs")
        if not abs(a / b - 1) < tolerance:
            sys.exit(f"{name}: {a!r} is not {b!r}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        compare(sys.argv[1], float(sys.argv[2]), sys.argv[3:], pathlib.Path(work))
