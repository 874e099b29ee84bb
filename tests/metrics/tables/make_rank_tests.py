#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints rank_tests.inc: tests by ranks, intervals and corrections as SciPy has them, for test_statistics.cpp.

Usage: make_rank_tests.py > rank_tests.inc. Made with SciPy 1.10.1. Where there are ties or zeros SciPy's exact tests do not
hold; there all choices of signs are tried. clang-format lays the file out.
"""
import itertools
import random

from scipy import optimize, special, stats


def wilcoxon_by_force(d):
    d = [x for x in d if x != 0]
    ranks = stats.rankdata([abs(x) for x in d])
    centre = sum(ranks) / 2
    lean = abs(sum(r for r, x in zip(ranks, d) if x > 0) - centre)
    far = sum(abs(sum(r for r, s in zip(ranks, signs) if s) - centre) >= lean - 1e-9
              for signs in itertools.product((0, 1), repeat=len(d)))
    return far / 2 ** len(d)


def text(values):
    return "{" + ", ".join(repr(float(v)) for v in values) + "}"


def sample(n, shift, digits=6):
    return [round(random.gauss(shift, 1), digits) for _ in range(n)]


def main():
    random.seed(4)
    print("// Made by make_rank_tests.py.\n")
    print("const std::vector<OneSample> kWilcoxon = {")
    for n, shift in ((3, 0), (5, 2), (8, 0.3), (12, 1), (25, 0.4), (50, 0.2)):
        d = sample(n, shift)
        print(f"    {{{text(d)}, {stats.wilcoxon(d, method='exact').pvalue!r}}},")
    for n, shift in ((6, 1), (9, 1), (12, 0)):  # ties and zeros
        d = [round(x * 2) / 2 for x in sample(n, shift)]
        print(f"    {{{text(d)}, {wilcoxon_by_force(d)!r}}},")
    for n, shift in ((61, 0.2), (90, 0.1), (200, 0.2)):
        d = [round(x, 1) for x in sample(n, shift)] if n == 90 else sample(n, shift)
        d = [x for x in d if x != 0]
        p = stats.wilcoxon(d, method="approx", correction=True).pvalue
        print(f"    {{{text(d)}, {p!r}}},")
    print("};\n\nconst std::vector<OneSample> kHalfWidths = {")
    for n in (2, 3, 8, 40):
        x = sample(n, 5)
        # stats.t.ppf is right to eight figures only; the incomplete beta function to all.
        b = special.betaincinv((n - 1) / 2, 0.5, 0.05)
        print(f"    {{{text(x)}, {float(((n - 1) * (1 - b) / b) ** 0.5 * stats.sem(x))!r}}},")
    print("};\n\nconst std::vector<Adjusted> kHolm = {")
    for p in ([0.01, 0.04, 0.03, 0.005], [0.2], [0.5, 0.02, 0.02, 0.9, 0.0001]):
        order = sorted(range(len(p)), key=lambda i: p[i])
        adjusted, most = [0] * len(p), 0
        for k, i in enumerate(order):
            most = max(most, min(1, (len(p) - k) * p[i]))
            adjusted[i] = most
        print(f"    {{{text(p)}, {text(adjusted)}}},")
    print("};\n\n/// Student's statistic without its skewness, turned round by bisection.\nconst std::vector<Ends> kIntervals = {")
    for n, power in ((6, 1), (12, 3), (30, 2)):
        x = [round(v ** power, 6) for v in sample(n, 1)]
        centre, error, skewness = sum(x) / n, stats.sem(x), stats.skew(x)

        def transformed(t):  # [hall1992]: of t over the root of n
            u = t / n ** 0.5
            return n ** 0.5 * (u + skewness * u ** 2 / 3 + skewness ** 2 * u ** 3 / 27 + skewness / (6 * n))

        ends = [optimize.brentq(lambda t: transformed(t) - side * stats.t.ppf(0.975, n - 1), -1e3, 1e3, xtol=1e-13)
                for side in (1, -1)]
        print(f"    {{{text(x)}, {float(centre - ends[0] * error)!r}, {float(centre - ends[1] * error)!r}}},")
    print("};")


if __name__ == "__main__":
    main()
