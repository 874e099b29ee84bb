#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Which quality matters: which_quality.py RESULTS prints which measures tell errors, and the worth of pipelines.

First come Spearman's rank correlations of errors with measures of quality over the runs of each domain. They are means
over domains, with the least and the greatest. Then, for each measure, comes a pipeline's mean over seeds divided by the
mean of DB: the geometric mean over domains. Errors count times the power of the number of vertices that makes them independent
of it.
"""
import collections
import glob
import json
import math
import sys

QUALITIES = ["eta_mean", "eta_worst", "d4", "n_irregular", "tau", "aspect_mean", "aspect_max", "warp_mean"]
ERRORS = {"poisson_h1": 0.5, "poisson_l2": 1, "elasticity_h1": 0.5, "poisson_condition": -1, "poisson_cg_iterations": -0.5}
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


def ranks(values):
    """Returns the rank of each value, from 1; ties share their mean rank."""
    return [sum(v < x for v in values) + (sum(v == x for v in values) + 1) / 2 for x in values]


def spearman(a, b):
    """Returns the correlation; NaN for fewer than three pairs, and if one of both is constant."""
    if len(a) < 3 or min(a) == max(a) or min(b) == max(b):
        return math.nan
    a, b = ranks(a), ranks(b)
    middle = (len(a) + 1) / 2
    spread = [math.sqrt(sum((x - middle) ** 2 for x in v)) for v in (a, b)]
    return sum((x - middle) * (y - middle) for x, y in zip(a, b)) / spread[0] / spread[1]


def correlations(error, quality):
    """Returns the rank correlation within each case."""
    for case in sorted({case for case, _ in cells}):
        runs = [m for (of, _), all_runs in cells.items() if of == case for m in all_runs]
        runs = [m for m in runs if m.get(error) is not None and m.get(quality) is not None]
        rho = spearman([m[error] * m["n_vertices"] ** ERRORS[error] for m in runs], [m[quality] for m in runs])
        if not math.isnan(rho):
            yield rho


print("| error | " + " | ".join(QUALITIES) + " |\n|---|" + "---|" * len(QUALITIES))
for error in ERRORS:
    found = [list(correlations(error, quality)) for quality in QUALITIES]
    print(f"| {error} | " + " | ".join(
        f"{sum(r) / len(r):.2f} ({min(r):.2f} to {max(r):.2f})" if r else "-" for r in found) + " |")
print()
print("| pipeline | " + " | ".join(MEASURES) + " |\n|---|" + "---|" * len(MEASURES))
for word in sorted({word for _, word in cells} - {"DB"}):
    line = []
    for key in MEASURES:
        ratios = [mean(case, word, key) / mean(case, "DB", key) for case in sorted({case for case, _ in cells})]
        ratios = [r for r in ratios if not math.isnan(r)]
        whole = math.exp(sum(map(math.log, ratios)) / len(ratios)) if ratios else math.nan
        line.append(f"{whole:.3f} ({min(ratios):.3f} to {max(ratios):.3f})" if ratios else "-")
    print(f"| {word} | " + " | ".join(line) + " |")
