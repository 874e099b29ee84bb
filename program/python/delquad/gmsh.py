# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes the model that is open in Gmsh's Python API by quads:

    import gmsh, delquad.gmsh
    gmsh.initialize(); gmsh.open("part.step")
    delquad.gmsh.mesh(size=2)
    gmsh.write("part.msh")
"""

import numpy as np

try:
    import gmsh
except ImportError as error:
    raise ImportError(f"delquad.gmsh needs Gmsh's module (Debian's python3-gmsh, or pip install gmsh): {error}") from None

from . import _core
from ._mesh import mesh as _mesh

_LINE, _TRIANGLE, _QUAD, _POINT = 1, 2, 3, 15  # kinds of elements in Gmsh
_NEAR = 1e-6  # part of the diagonal: a node this near to a point of the model belongs to it


def _names(dim, tag):
    """Returns the entity's own name, then the names of its physical groups; unnamed groups have their number."""
    groups = gmsh.model.getPhysicalGroupsForEntity(dim, tag)
    return [f"gmsh {dim} {tag}", *(gmsh.model.getPhysicalName(dim, group) or f"group_{group}" for group in groups)]


def _tags(entities, dim):
    """Returns the tags of Gmsh's entities; 0 for curves that cut a face and are not in the model."""
    own = [next((name for name in names if name.startswith(f"gmsh {dim} ")), "0") for _, names in entities]
    return np.array([int(name.split()[-1]) for name in own])


def _elements(dim, kind, corners):
    """Returns the elements of all curves or surfaces: tags of nodes, index of each entity, and entities."""
    tags = [tag for _, tag in gmsh.model.getEntities(dim)]
    parts = [gmsh.model.mesh.getElementsByType(kind, tag)[1].reshape(-1, corners) for tag in tags]
    entity = np.repeat(np.arange(len(tags)), [len(part) for part in parts])
    return np.concatenate(parts or [np.empty((0, corners), np.uint64)]), entity, [(tag, _names(dim, tag)) for tag in tags]


def _surface():
    """Returns the mesh on the model's surfaces, and the lines on its curves."""
    lines, line_curve, curves = _elements(1, _LINE, 2)
    triangles, triangle_region, regions = _elements(2, _TRIANGLE, 3)
    quads, quad_region, _ = _elements(2, _QUAD, 4)
    if not len(triangles) + len(quads):
        raise _core.InputError("the model that is open in Gmsh has no triangles, and no surfaces to make them of")
    tags, points, _ = gmsh.model.mesh.getNodes()
    order = np.argsort(tags)
    used = np.unique(np.concatenate([lines.ravel(), triangles.ravel(), quads.ravel()]))
    points = points.reshape(-1, 3)[order][np.searchsorted(tags[order], used)]
    lines, triangles, quads = (np.searchsorted(used, elements) for elements in (lines, triangles, quads))
    return _core.Mesh(points, lines, line_curve, triangles, triangle_region, quads, quad_region, curves, regions)


def _lone_points():
    """Yields points with a node but on no curve, which are embedded into surfaces."""
    for _, tag in gmsh.model.getEntities(0):
        if not len(gmsh.model.getAdjacencies(0, tag)[0]) and len(gmsh.model.mesh.getNodes(0, tag)[0]):
            yield gmsh.model.getValue(0, tag, []), _names(0, tag)[-1]


def _is_discrete(dim, tag):
    return gmsh.model.getType(dim, tag).startswith("Discrete")


def _places(result, curve, surface):
    """Returns, for each node, the dimension and tag of its point or else its curve or else its surface."""
    places = np.full((len(result.points), 2), 2)
    places[result.triangles, 1] = surface[result.triangle_region][:, None]
    places[result.quads, 1] = surface[result.quad_region][:, None]
    on = curve[result.line_curve] > 0
    places[result.lines[on]] = np.stack([np.ones(on.sum(), int), curve[result.line_curve[on]]], axis=1)[:, None]
    near = _NEAR * np.linalg.norm(np.ptp(result.points, axis=0))
    for point in gmsh.model.getEntities(0):
        distance = np.linalg.norm(result.points - gmsh.model.getValue(*point, []), axis=1)
        if distance.min() < near:
            places[distance.argmin()] = point
    return places


def mesh(size=None, **settings):
    """Meshes the surfaces of the model that is open in Gmsh by quads, which replace its mesh. Returns the Result.

    size, settings: as for delquad.mesh(), without order (use gmsh.model.mesh.setOrder(2) afterwards) and without keywords
        that join or mirror entities. Names are the names of physical groups.

    Quads come from the mesh on the surfaces or, if there is none, from Gmsh's triangles. Nodes move onto the geometry, if
    any. Entities and physical groups stay; elements of volumes are removed. Raises the same as delquad.mesh().
    """
    for joined in ("compounds", "ignore_below", "idealize", "mirror", "symmetry"):
        if settings.get(joined):
            raise _core.InputError(f"{joined}: expected nothing: entities of Gmsh's model cannot become one, or more")
    if "order" in settings:
        raise _core.InputError("order: expected nothing, but gmsh.model.mesh.setOrder() afterwards")
    gmsh.model.mesh.setOrder(1)
    if not gmsh.model.mesh.getElements(2)[1]:
        gmsh.model.mesh.generate(2)
    if not any(_is_discrete(*surface) for surface in gmsh.model.getEntities(2)):
        settings.setdefault("feature_angle", 179)  # faces end at curves alone
    result = _mesh(_surface(), size, **{**settings, "embed": [*settings.get("embed", ()), *_lone_points()]})
    curve, surface = _tags(result.curves, 1), _tags(result.regions, 2)
    places, number = _places(result, curve, surface), np.arange(1, len(result.points) + 1)
    gmsh.model.mesh.clear()
    for dim, tag in np.unique(places, axis=0).tolist():
        here = (places == (dim, tag)).all(axis=1)
        points = result.points[here].ravel()
        if dim > 0 and not _is_discrete(dim, tag):
            points = gmsh.model.getClosestPoint(dim, tag, points)[0]
        gmsh.model.mesh.addNodes(dim, tag, number[here], points)
        if dim == 0:
            gmsh.model.mesh.addElementsByType(tag, _POINT, [], number[here])
    for kind, elements, entity in (
        (_LINE, result.lines, curve[result.line_curve]),
        (_TRIANGLE, result.triangles, surface[result.triangle_region]),
        (_QUAD, result.quads, surface[result.quad_region]),
    ):
        for tag in np.unique(entity[entity > 0]):
            gmsh.model.mesh.addElementsByType(tag, kind, [], number[elements[entity == tag]].ravel())
    return result
