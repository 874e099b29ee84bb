#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace delquad {

struct Verification {
  std::size_t cells = 0, measured = 0;  ///< records there are; meshes whose measures were taken again
  std::vector<std::string> findings;    ///< what is not as it was written, a line each with the file
};

/// What is not as it was written in a cell, by its record.json: the record by the digest that it carries, and
/// the files that it lists; a line each with the file.
std::vector<std::string> damage_of_cell(const std::filesystem::path& record);

/// Checks a folder of results: records and study.json by the digests that they carry, the files of cells by
/// sizes and digests in the records, the copies of experiments, the measures in records by taking them again
/// of the meshes (those by command excepted), and tables by making them again; names cells that are not
/// there. Where a model is not found, in the copy or below `data`, the measures that need no size are
/// checked. Throws InputError when the folder holds no results.
Verification verify_results(const std::filesystem::path& folder, const std::filesystem::path& data);

}  // namespace delquad
