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

namespace delquad {

/// What is wrong with a file of results, for people, by what reading its JSON has thrown: "FILE:LINE:COLUMN:
/// WHAT: why" where it is no JSON, "FILE: WHAT: why" where another thing was expected in it. `what`: such as
/// "is no record of a cell"; empty: nothing is said there.
std::string json_problem(const std::filesystem::path& file, const std::string& what,
                         const std::exception& error);

/// A row of a published table.
struct PublishedRow {
  std::string name, source;
  std::map<std::string, double> values;  ///< by metric key
};

/// The column of a table that shows how long a step took.
struct StepTime {
  const char *key, *title;
  const char* step;  ///< as records call it; empty: all of these together
};
const std::vector<StepTime>& step_times_of_tables();

/// A claim that is fixed before the run: [[hypotheses]].
struct Hypothesis {
  std::string along;                  ///< title of the axis whose values are compared; empty: pipelines
  std::string better, than;           ///< pipelines, or values of that axis
  std::vector<std::string> measures;  ///< keys; each is a test
  bool operator==(const Hypothesis&) const = default;
};

/// Cells that may fail, as an experiment declares them: [[may_fail]].
struct MayFail {
  std::string name, variant, pipeline;  ///< of the case and of the [[variant]]; empty: any
  bool operator==(const MayFail&) const = default;
};

/// What an experiment says of its tables.
struct TablePlan {
  std::string title;
  std::vector<PublishedRow> published;
  bool step_times = false;           ///< the table has a column for each step's time
  std::vector<std::string> columns;  ///< of tables in Markdown and LaTeX, by key; empty: all
  std::vector<std::string> pairs;    ///< titles of axes whose values are compared as pipelines are
  std::vector<Hypothesis> hypotheses;
  std::vector<MayFail> may_fail;
};

/// Geometries are the same if their digests are equal, or if their shapes agree as far as chords let them.
struct CaseGeometry {
  std::string domain;         ///< what the case says; empty: the geometry tells
  std::string digest;         ///< of the model's file, without what is no geometry; empty: there is none
  std::vector<double> shape;  ///< moments; empty: not known
  double chord_error = 0;     ///< part of its length or area that chords of curves may have cut off
};

/// The cells of an experiment.
struct StudyCells {
  std::string experiment;  ///< name of its file, without folder and extension
  /// Digests of problems, by the folder of the variant: one, or more after folders were merged.
  std::map<std::string, std::vector<std::string>> problems;
  std::vector<std::string> cases, pipelines;
  /// What varies, in its order, with its values.
  std::vector<std::pair<std::string, std::vector<std::string>>> axes;
  std::map<std::string, CaseGeometry> geometry;  ///< by case
  std::string plan;       ///< digest of all that determines the results, but for the order of cases
  std::size_t cells = 0;  ///< that the experiment has
  /// case -> pipeline -> name of the published row beside it
  std::map<std::string, std::map<std::string, std::string>> compare;
  bool plan_changed = false;  ///< after the first record was there
};

/// The description of an experiment in its folder of results, beside the records of its cells: study.json.
struct StudyFile : TablePlan, StudyCells {};
/// What tables say then.
inline constexpr const char* kNotPlanned =
    "Not planned: hypotheses, cases, models, options or pipelines were changed after the first mesh was "
    "made.";
/// Whether two have the same plan, or both no hypotheses.
bool have_same_plan(const StudyFile& a, const StudyFile& b);
/// By case, the domain that it counts as: it says one, or an earlier case has the same geometry, or it is one
/// by itself.
std::map<std::string, std::string> domains_of(const StudyFile& study);

/// Value `i` of those of an axis, as it stands in the name of a folder: what might not stand there is
/// replaced by `_`, and long or doubtful texts by a digest.
std::string folder_text(const std::vector<std::string>& values, std::size_t i);

/// Throws InputError when it cannot be written.
void write_study(const std::filesystem::path& folder, const StudyFile& study);
/// Nothing when there is none; throws InputError when it is no such file, or of another version.
std::optional<StudyFile> read_study(const std::filesystem::path& folder);

/// Which cell of an experiment.
struct CellAddress {
  std::string name;                                          ///< of the case
  std::vector<std::pair<std::string, std::string>> variant;  ///< what varies, by title, with its value
  std::string pipeline;
};
/// Whether the cell is one of those that may fail.
bool is_one_of(const MayFail& cells, const CellAddress& cell);
bool may_fail(const TablePlan& plan, const CellAddress& cell);
/// Where the cell stands among those of the experiment: case, variant and pipeline. Nothing: it has none
/// such.
std::optional<std::array<std::size_t, 3>> place_of(const StudyFile& study, const CellAddress& cell);
/// The cell whose results lie in the folder of this name ("disc@seed=2"), with this pipeline; nothing where
/// the experiment has none such.
std::optional<CellAddress> find_cell(const StudyFile& study, const std::string& folder,
                                     const std::string& pipeline);

}  // namespace delquad
