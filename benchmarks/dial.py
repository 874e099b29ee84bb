#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the cost of fewer irregular vertices: Delquad's qualities, `best` at several weights, beside QuadWild with Bi-MDF at several alphas.

The size of each CAD model is --size-part of its diagonal in length. If the variable QUADWILD names the folder of QuadWild's built sources, it gets Delquad's triangles
(F at that size), with the settings of experiments/peers/adapters/quadwild.sh. Its patches are made once for each model, its quads for each alpha,
at the number of `good` within --within or the nearest of --tries. `delquad metrics` measures all meshes against the same size. The table has means over the models that all programs meshed; --json keeps the results; --figure draws irregular vertices
against tau and eta. Without QUADWILD it has Delquad's half.
"""

import argparse
import json
import math
import os
import re
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WORDS = {"fast": ["--quality", "fast"], "good": ["--quality", "good"]} | {
    f"best {weight:g}": ["--quality", "best", "--set", f"regularity.weight={weight}"] for weight in (0, .3, 1, 3)}
COLOURS = {"fast": "#888", "good": "#555", "best": "#0b6e99", "QuadWild": "#c2571a"}
MEASURES = {"n_quads": 0, "n_irregular": 1, "eta_mean": 3, "eta_worst": 3, "tau": 1, "n_inverted": 2, "seconds": 1}


def run(command, folder, seconds=None):
    """Returns whether it succeeded, and its process seconds."""
    before = os.times()
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return False, 0
    after = os.times()
    return done.returncode in (0, 3, 5), after.children_user + after.children_system - before.children_user - before.children_system


def measure(delquad, mesh, size, folder):
    if not mesh.exists() or not run([delquad, "metrics", mesh, "--size", repr(size), "--json", folder / "m.json"], folder)[0]:
        return None
    return json.loads((folder / "m.json").read_text())["metrics"]


def delquads(delquad, model, size, folder):
    out = {}
    for name, options in WORDS.items():
        mesh = folder / f"{name}.msh"
        done, seconds = run([delquad, "mesh", model, "-o", mesh, "--size", repr(size), "--threads", "1", "-q", "--allow-unsound", *options],
                            folder)
        if done and (measures := measure(delquad, mesh, size, folder)):
            out[name] = measures | {"seconds": seconds}
    return out


def mean_edge(path):
    points, lengths = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(w) for w in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [points[int(w.split("/")[0]) - 1] for w in words[1:4]]
            lengths += [math.dist(corners[k], corners[k - 1]) for k in range(3)]
    return sum(lengths) / len(lengths)


def quadwilds(delquad, quadwild, model, size, wanted, arguments, folder):
    """Returns, by alpha, the measures of the mesh whose number of quads is nearest to the wanted one."""
    programs, config = quadwild / "build/Build/bin", quadwild / "config"
    (folder / "config").symlink_to(config)  # its settings name files there
    run([delquad, "mesh", model, "-o", folder / "f.obj", "--size", repr(size), "--pipeline", "F", "--allow-triangles", "-q"], folder)
    if not (folder / "f.obj").exists():
        return {}
    lines = (folder / "f.obj").read_text().splitlines(True)
    (folder / "mesh.obj").write_text("".join(line for line in lines if not line.startswith("l ")))
    done, first = run([programs / "quadwild", "mesh.obj", "2", config / "prep_config/basic_setup_Mechanical.txt"], folder, 600)
    if not done or not (folder / "mesh_rem_p0.obj").exists():
        return {}
    scale, out = size / mean_edge(folder / "mesh_rem_p0.obj"), {}
    settings, mesh = (config / "main_config/flow_noalign_lemon.txt").read_text(), folder / "mesh_rem_p0_123_quadrangulation_smooth.obj"
    for alpha in arguments.alpha:
        best = None
        for _ in range(arguments.tries):
            text = re.sub(r"(?m)^scaleFact .*", f"scaleFact {scale!r}", re.sub(r"(?m)^alpha .*", f"alpha {alpha}", settings))
            (folder / "main.txt").write_text(text)
            mesh.unlink(missing_ok=True)
            done, seconds = run([programs / "quad_from_patches", "mesh_rem_p0.obj", "123", "main.txt"], folder, 300)
            measures = measure(delquad, mesh, size, folder) if done else None
            if measures is None:
                break
            measures["seconds"] = first + seconds
            off = abs(math.log(measures["n_quads"] / wanted))
            if best is None or off < best[0]:
                best = off, measures
            if off < arguments.within:
                break
            scale *= math.sqrt(measures["n_quads"] / wanted)
        if best:
            out[f"QuadWild {alpha:g}"] = best[1]
    return out


def figure(path, means):
    """Draws two boxes: irregular vertices against tau and against the mean eta."""
    svg = ['<svg xmlns="http://www.w3.org/2000/svg" width="860" height="400" font-family="sans-serif" font-size="12">'
           '<rect width="100%" height="100%" fill="white"/>']
    y_most = 1.08 * max(m["n_irregular"] for m in means.values())
    for left, key, title in ((60, "tau", "tau, %"), (490, "eta_mean", "mean eta")):
        values = [m[key] for m in means.values()]
        step = 10 ** math.floor(math.log10(max(values) - min(values) or 1))
        low, high = math.floor(min(values) / step) * step, math.ceil(max(values) / step + 1) * step
        svg.append(f'<rect x="{left}" y="20" width="350" height="320" fill="none" stroke="#999"/>'
                   f'<text x="{left + 175}" y="384" text-anchor="middle">{title}</text>')

        def x(value):
            return left + 350 * (value - low) / (high - low)

        def y(value):
            return 340 - 320 * value / y_most

        for k in range(round((high - low) / step) + 1):
            svg.append(f'<path d="M{x(low + k * step):.1f} 340v4" stroke="#999"/><text x="{x(low + k * step):.1f}" y="358" '
                       f'text-anchor="middle">{low + k * step:.6g}</text>')
        tick = 10 ** math.floor(math.log10(y_most))
        tick = tick if y_most / tick > 4 else tick / 2
        for k in range(int(y_most / tick) + 1):
            svg.append(f'<path d="M{left} {y(k * tick):.1f}h-4" stroke="#999"/><text x="{left - 8}" y="{y(k * tick) + 4:.1f}" '
                       f'text-anchor="end">{k * tick:g}</text>')
        for series, colour in COLOURS.items():
            row = [(name, m) for name, m in means.items() if name.split()[0] == series]
            places = [(x(m[key]), y(m["n_irregular"])) for _, m in row]
            if not row:
                continue
            svg.append(f'<path d="M{" L".join(f"{a:.1f} {b:.1f}" for a, b in places)}" fill="none" stroke="{colour}" stroke-opacity=".5"/>')
            for k, ((name, _), (a, b)) in enumerate(zip(row, places)):
                svg.append(f'<circle cx="{a:.1f}" cy="{b:.1f}" r="5" fill="{colour}"/>'
                           f'<text x="{a + 8:.1f}" y="{b - 6:.1f}" font-size="10">{name.split()[-1]}</text>')
    svg.append('<text x="20" y="180" transform="rotate(-90 20 180)" text-anchor="middle">irregular vertices</text>' + "".join(
        f'<text x="{left}" y="14" fill="{COLOURS[series]}">{text}</text>' for left, series, text in
        ((70, "best", "best, by weight"), (320, "QuadWild", "QuadWild, by alpha"))) + '</svg>')
    path.write_text("\n".join(svg) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", type=Path, nargs="*", help="CAD files; default: those of ../shared/data/cad")
    parser.add_argument("--delquad", type=Path, default=ROOT / "build/release/delquad")
    parser.add_argument("--size-part", type=float, default=60, help="the size: the diagonal over this")
    parser.add_argument("--alpha", type=float, nargs="+", default=[.005, .03, .1, .3, .7])
    parser.add_argument("--within", type=float, default=.02, help="how far the number of quads may be off")
    parser.add_argument("--tries", type=int, default=4)
    parser.add_argument("--json", type=Path, help="measures of each model: what is there is not made again")
    parser.add_argument("--figure", type=Path, help="SVG to draw")
    arguments = parser.parse_args()
    if not arguments.delquad.exists():
        return print(f"skipped: {arguments.delquad} is not built")
    print(subprocess.run([arguments.delquad, "--version"], check=True, capture_output=True, text=True).stdout)
    models = arguments.models or sorted((ROOT.parent / "shared/data/cad").glob("*.*"))
    delquad, quadwild = arguments.delquad.resolve(), Path(os.environ.get("QUADWILD", "")).resolve()
    there = "QUADWILD" in os.environ and (quadwild / "build/Build/bin/quadwild").exists()
    if not there:
        print("QuadWild: skipped, QUADWILD names no folder with it")
    results = json.loads(arguments.json.read_text()) if arguments.json and arguments.json.exists() else {}
    for model in models:
        known = results.get(model.stem, {})
        if known.keys() >= {*WORDS}:
            continue
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            run([delquad, "info", model.resolve(), "--json", folder / "info.json"], folder)
            size = json.loads((folder / "info.json").read_text())["diagonal"] / arguments.size_part
            result = known | delquads(delquad, model.resolve(), size, folder)
            if there and "good" in result and not known:
                result |= quadwilds(delquad, quadwild, model.resolve(), size, result["good"]["n_quads"], arguments, folder)
        results[model.stem] = result
        if arguments.json:
            arguments.json.write_text(json.dumps(results, indent=1) + "\n")
    names = [*WORDS, *(name for alpha in arguments.alpha if (name := f"QuadWild {alpha:g}") in {n for r in results.values() for n in r})]
    whole = [m for m in results if all(name in results[m] for name in names)]
    for model in results:
        if missing := [name for name in names if name not in results[model]]:
            print(f"not in the means: {model}, without a mesh of {', '.join(missing)}")
    if not whole:
        return
    means = {name: {key: sum(results[m][name][key] for m in whole) / len(whole) for key in MEASURES} for name in names}
    print(f"\n{len(whole)} models: {', '.join(whole)}\n\n| setting | quads | irregular | eta mean | eta worst | tau | inverted | CPU s |"
          "\n|---" + "|---:" * len(MEASURES) + "|")
    for name in names:
        print(f"| {name} | " + " | ".join(f"{means[name][key]:.{digits}f}" for key, digits in MEASURES.items()) + " |")
    if arguments.figure:
        figure(arguments.figure, means)


if __name__ == "__main__":
    main()
