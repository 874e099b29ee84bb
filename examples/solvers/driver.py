# SPDX-License-Identifier: GPL-3.0-or-later
"""Common parts of the examples: options, solvers that are programs, tables of loops, and pictures of meshes."""
import argparse
import math
import shutil
import subprocess
import sys
import time

import picture


def parser(doc, output, **numbers):
    made = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, default in numbers.items():
        made.add_argument(f"--{name}", type=int, default=default, help=f"default: {default}")
    made.add_argument("-o", "--output", default=output, help="the picture")
    return made


def run(command, package, folder="."):
    """Returns the output of a program of that package."""
    if not shutil.which(command[0]):
        sys.exit(f"{command[0]} is not installed: expected it on the PATH ({package})")
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{command[0]} failed: {done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def draw(mesh, values, output, title):
    """A Mesh of the module delquad, with values at its points."""
    picture.draw([[[*mesh.points[n], values[n]] for n in quad] for quad in mesh.quads], output, title)


def compare(problem, first, doublings, mesh, adapt, solve):
    """Prints the errors of uniform meshes, and of loops of squares and of stretched quads; returns the last mesh and its solution.

    Each series begins with `first` quads and doubles them; loops have three meshes of the first number. The functions are
    mesh(quads); adapt(mesh, solution, quads, isotropic); solve(mesh), which returns the solution, its number of quads, and two
    errors. The order is the order of errors in the mean size of quads.
    """
    print("problem    loop        quads   L2 error  order   H1 error  order  seconds")
    for loop in ("uniform", "squares", "stretched"):
        made, last = None, None
        for n in [first] * (1 if loop == "uniform" else 3) + [first * 2**k for k in range(1, doublings + 1)]:
            began = time.perf_counter()
            is_first = made is None or loop == "uniform"
            made = mesh(n) if is_first else adapt(made, solution, n, loop == "squares")
            solution, quads, errors = solve(made)
            print(f"{problem:11}{loop:10}{quads:7}", end="")
            for k, error in enumerate(errors):
                doubled = last is not None and n > last[0]
                order = f"{2 * math.log(last[1][k] / error) / math.log(n / last[0]):.2f}" if doubled else ""
                print(f"{error:11.3e}{order:>7}", end="")
            print(f"{time.perf_counter() - began:9.1f}", flush=True)
            last = n, errors
    return made, solution
