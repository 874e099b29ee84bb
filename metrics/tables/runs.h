#pragma once

#include <string>
#include <vector>

#include "metrics/tables/result_records.h"
#include "metrics/tables/study_file.h"

namespace delquad {

/// The cells of an experiment for other programs, and what is in them.
struct RunsCsv {
  std::string lines;    ///< one for each record: what it is of, what came of it, every measure and time
  std::string columns;  ///< one for each column of `lines`: meaning, unit, range, which way is better
};
/// With all digits; empty where a value is not defined.
RunsCsv runs_csv(const StudyFile& study, const std::vector<CellRecord>& records);

}  // namespace delquad
