#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Renews the tables of measurements in README and docs: make_tables.py RESULTS [NAME ...]; --cheap lists the experiments that take seconds

A table stands in its page between <!-- table: NAME, made by COMMAND --> and <!-- end -->. Its last line has the command, the version
and the date. TABLES has the file, the columns and the rows of each table. Tables whose results are not in RESULTS stay as they are.
"""
import datetime
import json
import pathlib
import re
import statistics
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
MARK = re.compile(r"<!-- table: (\w+), made by (.*?) -->\n.*?<!-- end -->", re.DOTALL)

QUALITY = ["eta worst", "eta mean", "d4", "tau"]
SHAPE = ["case", "quads", *QUALITY]
METRIC = ["case", "quads", "eta_M mean", "eta_M worst", "tau_M", "irregular"]
SPEED = ["model", "program", "seconds a million quads", "quads", "triangles", "eta mean", "eta worst", "irregular", "inverted"]
CLAIM = ["hypothesis", "measure", "better", "worse", "difference", "p corrected"]
# For each table: its file below RESULTS, its columns (none: all), its rows by patterns, its number there, and how it is pivoted.
TABLES = {
    "insertion_options": ("studies/insertion_options/table.md", SHAPE, {"pipeline": "DB", "case": "(lewis|airfoil).*"}),
    "cleanup": ("studies/cleanup/table.md", ["case", "pipeline", "quads", *QUALITY], {"case": "lewis|plate"}),
    "regularity": ("studies/regularity/table.md", ["case", "pipeline", "quads", "irregular", "necessary", "beyond", "eta mean", "tau"], {"case": "(annulus|plate|bracket).*weight=1"}),
    "metric_solutions": ("studies/metric_solutions/table.md", METRIC, {"case": "(shock|mmg|thin|layers), cross=size-aware.*=(1100|10000)", "pipeline": "DBCO"}),
    "metric_fields": ("studies/metric_fields/table.md", [*METRIC, "aligned"], {"case": "(constant|wall|ring).*", "pipeline": "DBCO"}),
    "which_quality": ("studies/which_quality/printed.md", ["error", "eta_mean", "d4", "tau", "aspect_mean", "warp_mean"], {}),
    "which_pipeline": ("studies/which_quality/printed.md", ["pipeline", "poisson_h1", "poisson_l2", "elasticity_h1", "poisson_cg_iterations"], {}, 1),
    "pipelines": ("studies/ablation/summary.md", ["pipeline", *QUALITY], {}, 0, ("pipeline", "measure", "mean")),
    "hypotheses": ("studies/ablation/hypotheses.md", CLAIM, {}),
    "cross_fields": ("studies/cross_fields/hypotheses.md", CLAIM, {}),
    "peers": ("peers/peers/table.md", ["case", "pipeline", "quads", "triangles", *QUALITY, "total CPU s"], {}),
    "mbb": ("public/mbb/table.md", ["case", "pipeline", "quads", "triangles", "Verdict.libmesh_shape", "Verdict.shape_mean", "SJ mean"], {}),
    "dial": ("benchmarks/dial.md", ["setting", "quads", "irregular", "eta mean", "eta worst", "tau", "inverted"], {}),
    "volumes": ("benchmarks/volumes.md", ["model", "quads", "cells", "hexahedra, % of volume", "% of cells", "their scaled Jacobian", "least of all", "s"], {}),
    "delhex": ("benchmarks/delhex.md", ["model", "strategy", "points inside", "hexahedra, % of volume", "% of cells", "their scaled Jacobian", "of pyramids",
                                        "of tetrahedra", "least of all", "tau", "regular points, %", "sides alone", "s"], {}),
    "per_million": ("benchmarks/per_million.md", SPEED, {"quads asked for": "50000", "program": "(?!.* 4[.]8).*"}),
}
# The experiments in experiments/studies/ that take seconds, and need no other model: a test compares their tables.
CHEAP = ["insertion_options", "cleanup"]


def rows_of(text, number):
    """Returns a table's rows by the titles of its columns."""
    lines = re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE)[number].splitlines()
    head, _, *rows = [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]
    return [dict(zip(head, row)) for row in rows]


def table(columns, rows):
    lines = [columns, ["---" if i == 0 else "---:" for i in range(len(columns))], *([row[key] for key in columns] for row in rows)]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def pivot(rows, key, name, value):
    """Returns a row for each value of `key`, with a column for each value of `name`."""
    found = {}
    for row in rows:
        found.setdefault(row[key], {key: row[key]})[row[name]] = row[value]
    return list(found.values())


def of_results(file, columns, wanted, number=0, pivoted=None):
    """Returns the rows of a table of results, without skipped cells."""
    rows = [row for row in rows_of(file.read_text(), number) if all(re.fullmatch(pattern, row[key]) for key, pattern in wanted.items())]
    rows = [row for row in rows if not {"skipped", "not applicable"} & set(row.values())]
    rows = pivot(rows, *pivoted) if pivoted else rows
    return table(columns or list(rows[0]), rows)


def of_matching():
    """Returns the table of speed beside LEMON, and its version, as `make bench` recorded them last."""
    number, ratios = list(json.loads((ROOT / "benchmarks/bench.json").read_text()).items())[-1]
    rows = {}
    for name, values in ratios.items():
        if found := re.fullmatch(r"matching: ours/(\w+)/(\d+) against lemon", name):
            rows.setdefault(found[1], {"graph": found[1].replace("_", " ")})[found[2] + " nodes"] = f"{statistics.median(values):.1f}"
    return table(["graph", "10000 nodes", "100000 nodes"], rows.values()), f"version {number}"


def version(file):
    """Returns commits and dates of the results beside a table; a printed file begins with its version."""
    records = [json.loads(record.read_text()) for record in file.parent.glob("*/*/record.json")]
    if not records:
        return f"{file.read_text().splitlines()[0].split(';')[0]}, {datetime.date.fromtimestamp(file.stat().st_mtime)}"
    commits = sorted({record["versions"]["commit"][:8] for record in records if "versions" in record})
    return f"commit {' and '.join(commits)}, {max(record.get('started', '') for record in records)[:10]}"


def renewed(page, results, names=()):
    def renew(found):
        name, command = found.groups()
        if name == "matching":
            text, made = of_matching()
        else:
            file = results / TABLES[name][0]
            if names and name not in names or not file.exists():
                return found[0]
            text, made = of_results(file, *TABLES[name][1:]), version(file)
        return f"<!-- table: {name}, made by {command} -->\n\n{text}\nMade by `{command}`, {made}.\n\n<!-- end -->"

    return MARK.sub(renew, page)


def pages():
    return [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


if __name__ == "__main__":
    if sys.argv[1] == "--cheap":
        sys.exit(print(*CHEAP))
    for page in pages():
        page.write_text(renewed(page.read_text(), pathlib.Path(sys.argv[1]), sys.argv[2:]))
