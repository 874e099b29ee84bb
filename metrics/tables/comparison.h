#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "metrics/tables/inference.h"
#include "metrics/tables/result_records.h"

namespace delquad {

enum class Verdict {
  kUnchanged,
  kImproved,   ///< as is proven
  kRegressed,  ///< as is proven
  kBetter,     ///< a fact: in every run
  kWorse,      ///< the same
  kNotProven   ///< changed, now the one way, now the other; or it is a time
};

/// One measure of one row (a pipeline on a variant, with every seed), before and after.
struct MeasureChange {
  std::string group, pipeline, metric;
  double before, after;  ///< means over the runs that both have
  std::size_t runs;      ///< pairs of them
  Verdict verdict;
};

/// One measure of one pipeline over all domains that both runs have: "after" is the first of the pair.
struct DomainChange {
  std::string pipeline;
  PairComparison pair;
  Verdict verdict;
};

/// Two runs of an experiment, cell by cell.
struct Comparison {
  std::vector<MeasureChange> changes;      ///< in the order of the rows, then of the metrics asked for
  std::vector<DomainChange> over_domains;  ///< of pipelines with at least six domains
  std::vector<std::string> missing;        ///< cells of the first run that the second lacks, "case pipeline"
  std::vector<std::string> added;          ///< the other way round
  std::vector<std::string> failed;         ///< ran before, failed after, with the reason
  std::vector<std::string> recovered;      ///< failed before, ran after
  std::vector<std::string> failing;        ///< failed both times
  std::string note = {};                   ///< over how many tests was corrected; empty: none
  int count(Verdict verdict) const;        ///< of rows, and over domains
  /// Something got worse: a measure, as is proven or in every run of a row, or a cell that is missing or
  /// failed.
  bool regressed() const {
    return count(Verdict::kRegressed) + count(Verdict::kWorse) + missing.size() + failed.size() > 0;
  }
};

/// Cells are paired by case, variant and seed. A measure has changed if its means differ by more than
/// `tolerance` times the larger magnitude. A value that is no longer defined is worse. Over all
/// domains, where there are six or more, changes are tested as pairs of pipelines are, all of them one
/// family. Throws InputError for a metric that does not exist or of which neither more nor less is better.
/// "seconds" counts as a metric, of which nothing is proven.
Comparison compare_records(const std::vector<CellRecord>& before, const std::vector<CellRecord>& after,
                           const std::vector<std::string>& metrics, double tolerance);

/// For people: what changed, a line each, then the counts.
std::string to_text(const Comparison& comparison);

}  // namespace delquad
