# SPDX-License-Identifier: GPL-3.0-or-later
"""All-quad meshes of planar domains and surfaces.

    import delquad
    result = delquad.mesh(delquad.polygons([[(0, 0), (1, 0), (1, 1), (0, 1)]]), size=0.05)
    result.write("square.msh")
"""

import os as _os

from . import _core
from ._core import (
    Cancelled,
    Curve,
    InputError,
    Loop,
    Mesh,
    Model,
    Result,
    TimeIsUp,
    __version__,
    arc,
    circle,
    crack,
    curve,
    example,
    example_step,
    examples,
    from_mesh,
    lines,
    loop,
    point,
    polyline,
    spline,
    qualities,
    segment,
    triangles,
)
from ._adapt import adapt, estimate_error, recover_gradient, recover_hessian, transfer
from ._exchange import View, from_meshio, read_mesh
from ._hexahedra import extrude, volume
from ._mesh import UnsoundError, cad, improve, judge, mesh, planar, polygons
from ._parts import add_cross, add_merge_cost, add_metric, add_size, add_stage, run

HexMesh = Mesh  # its name before hexahedra were part of Mesh

__all__ = [name for name in dir() if not name.startswith("_")]

# Messages and help call things by the name that users know.
for _thing in (Cancelled, InputError, TimeIsUp, UnsoundError):
    _thing.__module__ = "delquad"

# The program that reads CAD comes with this package.
_worker = _os.path.join(_os.path.dirname(__file__), "delquad-cad")
if _os.path.exists(_worker):
    _core.set_cad_worker(_worker)
