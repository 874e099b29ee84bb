#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Conducts heat through the plate of ../heat.toml by deal.II: run.py [--delquad PROGRAM] [-o PICTURE.svg]

Builds poisson.cpp, unless --poisson says where it is built. Elements are bilinear. Needs CMake and deal.II 9.4 (Debian:
libdeal.ii-dev).
"""
import json
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import driver  # noqa: E402
import picture  # noqa: E402


def parser(doc, output, **numbers):
    made = driver.parser(doc, output, **numbers)
    made.add_argument("--delquad", default="delquad", help="the program")
    made.add_argument("--poisson", help="default: it is built")
    return made


def build(folder):
    """The program."""
    for command in (["cmake", "-S", HERE, "-B", folder], ["cmake", "--build", folder]):
        driver.run(command, "Debian: cmake")
    return folder / "poisson"


def main():
    options = parser(__doc__, "heat.svg").parse_args()
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        poisson = options.poisson or build(folder / "build")
        driver.run([options.delquad, "-q", "mesh", HERE.parent / "heat.toml", "-o", folder / "heat.msh"], "see README.md")
        print(driver.run([poisson, "heat", folder / "heat.msh", folder / "heat.json"], "see --poisson").strip())
        picture.draw(json.loads((folder / "heat.json").read_text()), options.output, "temperature")


if __name__ == "__main__":
    main()
