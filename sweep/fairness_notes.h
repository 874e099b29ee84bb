#pragma once

#include <string>
#include <vector>

#include "sweep/result_records.h"

namespace delquad {

/// What tables and pairs say where pipelines are not compared like with like: which leave triangles, and in
/// which cases, and by how much the numbers of quads of our own words differ where other meshers were brought
/// to that of one of them.
std::vector<std::string> fairness_notes(const std::vector<CellRecord>& records);

}  // namespace delquad
