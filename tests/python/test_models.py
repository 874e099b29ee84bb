# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests models that can be meshed."""

import math

import numpy as np
import pytest

import delquad
from shapes import SQUARE, area, octahedron, square


def test_polygons_with_a_hole():
    hole = 0.4 + 0.2 * np.array(SQUARE)
    r = delquad.mesh(delquad.polygons([SQUARE, hole]), size=0.05)
    assert area(r) == pytest.approx(1 - 0.04)
    assert len(r.triangles) == 0 and r.sound and r.unsound == []


def test_washers_around_holes():
    plate = delquad.planar([delquad.loop([delquad.polyline([(0, 0), (4, 0), (4, 4), (0, 4), (0, 0)])]), delquad.loop([delquad.circle((2, 2), 0.5)])])
    r = delquad.mesh(plate, size=0.5, washers=[{"diameter": (0.8, 1.2), "rows": 2, "edges": 12, "width": 0.6}])
    distance = np.hypot(r.points[:, 0] - 2, r.points[:, 1] - 2)
    for radius in (0.5, 0.8, 1.1):
        assert np.count_nonzero(np.isclose(distance, radius, atol=0.01)) == 12
    for bad in ({"diameter": 1}, {"rows": 2}):
        with pytest.raises(delquad.InputError, match=r"washers: 'washers.diameter' .*two numbers \[least, most\]"):
            delquad.mesh(plate, size=0.5, washers=[bad])


def test_layers_along_curves():
    sides = [delquad.segment((0, 0), (2, 0), "floor"), delquad.polyline([(2, 0), (2, 1), (0, 1), (0, 0)], "rest")]
    layer = {"on": "floor", "first": 1e-3, "number": 5}
    r = delquad.mesh(delquad.planar([sides]), size=0.1, layers=[layer])
    assert area(r) == pytest.approx(2) and r.sound
    assert np.any(np.isclose(r.points[:, 1], 1e-3)) and np.any(np.isclose(r.points[:, 1], 2.2e-3))
    with pytest.raises(delquad.InputError, match="layers: unknown key 'layer.height'"):
        delquad.mesh(delquad.planar([sides]), size=0.1, layers=[{"height": 1, **layer}])
    with pytest.raises(delquad.InputError, match="'flor'.*'floor'"):
        delquad.mesh(delquad.planar([sides]), size=0.1, layers=[{**layer, "on": "flor"}])
    with pytest.raises(delquad.InputError, match="no region is called 'air'"):
        delquad.mesh(delquad.planar([sides]), size=0.1, layers=[{**layer, "into": "air"}])


def test_grids_by_name_and_corners():
    octagon = [(np.cos(a), np.sin(a)) for a in np.arange(8) * np.pi / 4]
    model = delquad.polygons([octagon])
    names = ("region_1", [octagon[k] for k in (1, 3, 5, 7)])
    result = delquad.mesh(model, size=0.1, mapped=[names])
    valence = np.bincount(result.quads.ravel())
    assert np.sum(valence == 1) == 4 and set(valence) == {1, 2, 4}
    with pytest.raises(delquad.InputError, match="no node of the outline"):
        delquad.mesh(model, size=0.1, mapped=[("region_1", [(0, 0), octagon[1], octagon[2]])])


def test_curves_and_points_inside():
    square = [delquad.polyline([(0, 0), (1, 0), (1, 1), (0, 1), (0, 0)], "wall")]
    model = delquad.planar([square], embed=[delquad.segment((0.2, 0.3), (0.7, 0.6), "fault"),
                                            delquad.crack(delquad.segment((0, 0.8), (0.4, 0.8), "crack")),
                                            delquad.point((0.8, 0.2), "sensor")])
    mesh = delquad.mesh(model, size=0.1)
    assert np.any(np.all(np.isclose(mesh.points, [0.8, 0.2, 0]), axis=1))
    assert len(mesh.triangles) == 0
    doubled = len(mesh.points) - len(np.unique(mesh.points, axis=0))
    assert doubled in (3, 4, 5)


def test_cracks_of_surfaces():
    corners = [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    plate = delquad.triangles(corners, [(0, 1, 2), (0, 2, 3)])
    mesh = delquad.mesh(plate, size=0.1, embed=[([(0.2, 0.5, 1), (0.8, 0.5, 1)], "slit", True), (0.5, 0.2, 1)])
    assert len(mesh.triangles) == 0
    assert len(mesh.points) - len(np.unique(mesh.points, axis=0)) == 5  # ends inside are shared


def test_planar_curves_and_their_names():
    sides = [
        delquad.segment((0, 0), (2, 0), name="bottom"),
        delquad.arc((2, 1), 1, -math.pi / 2, math.pi / 2, name="right"),
        delquad.polyline([(2, 2), (1, 2), (0, 2)], name="top"),
        delquad.segment((0, 2), (0, 0), name="left"),
    ]
    hole = delquad.circle((1, 1), 0.4, name="hole")
    r = delquad.mesh(delquad.planar([delquad.loop(sides, region="plate"), [hole]]), size=0.1)
    assert [names for _, names in r.regions] == [["plate"]]
    assert {names[0] for _, names in r.curves} == {"bottom", "right", "top", "left", "hole"}
    assert area(r) == pytest.approx(4 + math.pi / 2 - math.pi * 0.16, rel=5e-3)
    index = [names for _, names in r.curves].index(["hole"])
    on_hole = r.points[np.unique(r.lines[r.line_curve == index])]
    assert np.hypot(*(on_hole[:, :2] - 1).T) == pytest.approx(0.4, abs=1e-12)


def test_a_filled_hole_shares_its_curve():
    circle = delquad.circle((0.5, 0.5), 0.3)
    outer = [delquad.polyline(SQUARE + SQUARE[:1])]
    model = delquad.planar([delquad.loop(outer, region="a"), delquad.loop([circle], region="b")])
    r = delquad.mesh(model, size=0.1)
    assert sorted(names[0] for _, names in r.regions) == ["a", "b"]
    assert area(r) == pytest.approx(1)


def test_curve_functions_get_arrays():
    calls = []

    def ellipse(t):
        calls.append(t.shape)
        return np.column_stack([2 * np.cos(t), np.sin(t)])

    r = delquad.mesh(delquad.planar([[delquad.curve(ellipse, 0, 2 * np.pi, name="rim")]]), size=0.1)
    x, y = r.points[np.unique(r.lines)][:, :2].T
    assert x**2 / 4 + y**2 == pytest.approx(1, abs=1e-8)
    assert 0 < len(calls) < 10 and all(len(shape) == 1 for shape in calls)


def test_lines_are_kept():
    points = np.array(SQUARE, dtype=float)
    n = 10
    corners = np.repeat(points, n, axis=0)
    ring = corners + np.tile(np.arange(n) / n, 4)[:, None] * (np.roll(corners, -n, axis=0) - corners)
    lines = np.column_stack([np.arange(4 * n), np.roll(np.arange(4 * n), -1)])
    r = delquad.mesh(delquad.lines(ring, lines, np.repeat(np.arange(4), n)))
    assert len(r.lines) == 4 * n and len(r.curves) == 4
    assert {tuple(p) for p in ring} <= {tuple(p[:2]) for p in r.points}


def test_triangles_of_lists_and_arrays():
    points, triangles = octahedron()
    r = delquad.mesh(delquad.triangles(points.tolist(), triangles.tolist()), size=0.3)
    assert area(r) == pytest.approx(4 * math.sqrt(3), rel=1e-6)
    assert r.sound and len(r.regions) == 8
    one = delquad.mesh(delquad.triangles(points, triangles), 0.3, compounds="all")
    assert len(one.regions) == 1


def test_examples():
    assert "bracket" in delquad.examples()
    r = delquad.mesh(delquad.example("bracket"), size=10, word="DB")
    assert r.sound and len(r.quads) > 100


def test_files(tmp_path):
    r = delquad.mesh(square(), size=0.2)
    r.write(tmp_path / "square.msh")
    again = delquad.mesh(tmp_path / "square.msh")
    assert len(again.lines) == len(r.lines)
    assert delquad.mesh(str(tmp_path / "square.msh"), size="boundary").metrics == again.metrics
    (tmp_path / "drawn.toml").write_text('size = 0.1\n[[loop]]\nrectangle = [[0, 0], [2, 1]]\nregion = "fluid"\n')
    drawn = delquad.mesh(tmp_path / "drawn.toml")
    assert len(drawn.quads) == 200 and drawn.regions == [(1, ["fluid"])]
    assert len(delquad.mesh(tmp_path / "drawn.toml", size=0.2).quads) == 50
    (tmp_path / "curved.toml").write_text("order = 2\nsize = 0.5\nloop = { circle = { centre = [0, 0], radius = 1 } }\n")
    assert [delquad.mesh(tmp_path / "curved.toml", order=order).order for order in (None, 1)] == [2, 1]


def test_a_mesh_is_a_model():
    points, triangles = octahedron()
    first = delquad.mesh(delquad.triangles(points, triangles), size=0.5)
    again = delquad.mesh(first, size=0.3)
    assert area(again) == pytest.approx(area(first))


def test_cad_from_bytes():
    r = delquad.mesh(delquad.cad(delquad.example_step("bracket")), size=10, word="DB")
    same = delquad.mesh(delquad.example("bracket"), size=10, word="DB")
    assert len(r.quads) == len(same.quads)


def test_cad_in_a_unit():
    step = delquad.cad(delquad.example_step("bracket"))
    plain, other = (delquad.mesh(step, size=size, word="DB", unit=unit) for size, unit in ((10, None), (1, "cm")))
    assert (plain.unit, other.unit) == ("mm", "cm")
    assert other.points.max(axis=0) * 10 == pytest.approx(plain.points.max(axis=0))
    points, triangles = octahedron()
    with pytest.raises(delquad.InputError, match="does not say its unit"):
        delquad.mesh(delquad.triangles(points, triangles), size=0.5, unit="m")


def test_cad_from_a_file(tmp_path):
    step = tmp_path / "bracket.step"
    step.write_bytes(delquad.example_step("bracket"))
    r = delquad.mesh(step, size=10, word="DB")
    same = delquad.mesh(delquad.example("bracket"), size=10, word="DB")
    assert len(r.quads) == len(same.quads)
