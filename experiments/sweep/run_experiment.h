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
  bool force = false;          ///< run cells again that are done
  bool allow_unsound = false;  ///< meshes that are not sound are results, marked as such
  bool pictures = true;        ///< of meshes, as SVG, and fields.vtu
  PlaceInQueue place = {};
};

/// Runs every pipeline on every variant of every case, each in a process of its own. If one crashes, hangs or
/// uses up its memory, its cell has failed, and the rest goes on. Pipelines that begin alike share their
/// common stages. A cell is left out if its result is there already, made by the same program from the same
/// model and options. Cells that failed are tried again.
///
/// Writes DIR/study.json, the tables (see tables.h) and
/// DIR/<case>/<pipeline>/{mesh.msh, mesh.vtu, picture.svg, fields.vtu, record.json}. With a matrix, <case>
/// has the values that vary in its name. The experiment is copied, see keep_experiment(). A cell's files
/// appear together, its record last. A run that is killed at any moment leaves the cells that are done, and
/// none half done. The table names files that cannot be written.
///
/// Throws InputError when the folder cannot be written to, holds the results of another experiment, or
/// belongs to another run that is still going on.
Outcome run_experiment(const Experiment& experiment, const std::filesystem::path& folder,
                       const SweepOptions& options = {});

/// Returns the reason if the folder holds the results of another experiment; empty: it does not.
std::string why_folder_is_refused(const Experiment& experiment, const std::filesystem::path& folder);

/// Returns whether the folder had records already when its plan was made, or made otherwise than by `study`.
bool is_plan_changed(const StudyFile& study, const std::filesystem::path& folder);

/// Returns how long the cells that are to be made may take with two jobs, by the minutes of the experiment.
/// Nothing: it has none.
std::optional<double> expected_seconds(const Experiment& experiment, const std::filesystem::path& folder);

/// Returns the cells in their order, a line each, and what there is of them: as in state_of_cell(), or "data
/// not found".
std::string list_cells(const Experiment& experiment, const std::filesystem::path& folder);
/// Adds the time that the run would take, by records in the folder, and what it could prove. An empty folder
/// has no records; a warning says if the folder is of another experiment. Throws InputError as
/// check_hypotheses() does.
std::string dry_run(const Experiment& experiment, const std::filesystem::path& folder);

}  // namespace delquad
