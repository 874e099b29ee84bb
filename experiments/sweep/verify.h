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
  std::size_t cells = 0, measured = 0;  ///< records; meshes that were measured again
  std::vector<std::string> findings;    ///< differences from the records, a line each with the file
  std::string undrawn;                  ///< why figures are not checked; empty: they are, or there are none
};

/// Returns the differences of a cell from its record, a line each with the file. It checks the digest in the
/// record, and the files that it lists. `study` tells records of other problems.
std::vector<std::string> damage_of_cell(const std::filesystem::path& record, const StudyFile& study);

/// Returns the result of checking a folder of results. Records and study.json must fit their digests, and
/// files of cells the sizes and digests in the records. Copies of experiments are checked, meshes measured
/// again (except by command), and tables made again. Missing cells are named. If a model is neither in the
/// copy nor below `data`, only measures without a size are checked. Throws InputError if the folder holds no
/// results.
Verification verify_results(const std::filesystem::path& folder, const std::filesystem::path& data);

struct Rerun {
  bool same_mesh = false;                ///< byte by byte
  std::vector<std::string> differences;  ///< of the inputs: model, options, program, versions
  std::vector<std::string> values;       ///< changed values of the record, except times, a line each
};

/// Runs the cell of a record again, from the copy of the experiment in its folder of results, which may have
/// been moved. `data` is a folder of models that the copy lacks; they are found by name, or anywhere below by
/// name and digest. Throws InputError for a record of no finished cell, a changed copy, and a missing model.
Rerun rerun_record(const std::filesystem::path& record, const std::filesystem::path& data = kDataFolder);

}  // namespace delquad
