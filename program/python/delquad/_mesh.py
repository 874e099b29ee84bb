# SPDX-License-Identifier: GPL-3.0-or-later
"""mesh(), and models from Python values."""

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
    """The mesh does not represent its model, or is not fit for computation; `result` has it."""

    def __init__(self, message, result):
        super().__init__(message)
        self.result = result


def polygons(polygons):
    """Returns a planar domain bounded by polygons, each of shape (n, 2), n >= 3, without its first corner repeated.

    Polygons inside others are holes. Every corner gets a node.
    """
    return _core.polygons(list(polygons))


def planar(loops, embed=()):
    """Returns a planar domain bounded by curves: loops are lists of curves, or loop()s with a name for their region.

    Loops may lie side by side; regions share nodes where their curves overlap. embed: curves and point()s inside
    the regions. They become chains of edges and nodes of the mesh, and the mesh opens at crack()s.
    """
    return _core.planar([l if isinstance(l, _core.Loop) else _core.loop(list(l)) for l in loops], list(embed))


def cad(source):
    """Returns a STEP, IGES or BREP model, from a path or from bytes."""
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
    """Returns a value in TOML."""
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
    """Returns a keyword and its line of a model file."""
    try:
        return keyword, f"{key} = {_toml(value)}"
    except TypeError as error:
        raise TypeError(f"{keyword}: {error}") from None


def _set_field(problem, what, key, value):
    """Sets a size or cross: a number, a text, a function, or values at the points of a mesh."""
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
    """Returns the line for a keyword; none if its value is empty."""
    key, schema = _KEYS[keyword]
    if not isinstance(value, str) and isinstance(value, Iterable) and not isinstance(value, Mapping):
        value = list(value)
    try:
        return [_line(keyword, key, _keywords.value_of(schema, value))] if value not in ([], {}) else []
    except TypeError as error:
        raise TypeError(f"{keyword}: {error}") from None


def judge(mesh, criteria, size=None):
    """Judges the elements of any Mesh by criteria as for mesh(). size: the wanted edge length; None: the mean edge.

    Returns a dict with the numbers of "elements" and of "failing" ones. "limits" has, for each limit, its "failing"
    elements (triangles first), the "worst" value, its place "at", and the "cause". "causes" has the numbers of failing
    quads, and "why" explains them. "cures" has changes of a "key" to a "value" that may cure "count" elements
    with a "cause". "critical_step" and, by program, "estimated_step" are times with a material, else lengths.
    "step_of_squares" is the step of squares of the least size. Raises InputError for criteria that do not fit the mesh.
    """
    return _core.judge(mesh, _core.Criteria(_lines("criteria", criteria)), None if size is None else float(size))


def _embed(problem, embed):
    for entry in embed:
        is_named = isinstance(entry, tuple) and any(isinstance(part, str) for part in entry)
        points, name, *crack = entry if is_named else (entry, "")
        problem.embed(points if len(points) == 0 or hasattr(points[0], "__len__") else [points], name, bool(crack))


def _bar(stage, part):
    """Prints a line of progress, which the next one replaces."""
    end = "\n" if part >= 1 else ""
    print(f"\r{100 * part:3.0f} %  {stage:30}", end=end, flush=True)


_HEAD = """Meshes a model and returns a Result.

    model: from polygons(), planar(), lines(), triangles(), cad(), example(); a Mesh, with its triangles and quads
        or, without any, its lines; or the path of a file: .step, .iges, .brep, .stl, .obj, .off, .ply, .3mf, .geojson, .msh or .toml.
"""
# Values of keywords beside their descriptions.
_ALSO = {
    "size": """, a function of points of shape (n, 3) that returns n numbers, a file of sizes ("error.vtu:h"), or (mesh, values at its points)""",
    "metric": """, a function of points of shape (n, 2) that returns m11, m12, m22 of shape (n, 3), of surfaces of points of shape (n, 3) that
        returns m11, m12, m13, m22, m23, m33 of shape (n, 6), or (mesh, such values at its points); see docs/anisotropy.md""",
    "cross": """, radians; a function of points of shape (n, 2), a formula, or (mesh, values at its points)""",
}
_TAIL = """
    A table is a dictionary, or a tuple of values in the order of its keys. Tables with names are also {name: table}, or
    {name: value of the second key}, such as size_on={"inlet": 0.1}, divide={"wall": 20}. docs/keys.md has all keys.

    pipeline, quality: a pipeline of stages, such as "DBCO", or "fast", "good" (the default), "best" or "regular".
        word is another name of pipeline.
    options: options of the stages, such as {"insertion.h_max": 1.5}; see docs/keys.md.
    embed: polylines of shape (n, 3) and single points (3,) on a surface, which become edges and nodes of the mesh;
        each alone or with a name, (points, "name"), or a crack, (points, "name", True). In the plane see planar().
    name: name of the model in messages.
    max_elements: refuses sizes that need more. keep_going: leaves out faces that cannot be meshed.
    allow_unsound: returns unsound meshes, too.
    threads: 0 for the number of cores. time_limit: in seconds; 0 for none.
    progress: True, or a function of the stage and its finished part, from 0 to 1.

    Raises InputError, UnsoundError (unless allow_unsound), TimeIsUp, and exceptions of callbacks.
    """


def mesh(
    model,
    size=None,
    *,
    pipeline=None,
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
    word=None,
    **keywords,
):
    if pipeline is None:
        pipeline = word
    if pipeline is not None and quality is not None:
        raise _core.InputError("pipeline and quality exclude each other: a quality stands for a pipeline")
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
    result = problem.mesh(quality or "good" if pipeline is None else pipeline, threads, time_limit)
    if progress is True:
        _bar("done", 1)
    if result._complaint() and not allow_unsound:
        raise UnsoundError(result._complaint(), result)
    return result


def _with_keywords(function):
    """Gives a function a signature and help with all keywords."""
    own = [one for one in inspect.signature(function).parameters.values() if one.kind != one.VAR_KEYWORD]
    keys = [key for key in _KEYS if key != "size"]
    described = [inspect.Parameter(key, inspect.Parameter.KEYWORD_ONLY, default=None) for key in keys]
    function.__signature__ = inspect.Signature(own + described)
    lines = [_keywords.help_line(keyword, schema, _ALSO.get(keyword, "")) for keyword, (_, schema) in _KEYS.items()]
    function.__doc__ = _HEAD + "\n".join(lines) + "\n" + _TAIL


_with_keywords(mesh)


def improve(given, size=None, *, pipeline=None, **settings):
    """Improves an existing mesh, planar or in space, and returns a Result.

    given: a Mesh, or the path of a file; its points on the outline, on lines and between regions stay.
    size: as for mesh(); default: the size of the mesh.
    pipeline: from quads such as "CO" (the default), or from triangles "BCO" (the default without quads).
    settings: cross, gradation, options, threads and other keywords of mesh() for planar domains; in space also
        feature_angle.

    Given quads that would become worse are kept, and a warning says so. Raises the same as mesh().
    """
    if isinstance(given, (str, os.PathLike)):
        given = _core.read_mesh(os.fspath(given))
    elif not isinstance(given, _core.Mesh):
        raise TypeError(f"given: expected a delquad.Mesh or the path of a file, got {type(given).__name__}")
    return mesh(_core.given_mesh(given), size, pipeline=pipeline, **settings)
