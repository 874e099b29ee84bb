#include "metrics/tables/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/binomial.hpp>
#include <limits>
#include <numeric>

namespace delquad {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostExact = 60;  // up to here the numbers of ways are exact enough, and quickly had

std::vector<double> without_zeros(std::span<const double> differences) {
  std::vector<double> values;
  std::ranges::copy_if(differences, std::back_inserter(values), [](double d) { return d != 0; });
  return values;
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

/// The part of all choices of `n` ranks that add up to at most `sum`.
double exact_choice_tail(const std::vector<int>& ranks, std::size_t n, int sum) {
  const std::size_t sums = static_cast<std::size_t>(sum) + 1;
  std::vector<std::vector<double>> ways(n + 1, std::vector<double>(sums, 0));  // by number and sum of ranks
  ways[0][0] = 1;
  for (const int rank : ranks)
    for (std::size_t k = n; k > 0; --k)
      for (std::size_t s = static_cast<std::size_t>(rank); s < sums; ++s)
        ways[k][s] += ways[k - 1][s - static_cast<std::size_t>(rank)];
  return std::accumulate(ways[n].begin(), ways[n].end(), 0.0) /
         boost::math::binomial_coefficient<double>(static_cast<unsigned>(ranks.size()),
                                                   static_cast<unsigned>(n));
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

/// Of the sum of the doubled ranks of `n` among all, which is `off` away from its mean.
double normal_choice_tail(const std::vector<int>& ranks, std::size_t n, double off) {
  const auto total = static_cast<double>(ranks.size());
  const double centre = total + 1;  // the mean of doubled ranks
  double squares = 0;
  for (const int rank : ranks) squares += (rank - centre) * (rank - centre);
  const auto chosen = static_cast<double>(n);
  const double deviation = std::sqrt(chosen * (total - chosen) / total * squares / (total - 1));
  return deviation > 0 ? cdf(boost::math::normal(), -std::max(0.0, off - 1) / deviation) : 1;
}

constexpr int kResamples = 2000;
constexpr std::uint64_t kSeed = 20130903;  // any will do, as long as it stays

/// With linear interpolation between sorted values.
double quantile_of(const std::vector<double>& sorted, double part) {
  assert(!sorted.empty() && std::ranges::is_sorted(sorted) && part >= 0 && part <= 1);
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

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

double median(std::span<const double> samples) {
  if (samples.empty()) return kNone;
  std::vector<double> sorted(samples.begin(), samples.end());
  std::ranges::sort(sorted);
  const std::size_t n = sorted.size();
  return (sorted[(n - 1) / 2] + sorted[n / 2]) / 2;
}

namespace {

/// That leaves out 5 %, half of it on either side.
double student_quantile(double degrees_of_freedom) {
  constexpr double kTail = 0.025;
  return quantile(complement(boost::math::students_t(degrees_of_freedom), kTail));
}

/// And the standard error of the mean, of two or more.
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

RankTest wilcoxon(std::span<const double> differences, bool one_sided) {
  const std::vector<double> values = without_zeros(differences);
  std::vector<double> sizes;
  for (const double value : values) sizes.push_back(std::abs(value));
  const std::vector<int> ranks = double_ranks(sizes);
  int positive = 0, negative = 0;
  for (std::size_t i = 0; i < values.size(); ++i) (values[i] > 0 ? positive : negative) += ranks[i];
  const double tail = tail_of(ranks, one_sided ? negative : std::min(positive, negative));
  const double sides = one_sided ? 1 : 2, least = sides * std::exp2(-static_cast<double>(values.size()));
  return {std::min(1.0, sides * tail), std::min(1.0, least), double(positive) - negative};
}

double wilcoxon_power(std::size_t n, double effect, double level, bool one_sided) {
  constexpr int kDraws = 10'000;
  std::vector<int> ranks(n);
  for (std::size_t i = 0; i < n; ++i) ranks[i] = 2 * static_cast<int>(i + 1);
  const double tail = one_sided ? level : level / 2;
  const int half = std::accumulate(ranks.begin(), ranks.end(), 0) / 2;
  int most = -2;  // of the doubled ranks of differences below 0
  while (most + 2 <= half && tail_of(ranks, most + 2) <= tail) most += 2;
  RandomIndex draw(kSeed);
  constexpr std::size_t kSteps = std::size_t{1} << 52;
  std::vector<double> values(n), sizes(n);
  int proofs = 0;
  for (int i = 0; i < kDraws; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      const double part = (static_cast<double>(draw(kSteps)) + 0.5) / static_cast<double>(kSteps);
      values[k] = effect + quantile(boost::math::normal(), part);
      sizes[k] = std::abs(values[k]);
    }
    const std::vector<int> drawn = double_ranks(sizes);
    int negative = 0;
    for (std::size_t k = 0; k < n; ++k) negative += values[k] < 0 ? drawn[k] : 0;
    proofs += negative <= most ? 1 : 0;
  }
  return double(proofs) / kDraws;
}

RankTest mann_whitney(std::span<const double> first, std::span<const double> second) {
  if (first.empty() || second.empty()) return {};
  std::vector<double> all(first.begin(), first.end());
  all.insert(all.end(), second.begin(), second.end());
  const std::size_t n = first.size(), m = second.size();
  const std::vector<int> ranks = double_ranks(all);
  const int sum = std::accumulate(ranks.begin(), ranks.begin() + static_cast<std::ptrdiff_t>(n), 0);
  const int centre = static_cast<int>(n * (n + m + 1)), off = std::abs(sum - centre);
  double p = 1;
  if (n + m > kMostExact) {
    p = 2 * normal_choice_tail(ranks, n, off);
  } else if (off > 0) {
    // Both ways to be as far off, which ties make differ: the second sum is what the first leaves.
    const int centre_of_second = static_cast<int>(m * (n + m + 1));
    p = exact_choice_tail(ranks, n, centre - off) + exact_choice_tail(ranks, m, centre_of_second - off);
  }
  double ways = 1;  // to choose the first of all; infinite where there are too many to count
  for (std::size_t k = 1; k <= m; ++k) ways *= static_cast<double>(n + k) / static_cast<double>(k);
  return {std::min(1.0, p), std::min(1.0, 2 / ways), double(sum) - centre};
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

std::optional<PowerLaw> fit_power_law(std::span<const double> x, std::span<const double> y) {
  assert(x.size() == y.size());
  assert(std::ranges::all_of(x, [](double value) { return value > 0; }));
  assert(std::ranges::all_of(y, [](double value) { return value > 0; }));
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
  double off = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double d = v[i] - v0 - exponent * (u[i] - u0);
    off += d * d;
  }
  const double free = static_cast<double>(u.size()) - 2;
  const double half_width = free < 1 ? kNone : student_quantile(free) * std::sqrt(off / free / squares);
  return PowerLaw{std::exp(v0 - exponent * u0), exponent, half_width};
}

double domain_mean(const DomainSamples& domain) {
  assert(std::ranges::none_of(domain, [](const auto& seeds) { return seeds.empty(); }));
  double sum = 0;
  for (const std::vector<double>& seeds : domain) sum += mean(seeds);
  return sum / static_cast<double>(domain.size());
}

std::optional<Interval> interval_of_mean(std::span<const double> values) {
  constexpr std::size_t kFewest = 6;
  constexpr double kTail = 0.025;
  constexpr double kRounding = 1e-9;  // of resamples of one value, in deviations
  const std::size_t n = values.size();
  if (n < 2) return std::nullopt;
  const auto [centre, error] = mean_and_error(values);
  const double half = confidence_half_width(values);
  const Interval student = {centre - half, centre + half};
  if (n < kFewest || error == 0) return student;
  RandomIndex draw(kSeed);
  std::vector<double> statistics, sample(n);
  for (int i = 0; i < kResamples; ++i) {
    for (double& value : sample) value = values[draw(n)];
    const auto [m, e] = mean_and_error(sample);
    if (e > kRounding * error) statistics.push_back((m - centre) / e);
  }
  if (static_cast<double>(statistics.size()) < (1 - kTail) * kResamples) return student;
  std::ranges::sort(statistics);
  return Interval{centre - quantile_of(statistics, 1 - kTail) * error,
                  centre - quantile_of(statistics, kTail) * error};
}

std::size_t ClaimFamily::add(const RankTest& test) {
  assert(findings_.empty());
  tests_.push_back(test);
  return tests_.size() - 1;
}

void ClaimFamily::decide(double gate) {
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
    adjusted_[which[k]] = std::max(gate, adjusted[k]);
    findings_[which[k]] = adjusted_[which[k]] <= kSignificance ? Finding::kProven : Finding::kNotProven;
  }
}

double ClaimFamily::largest_p() const {
  double largest = 0;
  for (const double p : adjusted_) largest = std::isnan(p) ? 1 : std::max(largest, p);
  return largest;
}

void ClaimFamily::explore() {
  findings_.assign(tests_.size(), Finding::kExploratory);
  adjusted_.assign(tests_.size(), kNone);
}

std::string ClaimFamily::note(const char* whole) const {
  if (is_exploratory())
    return "Exploratory: this study claims what it had planned alone, in hypotheses.*; p is not corrected.";
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
