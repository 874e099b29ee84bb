# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes for and from other packages, which are imported only when needed."""

import os

from . import _core

# Larger pictures are slow to show, and show nothing.
_MOST_SHOWN = 20_000


def read_mesh(path):
    return _core.read_mesh(os.fspath(path))


read_mesh.__doc__ = f"Reads {', '.join(_core._extensions(written=False))}, perhaps with .gz behind."


def _write(self, path, binary=False, triangles=False, element=""):
    _core.Mesh._write_file(self, os.fspath(path), binary, triangles, element)


_write.__doc__ = f"Writes {', '.join(_core._extensions(written=True))} (docs/meshing.md tells more), whole or not at all. element: of cells in .inp, C3D8, C3D8I, C3D20, ..."


def _names(entities, kind):
    return [names[0] if names else f"{kind}_{tag}" for tag, names in entities]


def _to_meshio(self):
    """Returns a meshio.Mesh: cells in blocks by kind, with the tags of curves, regions and volumes as "gmsh:physical"."""
    import meshio
    import numpy as np

    def tags(entities, indices):
        return np.array([tag for tag, _ in entities] or [0], dtype=np.int32)[indices]

    blocks = [
        ("line", self.lines, tags(self.curves, self.line_curve)),
        ("triangle", self.triangles, tags(self.regions, self.triangle_region)),
        ("quad", self.quads, tags(self.regions, self.quad_region)),
        ("hexahedron", self.hexahedra, tags(self.volumes, self.hex_volume)),
        ("wedge", self.prisms, tags(self.volumes, self.prism_volume)),
        ("pyramid", self.pyramids, tags(self.volumes, self.pyramid_volume)),
        ("tetra", self.tetrahedra, tags(self.volumes, self.tet_volume)),
    ]
    blocks = [block for block in blocks if len(block[1])]
    field_data = {}
    for entities, kind, dim in ((self.curves, "curve", 1), (self.regions, "region", 2), (self.volumes, "volume", 3)):
        for (tag, _), name in zip(entities, _names(entities, kind)):
            field_data.setdefault(name, np.array([tag, dim]))
    return meshio.Mesh(
        self.points,
        [(kind, cells) for kind, cells, _ in blocks],
        cell_data={"gmsh:physical": [tag for _, _, tag in blocks]},
        field_data=field_data,
    )


def from_meshio(mesh):
    """Returns a Mesh of the lines, triangles and quads of a meshio.Mesh; other cells are left out.

    Curves and regions are distinguished by "gmsh:physical", "gmsh:geometrical", "medit:ref" or "cell_tags".
    """
    import numpy as np

    keys = ("gmsh:physical", "gmsh:geometrical", "medit:ref", "cell_tags")
    data = next((mesh.cell_data[key] for key in keys if key in mesh.cell_data), None)
    found = {kind: ([], []) for kind in ("line", "triangle", "quad")}
    for i, block in enumerate(mesh.cells):
        if block.type not in found:
            continue
        cells, tags = found[block.type]
        cells.append(np.asarray(block.data))
        tags.append(np.ones(len(block.data), dtype=np.int64) if data is None else np.asarray(data[i], dtype=np.int64))
    names = {(int(dim), int(tag)): name for name, (tag, dim) in mesh.field_data.items()}

    def joined(kind, columns):
        cells, tags = found[kind]
        if not cells:
            return np.empty((0, columns), dtype=np.int64), np.empty(0, dtype=np.int64)
        return np.concatenate(cells), np.concatenate(tags)

    lines, line_tags = joined("line", 2)
    triangles, triangle_tags = joined("triangle", 3)
    quads, quad_tags = joined("quad", 4)

    def entities(tags, dim):
        """Returns entities for the tags, and tags as indices of these."""
        unique, index = np.unique(tags, return_inverse=True)
        given = [int(tag) for tag in unique]
        # Numbers in files are positive; "none" often is 0.
        free = iter(tag for tag in range(1, len(given) + max(given, default=0) + 2) if tag not in given)
        return [(t if t > 0 else next(free), [names[dim, t]] if (dim, t) in names else []) for t in given], index

    curves, line_curve = entities(line_tags, 1)
    regions, region = entities(np.concatenate([triangle_tags, quad_tags]), 2)
    return _core.Mesh(
        mesh.points, lines, line_curve, triangles, region[: len(triangles)], quads, region[len(triangles) :],
        curves, regions,
    )


def _to_vtk(self):
    """Returns a vtkPolyData of triangles and quads, with the tags of their regions as "region"."""
    import numpy as np
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    def faces(elements):
        return np.insert(elements.astype(np.int64), 0, elements.shape[1], axis=1).ravel()

    points = vtkPoints()
    points.SetData(numpy_to_vtk(self.points, deep=True))
    cells = vtkCellArray()
    flat = np.concatenate([faces(self.triangles), faces(self.quads)])
    cells.SetCells(len(self.triangles) + len(self.quads), numpy_to_vtkIdTypeArray(flat, deep=True))
    regions = np.concatenate([self.triangle_region, self.quad_region])
    tags = numpy_to_vtk(np.array([tag for tag, _ in self.regions] or [0], dtype=np.int32)[regions], deep=True)
    tags.SetName("region")
    surface = vtkPolyData()
    surface.SetPoints(points)
    surface.SetPolys(cells)
    surface.GetCellData().AddArray(tags)
    return surface


def _to_pyvista(self):
    """Returns a pyvista.PolyData of triangles and quads, with the tags of their regions as "region"."""
    import pyvista

    return pyvista.wrap(self.to_vtk())


def _svg(self):
    """Returns a picture for notebooks; None for meshes that are too large for one."""
    n = len(self.quads) + len(self.triangles)
    if n == 0 or n > _MOST_SHOWN:
        return None
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "mesh.svg")
        self.write(path)
        with open(path, encoding="utf-8") as file:
            return file.read()


class View:
    """A page that shows a mesh; its file is `path`. A notebook shows it in a frame."""

    def __init__(self, path):
        self.path = path

    def _repr_html_(self):
        import html
        import pathlib

        page = html.escape(pathlib.Path(self.path).read_text(encoding="utf-8"))
        return f'<iframe srcdoc="{page}" sandbox="allow-scripts allow-downloads" style="width: 100%; height: 800px; border: 0"></iframe>'


def _view(self, path=None):
    """Writes a page that shows the mesh, and returns it: one HTML file with shape, sizes, names and the worst quads.

    path: the file; None for a new one in a temporary folder. A browser opens it if there is a display, unless a notebook
    shows it.
    """
    import sys
    import tempfile
    import webbrowser

    if not hasattr(_core, "write_view"):
        raise RuntimeError("delquad was built without its programs (DELQUAD_PROGRAMS)")
    path = os.path.join(tempfile.mkdtemp(prefix="delquad-"), "mesh.html") if path is None else os.fspath(path)
    _core.write_view(path, self, os.path.splitext(os.path.basename(path))[0], list(getattr(self, "warnings", [])))
    in_notebook = "IPython" in sys.modules and getattr(sys.modules["IPython"].get_ipython(), "kernel", None) is not None
    if not in_notebook and (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        webbrowser.open(f"file://{os.path.abspath(path)}")
    return View(path)


def _repr(self):
    kind = type(self).__name__
    cells = "".join(f", {len(getattr(self, name))} {name}" for name in ("hexahedra", "prisms", "pyramids", "tetrahedra") if len(getattr(self, name)))
    return f"<delquad.{kind}: {len(self.points)} points, {len(self.quads)} quads, {len(self.triangles)} triangles{cells}>"


_core.Mesh.write = _write
_core.Mesh.view = _view
_core.Mesh.to_meshio = _to_meshio
_core.Mesh.to_vtk = _to_vtk
_core.Mesh.to_pyvista = _to_pyvista
_core.Mesh._repr_svg_ = _svg
_core.Mesh.__repr__ = _repr
