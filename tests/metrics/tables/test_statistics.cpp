// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/statistics.h"
#include "metrics/tables/table.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

struct OneSample {
  std::vector<double> values;
  double expected;
};
struct Adjusted {
  std::vector<double> p, expected;
};
struct Ends {
  std::vector<double> values;
  double low, high;
};
#include "rank_tests.inc"

TEST(Statistics, AgreesWithSciPy) {
  for (const auto& [values, expected] : kWilcoxon)
    EXPECT_NEAR(wilcoxon(values).p, expected, 1e-9) << values.size();
  for (const auto& [values, expected] : kHalfWidths)
    EXPECT_NEAR(confidence_half_width(values), expected, 1e-9) << values.size();
  for (const auto& [p, expected] : kHolm)
    for (std::size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(holm(p)[i], expected[i], 1e-12);
}

/// All digits, the same every time: there is nothing drawn.
TEST(Interval, AgreesWithSciPy) {
  for (const auto& [values, low, high] : kIntervals) {
    const auto interval = interval_of_mean(values);
    ASSERT_TRUE(interval);
    EXPECT_NEAR(interval->low, low, 1e-8 * (high - low));
    EXPECT_NEAR(interval->high, high, 1e-8 * (high - low));
    std::vector<double> negative;  // skewed the other way
    for (const double value : values) negative.push_back(-value);
    EXPECT_NEAR(interval_of_mean(negative)->low, -high, 1e-8 * (high - low));
  }
}

TEST(Interval, IsStudentsOfFewAndWithoutSkewness) {
  for (const auto& [values, half] : kHalfWidths) {
    if (values.size() > 3) continue;
    EXPECT_NEAR(interval_of_mean(values)->high - mean(values), half, 1e-9);
  }
  const std::vector<double> even = {-3, -2, -1, 0, 1, 2, 3};
  EXPECT_NEAR(interval_of_mean(even)->high, confidence_half_width(even), 1e-12);
  EXPECT_EQ(interval_of_mean(std::vector<double>(8, 2.0))->low, 2);
  EXPECT_FALSE(interval_of_mean(std::vector<double>{1}));
}

/// In 300 studies of each kind it has the true mean in 93 to 97 % of them, give or take two standard errors.
TEST(Interval, HasTheMeanAsOftenAsItSays) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::gamma_distribution<double> skewed(4);     // skewness 1
  std::student_t_distribution<double> heavy(5);  // kurtosis 9
  const std::pair<const char*, std::function<double()>> shapes[] = {
      {"normal", [&] { return normal(random); }},
      {"skewed", [&] { return skewed(random) - 4; }},
      {"heavy tails", [&] { return heavy(random); }}};
  constexpr int kStudiesOfEach = 300;
  const double slack = 2 * std::sqrt(0.05 * 0.95 / kStudiesOfEach);
  for (const auto& [name, draw] : shapes)
    for (const int domains : {6, 8, 12, 24}) {
      int covered = 0;
      for (int study = 0; study < kStudiesOfEach; ++study) {
        std::vector<double> values;
        for (int k = 0; k < domains; ++k) values.push_back(draw());
        const auto interval = interval_of_mean(values);
        covered += interval->low <= 0 && 0 <= interval->high;
      }
      const double part = static_cast<double>(covered) / kStudiesOfEach;
      EXPECT_GE(part, 0.93 - slack) << name << ' ' << domains;
      EXPECT_LE(part, 0.97 + slack) << name << ' ' << domains;
    }
}

TEST(Domains, VariantsWeighAlikeHoweverManySeedsTheyHave) {
  EXPECT_DOUBLE_EQ(domain_mean({{1, 1, 1, 1}, {3}}), 2);
}

TEST(Claims, TestsThatCannotProveAnythingDoNotCount) {
  ClaimFamily family;
  const std::size_t strong = family.add({0.02, 1e-6, 1});
  for (int i = 0; i < 100; ++i) family.add({0.0078125, 0.0078125, 1});  // eight seeds that all agree
  family.decide();
  EXPECT_EQ(family.counted(), 1u);
  EXPECT_EQ(family.finding(strong), Finding::kProven);
  EXPECT_DOUBLE_EQ(family.adjusted_p(strong), 0.02);
  EXPECT_EQ(family.finding(1), Finding::kTooFew);
  EXPECT_TRUE(std::isnan(family.adjusted_p(1)));
  EXPECT_TRUE(holds(family.note(), "over 1 test,", "100 more could not"));
}

TEST(Claims, AsManyAsCanProveSomethingCount) {
  ClaimFamily family;
  for (int i = 0; i < 6; ++i) family.add({0.0078125, 0.0078125, 1});  // 6 * 0.0078 < 0.05
  family.decide();
  EXPECT_EQ(family.counted(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(family.finding(i), Finding::kProven);
  ClaimFamily one_more;
  for (int i = 0; i < 7; ++i) one_more.add({0.0078125, 0.0078125, 1});  // 7 * 0.0078 > 0.05
  one_more.decide();
  EXPECT_EQ(one_more.counted(), 0u);
  EXPECT_EQ(one_more.finding(0), Finding::kTooFew);
  ClaimFamily none;
  none.decide();
  EXPECT_EQ(none.size(), 0u);
}

TEST(CellText, DigitsFollowTheInterval) {
  EXPECT_EQ(decimals_of(0.43, 0), 2);
  EXPECT_EQ(decimals_of(0.0123, 3), 3);
  EXPECT_EQ(decimals_of(12.3, 3), 0);
  EXPECT_EQ(decimals_of(4321, 1), 0);
  EXPECT_EQ(decimals_of(0, 3), 3);
  EXPECT_EQ(decimals_of(std::nan(""), 1), 1);
  EXPECT_EQ(half_width_text(1e-12, decimals_of(1e-12, 3)), "< 0.001") << "hidden by no rounding";
  EXPECT_EQ(decimals_of(3e-6, 3), 6);
  EXPECT_EQ(half_width_text(3e-6, 6), "0.000003");
  EXPECT_EQ(decimals_of(3e-12, 12), 13) << "of small measures";
  EXPECT_EQ(interval_text(-0.0001, {-0.04, 0.05}, 4), "0.000 [-0.040, 0.050]");
  EXPECT_EQ(p_text(3e-8), "< 0.0001") << "never 0";
  EXPECT_EQ(p_text(0.0123), "0.0123");
  EXPECT_EQ(interval_text(0.01234, {0.01, 0.0149}, 4), "0.0123 [0.0100, 0.0149]");
}

/// As toFixed() of JavaScript does: the page shows the same.
TEST(CellText, HalvesAreRoundedAwayFromZero) {
  EXPECT_EQ(number_text(160.5, 0), "161");
  EXPECT_EQ(number_text(161.5, 0), "162");
  EXPECT_EQ(number_text(-2.5, 0), "-3");
  EXPECT_EQ(number_text(88.25, 1), "88.3");
  EXPECT_EQ(number_text(0.0625, 3), "0.063");
  EXPECT_EQ(number_text(0.15, 1), "0.1") << "which is less than .15";
  EXPECT_EQ(number_text(2.4999, 0), "2");
  EXPECT_EQ(number_text(-0.01, 1), "0.0");
}

/// By trying every choice of signs.
double wilcoxon_by_force(std::vector<double> d) {
  std::erase(d, 0.0);
  std::vector<double> rank;
  for (const double x : d) {
    double below = 0, same = 0;
    for (const double y : d) {
      below += std::abs(y) < std::abs(x);
      same += std::abs(y) == std::abs(x);
    }
    rank.push_back(below + (same + 1) / 2);
  }
  double total = 0, positive = 0;
  for (std::size_t i = 0; i < d.size(); ++i) {
    total += rank[i];
    if (d[i] > 0) positive += rank[i];
  }
  const double lean = std::abs(positive - total / 2);
  int as_far = 0;
  for (unsigned signs = 0; signs < 1u << d.size(); ++signs) {
    double sum = 0;
    for (std::size_t i = 0; i < d.size(); ++i)
      if (signs >> i & 1) sum += rank[i];
    as_far += std::abs(sum - total / 2) >= lean;
  }
  return static_cast<double>(as_far) / (1u << d.size());
}

TEST(Statistics, WilcoxonAgreesWithAllChoicesOfSigns) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<double> d(1 + trial % 10);
    for (double& x : d) x = static_cast<int>(random() % 9) - 3;  // ties, zeros and a lean
    EXPECT_NEAR(wilcoxon(d).p, wilcoxon_by_force(d), 1e-12) << trial;
  }
}

TEST(Statistics, WilcoxonOfManyIsNearTheExactOne) {
  std::mt19937 random(8);
  std::vector<double> d;
  for (int i = 0; i < 60; ++i) d.push_back(static_cast<double>(random() % 1000) - 400);
  const double exact = wilcoxon(d).p;
  d.push_back(0.5);  // one more: the normal distribution
  EXPECT_NEAR(wilcoxon(d).p, exact, 0.01);
}

/// Failures have the largest differences, all of the same size.
TEST(Statistics, WilcoxonTakesInfiniteDifferences) {
  const std::vector<double> failed = {1, 2, 3, 4, 5, -HUGE_VAL, -HUGE_VAL}, large = {1, 2, 3, 4, 5, -9, -9};
  EXPECT_EQ(wilcoxon(failed).p, wilcoxon(large).p);
  EXPECT_EQ(wilcoxon(failed).lean, wilcoxon(large).lean);
}

TEST(Statistics, WilcoxonOfFewProvesNothing) {
  EXPECT_EQ(wilcoxon({}).p, 1);
  EXPECT_EQ(wilcoxon(std::vector<double>{0, 0}).p, 1);
  EXPECT_DOUBLE_EQ(wilcoxon(std::vector<double>{1, 2, 3, 4, 5}).p, 2.0 / 32);
  EXPECT_DOUBLE_EQ(wilcoxon(std::vector<double>{1, 2, 3, 4, 5, 6}).p, 2.0 / 64);
}

/// Student's t of 9 degrees of freedom, 97.5 %: 2.262157.
TEST(Statistics, ConfidenceIntervalOfTenSamples) {
  std::vector<double> samples;
  for (int i = 1; i <= 10; ++i) samples.push_back(i);
  EXPECT_NEAR(confidence_half_width(samples), 2.262157 * 3.0276504 / std::sqrt(10), 1e-5);
  EXPECT_EQ(mean(samples), 5.5);
  EXPECT_TRUE(std::isnan(confidence_half_width(std::vector<double>{1})));
}

}  // namespace
}  // namespace delquad
