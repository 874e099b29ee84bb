# SPDX-License-Identifier: GPL-3.0-or-later
"""The program of docs/python.md, as it stands there."""

import pathlib
import re
import subprocess
import sys

import pytest

import delquad
from shapes import needed

PAGE = pathlib.Path(__file__).parents[2] / "docs" / "python.md"


def test_from_a_step_file_to_a_solved_problem(tmp_path):
    needed("dolfinx")
    section = PAGE.read_text(encoding="utf-8").split("## From a STEP file")[1]
    code = re.search(r"```python\n(.*?)```", section, re.DOTALL)[1]
    assert len([line for line in code.splitlines() if line]) <= 17
    (tmp_path / "bracket.step").write_bytes(delquad.example_step("bracket"))
    # Zero at the foot, positive elsewhere.
    code += "values = temperature.x.array\nprint(len(part.points), len(values), values.min(), values.max())\n"
    said = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, check=True, capture_output=True, text=True
    ).stdout.splitlines()[-1]
    points, values, coldest, hottest = (float(word) for word in said.split())
    assert points == values > 1000
    assert coldest == pytest.approx(0, abs=1e-6) and 100 < hottest < 1e5
