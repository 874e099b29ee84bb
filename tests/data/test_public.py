#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Models of others as ours, and their measures, against known answers.

Usage: test_public.py FOLDER_OF_SCRIPTS DELQUAD [unittest's arguments]
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

SCRIPTS, DELQUAD = pathlib.Path(sys.argv[1]), sys.argv[2]
GEO = """Point( 1) = { 0, 0,0, 50.00};
Point( 2) = { 1, 0,0, 50.00};
Point( 3) = { 1, 1,0, 50.00};
Point( 4) = { 0, 1,0, 50.00};
Point( 5) = { 2, 0.5,0, 50.00};
Line( 1) = {1, 2};
Line( 2) = {2, 3};
Line( 3) = {3, 4, 1};
Line( 4) = {2, 5, 3};
Line Loop( 7) = {1, 2, 3};
Plane Surface( 7) = {7};
Line Loop( 8) = {4,-2};
Plane Surface( 8) = {8};
"""
CONTROL = r"""
\begin{CONTROL_INPUT}
   \begin{BACKGROUND_GRID}
      x0 = [-2.0, -1.0, 0.0]  % a comment
      dx = [0.5, 0.5, 0.0]
      N  = [8, 4, 1]
   \end{BACKGROUND_GRID}
   \begin{REFINEMENT_REGIONS}
      \begin{REFINEMENT_CENTER}
         type = smooth
         x0   = [-1.5, 0.0, 0.0]
         h    = 0.1
         w    = 0.2
      \end{REFINEMENT_CENTER}
   \end{REFINEMENT_REGIONS}
\end{CONTROL_INPUT}
\begin{MODEL}
   \begin{INNER_BOUNDARIES}
      \begin{CHAIN}
         name = half
         \begin{ELLIPTIC_ARC}
            name = arc
            units = degrees
            center = [0.0, 0.0, 0.0]
            xRadius = 0.4
            yRadius = 0.2
            start angle = 0.0
            end angle = 180.0
            rotation = 90.0
         \end{ELLIPTIC_ARC}
         \begin{END_POINTS_LINE}
            name = chord
            xStart = [0.0, -0.4, 0.0]
            xEnd = [0.0, 0.4, 0.0]
         \end{END_POINTS_LINE}
      \end{CHAIN}
   \end{INNER_BOUNDARIES}
   \begin{INTERFACE_BOUNDARIES}
      \begin{CHAIN}
         name = inclusion
         \begin{PARAMETRIC_EQUATION_CURVE}
            name = circle
            xEqn = x(t) = 1.0 + 0.5*cos(2*pi*t)
            yEqn = y(t) = 0.5*sin(2*pi*t)
            zEqn = z(t) = 0.0
         \end{PARAMETRIC_EQUATION_CURVE}
      \end{CHAIN}
   \end{INTERFACE_BOUNDARIES}
\end{MODEL}
"""


class Public(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def script(self, name, *arguments):
        return subprocess.run([sys.executable, SCRIPTS / name, *arguments], check=True, capture_output=True, text=True).stdout

    def mesh(self, model):
        """The program's model file, once it has been meshed."""
        subprocess.run([DELQUAD, "mesh", model, "--size", "0.1", "-o", self.folder / "mesh.msh"], check=True, capture_output=True)
        return tomllib.loads(model.read_text())

    def measures(self, *corners):
        mesh = self.folder / "one.msh"
        nodes = "\n".join(f"{k + 1} {x} {y} 0" for k, (x, y) in enumerate(corners))
        mesh.write_text(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n{nodes}\n$EndNodes\n"
                        "$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n")
        return json.loads(self.script("verdict.py", mesh))

    def test_measures(self):
        square = self.measures((0, 0), (1, 0), (1, 1), (0, 1))
        for key in ("shape_mean", "shape_min", "aspect", "libmesh_shape"):
            self.assertAlmostEqual(square[key], 1)
        rectangle = self.measures((0, 0), (2, 0), (2, 1), (0, 1))
        self.assertAlmostEqual(rectangle["shape_mean"], 4 / 5)
        self.assertAlmostEqual(rectangle["aspect"], 3 / 2)
        trapezoid = self.measures((0, 0), (2, 0), (1, 1), (0, 1))
        self.assertAlmostEqual(trapezoid["least_angle"], 45)
        self.assertAlmostEqual(trapezoid["largest_angle"], 135)
        self.assertAlmostEqual(trapezoid["aspect"], 2 * (4 + math.sqrt(2)) / 6)
        shapes = [4 / 5, 2 / 3, 2 / 3, 1]
        self.assertAlmostEqual(trapezoid["shape_mean"], min(shapes))
        self.assertAlmostEqual(trapezoid["libmesh_shape"], 4 / sum(1 / shape for shape in shapes))

    def test_lines_of_gmsh(self):
        (self.folder / "two.geo").write_text(GEO)
        self.script("geo.py", self.folder / "two.geo", self.folder / "two.toml", "polyline")
        model = self.mesh(self.folder / "two.toml")
        self.assertEqual(model["curve"][2], {"name": "c3", "polyline": [[1.0, 1.0], [0.0, 1.0], [0.0, 0.0]]})
        self.assertEqual(model["loop"], [{"curves": ["c1", "c2", "c3"], "region": "s7"}, {"curves": ["c4", "c2"], "region": "s8"}])

    def test_control_file_of_hohqmesh(self):
        (self.folder / "box.control").write_text(CONTROL)
        self.script("hohqmesh.py", self.folder / "box.control", self.folder / "models")
        model = self.mesh(self.folder / "models" / "box.toml")
        names = ["c1", "c2"], ["c3"]
        self.assertEqual(model["loop"], [{"rectangle": [[-2.0, -1.0], [2.0, 1.0]], "region": "domain"},
                                         {"curves": names[0], "hole": True}, {"curves": names[1], "region": "inclusion"}])
        self.assertEqual(model["size"]["base"], 0.5)
        first, *others = model["size"]["source"]
        self.assertEqual(first, {"at": [-1.5, 0.0], "near": 0.1, "far": 0.5, "radius_far": 0.2 * math.log(5, 3)})
        ends = min(others, key=lambda source: source["near"])  # of the half ellipse: its radius of curvature is 0.1 at (0, 0.4)
        self.assertAlmostEqual(min(math.dist(ends["at"], (0, y)) for y in (-0.4, 0.4)), 0, delta=0.02)
        self.assertAlmostEqual(ends["near"], 0.1 / 3, delta=0.001)
        self.assertAlmostEqual(max(source["near"] for source in others if source["at"][0] > 0), 0.5 / 3, delta=0.001)



if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
