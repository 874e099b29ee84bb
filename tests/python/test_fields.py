# SPDX-License-Identifier: GPL-3.0-or-later
"""Sizes and crosses."""

import threading

import numpy as np
import pytest

import delquad
from shapes import octahedron, square


def edge_lengths(mesh):
    a, b = mesh.points[mesh.quads], mesh.points[np.roll(mesh.quads, -1, axis=1)]
    return np.linalg.norm(b - a, axis=2).ravel(), ((a + b) / 2).reshape(-1, 3)


def test_functions_get_batches_in_the_calling_thread():
    calls = []

    def size(x):
        calls.append((x.shape, x.dtype, threading.get_ident()))
        return 0.02 + 0.1 * x[:, 0]

    r = delquad.mesh(square(), size=size)
    assert 1 <= len(calls) <= 20
    assert all(shape[1:] == (3,) and dtype == float for shape, dtype, _ in calls)
    assert {thread for _, _, thread in calls} == {threading.get_ident()}
    assert sum(shape[0] for shape, _, _ in calls) < 100_000
    lengths, middles = edge_lengths(r)
    assert np.median(lengths / (0.02 + 0.1 * middles[:, 0])) == pytest.approx(1, abs=0.1)


def test_a_constant_function_is_the_constant():
    by_number = delquad.mesh(square(), size=0.05)
    calls = []
    for function in (lambda x: 0.05, lambda x: np.full(len(x), 0.05), lambda x: [0.05] * len(x)):
        r = delquad.mesh(square(), size=lambda x: calls.append(len(x)) or function(x))
        assert np.array_equal(r.points, by_number.points) and np.array_equal(r.quads, by_number.quads)
    assert len(calls) == 3


def test_sizes_are_divided_and_found_by_number():
    half = delquad.mesh(square(), size=0.05)
    divided = delquad.mesh(square(), size=0.1, refine=2)
    assert np.array_equal(half.points, divided.points) and np.array_equal(half.quads, divided.quads)
    assert len(delquad.mesh(square(), quads=900).quads) == 900
    graded = delquad.mesh(square(), size=lambda x: 1 + 4 * x[:, 0], quads=900)
    assert len(graded.quads) == pytest.approx(900, rel=0.03)
    for wrong in ({"size": 0.1, "quads": 900}, {"quads": 0}, {"size": 0.1, "refine": 0}):
        with pytest.raises(delquad.InputError, match="quads|refine"):
            delquad.mesh(square(), **wrong)


def test_the_arrays_are_the_callbacks_own():
    kept = []

    def size(x):
        kept.append(x)
        x += 1e9
        return 0.1 + 0.1 * (x[:, 0] > 1e9 + 0.5)

    delquad.mesh(square(), size=size)
    assert all(x.flags.owndata or x.base is not None for x in kept)
    assert kept[0].min() > 1e8


def test_formulas_and_limits():
    a = delquad.mesh(square(), size="0.02 + 0.1*x", word="DB")
    b = delquad.mesh(square(), size=lambda x: 0.02 + 0.1 * x[:, 0], word="DB")
    assert a.expected_quads == pytest.approx(b.expected_quads, rel=1e-3)
    capped = delquad.mesh(square(), size="0.02 + 0.1*x", max_size=0.04)
    assert len(capped.quads) > 1.3 * len(a.quads)
    graded = delquad.mesh(square(), size=lambda x: np.where(x[:, 0] < 0.5, 0.01, 0.2), gradation=0.2)
    assert len(graded.quads) > 5000


def test_sources():
    r = delquad.mesh(square(), size=0.1, sources=[((0, 0, 0), (0, 1, 0), 0.01, 0.1, 0, 0.5)])
    lengths, middles = edge_lengths(r)
    assert np.median(lengths[middles[:, 0] < 0.05]) < 0.03


def test_sizes_by_name():
    sides = [delquad.segment((0, 0), (1, 0), "floor"), delquad.polyline([(1, 0), (1, 1), (0, 1), (0, 0)])]
    for asked in (0.02, {"size": 0.02, "reach": 0.01, "growth": 0.5}):
        r = delquad.mesh(delquad.planar([sides]), size=0.2, size_on={"floor": asked}, word="DB")
        assert abs(np.count_nonzero(r.points[:, 1] == 0) - 51) <= 1
        assert np.count_nonzero(r.points[:, 1] == 1) <= 8
    with pytest.raises(delquad.InputError, match="nothing is called 'inlet'"):
        delquad.mesh(square(), size=0.2, size_on={"inlet": 0.02})


def test_nodal_sizes():
    background = delquad.mesh(square(), size=0.2)
    values = 0.02 + 0.1 * background.points[:, 0]
    r = delquad.mesh(square(), size=(background, values))
    expected = delquad.mesh(square(), size="0.02 + 0.1*x")
    assert r.expected_quads == pytest.approx(expected.expected_quads, rel=1e-3)


def directions(mesh):
    """Angles of edges in [0, pi/2)."""
    d = mesh.points[np.roll(mesh.quads, -1, axis=1)] - mesh.points[mesh.quads]
    return np.arctan2(d[..., 1], d[..., 0]).ravel() % (np.pi / 2)


@pytest.mark.parametrize("kind", ["function", "text", "nodal"])
def test_crosses(kind):
    background = delquad.mesh(square(), size=0.2)
    cross = {
        "function": lambda x: np.full(len(x), 0.5),
        "text": "0.5",
        "nodal": (background, np.full(len(background.points), 0.5)),
    }[kind]
    r = delquad.mesh(square(), size=0.03, cross=cross, word="DB")
    assert np.median(directions(r)) == pytest.approx(0.5, abs=0.1)


def test_cross_functions_get_points_of_the_plane():
    shapes = []
    delquad.mesh(square(), size=0.1, cross=lambda x: shapes.append(x.shape) or x[:, 0])
    assert all(shape[1:] == (2,) for shape in shapes)


def test_named_crosses_and_qualities():
    size = "0.03 + 0.05*x"
    by_quality = delquad.mesh(square(), size=size, quality="good")
    options = {"regularity.quads": 60, "regularity.rounds": 1, "regularity.tolerance": 0.0,
               "recombination.settled": 0.05}
    by_word = delquad.mesh(square(), size=size, word="DBQO", cross="size-aware", options=options)
    assert np.array_equal(by_quality.points, by_word.points)
    plain = delquad.mesh(square(), size=size, word="DBQO", options=options)
    assert not np.array_equal(plain.points, by_word.points)
    assert delquad.mesh(square(), size=size, cross="gradient", word="DB").sound
    assert delquad.qualities()["fast"] == "DB"


def test_functions_on_surfaces():
    model = delquad.triangles(*octahedron())
    r = delquad.mesh(model, size=lambda x: 0.05 + 0.2 * np.abs(x[:, 2]))
    lengths, middles = edge_lengths(r)
    assert np.median(lengths / (0.05 + 0.2 * np.abs(middles[:, 2]))) == pytest.approx(1, abs=0.15)
