#!/usr/bin/env python3
"""What the Python module costs: importing it and meshing a square, and a constant callback beside the constant.

    PYTHONPATH=build/release/python python3 benchmarks/python_module.py
"""

import statistics
import subprocess
import sys
import time

import numpy as np

import delquad

RUNS = 9
START = """
import numpy, time
begin = time.perf_counter()
import delquad
delquad.mesh(delquad.polygons([[(0, 0), (1, 0), (1, 1), (0, 1)]]), size=0.1)
print(time.perf_counter() - begin)
"""


def seconds(call):
    begin = time.perf_counter()
    call()
    return time.perf_counter() - begin


def main():
    starts = [float(subprocess.check_output([sys.executable, "-c", START])) for _ in range(RUNS)]
    print(f"import delquad (numpy being there) and mesh a square: {1000 * min(starts):.0f} ms at best, "
          f"{1000 * statistics.median(starts):.0f} ms in the middle")
    square = delquad.polygons([[(0, 0), (1, 0), (1, 1), (0, 1)]])
    part = delquad.example("bracket")
    for name, model, size in (("square", square, 0.02), ("square", square, 0.005), ("bracket", part, 4.0)):
        pairs = []
        for _ in range(RUNS):  # in turns, for the machine may be busy
            constant = seconds(lambda: delquad.mesh(model, size=size))
            function = seconds(lambda: delquad.mesh(model, size=lambda x: np.full(len(x), size)))
            pairs.append((constant, function))
        constant, function = (min(times) for times in zip(*pairs))
        print(f"{name} at {size}: constant {1000 * constant:.1f} ms, by a callback {1000 * function:.1f} ms, "
              f"factor {function / constant:.2f}")


if __name__ == "__main__":
    main()
