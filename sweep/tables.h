#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sweep/table.h"

namespace delquad {

/// What came of the cells of an experiment.
struct Outcome {
  Table table;
  /// Pairs of pipelines over all cases and seeds that both ran on; no rows where there are too few to tell
  /// anything.
  Table pairs;
  long long leftover_triangles = 0;  ///< in cells whose pipeline makes quads
  int bad_inputs = 0, others_failed = 0;
};

/// The tables of an experiment, from the records of its cells and its study.json alone. Cells that differ in
/// nothing but the seed make one row: means, and the half-widths of their 95 % confidence intervals. Throws
/// InputError as read_records() does.
Outcome make_tables(const std::filesystem::path& folder);
/// Writes the tables that have rows in every format; returns what could not be written.
std::vector<std::string> write_tables(const std::filesystem::path& folder, const Outcome& outcome);
/// Every file that it may write.
std::vector<std::string> result_files();

}  // namespace delquad
