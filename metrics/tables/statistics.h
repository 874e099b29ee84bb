#pragma once

#include <cassert>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace delquad {

double mean(std::span<const double> samples);
/// Half the width of the 95 % confidence interval of the mean, by Student's t; NaN of fewer than two.
double confidence_half_width(std::span<const double> samples);

/// Twice the rank of each value, from 1: whole numbers also where ties share a mean rank.
std::vector<int> double_ranks(std::span<const double> values);

/// A test by ranks of the hypothesis that there is no difference.
struct RankTest {
  double p = 1;        ///< how likely it is that samples lean so far to one side when nothing does
  double least_p = 1;  ///< the least that so many samples can give, however they come out
  double lean = 0;     ///< above 0: the first is larger
};
/// Wilcoxon's signed-rank test of differences, first minus second, two-sided. Zeros are left out, ties share
/// their mean rank; differences may be infinite. Exact up to 60 differences, by the normal distribution
/// beyond. p = 1 of none.
RankTest wilcoxon(std::span<const double> differences);
/// Holm's step-down adjustment [holm1979]: a hypothesis may be rejected at a level when its adjusted p-value
/// is at most that level; then the probability of any false rejection is at most the level, however the tests
/// depend on each other.
std::vector<double> holm(std::span<const double> p);

/// Samples of one domain: of each of its variants the seeds.
using DomainSamples = std::vector<std::vector<double>>;

/// The mean over variants of the mean over seeds; no variant may be empty.
double domain_mean(const DomainSamples& domain);

struct Interval {
  double low, high;
};

/// The 95 % interval of the mean by Student's statistic without its skewness [hall1992]; of fewer than six
/// values by Student's statistic as it is. Nothing of fewer than two values.
std::optional<Interval> interval_of_mean(std::span<const double> values);

/// The probability of any false claim in all tables of a study.
inline constexpr double kSignificance = 0.05;

enum class Finding {
  kProven,      ///< a difference
  kNotProven,   ///< no difference is
  kTooFew,      ///< samples: nothing could have been proven, whatever they say
  kExploratory  ///< nothing was planned: no claim, whatever they say
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
  /// In place of decide(): the tests are shown, and nothing is claimed.
  void explore();
  bool is_exploratory() const { return !findings_.empty() && findings_[0] == Finding::kExploratory; }
  const RankTest& test(std::size_t test) const { return tests_[test]; }
  Finding finding(std::size_t test) const {
    assert(test < findings_.size());
    return findings_[test];
  }
  /// Holm's; NaN of those that do not count.
  double adjusted_p(std::size_t test) const { return adjusted_[test]; }
  std::size_t size() const { return tests_.size(); }
  std::size_t counted() const { return counted_; }
  /// For people: over how many tests was corrected, and how many do not count.
  std::string note(const char* whole = "of this study") const;

 private:
  std::vector<RankTest> tests_;
  std::vector<Finding> findings_;
  std::vector<double> adjusted_;
  std::size_t counted_ = 0;
};

}  // namespace delquad
