#include "sweep/statistics.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace delquad {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostExact = 60;

/// Twice the rank of each absolute value, whole numbers also where ties share a mean rank.
std::vector<int> double_ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::abs(values[i]); });
  std::vector<int> ranks(values.size());
  for (std::size_t first = 0, last; first < order.size(); first = last) {
    last = first + 1;
    while (last < order.size() && std::abs(values[order[last]]) == std::abs(values[order[first]])) ++last;
    for (std::size_t k = first; k < last; ++k) ranks[order[k]] = static_cast<int>(first + last + 1);
  }
  return ranks;
}

/// The part of all choices of signs whose positive ranks add up to at most `sum`.
double exact_tail(const std::vector<int>& ranks, int sum) {
  std::vector<double> ways(static_cast<std::size_t>(sum) + 1, 0);  // parts, by sum of positive ranks
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

}  // namespace

double mean(std::span<const double> samples) {
  return std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
}

double median(std::span<const double> samples) {
  if (samples.empty()) return kNone;
  std::vector<double> sorted(samples.begin(), samples.end());
  std::ranges::sort(sorted);
  const std::size_t n = sorted.size();
  return (sorted[(n - 1) / 2] + sorted[n / 2]) / 2;
}

double confidence_half_width(std::span<const double> samples) {
  const auto n = static_cast<double>(samples.size());
  if (n < 2) return kNone;
  const double centre = mean(samples);
  double squares = 0;
  for (const double s : samples) squares += (s - centre) * (s - centre);
  constexpr double kTail = 0.025;
  const double t = quantile(complement(boost::math::students_t(n - 1), kTail));
  return t * std::sqrt(squares / (n - 1) / n);
}

double wilcoxon_p(std::span<const double> differences) {
  std::vector<double> values;
  std::ranges::copy_if(differences, std::back_inserter(values), [](double d) { return d != 0; });
  const std::vector<int> ranks = double_ranks(values);
  int positive = 0, negative = 0;
  for (std::size_t i = 0; i < values.size(); ++i) (values[i] > 0 ? positive : negative) += ranks[i];
  const int less = std::min(positive, negative);
  const double tail = values.size() <= kMostExact ? exact_tail(ranks, less) : normal_tail(ranks, less);
  return std::min(1.0, 2 * tail);
}

std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y) {
  std::vector<double> u, v;
  for (const double value : x) u.push_back(std::log(value));
  for (const double value : y) v.push_back(std::log(value));
  const double u0 = mean(u), v0 = mean(v);
  double squares = 0, products = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    squares += (u[i] - u0) * (u[i] - u0);
    products += (u[i] - u0) * (v[i] - v0);
  }
  if (!(squares > 0)) return std::nullopt;
  const double exponent = products / squares;
  return PowerLaw{std::exp(v0 - exponent * u0), exponent};
}

}  // namespace delquad
