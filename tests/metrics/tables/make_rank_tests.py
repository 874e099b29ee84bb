#!/usr/bin/env python3
"""Prints rank_tests.inc: tests by ranks, intervals and corrections as SciPy has them, for test_statistics.cpp.

Usage: make_rank_tests.py > rank_tests.inc. Made with SciPy 1.10.1. Where there are ties or zeros SciPy's exact tests do not
hold; there all choices of signs, or of a sample, are tried. clang-format lays the file out.
"""
import itertools
import random

from scipy import special, stats


def wilcoxon_by_force(d):
    d = [x for x in d if x != 0]
    ranks = stats.rankdata([abs(x) for x in d])
    centre = sum(ranks) / 2
    lean = abs(sum(r for r, x in zip(ranks, d) if x > 0) - centre)
    far = sum(abs(sum(r for r, s in zip(ranks, signs) if s) - centre) >= lean - 1e-9
              for signs in itertools.product((0, 1), repeat=len(d)))
    return far / 2 ** len(d)


def mann_whitney_by_force(a, b):
    ranks = stats.rankdata(a + b)
    centre = len(a) * (len(a) + len(b) + 1) / 2
    lean = abs(sum(ranks[:len(a)]) - centre)
    choices = list(itertools.combinations(range(len(ranks)), len(a)))
    return sum(abs(sum(ranks[i] for i in c) - centre) >= lean - 1e-9 for c in choices) / len(choices)


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
    print("};\n\nconst std::vector<TwoSamples> kMannWhitney = {")
    for n, m, shift in ((2, 3, 1), (5, 5, 2), (10, 7, 0.5), (20, 30, 0.6)):
        a, b = sample(n, shift), sample(m, 0)
        print(f"    {{{text(a)}, {text(b)}, {stats.mannwhitneyu(a, b, method='exact').pvalue!r}}},")
    for n, m, shift in ((4, 6, 1), (7, 7, 0.5)):  # ties
        a, b = ([round(x) for x in sample(k, s)] for k, s in ((n, shift), (m, 0)))
        print(f"    {{{text(a)}, {text(b)}, {mann_whitney_by_force(a, b)!r}}},")
    for n, m, digits in ((40, 30, 6), (50, 25, 1)):
        a, b = sample(n, 0.3, digits), sample(m, 0, digits)
        print(f"    {{{text(a)}, {text(b)}, {stats.mannwhitneyu(a, b, method='asymptotic').pvalue!r}}},")
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
    print("};\n\n/// Bootstrap-t by all n^n resamples of n values.\nconst std::vector<AllResamples> kBootstrap = {")
    for n in (6, 7):
        x = sample(n, 1)
        centre, error = sum(x) / n, stats.sem(x)
        all_of_them = ((sum(c) / n - centre) / stats.sem(c) for c in itertools.product(x, repeat=n) if len(set(c)) > 1)
        high, low = stats.mstats.mquantiles(list(all_of_them), [0.025, 0.975], alphap=1, betap=1)
        print(f"    {{{text(x)}, {float(centre - low * error)!r}, {float(centre - high * error)!r}}},")
    print("};\n\nconst std::vector<OneSample> kOneSided = {")
    for n, shift in ((5, 2), (9, -0.5), (12, 0.3)):
        d = sample(n, shift)
        print(f"    {{{text(d)}, {stats.wilcoxon(d, method='exact', alternative='greater').pvalue!r}}},")
    d = sample(70, 0.1)
    p = stats.wilcoxon(d, method="approx", correction=True, alternative="greater").pvalue
    print(f"    {{{text(d)}, {p!r}}},")
    print("};")


if __name__ == "__main__":
    main()
