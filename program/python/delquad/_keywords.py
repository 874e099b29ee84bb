# SPDX-License-Identifier: GPL-3.0-or-later
"""Keywords by their descriptions, which the library and model files share."""

import json
import textwrap
from collections.abc import Iterable, Mapping


def _number(kind, name):
    least, most = kind.get("minimum"), kind.get("maximum")
    if least is not None and most is not None:
        return f"{name} from {least} to {most}"
    if "exclusiveMinimum" in kind:
        above = f"{name} above {kind['exclusiveMinimum']}"
        return above if most is None else f"{above}, at most {most}"
    return name if least is None else f"{name}, at least {least}"


def words(schema):
    """Returns the values that a JSON Schema allows, in words."""
    if "anyOf" in schema:
        return " or ".join(dict.fromkeys(map(words, schema["anyOf"]))).replace("a table or a list: a table", "one or more tables")
    if "enum" in schema:
        return ", ".join(f"`{json.dumps(word)}`" for word in schema["enum"])
    kinds = schema.get("type", [])
    said = []
    for kind in [kinds] if isinstance(kinds, str) else kinds:
        if kind in ("number", "integer"):
            said.append(_number(schema, "a number" if kind == "number" else "a whole number"))
        elif kind == "array":
            least, most = schema.get("minItems"), schema.get("maxItems")
            numbers = {"number": "numbers", "integer": "whole numbers"}.get(str(schema["items"].get("type")))
            if most and numbers:
                said.append(f"{most} {numbers}" if least == most else f"{least} or {most} {numbers}")
            else:
                said.append("a list: " + words(schema["items"]))
        else:
            said.append({"string": "a text", "boolean": "true or false", "object": "a table"}[kind])
    return " or ".join(said)


def kinds_of(schema):
    """Yields the allowed kinds of value, each of one type."""
    for kind in schema.get("anyOf", [schema]):
        kinds = kind.get("type")
        for one in kinds if isinstance(kinds, list) else [kinds]:
            yield {**kind, "type": one}


def keys_of_table(schema):
    """Returns the schemas of the keys of a table, or of each table of a list; empty: no table."""
    for kind in kinds_of(schema):
        table = kind["items"] if kind["type"] == "array" else kind
        if "properties" in table:
            return table["properties"]
    return {}


def help_line(keyword, schema, also=""):
    """Returns the lines of help() for a keyword."""
    keys = keys_of_table(schema)
    of = " of " + ", ".join(keys) if keys else ""
    line = f"{keyword}: {schema['description']} ({words(schema)}{of}){also}"
    return textwrap.fill(line, 116, initial_indent="    ", subsequent_indent="        ", break_long_words=False)


def value_of(schema, value):
    """Returns a value as in files. A tuple becomes a table of its values in the order of the keys. A dictionary of names becomes a list
    of tables with names. Any other value there belongs to the second key."""
    if isinstance(value, str):
        return [value] if schema.get("type") == "array" else value
    keys = keys_of_table(schema)
    if not keys or not isinstance(value, Iterable):
        return value
    if not any(kind["type"] == "array" for kind in kinds_of(schema)):
        return _table(keys, value)
    if isinstance(value, Mapping):
        first, second = list(keys)[:2]
        if first not in ("name", "as") or value.keys() <= keys.keys():
            value = [value]
        else:
            value = [{first: name, **(one if isinstance(one, Mapping) else {second: one})} for name, one in value.items()]
    return [_table(keys, one) for one in value]


def _table(keys, value):
    if isinstance(value, Mapping):
        return {key: value_of(keys.get(key, {}), one) for key, one in value.items()}
    if isinstance(value, str) or not isinstance(value, Iterable):
        return value
    if len(values := list(value)) > len(keys):
        raise TypeError(f"{len(values)} values: expected at most {len(keys)}, of {', '.join(keys)}")
    return dict(zip(keys, values))
