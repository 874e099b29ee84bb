"""mesh(), and models that are given as Python values."""

import numbers
import os

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


def _set_field(problem, what, value):
    """A size or cross: a text, a function, or values at the points of a mesh."""
    if isinstance(value, str):
        getattr(problem, what + "_text")(value)
    elif callable(value):
        getattr(problem, what + "_function")(value)
    elif isinstance(value, tuple) and len(value) == 2 and isinstance(value[0], _core.Mesh):
        getattr(problem, what + "_nodal")(*value)
    else:
        return False
    return True


def _set_size(problem, size):
    if _set_field(problem, "size", size):
        return
    try:
        number = float(size)
    except (TypeError, ValueError):
        raise TypeError(
            "size: expected a number, a function of points, a text, or a mesh and values at its points, got "
            + type(size).__name__
        ) from None
    problem.size_number(number)


def _set_metric(problem, metric):
    asked = dict(metric) if isinstance(metric, dict) else {"tensor": metric}
    limits = [float(asked.pop(key, 0)) for key in ("min", "max", "aspect", "gradation", "complexity")]
    if len(asked) != 1 or not asked.keys() <= {"tensor", "sizes", "solution", "file", "chord"}:
        raise TypeError(
            "metric: expected one of 'tensor', 'sizes', 'solution', 'file' and 'chord', with 'min', 'max', 'aspect', "
            f"'gradation' and 'complexity', got {', '.join(asked) or 'none'}"
        )
    [(kind, given)] = asked.items()
    if callable(given):
        problem.metric_function(given)
    elif kind == "tensor" and len(given) == 2:
        problem.metric_nodal(*given)
    else:
        problem.metric_texts(kind, [str(given)] if kind in ("solution", "file", "chord") else [str(text) for text in given])
    problem.metric_limits(*limits)


def _set_cross(problem, cross):
    if not _set_field(problem, "cross", cross):
        raise TypeError(
            "cross: expected 'boundary', 'size-aware', 'gradient', an angle as text, a function of points, or a "
            "mesh and angles at its points, got " + type(cross).__name__
        )


_LAYER = {"first": float, "growth": float, "number": int, "thickness": float, "fan": float}


def _add_layer(problem, layer):
    values = {"growth": 1.2, "number": 0, "thickness": 0, "fan": 60, **layer}
    on = values.pop("on", None)
    into = values.pop("into", [])
    unknown = sorted(set(values) - set(_LAYER))
    if on is None or unknown or "first" not in values:
        raise _core.InputError(
            "layers: expected 'on', 'first' and either 'number' or 'thickness', perhaps 'growth', 'fan' and 'into'"
            + (f", got '{unknown[0]}'" if unknown else "")
        )
    names = [[given] if isinstance(given, str) else list(given) for given in (on, into)]
    problem.add_layer(*names, *(read(values[key]) for key, read in _LAYER.items()))


def _set_surface(problem, compounds, feature_angle, weld, merge_curves, ignore_below, idealize, keep, fill_holes, simplify, mirror, glue, unit):
    if isinstance(compounds, str):
        problem.compounds_named(compounds)
    elif compounds is not None:
        problem.compounds([[int(tag) for tag in group] for group in compounds])
    if feature_angle is not None:
        problem.feature_angle(feature_angle)
    if weld is not None:
        problem.weld(weld)
    if merge_curves is not None:
        problem.merge_curves(merge_curves)
    if ignore_below is not None:
        problem.ignore_below(ignore_below)
    if idealize:
        problem.idealize(True)
    if keep:
        problem.keep([keep] if isinstance(keep, str) else list(keep))
    if fill_holes is not None:
        problem.fill_holes(fill_holes)
    if simplify is not None:
        problem.simplify(simplify)
    if mirror is not None:
        point, normal = mirror
        problem.mirror(point, normal)
    if glue:
        problem.glue(True)
    if unit is not None:
        problem.unit(unit)


def _criteria(criteria):
    """A preset, the path of a file, or limits by name."""
    if isinstance(criteria, (str, os.PathLike)):
        return _core.Criteria(os.fspath(criteria))
    limits = dict(criteria)
    result = _core.Criteria(limits.pop("preset")) if "preset" in limits else _core.Criteria()
    if "material" in limits:
        material = limits.pop("material")
        if set(material) != {"young", "poisson", "density"}:
            raise _core.InputError("criteria: the material: expected 'young', 'poisson' and 'density'")
        result.material(*(float(material[key]) for key in ("young", "poisson", "density")))
    result.time_step_by = limits.pop("time_step_by", result.time_step_by)
    result.strict = limits.pop("strict", result.strict)
    for on, named in [("", limits), *limits.pop("on", {}).items()]:
        for key, value in named.items():
            result.set(key, value if isinstance(value, str) else repr(float(value)), on)
    return result


def judge(mesh, criteria, size=None):
    """How the elements of any Mesh do by criteria, which are as for mesh(). size: that is wanted, a number; None: the
    mean edge.

    Returns a dict: "elements" and how many of them are "failing"; "limits", each with its "failing" elements (triangles
    first), the "worst" value, where it is ("at"), and the "cause"; "causes" with the numbers of failing quads, and
    "why" in words; "critical_step" and "estimated_step" by program, times where there is a material, else lengths;
    "step_of_squares" of the least size.
    """
    return _core.judge(mesh, _criteria(criteria), None if size is None else float(size))


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
    if size is not None:
        _set_size(problem, size)
    if metric is not None:
        _set_metric(problem, metric)
    if quads is not None and isinstance(size, numbers.Real):
        raise _core.InputError(
            "size and quads: a size that is a number says how many quads there are: expected one of both"
        )
    for source in sources:
        problem.add_source(*source)
    for on, asked in (size_on or {}).items():
        problem.add_named_size(on, **(asked if isinstance(asked, dict) else {"size": asked}))
    for on, asked in (divide or {}).items():
        problem.divide(on, **(asked if isinstance(asked, dict) else {"edges": asked}))
    for pair in periodic:
        motion = {"translate": (0, 0, 0), "rotate": 0, "centre": (0, 0, 0), "axis": (0, 0, 1)} | pair
        problem.periodic(motion.pop("from"), motion.pop("to"), **motion)
    if symmetry:
        problem.symmetry([] if symmetry == "auto" else list(symmetry), symmetry == "auto")
    if mapped:
        grids = [mapped] if isinstance(mapped, str) else list(mapped)
        automatic = isinstance(mapped, str) and mapped == "auto"
        problem.mapped([] if automatic else [grid for grid in grids if isinstance(grid, str)], automatic)
        for grid in grids:
            if not isinstance(grid, str):
                name, corners = grid
                problem.mapped_corners(name, list(corners))
    for layer in layers:
        _add_layer(problem, layer)
    for add, what, asked in ((problem.add_washer, "washers", washers), (problem.add_fillet_rows, "fillet_rows", fillet_rows)):
        for rows in asked:
            try:
                add(**rows)
            except TypeError:
                raise _core.InputError(f"{what}: {dict(rows)}: expected a range of two lengths, and numbers") from None
    problem.size_limits(gradation, curvature, min_size, max_size)
    if cross is not None:
        _set_cross(problem, cross)
    _set_surface(problem, compounds, feature_angle, weld, merge_curves, ignore_below, idealize, keep, fill_holes, simplify, mirror, glue, unit)
    _embed(problem, embed)
    if not isinstance(names or {}, dict):
        raise _core.InputError(f"names: {names!r}: expected a dictionary of names, each with what tells its faces or curves")
    for part, fits in (names or {}).items():
        try:
            problem.name_part(part, **fits)
        except TypeError:
            expected = "at, box, normal, number (a list of whole numbers), like or of"
            raise _core.InputError(f"names: {part!r}: {fits!r}: expected {expected}") from None
    if quality is not None:
        _core.check_quality(quality)
    for limit, value in (("limits.min_angle", min_angle), ("limits.max_aspect", max_aspect)):
        if value is not None:
            problem.option(limit, float(value))
    if criteria is not None:
        problem.criteria(_criteria(criteria))
    for key, value in (options or {}).items():
        problem.option(key, value.item() if hasattr(value, "item") else value)
    if name is not None:
        problem.name(name)
    if seed is not None:
        problem.seed(seed)
    if order is not None:
        problem.order(order)
    if refine is not None:
        problem.refine(refine)
    if quads is not None:
        problem.quads(quads)
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
