// SPDX-License-Identifier: GPL-3.0-or-later
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

// This header tests claims of a study. Its tables and reports use it.

namespace delquad {

/// Fewer domains prove nothing at 5 % by Wilcoxon's test [wilcoxon1945].
inline constexpr std::size_t kFewestDomains = 6;

/// Comparison of two pipelines, or of two values of an axis, in a measure, over common domains.
struct PairComparison {
  std::string first, second;
  Metric metric;
  PairedDomains domains;                  ///< first minus second
  std::optional<Interval> interval = {};  ///< interval of the mean, over domains where neither failed
  std::size_t test = 0;                   ///< index in its family of Wilcoxon's test over domains

  /// Returns "DB failed on 2 domains, PB on 1"; empty: neither failed.
  std::string failures() const;
};

/// All claims of a study's tables. One family of tests has all pairs of pipelines, or the hypotheses; see
/// docs/statistics.md.
class Inference {
 public:
  /// `records` must outlive it.
  Inference(const StudyFile& study, const std::vector<CellRecord>& records);
  Inference(const Inference&) = delete;
  Inference& operator=(const Inference&) = delete;

  /// Returns the tests of pairs, which are exploratory if the study has hypotheses.
  const ClaimFamily& family() const { return family_; }
  /// Returns every two pipelines with at least two common domains, in every measure, and values of requested
  /// axes. Pipelines that leave triangles have no measures of quads. Unsound meshes count.
  const std::vector<PairComparison>& pairs() const { return pairs_; }
  /// Returns the tests of hypotheses.
  const ClaimFamily& planned() const { return planned_; }
  /// Returns a test for each measure of each hypothesis, in order, even without data.
  const std::vector<PairComparison>& hypotheses() const { return hypotheses_; }
  /// Returns whether the first is proven to be better or worse: by the test, and by an interval on the same
  /// side of 0. If a study has hypotheses, only they are proven.
  std::optional<bool> first_is_better(const PairComparison& pair) const;

 private:
  ClaimFamily family_, planned_;
  std::vector<PairComparison> pairs_, hypotheses_;
};

/// Returns the same within a family.
std::optional<bool> first_is_better(const PairComparison& pair, const ClaimFamily& family);

/// Returns a row for each pair: domains and runs, and domains on which the first is better or worse and each
/// has failed. Then come the mean of the domains with its 95 % interval, p-values, and the finding.
Table pairs_table(const std::string& title, const Inference& inference);
/// Returns the same rows for hypotheses.
Table hypotheses_table(const std::string& title, const Inference& inference);

/// Returns the measures in which pairs are compared.
std::vector<Metric> compared_measures(const StudyFile& study, const std::vector<CellRecord>& records);
/// Returns the range of values of a built-in measure.
Interval range_of(const std::string& key);
/// Returns the columns of the study's table. They are the number of runs, the measures of the paper's tables,
/// the study's own measures, other measures in its columns, and times.
std::vector<TableColumn> table_columns(const StudyFile& study, const std::vector<CellRecord>& records);

}  // namespace delquad
