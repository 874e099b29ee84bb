// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "metrics/tables/result_records.h"

// This header makes the notes of tables. The tables use it.

namespace delquad {

/// Returns a note for each calibrated peer on each case: the change of its size, and whether it has the
/// number of quads. If some meshes miss it, the note has their number and the worst one.
std::vector<std::string> calibration_notes(const std::vector<CellRecord>& records);

/// Returns a note for each pipeline that peers were calibrated to: these peers, and percentages by which
/// other pipelines have more or fewer quads. Pipelines within the peers' tolerance are left out. Returns
/// nothing without calibrated peers.
std::vector<std::string> quad_count_notes(const std::vector<CellRecord>& records);

/// Returns a note for each pipeline that leaves triangles among quads: the number of its cases, up to five of
/// their names, then `consequence`.
std::vector<std::string> triangle_notes(const std::vector<CellRecord>& records,
                                        const std::string& consequence);

/// Returns a note for each pipeline that makes quads in some cases only: the cases without quads.
std::vector<std::string> quadless_notes(const std::vector<CellRecord>& records);

}  // namespace delquad
