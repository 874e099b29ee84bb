# SPDX-License-Identifier: GPL-3.0-or-later
"""From a solution to the next mesh."""

import os

import numpy as np

from . import _core
from ._mesh import _as_model


def _as_mesh(mesh):
    if isinstance(mesh, (str, os.PathLike)):
        return _core.read_mesh(os.fspath(mesh))
    if not isinstance(mesh, _core.Mesh):
        raise TypeError(f"mesh: expected a delquad.Mesh or the path of a file, got {type(mesh).__name__}")
    return mesh


def _columns(fields):
    """Returns (name, values) of each component."""
    named = fields.items() if isinstance(fields, dict) else [("field", fields)]
    columns = []
    for name, values in named:
        values = np.asarray(values)
        if values.ndim == 2:
            columns += [(f"{name}_{k}", values[:, k]) for k in range(values.shape[1])]
        else:
            columns.append((str(name), values))
    return columns


def adapt(
    mesh,
    fields,
    *,
    quads=None,
    error=None,
    norm=2.0,
    model=None,
    weight=None,
    isotropic=False,
    min_size=0.0,
    max_size=0.0,
    aspect=0.0,
    gradation=1.5,
    quality="good",
    threads=0,
    time_limit=0.0,
):
    """Returns the mesh with the least error of solutions, and their errors: (Result, {name: {"now", "gradient", "expected"}}).

    mesh: the planar mesh of the solutions, of triangles and quads; a Mesh or the path of a file.
    fields: values at its points, of shape (n,) or (n, k) with components, or {name: such values}.
    quads, error: the wanted number of quads, or the wanted error of interpolation: one of both, above 0.
    norm: p of the Lp norm of this error, from 1 to float("inf").
    model: as for mesh(); None: the domain of the mesh. Its size does not count.
    weight: the weight of errors at each point, at least 0, such as an adjoint solution.
    isotropic: square quads. min_size, max_size: limits of lengths; 0: none.
    aspect, gradation: limits of the ratio of lengths, at least 1, and of their growth per unit length, above 1; 0: none.
    quality, threads, time_limit: as for mesh().

    "now" is the estimated error of interpolation in the norm, and "gradient" the error of the gradient in L2. "expected" is the
    error of interpolation on the new mesh. Raises InputError for values that are not finite, or constant, and as mesh().
    """
    spec = _core.AdaptSpec(quads or 0, error or 0, norm, min_size, max_size, aspect, gradation, isotropic, quality)
    return _core.adapt(
        _as_mesh(mesh), _columns(fields), spec, weight, None if model is None else _as_model(model), threads, time_limit
    )


def recover_hessian(mesh, values):
    """Returns second derivatives xx, xy and yy of values at the points, of shape (n, 3). They come from the polynomial that fits best
    around each point [zhang2005]. Between regions the side with the larger ones counts."""
    return _core.recover(_as_mesh(mesh), values)[1]


def recover_gradient(mesh, values):
    """Returns the gradient of the polynomials of recover_hessian(), of shape (n, 2)."""
    return _core.recover(_as_mesh(mesh), values)[0]


def estimate_error(mesh, values, norm=2.0):
    """Returns the estimated errors of a solution: {"interpolation", "interpolation_of_elements", "gradient", "gradient_of_elements"}.

    The error of interpolation is in the Lp norm, 1 <= norm <= inf, by recovered Hessians. The error of the gradient is in L2, by
    recovered gradients [zienkiewicz1992]. Elements are triangles, then quads.
    """
    whole, each, gradient, each_gradient = _core.estimate(_as_mesh(mesh), values, norm)
    return {
        "interpolation": whole,
        "interpolation_of_elements": each,
        "gradient": gradient,
        "gradient_of_elements": each_gradient,
    }


def transfer(mesh, values, to, how="interpolated", of_elements=False):
    """Returns values on another mesh, `to`: at its points, or with `of_elements` on triangles and then quads.

    how: "interpolated", "conservative" (keeps the integral), or "bounded" (conservative and within the extremes nearby).
    Raises InputError for values that are not finite or not one per point (element).
    """
    return _core.transfer(_as_mesh(mesh), values, _as_mesh(to), how, of_elements)
