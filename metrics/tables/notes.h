#pragma once

#include <string>
#include <vector>

#include "metrics/tables/result_records.h"

namespace delquad {

/// What tables say of peers that were calibrated: for each of them on each case, by how much the size was
/// changed and how close the number of quads came; where some runs missed it, how many and the worst.
std::vector<std::string> calibration_notes(const std::vector<CellRecord>& records);

/// To which word's number of quads which peers were brought, and how many more or fewer the words have that
/// were not, where that is more than peers may miss. Nothing where no peer was calibrated.
std::vector<std::string> quad_count_notes(const std::vector<CellRecord>& records);

/// For each word that leaves triangles among its quads: on how many of its cases and on which (five at most
/// by name), then `consequence`.
std::vector<std::string> triangle_notes(const std::vector<CellRecord>& records,
                                        const std::string& consequence);

/// For each word that makes quads, but not everywhere: where it made none.
std::vector<std::string> quadless_notes(const std::vector<CellRecord>& records);

}  // namespace delquad
