#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits errors: what_buys_error.py RESULTS prints powers of the number of vertices, and how many vertices squares need.

The column `power` has the power by which errors go with the number of vertices, as the mean over cases. The others
compare all rows at one number of vertices. They divide the error of the first pipeline's loop of squares by the row's
error. The quotient is taken to the power of 1 in L2 and 2 in H1. Errors fall by these powers of the number of vertices
where layers are resolved. Rows are pipelines and options, the last column is the geometric mean over cases.
"""
import collections
import csv
import math
import sys

POWERS = {"poisson_l2": 1, "poisson_h1": 2}
SQUARES = "kind = 'squares'"


def fit(points):
    """Returns power and factor of the best law, by least squares of the logarithms."""
    u, v = ([math.log(p[k]) for p in points] for k in (0, 1))
    u0, v0 = sum(u) / len(u), sum(v) / len(v)
    power = sum((a - u0) * (b - v0) for a, b in zip(u, v)) / sum((a - u0) ** 2 for a in u)
    return power, math.exp(v0 - power * u0)


with open(sys.argv[1] + "/runs.csv", newline="") as file:
    runs = [run for run in csv.DictReader(file) if run["status"] == "ok" and run["poisson_h1"]]
cases = list(dict.fromkeys(run["case"] for run in runs))
rows = list(dict.fromkeys((run["pipeline"], run["adapt"]) for run in runs))
base = next((row for row in rows if SQUARES in row[1]), None)
if base is None:
    sys.exit(f"{sys.argv[1]}: no rows of squares: expected the results of experiments/studies/what_buys_error.toml")
points = collections.defaultdict(list)
for run in runs:
    for key in POWERS:
        points[run["pipeline"], run["adapt"], run["case"], key].append((float(run["n_vertices"]), float(run[key])))
middle = {c: math.exp(sum(v := [math.log(float(r["n_vertices"])) for r in runs if r["case"] == c]) / len(v)) for c in cases}
for key, power in POWERS.items():
    print(f"{key}\n\n| | power | " + " | ".join(cases) + " | mean |\n|---|" + "---:|" * (len(cases) + 2))
    laws = {(row, c): fit(points[*row, c, key]) for row in rows for c in cases}
    at = {place: factor * middle[place[1]] ** slope for place, (slope, factor) in laws.items()}
    for row in rows:
        saved = [(at[base, c] / at[row, c]) ** power for c in cases]
        whole = math.exp(sum(map(math.log, saved)) / len(saved))
        slope = sum(laws[row, c][0] for c in cases) / len(cases)
        print(f"| {' '.join(row)} | {slope:.2f} | " + " | ".join(f"{s:.2g}" for s in [*saved, whole]) + " |")
    print()
