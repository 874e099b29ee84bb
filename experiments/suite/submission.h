#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "delquad/mesher.h"
#include "experiments/suite/suite_list.h"
#include "metrics/tables/table.h"

namespace delquad {

/// Who made the meshes of a folder: its result.toml.
struct Submission {
  std::filesystem::path folder;
  std::string program;  ///< in tables: small letters, digits, - and _
  std::string version, command;
  std::vector<std::string> authors;
};
/// Throws InputError with file and line for what is missing or unknown.
Submission read_submission(const std::filesystem::path& folder);

/// How many of the suite's cases a submission has a good mesh of.
struct SubmissionCount {
  int measured = 0, refused = 0, missing = 0;
  std::vector<std::string> of_no_case;  ///< files of meshes that were not looked at
};

/// Measures the meshes of a submission, NAME_1.msh or NAME_1.obj and so on, and writes them with records to
/// results/PROGRAM, as `delquad run` does for a peer, in place of all that an earlier submission of the
/// program has there. Cases of other models are not run. A mesh that is missing, cannot be read or is not one
/// of its model is a failed cell that says so. `all`: the suite's models that are there, which are written to
/// results/models. Throws InputError
/// when the folder cannot be written to, belongs to a run, or has no mesh of any case.
SubmissionCount add_submission(const Submission& submission, const std::filesystem::path& results,
                               const std::vector<SuiteModel>& models, const std::vector<SuiteModel>& all);

/// Throws PeerError unless the mesh is conforming, has the model's area and lies on it: no place of the model
/// is further from the mesh, and none of the mesh further from the model, than 1.25 times the size there. Of
/// planar domains that is asked of the boundaries. Makes planar meshes run counterclockwise.
void check_is_of_model(const Prepared& prepared, Mesh& mesh);

/// Programs and pipelines on the suite, the best first: all families together but `metric` and
/// `public` (is_for_all()), then each.
///
/// `results`: a folder with results of the suite, one folder for each run or submission. A case counts as
/// solved when its mesh is sound and has quads only. The score of a case is the mean eta times tau times the
/// share of quads, 0 without a sound mesh; that of a model the mean over its cases that were run, that of a
/// program the mean over its models, with its 95 % interval, all in percent. Programs that ran fewer cases
/// than others stand below these. Every two programs of a group are tested by Wilcoxon's signed-rank test
/// over the models that both ran, all of them one family. The other measures are means over the sound
/// meshes, but for the worst eta, which is the least, and the CPU seconds, which are the sum. Cells that are
/// not applicable were not run. A program with nothing else in a group has a row without a rank there, and a
/// note with the reason. Of cases with a metric eta and tau are those in the metric. Throws InputError where
/// there are no results, or results of something else.
Table rank_programs(const std::filesystem::path& results);

/// Writes the table in every format to results/ranking/table.*.
void write_ranking(const std::filesystem::path& results, const Table& table);

}  // namespace delquad
