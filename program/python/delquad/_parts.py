# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of your own, and experiments with them. Add parts once, before anything is meshed."""

import hashlib
import inspect
import os
import pathlib
import pickle
import signal
import sys

from . import _core

_added = {}


def _describe(function):
    """Returns bytes that identify a function: its file and its data, without globals and environment."""
    inner = inspect.unwrap(function)
    inner = getattr(inner, "func", inner)
    code = getattr(inner, "__code__", None) or getattr(type(inner).__call__, "__code__", None)
    held = [{key: value for key, value in getattr(function, "__dict__", {}).items() if key != "__wrapped__"}]
    held += [getattr(function, key, None) for key in ("__defaults__", "__kwdefaults__", "args", "keywords")]
    held += [cell.cell_contents for cell in getattr(inner, "__closure__", None) or ()]
    held += [function.__self__] if inspect.ismethod(function) else []
    try:
        file = pathlib.Path(code.co_filename)
        return (file.read_bytes() if file.is_file() else code.co_code + repr(code.co_consts).encode()) + pickle.dumps(held)
    except Exception:  # nothing to compare: cells run again
        return os.urandom(16)


def _add(add, name, function, *rest):
    if not callable(function):
        raise TypeError(f"{name}: expected a function, got {type(function).__name__}")
    add(name, function, *rest)
    _added[f"{add.__name__} {name}"] = hashlib.sha256(_describe(function)).hexdigest()


def add_metric(key, function, *, title="", unit="", better="neither", worst=None, source="", digits=3):
    """Adds a measure of meshes: a column of tables, a value of records and of Result.metrics.

    `function(mesh, *, size, problem, word, surface)` returns a number, nan if it is not defined. Its exception becomes
    the reason for a missing value.
    size: the size that was followed, of shape (n,) at the points of the mesh, or None.
    problem: the name of the problem or, in experiments, of the case; word: the pipeline.
    surface: the triangulation of a surface, or None.
    better: "higher", "lower" or "neither"; worst: its value for the worst mesh; digits: after the decimal point, in tables.
    Raises ValueError for a key that is taken.
    """
    _add(_core.add_metric, key, function, title, unit, better, worst, source, digits)


def add_merge_cost(name, function):
    """Adds a cost of merging two triangles: options={"recombination.cost": name}, in files recombination.cost.

    `function(corners, theta, size)` returns n numbers from 0, the best, to 3.
    corners: of shape (n, 4, 2), in the patch's parameter plane, counterclockwise; the merged side joins the second and
    the fourth.
    theta: of shape (n,), an angle of the cross at their mean, radians.
    size: of shape (n,), the wanted edge length there.
    """
    _add(_core.add_merge_cost, name, function)


def add_stage(letter, name, function):
    """Adds a stage of pipelines, from quads to quads, with a letter from A to Z.

    `function(points, quads, n_boundary, theta, size)` gets a patch in its parameter plane and returns points and quads:
    (n, 2) numbers and (m, 4) indices, counterclockwise. The first n_boundary points are the boundary's and must not
    change. theta and size: as for add_merge_cost(), at the points.
    """
    _add(_core.add_stage, letter, function, name)


def add_size(name, function):
    """Adds a name for size in files: function(points) of shape (n, 3) returns n edge lengths."""
    _add(_core.add_size, name, function)


def add_cross(name, function):
    """Adds a name for cross in files of planar domains: function(points) of shape (n, 2) returns n angles, radians."""
    _add(_core.add_cross, name, function)


def run(arguments):
    """Runs the program delquad with the added parts: run(["run", "experiment.toml", "-o", "results"]).

    Returns its exit code; 0 is success. It runs in a copy of this process and prints to the output of this one.
    KeyboardInterrupt ends it, too.
    """
    if not hasattr(_core, "run"):
        raise RuntimeError("delquad was built without its programs (DELQUAD_PROGRAMS)")
    _core.set_added_parts("\n".join(f"{part} {digest}" for part, digest in sorted(_added.items())))
    sys.stdout.flush()
    sys.stderr.flush()
    _core.finish_threads()
    child = os.fork()
    if child == 0:
        code = 1
        try:
            code = _core.run([str(argument) for argument in arguments])
            sys.stdout.flush()
        finally:
            os._exit(code)
    try:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    except KeyboardInterrupt:
        os.kill(child, signal.SIGINT)
        os.waitpid(child, 0)
        raise
