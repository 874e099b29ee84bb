// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cassert>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

// This header has tests and intervals. Tables of studies use it.

namespace delquad {

/// Returns the mean; samples must not be empty.
double mean(std::span<const double> samples);
/// Returns half the width of the 95 % confidence interval of the mean, by Student's t; NaN for fewer than two
/// samples.
double confidence_half_width(std::span<const double> samples);

/// Returns twice the rank of each value, from 1, so that shared mean ranks of ties are integers.
std::vector<int> double_ranks(std::span<const double> values);

/// Rank test of the hypothesis that there is no difference.
struct RankTest {
  double p = 1;        ///< probability of a lean at least as large without any difference
  double least_p = 1;  ///< least p that so many samples can give
  double lean = 0;     ///< above 0: the first is larger
};
/// Returns Wilcoxon's two-sided signed-rank test of differences, first minus second [wilcoxon1945]. Zeros are
/// left out, and ties share their mean rank; differences may be infinite. It is exact up to 60 differences,
/// and by the normal distribution beyond. Returns p = 1 without differences.
RankTest wilcoxon(std::span<const double> differences);
/// Returns p-values adjusted by Holm's step-down method [holm1979]. A hypothesis may be rejected at a level
/// if its adjusted p-value is at most that level. Then any false rejection has at most that probability, for
/// any dependence of the tests.
std::vector<double> holm(std::span<const double> p);

/// Samples of a domain: the seeds of each of its variants.
using DomainSamples = std::vector<std::vector<double>>;

/// Returns the mean over variants of the mean over seeds; no variant may be empty.
double domain_mean(const DomainSamples& domain);

struct Interval {
  double low, high;
};

/// Returns the 95 % interval of the mean, by Student's statistic without its skewness [hall1992]. For fewer
/// than six values Student's statistic is unchanged. Returns nothing for fewer than two values.
std::optional<Interval> interval_of_mean(std::span<const double> values);

/// Probability of any false claim in all tables of a study.
inline constexpr double kSignificance = 0.05;

enum class Finding {
  kProven,      ///< a difference
  kNotProven,   ///< no difference is proven
  kTooFew,      ///< too few samples to prove anything
  kExploratory  ///< not planned, so nothing is claimed
};

/// All tests of a study. It decides what may be claimed, so that any false claim has at most the probability
/// kSignificance, for any dependence of the tests.
///
/// It applies Holm's method [holm1979] to the tests that could have proven something. Tests whose least
/// p-value exceeds the corrected level for all counted tests do not count [tarone1990]. The least p-values
/// follow from the numbers of samples, before any result.
class ClaimFamily {
 public:
  /// Returns the index of the test.
  std::size_t add(const RankTest& test);
  /// Decides. Must be called once, after all tests are added and before any query.
  void decide();
  /// Replaces decide(): tests are shown, and nothing is claimed.
  void explore();
  bool is_exploratory() const { return !findings_.empty() && findings_[0] == Finding::kExploratory; }
  const RankTest& test(std::size_t test) const { return tests_[test]; }
  Finding finding(std::size_t test) const {
    assert(test < findings_.size());
    return findings_[test];
  }
  /// Returns Holm's value; NaN for tests that do not count.
  double adjusted_p(std::size_t test) const { return adjusted_[test]; }
  std::size_t size() const { return tests_.size(); }
  std::size_t counted() const { return counted_; }
  /// Returns the number of tests in the correction, and of those that do not count, in words.
  std::string note(const char* whole = "of this study") const;

 private:
  std::vector<RankTest> tests_;
  std::vector<Finding> findings_;
  std::vector<double> adjusted_;
  std::size_t counted_ = 0;
};

}  // namespace delquad
