# SPDX-License-Identifier: GPL-3.0-or-later
"""Ranks the programs that ran the suite, by the runs.csv below a folder, as docs/suite.md says: ranking.py DIR
It writes DIR/ranking/table.md and table.csv."""
import csv, itertools, json, pathlib, sys
import numpy as np
from scipy import stats

FOR_ALL = ["planar", "cad", "triangles", "hard"]  # experiments that every program can be asked
COLUMNS = {"score": 1, "models": 0, "cases": 0, "solved": 0, "with triangles": 0, "failed": 0, "eta worst": 3,
           "eta mean": 3, "d4": 1, "tau": 1, "CPU s": 1}
NOTES = ["score: mean over the models of mean eta x tau x share of quads, averaged over the cases of a model; 0 for a case without a sound mesh; in percent, "
         "with its 95 % interval over the models",
         "solved: sound meshes of quads only; failed: no mesh, or one that is not sound or not of its model; who ran fewer cases stands below",
         "eta worst: the least; eta mean, d4, tau: means over the sound meshes; CPU s: their sum"]


def read_cells(folder):
    """Returns the rows of runs.csv by program and experiment; from the second run on, a repeated name begins with the folder."""
    programs, owners, titles = {}, {}, {}
    for file in sorted(folder.rglob("runs.csv")):
        study = json.loads(file.with_name("study.json").read_text())
        experiment = study["experiment"]
        if titles.setdefault(experiment, study["title"]) != study["title"]:
            sys.exit(f"error: {file.parent}: holds results of '{study['title']}', not of '{titles[experiment]}'")
        for row in csv.DictReader(file.read_text().splitlines()):
            owner = owners.setdefault((row["pipeline"], experiment), file)
            name = row["pipeline"] if owner == file else f"{file.parent.relative_to(folder)}/{row['pipeline']}"
            programs.setdefault(name, {}).setdefault(experiment, []).append(row)
    return programs


class Entry:
    """A program in a group of experiments."""

    def __init__(self, name, cells):
        self.name, self.better_than = name, []
        self.cells = [c for c in cells if c["status"] not in ("skipped", "not applicable")]
        self.reason = next((c["reason"] for c in cells if c["status"] == "not applicable"), "")
        sound = [c for c in self.cells if c["status"] == "ok"]
        solved = sum(value(c, "percent_quads") == 100 for c in sound)
        scores = {}
        for c in self.cells:
            scores.setdefault(c["domain"], []).append(score(c))
        self.scores = {model: np.mean(of) for model, of in scores.items()}
        of_models = list(self.scores.values())
        n = len(of_models)
        self.interval = stats.t.ppf(0.975, n - 1) * np.std(of_models, ddof=1) / np.sqrt(n) if n > 1 else np.nan
        means = {key: [value(c, key) for c in sound if value(c, "percent_quads") > 0] for key in ("eta_worst", "eta_mean", "d4", "tau")}
        self.values = {"score": np.mean(of_models) if n else np.nan, "models": n, "cases": len(self.cells), "solved": solved, "with triangles": len(sound) - solved,
                       "failed": len(self.cells) - len(sound), "eta worst": min(means["eta_worst"], default=np.nan),
                       "eta mean": mean(means["eta_mean"]), "d4": mean(means["d4"]), "tau": mean([value(c, "tau") for c in sound]),
                       "CPU s": sum(float(c["seconds_total"] or 0) for c in sound)}

    def texts(self):
        if not self.cells:
            return ["not applicable"] + [""] * len(COLUMNS)
        shown = ["" if np.isnan(self.values[c]) else f"{self.values[c]:.{digits}f}" for c, digits in COLUMNS.items()]
        shown[0] += "" if np.isnan(self.interval) else f" ± {self.interval:.1f}"
        return shown + [", ".join(self.better_than)]


def mean(values):
    return np.mean(values) if values else np.nan


def value(cell, key):
    """Returns measures of a run; if the case has a metric, eta and tau in the metric."""
    return float(cell.get("metric_" + key) or cell[key] or "nan")


def score(cell):
    if cell["status"] != "ok" or not value(cell, "percent_quads") > 0:
        return 0
    return value(cell, "eta_mean") * value(cell, "tau") * value(cell, "percent_quads") / 100


def test(groups):
    """Tests every two programs of every group over the models that both ran. All tests are one family; see docs/statistics.md."""
    duels = []
    for first, second in itertools.chain(*(itertools.combinations(group, 2) for group in groups.values())):
        differences = [s - second.scores[model] for model, s in first.scores.items() if model in second.scores]
        if np.mean(differences or 0) * np.median(differences or 0) > 0:  # both say which is better
            duels.append((stats.wilcoxon(differences).pvalue, 2 * 0.5 ** len(differences), np.mean(differences), first, second))
    most = next(k for k in itertools.count(1) if sum(least <= 0.05 / k for _, least, *_ in duels) <= k)
    counted = sorted((d for d in duels if d[1] <= 0.05 / most), key=lambda d: d[0])  # the others could prove nothing
    for k, (p, _, effect, first, second) in enumerate(counted):
        if p * (len(counted) - k) > 0.05:
            break
        winner, loser = (first, second) if effect > 0 else (second, first)
        winner.better_than.append(loser.name)
    return f"better than: proven by Wilcoxon's signed-rank test over the models that both ran; {len(counted)} of {len(duels)} tests count, corrected by Holm's method"


def main(folder):
    programs = read_cells(folder)
    if not programs:
        sys.exit(f"error: {folder}: has no runs.csv: 'delquad run experiments/suite/*.toml -o {folder}' makes them")
    experiments = sorted({e for of in programs.values() for e in of}, key=lambda e: (FOR_ALL.index(e) if e in FOR_ALL else len(FOR_ALL), e))
    groups = {}
    for group, members in [("all", FOR_ALL), *((e, [e]) for e in experiments)]:
        cells = {name: [c for e in members for c in of.get(e, [])] for name, of in programs.items()}
        groups[group] = sorted((Entry(name, of) for name, of in cells.items() if of),
                               key=lambda e: (e.values["cases"], np.nan_to_num(e.values["score"])), reverse=True)
    notes = NOTES + [test(groups)] + [f"{e.name} is not applicable to {group}: {e.reason}" for group, of in groups.items() for e in of if not e.cells]
    head = ["family", "program", *COLUMNS, "better than"]
    rows = [[group, entry.name, *entry.texts()] for group, of in groups.items() for entry in of]
    (folder / "ranking").mkdir(exist_ok=True)
    lines = ["# Suite, ranked", "", *("| " + " | ".join(row) + " |" for row in [head, ["---"] * 2 + ["---:"] * len(COLUMNS) + ["---"], *rows]), "", *("* " + note for note in notes)]
    (folder / "ranking/table.md").write_text("\n".join(lines) + "\n")
    with (folder / "ranking/table.csv").open("w", newline="") as out:
        table = csv.writer(out)
        table.writerow(["family", "program", *COLUMNS, "score_half_width", "better than"])
        for group, of in groups.items():
            table.writerows([group, e.name, *e.values.values(), e.interval, ", ".join(e.better_than)] for e in of)
    print("\n".join(lines))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]))
