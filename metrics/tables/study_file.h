// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// This header has the description of an experiment, study.json. Tables, the bench and reports use it.

namespace delquad {

/// Returns a message on an unreadable file of results, from an exception of the JSON parser. It is
/// "FILE:LINE:COLUMN: WHAT: why" for invalid JSON, and "FILE: WHAT: why" for unexpected content. `what` is a
/// text such as "is no record of a cell"; empty: left out.
std::string json_problem(const std::filesystem::path& file, const std::string& what,
                         const std::exception& error);

/// A row of a published table.
struct PublishedRow {
  std::string name, source;
  std::map<std::string, double> values;  ///< by metric key
};

/// A column with the time of a step.
struct StepTime {
  const char *key, *title;
  const char* step;  ///< name in records; empty: all of these together
};
/// Returns the columns of times, in order.
const std::vector<StepTime>& step_times_of_tables();

/// A claim that is fixed before the run: [[hypotheses]].
struct Hypothesis {
  std::string along;                  ///< title of the axis whose values are compared; empty: pipelines
  std::string better, than;           ///< pipelines, or values of that axis
  std::vector<std::string> measures;  ///< keys; each is a test
  bool operator==(const Hypothesis&) const = default;
};

/// Cells that may fail, as declared in [[may_fail]].
struct MayFail {
  std::string name, variant, pipeline;  ///< of the case and of the [[variant]]; empty: any
  bool operator==(const MayFail&) const = default;
};

/// An experiment's entries for its tables.
struct TablePlan {
  std::string title;
  std::vector<PublishedRow> published;
  bool step_times = false;           ///< the table has a column for the time of each step
  std::vector<std::string> columns;  ///< columns in Markdown and LaTeX, by key; empty: all
  std::vector<std::string> pairs;    ///< titles of axes whose values are compared like pipelines
  std::vector<Hypothesis> hypotheses;
  std::vector<MayFail> may_fail;
};

/// Identity of a geometry: the digest, or the shape within the accuracy of chords.
struct CaseGeometry {
  std::string domain;         ///< declared domain; empty: by geometry
  std::string digest;         ///< digest of the model's file, only of its geometry; empty: none
  std::vector<double> shape;  ///< moments; empty: not known
  double chord_error = 0;     ///< part of length or area that chords of curves may have cut off
};

/// Cells of an experiment.
struct StudyCells {
  std::string experiment;  ///< name of its file, without folder and extension
  /// Digests of problems by folder of the variant: one, or more after folders were merged.
  std::map<std::string, std::vector<std::string>> problems;
  std::vector<std::string> cases, pipelines;
  /// Axes in order, with their values.
  std::vector<std::pair<std::string, std::vector<std::string>>> axes;
  std::map<std::string, CaseGeometry> geometry;  ///< by case
  std::string plan;       ///< digest of everything that determines results, without the order of cases
  std::size_t cells = 0;  ///< number of cells of the experiment
  /// Name of the published row by case and pipeline.
  std::map<std::string, std::map<std::string, std::string>> compare;
  bool plan_changed = false;  ///< changed after the first record existed
};

/// Description of an experiment in its folder of results: study.json, beside the records of cells.
struct StudyFile : TablePlan, StudyCells {};
/// Note of tables in that case.
inline constexpr const char* kNotPlanned =
    "Not planned: hypotheses, cases, models, options or pipelines were changed after the first mesh was "
    "made.";
/// Returns whether both have the same plan, or no hypotheses.
bool have_same_plan(const StudyFile& a, const StudyFile& b);
/// Returns the domain of each case: a declared one, the domain of an earlier case with the same geometry, or
/// its own.
std::map<std::string, std::string> domains_of(const StudyFile& study);

/// Returns value `i` of an axis as part of a folder's name. Unsuitable characters become `_`; long or
/// ambiguous texts become a digest.
std::string folder_text(const std::vector<std::string>& values, std::size_t i);

/// Throws InputError if it cannot be written.
void write_study(const std::filesystem::path& folder, const StudyFile& study);
/// Returns nothing if there is none. Throws InputError for another file or version.
std::optional<StudyFile> read_study(const std::filesystem::path& folder);

/// Address of a cell in an experiment.
struct CellAddress {
  std::string name;                                          ///< name of the case
  std::vector<std::pair<std::string, std::string>> variant;  ///< values of axes by title
  std::string pipeline;
};
/// Returns whether the cell is one of the cells that may fail.
bool is_one_of(const MayFail& cells, const CellAddress& cell);
bool may_fail(const TablePlan& plan, const CellAddress& cell);
/// Returns the indices of the cell's case, variant and pipeline in the experiment; nothing if it is not
/// there.
std::optional<std::array<std::size_t, 3>> place_of(const StudyFile& study, const CellAddress& cell);
/// Returns the cell with results in the folder of this name ("disc@seed=2"), with this pipeline; nothing if
/// the experiment has none.
std::optional<CellAddress> find_cell(const StudyFile& study, const std::string& folder,
                                     const std::string& pipeline);

}  // namespace delquad
