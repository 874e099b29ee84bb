// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/report/page_json.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

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
