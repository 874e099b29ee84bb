#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Fuzzes every target, one after the other, and prints a table.

Usage: run.py BUILD [--seconds N] [--targets NAME ...] [--work FOLDER]. BUILD is where `cmake --preset fuzz` built. The
seconds are divided among the targets. Inputs that reached something new are kept in FOLDER/corpus/TARGET and tried first
next time; findings in FOLDER/findings/TARGET, which makes the exit code 1.
"""
import argparse
import dataclasses
import os
import pathlib
import re
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
# Sanitizers make the program some 50 times slower: an input of 0.6 seconds took 27.
LIMITS = ["-timeout=120", "-report_slow_units=120", "-rss_limit_mb=2048", "-malloc_limit_mb=1024"]
GROUPS = ["reader", "case", "result", "cad", "mesher"]


@dataclasses.dataclass
class Target:
    group: str
    name: str
    longest: int


@dataclasses.dataclass
class Result:
    name: str
    executions: int
    seconds: float
    edges: int
    features: int
    findings: int
    megabytes: int


def targets_of(build, seeds):
    """The targets of all programs; their seeds are written."""
    found = []
    for group in GROUPS:
        program = build / "tests/fuzz" / f"seeds_{group}"
        if group == "cad" and not program.exists():
            print("without OpenCASCADE: files of CAD are not tried", file=sys.stderr)
            continue
        lines = subprocess.run([program, seeds], check=True, capture_output=True, text=True).stdout.splitlines()
        found += [Target(group, name, int(longest)) for name, longest in map(str.split, lines)]
    return found


def last_number(pattern, text):
    found = re.findall(pattern, text)
    return int(found[-1]) if found else 0


def temporary_folder(work):
    """In memory, where there is such a place: each input is a file."""
    memory = pathlib.Path("/dev/shm")
    folder = memory / f"delquad-fuzz-{os.getpid()}" if os.access(memory, os.W_OK) else work / "tmp"
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def fuzz(target, build, work, seconds):
    folders = [work / kind / target.name for kind in ("corpus", "seeds")] + [HERE / "corpus" / target.name]
    findings = work / "findings" / target.name
    for folder in (folders[0], findings):
        folder.mkdir(parents=True, exist_ok=True)
    before = set(findings.iterdir())
    dictionary = HERE / "dictionaries" / f"{target.name}.dict"
    command = [build / "tests/fuzz" / f"fuzz_{target.group}", *LIMITS, f"-max_total_time={seconds}",
               f"-max_len={target.longest}", "-print_final_stats=1", f"-artifact_prefix={findings}/",
               *([f"-dict={dictionary}"] if dictionary.exists() else []), *[f for f in folders if f.exists()]]
    scratch = temporary_folder(work)
    begin = time.monotonic()
    log = work / f"{target.name}.log"
    with log.open("wb") as out:
        status = subprocess.run(command, stdout=out, stderr=out, check=False,
                                env={**os.environ, "DELQUAD_FUZZ_TARGET": target.name, "TMPDIR": str(scratch)}).returncode
    seconds = time.monotonic() - begin
    subprocess.run(["rm", "-r", scratch], check=True)
    text = log.read_text(errors="replace")
    found = sorted(set(findings.iterdir()) - before)
    for file in found:
        print(f"{target.name}: found {file}, see {log}", file=sys.stderr)
    if status != 0 and not found:
        print(f"{target.name}: ended with exit code {status}, see {log}", file=sys.stderr)
    return Result(target.name, last_number(r"stat::number_of_executed_units: *(\d+)", text) or last_number(r"#(\d+)", text),
                  seconds, last_number(r"cov: (\d+)", text), last_number(r"ft: (\d+)", text),
                  max(len(found), int(status != 0)), last_number(r"(?:rss|peak_rss_mb): *(\d+)", text))


def print_table(results):
    print(f"{'target':14} {'executions':>11} {'per second':>10} {'edges':>7} {'features':>8} {'findings':>8} {'MB':>5}")
    for r in results:
        print(f"{r.name:14} {r.executions:11} {r.executions / r.seconds:10.0f} {r.edges:7} {r.features:8} {r.findings:8} "
              f"{r.megabytes:5}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--seconds", type=int, default=120)
    parser.add_argument("--targets", nargs="*")
    parser.add_argument("--work", type=pathlib.Path)
    arguments = parser.parse_args()
    work = (arguments.work or arguments.build / "fuzzing").resolve()
    work.mkdir(parents=True, exist_ok=True)
    targets = targets_of(arguments.build.resolve(), work / "seeds")
    unknown = set(arguments.targets or []) - {t.name for t in targets}
    if unknown:
        sys.exit(f"unknown targets {sorted(unknown)}; known: {[t.name for t in targets]}")
    targets = [t for t in targets if not arguments.targets or t.name in arguments.targets]
    each = max(1, arguments.seconds // len(targets))
    results = [fuzz(target, arguments.build.resolve(), work, each) for target in targets]
    print_table(results)
    n_findings = sum(r.findings for r in results)
    if n_findings:
        print(f"{n_findings} findings, see {work / 'findings'}")
    return 1 if n_findings else 0


if __name__ == "__main__":
    sys.exit(main())
