# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests results."""

import gc
import math
import re
import xml.etree.ElementTree

import numpy as np
import pytest

import delquad
from shapes import SQUARE, needed, octahedron, prism, square


def two_regions():
    circle = delquad.circle((0.5, 0.5), 0.3, name="rim")
    outer = [delquad.polyline(SQUARE + SQUARE[:1], name="box")]
    return delquad.planar([delquad.loop(outer, region="a"), delquad.loop([circle], region="b")])


def test_arrays_and_their_types():
    r = delquad.mesh(two_regions(), size=0.1)
    assert r.points.dtype == np.float64 and r.points.shape[1] == 3
    for array, columns in ((r.quads, 4), (r.triangles, 3), (r.lines, 2)):
        assert array.dtype == np.int32 and array.shape[1] == columns
    assert r.quad_region.shape == (len(r.quads),) and r.line_curve.shape == (len(r.lines),)
    assert set(np.unique(r.quad_region)) == set(range(len(r.regions)))
    assert r.triangles.shape == (0, 3) and r.triangle_region.shape == (0,)


def test_periodic_nodes_are_images():
    ends = delquad.triangles(*prism())
    pair = {"from": "region_1", "to": "region_2", "translate": (0, 0, 2)}
    r = delquad.mesh(ends, size=0.2, periodic=[pair])
    ((face, master, nodes),) = r.periodic_faces
    assert [r.regions[i][0] for i in (face, master)] == [2, 1]
    assert np.allclose(r.points[nodes[:, 0]] - r.points[nodes[:, 1]], (0, 0, 2), atol=1e-13)
    assert set(nodes[:, 0]) == set(r.quads[r.quad_region == face].ravel())
    assert len(r.periodic) > 0 and all(nodes.shape[1] == 2 for _, _, nodes in r.periodic)


def test_arrays_are_views_that_keep_the_mesh():
    r = delquad.mesh(square(), size=0.05)
    points, quads = r.points, r.quads
    assert points.__array_interface__["data"] == r.points.__array_interface__["data"]
    assert not points.flags.owndata and points.base is r
    with pytest.raises(ValueError):
        points[0, 0] = 1
    copies = points.copy(), quads.copy()
    del r
    gc.collect()
    for _ in range(5):
        delquad.mesh(square(), size=0.05)
    assert np.array_equal(points, copies[0]) and np.array_equal(quads, copies[1])


@pytest.mark.skipif(not hasattr(delquad._core, "write_view"), reason="built without its programs")
def test_a_view_is_a_page_and_a_frame(tmp_path, monkeypatch):
    for display in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(display, raising=False)
    view = delquad.mesh(square(), size=0.25).view(tmp_path / "m.html")
    page = (tmp_path / "m.html").read_text(encoding="utf-8")
    assert view.path == str(tmp_path / "m.html") and '"n_quads":16' in page
    frame = view._repr_html_()
    assert frame.startswith("<iframe srcdoc=") and frame.count("&lt;") == page.count("<") and frame.count("<") == 2


def test_what_is_known_of_the_mesh():
    r = delquad.mesh(square(), size=0.05)
    assert r.metrics["eta_mean"] == pytest.approx(1)
    assert all(isinstance(v, float) for v in r.metrics.values())
    assert r.summaries["insertion"]["inserted"] > 0
    assert r.seconds and all(s >= 0 for s in r.seconds.values()) and r.wall_seconds > 0
    assert r.expected_quads == pytest.approx(400)
    assert r.warnings == [] and r.failures == [] and r.sound
    assert "400 quads" in repr(r)


def test_options():
    plain = delquad.mesh(square(), "0.02 + 0.05*x", word="DB")
    coarse = delquad.mesh(square(), "0.02 + 0.05*x", word="DB", options={"insertion.h_max": np.float64(2)})
    assert len(coarse.points) < len(plain.points)
    raw = delquad.mesh(square(), 0.1, word="DB", options={"recombination.treatment": "none"})
    assert "treatment" not in raw.summaries


def test_warnings_are_texts():
    sliver = delquad.polygons([[(0, 0), (1, 0), (1, 0.02), (0, 0.02)]])
    r = delquad.mesh(sliver, size=5, allow_unsound=True)
    assert r.warnings and all(isinstance(w, str) for w in r.warnings)


def test_the_same_for_every_number_of_threads():
    model = delquad.triangles(*octahedron())
    a, b = (delquad.mesh(model, size=0.1, threads=n) for n in (1, 3))
    assert np.array_equal(a.points, b.points) and np.array_equal(a.quads, b.quads)


@pytest.mark.parametrize("kind", [".msh", ".vtu", ".obj", ".inp", ".mesh"])
def test_files_hold_the_mesh(tmp_path, kind):
    r = delquad.mesh(two_regions(), size=0.1)
    r.write(tmp_path / ("mesh" + kind))
    again = delquad.read_mesh(tmp_path / ("mesh" + kind))
    assert type(again) is delquad.Mesh
    assert len(again.quads) == len(r.quads) and np.allclose(again.points, r.points)


def test_help_tells_all_formats():
    assert all(kind in delquad.Mesh.write.__doc__ for kind in (".msh", ".gr3", ".svg"))
    assert ".mfem" in delquad.read_mesh.__doc__ and ".re2" not in delquad.read_mesh.__doc__


def test_meshio_there_and_back():
    needed("meshio")
    r = delquad.mesh(two_regions(), size=0.1)
    m = r.to_meshio()
    assert set(m.field_data) == {"a", "b", "rim", "box"}
    again = delquad.from_meshio(m)
    assert np.array_equal(again.points, r.points) and np.array_equal(again.quads, r.quads)
    assert again.regions == r.regions and again.curves == r.curves
    assert np.array_equal(again.quad_region, r.quad_region) and np.array_equal(again.line_curve, r.line_curve)


def test_meshio_of_others():
    meshio = needed("meshio")
    points = np.array(SQUARE + [(2, 0), (2, 1)], dtype=float)
    cells = [("quad", [[0, 1, 2, 3]]), ("vertex", [[0]]), ("triangle", [[1, 4, 2], [4, 5, 2]])]
    plain = delquad.from_meshio(meshio.Mesh(points, cells))
    assert len(plain.quads) == 1 and len(plain.triangles) == 2 and len(plain.regions) == 1
    data = {"gmsh:physical": [[7], [0], [0, 9]]}
    tagged = delquad.from_meshio(meshio.Mesh(points, cells, cell_data=data, field_data={"x": np.array([9, 2])}))
    tags = [tag for tag, _ in tagged.regions]
    assert len(set(tags)) == 3 and min(tags) > 0 and {7, 9} <= set(tags)
    assert dict(tagged.regions)[9] == ["x"]
    assert tags[tagged.triangle_region[1]] == 9 and tags[tagged.quad_region[0]] == 7


def test_pictures_for_notebooks():
    r = delquad.mesh(square(), size=0.1)
    root = xml.etree.ElementTree.fromstring(r._repr_svg_())
    assert root.tag.endswith("svg")
    assert delquad.mesh(delquad.triangles(*octahedron()), size=0.3)._repr_svg_().count("<path") > 0
    assert delquad.mesh(square(), size=0.005, word="DB")._repr_svg_() is None


def test_vtk():
    needed("vtkmodules.vtkFiltersCore")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersCore import vtkMassProperties, vtkTriangleFilter

    r = delquad.mesh(two_regions(), size=0.1)
    surface = r.to_vtk()
    assert surface.GetNumberOfCells() == len(r.quads)
    tags = [tag for tag, _ in r.regions]
    assert vtk_to_numpy(surface.GetCellData().GetArray("region")).tolist() == [tags[i] for i in r.quad_region]
    triangles, measure = vtkTriangleFilter(), vtkMassProperties()
    triangles.SetInputData(surface)
    measure.SetInputConnection(triangles.GetOutputPort())
    assert measure.GetSurfaceArea() == pytest.approx(1)


def test_pyvista():
    needed("pyvista")
    r = delquad.mesh(two_regions(), size=0.1)
    surface = r.to_pyvista()
    assert surface.n_cells == len(r.quads) and surface.area == pytest.approx(1)


def test_meshes_from_arrays():
    m = delquad.Mesh(SQUARE, [], [], [], [], [[0, 1, 2, 3]], [0], [], [(5, ["plate"])])
    assert m.points.shape == (4, 3) and m.regions == [(5, ["plate"])]
    assert math.isclose(np.ptp(m.points[:, 0]), 1)


def test_criteria_judge_elements():
    wedge = delquad.polygons([[(0, 0), (6, 0), (6, 2.8)]])
    result = delquad.mesh(wedge, 0.4, criteria="batch")
    report = result.criteria
    angle = next(limit for limit in report["limits"] if limit["criterion"] == "min_angle")
    assert 0 < report["failing"] < report["elements"] == len(result.quads)
    assert angle["limit"] == 40 and angle["cause"] == "corner" and angle["worst"] < 40
    assert result.metrics["failing"] == pytest.approx(100 * report["failing"] / report["elements"])
    corners = result.points[result.quads[angle["failing"]]]
    assert (np.linalg.norm(corners, axis=2).min(axis=1) < 2).any()
    assert delquad.judge(result, "batch", 0.4)["failing"] == report["failing"]
    assert delquad.mesh(wedge, 0.4).criteria is None
    with pytest.raises(delquad.UnsoundError, match="an angle below 40 degrees"):
        delquad.mesh(wedge, 0.4, criteria={"preset": "batch", "strict": True})
    material = {"young": 200.0, "poisson": 0.0, "density": 2.0}
    timed = delquad.mesh(wedge, 0.4, criteria={"min_time_step": 1e-9, "material": material}).criteria
    assert timed["critical_step"] == pytest.approx(report["critical_step"] / 10)
    for wrong, what in (
        ({"min_lenght": 1}, "did you mean 'min_length'"),
        ({"min_time_step": 1e-6}, "needs a material"),
        ({"max_aspect": 2, "material": {"young": 1.0, "poisson": 0.3}}, "density"),
        ({"min_length": 3, "max_length": 2}, "no element is within both"),
        ("batchh", "did you mean 'batch'"),
    ):
        with pytest.raises(delquad.InputError, match=what):
            delquad.mesh(wedge, 0.4, criteria=wrong)


def test_criteria_name_curves_and_cures():
    limits = {"max_aspect": 1.3, "min_length": "0.2 size"}
    report = delquad.mesh(delquad.example("sheet"), 2, criteria=limits).criteria
    assert any(re.search(r"reduce the size, to [0-9.]+ by curve \d+ in face", why) for why in report["why"])
    (cure,) = [cure for cure in report["cures"] if cure["key"] != "size"]
    assert (cure["cause"], cure["key"]) == ("short curve", "surface.ignore_below")
    assert 0.3 < cure["value"] < 0.33, "the step in the outline is 0.3 long"
    assert 0 < cure["count"] <= report["causes"]["short curve"]
