#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of examples/freecad and examples/blender do their work in the programs they are for: check_integrations.py freecad|blender DELQUAD

Runs in_freecad.py or in_blender.py in the program, whose last line is "good". Exit code 77: the program is not installed, and why.
"""
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / "support"))
import needs  # noqa: E402

COMMANDS = {"freecad": ["freecadcmd"], "blender": ["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python"]}
NEEDED = {"freecad": {"freecadcmd": "freecad", "ccx": "calculix-ccx"}, "blender": {"blender": "blender"}}


def main():
    program, delquad = sys.argv[1:]
    for needed, package in NEEDED[program].items():
        needs.program(needed, package)
    with tempfile.TemporaryDirectory() as home:
        environment = {**os.environ, "HOME": home, "PATH": f"{os.path.dirname(delquad)}:{os.environ['PATH']}", "PYTHONDONTWRITEBYTECODE": "1",
                       "INTEGRATIONS": str(HERE.parents[1] / "examples" / sys.argv[1])}
        result = subprocess.run([*COMMANDS[program], HERE / f"in_{program}.py"], cwd=home, env=environment, stdin=subprocess.DEVNULL,
                                capture_output=True, text=True, timeout=280)
    print(result.stdout[-3000:], result.stderr[-3000:])
    return 0 if "\ngood\n" in result.stdout else 1


if __name__ == "__main__":
    sys.exit(main())
