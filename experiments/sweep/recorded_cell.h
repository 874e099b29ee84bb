// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "experiments/sweep/experiment.h"

// This header reads cells from their records. The commands `rerun`, `verify` and `mesh` use it.

namespace delquad {

/// Reads a record. Throws InputError for another file or version.
nlohmann::ordered_json read_record_file(const std::filesystem::path& file);

/// A cell as its record has it.
struct RecordedCell {
  Case c;
  Experiment experiment;  ///< with its pipeline only, and with its peers and measures
  bool is_of_experiment;  ///< else 'delquad mesh --json' wrote the record
};

/// Returns the cell of a record. Files of models and sizes are found by name and digest: at their place, in
/// the copies of the folder of results, or anywhere below `data`. Peers and measures run the programs in the
/// copies. Throws InputError for a missing file, and for functions or meshes in memory.
RecordedCell recorded_cell(const nlohmann::ordered_json& record, const std::filesystem::path& file,
                           const std::filesystem::path& data = {});

/// Returns the folder of the results that a cell's record belongs to.
std::filesystem::path results_of(const std::filesystem::path& record_file);

}  // namespace delquad
