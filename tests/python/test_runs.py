# SPDX-License-Identifier: GPL-3.0-or-later
"""How meshes are made: progress, Ctrl-C, threads, memory."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy as np
import pytest

import delquad
from shapes import square


def test_progress():
    seen = []
    delquad.mesh(square(), 0.1, progress=lambda *report: seen.append((*report, threading.get_ident())))
    stages, parts, callers = zip(*seen)
    assert "matching" in " ".join(stages) or len(set(stages)) >= 4
    assert list(parts) == sorted(parts) and 0 <= parts[0] and parts[-1] <= 1
    assert set(callers) == {threading.get_ident()}


def test_progress_that_is_shown(capsys):
    delquad.mesh(square(), 0.1, progress=True)
    assert "100 %  done" in capsys.readouterr().out


def test_progress_that_fails_ends_the_work():
    class Enough(Exception):
        pass

    def stop(stage, part):
        raise Enough(stage)

    with pytest.raises(Enough):
        delquad.mesh(square(), 0.1, progress=stop)


def interrupted(code):
    """Runs a program, sends it Ctrl-C once it says that it is ready, and returns what it then says."""
    program = subprocess.Popen([sys.executable, "-c", textwrap.dedent(code)], stdout=subprocess.PIPE, text=True)
    assert program.stdout.readline() == "ready\n"
    time.sleep(0.2)
    program.send_signal(signal.SIGINT)
    said = program.communicate(timeout=120)[0]
    return said, program.returncode


def test_ctrl_c_while_meshing():
    said, code = interrupted(
        """
        import delquad
        square = delquad.polygons([[(0, 0), (1, 0), (1, 1), (0, 1)]])
        def ready(stage, part):
            if part == 0:
                print("ready", flush=True)
        try:
            delquad.mesh(square, 0.002, word="DB", progress=ready)
        except KeyboardInterrupt:
            print("interrupted", len(delquad.mesh(square, 0.5).quads))
        """
    )
    assert (said, code) == ("interrupted 4\n", 0)


def test_ctrl_c_in_a_callback_that_hangs():
    said, code = interrupted(
        """
        import delquad, time
        square = delquad.polygons([[(0, 0), (1, 0), (1, 1), (0, 1)]])
        def hang(x):
            print("ready", flush=True)
            time.sleep(100)
        try:
            delquad.mesh(square, hang)
        except KeyboardInterrupt:
            print("interrupted")
        """
    )
    assert (said, code) == ("interrupted\n", 0)


def test_the_interpreter_goes_on_meanwhile():
    ticks = []
    done = threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    ticking = threading.Thread(target=tick)
    ticking.start()
    delquad.mesh(square(), 0.01, word="DB")
    done.set()
    ticking.join()
    assert len(ticks) > 5


def test_two_threads_at_once():
    sizes = [0.05, 0.04]
    alone = [delquad.mesh(square(), size) for size in sizes]
    results, callers = {}, {}

    def work(i):
        def size(x):
            callers.setdefault(i, set()).add(threading.get_ident())
            return sizes[i] + 0 * x[:, 0]

        results[i] = [delquad.mesh(square(), size) for _ in range(5)]
        assert callers[i] == {threading.get_ident()}

    threads = [threading.Thread(target=work, args=(i,)) for i in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for i in range(2):
        assert all(np.array_equal(r.points, alone[i].points) for r in results[i])


def test_many_small_meshes_without_growth():
    def some(n):
        for k in range(n):
            r = delquad.mesh(square(), size=lambda x: 0.3 + 0.1 * x[:, 0], word="DB")
            r.points, r.quads, r.metrics
            if k % 10 == 0:
                with pytest.raises(delquad.InputError):
                    delquad.mesh(square(), size=lambda x: -1, word="DB")

    def resident():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    def growth(n):
        before = resident()
        some(n)
        return resident() - before

    some(200)
    # A leaked mesh is some kilobytes, a leaked array of samples over 100: that is in every round, unlike what threads
    # keep for themselves.
    assert any(growth(800) < 4 << 20 for _ in range(6))


def test_time_limit():
    begin = time.perf_counter()
    with pytest.raises(delquad.TimeIsUp):
        delquad.mesh(square(), 0.0005, time_limit=0.5)
    assert time.perf_counter() - begin < 60
    assert delquad.mesh(square(), 0.2, time_limit=1000).sound


def test_time_limit_is_a_number():
    with pytest.raises(TypeError):
        delquad.mesh(square(), 0.1, time_limit="long")
