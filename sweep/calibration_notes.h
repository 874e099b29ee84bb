#pragma once

#include <string>
#include <vector>

#include "sweep/result_records.h"

namespace delquad {

/// What tables say of peers that were calibrated: for each row, by how much the size was changed and how
/// close the number of quads came.
std::vector<std::string> calibration_notes(const std::vector<CellRecord>& records);

}  // namespace delquad
