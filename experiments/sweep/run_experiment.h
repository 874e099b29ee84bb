// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "experiments/console/progress.h"
#include "experiments/sweep/experiment.h"
#include "experiments/sweep/process_tree.h"
#include "metrics/tables/tables.h"

// This header runs the cells of an experiment. The program and the bench use it.

namespace delquad {

/// One of several runs that share an experiment and its folder.
struct Shard {
  std::size_t index = 0, count = 1;  ///< index < count
};

struct SweepOptions {
  ProcessLimits limits = {};
  Shard shard = {};
  bool force = false;          ///< run finished cells again
  bool allow_unsound = false;  ///< unsound meshes are results, with a mark
  bool pictures = true;        ///< write SVG pictures of meshes, and fields.vtu
  PlaceInQueue place = {};
};

/// Runs every pipeline on every variant of every case, each in a separate process, and returns the tables. If
/// a process crashes, hangs or exceeds its memory, its cell has failed, and the rest continues. Pipelines
/// share common first stages. A cell is left out if its result exists, made by the same program from the same
/// model and options. Failed cells run again.
///
/// Writes DIR/study.json, the tables (see tables.h) and
/// DIR/<case>/<pipeline>/{mesh.msh, mesh.vtu, picture.svg, fields.vtu, record.json}. With a matrix, <case>
/// contains the varied values. The experiment is copied, see keep_experiment(). Files of a cell appear
/// together, its record last. If the run is killed, finished cells stay, and no unfinished ones. The table
/// names files that cannot be written.
///
/// Throws InputError if the folder cannot be written to, holds the results of another experiment, or belongs
/// to another run that has not ended.
Outcome run_experiment(const Experiment& experiment, const std::filesystem::path& folder,
                       const SweepOptions& options = {});

/// Returns the other experiment whose results the folder holds, as a reason; empty: none.
std::string why_folder_is_refused(const Experiment& experiment, const std::filesystem::path& folder);

/// Returns whether the folder had records before its plan was made, or has another plan than `study`.
bool is_plan_changed(const StudyFile& study, const std::filesystem::path& folder);

/// Returns the expected seconds of the missing cells with two jobs, by the minutes of the experiment; nothing
/// if it has none.
std::optional<double> expected_seconds(const Experiment& experiment, const std::filesystem::path& folder);

/// Returns the cells in order, a line each, with their states as in state_of_cell(), or "data not found".
std::string list_cells(const Experiment& experiment, const std::filesystem::path& folder);
/// Returns the same with the expected time of the run, by records in the folder, and the claims that it could
/// prove. An empty folder has no records; a warning tells if the folder is of another experiment. Throws
/// InputError as check_hypotheses().
std::string dry_run(const Experiment& experiment, const std::filesystem::path& folder);

}  // namespace delquad
