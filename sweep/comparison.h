#pragma once

#include <string>
#include <vector>

#include "sweep/result_records.h"

namespace delquad {

enum class Verdict { kUnchanged, kImproved, kRegressed };

/// One measure of one cell, before and after.
struct MeasureChange {
  std::string group, pipeline, metric;
  double before, after;
  Verdict verdict;
};

/// Two runs of an experiment, cell by cell.
struct Comparison {
  std::vector<MeasureChange> changes;  ///< in the order of the cells, then of the metrics asked for
  std::vector<std::string> missing;    ///< cells of the first run that the second lacks, "case pipeline"
  std::vector<std::string> added;      ///< the other way round
  std::vector<std::string> failed;     ///< ran before, failed after, with the reason
  std::vector<std::string> recovered;  ///< failed before, ran after
  std::vector<std::string> failing;    ///< failed both times
  int count(Verdict verdict) const;
  /// Something got worse: a measure, or a cell that is missing or failed.
  bool regressed() const { return count(Verdict::kRegressed) + missing.size() + failed.size() > 0; }
};

/// A measure has changed when it differs by more than `tolerance` times the larger of both magnitudes; a
/// value that is no longer defined is a regression. Throws InputError for a metric that does not exist or of
/// which neither more nor less is better. "seconds" counts as a metric.
Comparison compare_records(const std::vector<CellRecord>& before, const std::vector<CellRecord>& after,
                           const std::vector<std::string>& metrics, double tolerance);

/// For people: what changed, a line each, then the counts.
std::string to_text(const Comparison& comparison);

}  // namespace delquad
