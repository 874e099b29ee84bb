#!/usr/bin/python3
"""Runs an example of a solver, and checks what it prints and draws: check_examples.py FOLDER DELQUAD EXAMPLE HEAT

FOLDER: examples/solvers. HEAT: the program of the example of deal.II, whose own script would build it anew. Exit code 77: the
solver is not installed.
"""
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

# Of the plate with two holes, between a difference of temperatures of one, by elements of order 4 (finite_elements.py) on 672 and
# on 2698 quads.
HEAT = 2.2997566
PRINTED = r"heat from hot to cold: (.*)"
# Commands, what they print, its value and how far from it, as a part, they may be.
EXAMPLES = {
    "strip": (["calculix/run.py", "strip"], r"stress along x: .* to (.*)", 3.14, 0.01),
    "pipes": (["calculix/run.py", "pipes"], r"displacement: 0 to (.*)", 0.0306, 0.02),
    "dolfinx": (["dolfinx/heat.py"], PRINTED, HEAT, 1e-5),
    "freefem": (["freefem/run.py"], PRINTED, HEAT, 0.005),
}


def run(command):
    result = subprocess.run(command, capture_output=True, text=True)
    if "is not installed" in result.stderr:
        print(result.stderr.strip())
        sys.exit(77)
    assert result.returncode == 0, f"{command}: {result.stdout}{result.stderr}"
    return result.stdout


def run_dealii(examples, delquad, program):
    """As run.sh does, once its program is built."""
    run([delquad, "-q", "mesh", os.path.join(examples, "heat.toml"), "-o", "heat.msh"])
    printed = run([program, "heat.msh", "heat.json"])
    run([sys.executable, os.path.join(examples, "picture.py"), "heat.json", "picture.svg"])
    return printed


def main():
    examples, delquad, name, heat = sys.argv[1:]
    if name == "dealii" and not os.path.exists(heat):
        print("deal.II is not installed (libdeal.ii-dev)")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if name == "dealii":
            printed, (_, pattern, value, tolerance) = run_dealii(examples, delquad, heat), ([], PRINTED, HEAT, 0.005)
        else:
            command, pattern, value, tolerance = EXAMPLES[name]
            printed = run([sys.executable, os.path.join(examples, command[0]), *command[1:], "--delquad", delquad, "-o", "picture.svg"])
        shapes = len(list(xml.etree.ElementTree.parse("picture.svg").iter("{http://www.w3.org/2000/svg}polygon")))
    elements = int(re.search(r"(\d+) (elements|triangles)", printed)[1])
    each = 2 if name == "freefem" else 5  # polygons in the picture: an outline, and its parts
    found = float(re.search(pattern, printed)[1])
    print(f"{name}: {elements} elements, {shapes} polygons drawn, {found:.8g} for {value} ({found / value - 1:+.1e})")
    return 0 if abs(found / value - 1) < tolerance and shapes == each * elements else 1


if __name__ == "__main__":
    sys.exit(main())
