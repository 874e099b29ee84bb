#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace delquad {

/// What a record says of one cell of an experiment.
struct CellRecord {
  std::string group, pipeline;           ///< the case, and the pipeline run on it
  std::string failure;                   ///< why there are no values; empty: none
  std::map<std::string, double> values;  ///< by metric key, and "seconds"; NaN where not defined
};

/// The records of an experiment below a folder, by path. Throws InputError naming the file that is no record,
/// the cell that is there twice, or the folder that has none.
std::vector<CellRecord> read_records(const std::filesystem::path& folder);

}  // namespace delquad
