#pragma once

#include <string>
#include <vector>

#include "metrics/tables/result_records.h"

namespace delquad {

/// A note for each calibrated peer on each case: by how much its size was changed, and whether it has the
/// number of quads. Where some meshes miss it, the note has their number and the worst.
std::vector<std::string> calibration_notes(const std::vector<CellRecord>& records);

/// For each word that peers were brought to: these peers, and by how many percent other words have more quads
/// or fewer. Words as near as peers have to be are left out. Nothing where no peer was calibrated.
std::vector<std::string> quad_count_notes(const std::vector<CellRecord>& records);

/// For each word that leaves triangles among its quads: on how many of its cases and on which (five at most
/// by name), then `consequence`.
std::vector<std::string> triangle_notes(const std::vector<CellRecord>& records,
                                        const std::string& consequence);

/// For each word that makes quads, but not everywhere: where it made none.
std::vector<std::string> quadless_notes(const std::vector<CellRecord>& records);

}  // namespace delquad
