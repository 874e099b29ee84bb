"""mesh(), and models that are given as Python values."""

import json
import numbers
import os
from collections.abc import Iterable, Mapping

from . import _core

_MAX_ELEMENTS = 50_000_000


class UnsoundError(RuntimeError):
    """The mesh is not one of its model, or not fit to be computed with; `result` has it."""

    def __init__(self, message, result):
        super().__init__(message)
        self.result = result


def polygons(polygons):
    """A planar domain bounded by polygons, each of shape (n, 2), without its first corner repeated.

    Polygons inside others are holes. Every corner gets a node.
    """
    return _core.polygons(list(polygons))


def planar(loops, embed=()):
    """A planar domain bounded by curves: loops are lists of curves, or loop()s with a name for their region.

    Loops may lie side by side: where their curves lie on each other, regions share nodes. embed: curves and
    point()s inside of the regions, which become chains of edges and nodes of the mesh; crack()s come apart.
    """
    return _core.planar([l if isinstance(l, _core.Loop) else _core.loop(list(l)) for l in loops], list(embed))


def cad(source):
    """A STEP, IGES or BREP model, from a path or from bytes."""
    return _core.cad(source) if isinstance(source, bytes) else _core.read_model(os.fspath(source))


def _as_model(model):
    if isinstance(model, _core.Model):
        return model
    if isinstance(model, _core.Mesh):
        return _core.from_mesh(model)
    if isinstance(model, (str, os.PathLike)):
        return _core.read_model(os.fspath(model))
    raise TypeError(
        f"model: expected a delquad.Model, a delquad.Mesh or the path of a file, got {type(model).__name__}"
    )


def _toml(value):
    """A value as TOML writes it."""
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    if isinstance(value, numbers.Real):
        return repr(value if isinstance(value, numbers.Integral) else float(value))
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(str(key))} = {_toml(one)}" for key, one in value.items()) + "}"
    if isinstance(value, Iterable):
        return "[" + ", ".join(map(_toml, value)) + "]"
    raise TypeError(f"expected numbers, texts, lists or dictionaries, got {type(value).__name__}")


def _line(keyword, key, value):
    """A key of model files that a keyword stands for."""
    try:
        return keyword, f"{key} = {_toml(value)}"
    except TypeError as error:
        raise TypeError(f"{keyword}: {error}") from None


def _set_field(problem, what, key, value):
    """A size or cross: a number, a text, a function, or values at the points of a mesh."""
    if callable(value):
        getattr(problem, what + "_function")(value)
    elif isinstance(value, tuple) and len(value) == 2 and isinstance(value[0], _core.Mesh):
        getattr(problem, what + "_nodal")(*value)
    elif isinstance(value, str) or hasattr(value, "__float__"):
        problem.clear(what)
        return [_line(what, key, value if isinstance(value, str) else float(value))]
    else:
        raise TypeError(
            f"{what}: expected a number, a text, a function of points, or a mesh and values at its points, got "
            + type(value).__name__
        )
    return []


def _set_metric(problem, metric):
    asked = dict(metric) if isinstance(metric, Mapping) else {"tensor": metric}
    kinds = asked.keys() & {"tensor", "sizes", "solution", "file", "chord"}
    if len(kinds) != 1:
        raise TypeError("metric: expected one of 'tensor', 'sizes', 'solution', 'file' and 'chord'")
    [kind] = kinds
    if callable(asked[kind]):
        problem.metric_function(asked.pop(kind))
    elif kind == "tensor" and len(asked[kind]) == 2:
        problem.metric_nodal(*asked.pop(kind))
    return [_line("metric", f"metric.{key}", value) for key, value in asked.items()]


def _named(keyword, given, plain, key="name"):
    """Tables with their names, from {name: table or the value of one key}."""
    if not isinstance(given or {}, Mapping):
        raise _core.InputError(f"{keyword}: {given!r}: expected a dictionary of names")
    return [{key: name, **(one if isinstance(one, Mapping) else {plain: one})} for name, one in (given or {}).items()]


def _tables(given, *keys):
    """Tables from tuples of their values; texts stay."""
    if isinstance(given, str):
        return given
    return [one if isinstance(one, str) else dict(zip(keys, one, strict=True)) for one in given]


def _criteria(criteria):
    """A preset, the path of a file, or limits by name: as files have them."""
    if isinstance(criteria, Mapping) and "on" in criteria:
        criteria = {**criteria, "on": _named("criteria", criteria["on"], "min_length")}
    return _line("criteria", "criteria", criteria)


def judge(mesh, criteria, size=None):
    """How the elements of any Mesh do by criteria, which are as for mesh(). size: that is wanted, a number; None: the
    mean edge.

    Returns a dict: "elements" and how many of them are "failing"; "limits", each with its "failing" elements (triangles
    first), the "worst" value, where it is ("at"), and the "cause"; "causes" with the numbers of failing quads, and
    "why" in words; "critical_step" and "estimated_step" by program, times where there is a material, else lengths;
    "step_of_squares" of the least size.
    """
    return _core.judge(mesh, _core.Criteria([_criteria(criteria)]), None if size is None else float(size))


def _embed(problem, embed):
    for entry in embed:
        points, name = entry if isinstance(entry, tuple) and isinstance(entry[-1], str) else (entry, "")
        problem.embed(points if len(points) == 0 or hasattr(points[0], "__len__") else [points], name)


def _bar(stage, part):
    """Writes a line that the next one replaces."""
    end = "\n" if part >= 1 else ""
    print(f"\r{100 * part:3.0f} %  {stage:30}", end=end, flush=True)


def mesh(
    model,
    size=None,
    *,
    metric=None,
    word=None,
    quality=None,
    cross=None,
    sources=(),
    size_on=None,
    divide=None,
    periodic=(),
    mapped=(),
    symmetry=(),
    layers=(),
    washers=(),
    fillet_rows=(),
    gradation=None,
    curvature=None,
    min_size=None,
    max_size=None,
    compounds=None,
    feature_angle=None,
    weld=None,
    merge_curves=None,
    ignore_below=None,
    idealize=False,
    keep=(),
    fill_holes=None,
    simplify=None,
    mirror=None,
    glue=False,
    unit=None,
    embed=(),
    names=None,
    options=None,
    name=None,
    seed=None,
    order=None,
    refine=None,
    quads=None,
    max_elements=_MAX_ELEMENTS,
    keep_going=False,
    allow_unsound=False,
    min_angle=None,
    max_aspect=None,
    criteria=None,
    threads=0,
    time_limit=0,
    progress=None,
):
    """Meshes a model and returns a Result.

    model: from polygons(), planar(), lines(), triangles(), cad(), example(); a Mesh, whose triangles and quads
        or else lines count; or the path of a file: .step, .iges, .brep, .stl, .obj, .off, .ply, .3mf, .geojson, .msh or .toml.
    size: edge length: a number, a function of points of shape (n, 3) that returns n numbers, a formula in x, y, z,
        "boundary" or a file of sizes ("error.vtu:h") as text, or (mesh, values at its points).
    metric: lengths by direction, in place of a size: a function of points of shape (n, 2) that returns
        m11, m12, m22 of shape (n, 3), of surfaces of points of shape (n, 3) that returns m11, m12, m13, m22, m23, m33 of
        shape (n, 6); (mesh, such values at its points), or a dictionary with one of "tensor" (these, or formulas),
        "sizes" (formulas of h1, h2 and the direction of h1), "solution" (a formula), "file" and "chord" (of surfaces: how
        far sides stray from an arc), and with "min", "max", "aspect", "gradation" and "complexity"; see docs/anisotropy.md.
    word, quality: the stages by letters, or "fast", "good" (as if nothing is said), "best" or "regular".
    cross: "boundary", "size-aware", "gradient", "metric" (along its axes), or angles in radians: a function of points of shape (n, 2), a
        formula, or (mesh, values at its points).
    sources: (point, point, size near, size far, radius near, radius far) each; the smallest size counts.
    size_on: {name: size} of curves, points, regions and faces, or {name: {"size": 0.1, "reach": 0.5, "growth": 0.3}}
        or {name: {"curvature": 24}}; the smallest size counts.
    divide: {name: number of edges} of curves, or {name: {"edges": 20, "progression": 1.2, "bump": 0.1}}.
    periodic: {"from": name, "to": name, "translate": (x, y, z)} each, or with "rotate" in degrees, "centre" and "axis": the
        second curves get the images of the nodes of the first; on surfaces faces may be named, which get whole meshes.
    symmetry: "auto", or a point and a normal of each of one or two planes (of surfaces up to three); what is behind
        them is a mirror image.
    mapped: names of regions or faces that become grids, or "auto" for all where that pays; among names
        (name, corners) tells three or four corners, each a point or the name of one.
    layers: thin quads along curves of a planar model: {"on": name or names, "first": height, "growth": 1.2,
        "number": n or "thickness": height, "fan": 60, "into": name or names of regions} each; see docs/meshing.md.
    washers: rows of quads around holes: {"diameter": (least, most), "rows": 2, "edges": 16, "width": 4} each; all but the
        diameters may be left out. fillet_rows: across fillets of CAD: {"radius": (least, most), "rows": 3} each.
    gradation, curvature, min_size, max_size: the most growth of sizes per length, elements per full turn of
        curved surfaces, the least size for that, the largest size.
    compounds, feature_angle, weld, merge_curves, mirror: how faces of surfaces are made of the model; mirror is a
        point and a normal.
    ignore_below: a length; narrower faces become part of neighbours, shorter curves points.
    idealize: ignore_below is min_length of the criteria. keep: names that are not left out.
    fill_holes: a diameter; holes that are not wider are closed.
    simplify: so many sizes; planar polylines lose points that lie nearer to what stays (0.1 if nothing is said, of GeoJSON).
    glue: bodies of a CAD model that touch share faces, curves and nodes there.
    unit: of lengths, of CAD and 3MF: "um", "mm" (as if nothing is said), "cm", "m", "km", "in" or "ft".
    embed: polylines of shape (n, 3) and single points (3,) on a surface, which become edges and nodes of the mesh;
        each alone or with a name, (points, "name"). (In the plane: see planar().)
    names: of faces and curves of a surface: {name: {"at": (x, y, z)}}, the face nearest to that, or by "box", "normal", "number" and
        "like"; with "of": "curves" curves; see docs/models.md.
    name: of the model, for messages. seed: above 0, planar domains are turned a little and nodes on curves shifted, at random.
    refine: all sizes are divided by it, for studies of convergence; see docs/meshing.md.
    quads: about how many, by sizes that are all larger or smaller, or without a size by one.
    max_elements: sizes that ask for more are refused. keep_going: faces that cannot be meshed are left out.
    allow_unsound: meshes that are not sound are returned, too.
    order: of the elements, 1 to 4; None: as the model's file says, or 1. Above 1 they are curved along the model, and arrays hold
        their corners only.
    min_angle, max_aspect: degrees, and longest over shortest side (but in layers), beyond which an element is an error.
    criteria: that elements are judged by (Result.criteria): "batch", "crash", "static", the path of a file, or limits
        {"preset": "batch", "min_length": "0.4 size", "max_aspect": 4, "on": {name: {"min_length": 2}}, "material":
        {"young": 210e3, "poisson": 0.3, "density": 7.85e-9}, "strict": True}; see docs/meshing.md.
    threads: 0 for as many as there are cores. time_limit: in seconds; 0 for none.
    progress: True, or a function of the stage and the part that is done, from 0 to 1.
    options: of the stages, such as {"insertion.h_max": 1.5}; see docs/keys.md.

    Raises InputError, UnsoundError (unless allow_unsound), TimeIsUp, and what callbacks raise.
    """
    if word is not None and quality is not None:
        raise _core.InputError("word and quality exclude each other: a quality stands for a word")
    problem = _core.Problem(_as_model(model))
    if quads is not None and isinstance(size, numbers.Real):
        raise _core.InputError(
            "size and quads: a size that is a number says how many quads there are: expected one of both"
        )
    lines = [] if size is None else _set_field(problem, "size", "size.base", size)
    lines += [] if metric is None else _set_metric(problem, metric)
    lines += [] if cross is None else _set_field(problem, "cross", "cross", cross)
    source = ("at", "to", "near", "far", "radius_near", "radius_far")
    given = {
        "sources": ("size.source", [dict(zip(source, one, strict=True)) for one in sources]),
        "size_on": ("size.on", _named("size_on", size_on, "size")),
        "gradation": ("size.gradation", gradation),
        "curvature": ("size.curvature", curvature),
        "min_size": ("size.min", min_size),
        "max_size": ("size.max", max_size),
        "divide": ("divide", _named("divide", divide, "edges")),
        "periodic": ("periodic", periodic),
        "symmetry": ("symmetry", _tables(symmetry, "point", "normal")),
        "mapped": ("mapped", _tables(mapped, "name", "corners")),
        "layers": ("layer", layers),
        "washers": ("washers", washers),
        "fillet_rows": ("fillet_rows", fillet_rows),
        "compounds": ("surface.compound", compounds),
        "feature_angle": ("surface.feature_angle", feature_angle),
        "weld": ("surface.weld_tolerance", weld),
        "merge_curves": ("surface.merge_curves", merge_curves),
        "ignore_below": ("surface.ignore_below", ignore_below),
        "idealize": ("surface.idealize", idealize or None),
        "keep": ("surface.keep", [keep] if isinstance(keep, str) else keep),
        "fill_holes": ("surface.fill_holes", fill_holes),
        "simplify": ("surface.simplify", simplify),
        "mirror": ("surface.mirror", mirror and _tables([mirror], "point", "normal")[0]),
        "glue": ("surface.glue", glue or None),
        "unit": ("surface.unit", unit),
        "names": ("surface.name", _named("names", names, "at", "as")),
        "seed": ("seed", seed),
        "order": ("order", order),
        "refine": ("refine", refine),
        "quads": ("quads", quads),
        "min_angle": ("limits.min_angle", min_angle),
        "max_aspect": ("limits.max_aspect", max_aspect),
    }
    for keyword, (key, value) in given.items():
        value = value if isinstance(value, str) or not isinstance(value, Iterable) else list(value) or None
        if value is not None:
            lines.append(_line(keyword, key, value))
    if criteria is not None:
        lines.append(_criteria(criteria))
    lines += [_line("options", key, value) for key, value in (options or {}).items()]
    problem.set(lines)
    _embed(problem, embed)
    if quality is not None:
        _core.check_quality(quality)
    if name is not None:
        problem.name(name)
    problem.max_elements(max_elements)
    problem.keep_going(keep_going)
    if progress:
        problem.progress(_bar if progress is True else progress)
    result = problem.mesh(quality or "good" if word is None else word, threads, time_limit)
    if progress is True:
        _bar("done", 1)
    if result._complaint() and not allow_unsound:
        raise UnsoundError(result._complaint(), result)
    return result


def improve(given, size=None, *, word=None, **settings):
    """Makes a mesh better that is there already, planar or in space, and returns a Result.

    given: a Mesh, or the path of a file; its points on the outline, on lines and between regions stay.
    size: as for mesh(); else what the mesh has.
    word: from quads stages such as "CO" (as if nothing is said), from triangles "BCO" (where there are no quads).
    settings: cross, gradation, options, threads and others of mesh() that are for planar domains; in space
        feature_angle, too.

    Where given quads would become worse, they are kept, and the warnings say so. Raises what mesh() raises.
    """
    if isinstance(given, (str, os.PathLike)):
        given = _core.read_mesh(os.fspath(given))
    elif not isinstance(given, _core.Mesh):
        raise TypeError(f"given: expected a delquad.Mesh or the path of a file, got {type(given).__name__}")
    return mesh(_core.given_mesh(given), size, word=word, **settings)
