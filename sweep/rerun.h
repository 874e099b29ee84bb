#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace delquad {

struct Rerun {
  bool same_mesh = false;                ///< byte for byte
  std::vector<std::string> differences;  ///< in what determines it: model, options, program, versions
};

/// Makes the cell of a record again, from the experiment's file. Throws InputError when the file is no record
/// of a cell that was done, or the experiment no longer has it.
Rerun rerun_record(const std::filesystem::path& record);

}  // namespace delquad
