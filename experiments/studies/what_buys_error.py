#!/usr/bin/env python3
"""What buys error: what_buys_error.py RESULTS prints how many vertices squares need for the same error.

From slopes.json: of each case the errors of all rows at one number of vertices, over those of the first word's loop
of squares, to the power of -1 in L2 and -2 in H1, by which they fall where layers are resolved. Rows are words and
options, the last column is the geometric mean over cases.
"""
import collections
import json
import math
import sys

POWERS = {"poisson_l2": 1, "poisson_h1": 2}
SQUARES = "kind = 'squares'"

with open(sys.argv[1] + "/slopes.json") as file:
    rows = [row for row in json.load(file)["rows"] if row["values"].get("at.poisson_h1")]
cases = list(dict.fromkeys(row["case"] for row in rows))
found = collections.defaultdict(dict)
for row in rows:
    found[row["pipeline"]][row["case"]] = row["values"]
base = next((values for name, values in found.items() if SQUARES in name), None)
if base is None:
    sys.exit(f"{sys.argv[1]}: no rows of squares: expected the results of experiments/studies/what_buys_error.toml")
for key, power in POWERS.items():
    print(f"{key}\n\n| | " + " | ".join(cases) + " | mean |\n|---|" + "---:|" * (len(cases) + 1))
    for name, values in found.items():
        saved = [(base[c]["at." + key] / values[c]["at." + key]) ** power for c in cases]
        whole = math.exp(sum(map(math.log, saved)) / len(saved))
        print(f"| {name} | " + " | ".join(f"{s:.2g}" for s in [*saved, whole]) + " |")
    print()
