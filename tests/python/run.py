#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a file of tests by pytest: run.py FILE. Exit code 77: all of them were skipped; reasons are printed as needs.py prints them."""
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import needs  # noqa: E402

pytest = needs.module("pytest", "python3-pytest")
needs.module("numpy", "python3-numpy")


class Skips:
    def __init__(self):
        self.reasons, self.others = [], 0

    def pytest_collectreport(self, report):
        if report.skipped:
            self.reasons.append(report.longrepr[2])

    def pytest_runtest_logreport(self, report):
        if report.skipped:
            self.reasons.append(report.longrepr[2])
        self.others += report.when == "call" and not report.skipped


def main():
    skips = Skips()
    status = pytest.main(["-q", "-p", "no:cacheprovider", *sys.argv[1:]], plugins=[skips])
    for reason in skips.reasons:
        needs.leave_out(reason.removeprefix("Skipped: "))
    skipped = skips.reasons and not skips.others and status in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED)
    return needs.SKIPPED if skipped else status


if __name__ == "__main__":
    sys.exit(main())
