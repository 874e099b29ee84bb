# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts in Python: measures, costs, stages and fields, and experiments with them."""

import json
import subprocess
import sys
import threading

import numpy as np
import pytest

import delquad
from shapes import square

SEEN = []


def own_measure(mesh, *, size, problem, word, surface):
    SEEN.append((problem, word, surface is not None, None if size is None else size.shape))
    if word == "FB":
        raise ValueError("not of FB")
    return len(mesh.quads) / 2


def eta_cost(corners, theta, size):
    """1 - eta of convex quads, rounded down as the program's own; others as dear as can be."""
    assert corners.shape[1:] == (4, 2) and theta.shape == size.shape == corners.shape[:1]
    after, before = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    cross = after[..., 0] * before[..., 1] - after[..., 1] * before[..., 0]
    angle = np.arctan2(cross, (after * before).sum(axis=2)) % (2 * np.pi)
    return np.floor(1e6 * np.minimum(3, np.abs(angle - np.pi / 2).max(axis=1) / (np.pi / 2))) / 1e6


def smooth(points, quads, n_boundary, theta, size):
    total, count = np.zeros_like(points), np.zeros(len(points))
    for k in range(4):
        np.add.at(total, quads[:, k], points[quads[:, (k + 1) % 4]] + points[quads[:, k - 1]])
        np.add.at(count, quads[:, k], 2)
    points[n_boundary:] = (total / count[:, None])[n_boundary:]
    return points, quads


BAD = []

delquad.add_metric("halves", own_measure, title="half of the quads", better="lower", digits=1)
delquad.add_merge_cost("own-eta", eta_cost)
delquad.add_merge_cost("bad", lambda corners, theta, size: BAD[0])
delquad.add_stage("X", "smoothing in Python", smooth)
delquad.add_stage("Y", "a mistake", lambda points, quads, *_: (points[:-1], quads))
delquad.add_size("graded", lambda x: 0.05 + 0.1 * x[:, 0])
delquad.add_cross("diagonal", lambda x: np.full(len(x), np.pi / 4))


def test_a_measure_is_one_of_the_metrics():
    SEEN.clear()
    result = delquad.mesh(square(), 0.1, word="DB", name="plate")
    assert result.metrics["halves"] == len(result.quads) / 2
    assert SEEN == [("plate", "DB", False, (len(result.points),))]
    delquad.mesh(delquad.example("bracket"), 10, word="DB")
    assert SEEN[-1][2]
    assert np.isnan(delquad.mesh(square(), 0.1, word="FB").metrics["halves"])


def test_a_cost_decides_what_is_merged():
    option = {"recombination.cost": "own-eta"}
    disc = delquad.planar([[delquad.circle((0, 0), 1)]])
    usual = delquad.mesh(disc, 0.2, word="DB")
    assert np.array_equal(delquad.mesh(disc, 0.2, word="DB", options=option).quads, usual.quads)
    for value in (4.0, float("nan")):
        BAD[:] = [value]
        with pytest.raises(RuntimeError, match="matching cost 'bad'.*from 0 to 3"):
            delquad.mesh(disc, 0.2, word="DB", options={"recombination.cost": "bad"})


def test_a_stage_edits_each_patch():
    usual, smoothed = (delquad.mesh(delquad.example("bracket"), 8, word=word) for word in ("DB", "DBX"))
    assert len(usual.quads) == len(smoothed.quads)
    assert not np.array_equal(usual.points, smoothed.points)
    with pytest.raises(RuntimeError, match="Y"):
        delquad.mesh(square(), 0.1, word="DBY")


def test_mistakes_of_programmers():
    with pytest.raises(ValueError, match="'tau' already"):
        delquad.add_metric("tau", own_measure)
    with pytest.raises(ValueError, match="'better'|better"):
        delquad.add_metric("new", own_measure, better="best")
    for letter in ("x", "XY", "", "1"):
        with pytest.raises(ValueError, match="capital"):
            delquad.add_stage(letter, "bad", smooth)
    with pytest.raises(TypeError, match="expected a function"):
        delquad.add_size("nothing", 3)
    delquad.add_size("nothing", lambda x: 1.0)
    for name in ("boundary", "x", 'q"x', "a b", "", "7"):
        with pytest.raises(ValueError):
            delquad.add_size(name, lambda x: 1.0)


@pytest.mark.skipif(not hasattr(delquad._core, "run"), reason="built without programs")
def test_experiments_have_them(tmp_path, capfd):
    file = tmp_path / "own.toml"
    file.write_text(
        'pipelines = ["FB", "DB", "DBX"]\nrecombination = { cost = "own-eta" }\n'
        '[[case]]\nname = "a"\nloop = { rectangle = [[0, 0], [1, 1]] }\nsize = "graded"\ncross = "diagonal"\n'
    )
    run = ["run", file, "-o", tmp_path / "results", "-j", "1"]
    assert delquad.run(run) == 1, "a measure failed"
    assert "half of the quads" in capfd.readouterr().out
    record = json.loads((tmp_path / "results" / "a" / "DBX" / "record.json").read_text())
    assert record["metrics"]["halves"] == record["metrics"]["n_quads"] / 2
    other = json.loads((tmp_path / "results" / "a" / "FB" / "record.json").read_text())
    assert other["failed_metrics"] == {"halves": "ValueError: not of FB"}
    made = (tmp_path / "results" / "a" / "DBX" / "mesh.msh").stat().st_mtime_ns
    assert delquad.run(run) == 1
    assert (tmp_path / "results" / "a" / "DBX" / "mesh.msh").stat().st_mtime_ns == made, "it was there already"
    assert delquad.run(["run", tmp_path / "missing.toml"]) == 2


@pytest.mark.skipif(not hasattr(delquad._core, "run"), reason="built without programs")
def test_cells_are_made_anew_when_a_part_holds_something_else(tmp_path):
    (tmp_path / "e.toml").write_text(
        'pipelines = ["DB"]\n[[case]]\nname = "a"\nloop = { rectangle = [[0, 0], [1, 1]] }\nsize = 0.3\n'
    )
    (tmp_path / "own.py").write_text(
        "import sys, delquad\n"
        "def made(value):\n    return lambda mesh, **_: value\n"
        "delquad.add_metric('own', made(float(sys.argv[1])))\n"
        "sys.exit(delquad.run(['run', 'e.toml', '-o', 'results']))\n"
    )
    made = []
    for value in (0.25, 0.75, 0.75):
        subprocess.run([sys.executable, "own.py", str(value)], cwd=tmp_path, check=True, capture_output=True)
        file = tmp_path / "results" / "a" / "DB" / "record.json"
        assert json.loads(file.read_text())["metrics"]["own"] == value
        made.append((file.parent / "mesh.msh").stat().st_mtime_ns)
    assert made[0] < made[1] == made[2]


@pytest.mark.skipif(not hasattr(delquad._core, "run"), reason="built without programs")
def test_other_threads_may_be_busy(tmp_path):
    (tmp_path / "e.toml").write_text(
        'pipelines = ["DBX"]\n[[case]]\nname = "a"\nloop = { rectangle = [[0, 0], [1, 1]] }\nsize = 0.3\n'
    )
    end = threading.Event()
    busy = threading.Thread(target=lambda: all(not end.is_set() for _ in iter(int, 1)))
    busy.start()
    try:
        assert delquad.run(["run", tmp_path / "e.toml", "-o", tmp_path / "results", "--timeout", "20"]) == 0
    finally:
        end.set()
        busy.join()
