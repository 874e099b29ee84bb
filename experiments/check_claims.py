"""Recomputes what DIR/pairs.csv claims, from DIR/runs.csv alone, as docs/statistics.md says: check_claims.py DIR"""
import csv, itertools, math, pathlib, sys
import numpy as np
from scipy import stats

def rows(name):
    file = pathlib.Path(sys.argv[1]) / name
    return list(csv.DictReader(file.open(newline=""))) if file.exists() else []
def wilcoxon(differences):  # p, the least that it could be, and which way it leans
    d = np.array([x for x in differences if x != 0])
    ranks, ways = np.rint(2 * stats.rankdata(abs(d))).astype(int), np.ones(1)
    up, down, least = ranks[d > 0].sum(), ranks[d < 0].sum(), min(1, 2.0 ** (1 - len(d)))
    if len(d) > 60: return stats.wilcoxon(d, correction=True, method="approx").pvalue, least, up - down
    for r in ranks: ways = np.pad(ways, (0, r)) + np.pad(ways, (r, 0))  # in which signs give a sum
    return min(1, 2 * ways[:min(up, down) + 1].sum() / 2.0 ** len(d)), least, up - down
def mann_whitney(a, b):
    p = stats.mannwhitneyu(a, b, method="exact" if len(a) + len(b) <= 60 else "asymptotic").pvalue
    return p, min(1, 2 / math.comb(len(a) + len(b), len(a))), 0
def differences(a, b, key):  # of runs of the same variant and seed
    other = {(r["group"], r["seed"]): np.median(r[key]) for r in b if r[key]}
    return [(r, np.median(r[key]) - other[r["group"], r["seed"]]) for r in a if r[key] and (r["group"], r["seed"]) in other]
columns, measures, words, groups, family, pairs = rows("runs_columns.csv"), {}, {}, {}, [], {}
mean = lambda values: np.cumsum(values)[-1] / len(values)  # in their order, so that ties stay ties
for c in (c for c in columns if c["tested"]):  # a measure has one column, a time one for each of its runs
    measures.setdefault(c["column"].split("_run_")[0], []).append(c)
names = [c["column"] for c in columns]
for run in (r for r in rows("runs.csv") if r["status"] in ("ok", "unsound")):
    variant = [f"{a}={run[a]}" for a in names[names.index("kind") + 1:names.index("seed")]]
    values = {key: [float(run[one["column"]]) for one in c if run[one["column"]]] for key, c in measures.items()}
    run |= values | {"group": ", ".join([run["case"]] + variant)} | {n: float(run[n]) for n in ("n_quads", "n_triangles")}
    words.setdefault(run["pipeline"], []).append(run)
    groups.setdefault(run["group"], {}).setdefault(run["pipeline"], []).append(run)
for group, (key, c) in itertools.product(groups.values(), measures.items()):  # what marks could claim
    rivals = [r for r in group.values() if any(x[key] for x in r) and all(
        x["status"] == "ok" and x["n_quads"] and not (c[0]["of_quads"] and x["n_triangles"]) for x in r)]
    for a, b in itertools.combinations(rivals, 2):
        family.append(wilcoxon([d for _, d in differences(a, b, key)]) if c[0]["column"] == key else
                      mann_whitney(sum((x[key] for x in a), []), sum((x[key] for x in b), [])))
for (second, first), (key, c) in itertools.product(itertools.combinations(words, 2), measures.items()):
    a, b, domains = *([r for r in words[w] if r["n_quads"]] for w in (first, second)), {}
    for run, d in differences(a, b, key): domains.setdefault(run["domain"], {}).setdefault(run["group"], []).append(d)
    if len(domains) > 1 and "pairs" in c[0]["tested"] and not (c[0]["of_quads"] and any(r["n_triangles"] for r in a + b)):
        means = [mean([mean(seeds) for _, seeds in sorted(variants.items())]) for variants in domains.values()]
        pairs[f"{first} - {second}", c[0]["title"]] = len(family), len(means), mean(means), c[0]["better"]
        family.append(wilcoxon(means))
k = next(k for k in itertools.count(1) if sum(least <= 0.05 / k for _, least, _ in family) <= k)  # Tarone
counted = sorted((i for i in range(len(family)) if family[i][1] <= 0.05 / k), key=lambda i: family[i][0])
holm = np.maximum.accumulate([min(1, (len(counted) - j) * family[i][0]) for j, i in enumerate(counted)] or [0])
corrected, stated = dict(zip(counted, holm)), {(r["pipelines"], r["measure"]): r for r in rows("pairs.csv")}
wrong = [f"{pair}: is not in both, runs.csv and pairs.csv" for pair in sorted(set(pairs) ^ set(stated))]
for pair, (i, n, effect, better) in ((pair, found) for pair, found in pairs.items() if pair in stated):
    proven, too_few = corrected.get(i, 1) <= 0.05 and effect * family[i][2] > 0, n < 6 or i not in corrected
    way = "better" if (effect > 0) == (better == "higher") else "worse"
    claim = "too few domains" if too_few else way if proven else "not proven"
    numbers = {"domains": n, "effect": effect, "p": family[i][0], "p_corrected": corrected.get(i, math.nan)}
    wrong += [f"{pair}: {key} is {stated[pair][key]}, by runs.csv {value}" for key, value in numbers.items() if not
              np.isclose(float(stated[pair][key] or math.nan), value, rtol=1e-9, atol=1e-12, equal_nan=True)]
    if stated[pair]["first_is"] != claim: wrong.append(f"{pair}: is '{stated[pair]['first_is']}', by runs.csv '{claim}'")
print(*wrong, f"{len(pairs)} comparisons of {len(family)} tests: {'not ' if wrong else ''}confirmed", sep="\n")
sys.exit(1 if wrong else 0)
