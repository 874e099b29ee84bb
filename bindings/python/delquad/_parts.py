"""Parts of one's own, and experiments with them. Parts are added once, before anything is meshed."""

import hashlib
import inspect
import marshal
import pathlib

from . import _core

_counted = False


def _count(name, function):
    """Experiments make cells anew when the file with the function changes, or the function where there is none."""
    if not callable(function):
        raise TypeError(f"{name}: expected a function, got {type(function).__name__}")
    if not hasattr(_core, "add_to_program"):
        return
    function = inspect.unwrap(function)
    code = getattr(function, "__code__", None) or getattr(type(function).__call__, "__code__", None)
    file = pathlib.Path(code.co_filename) if code else None
    source = file.read_bytes() if file and file.is_file() else marshal.dumps(code) if code else repr(function).encode()
    _core.add_to_program(f"{name} {hashlib.sha256(source).hexdigest()}")


def add_metric(key, function, *, title="", unit="", better="neither", worst=None, source="", digits=3):
    """A measure of meshes: a column of tables, a value of records and of Result.metrics.

    function(mesh, *, size, problem, word, surface) returns a number, nan where it is not defined; what it raises is
    the reason why there is no value. size: of shape (n,), that was meshed by, at the points of the mesh, or None;
    problem: the name of the problem, in experiments of the case; word: of stages; surface: the triangulation that
    stands behind a surface, or None. better: "higher", "lower" or "neither"; worst: its value of the
    worst mesh.
    """
    _core.add_metric(key, function, title, unit, better, worst, source, digits)
    _count(key, function)


def add_merge_cost(name, function):
    """What it costs to merge two triangles: options={"recombination.cost": name}, in files recombination.cost.

    function(corners, theta, size) returns n numbers from 0, the best, to 3. corners: of shape (n, 4, 2), in the
    patch's parameter plane, counterclockwise; the side that goes is between the second and the fourth. theta: of shape
    (n,), an angle of the cross at their mean, radians. size: of shape (n,), the wanted edge length there.
    """
    _core.add_merge_cost(name, function)
    _count(name, function)


def add_stage(letter, name, function):
    """A stage of words, from quads to quads, with a letter from A to Z.

    function(points, quads, n_boundary, theta, size) gets one patch in its parameter plane and returns points and quads:
    (n, 2) numbers, of which the first n_boundary are the boundary's and stay as they are, and (m, 4) indices,
    counterclockwise. theta and size: as for add_merge_cost(), at the points.
    """
    _core.add_stage(letter, name, function)
    _count(letter, function)


def add_size(name, function):
    """What size may be in files: function(points) of shape (n, 3) returns n edge lengths."""
    _core.add_size(name, function)
    _count(name, function)


def add_cross(name, function):
    """What cross may be in files of planar domains: function(points) of shape (n, 2) returns n angles, radians."""
    _core.add_cross(name, function)
    _count(name, function)


def run(arguments):
    """The program delquad with the parts that were added: run(["run", "experiment.toml", "-o", "results"]).

    Returns its exit code: 0 is success. It prints to the process's own output.
    """
    global _counted
    if not hasattr(_core, "run"):
        raise RuntimeError("delquad was built without its programs (DELQUAD_PROGRAMS)")
    if not _counted:
        _core.add_to_program(hashlib.sha256(pathlib.Path(_core.__file__).read_bytes()).hexdigest())
        _counted = True
    return _core.run([str(argument) for argument in arguments])
