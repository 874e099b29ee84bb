#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes docs/keys.md, the reference of all keys, from `delquad schema`.

Usage: make_keys.py DELQUAD > docs/keys.md
"""
import json
import pathlib
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "program/python/delquad"))
from _keywords import words  # noqa: E402

HEAD = """# Keys

Made by `docs/site/make_keys.py` from `delquad schema`; a test checks that it is up to date. [models.md](models.md) and [experiments.md](experiments.md) say what the keys do. Keys in bold must be there.
"""
OF_A_MODEL = """## Keys of a model or a case

All of these keys may also stand at the top of an experiment, for every case. Model files have no `name`, `data`, `domain`, `solution`, `adapt` and `compare`. [Options](#options-of-the-stages) are below."""
OF_AN_EXPERIMENT = """## Keys of an experiment

`[matrix]` has keys of a model, each with a list of values. `[[variant]]` has a name and keys of a model."""
MEASURES = """## Measures

These are the keys of `columns`, claims and records. `[[metric]]` and programs add others. "Paper" is [remacle2013](bibliography.bib); the [glossary](glossary.md) has the terms. Measures of metrics, criteria and solvers need a case with these."""
# Pages that explain a key, or a table of keys.
EXPLAINED = {
    **dict.fromkeys(["loop", "pattern", "curve", "embed"], "models.md#shapes"),
    **dict.fromkeys(["washers", "fillet_rows"], "models.md#rows-around-holes-and-across-fillets"),
    **dict.fromkeys(["refine", "quads", "cross"], "meshing.md#sizes-and-directions"),
    **dict.fromkeys(["peer", "peer_files", "calibrate", "calibrate_to"], "experiments.md#peers"),
    **dict.fromkeys(["solution", "adapt"], "experiments.md#meshes-that-follow-a-solution"),
    **dict.fromkeys(["columns", "step_times", "reference", "data", "domain", "compare"], "experiments.md#an-experiment"),
    **dict.fromkeys(["matrix", "variant", "pairs"], "experiments.md#variants"),
    "start": "meshing.md#a-mesh-that-is-there-already",
    "order": "meshing.md#curved-elements",
    "metric": "anisotropy.md",
    "mapped": "models.md#grids",
    "divide": "models.md#numbers-of-edges",
    "periodic": "models.md#periodic-sides",
    "symmetry": "models.md#symmetry",
    "layer": "models.md#layers",
    "size": "models.md#sizes",
    "surface": "models.md#surfaces",
    "criteria": "models.md#criteria",
    "seed": "models.md#a-model",
    "pipelines": "experiments.md#pipelines",
    "hypotheses": "experiments.md#hypotheses",
    **dict.fromkeys(["may_fail", "minutes"], "experiments.md#several-experiments"),
    "solver": "experiments.md#solvers",
}


def tables_of(schema):
    """Yields the kinds of table that a key may hold."""
    for kind in schema.get("anyOf", [schema]):
        if kind.get("type") == "array":
            kind = kind["items"]
        if "properties" in kind:
            yield kind


def rows(head, table, seen, explained=None):
    """Yields the keys of a table, then the tables that they hold, each once."""
    yield f"\n{head}\n\n| key | value | meaning |\n|---|---|---|\n"
    for key, schema in table["properties"].items():
        shown = f"**`{key}`**" if key in table.get("required", []) else f"`{key}`"
        about = schema.get("description", "")
        if key in (explained or {}):
            about += f" ([more]({explained[key]}))"
        yield f"| {shown} | {words(schema)} | {about} |\n"
    for key, schema in table["properties"].items():
        for inner in [] if key in ("matrix", "variant", "case") else tables_of(schema):
            if json.dumps(inner) in seen:
                continue
            seen.add(json.dumps(inner))
            new = {name: kind for name, kind in inner["properties"].items() if explained or kind != table["properties"].get(name)}
            also = ", and keys above" if len(new) < len(inner["properties"]) else ""
            yield from rows(f"### `{key}`{also}", {**inner, "properties": new}, seen)


def main():
    def said(*arguments):
        return subprocess.run([sys.argv[1], "schema", *arguments], check=True, capture_output=True, text=True).stdout

    schema = json.loads(said())
    case = next(tables_of(schema["properties"]["case"]))
    groups = {line.split("`")[1].split(".")[0] for line in said("--options").splitlines()[2:]}
    case["properties"] = {key: kind for key, kind in case["properties"].items() if key not in groups}
    own = {key: kind for key, kind in schema["properties"].items() if key not in {*case["properties"], *groups} or key == "metric"}
    seen = set()
    print(HEAD, *rows(OF_A_MODEL, case, seen, EXPLAINED), *rows(OF_AN_EXPERIMENT, {"properties": own}, seen, {**EXPLAINED, "metric": "experiments.md#metrics-by-command"}), sep="", end="")
    print("\n## Options of the stages\n\n" + said("--options"), end="")
    print(f"\n{MEASURES}\n\n" + said("--measures"), end="")


if __name__ == "__main__":
    main()
