#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves by deal.II in a loop of meshes by `delquad adapt`: adapt.py [--quads N] [--doublings D] [--delquad PROGRAM] [-o PICTURE.svg]

Solves Poisson's equation for atan(60 (r - pi/3)), r from (1.25, -0.25), a layer along an arc, by bilinear elements. Each loop has
three meshes of N quads, then D meshes with twice as many each; the picture shows the last one. The order is the order of the error in
the mean size of quads. Builds poisson.cpp, unless --poisson names the built program. Needs CMake and deal.II 9.4 (Debian:
libdeal.ii-dev).
"""
import json
import pathlib
import tempfile

import run

SQUARE = "loop = { rectangle = [[0, 0], [1, 1]] }\n"


def main():
    options = run.parser(__doc__, "adapt.svg", quads=500, doublings=3).parse_args()
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        poisson = options.poisson or run.build(folder / "build")
        model, mesh, solution, cells = (folder / name for name in ("square.toml", "mesh.msh", "solution.msh", "cells.json"))
        model.write_text(SQUARE)

        def delquad(*words):
            run.driver.run([options.delquad, "-q", *words, "-o", mesh], "see README.md")
            return mesh

        def uniform(quads):
            return delquad("mesh", model, "--quads", str(quads))

        def adapted(_, u, quads, isotropic):
            return delquad("adapt", u, "--quads", str(quads), "--model", model, *["--isotropic"] * isotropic)

        def solve(_):
            printed = run.driver.run([poisson, "shock", mesh, cells, solution], "see --poisson").split()
            return f"{solution}:u", int(printed[0]), [float(error) for error in printed[1:]]

        run.driver.compare("shock", options.quads, options.doublings, uniform, adapted, solve)
        run.picture.draw(json.loads(cells.read_text()), options.output, "shock")


if __name__ == "__main__":
    main()
