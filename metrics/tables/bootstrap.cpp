#include "metrics/tables/bootstrap.h"

#include <algorithm>
#include <cstdint>

#include "metrics/tables/random_index.h"
#include "metrics/tables/statistics.h"

namespace delquad {
namespace {

constexpr int kResamples = 2000;
constexpr std::uint64_t kSeed = 20130903;  // any will do, as long as it stays

double redrawn_mean(const DomainSamples& domain, RandomIndex& draw) {
  double sum = 0;
  for (const std::vector<double>& seeds : domain) {
    double of_variant = 0;
    for (std::size_t k = 0; k < seeds.size(); ++k) of_variant += seeds[draw(seeds.size())];
    sum += of_variant / static_cast<double>(seeds.size());
  }
  return sum / static_cast<double>(domain.size());
}

/// With linear interpolation between sorted values.
double quantile_of(const std::vector<double>& sorted, double part) {
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

double domain_mean(const DomainSamples& domain) {
  double sum = 0;
  for (const std::vector<double>& seeds : domain) sum += mean(seeds);
  return sum / static_cast<double>(domain.size());
}

std::optional<Interval> bootstrap_interval(const std::vector<DomainSamples>& domains) {
  if (domains.size() < 2) return std::nullopt;
  RandomIndex draw(kSeed);
  std::vector<double> means;
  for (int i = 0; i < kResamples; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < domains.size(); ++k) sum += redrawn_mean(domains[draw(domains.size())], draw);
    means.push_back(sum / static_cast<double>(domains.size()));
  }
  std::ranges::sort(means);
  constexpr double kTail = 0.025;
  return Interval{quantile_of(means, kTail), quantile_of(means, 1 - kTail)};
}

}  // namespace delquad
