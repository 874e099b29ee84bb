# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a command and measures it."""

import os
import subprocess
import sys
import time


def run(command):
    """Returns wall and CPU seconds and peak memory in bytes of a command and its children; none if it fails."""
    start = time.perf_counter()
    with open(os.devnull, "w") as nowhere:
        child = subprocess.Popen(command, stdout=nowhere, stderr=nowhere)
        _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        print(f"failed with {child.returncode}: {' '.join(map(str, command))}", file=sys.stderr)
        return None
    return time.perf_counter() - start, usage.ru_utime + usage.ru_stime, 1024 * usage.ru_maxrss
