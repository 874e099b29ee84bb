# SPDX-License-Identifier: GPL-3.0-or-later
"""From solutions to meshes."""

import numpy as np
import pytest

import delquad
from shapes import SQUARE, area, square


def shock(mesh):
    return np.tanh(20 * (mesh.points[:, 0] + 0.5 * mesh.points[:, 1] - 0.7))


def test_a_loop():
    mesh = delquad.mesh(square(), quads=500)
    errors = []
    for _ in range(3):
        mesh, told = delquad.adapt(mesh, shock(mesh), quads=500, quality="fast")
        errors.append(told["field"])
    assert mesh.sound and area(mesh) == pytest.approx(1, rel=1e-12)
    assert errors[2]["now"] < errors[0]["now"] / 5
    assert errors[1]["expected"] == pytest.approx(errors[2]["now"], rel=0.3)
    assert delquad.estimate_error(mesh, shock(mesh))["interpolation"] < errors[0]["now"] / 3


def test_models_and_components(tmp_path):
    mesh = delquad.mesh(square(), size=0.1)
    mesh.write(tmp_path / "a.msh")
    again = delquad.read_mesh(tmp_path / "a.msh")
    x, y = again.points[:, 0], again.points[:, 1]
    named = delquad.planar([delquad.loop([delquad.polyline(SQUARE + [SQUARE[0]], "rim")], "inside")])
    both = {"u": np.stack([x**2, np.sin(9 * y)], axis=1), "p": x * y**2}
    made, told = delquad.adapt(tmp_path / "a.msh", both, error=0.003, model=named, norm=1, isotropic=True)
    assert sorted(told) == ["p", "u_0", "u_1"]
    assert max(t["expected"] for t in told.values()) == pytest.approx(0.003, rel=0.2)
    assert made.curves[0][1] == ["rim"]


def test_derivatives():
    mesh = delquad.mesh(square(), size=0.1)
    x, y = mesh.points[:, 0], mesh.points[:, 1]
    u = x**2 - 3 * x * y + y
    assert np.allclose(delquad.recover_hessian(mesh, u), [2, -3, 0], atol=1e-9)
    assert np.allclose(delquad.recover_gradient(mesh, u), np.stack([2 * x - 3 * y, 1 - 3 * x], axis=1), atol=1e-10)


def test_transfer():
    coarse, fine = (delquad.mesh(square(), size=h) for h in (0.2, 0.07))
    values = coarse.points[:, 0] * 2 + 1
    for how in ("interpolated", "conservative", "bounded"):
        assert np.allclose(delquad.transfer(coarse, values, fine, how), fine.points[:, 0] * 2 + 1)
        ones = delquad.transfer(coarse, np.ones(len(coarse.quads)), fine, how, of_elements=True)
        assert ones.shape == (len(fine.quads),) and np.allclose(ones, 1)
    with pytest.raises(delquad.InputError, match="expected 'interpolated', 'conservative' or 'bounded'"):
        delquad.transfer(coarse, values, fine, "somehow")


def test_wrong_input():
    mesh = delquad.mesh(square(), size=0.2)
    for fields, settings, message in (
        (np.ones(3), {"quads": 100}, "has 3 values"),
        (np.ones(len(mesh.points)), {"quads": 100}, "constant or linear"),
        (shock(mesh), {}, "expected one of both"),
        (shock(mesh), {"quads": 100, "weight": -shock(mesh) ** 2}, "expected at least 0"),
        ({"u": "text"}, {"quads": 100}, "the field u: expected numbers"),
    ):
        with pytest.raises(delquad.InputError, match=message):
            delquad.adapt(mesh, fields, **settings)
    with pytest.raises(TypeError, match="expected a delquad.Mesh"):
        delquad.adapt(3, 3, quads=100)
