# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the microbenchmarks and prints a table of speeds of our steps over their baselines, now and in earlier versions.

    python3 benchmarks/ratios.py build/release [--record] [-- --benchmark_filter=... and other flags of Google Benchmark]

`--record` adds the ratios to benchmarks/bench.json under the program's version, in place of its old ones. A ratio is the median over
repetitions, of CPU times or, with two threads, of wall-clock times. It is marked if it differs from the previous version's at 5 %. The
Mann-Whitney U test compares the repetitions' ratios, as Google Benchmark's compare.py tests times.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

from scipy.stats import mannwhitneyu

HISTORY = pathlib.Path(__file__).with_name("bench.json")
# The baseline of each step, by the first part of names: the same work by a library, or by one thread. Insertion and an evaluation have
# CGAL's Delaunay triangulation of the same points instead, which is a part of their work and gives a scale.
BASELINES = {
    "matching": {"ours": "lemon", "ours_two_threads": "lemon"},
    "insertion": {"insertion": "triangulation_alone"},
    "recombination": {"recombination": "recombination_by_lemon", "recombination_two_threads": "recombination"},
    "smoothing": {"evaluate": "triangulation_alone"},
}
REPETITIONS = 5


def run_times(program, flags):
    """Returns times of all repetitions in seconds, on the CPU and on the clock, by names."""
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        # It prints single times, and a warning on a library that the distribution built with assertions.
        subprocess.run([program, f"--benchmark_out={out.name}", f"--benchmark_repetitions={REPETITIONS}", *flags], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        text = pathlib.Path(out.name).read_text()
    unit = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1}
    times = {}
    for run in json.loads(text)["benchmarks"] if text else []:
        if run["run_type"] == "iteration" and not run.get("error_occurred"):
            times.setdefault(run["run_name"], []).append([run[clock] * unit[run["time_unit"]] for clock in ("cpu_time", "real_time")])
    return times


def ratios_of(step, times):
    for name, ours in times.items():
        first, _, rest = name.partition("/")
        theirs = times.get(f"{BASELINES[step].get(first)}/{rest}")
        if theirs:
            label = f"{step}: {first}/{rest} against {BASELINES[step][first]}".replace("/process_time/real_time", "")
            clock = int("two_threads" in first)
            yield label, statistics.median(run[clock] for run in ours), [b[clock] / a[clock] for a, b in zip(ours, theirs)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--record", action="store_true")
    given, flags = parser.parse_known_args()
    version = subprocess.run([given.build / "delquad", "--version"], check=True, capture_output=True, text=True).stdout.split()[1]
    history = json.loads(HISTORY.read_text()) if HISTORY.exists() else {}
    before = [v for v in history if v != version]
    found = {}
    print(f"| what | ms | times faster | {' | '.join(before)}{' | ' if before else ''}changed |\n|---|--:|--:|{'--:|' * len(before)}---|")
    for step in BASELINES:
        for label, time, ratios in ratios_of(step, run_times(given.build / f"benchmarks/bench_{step}", [f for f in flags if f != "--"])):
            found[label] = [round(r, 4) for r in ratios]
            now = statistics.median(ratios)
            old = [history[v].get(label) for v in before]
            changed = ""
            if old and old[-1] and mannwhitneyu(ratios, old[-1]).pvalue < 0.05:
                changed = "faster" if now > statistics.median(old[-1]) else "slower"
            cells = [f"{statistics.median(o):.2f}" if o else "" for o in old]
            print(f"| {label} | {1e3 * time:.3g} | {now:.2f} | {''.join(c + ' | ' for c in cells)}{changed} |", flush=True)
    if not found:
        sys.exit("no benchmark has a baseline: expected names that --benchmark_filter takes on both sides, such as D_uniform/1000/")
    if given.record:
        history[version] = {**history.get(version, {}), **found}
        HISTORY.write_text(json.dumps(history, indent=1, sort_keys=True) + "\n")


if __name__ == "__main__":
    main()
