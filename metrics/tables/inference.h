#pragma once

#include <vector>

#include "metrics/tables/marks.h"
#include "metrics/tables/pairs.h"
#include "metrics/tables/study_file.h"

namespace delquad {

/// Everything that the tables of a study may claim: one family of tests, of the marks in its table and of the
/// pairs of its pipelines. See docs/statistics.md.
class Inference {
 public:
  /// `records` have to outlive it.
  Inference(const StudyFile& study, const std::vector<CellRecord>& records);
  Inference(const Inference&) = delete;
  Inference& operator=(const Inference&) = delete;

  const std::vector<Samples>& samples() const { return samples_; }
  const ClaimFamily& family() const { return family_; }
  const Marking& marking() const { return marking_; }
  const std::vector<PairComparison>& pairs() const { return pairs_; }

 private:
  std::vector<Samples> samples_;
  ClaimFamily family_;
  Marking marking_;
  std::vector<PairComparison> pairs_;
};

/// Its columns: of how many runs, what the paper's tables show, measures of the study's own, those that it
/// asks for, and times.
std::vector<TableColumn> table_columns(const StudyFile& study, const std::vector<CellRecord>& records);
/// The key under which tables show the time of a run: of the stages alone, or of all steps.
const char* time_key(const StudyFile& study);
/// Of the least of repeated runs.
inline constexpr const char* kLeastTime = "seconds_least";

}  // namespace delquad
