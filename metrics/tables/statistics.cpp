// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/tables/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>

namespace delquad {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostExact = 60;  // up to here counting is exact enough and fast

std::vector<double> without_zeros(std::span<const double> differences) {
  std::vector<double> values;
  std::ranges::copy_if(differences, std::back_inserter(values), [](double d) { return d != 0; });
  return values;
}

/// Returns the part of all choices of signs whose positive ranks add up to at most `sum`.
double exact_tail(const std::vector<int>& ranks, int sum) {
  std::vector<double> ways(static_cast<std::size_t>(sum) + 1, 0);  // parts by sum of positive ranks
  ways[0] = 1;
  for (const int rank : ranks)
    for (std::size_t s = ways.size(); s-- > 0;) {
      ways[s] /= 2;
      if (s >= static_cast<std::size_t>(rank)) ways[s] += ways[s - static_cast<std::size_t>(rank)] / 2;
    }
  return std::accumulate(ways.begin(), ways.end(), 0.0);
}

double normal_tail(const std::vector<int>& ranks, int sum) {
  double total = 0, squares = 0;
  for (const int rank : ranks) {
    total += rank;
    squares += double(rank) * rank;
  }
  return cdf(boost::math::normal(), (sum + 1 - total / 2) / (std::sqrt(squares) / 2));
}

double tail_of(const std::vector<int>& ranks, int sum) {
  return ranks.size() <= kMostExact ? exact_tail(ranks, sum) : normal_tail(ranks, sum);
}

/// Returns the largest least p-value of tests that count. It is kSignificance / K for the least K such that
/// at most K tests can reach it [tarone1990].
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

std::vector<int> double_ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  std::vector<int> ranks(values.size());
  for (std::size_t first = 0, last; first < order.size(); first = last) {
    last = first + 1;
    while (last < order.size() && values[order[last]] == values[order[first]]) ++last;
    for (std::size_t k = first; k < last; ++k) ranks[order[k]] = static_cast<int>(first + last + 1);
  }
  return ranks;
}

double mean(std::span<const double> samples) {
  return std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
}

namespace {

/// Returns the quantile that leaves out 5 %, half on either side.
double student_quantile(double degrees_of_freedom) {
  constexpr double kTail = 0.025;
  return quantile(complement(boost::math::students_t(degrees_of_freedom), kTail));
}

/// Returns the mean and its standard error, for two samples or more.
std::array<double, 2> mean_and_error(std::span<const double> samples) {
  const auto n = static_cast<double>(samples.size());
  const double centre = mean(samples);
  double squares = 0;
  for (const double s : samples) squares += (s - centre) * (s - centre);
  return {centre, std::sqrt(squares / (n - 1) / n)};
}

}  // namespace

double confidence_half_width(std::span<const double> samples) {
  const auto n = static_cast<double>(samples.size());
  return n < 2 ? kNone : student_quantile(n - 1) * mean_and_error(samples)[1];
}

RankTest wilcoxon(std::span<const double> differences) {
  const std::vector<double> values = without_zeros(differences);
  std::vector<double> sizes;
  for (const double value : values) sizes.push_back(std::abs(value));
  const std::vector<int> ranks = double_ranks(sizes);
  int positive = 0, negative = 0;
  for (std::size_t i = 0; i < values.size(); ++i) (values[i] > 0 ? positive : negative) += ranks[i];
  const double tail = tail_of(ranks, std::min(positive, negative));
  const double least = std::exp2(1 - static_cast<double>(values.size()));
  return {std::min(1.0, 2 * tail), std::min(1.0, least), double(positive) - negative};
}

std::vector<double> holm(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return p[i]; });
  std::vector<double> adjusted(p.size());
  double so_far = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    so_far = std::max(so_far, std::min(1.0, static_cast<double>(p.size() - k) * p[order[k]]));
    adjusted[order[k]] = so_far;
  }
  return adjusted;
}

double domain_mean(const DomainSamples& domain) {
  assert(std::ranges::none_of(domain, [](const auto& seeds) { return seeds.empty(); }));
  double sum = 0;
  for (const std::vector<double>& seeds : domain) sum += mean(seeds);
  return sum / static_cast<double>(domain.size());
}

std::optional<Interval> interval_of_mean(std::span<const double> values) {
  constexpr std::size_t kFewest = 6;
  if (values.size() < 2) return std::nullopt;
  const auto n = static_cast<double>(values.size());
  const auto [centre, error] = mean_and_error(values);
  const double half = confidence_half_width(values);
  double cubes = 0;
  for (const double value : values) cubes += std::pow(value - centre, 3);
  const double deviation = error * std::sqrt(n - 1);  // its square is the mean of the squares
  const double skewness = cubes / n / std::pow(deviation, 3);
  if (values.size() < kFewest || !(std::abs(skewness) > 1e-9)) return Interval{centre - half, centre + half};
  // Returns where the limit by Student's statistic over the root of n lies without its skewness.
  const auto inverse = [&](double u) {
    return 3 / skewness * (std::cbrt(1 + skewness * (u - skewness / (6 * n))) - 1);
  };
  const double spread = error * std::sqrt(n), end = half / spread;
  return Interval{centre - spread * inverse(end), centre - spread * inverse(-end)};
}

std::size_t ClaimFamily::add(const RankTest& test) {
  assert(findings_.empty());
  tests_.push_back(test);
  return tests_.size() - 1;
}

void ClaimFamily::decide() {
  assert(findings_.empty());
  findings_.assign(tests_.size(), Finding::kTooFew);
  adjusted_.assign(tests_.size(), kNone);
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
    findings_[which[k]] = adjusted_[which[k]] <= kSignificance ? Finding::kProven : Finding::kNotProven;
  }
}

void ClaimFamily::explore() {
  findings_.assign(tests_.size(), Finding::kExploratory);
  adjusted_.assign(tests_.size(), kNone);
}

std::string ClaimFamily::note(const char* whole) const {
  if (is_exploratory())
    return "Exploratory: only what was planned before the run is claimed; p is not corrected.";
  if (tests_.empty()) return "Nothing is tested: that takes several seeds or domains.";
  if (counted_ == 0)
    return fmt::format("Nothing can be proven: {} test{}, with too few samples.", tests_.size(),
                       tests_.size() == 1 ? "" : "s");
  std::string text =
      fmt::format("Corrected (Holm) over {} test{}, which are all {} that could prove a difference at 5 %",
                  counted_, counted_ == 1 ? "" : "s", whole);
  if (const std::size_t rest = tests_.size() - counted_; rest > 0)
    text += fmt::format("; {} more could not, with so few samples, and do not count", rest);
  return text + ".";
}

}  // namespace delquad
