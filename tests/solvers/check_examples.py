#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs an example of a solver, and checks what it prints and draws: check_examples.py FOLDER DELQUAD EXAMPLE POISSON

FOLDER: examples/solvers. POISSON: the program of the examples of deal.II, whose own scripts would build it anew. Exit code 77: the
solver, or the Python module, is not installed.
"""
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import needs  # noqa: E402

# The plate with two holes, between a difference of temperatures of one, by elements of order 4 (finite_elements.py) on 672 and on 2698
# quads.
HEAT = 2.2997566
PRINTED = r"heat from hot to cold: (.*)"
# Commands, what they print, its value and how far from it, as a part, they may be.
EXAMPLES = {
    "strip": (["calculix/run.py", "strip"], r"stress along x: .* to (.*)", 3.14, 0.01),
    "pipes": (["calculix/run.py", "pipes"], r"displacement: 0 to (.*)", 0.0306, 0.02),
    "dolfinx": (["dolfinx/heat.py"], PRINTED, HEAT, 1e-5),
    "freefem": (["freefem/run.py"], PRINTED, HEAT, 0.005),
    "dealii": (["dealii/run.py"], PRINTED, HEAT, 0.005),
}


def run(command):
    result = subprocess.run(command, capture_output=True, text=True)
    missing = re.search(r".*is not installed.*|No module named '(delquad|numpy|scipy).*", result.stderr)
    if missing:
        needs.skip(missing[0])
    assert result.returncode == 0, f"{command}: {result.stdout}{result.stderr}"
    return result.stdout


def rows(printed, word):
    """The numbers of each line that begins so."""
    return [[float(x) for x in re.findall(r"[-+]?\d[\d.]*(?:e[-+]\d+)?", line)] for line in printed.splitlines() if line.startswith(word)]


def check_pairs(printed, problem="advection", gain=2):
    """The L2 error of squares is the error of a uniform mesh over the gain, or less; stretched quads halve both errors of squares."""
    uniform, squares, stretched = (rows(printed, f"{problem:11}{loop}")[-1] for loop in ("uniform", "squares", "stretched"))
    return squares[1] < uniform[1] / gain and stretched[1] < squares[1] / 2 and stretched[3] < squares[3] / 2


def check_freefem(printed):
    """Stretched quads, halved, beat squares, and neither they nor the triangles of adaptmesh have twice the others' errors."""
    squares, stretched, theirs = (rows(printed, loop)[-1] for loop in ("squares", "stretched", "adaptmesh  "))
    return stretched[3] < squares[3] / 2 and all(abs(math.log2(stretched[k] / theirs[k - 1])) < 1 for k in (3, 4))


def check_calculix(printed):
    """Both loops have the stress within 3 %; uniform meshes of twice as many quads do not."""
    uniform, squares, stretched = (rows(printed, loop) for loop in ("uniform", "squares", "stretched"))
    adapted = max(abs(squares[-1][2]), abs(stretched[-1][2]))
    return adapted < 3 and uniform[1][0] > 1.5 * stretched[-1][0] and abs(uniform[1][2]) > 10


def check_front(printed):
    """Mass, names and the circle stay, and values within their extremes."""
    interpolated, conservative, bounded = (rows(printed, how)[0] for how in ("interpolated", "conservative", "bounded"))
    [[off_circle]] = rows(printed, "nodes of the rim")
    stays = max(abs(conservative[0]), abs(bounded[0])) < 1e-12 and max(interpolated[3], bounded[3]) < 1e-12
    return stays and off_circle < 1e-5 and "names: the same" in printed


# Loops that adapt meshes print tables.
LOOPS = {
    "adapt_dolfinx": (["dolfinx/adapt.py", "advection", "--quads", "200", "--doublings", "1"], check_pairs),
    "adapt_dealii": (["dealii/adapt.py", "--quads", "200", "--doublings", "1"], lambda printed: check_pairs(printed, "shock", 1.3)),
    "adapt_freefem": (["freefem/adapt.py", "--vertices", "400", "--meshes", "3"], check_freefem),
    "adapt_calculix": (["calculix/adapt.py", "--quads", "200", "--meshes", "3"], check_calculix),
    "adapt_front": (["front.py", "--quads", "150", "--meshes", "6"], check_front),
}


def main():
    examples, delquad, name, poisson = sys.argv[1:]
    if "dealii" in name and not os.path.exists(poisson):
        needs.skip("libdeal.ii-dev: the program of the example was not built")
    command = (LOOPS if name in LOOPS else EXAMPLES)[name][0]
    programs = ["--delquad", delquad] if name in EXAMPLES or name == "adapt_dealii" else []
    programs += ["--poisson", poisson] if "dealii" in name else []
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(folder, "picture.svg")
        printed = run([sys.executable, os.path.join(examples, command[0]), *command[1:], *programs, "-o", picture])
        shapes = len(list(xml.etree.ElementTree.parse(picture).iter("{http://www.w3.org/2000/svg}polygon")))
    if name in LOOPS:
        print(printed)
        return 0 if LOOPS[name][1](printed) and shapes > 0 else 1
    _, pattern, value, tolerance = EXAMPLES[name]
    elements = int(re.search(r"(\d+) (elements|triangles)", printed)[1])
    each = 2 if name == "freefem" else 5  # polygons in the picture: an outline, and its parts
    found = float(re.search(pattern, printed)[1])
    print(f"{name}: {elements} elements, {shapes} polygons drawn, {found:.8g} for {value} ({found / value - 1:+.1e})")
    return 0 if abs(found / value - 1) < tolerance and shapes == each * elements else 1


if __name__ == "__main__":
    sys.exit(main())
