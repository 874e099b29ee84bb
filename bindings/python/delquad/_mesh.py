"""mesh(), and models that are given as Python values."""

import difflib
import inspect
import json
import numbers
import os
from collections.abc import Iterable, Mapping

from . import _core, _keywords

# Keys of problems: (key, JSON Schema) by keyword.
_KEYS = {keyword: (key, json.loads(schema)) for keyword, key, schema in _core.keywords()}


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
        problem.set_function(what, value)
    elif isinstance(value, tuple) and len(value) == 2 and isinstance(value[0], _core.Mesh):
        problem.set_nodal(what, *value)
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
    problem.clear("metric")
    asked = dict(metric) if isinstance(metric, Mapping) else {"tensor": metric}
    if len(asked.keys() & {"tensor", "sizes", "solution", "file", "chord"}) != 1:
        raise TypeError("metric: expected one of 'tensor', 'sizes', 'solution', 'file' and 'chord'")
    tensor = asked.get("tensor")
    if callable(tensor):
        problem.set_function("metric", asked.pop("tensor"))
    elif tensor is not None and len(tensor) == 2:
        problem.set_nodal("metric", *asked.pop("tensor"))
    return [_line("metric", f"metric.{key}", value) for key, value in asked.items()]


def _lines(keyword, value):
    """The line for a keyword; none: its value is an empty list."""
    key, schema = _KEYS[keyword]
    if not isinstance(value, str) and isinstance(value, Iterable) and not isinstance(value, Mapping):
        value = list(value)
    try:
        return [_line(keyword, key, _keywords.value_of(schema, value))] if value not in ([], {}) else []
    except TypeError as error:
        raise TypeError(f"{keyword}: {error}") from None


def judge(mesh, criteria, size=None):
    """How the elements of any Mesh do by criteria, which are as for mesh(). size: that is wanted, a number; None: the
    mean edge.

    Returns a dict: "elements" and how many of them are "failing"; "limits", each with its "failing" elements (triangles
    first), the "worst" value, where it is ("at"), and the "cause"; "causes" with the numbers of failing quads, and
    "why" in words; "critical_step" and "estimated_step" by program, times where there is a material, else lengths;
    "step_of_squares" of the least size.
    """
    return _core.judge(mesh, _core.Criteria(_lines("criteria", criteria)), None if size is None else float(size))


def _embed(problem, embed):
    for entry in embed:
        points, name = entry if isinstance(entry, tuple) and isinstance(entry[-1], str) else (entry, "")
        problem.embed(points if len(points) == 0 or hasattr(points[0], "__len__") else [points], name)


def _bar(stage, part):
    """Writes a line that the next one replaces."""
    end = "\n" if part >= 1 else ""
    print(f"\r{100 * part:3.0f} %  {stage:30}", end=end, flush=True)


_HEAD = """Meshes a model and returns a Result.

    model: from polygons(), planar(), lines(), triangles(), cad(), example(); a Mesh, whose triangles and quads
        or else lines count; or the path of a file: .step, .iges, .brep, .stl, .obj, .off, .ply, .3mf, .geojson, .msh or .toml.
"""
# What keywords may be beside their descriptions.
_ALSO = {
    "size": """, a function of points of shape (n, 3) that returns n numbers, a file of sizes ("error.vtu:h"), or (mesh, values at its points)""",
    "metric": """, a function of points of shape (n, 2) that returns m11, m12, m22 of shape (n, 3), of surfaces of points of shape (n, 3) that
        returns m11, m12, m13, m22, m23, m33 of shape (n, 6), or (mesh, such values at its points); see docs/anisotropy.md""",
    "cross": """, radians; a function of points of shape (n, 2), a formula, or (mesh, values at its points)""",
}
_TAIL = """
    A table is a dictionary, or a tuple of values in the order of its keys. Tables with names are also {name: table}, or
    {name: value of the second key}, such as size_on={"inlet": 0.1}, divide={"wall": 20}. docs/keys.md has all keys.

    word, quality: the stages by letters, or "fast", "good" (as if nothing is said), "best" or "regular".
    options: of the stages, such as {"insertion.h_max": 1.5}; see docs/keys.md.
    embed: polylines of shape (n, 3) and single points (3,) on a surface, which become edges and nodes of the mesh;
        each alone or with a name, (points, "name"). (In the plane: see planar().)
    name: of the model, for messages.
    max_elements: sizes that ask for more are refused. keep_going: faces that cannot be meshed are left out.
    allow_unsound: meshes that are not sound are returned, too.
    threads: 0 for as many as there are cores. time_limit: in seconds; 0 for none.
    progress: True, or a function of the stage and the part that is done, from 0 to 1.

    Raises InputError, UnsoundError (unless allow_unsound), TimeIsUp, and what callbacks raise.
    """


def mesh(
    model,
    size=None,
    *,
    word=None,
    quality=None,
    options=None,
    embed=(),
    name=None,
    max_elements=None,
    keep_going=False,
    allow_unsound=False,
    threads=0,
    time_limit=0,
    progress=None,
    **keywords,
):
    if word is not None and quality is not None:
        raise _core.InputError("word and quality exclude each other: a quality stands for a word")
    for unknown in keywords.keys() - _KEYS.keys():
        near = difflib.get_close_matches(unknown, inspect.signature(mesh).parameters, 1)
        raise TypeError(f"mesh() has no keyword '{unknown}'" + (f"; did you mean '{near[0]}'?" if near else "; help(delquad.mesh) lists all"))
    given = {"size": size, **keywords}
    if given.get("quads") is not None and isinstance(size, numbers.Real):
        raise _core.InputError("size and quads: a size that is a number says how many quads there are: expected one of both")
    problem = _core.Problem(_as_model(model))
    lines = []
    for keyword, value in given.items():
        if value is None:
            continue
        if keyword == "metric":
            lines += _set_metric(problem, value)
        elif keyword in ("size", "cross"):
            lines += _set_field(problem, keyword, _KEYS[keyword][0], value)
        else:
            lines += _lines(keyword, value)
    problem.set(lines + [_line("options", key, value) for key, value in (options or {}).items()])
    _embed(problem, embed)
    if quality is not None:
        _core.check_quality(quality)
    if name is not None:
        problem.name(name)
    if max_elements is not None:
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


def _with_keywords(function):
    """Gives it a signature and help with all keywords."""
    own = [one for one in inspect.signature(function).parameters.values() if one.kind != one.VAR_KEYWORD]
    keys = [key for key in _KEYS if key != "size"]
    described = [inspect.Parameter(key, inspect.Parameter.KEYWORD_ONLY, default=None) for key in keys]
    function.__signature__ = inspect.Signature(own + described)
    lines = [_keywords.help_line(keyword, schema, _ALSO.get(keyword, "")) for keyword, (_, schema) in _KEYS.items()]
    function.__doc__ = _HEAD + "\n".join(lines) + "\n" + _TAIL


_with_keywords(mesh)


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
