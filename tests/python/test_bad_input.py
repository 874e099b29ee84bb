# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests models that cannot be meshed: an exception that says what and where, and an interpreter that goes on."""

import pathlib
import re
import tomllib

import numpy as np
import pytest

import delquad
from shapes import SQUARE, octahedron, square


def says(exception, pattern, *arguments, **named):
    with pytest.raises(exception, match=pattern):
        delquad.mesh(*arguments, **named)


def test_exceptions_are_the_usual_ones():
    assert issubclass(delquad.InputError, ValueError)
    assert issubclass(delquad.TimeIsUp, delquad.Cancelled)
    assert delquad.InputError.__module__ == "delquad"


@pytest.mark.parametrize(
    "make, pattern",
    [
        (lambda: delquad.polygons([]), "there are none"),
        (lambda: delquad.polygons([[(0, 0), (1, 0)]]), "polygon 1: 2 corners"),
        (lambda: delquad.polygons([np.zeros((4, 3))]), r"polygon 1: expected numbers of shape \(n, 2\).*\(4, 3\)"),
        (lambda: delquad.polygons([[(0, 0), (1, 0), (1, np.nan)]]), "polygon 1: point 2 is"),
        (lambda: delquad.polygons([[(0, 0), (1,), (1, 1)]]), "polygon 1: expected numbers"),
        (lambda: delquad.polygons([["a", "b", "c"]]), "polygon 1: expected numbers"),
        (lambda: delquad.polygons([SQUARE + [(0, 0)]]), "closes by itself"),
        (lambda: delquad.circle((0, 0), -1), "radius is -1"),
        (lambda: delquad.circle((0, 0, 0), 1), "circle's centre: expected 2 numbers, got 3"),
        (lambda: delquad.segment((0, 0), (0, 0)), "no length"),
        (lambda: delquad.curve(lambda t: t, 0, 1), r"function: expected numbers of shape \(n, 2\)"),
        (lambda: delquad.curve(lambda t: np.zeros((2, 2)), 0, 1), "expected .* points, one for each parameter, got 2"),
        (lambda: delquad.curve(lambda t: np.full((len(t), 2), np.nan), 0, 1), "finite coordinates"),
        (lambda: delquad.lines(SQUARE, [(0, 4)]), "line 0 has point 4: there are 4"),
        (lambda: delquad.lines(SQUARE, [(0, 1.5)]), "lines: expected whole numbers"),
        (lambda: delquad.lines(SQUARE, [(0, 1)], [0, 1]), "1 lines, but 2 numbers"),
        (lambda: delquad.lines(SQUARE, [(0, 1)], [-1]), "line 0 is of curve -1"),
        (lambda: delquad.triangles(SQUARE, [(0, 1, 2, 3)]), r"shape \(n, 3\), got an array of shape \(1, 4\)"),
        (lambda: delquad.triangles(SQUARE, [(0, 1, -1)]), "triangle 0 has point -1"),
        (lambda: delquad.triangles(SQUARE, [(0, 1, 2**40)]), "out of range"),
        (lambda: delquad.triangles([(0, 0, np.inf)], []), "point 0 is"),
        (lambda: delquad.Mesh(SQUARE, [], [], [], [], [(0, 1, 2, 4)], [0], [], [(1, [])]), "quad 0 has point 4"),
    ],
)
def test_models(make, pattern):
    with pytest.raises(delquad.InputError, match=pattern):
        make()


def test_models_that_fail_when_they_are_meshed(tmp_path):
    says(delquad.InputError, "neither triangles nor quads", delquad.triangles(SQUARE, np.empty((0, 3), int)), 1)
    says(delquad.InputError, "no line elements", delquad.lines(SQUARE, np.empty((0, 2), int)), 1)
    says(delquad.InputError, "open", delquad.planar([[delquad.segment((0, 0), (1, 0))]]), 1)
    says(delquad.InputError, "no loops", delquad.planar([]), 1)
    says(delquad.InputError, "no such example|unknown example|'nothing'", delquad.example("nothing"), 1)
    says(delquad.InputError, "none.step", tmp_path / "none.step", 1)
    (tmp_path / "a.xyz").touch()
    says(delquad.InputError, "unknown kind", tmp_path / "a.xyz", 1)
    says(TypeError, "model: expected", 17, 1)
    (tmp_path / "broken.msh").write_bytes(b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2 3")
    says(delquad.InputError, "broken.msh", tmp_path / "broken.msh", 1)


@pytest.mark.parametrize(
    "named, pattern",
    [
        ({}, "expected a size"),
        ({"size": 0}, "size: size 0: expected a finite number > 0"),
        ({"size": -1}, "size: size -1: expected a finite number > 0"),
        ({"size": float("nan")}, "size: .* must be a finite number"),
        ({"size": ""}, "size"),
        ({"size": "x +"}, "size: .*x +"),
        ({"size": 0.1, "word": "XY"}, "X"),
        ({"size": 0.1, "word": ""}, "empty"),
        ({"size": 0.1, "word": "BD"}, "B"),
        ({"size": 0.1, "quality": "superb"}, "superb.*fast, good, best, regular"),
        ({"size": 0.1, "quality": "good", "word": "DB"}, "exclude each other"),
        ({"size": 0.1, "gradation": -1}, "gradation: 'gradation' is -1: expected a number above 0"),
        ({"size": 0.1, "min_size": 0.01}, "'curvature' too"),
        ({"size": 0.1, "feature_angle": 30}, "planar"),
        ({"size": 0.1, "max_elements": 0}, "'max_elements' is 0: expected at least 1"),
        ({"size": 1e-5}, "more than the"),
        ({"size": 0.1, "seed": -1}, "seed: 'seed' is -1"),
        ({"size": 0.1, "sources": [((0, 0, 0), (0, 0, 0), 0, 1, 0, 1)]}, "sources: 'near' is 0: expected a number above 0"),
        ({"size": 0.1, "cross": "sideways"}, "cross"),
    ],
)
def test_problems(named, pattern):
    says(delquad.InputError, pattern, square(), **named)


# The rows that the command line and model files are tried with.
ROWS = re.findall(r"^  \| (\w+\.\w+)=(\S+) \| (.*)$", (pathlib.Path(__file__).parents[1] / "program/refusals.txt").read_text(), re.MULTILINE)


@pytest.mark.parametrize("key, value, words", ROWS)
def test_keys_of_stages(key, value, words):
    pattern = "options: .*" + ".*".join(map(re.escape, words.split(" ... ")))
    says(delquad.InputError, pattern, square(), 0.1, options={key: tomllib.loads("it = " + value.replace("\\", ""))["it"]})


def test_surfaces():
    model = delquad.triangles(*octahedron())
    says(delquad.InputError, "there is no size: expected a number", model)
    says(delquad.InputError, "feature_angle: 'feature_angle' is 200", model, 0.2, feature_angle=200)
    says(delquad.InputError, "weld: 'weld_tolerance' is 2", model, 0.2, weld=2)
    says(delquad.InputError, "curvature: 'curvature' is 1", model, 0.2, curvature=1)
    says(delquad.InputError, "compounds: compound 'some'", model, 0.2, compounds="some")
    says(delquad.InputError, "no face 77", model, 0.2, compounds=[[1, 77]])
    says(delquad.InputError, "surface takes its crosses", model, 0.2, cross=lambda x: x[:, 0])


def test_keywords():
    says(TypeError, "no keyword 'gradaton'; did you mean 'gradation'", square(), 0.1, gradaton=0.2)
    says(TypeError, "sources: 7 values: expected at most 6, of at, to, near", square(), 0.1, sources=[(0,) * 7])
    says(delquad.InputError, "layers: unknown key 'layer.frist'; did you mean 'first'", square(), 0.1, layers={"on": "a", "frist": 1})
    says(delquad.InputError, "size_on: 'size.on' must be a table or a list of tables", square(), 0.1, size_on=0.1)


@pytest.mark.parametrize("size", [[], None.__class__, object(), (1, 2), {}])
def test_sizes_of_no_use(size):
    if callable(size):
        says(TypeError, "", square(), size=size)
    else:
        says(TypeError, "size: expected a number", square(), size=size)


class Mine(Exception):
    pass


@pytest.mark.parametrize("what", ["size", "cross"])
def test_callbacks(what):
    def given(function):
        return {"size": 0.1, what: function}

    def fails(x):
        raise Mine("as it is")

    with pytest.raises(Mine, match="^as it is$") as caught:
        delquad.mesh(square(), **given(fails))
    assert caught.traceback[-1].name == "fails"
    name = f"the result of the {what} function"
    says(delquad.InputError, name + ": expected .* numbers, one for each point.*shape \\(3,\\)", square(),
         **given(lambda x: np.ones(3)))
    says(delquad.InputError, name + ": expected .*shape", square(), **given(lambda x: x))
    says(delquad.InputError, name + ".*NoneType", square(), **given(lambda x: None))
    says(delquad.InputError, name + ".*complex", square(), **given(lambda x: np.full(len(x), 1j)))
    says(delquad.InputError, f"{what}: the {what} function is .*nan|not a finite number", square(),
         **given(lambda x: np.full(len(x), np.nan)))
    says(TypeError, "positional argument", square(), **given(lambda: 0))
    assert delquad.mesh(square(), 0.2).sound


def test_sizes_that_are_bad_somewhere():
    says(delquad.InputError, r"size: the size function is -0\.\d+ at \(0\.\d+, .*a finite length > 0", square(),
         size=lambda x: x[:, 0] - 0.5)


def test_nodal_values():
    mesh = delquad.mesh(square(), 0.2)
    says(delquad.InputError, "but there are 3 values", square(), size=(mesh, np.ones(3)))
    says(delquad.InputError, "nodal size 0 is -1", square(), size=(mesh, np.full(len(mesh.points), -1)))
    says(delquad.InputError, "nodal angle 0 is nan", square(), size=0.1, cross=(mesh, np.full(len(mesh.points), np.nan)))


def test_an_unsound_mesh_comes_with_its_error(tmp_path):
    # A node in the middle of a triangle's side: one quad, with an angle of 180 degrees, that nothing repairs.
    points = [(0, 0), (1, 0), (2, 0), (1, 1)]
    lines = [(0, 1), (1, 2), (2, 3), (3, 0)]
    delquad.Mesh(points, lines, [0] * 4, [], [], [], [], [(1, ["rim"])], []).write(tmp_path / "flat.msh")
    model = tmp_path / "flat.toml"
    model.write_text('mesh = "flat.msh"\nsize = 2\nrecombination = { treatment = "none" }\n')
    with pytest.raises(delquad.UnsoundError, match=r"not sound: 1 quad is inverted or flat.*\(1, 0.25, 0\)") as caught:
        delquad.mesh(model, word="DB")
    assert len(caught.value.result.quads) == 1 and not caught.value.result.sound
    again = delquad.mesh(model, word="DB", allow_unsound=True)
    assert again.unsound == caught.value.result.unsound
    with pytest.raises(delquad.UnsoundError, match="beyond the limits") as caught:
        delquad.mesh(square(), 0.27, max_aspect=1)
    result = caught.value.result
    assert not result.sound and result.unsound == result.beyond_limits and result.unsound[0] in result.warnings[-1]


def test_files_that_cannot_be_written(tmp_path):
    r = delquad.mesh(square(), 0.2)
    with pytest.raises(delquad.InputError, match="nowhere"):
        r.write(tmp_path / "nowhere" / "a.msh")
    with pytest.raises(delquad.InputError, match="xyz"):
        r.write(tmp_path / "a.xyz")
