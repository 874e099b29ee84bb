#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "metrics/tables/statistics.h"

namespace delquad {

/// The probability of any false claim in all tables of a study.
inline constexpr double kSignificance = 0.05;

enum class Finding {
  kProven,     ///< a difference
  kNotProven,  ///< no difference is
  kTooFew      ///< samples: nothing could have been proven, whatever they say
};

/// All tests of a study: what may be claimed, so that the probability of any false claim, anywhere, is at
/// most kSignificance, however the tests depend on each other.
///
/// By Holm's method [holm1979] over the tests that could have proven something. The others, whose least
/// p-value is above what the correction for all that count asks for, do not count [tarone1990]: their least
/// p-values are known from the number of samples alone, before anybody has won.
class ClaimFamily {
 public:
  /// Returns the number of the test.
  std::size_t add(const RankTest& test);
  /// To be called once, after all tests are added and before anything is asked.
  void decide();
  const RankTest& test(std::size_t test) const { return tests_[test]; }
  Finding finding(std::size_t test) const { return findings_[test]; }
  /// Holm's; NaN of those that do not count.
  double adjusted_p(std::size_t test) const { return adjusted_[test]; }
  std::size_t size() const { return tests_.size(); }
  std::size_t counted() const { return counted_; }
  /// For people: over how many tests was corrected, and how many do not count.
  std::string note() const;

 private:
  std::vector<RankTest> tests_;
  std::vector<Finding> findings_;
  std::vector<double> adjusted_;
  std::size_t counted_ = 0;
};

}  // namespace delquad
