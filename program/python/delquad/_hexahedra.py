# SPDX-License-Identifier: GPL-3.0-or-later
"""extrude() and volume()."""

import os
import warnings

from . import _core
from ._mesh import mesh as _mesh


def extrude(
    mesh, *, along=None, around=None, angle=360.0, curve=None, normals=None, both_sides=False, layers=0, growth=1.0, heights=None, threads=0, time_limit=0.0
):
    """Sweeps a mesh of quads, or the file of one, and returns a Mesh of hexahedra. One of these sets the path:

    along: a vector from the first layer of nodes to the last.
    around: a point of an axis and its direction; angle: from -360 to 360 degrees, not 0; a full turn closes the ring.
    curve: points of a line of shape (n, 3), along which the section moves and turns.
    normals: a thickness along the normals, negative against them; both_sides: half of it to each side.

    layers: their number; 0, with curve only, for one on each segment. growth: height of a layer over the previous height, above 0.
    heights: a dict from names of regions to lengths, with along or normals; a layer ends at each height.
    threads: 0 for the number of cores. time_limit: in seconds; 0 for none.

    Regions become volumes. Curves on the boundary and named inner curves become faces, named points curves. The start and
    the end of the sweep are faces "NAME start" and "NAME end". Raises InputError if hexahedra would be inverted, or the
    body would meet itself.
    """
    if isinstance(mesh, (str, os.PathLike)):
        mesh = _core.read_mesh(os.fspath(mesh))
    elif not isinstance(mesh, _core.Mesh):
        raise TypeError(f"mesh: expected a delquad.Mesh or the path of a file, got {type(mesh).__name__}")
    if sum(way is not None for way in (along, around, curve, normals)) != 1:
        raise _core.InputError("expected one of along, around, curve and normals")
    point, axis = (None, None) if around is None else around
    return _core.extrude(mesh, layers, growth, heights or {}, threads, time_limit, along, point, axis, angle, curve, normals, both_sides)


def volume(model, size=None, *, cells="hex-dominant", strategy="DBCO", layers=None, layers_on=(), max_elements=50_000_000, threads=0, time_limit=0.0, **settings):
    """Fills a closed model and returns a Mesh with hexahedra, pyramids and tetrahedra.

    model: as for mesh(), which makes the skin with size and settings; or a Mesh of closed quads, which stay as they are.
    cells: "hex-dominant" and "pyramids-and-tets" keep the quads, "tets" splits each into two triangles.
        With order=2, "tets" have middle nodes on the model, which write(element="C3D10") needs.
    strategy: stages of "hex-dominant", by letter. F or D place points, of equilateral tetrahedra or of cubes. B recombines
        them, C cleans up, O optimizes the other cells. C and O may be absent.
    layers: (first height, growth, number) of hexahedra on the faces named in layers_on, or on all. They end on rows of quads
        that the skin of a model gets, elsewhere by prisms.
    max_elements: of the skin, and of cells. threads: 0 for the number of cores.
    time_limit: in seconds, of the skin and of the cells; 0 for none.

    Warns of places where layers are lower or end. Bodies become volumes, and regions of the skin faces. Raises InputError,
    with the place, if quads are open or cross each other, or a body cannot be filled.
    """
    layers_on = [layers_on] if isinstance(layers_on, str) else list(layers_on)
    if layers is not None:
        if not (len(layers) == 3 and float(layers[2]).is_integer()):
            raise _core.InputError(f"layers: {layers}: expected first height, growth and a whole number")
        layers = (layers[0], layers[1], int(layers[2]))
    if layers_on and layers is None:
        raise _core.InputError("layers_on goes with layers only")
    if isinstance(model, _core.Mesh):
        if size is not None or settings:
            raise _core.InputError(f"volume() of a Mesh keeps its quads: expected no {'size' if size is not None else next(iter(settings))}")
    else:
        settings |= dict(max_elements=max_elements, threads=threads, time_limit=time_limit)
        skin = _mesh(model, size, **settings)
        if rows := _core.rows_beside(skin, layers, layers_on) if layers_on else None:
            try:
                skin = _mesh(model, size, layers=[rows], **settings)
            except _core.InputError as error:
                warnings.warn(f"layers end by prisms at other faces, which get none: {error}", stacklevel=2)
        model = skin
    mesh, notes = _core.fill_skin(model, cells, strategy, max_elements, threads, time_limit, layers, layers_on)
    for note in notes:
        warnings.warn(note, stacklevel=2)
    return mesh
