#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the figures of folders of results, as SVG and PDF in DIR/figures: figures.py DIR ...

It reads only runs.csv, runs_columns.csv, pairs.csv and hypotheses.csv. `delquad run` and `delquad tables` call it. To change figures, change a
copy of it, and name the copy in the environment variable DELQUAD_FIGURES. Exit code 3: matplotlib is not installed."""

import csv
import functools
import math
import os
import pathlib
import sys

WIDTH, HEIGHT = 3.4, 2.4  # inches: a column of a journal with two, and the axes with their labels
LINE = 0.16  # inches: a line of the legend, or of the notes
FEWEST_CASES = 3
LEAST_COST = 1e-6  # nobody sees a smaller one
# Okabe and Ito: people with any color vision tell them apart. Shapes and dashes tell series apart without color.
COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000"]
MARKERS, DASHES = "os^D", ["-", "--", ":", "-."]
STYLE = {
    "figure.constrained_layout.use": True, "font.family": "DejaVu Sans", "font.size": 7, "axes.linewidth": 0.6, "legend.frameon": False,
    "lines.linewidth": 1.2, "lines.markersize": 3.5, "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.4, "axes.axisbelow": True,
    "text.parse_math": False,  # names of cases and pipelines are no formulas
    "svg.fonttype": "path", "svg.hashsalt": "delquad", "pdf.fonttype": 42,  # fonts inside, the same bytes each time
}


def read(folder, name):
    path = folder / name
    return list(csv.DictReader(path.open(newline="", encoding="utf-8"))) if path.exists() else []


def number(row, key):
    return float(row.get(key) or math.nan)


class Runs:
    """Keeps the runs of pipelines that make quads, on the variants of cases that all of them have run."""

    def __init__(self, rows, columns):
        names = [column["column"] for column in columns]
        axes = names[names.index("kind") + 1:names.index("status")] if rows else []
        has_mesh = [row for row in rows if row["status"] in ("ok", "unsound")]
        quads = {row["pipeline"] for row in has_mesh if number(row, "n_quads") > 0}
        others = {row["pipeline"] for row in has_mesh} - quads
        self.cells, groups = {}, {}
        self.pipelines = list(dict.fromkeys(row["pipeline"] for row in rows if row["pipeline"] not in others))
        for row in rows:
            group = (row["case"], *(row[axis] for axis in axes))
            groups.setdefault(group, []).append(row)
            self.cells[group, row["pipeline"]] = row
        self.groups = [group for group, cells in groups.items()
                       if all((group, pipeline) in self.cells for pipeline in self.pipelines)
                       and not any(cell["status"] == "skipped" for cell in cells)]  # its data is absent

    def of(self, pipeline):
        return [self.cells[group, pipeline] for group in self.groups]

    def label(self, pipeline):
        """Names a pipeline and counts its missing values: "gmsh (1 failed, 2 not applicable of 12)"."""
        told = {}
        for cell in self.of(pipeline):
            if not is_sound(cell):
                what = {"ok": "without quads", "unsound": "not sound"}.get(cell["status"], cell["status"])
                told[what] = told.get(what, 0) + 1
        text = ", ".join(f"{count} {what}" for what, count in told.items())
        return f"{pipeline} ({text} of {len(self.groups)})" if text else pipeline


def is_sound(cell):
    return cell["status"] == "ok" and number(cell, "n_quads") > 0


def draw_scatter(x, y, labels, axes, runs):
    for k, pipeline in enumerate(runs.pipelines):
        cells = [cell for cell in runs.of(pipeline) if is_sound(cell)]
        axes.plot([x(cell) for cell in cells], [number(cell, y) for cell in cells], linestyle="none", alpha=0.75, label=runs.label(pipeline),
                  markeredgewidth=0, marker=MARKERS[k % len(MARKERS)], color=COLORS[k % len(COLORS)])
    axes.set(**labels)


def draw_profile(title, cost, axes, runs):
    """Draws performance profiles [dolan2002]: the share of cells on which a pipeline costs at most a multiple of the least cost.

    A cell without a sound mesh costs infinitely much.
    """
    def cost_of(cell):
        value = cost(cell) if is_sound(cell) else math.inf
        return math.inf if math.isnan(value) else max(value, LEAST_COST)
    factors = {pipeline: [] for pipeline in runs.pipelines}
    for group in runs.groups:
        costs = {pipeline: cost_of(runs.cells[group, pipeline]) for pipeline in runs.pipelines}
        least = min(costs.values())
        for pipeline, value in costs.items():
            factors[pipeline].append(value / least if value < math.inf else math.inf)
    most = max((f for of in factors.values() for f in of if f < math.inf), default=1) * 1.05
    for k, (pipeline, of) in enumerate(factors.items()):
        reached = sorted(f for f in of if f < math.inf)
        percents = [0, *(100 * (i + 1) / len(of) for i in range(len(reached)))]
        axes.plot([1, *reached, most], [*percents, percents[-1]], drawstyle="steps-post", label=runs.label(pipeline),
                  linestyle=DASHES[k // len(COLORS) % len(DASHES)], color=COLORS[k % len(COLORS)])
    axes.set(xlabel=f"{title}: times the least", ylabel="% of the cells", xscale="log", ylim=(0, 103))


COMPARISONS = {  # of pipelines over cases
    "time_quality": functools.partial(draw_scatter, lambda cell: number(cell, "seconds_total"), "eta_mean",
                                      {"xlabel": "seconds, from the model to the mesh", "ylabel": "mean eta", "xscale": "log"}),
    "irregular_tau": functools.partial(draw_scatter, lambda cell: 100 - number(cell, "d4"), "tau",
                                       {"xlabel": "interior vertices without just four quads, %", "ylabel": "tau, %"}),
    "profile_eta": functools.partial(draw_profile, "1 - mean eta", lambda cell: 1 - number(cell, "eta_mean")),
    "profile_tau": functools.partial(draw_profile, "100 - tau", lambda cell: 100 - number(cell, "tau")),
    "profile_time": functools.partial(draw_profile, "seconds", lambda cell: number(cell, "seconds_total")),
}


def is_proven(pair, hypotheses):
    """Planned studies prove their hypotheses alone."""
    first, second = pair["pipelines"].split(" - ", 1)
    planned = {f"{first} better than {second}", f"{second} better than {first}"}
    claims = [row["first_is"] for row in hypotheses if row["hypothesis"] in planned and row["measure"] == pair["measure"]]
    return any(claim in ("better", "worse", "proven", "refuted") for claim in [pair["first_is"], *claims])  # without failures


def draw_effects(rows, column, hypotheses, axes):
    def label(row):
        names, counts = row["pipelines"].split(" - ", 1), (row["first_failed"], row["second_failed"])
        told = ", ".join(f"{name} failed on {count}" for name, count in zip(names, counts) if float(count or 0) > 0)
        return row["pipelines"] + (f"\n({told})" if told else "")
    for k, row in enumerate(rows):
        axes.plot([number(row, "low"), number(row, "high")], [k, k], color=COLORS[0])
        axes.plot([number(row, "effect")], [k], marker="o", color=COLORS[0], markerfacecolor=COLORS[0] if is_proven(row, hypotheses) else "white")
    axes.axvline(0, color="black", linewidth=0.6)
    axes.set(yticks=range(len(rows)), yticklabels=map(label, rows), ylim=(len(rows) - 0.5, -0.5))
    axes.figure.supxlabel(f"{column['title']}: mean difference over domains, with 95 % interval;\n{'above' if column['better'] == 'higher' else 'below'}"
                          " 0: the first is better; full: proven at 5 %, without a failure", fontsize=7)


def effects(folder, columns):
    """Returns the functions that draw, by the name of the figure, for each measure of pairs."""
    found, hypotheses = {}, read(folder, "hypotheses.csv")
    rows = [row for row in read(folder, "pairs.csv") if row["low"]]
    for title in dict.fromkeys(row["measure"] for row in rows):
        column = next(column for column in columns if column["title"] == title and column["better"])
        of_measure = [row for row in rows if row["measure"] == title]
        found["effects_" + column["column"]] = functools.partial(draw_effects, of_measure, column, hypotheses)
    return found


def save(figure, path):
    """Writes whole files without a date."""
    for extension, date in ((".svg", "Date"), (".pdf", "CreationDate")):
        unfinished = path.with_name(f".{path.name}.{os.getpid()}")  # several shards may draw at once
        figure.savefig(unfinished, format=extension[1:], metadata={date: None})
        os.replace(unfinished, path.with_suffix(extension))


def draw(folder):
    columns = read(folder, "runs_columns.csv")
    runs = Runs(read(folder, "runs.csv"), columns)
    wanted = effects(folder, columns)
    heights = {name: 0.9 + 1.5 * LINE * len(drawing.args[0]) for name, drawing in wanted.items()}
    if len(runs.pipelines) > 1 and len({group[0] for group in runs.groups}) >= FEWEST_CASES:
        wanted.update({name: functools.partial(drawing, runs=runs) for name, drawing in COMPARISONS.items()})
    target = folder / "figures"
    for path in target.glob("*"):  # what an earlier run has drawn would be taken for these
        is_ours = path.stem in COMPARISONS or path.stem.startswith("effects_")
        if is_ours and path.suffix in (".svg", ".pdf", ".csv") and (path.stem not in wanted or path.suffix == ".csv"):
            path.unlink(missing_ok=True)
    if not wanted:
        return
    import matplotlib  # only now: it takes a second
    from matplotlib.figure import Figure
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
    matplotlib.rcParams.update(STYLE)
    target.mkdir(exist_ok=True)
    for name, drawing in wanted.items():
        figure = Figure(figsize=(WIDTH, heights.get(name, HEIGHT + LINE * ((len(runs.pipelines) + 1) // 2))))
        axes = figure.add_subplot()
        drawing(axes)
        if axes.get_xscale() == "log":
            low, high = axes.get_xlim()
            axes.xaxis.set(major_locator=LogLocator(subs=(1, 2, 5) if high < 200 * low else (1,)), minor_locator=NullLocator(),
                           major_formatter=FuncFormatter(lambda x, _: f"{x:g}"))
        if name in COMPARISONS:
            axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1), ncol=2, fontsize="small", borderaxespad=0.2)
        save(figure, target / name)


if __name__ == "__main__":
    try:
        for argument in sys.argv[1:]:
            draw(pathlib.Path(argument))
    except ModuleNotFoundError as error:
        system = "/usr/bin/python3"  # which has what Debian installs
        if os.path.exists(system) and not os.path.samefile(system, sys.executable):
            os.execv(system, [system, *sys.argv])
        print(error)
        sys.exit(3)
