# SPDX-License-Identifier: GPL-3.0-or-later
"""extrude()."""

import os

from . import _core


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
