#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "metrics/tables/result_records.h"

namespace delquad {

/// Times of a cell that was run again and again.
struct CellTimes {
  std::string pipeline;
  std::string key;  ///< of the cell: what its result depends on
  /// One for each run, by key: "seconds", as in records, and "seconds_total"; of peers the latter alone.
  std::map<std::string, std::vector<double>> seconds;
  std::string failure = {};  ///< why there are none; empty: there are
};

/// DIR/<case>/times.json: the times of all pipelines on one variant of a case, run in changing order.
struct VariantTimes {
  int repetitions = 0;
  double load_before = 0, load_after = 0;  ///< processes that want to run, averaged over a minute
  std::vector<CellTimes> cells;
};

/// Throws InputError when it cannot be written.
void write_times(const std::filesystem::path& folder, const VariantTimes& times);
/// Nothing where there is none; throws InputError for a file that is damaged.
std::optional<VariantTimes> read_times(const std::filesystem::path& folder);

/// Gives each record the times of its cell. Returns what is wrong with files of times that are there: damaged
/// ones, and times of other cells than those of the records.
std::vector<std::string> attach_times(std::vector<CellRecord>& records);

}  // namespace delquad
