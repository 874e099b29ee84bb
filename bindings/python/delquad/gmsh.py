"""Quads for the model that is open in Gmsh's Python API:

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
_NEAR = 1e-6  # of the diagonal: a node this near to a point of the model is that point's


def _names(dim, tag):
    """First the entity's own, then those of its physical groups; a group without a name goes by its number."""
    groups = gmsh.model.getPhysicalGroupsForEntity(dim, tag)
    return [f"gmsh {dim} {tag}", *(gmsh.model.getPhysicalName(dim, group) or f"group_{group}" for group in groups)]


def _tags(entities, dim):
    """Of Gmsh's entities; 0 for curves that are not the model's, by which a face was cut."""
    own = [next((name for name in names if name.startswith(f"gmsh {dim} ")), "0") for _, names in entities]
    return np.array([int(name.split()[-1]) for name in own])


def _elements(dim, kind, corners):
    """Of all curves or surfaces: tags of nodes, the index of each one's entity, and the entities."""
    tags = [tag for _, tag in gmsh.model.getEntities(dim)]
    parts = [gmsh.model.mesh.getElementsByType(kind, tag)[1].reshape(-1, corners) for tag in tags]
    entity = np.repeat(np.arange(len(tags)), [len(part) for part in parts])
    return np.concatenate(parts or [np.empty((0, corners), np.uint64)]), entity, [(tag, _names(dim, tag)) for tag in tags]


def _surface():
    """The mesh that the model has on its surfaces, and the lines on its curves."""
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
    """Points with a node, but on no curve: those that were embedded into surfaces."""
    for _, tag in gmsh.model.getEntities(0):
        if not len(gmsh.model.getAdjacencies(0, tag)[0]) and len(gmsh.model.mesh.getNodes(0, tag)[0]):
            yield gmsh.model.getValue(0, tag, []), _names(0, tag)[-1]


def _is_discrete(dim, tag):
    return gmsh.model.getType(dim, tag).startswith("Discrete")


def _places(result, curve, surface):
    """For each node the dimension and tag of what it lies on: a surface, but for those of a curve, but for those of a point."""
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
    """Meshes the surfaces of the model that is open in Gmsh by quads, which take the place of its mesh there.

    size, settings: as of delquad.mesh(), but order (gmsh.model.mesh.setOrder(2) comes after) and what joins or mirrors entities; names are those of physical
        groups. Returns the Result.

    Quads are made of the mesh that is on the surfaces, of Gmsh's triangles where there is none yet. Nodes are moved onto the
    geometry, where there is one. Entities and physical groups stay, elements of volumes go. Raises what delquad.mesh() raises.
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
