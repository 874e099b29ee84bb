# SPDX-License-Identifier: GPL-3.0-or-later
"""Words that begin from a mesh."""

import numpy as np
import pytest

import delquad
from shapes import SQUARE


def test_the_word_in_two_halves():
    model = delquad.polygons([SQUARE, [(0.3, 0.35), (0.7, 0.3), (0.55, 0.7)]])
    start = delquad.mesh(model, size=0.05, word="DB")
    better = delquad.improve(start)
    assert better.sound and len(better.triangles) == 0
    assert better.metrics["eta_mean"] > start.metrics["eta_mean"]
    assert better.curves == start.curves and len(better.lines) == len(start.lines)


def test_triangles_and_files(tmp_path):
    triangles = delquad.mesh(delquad.polygons([SQUARE]), size=0.1, word="D")
    assert len(delquad.improve(triangles).quads) == pytest.approx(100, rel=0.2)
    triangles.write(tmp_path / "t.vtu")
    assert len(delquad.improve(tmp_path / "t.vtu", word="B").triangles) == 0
    with pytest.raises(delquad.InputError, match="no quads"):
        delquad.improve(triangles, word="CO")
    with pytest.raises(TypeError, match="expected a delquad.Mesh"):
        delquad.improve(3)


def test_meshes_in_space(tmp_path):
    start = delquad.mesh(delquad.example("bracket"), size=5.0, word="DB")
    better = delquad.improve(start, word="O")
    assert better.sound and len(better.quads) == len(start.quads)
    assert better.metrics["eta_mean"] > start.metrics["eta_mean"]
    assert better.curves == start.curves and better.regions == start.regions and better.unit == "mm"
    start.write(tmp_path / "start.msh")
    assert delquad.improve(tmp_path / "start.msh", feature_angle=30).sound
    with pytest.raises(delquad.InputError, match="keeps its faces"):
        delquad.improve(start, compounds="all")
