#!/usr/bin/env python3
"""What words are worth: which_quality.py RESULTS prints, for each measure, a word's mean over that of DB.

Errors count times the power of the number of vertices that makes them independent of it. Of each domain the
mean over seeds is taken, of these the geometric mean over domains, with the least and the greatest.
"""
import collections
import glob
import json
import math
import sys

MEASURES = {"eta_mean": 0, "poisson_h1": 0.5, "poisson_l2": 1, "elasticity_h1": 0.5, "poisson_cg_iterations": -0.5}

cells = collections.defaultdict(list)
for file in glob.glob(sys.argv[1] + "/*/*/record.json"):
    with open(file) as record:
        cell = json.load(record)
    if cell["status"] == "ok":
        cells[cell["case"], cell["pipeline"]].append(cell["metrics"])
    else:
        print(f"left out: {file}: {cell['reason']}")
if not any(word == "DB" for _, word in cells):
    sys.exit(f"{sys.argv[1]}: no cells of DB: expected the results of experiments/studies/which_quality.toml")


def mean(case, word, key):
    values = [m[key] * m["n_vertices"] ** MEASURES[key] for m in cells[case, word] if m.get(key) is not None]
    return sum(values) / len(values) if values else math.nan


print("| | " + " | ".join(MEASURES) + " |\n|---|" + "---|" * len(MEASURES))
for word in sorted({word for _, word in cells} - {"DB"}):
    line = []
    for key in MEASURES:
        ratios = [mean(case, word, key) / mean(case, "DB", key) for case in sorted({case for case, _ in cells})]
        ratios = [r for r in ratios if not math.isnan(r)]
        whole = math.exp(sum(map(math.log, ratios)) / len(ratios)) if ratios else math.nan
        line.append(f"{whole:.3f} ({min(ratios):.3f} to {max(ratios):.3f})" if ratios else "-")
    print(f"| {word} | " + " | ".join(line) + " |")
