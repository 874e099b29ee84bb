# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks for programs and modules that a test needs.

If one is missing, the test prints "skipped: REASON" and ends with exit code 77, which CTest takes for skipped.
"""
import importlib
import shutil
import sys

SKIPPED = 77


def leave_out(reason):
    """Says why a part of a test is left out; the test goes on."""
    print(f"skipped: {reason}", flush=True)


def skip(reason):
    leave_out(reason)
    sys.exit(SKIPPED)


def module(name, package):
    """The module, of Debian's package; it may be there and lack a library or another module."""
    try:
        return importlib.import_module(name)
    except (ImportError, OSError) as error:
        skip(f"{package}: {error}")


def program(name, package):
    if shutil.which(name) is None:
        skip(f"{package}: there is no program {name}")
