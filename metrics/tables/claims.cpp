#include "metrics/tables/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace delquad {
namespace {

/// The largest p-value that a test may be able to reach and count: kSignificance over the least number K such
/// that no more than K tests can reach kSignificance / K [tarone1990].
double reach(const std::vector<RankTest>& tests) {
  std::vector<double> least;
  for (const RankTest& test : tests) least.push_back(test.least_p);
  std::ranges::sort(least);
  for (std::size_t k = 1;; ++k) {
    const double level = kSignificance / static_cast<double>(k);
    if (std::ranges::upper_bound(least, level) - least.begin() <= static_cast<std::ptrdiff_t>(k))
      return level;
  }
}

}  // namespace

std::size_t ClaimFamily::add(const RankTest& test) {
  tests_.push_back(test);
  return tests_.size() - 1;
}

void ClaimFamily::decide() {
  findings_.assign(tests_.size(), Finding::kTooFew);
  adjusted_.assign(tests_.size(), std::numeric_limits<double>::quiet_NaN());
  const double level = reach(tests_);
  std::vector<std::size_t> which;
  std::vector<double> p;
  for (std::size_t i = 0; i < tests_.size(); ++i)
    if (tests_[i].least_p <= level) {
      which.push_back(i);
      p.push_back(tests_[i].p);
    }
  counted_ = which.size();
  const std::vector<double> adjusted = holm(p);
  for (std::size_t k = 0; k < which.size(); ++k) {
    adjusted_[which[k]] = adjusted[k];
    findings_[which[k]] = adjusted[k] <= kSignificance ? Finding::kProven : Finding::kNotProven;
  }
}

std::string ClaimFamily::note() const {
  if (tests_.empty()) return "Nothing is tested: that takes several seeds or domains.";
  if (counted_ == 0)
    return fmt::format("Nothing can be proven: {} test{}, with too few samples.", tests_.size(),
                       tests_.size() == 1 ? "" : "s");
  std::string text = fmt::format(
      "Corrected (Holm) over {} test{}, which are all of this study that could prove a difference at 5 %",
      counted_, counted_ == 1 ? "" : "s");
  if (const std::size_t rest = tests_.size() - counted_; rest > 0)
    text += fmt::format("; {} more could not, with so few samples, and do not count", rest);
  return text + ".";
}

}  // namespace delquad
