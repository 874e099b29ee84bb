"""Recomputes what DIR/pairs.csv or DIR/hypotheses.csv claims, from DIR/runs.csv alone, as docs/statistics.md says: check_claims.py DIR"""
import csv, itertools, math, pathlib, sys
import numpy as np
from scipy import stats
folder = pathlib.Path(sys.argv[1])
def rows(name): return list(csv.DictReader((folder / name).open(newline=""))) if (folder / name).exists() else []
def wilcoxon(differences, tails=2):  # p (with one tail, of being above 0), the least that it could be, and which way it leans
    d = np.array([x for x in differences if x != 0])
    ranks, ways = np.rint(2 * stats.rankdata(abs(d))).astype(int), np.ones(1)
    up, down, least = ranks[d > 0].sum(), ranks[d < 0].sum(), min(1, tails * 0.5 ** len(d))
    if len(d) > 60: return stats.wilcoxon(d, correction=True, method="approx", alternative=["greater", "two-sided"][tails - 1]).pvalue, least, up - down
    for r in ranks: ways = np.pad(ways, (0, r)) + np.pad(ways, (r, 0))  # in which signs give a sum
    return min(1, tails * ways[:(min(up, down) if tails == 2 else down) + 1].sum() / 2.0 ** len(d)), least, up - down
def mann_whitney(a, b): return stats.mannwhitneyu(a, b, method="exact" if len(a) + len(b) <= 60 else "asymptotic").pvalue, min(1, 2 / math.comb(len(a) + len(b), len(a))), 0
def differences(a, b, key, axis="pipeline"):  # of runs of the same variant and seed
    variant = lambda r: tuple(r[x] for x in ["case", "pipeline", *axes] if x != axis)
    other = {(variant(r), r["seed"]): np.median(r[key]) for r in b if r[key]}
    return [(r, variant(r), np.median(r[key]) - other[variant(r), r["seed"]]) for r in a if r[key] and (variant(r), r["seed"]) in other]
def compare(first, second, key, of_quads):  # words, or values of an axis: means of domains
    axis, domains = names[first][0], {}
    a, b = ([r for r in runs if r["n_quads"] and r[axis] == names[n][1] and not (of_quads and r["pipeline"] in triangles)] for n in (first, second))
    for r, variant, d in differences(a, b, key, axis): domains.setdefault(r["domain"], {}).setdefault(variant, []).append(d)
    return [mean([mean(s) for _, s in sorted(v.items())]) for v in domains.values()]
def decide(family, floor):  # Holm over those that Tarone leaves
    k = next(k for k in itertools.count(1) if sum(least <= 0.05 / k for _, least, _ in family) <= k)
    counted = sorted((i for i in range(len(family)) if family[i][1] <= 0.05 / k), key=lambda i: family[i][0])
    return dict(zip(counted, np.maximum.accumulate([floor] + [min(1, (len(counted) - j) * family[i][0]) for j, i in enumerate(counted)])[1:]))
columns, told, planned, measures, groups, runs, found = *map(rows, ("runs_columns.csv", "runs.csv", "hypotheses.csv")), {}, {}, [], []
mean = lambda values: np.cumsum(values)[-1] / len(values)  # in their order, so that ties stay ties
for c in (c for c in columns if c["tested"]): measures.setdefault(c["column"].split("_run_")[0], []).append(c)  # a time has one a run
axes = [c["column"] for c in columns]; axes = axes[axes.index("kind") + 1:axes.index("seed")]
names = {r[x] if x == "pipeline" else f"{x}={r[x]}": (x, r[x]) for r in told for x in ("pipeline", *axes)}
for run in (r for r in told if r["status"] in ("ok", "unsound")):
    runs.append(run | {key: [float(run[one["column"]]) for one in c if run[one["column"]]] for key, c in measures.items()}
                | {n: float(run[n]) for n in ("n_quads", "n_triangles")})
    groups.setdefault((run["case"],) + tuple(run[x] for x in axes), {}).setdefault(run["pipeline"], []).append(runs[-1])
triangles, families, corrected = {r["pipeline"] for r in runs if r["n_triangles"]}, [[], []], []
for group, (key, c) in itertools.product(groups.values(), () if planned else measures.items()):  # what marks could claim
    rivals = [r for r in group.values() if any(x[key] for x in r) and all(
        x["status"] == "ok" and x["n_quads"] and not (c[0]["of_quads"] and x["n_triangles"]) for x in r)]
    families[0] += [wilcoxon([d for *_, d in differences(a, b, key)]) if c[0]["column"] == key else mann_whitney(
        sum((x[key] for x in a), []), sum((x[key] for x in b), [])) for a, b in itertools.combinations(rivals, 2)]
what, between, *claims = ("hypothesis", " better than ", "refuted", "proven") if planned else ("pipelines", " - ", "worse", "better")
said = {a + between + b + how: (a, b, how) for a, b in itertools.permutations(names, 2) for how in ("", ", two-sided", ", secondary", ", two-sided, secondary")}
for stated in planned or rows("pairs.csv"):
    first, second, how = said[stated[what]]
    key, c = next((key, c[0]) for key, c in measures.items() if c[0]["title"] == stated["measure"])
    means, sign, family = compare(first, second, key, c["of_quads"]), 1 if c["better"] == "higher" else -1, int("secondary" in how)
    found.append((stated, family, len(families[family]), means, sign))
    families[family].append(wilcoxon([sign * m for m in means], 1 if planned and "two-sided" not in how else 2))
for family in families: corrected.append(decide(family, max((corrected[0].get(i, 1) for i in range(len(families[0]))), default=0) if corrected else 0))
wrong = [f"{r['pipelines']} {r['measure']}: claims what was not planned" for r in rows("pairs.csv") if planned and r["first_is"] != "exploratory"]
for stated, family, i, means, sign in found:
    (p, _, lean), effect, holm = families[family][i], mean(means) if means else math.nan, corrected[family].get(i, math.nan)
    claim = "no difference" if len(means) > 5 and not any(means) else "too few domains" if math.isnan(holm) else "not proven" if holm > 0.05 or sign * effect * lean <= 0 else claims[int(sign * effect > 0)]
    wrong += [f"{' '.join(list(stated.values())[:2])}: {key} is '{stated[key]}', by runs.csv '{value}'" for key, value in zip(("domains", "effect", "p", "p_corrected", "first_is"), (len(means), effect, p, holm, claim))
              if (stated[key] != value if key == "first_is" else not np.isclose(float(stated[key] or math.nan), value, rtol=1e-9, atol=1e-12, equal_nan=True))]
late = "not planned, " if any("plan_changed" in study.read_text() for study in folder.glob("study.json")) else ""
print(*wrong, f"{len(found)} comparisons of {sum(map(len, families))} tests: {late}{'' if found and not wrong else 'not '}confirmed", sep="\n")
sys.exit(not found or bool(wrong))
