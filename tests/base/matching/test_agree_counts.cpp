// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/matching/edge_counts.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// The boxes of a strip, side by side; box i lies between uprights i and i + 1, and has a bottom and a top.
struct Strip {
  std::vector<AgreeingCurve> curves;
  std::vector<ClosureSum> sums;
  std::vector<int> counts;
  int boxes;

  Strip(int n, double upright, double weight) : boxes(n) {
    for (int i = 0; i <= n; ++i) {
      std::vector<int> patches;
      if (i > 0) patches.push_back(i - 1);
      if (i < n) patches.push_back(i);
      add(upright, weight, patches);
    }
    for (int i = 0; i < n; ++i) {
      add(6, weight, {i});
      add(6, weight, {i});
      sums.push_back({i, {{i, 1}, {i + 1, -1}}, 3, 3});
      sums.push_back({i, {{bottom(i), 1}, {bottom(i) + 1, -1}}, 3, 3});
    }
  }
  void add(double ideal, double weight, std::vector<int> patches) {
    curves.push_back({ideal, 1, true, weight, std::move(patches)});
    counts.push_back(static_cast<int>(std::lround(ideal)));
  }
  int bottom(int box) const { return boxes + 1 + 2 * box; }
  int open_sums() const {
    int open = 0;
    for (const ClosureSum& sum : sums) {
      int value = 0;
      for (const auto& [curve, times] : sum.terms) value += times * counts[curve];
      open += value != 0;
    }
    return open;
  }
  bool even() const {
    std::vector<int> around(boxes, 0);
    for (std::size_t c = 0; c < curves.size(); ++c)
      for (const int p : curves[c].patches) around[p] += counts[c];
    return std::ranges::all_of(around, [](int n) { return n % 2 == 0; });
  }
  Budget steps{1'000'000};
  void agree() { agree_counts(curves, boxes, sums, steps, counts); }
};

TEST(AgreeCounts, LeavesWhatAgrees) {
  Strip strip(4, 5, 1);
  const std::vector<int> before = strip.counts;
  strip.agree();
  EXPECT_EQ(strip.counts, before);
}

TEST(AgreeCounts, EndsOnceTheStepsAreSpent) {
  Strip strip(5, 5, 0.2);
  strip.counts[2] = 7;
  const std::vector<int> before = strip.counts;
  strip.steps.spend(strip.steps.left());
  strip.agree();
  EXPECT_EQ(strip.counts, before);
  EXPECT_EQ(strip.steps.left(), 0);
}

TEST(AgreeCounts, ClosesAlongAChainOfPatches) {
  Strip strip(5, 5, 0.2);
  strip.counts[2] = 7;
  ASSERT_EQ(strip.open_sums(), 2);
  strip.agree();
  EXPECT_EQ(strip.open_sums(), 0);
  EXPECT_TRUE(strip.even());
}

TEST(AgreeCounts, MovesAWholeRowWhereBothEndsWantMore) {
  // The uprights that are given ask for 6; with 5 in the middle two rows would have to end, twice.
  Strip strip(3, 5, 0.2);
  for (const int i : {0, 3}) strip.counts[i] = 6, strip.curves[i].is_free = false;
  strip.counts[strip.bottom(0)] = strip.counts[strip.bottom(2)] = 7;
  strip.agree();
  EXPECT_EQ(strip.open_sums(), 0);
  EXPECT_EQ(std::vector(strip.counts.begin(), strip.counts.begin() + 4), std::vector(4, 6));
  EXPECT_TRUE(strip.even());
}

TEST(AgreeCounts, KeepsTheSizeWhereThatIsWorthMore) {
  Strip strip(2, 5, 50);
  strip.curves[1].ideal = 9, strip.counts[1] = 9;
  const std::vector<int> before = strip.counts;
  strip.agree();
  EXPECT_EQ(strip.counts, before);
}

TEST(AgreeCounts, RaisesWhatIsToBeSoMuchAtLeast) {
  // A triangle has a star where each two of its sides are together longer than the third by two or more.
  const auto agreed = [](double price) {
    std::vector<AgreeingCurve> curves;
    std::vector<ClosureSum> sums;
    for (int i = 0; i < 3; ++i) curves.push_back({i == 2 ? 10.0 : 4.0, 1, true, 0.1, {0}});
    for (int i = 0; i < 3; ++i)
      sums.push_back({0, {{i, -1}, {(i + 1) % 3, 1}, {(i + 2) % 3, 1}}, price, price, 2});
    std::vector<int> counts{4, 4, 10};
    Budget steps{100'000};
    agree_counts(curves, 1, sums, steps, counts);
    return counts;
  };
  const std::vector<int> counts = agreed(10);
  EXPECT_GE(counts[0] + counts[1] - counts[2], 2);
  EXPECT_EQ((counts[0] + counts[1] + counts[2]) % 2, 0);
  EXPECT_EQ(agreed(0), (std::vector{4, 4, 10}));
}

TEST(AgreeCounts, KeepsTheParityOfEachPatch) {
  for (int seed = 1; seed <= 200; ++seed) {
    std::srand(seed);
    Strip strip(6, 5, 0.5);
    for (AgreeingCurve& c : strip.curves)
      c.ideal = 2 + std::rand() % 60 / 7.0, c.is_free = std::rand() % 5 > 0;
    for (std::size_t c = 0; c < strip.counts.size(); ++c)
      strip.counts[c] = std::max(1, static_cast<int>(std::lround(strip.curves[c].ideal)));
    for (int box = 0; box < 6; ++box) {
      const int b = strip.bottom(box);
      strip.counts[b] +=
          (strip.counts[b] + strip.counts[b + 1] + strip.counts[box] + strip.counts[box + 1]) % 2;
    }
    ASSERT_TRUE(strip.even());
    const std::vector<int> before = strip.counts;
    const int open = strip.open_sums();
    strip.agree();
    EXPECT_TRUE(strip.even()) << seed;
    EXPECT_LE(strip.open_sums(), open) << seed;
    for (std::size_t c = 0; c < before.size(); ++c) {
      EXPECT_GE(strip.counts[c], 1) << seed;
      EXPECT_TRUE(strip.curves[c].is_free || strip.counts[c] == before[c]) << seed;
    }
  }
}

}  // namespace
}  // namespace delquad
