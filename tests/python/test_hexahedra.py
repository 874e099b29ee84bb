# SPDX-License-Identifier: GPL-3.0-or-later
"""Cells of volumes: swept from quads, and between closed quads."""

import math

import numpy as np
import pytest

import delquad
from shapes import SQUARE


def square(size=0.25):
    return delquad.mesh(delquad.polygons([SQUARE]), size=size)


def test_volumes_and_arrays(tmp_path):
    quads = square()
    n = len(quads.quads)
    block = delquad.extrude(quads, along=(0, 0, 2), layers=5, growth=1.5)
    assert block.hexahedra.shape == (5 * n, 8) and block.points.shape == (6 * len(quads.points), 3)
    assert block.volume == pytest.approx(2)
    assert block.scaled_jacobian.shape == (5 * n,) and block.scaled_jacobian.min() > 0.99
    assert np.all(block.hex_volume == 0) and len(block.volumes) == 1
    assert len(block.quads) == len(block.quad_face) == 2 * n + 5 * len(quads.lines)
    with pytest.raises(ValueError):
        block.points[0, 0] = 7
    ring = delquad.extrude(quads, around=((-1, 0, 0), (0, 1, 0)), layers=60)
    assert ring.volume == pytest.approx(2 * math.pi * 1.5, rel=2e-3) and len(ring.points) == 60 * len(quads.points)
    assert delquad.extrude(quads, around=((-1, 0, 0), (0, 1, 0)), angle=90, layers=15).volume == pytest.approx(ring.volume / 4)
    assert delquad.extrude(quads, curve=[(0, 0, 0), (0, 0, 1), (0, 0, 3)]).volume == pytest.approx(3)
    quads.write(tmp_path / "q.msh")
    assert delquad.extrude(quads, along=(0, 0, 1), layers=3, heights={"domain": 2.5}).volume == pytest.approx(2.5)
    shell = delquad.extrude(tmp_path / "q.msh", normals=0.5, both_sides=True, layers=2)
    assert shell.volume == pytest.approx(0.5) and shell.points[:, 2].min() == -0.25
    for name in ("a.msh", "a.vtu", "a.inp"):
        shell.write(tmp_path / name)
        back = delquad.read_mesh(tmp_path / name)
        assert isinstance(back, delquad.HexMesh) and "hexahedra" in repr(back)
        assert back.hexahedra.shape == shell.hexahedra.shape and back.volume == pytest.approx(0.5)
    shell.write(tmp_path / "c.inp", element="C3D20")
    assert "TYPE=C3D20" in (tmp_path / "c.inp").read_text()
    with pytest.raises(delquad.InputError, match="hexahedra"):
        delquad.improve(tmp_path / "a.msh")


def test_what_cannot_be_swept():
    quads = square()
    with pytest.raises(delquad.InputError, match="one of along"):
        delquad.extrude(quads, layers=2)
    with pytest.raises(delquad.InputError, match="inverted or flat"):
        delquad.extrude(quads, along=(1, 0, 0), layers=2)
    with pytest.raises(delquad.InputError, match="0 layers"):
        delquad.extrude(quads, along=(0, 0, 1))
    with pytest.raises(delquad.InputError, match="crosses its axis"):
        delquad.extrude(quads, around=((0.3, 0, 0), (0, 1, 0)), layers=20)
    with pytest.raises(delquad.InputError, match="triangles"):
        delquad.extrude(delquad.mesh(delquad.polygons([SQUARE]), size=0.25, word="D"), along=(0, 0, 1), layers=2)
    with pytest.raises(TypeError, match="expected a delquad.Mesh"):
        delquad.extrude(3, along=(0, 0, 1), layers=2)


def test_closed_models_are_filled(tmp_path):
    model = delquad.example("sphere")
    ball = delquad.volume(model, quads=300, threads=1)
    skin = delquad.mesh(model, quads=300, threads=1)
    assert np.array_equal(ball.quads, skin.quads) and len(ball.volumes) == 1
    cells = [ball.hexahedra, ball.prisms, ball.pyramids, ball.tetrahedra]
    assert len(ball.scaled_jacobian) == sum(map(len, cells))
    assert ball.scaled_jacobian.min() > 0 and np.array_equal(delquad.volume(skin).points, ball.points)
    assert len(delquad.volume(skin, strategy="FB").tetrahedra) > len(ball.tetrahedra)
    tets = delquad.volume(skin, cells="tets")
    assert len(tets.hexahedra) == 0 and len(tets.triangles) == 2 * len(skin.quads) and tets.volume == pytest.approx(ball.volume, rel=0.01)

    layered = delquad.volume(skin, layers=(0.01, 1.2, 3.0))
    with pytest.warns(UserWarning, match="layers are lower"):
        delquad.volume(skin, layers=(3, 1.2, 3))
    assert len(layered.hexahedra) >= 3 * len(skin.quads)
    curved = delquad.volume(model, quads=300, order=2, cells="tets")
    curved.write(tmp_path / "a.inp", element="C3D10")
    assert "TYPE=C3D10" in (tmp_path / "a.inp").read_text()


def test_layers_end_on_rows_of_other_faces():
    elbow = delquad.volume(delquad.example("elbow"), 4, layers=(0.1, 1.3, 4), layers_on=["region_5", "region_6", "region_7"])
    assert len(elbow.quads) > len(delquad.mesh(delquad.example("elbow"), 4).quads) and elbow.scaled_jacobian.min() > 0


def test_what_cannot_be_filled():
    with pytest.raises(delquad.InputError, match="goes with layers only"):
        delquad.volume(square(), layers_on="wall")
    with pytest.raises(delquad.InputError, match="a whole number"):
        delquad.volume(square(), layers=(1, 1, float("nan")))
    with pytest.raises(delquad.InputError, match="layers: a growth of 0.5"):
        delquad.volume(delquad.mesh(delquad.example("sphere"), quads=100), layers=(0.1, 0.5, 3))
    with pytest.raises(delquad.InputError, match="open at the edge"):
        delquad.volume(square())
    with pytest.raises(delquad.InputError, match="expected no size"):
        delquad.volume(square(), 0.5)
    with pytest.raises(delquad.InputError, match="cells 'cubes'"):
        delquad.volume(square(), cells="cubes")
    with pytest.raises(delquad.InputError, match="strategy 'X'"):
        delquad.volume(square(), strategy="X")
