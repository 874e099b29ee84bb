#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "metrics/tables/result_records.h"
#include "metrics/tables/study_file.h"
#include "metrics/tables/table.h"

namespace delquad {

/// Folder of the figures in a folder of results: see draw_figures().
inline constexpr const char* kFigures = "figures";

/// What came of the cells of an experiment.
struct Outcome {
  Table table;
  /// Pairs of pipelines over the domains that both ran on; no rows where they have fewer than two in common.
  Table pairs;
  Table summary = {};     ///< see summarise(); no rows where there are fewer than two domains
  Table hypotheses = {};  ///< of the experiment, and what became of them; no rows where it has none
  /// By name, with their texts: every run with what its columns mean, tables as they are printed with the
  /// works that their captions cite.
  std::map<std::string, std::string> files = {};
  long long leftover_triangles = 0;                    ///< in cells whose pipeline makes quads only
  int bad_inputs = 0, unsound = 0, others_failed = 0;  ///< cells that failed, and may not
  long long metrics_failed = 0;  ///< cells with a mesh, in which a measure by command failed
  /// These numbers in words: by reason the cells, or none.
  std::map<std::string, std::vector<std::string>> failures = {};
  std::map<std::string, std::vector<std::string>> inapplicable =
      {};  ///< by reason, cells that have not failed
};
/// A line for each reason in Outcome::inapplicable.
std::vector<std::string> inapplicable_notes(const Outcome& outcome);

/// The records of an experiment's cells, and what it consists of.
struct StudyResults {
  StudyFile study;
  std::vector<CellRecord> records;  ///< by place
  std::size_t left_out = 0;         ///< records of cells that the experiment no longer has
};
/// Throws InputError as read_records() does, and where the folder has no study.json.
StudyResults read_results(const std::filesystem::path& folder);

/// The tables of an experiment, from the records of its cells and its study.json alone. Cells that differ in
/// nothing but the seed make one row: means, and the half-widths of their 95 % confidence intervals. They
/// call better only that which is proven, see docs/statistics.md.
Outcome make_tables(const StudyResults& results);
/// Throws InputError as read_results() does.
Outcome make_tables(const std::filesystem::path& folder);
/// Writes the tables that have rows and the files; returns the errors. The first table comes in
/// every format, others as Markdown and CSV: tables.tex has them for print. Removes files of earlier runs
/// that this one has not.
std::vector<std::string> write_tables(const std::filesystem::path& folder, const Outcome& outcome);
/// Every name that an experiment itself takes in the folder of its results.
std::vector<std::string> result_files();

}  // namespace delquad
