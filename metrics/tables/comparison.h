// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "metrics/tables/inference.h"
#include "metrics/tables/result_records.h"

// This header compares two runs of an experiment. The program uses it.

namespace delquad {

enum class Verdict {
  kUnchanged,
  kImproved,   ///< proven
  kRegressed,  ///< proven
  kBetter,     ///< better in every run
  kWorse,      ///< worse in every run
  kNotProven   ///< changed in both directions, or a time
};

/// Change of a measure in a row: a pipeline on a variant, with all seeds.
struct MeasureChange {
  std::string group, pipeline, metric;
  double before, after;  ///< means over the runs of both
  std::size_t runs;      ///< number of pairs
  Verdict verdict;
};

/// Change of a measure of a pipeline over all common domains; "after" is the first of the pair.
struct DomainChange {
  std::string pipeline;
  PairComparison pair;
  Verdict verdict;
};

/// Two runs of an experiment, compared cell by cell.
struct Comparison {
  std::vector<MeasureChange> changes;      ///< in the order of rows, then of requested metrics
  std::vector<DomainChange> over_domains;  ///< for pipelines with at least six domains
  std::vector<std::string> missing;  ///< cells of the first run without match in the second, "case pipeline"
  std::vector<std::string> added;    ///< cells of the second run without match in the first
  std::vector<std::string> failed;   ///< ran before, failed after, with the reason
  std::vector<std::string> recovered;  ///< failed before, ran after
  std::vector<std::string> failing;    ///< failed both times
  std::string note = {};               ///< number of tests in the correction; empty: none
  int count(Verdict verdict) const;    ///< counts rows, and changes over domains
  /// Returns whether something got worse: a measure (proven, or in every run of a row), or a missing or
  /// failed cell.
  bool regressed() const {
    return count(Verdict::kRegressed) + count(Verdict::kWorse) + missing.size() + failed.size() > 0;
  }
};

/// Returns the comparison of records, with cells paired by case, variant and seed. A measure has changed if
/// its means differ by more than `tolerance`, at least 0, times the larger magnitude. A value that is no
/// longer defined is worse. Over six domains or more, changes are tested like pairs of pipelines, as one
/// family. Throws InputError for an unknown metric, or one for which neither direction is better. "seconds"
/// counts as a metric without proofs.
Comparison compare_records(const std::vector<CellRecord>& before, const std::vector<CellRecord>& after,
                           const std::vector<std::string>& metrics, double tolerance);

/// Returns the changes, a line each, and the counts.
std::string to_text(const Comparison& comparison);

}  // namespace delquad
