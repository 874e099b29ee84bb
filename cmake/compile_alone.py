#!/usr/bin/env python3
"""Compiles each source of a build folder alone, without making anything: unity builds hide includes that are missing.

Usage: compile_alone.py BUILD. Exit code 1 when a source does not compile, or there is none. Sources that the build makes are left out.
"""
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys


def compiles(entry):
    command = re.sub(r" -o \S+ ", " -fsyntax-only ", re.sub(r"^ccache ", "", entry["command"]))
    return subprocess.run(command, shell=True, cwd=entry["directory"]).returncode == 0


def main():
    entries = json.loads((pathlib.Path(sys.argv[1]) / "compile_commands.json").read_text())
    entries = [e for e in entries if pathlib.Path(e["file"]).exists()]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        wrong = [e["file"] for e, good in zip(entries, pool.map(compiles, entries)) if not good]
    print(f"{len(entries)} sources compiled alone, {len(wrong)} do not: {' '.join(wrong)}")
    return 1 if wrong or not entries else 0


if __name__ == "__main__":
    sys.exit(main())
