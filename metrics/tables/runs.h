// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "metrics/tables/result_records.h"
#include "metrics/tables/study_file.h"

// This header makes runs.csv. The tables use it.

namespace delquad {

/// An experiment's cells as CSV for other programs.
struct RunsCsv {
  std::string lines;    ///< a line for each record: its cell, outcome, all measures and times
  std::string columns;  ///< a line for each column of `lines`: meaning, unit, range, better direction
};
/// Returns the CSV with all digits; values that are not defined are empty.
RunsCsv runs_csv(const StudyFile& study, const std::vector<CellRecord>& records);

}  // namespace delquad
