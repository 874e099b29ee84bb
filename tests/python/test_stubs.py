# SPDX-License-Identifier: GPL-3.0-or-later
"""The stubs say what the module has: the same names, parameters and defaults."""

import ast
import inspect
import json
import pathlib
import re
import subprocess
import sys

import pytest

import delquad
from delquad import _keywords, _mesh
from shapes import needed

STUBS = pathlib.Path(delquad.__file__).with_suffix(".pyi")
TREE = ast.parse(STUBS.read_text(encoding="utf-8"))
CLASSES = {node.name: node for node in TREE.body if isinstance(node, ast.ClassDef) and not node.name.startswith("_")}
FUNCTIONS = {node.name: node for node in TREE.body if isinstance(node, ast.FunctionDef)}


def parameters(function):
    """Parameters of a stub: (name, kind, default as text or None)."""
    named = function.args.posonlyargs + function.args.args
    defaults = [None] * (len(named) - len(function.args.defaults)) + function.args.defaults
    all = [(a.arg, "plain", d) for a, d in zip(named, defaults)]
    all += [(a.arg, "keyword", d) for a, d in zip(function.args.kwonlyargs, function.args.kw_defaults)]
    if function.args.kwarg:
        all.append((function.args.kwarg.arg, "rest", None))
    return [(name, kind, None if default is None else ast.literal_eval(default)) for name, kind, default in all]


def actual_parameters(function):
    """The same of a function: of one by pybind11 from the first line of its help."""
    kinds = {
        inspect.Parameter.POSITIONAL_OR_KEYWORD: "plain",
        inspect.Parameter.KEYWORD_ONLY: "keyword",
        inspect.Parameter.VAR_KEYWORD: "rest",
    }
    if inspect.isfunction(function):
        return [
            (p.name, kinds[p.kind], None if p.default is inspect.Parameter.empty else p.default)
            for p in inspect.signature(function).parameters.values()
        ]
    return parameters(ast.parse(f"def {function.__doc__.splitlines()[0]}: ...").body[0])


def members(name):
    """Members of a class in the stubs, with the members of its bases there."""
    own = {node.name: node for node in CLASSES[name].body if isinstance(node, ast.FunctionDef)}
    for base in CLASSES[name].bases:
        if base.id in CLASSES:
            own = members(base.id) | own
    return own


def is_property(node):
    return any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)


def test_names():
    assert sorted([*CLASSES, *FUNCTIONS, "HexMesh"]) == sorted(delquad.__all__)  # another name of Mesh


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_functions(name):
    assert parameters(FUNCTIONS[name]) == actual_parameters(getattr(delquad, name))


@pytest.mark.parametrize("name", sorted(CLASSES))
def test_classes(name):
    actual, told = getattr(delquad, name), members(name)
    if issubclass(actual, Exception):
        known = set(dir(RuntimeError)) | set(dir(ValueError))
        assert {n for n in dir(actual) if not n.startswith("_")} <= known
        return
    assert {n for n in dir(actual) if not n.startswith("_")} == {n for n in told if not n.startswith("_")}
    for key, node in told.items():
        attribute = getattr(actual, key)
        assert is_property(node) == isinstance(attribute, property), key
        if not is_property(node) and (key != "__init__" or node in CLASSES[name].body):
            assert parameters(node) == actual_parameters(attribute), key


def test_gmsh():
    needed("gmsh")
    import delquad.gmsh

    told = ast.parse(pathlib.Path(delquad.gmsh.__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
    (stub,) = [node for node in told.body if isinstance(node, ast.FunctionDef)]
    assert parameters(stub) == actual_parameters(delquad.gmsh.mesh)


PLAIN = {"number": "float", "integer": "int", "string": "str", "boolean": "bool", "object": "Mapping[str, Any]"}


def type_of(schema):
    """The type of a keyword in the stubs."""
    types = []
    for kind in _keywords.kinds_of(schema):
        items = kind.get("items", {}).get("type")
        if "enum" in kind:
            types.append("Literal[" + ", ".join(map(json.dumps, kind["enum"])) + "]")
        elif kind["type"] == "array":
            types += ["str", "Sequence[str]"] if items == "string" else ["Iterable[Any]"]
        else:
            types.append(PLAIN[kind["type"]])
    if types == ["Mapping[str, Any]"]:
        types.append("tuple[Any, ...]")
    return " | ".join(dict.fromkeys([*types, "None"]))


# Keys of cases that no keyword is for: models are values in Python, and the rest is for experiments.
OF_FILES = "name loop pattern curve embed example mesh start model data domain solution adapt compare".split()


def said(*arguments):
    code = f"import delquad, sys; sys.exit(delquad.run({arguments!r}))"
    return subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout


def test_keywords_are_the_keys_of_the_schema():
    keys = _keywords.keys_of_table(json.loads(said("schema"))["properties"]["case"])
    groups = {line.split("`")[1].split(".")[0] for line in said("schema", "--options").splitlines()[2:]}
    for table in ("size", "surface", "limits"):
        keys |= {f"{table}.{key}": schema for key, schema in _keywords.keys_of_table(keys.pop(table)).items()}
    assert dict(_mesh._KEYS.values()) == {key: keys[key] for key in keys.keys() - groups - set(OF_FILES)}


# These may be functions, values at points or paths, too.
OTHERS = ("size", "metric", "cross", "criteria")


def test_keywords_have_the_types_of_their_descriptions():
    told = {argument.arg: ast.unparse(argument.annotation) for argument in FUNCTIONS["mesh"].args.kwonlyargs}
    described = {key: type_of(schema) for key, (_, schema) in _mesh._KEYS.items() if key not in OTHERS}
    wanted = {key: ast.unparse(ast.parse(type, mode="eval")) for key, type in described.items()}
    assert {key: told.get(key) for key in wanted} == wanted, "\n".join(f"    {key}: {type} = None," for key, type in described.items())


@pytest.mark.parametrize("keyword", sorted(_mesh._KEYS))
def test_help_tells_what_a_keyword_is_and_its_range(keyword):
    _, schema = _mesh._KEYS[keyword]
    assert f"{keyword}: {schema['description']} ({_keywords.words(schema)}" in " ".join(delquad.mesh.__doc__.split())


@pytest.mark.parametrize("name", ["mesh", "extrude", "adapt"])
def test_help_has_every_argument(name):
    function = getattr(delquad, name)
    for parameter in inspect.signature(function).parameters:
        assert re.search(rf"\b{parameter}\b", function.__doc__), parameter
