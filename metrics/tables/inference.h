#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "delquad/metrics.h"
#include "metrics/tables/samples.h"
#include "metrics/tables/statistics.h"
#include "metrics/tables/study_file.h"
#include "metrics/tables/table.h"

namespace delquad {

/// With fewer domains Wilcoxon's test can prove nothing at 5 %.
inline constexpr std::size_t kFewestDomains = 6;

/// Two pipelines, or two values of an axis, in one measure, over their common domains.
struct PairComparison {
  std::string first, second;
  Metric metric;
  PairedDomains domains;                  ///< first minus second
  std::optional<Interval> interval = {};  ///< of the mean, over the domains on which neither has failed
  std::size_t test = 0;                   ///< of its family: Wilcoxon's over the domains

  /// "DB failed on 2 domains, PB on 1"; empty: neither has.
  std::string failures() const;
};

/// Everything that the tables of a study may claim. Either all pairs of its pipelines are one family of
/// tests, or its hypotheses are. See docs/statistics.md.
class Inference {
 public:
  /// `records` have to outlive it.
  Inference(const StudyFile& study, const std::vector<CellRecord>& records);
  Inference(const Inference&) = delete;
  Inference& operator=(const Inference&) = delete;

  /// The tests of the pairs, which are explored where the study has hypotheses.
  const ClaimFamily& family() const { return family_; }
  /// Every two pipelines that share two domains or more, in every measure, and values of the axes that the
  /// study asks for. Measures of quads leave out pipelines that leave triangles. Unsound meshes count as they
  /// are.
  const std::vector<PairComparison>& pairs() const { return pairs_; }
  /// The tests of the hypotheses.
  const ClaimFamily& planned() const { return planned_; }
  /// A test for each measure of each hypothesis, in their order, whatever there is to test.
  const std::vector<PairComparison>& hypotheses() const { return hypotheses_; }
  /// Whether the first is proven to be better, or worse: by the test, and by an interval without 0 on the
  /// same side. A study with hypotheses proves them alone.
  std::optional<bool> first_is_better(const PairComparison& pair) const;

 private:
  ClaimFamily family_, planned_;
  std::vector<PairComparison> pairs_, hypotheses_;
};

/// The same in a family.
std::optional<bool> first_is_better(const PairComparison& pair, const ClaimFamily& family);

/// A row for each pair: domains and runs, and on how many domains the first is better and worse and each has
/// failed. Then the mean of the domains with its 95 % interval, p-values, and what is proven, in words.
Table pairs_table(const std::string& title, const Inference& inference);
/// The same of what was planned.
Table hypotheses_table(const std::string& title, const Inference& inference);

/// The measures that pairs are compared by.
std::vector<Metric> compared_measures(const StudyFile& study, const std::vector<CellRecord>& records);
/// What no value of a measure of the project's own can leave.
Interval range_of(const std::string& key);
/// Returns the columns of the study's table. They are the number of runs, the measures of the paper's tables,
/// the study's own measures, other measures in its columns, and times.
std::vector<TableColumn> table_columns(const StudyFile& study, const std::vector<CellRecord>& records);

}  // namespace delquad
