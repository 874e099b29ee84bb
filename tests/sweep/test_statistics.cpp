#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "sweep/statistics.h"

namespace delquad {
namespace {

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
    EXPECT_NEAR(wilcoxon_p(d), wilcoxon_by_force(d), 1e-12) << trial;
  }
}

TEST(Statistics, WilcoxonOfManyIsNearTheExactOne) {
  std::mt19937 random(8);
  std::vector<double> d;
  for (int i = 0; i < 60; ++i) d.push_back(static_cast<double>(random() % 1000) - 400);
  const double exact = wilcoxon_p(d);
  d.push_back(0.5);  // one more: the normal distribution
  EXPECT_NEAR(wilcoxon_p(d), exact, 0.01);
}

TEST(Statistics, WilcoxonOfFewProvesNothing) {
  EXPECT_EQ(wilcoxon_p({}), 1);
  EXPECT_EQ(wilcoxon_p(std::vector<double>{0, 0}), 1);
  EXPECT_DOUBLE_EQ(wilcoxon_p(std::vector<double>{1, 2, 3, 4, 5}), 2.0 / 32);
  EXPECT_DOUBLE_EQ(wilcoxon_p(std::vector<double>{1, 2, 3, 4, 5, 6}), 2.0 / 64);
}

/// Student's t of 9 degrees of freedom, 97.5 %: 2.262157.
TEST(Statistics, ConfidenceIntervalOfTenSamples) {
  std::vector<double> samples;
  for (int i = 1; i <= 10; ++i) samples.push_back(i);
  EXPECT_NEAR(confidence_half_width(samples), 2.262157 * 3.0276504 / std::sqrt(10), 1e-5);
  EXPECT_EQ(mean(samples), 5.5);
  EXPECT_EQ(median(samples), 5.5);
  EXPECT_TRUE(std::isnan(confidence_half_width(std::vector<double>{1})));
  EXPECT_TRUE(std::isnan(median({})));
}

TEST(PowerLaw, FindsTheLawThatMadeThePairs) {
  const std::vector<double> x = {10, 20, 500, 7000};
  std::vector<double> y;
  for (const double v : x) y.push_back(3 * std::pow(v, 1.25));
  const auto law = fit_power_law(x, y);
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, 1.25, 1e-12);
  EXPECT_NEAR(law->factor, 3, 1e-11);
}

TEST(PowerLaw, ErrorsBalanceAndOneSizeTellsNothing) {
  // Twice and half of x: the law between them is x itself.
  const auto law = fit_power_law(std::vector<double>{1, 1, 100, 100}, std::vector<double>{2, 0.5, 200, 50});
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, 1, 1e-12);
  EXPECT_NEAR(law->factor, 1, 1e-12);
  EXPECT_FALSE(fit_power_law(std::vector<double>{5, 5}, std::vector<double>{1, 2}));
  EXPECT_FALSE(fit_power_law(std::vector<double>{}, std::vector<double>{}));
}

}  // namespace
}  // namespace delquad
