#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/cases/case.h"

namespace delquad {

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
