# SPDX-License-Identifier: GPL-3.0-or-later
"""Recomputes the claims of DIR/pairs.csv or DIR/hypotheses.csv from DIR/runs.csv alone, as docs/statistics.md explains: check_claims.py DIR"""
import csv, itertools, math, pathlib, sys
import numpy as np
from scipy import stats
folder = pathlib.Path(sys.argv[1])
def rows(name): return list(csv.DictReader((folder / name).open(newline=""))) if (folder / name).exists() else []
def wilcoxon(differences):  # p, the least that it could be, and which way it leans
    d = np.array([x for x in differences if x != 0])
    ranks, ways = np.rint(2 * stats.rankdata(abs(d))).astype(int), np.ones(1)
    up, down, least = ranks[d > 0].sum(), ranks[d < 0].sum(), min(1, 2 * 0.5 ** len(d))
    if len(d) > 60: return min(1, 2 * stats.norm.cdf((min(up, down) + 1 - ranks.sum() / 2) / (math.sqrt((ranks.astype(float) ** 2).sum()) / 2))), least, up - down
    for r in ranks: ways = np.pad(ways, (0, r)) + np.pad(ways, (r, 0))  # in which signs give a sum
    return min(1, 2 * ways[:min(up, down) + 1].sum() / 2.0 ** len(d)), least, up - down
def interval(values):  # of the mean: Student's, from six values on without the skewness
    n, x = len(values), np.array(values)
    end, spread = stats.t.ppf(0.975, n - 1) / math.sqrt(n), x.std(ddof=1)
    g = ((x - x.mean()) ** 3).mean() / x.std() ** 3 if x.std() > 0 else 0
    inverse = (lambda u: 3 / g * (np.cbrt(1 + g * (u - g / (6 * n))) - 1)) if n > 5 and abs(g) > 1e-9 else (lambda u: u)
    return x.mean() - spread * inverse(end), x.mean() - spread * inverse(-end)
def competes(pipeline, of_quads): return pipeline not in triangles_alone and not (of_quads and pipeline in with_triangles)
def compare(first, second, key, column):  # words, or values of an axis: by domain the difference, and who failed
    (axis, a), (_, b) = names[first], names[second]
    variant = lambda r: tuple(r[x] for x in ["case", "pipeline", *axes] if x != axis)
    run = [r for r in told if r["status"] not in ("skipped", "not applicable") and competes(r["pipeline"], column["of_quads"])]
    partners, domains = {(variant(r), r["seed"]): r for r in run if r[axis] == b}, {}
    for r in (r for r in run if r[axis] == a and (variant(r), r["seed"]) in partners):
        sides = r, partners[variant(r), r["seed"]]
        there = [float(s["n_quads"] or 0) > 0 for s in sides]
        values = [float(s[key]) if t and s[key] else math.nan for s, t in zip(sides, there)]
        if all(map(math.isnan, values)) and any(there): continue  # the measure is not defined
        differences, failed = domains.setdefault(r["domain"], ({}, [False, False]))
        for side in (0, 1): failed[side] |= math.isnan(values[side])
        if not any(map(math.isnan, values)): differences.setdefault(variant(r), []).append(values[0] - values[1])
    worst = {"higher": -math.inf, "lower": math.inf}[column["better"]]
    decided = [d for d in domains.values() if not all(d[1])]  # where both failed, nothing is
    return [worst if f[0] else -worst if f[1] else mean([mean(s) for _, s in sorted(v.items())]) for v, f in decided], [sum(f[side] for _, f in decided) for side in (0, 1)]
def decide(family):  # Holm over those that Tarone leaves
    k = next(k for k in itertools.count(1) if sum(least <= 0.05 / k for _, least, _ in family) <= k)
    counted = sorted((i for i in range(len(family)) if family[i][1] <= 0.05 / k), key=lambda i: family[i][0])
    return dict(zip(counted, np.maximum.accumulate([0] + [min(1, (len(counted) - j) * family[i][0]) for j, i in enumerate(counted)])[1:]))
mean = lambda values: np.cumsum(values)[-1] / len(values)  # in their order, so that ties stay ties
columns, told, planned = map(rows, ("runs_columns.csv", "runs.csv", "hypotheses.csv"))
axes = [c["column"] for c in columns]; axes = axes[axes.index("kind") + 1:axes.index("seed")]
names = {r[x] if x == "pipeline" else f"{x}={r[x]}": (x, r[x]) for r in told for x in ("pipeline", *axes)}
quads = {r["pipeline"] for r in told if float(r["n_quads"] or 0) > 0}
with_triangles = {r["pipeline"] for r in told if float(r["n_quads"] or 0) > 0 and float(r["n_triangles"] or 0) > 0}
triangles_alone = {r["pipeline"] for r in told if r["status"] in ("ok", "unsound")} - quads
late = any('"plan_changed": true' in study.read_text() for study in folder.glob("study.json"))
what, between, *claims = ("hypothesis", " better than ", "refuted", "proven") if planned else ("pipelines", " - ", "worse", "better")
said = {a + between + b: (a, b) for a, b in itertools.permutations(names, 2)}
found, family = [], []
for stated in planned or rows("pairs.csv"):
    first, second = said[stated[what]]
    column = next(c for c in columns if c["title"] == stated["measure"] and c["better"])
    differences, failed = compare(first, second, column["column"], column)
    found.append((stated, first, second, differences, failed, 1 if column["better"] == "higher" else -1))
    family.append(wilcoxon(differences))
corrected = {} if late else decide(family)
wrong = [f"{r['pipelines']} {r['measure']}: claims what was not planned" for r in rows("pairs.csv") if (planned or late) and r["first_is"] != "exploratory"]
for (stated, first, second, differences, failed, sign), (p, _, lean), holm in zip(found, family, (corrected.get(i, math.nan) for i in range(len(family)))):
    finite = [d for d in differences if math.isfinite(d)]
    effect, ends = mean(finite) if finite else math.nan, interval(finite) if len(finite) > 1 else (-math.inf, math.inf)
    claim = "exploratory" if late else "no difference" if len(differences) > 5 and not any(differences) else "too few domains" if math.isnan(holm) else "not proven"
    if claim == "not proven" and holm <= 0.05 and (ends[0] > 0 if lean > 0 else ends[1] < 0):
        claim = claims[int(sign * lean > 0)]
        if any(failed): claim += " (" + ", ".join(f"{name} failed on {n}" for name, n in zip((first, second), failed) if n) + ")"
    wrong += [f"{' '.join(list(stated.values())[:2])}: {key} is '{stated[key]}', by runs.csv '{value}'" for key, value in zip(("domains", "first_failed", "second_failed", "effect", "p", "p_corrected", "first_is"), (len(differences), *failed, effect, p, holm, claim))
              if (stated[key] != value if key == "first_is" else not np.isclose(float(stated[key] or math.nan), value, rtol=1e-9, atol=1e-12, equal_nan=True))]
print(*wrong, f"{len(found)} comparisons of {len(family)} tests: {'not planned, ' if late else ''}{'' if found and not wrong else 'not '}confirmed", sep="\n")
sys.exit(not found or bool(wrong))
