"""Parts of one's own, and experiments with them. Parts are added once, before anything is meshed."""

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
    """What tells it from others: the file that it stands in, and what it holds. Globals and the environment do not."""
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
    except Exception:  # nothing that could be compared: cells are made anew
        return os.urandom(16)


def _add(add, name, function, *rest):
    if not callable(function):
        raise TypeError(f"{name}: expected a function, got {type(function).__name__}")
    add(name, function, *rest)
    _added[f"{add.__name__} {name}"] = hashlib.sha256(_describe(function)).hexdigest()


def add_metric(key, function, *, title="", unit="", better="neither", worst=None, source="", digits=3):
    """A measure of meshes: a column of tables, a value of records and of Result.metrics.

    function(mesh, *, size, problem, word, surface) returns a number, nan where it is not defined; what it raises is
    the reason why there is no value. size: of shape (n,), that was meshed by, at the points of the mesh, or None;
    problem: the name of the problem, in experiments of the case; word: of stages; surface: the triangulation that
    stands behind a surface, or None. better: "higher", "lower" or "neither"; worst: its value of the
    worst mesh.
    """
    _add(_core.add_metric, key, function, title, unit, better, worst, source, digits)


def add_merge_cost(name, function):
    """What it costs to merge two triangles: options={"recombination.cost": name}, in files recombination.cost.

    function(corners, theta, size) returns n numbers from 0, the best, to 3. corners: of shape (n, 4, 2), in the
    patch's parameter plane, counterclockwise; the side that goes is between the second and the fourth. theta: of shape
    (n,), an angle of the cross at their mean, radians. size: of shape (n,), the wanted edge length there.
    """
    _add(_core.add_merge_cost, name, function)


def add_stage(letter, name, function):
    """A stage of words, from quads to quads, with a letter from A to Z.

    function(points, quads, n_boundary, theta, size) gets one patch in its parameter plane and returns points and quads:
    (n, 2) numbers, of which the first n_boundary are the boundary's and stay as they are, and (m, 4) indices,
    counterclockwise. theta and size: as for add_merge_cost(), at the points.
    """
    _add(_core.add_stage, letter, function, name)


def add_size(name, function):
    """What size may be in files: function(points) of shape (n, 3) returns n edge lengths."""
    _add(_core.add_size, name, function)


def add_cross(name, function):
    """What cross may be in files of planar domains: function(points) of shape (n, 2) returns n angles, radians."""
    _add(_core.add_cross, name, function)


def run(arguments):
    """The program delquad with the parts that were added: run(["run", "experiment.toml", "-o", "results"]).

    Returns its exit code: 0 is success. It runs in a process of its own, a copy of this one, and prints to this one's
    own output. KeyboardInterrupt ends it, too.
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
