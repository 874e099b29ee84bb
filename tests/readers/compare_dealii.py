"""Whether deal.II's errors of Poisson's equation on a mesh are those of the program.

Usage: compare_dealii.py DELQUAD DEALII_POISSON.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

MODEL = """
loop = [{ rectangle = [[0, 0], [3, 2]] }, { circle = { centre = [1, 1], radius = 0.4 } }]
size = "0.1 + 0.05*x"
"""


def compare(delquad, dealii, folder):
    (folder / "model.toml").write_text(MODEL)
    mesh, record = folder / "mesh.msh", folder / "metrics.json"
    subprocess.run([delquad, "mesh", folder / "model.toml", "-o", mesh, "--pipeline", "DB"], check=True)
    subprocess.run([delquad, "metrics", mesh, "--solve", "poisson", "--json", record], check=True)
    ours = json.loads(record.read_text())["metrics"]
    theirs = json.loads(subprocess.run([dealii, mesh], check=True, capture_output=True, text=True).stdout)
    for name in ("l2", "h1"):
        a, b = ours[f"poisson_{name}"], theirs[name]
        print(f"{name}: {a!r} ours, {b!r} deal.II's")
        if not abs(a / b - 1) < 1e-10:
            sys.exit(f"{name}: {a!r} is not {b!r}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        compare(sys.argv[1], sys.argv[2], pathlib.Path(work))
