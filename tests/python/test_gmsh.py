# SPDX-License-Identifier: GPL-3.0-or-later
"""Quads for the model that is open in Gmsh."""

import numpy as np
import pytest

import delquad
from shapes import needed

gmsh = needed("gmsh")

import delquad.gmsh  # noqa: E402

LINE, TRIANGLE, QUAD, POINT = 1, 2, 3, 15


@pytest.fixture(autouse=True)
def opened():
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    yield
    gmsh.finalize()


def count(kind):
    return len(gmsh.model.mesh.getElementsByType(kind)[0])


def nodes(dim, tag):
    """Coordinates of those inside of an entity."""
    return gmsh.model.mesh.getNodes(dim, tag)[1].reshape(-1, 3)


def drilled_box():
    """3 x 2 x 1 with a hole of radius 0.5 along z, and a sphere of radius 1 beside it."""
    occ = gmsh.model.occ
    occ.addBox(0, 0, 0, 3, 2, 1)
    occ.addCylinder(1.5, 1, 0, 0, 0, 1, 0.5)
    occ.cut([(3, 1)], [(3, 2)])
    occ.addSphere(6, 0, 0, 1)
    occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.3)


def test_entities_of_a_solid():
    drilled_box()
    kinds = {tag: gmsh.model.getType(2, tag) for _, tag in gmsh.model.getEntities(2)}
    bore, ball = ([tag for tag in kinds if kinds[tag] == kind] for kind in ("Cylinder", "Sphere"))
    gmsh.model.addPhysicalGroup(2, bore, 7)
    gmsh.model.setPhysicalName(2, 7, "bore")
    r = delquad.gmsh.mesh(size=0.2, size_on={"bore": 0.1})
    assert count(QUAD) == len(r.quads) and count(TRIANGLE) == 0
    assert count(POINT) == len(gmsh.model.getEntities(0)) == 12  # ten of the box and its hole, two poles
    assert gmsh.model.getPhysicalName(2, 7) == "bore"
    points = gmsh.model.mesh.getNodesForPhysicalGroup(2, 7)[1].reshape(-1, 3) - (1.5, 1, 0)
    assert len(points) > 300 and np.allclose(np.hypot(points[:, 0], points[:, 1]), 0.5, atol=1e-12)
    assert np.allclose(np.linalg.norm(nodes(2, ball[0]) - (6, 0, 0), axis=1), 1, atol=1e-12)
    numbers, points, _ = gmsh.model.mesh.getNodes()
    points = points.reshape(-1, 3)[np.argsort(numbers)]
    for dim, tag in gmsh.model.getEntities(1) + gmsh.model.getEntities(2):
        nodes_of = gmsh.model.mesh.getElementsByType(LINE if dim == 1 else QUAD, tag)[1].astype(int)
        at = points[nodes_of - 1].reshape(-1, 2 * dim, 3)
        parts = at[:, 1] - at[:, 0] if dim == 1 else np.cross(at[:, 2] - at[:, 0], at[:, 3] - at[:, 1]) / 2
        exact = gmsh.model.occ.getMass(dim, tag)
        assert np.linalg.norm(parts, axis=1).sum() == pytest.approx(exact, rel=0.02, abs=1e-9)  # as good as chords are
    gmsh.model.mesh.setOrder(2)
    assert len(gmsh.model.mesh.getElements(2)[0]) == 1 and count(QUAD) == 0
    r = delquad.gmsh.mesh(size=0.3)  # of its own quads
    assert count(QUAD) == len(r.quads) and np.allclose(np.linalg.norm(nodes(2, ball[0]) - (6, 0, 0), axis=1), 1, atol=1e-12)


def test_a_plane_of_the_built_in_kernel():
    geo = gmsh.model.geo
    corners = [geo.addPoint(x, y, 0) for x, y in ((0, 0), (2, 0), (2, 1), (0, 1), (1, 0), (1, 1))]
    left = [geo.addLine(corners[a], corners[b]) for a, b in ((0, 4), (4, 5), (5, 3), (3, 0))]
    right = [geo.addLine(corners[a], corners[b]) for a, b in ((4, 1), (1, 2), (2, 5))]
    surfaces = [geo.addPlaneSurface([geo.addCurveLoop(loop)]) for loop in (left, [*right, -left[1]])]
    geo.synchronize()
    gmsh.model.addPhysicalGroup(1, [left[1]], 3)
    r = delquad.gmsh.mesh(size=0.25)
    assert [len(gmsh.model.mesh.getElementsByType(QUAD, tag)[0]) for tag in surfaces] == [16, 16]
    assert len(nodes(1, left[1])) == 3 and np.allclose(nodes(1, left[1])[:, 0], 1)
    assert ["group_3"] in [names[1:] for _, names in r.curves]


def test_what_is_embedded():
    occ = gmsh.model.occ
    plate, ends = occ.addRectangle(0, 0, 0, 2, 1), [occ.addPoint(x, 0.5, 0) for x in (0.5, 1.5)]
    line, point = occ.addLine(*ends), occ.addPoint(1, 0.2, 0)
    occ.synchronize()
    gmsh.model.mesh.embed(1, [line], 2, plate)
    gmsh.model.mesh.embed(0, [point], 2, plate)
    delquad.gmsh.mesh(size=0.1)
    assert len(nodes(1, line)) == 9 and np.allclose(nodes(1, line)[:, 1], 0.5)
    assert np.allclose(nodes(0, point), [(1, 0.2, 0)])


def test_what_cannot_be():
    with pytest.raises(delquad.InputError, match="no triangles"):
        delquad.gmsh.mesh(size=1)
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    with pytest.raises(delquad.InputError, match="setOrder"):
        delquad.gmsh.mesh(size=1, order=2)
    with pytest.raises(delquad.InputError, match="size"):
        delquad.gmsh.mesh()
