// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "metrics/tables/result_records.h"
#include "metrics/tables/study_file.h"
#include "metrics/tables/table.h"

// This header makes the tables of an experiment. The bench, the program and reports use it.

namespace delquad {

/// Folder of figures in a folder of results, see draw_figures().
inline constexpr const char* kFigures = "figures";

/// Result of an experiment.
struct Outcome {
  Table table;
  /// Pairs of pipelines over common domains; no rows for fewer than two domains.
  Table pairs;
  Table summary = {};     ///< see summarise(); no rows for fewer than two domains
  Table hypotheses = {};  ///< hypotheses of the experiment and their findings; no rows without any
  /// Texts of files by name: all runs with the meaning of columns, printed tables, and the references of
  /// their captions.
  std::map<std::string, std::string> files = {};
  long long leftover_triangles = 0;                    ///< in cells whose pipeline makes only quads
  int bad_inputs = 0, unsound = 0, others_failed = 0;  ///< cells that failed unexpectedly
  long long metrics_failed = 0;  ///< cells with a mesh, in which a measure by command failed
  /// Failed cells by reason.
  std::map<std::string, std::vector<std::string>> failures = {};
  std::map<std::string, std::vector<std::string>> inapplicable =
      {};  ///< cells that are not applicable and did not fail, by reason
};
/// Returns a line for each reason in Outcome::inapplicable.
std::vector<std::string> inapplicable_notes(const Outcome& outcome);

/// Records of an experiment's cells, with its description.
struct StudyResults {
  StudyFile study;
  std::vector<CellRecord> records;  ///< by place
  std::size_t left_out = 0;         ///< records of cells that the experiment no longer has
};
/// Reads study.json and the records. Throws InputError as read_records(), and for a folder without
/// study.json.
StudyResults read_results(const std::filesystem::path& folder);

/// Returns the tables of an experiment from records and study.json only. Cells that differ only in the seed
/// make one row, with means and half-widths of their 95 % confidence intervals. Only proven differences count
/// as better, see docs/statistics.md.
Outcome make_tables(const StudyResults& results);
/// Does the same for a folder. Throws InputError as read_results().
Outcome make_tables(const std::filesystem::path& folder);
/// Writes tables with rows and the files, and returns the errors. The first table has every format, others
/// Markdown and CSV; tables.tex has them for print. Removes files of earlier runs that this one does not
/// have.
std::vector<std::string> write_tables(const std::filesystem::path& folder, const Outcome& outcome);
/// Returns all names that an experiment uses in its folder of results.
std::vector<std::string> result_files();

}  // namespace delquad
