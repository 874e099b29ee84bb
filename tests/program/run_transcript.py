#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the scenes of a transcript: run_transcript.py FILE --build FOLDER [--no-cad] [--only TITLE]

A scene begins with its title, at the margin, and has an empty folder, in another of its own. In it, indented by two spaces:

    $ COMMAND            is run by bash; lines that begin with "> " continue it. FUNCTIONS are there, and those that are defined by
                         a command before
    WORDS                stand on standard output, parts parted by " ... " one after the other; "\n" ends a line
    ! WORDS              stand on standard error; without words, that is empty
    !! WORDS             stand there on the only line
    - WORDS              stand on neither
    = WORDS              are all words of standard output
    [CODE]               is the exit code, 0 otherwise
    refused: WORDS       exit code 2, one line "error: ..." with these words, no output and no new file
    | VALUE | WORDS      the last command with VALUE in place of {} is refused with these words, or gives them after ": "

A title that begins with "CAD: " is left out without OpenCASCADE. Other lines at the margin, behind "#", are remarks.
"""
import argparse
import collections
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SECONDS = 120
DEFINITION, DEFINED = re.compile(r"\w+\(\)"), []  # of functions by the transcript
FUNCTIONS = r"""
# A unit square with named sides, and further lines: square FILE [LINE ...]
square() {
  printf '%s\n' 'loop = { rectangle = [[0, 0], [1, 1]], boundary = ["bottom", "right", "top", "left"], region = "square" }' "${@:2}" > "$1"
}
# The same with further loops.
loops() {
  printf '%s\n' '[[loop]]' 'rectangle = [[0, 0], [1, 1]]' 'boundary = ["bottom", "right", "top", "left"]' 'region = "square"' "${@:2}" > "$1"
}
# A file of these lines, in which \n, \x00 and so on are replaced.
lines() { printf '%b\n' "${@:2}" > "$1"; }
# A closed polygon of lines as MSH: polygon FILE NAME X,Y ...
polygon() {
  local n=$(($# - 2)) i file=$1
  {
    printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 7 "%s"\n$EndPhysicalNames\n$Nodes\n%d\n' "$2" $n
    for ((i = 1; i <= n; ++i)); do echo "$i ${@:i+2:1} 0" | tr , ' '; done
    printf '$EndNodes\n$Elements\n%d\n' $n
    for ((i = 1; i <= n; ++i)); do echo "$i 1 2 7 3 $i $((i % n + 1))"; done
    echo '$EndElements'
  } > "$file"
}
# Names in a MSH file, of curves (1) or regions (2): names DIMENSION FILE
names() { sed -n '/^\$[PM].*Names/,/^\$End/s/^'"$1"' [0-9]* "\(.*\)"/\1/p' "$2" | sort -u; }
# What a MSH file has.
counts() {
  awk '/^\$Entities/ { getline; c = $2; r = $3 } /^\$Nodes/ { getline; p = $2 }
    /^\$Elements/ { getline; for (b = $1; b > 0; --b) { getline; n[$3] += $4; for (i = $4; i > 0; --i) getline } }
    END { printf "%d points, %d curves, %d regions, %d lines, %d triangles, %d quads\n", p, c, r, n[1], n[2], n[3] }' "$1"
}
"""


Scene = collections.namedtuple("Scene", "title steps")


def scenes(path):
    all_scenes = []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        if not line.startswith(" "):
            all_scenes.append(Scene(line, []))
        elif line.startswith("  $ "):
            all_scenes[-1].steps.append((number, line[4:], []))
        elif line.startswith("  > "):
            all_scenes[-1].steps[-1] = (number, all_scenes[-1].steps[-1][1] + "\n" + line[4:], [])
        else:
            all_scenes[-1].steps[-1][2].append((number, line[2:]))
    return all_scenes


def has(text, words):
    at = 0
    for part in words.replace("\\n", "\n").split(" ... "):
        at = text.find(part, at)
        if at < 0:
            return False
        at += len(part)
    return True


def names():
    return sorted(map(str, pathlib.Path().rglob("*")))


def run(command):
    if DEFINITION.match(command):
        DEFINED.append(command)
    result = subprocess.run(["bash", "-c", "\n".join([*DEFINED, command])], stdin=subprocess.DEVNULL, capture_output=True, timeout=SECONDS)
    return result.returncode, result.stdout.decode(errors="replace"), result.stderr.decode(errors="replace")


def refused(command, words):
    before = names()
    code, out, err = run(command)
    error = re.fullmatch("error: .*\n", err) and "internal" not in err
    return code == 2 and error and has(err, words) and not out and names() == before, (code, out, err)


def failures(step):
    """Lines that do not hold, with what the command gave."""
    number, command, expected = step
    table = [(n, *re.fullmatch(r"\| (.*?) ?\|(?: (.*))?", line).groups("")) for n, line in expected if line.startswith("|")]
    for n, value, words in table:
        good, given = refused(command.replace("{}", value), words)
        if not good:
            yield n, given
    if table:
        return
    only = [(n, line[8:].strip()) for n, line in expected if line.startswith("refused:")]
    if only:
        good, given = refused(command, only[0][1])
        if not good:
            yield only[0][0], given
        return
    code, out, err = given = run(command)
    wanted = [line for _, line in expected if re.fullmatch(r"\[\d+\]", line)] or ["[0]"]
    if f"[{code}]" != wanted[0]:
        yield number, given
    for n, line in expected:
        kind, _, words = line.partition(" ")
        good = {"!": lambda: has(err, words) if words else not err, "!!": lambda: has(err, words) and err.count("\n") == 1, "-": lambda: not has(out + err, words),
                "=": lambda: out.split() == words.split()}.get(kind, lambda: line in wanted or has(out, line))()
        if not good:
            yield n, given


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--cad", action=argparse.BooleanOptionalAction, default=True)
    parser.add_argument("--only", metavar="TITLE")
    given = parser.parse_args()
    os.environ["SOURCE"] = str(pathlib.Path(__file__).parents[2])
    os.environ["PATH"] = f"{given.build.resolve()}:{os.environ['PATH']}"
    os.environ["XDG_CACHE_HOME"] = "/dev/null"
    wrong = 0
    with tempfile.TemporaryDirectory() as home:
        functions = pathlib.Path(home) / "functions.sh"
        functions.write_text(FUNCTIONS)
        os.environ["BASH_ENV"] = str(functions)
        for scene in scenes(given.file.resolve()):
            if (not given.cad and scene.title.startswith("CAD: ")) or given.only not in (None, scene.title):
                DEFINED.extend(command for _, command, _ in scene.steps if DEFINITION.match(command))
                continue
            with tempfile.TemporaryDirectory() as folder:
                os.mkdir(f"{folder}/scene")
                os.chdir(f"{folder}/scene")
                for step in scene.steps:
                    for n, (code, out, err) in failures(step):
                        wrong += 1
                        print(f"{given.file}:{n}: {scene.title}\n  $ {step[1]}\n[{code}]\n{out[-3000:]}{err[-3000:]}")
                os.chdir(home)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
