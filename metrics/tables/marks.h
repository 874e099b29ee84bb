#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "delquad/metrics.h"
#include "metrics/tables/samples.h"
#include "metrics/tables/statistics.h"
#include "metrics/tables/table.h"

namespace delquad {

/// A measure of tables that is better one way, and how it is tested.
struct TestedMeasure {
  Metric metric;
  ValueKind kind = ValueKind::kMeasure;
};

/// Which values of each group (a variant of a case) are proven to be the best.
///
/// Rivals are rows of sound meshes of quads; for measures of quads alone only those without triangles. Every
/// two of a group are tested against each other, by Wilcoxon's signed-rank test over the seeds that both
/// have, and times by the Mann-Whitney U test over repeated runs: whoever turns out to be the best, that test
/// is among them.
class Marking {
 public:
  /// Adds its tests to the family. `samples` has to outlive it.
  Marking(const std::vector<Samples>& samples, const std::vector<TestedMeasure>& measures,
          ClaimFamily& family);

  /// `rows`: of the samples, in the same order. The best value is marked as such where it is proven to be
  /// better than every rival; else it and what is not proven to be worse are marked as good; nothing is
  /// marked where there were too few runs to tell anything.
  void mark(const ClaimFamily& family, std::span<TableRow> rows) const;
  /// Whether any of its tests could prove a difference.
  bool can_prove(const ClaimFamily& family) const;
  /// For people: what the marks of these rows mean, and why there are none.
  std::vector<std::string> notes(const ClaimFamily& family, std::span<const TableRow> rows) const;

 private:
  struct Duel {
    std::size_t first, second;  ///< rows
    std::size_t test;           ///< of the family
  };
  /// A measure in a group.
  struct Contest {
    std::string key;
    double sign;                      ///< 1 where more is better, -1 where less is
    std::vector<std::size_t> rivals;  ///< rows
    std::vector<double> values;       ///< of the rivals
    std::vector<Duel> duels;
  };

  static bool can_prove(const ClaimFamily& family, const Contest& contest);
  void add_group(std::size_t first, std::size_t last, const TestedMeasure& measure, ClaimFamily& family);
  RankTest test(const TestedMeasure& measure, std::size_t first, std::size_t second) const;

  const std::vector<Samples>& samples_;
  std::vector<Contest> contests_;
};

}  // namespace delquad
