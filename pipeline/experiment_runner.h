#pragma once

#include <filesystem>

#include "pipeline/experiment.h"
#include "pipeline/progress.h"
#include "pipeline/table.h"

namespace delquad {

struct ExperimentOutcome {
  Table table;
  int bad_inputs = 0;                ///< cells that failed because of what was given
  int internal_errors = 0;           ///< cells that failed because of the program
  long long leftover_triangles = 0;  ///< of pipelines that should make quads
};

/// How many times run_experiment() steps the progress.
int experiment_steps(const Experiment& experiment);

/// Runs every pipeline on every case. Writes DIR/<case>/<pipeline>/{mesh.msh, mesh.vtu, picture.svg,
/// record.json}, DIR/<case>/{cross.svg, size.svg} and DIR/table.{md, csv, tex, json}. What fails, the writing
/// of files included, goes to the table; the rest goes on. A cell's files appear together or not at all.
/// Throws InputError when the folder cannot be written to from the start.
ExperimentOutcome run_experiment(const Experiment& experiment, const std::filesystem::path& folder,
                                 Progress& progress);

/// Makes the folder, or throws InputError when it cannot be made or written to.
void prepare_folder(const std::filesystem::path& folder);

}  // namespace delquad
