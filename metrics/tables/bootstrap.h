#pragma once

#include <optional>
#include <vector>

namespace delquad {

/// Samples of one domain: of each of its variants the seeds.
using DomainSamples = std::vector<std::vector<double>>;

/// The mean over variants of the mean over seeds; no variant may be empty.
double domain_mean(const DomainSamples& domain);

struct Interval {
  double low, high;
};

/// The 95 % interval of the mean of domain means by the bootstrap in two stages [davison1997, section 3.8]:
/// domains are drawn with replacement, then in each of them the seeds of every variant; the 2.5th and 97.5th
/// percentile of 2000 means. The same numbers every time. Nothing of fewer than two domains.
std::optional<Interval> bootstrap_interval(const std::vector<DomainSamples>& domains);

}  // namespace delquad
