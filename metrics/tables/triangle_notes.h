#pragma once

#include <string>
#include <vector>

#include "metrics/tables/result_records.h"

namespace delquad {

/// For each word that leaves triangles among its quads: on how many of its cases and on which (five at most
/// by name), then `consequence`.
std::vector<std::string> triangle_notes(const std::vector<CellRecord>& records,
                                        const std::string& consequence);

/// For each word that makes quads, but not everywhere: where it made none.
std::vector<std::string> quadless_notes(const std::vector<CellRecord>& records);

}  // namespace delquad
