// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "io/cases/case.h"
#include "metrics/tables/study_file.h"

// This header verifies results and makes them again. The commands `verify`, `rerun` and `merge` use it.

namespace delquad {

struct Verification {
  std::size_t cells = 0, measured = 0;  ///< records there are; meshes whose measures were taken again
  std::vector<std::string> findings;    ///< what is not as it was written, a line each with the file
  std::string undrawn;                  ///< why figures are not checked; empty: they are, or there are none
};

/// Returns what is not as it was written in a cell, a line each with the file. It checks the record by the
/// digest that it carries, and the files that it lists. `study` tells records of other problems.
std::vector<std::string> damage_of_cell(const std::filesystem::path& record, const StudyFile& study);

/// Checks a folder of results. Records and study.json must fit the digests that they carry, and files of
/// cells the sizes and digests in the records. It checks the copies of experiments, takes the measures of
/// meshes again (except by command), and makes tables again. It names cells that are not there. If a model is
/// not found, in the copy or below `data`, the measures that need no size are checked. Throws InputError if
/// the folder holds no results.
Verification verify_results(const std::filesystem::path& folder, const std::filesystem::path& data);

struct Rerun {
  bool same_mesh = false;                ///< byte for byte
  std::vector<std::string> differences;  ///< in what determines it: model, options, program, versions
  std::vector<std::string> values;       ///< of the record, times excepted, that are others now, a line each
};

/// Makes the cell of a record again, from the copy of the experiment in its folder of results: that folder
/// may have been moved. `data`: where models lie that are no part of the copy; they are found by their names,
/// or anywhere below by name and digest. Throws InputError when the file is no record of a cell that was
/// done, the copy was changed, or a model is not there.
Rerun rerun_record(const std::filesystem::path& record, const std::filesystem::path& data = kDataFolder);

}  // namespace delquad
