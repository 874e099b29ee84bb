#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "metrics/tables/marks.h"
#include "metrics/tables/samples.h"
#include "metrics/tables/statistics.h"
#include "metrics/tables/table.h"

namespace delquad {

/// With fewer domains Wilcoxon's test can prove nothing at 5 %.
inline constexpr std::size_t kFewestDomains = 6;

/// Two pipelines in one measure, over the domains on which both have a value. The sample is the domain (the
/// case): the differences of its seeds are averaged, then those of its variants, since neither are
/// independent of each other.
struct PairComparison {
  std::string first, second;
  Metric metric;
  PairedDomains domains;  ///< first minus second
  std::size_t test;       ///< of the family: Wilcoxon's over the means of the domains
};

/// Every two pipelines that share two domains or more, in every measure; of quads alone only where both leave
/// no triangles on them. Unsound meshes count as they are. Adds a test to the family for each.
std::vector<PairComparison> compare_pairs(const std::vector<CellRecord>& records,
                                          const std::vector<std::string>& pipelines,
                                          const std::vector<TestedMeasure>& measures, ClaimFamily& family);

/// A row for each: domains and runs, on how many domains the first is better and worse, the mean of the
/// domains' means with its 95 % bootstrap interval, p-values, and what is proven, in words.
Table pairs_table(const std::string& title, const std::vector<PairComparison>& pairs,
                  const ClaimFamily& family);

}  // namespace delquad
