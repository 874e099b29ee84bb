// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "experiments/sweep/run_experiment.h"
#include "io/cases/case.h"
#include "program/commands.h"

// This header has parts of commands that run experiments. `run` and `batch` use it.

namespace delquad {

/// The common arguments of commands that run experiments.
struct SweepArguments {
  std::filesystem::path folder, data = kDataFolder;
  int threads = 0;  ///< of each process; 0: the cores, shared out among the processes
  SweepOptions options;
};
void add_sweep(CLI::App& command, SweepArguments& arguments);
int threads_of(const SweepArguments& arguments);

/// Runs the experiment, and prints its tables.
Outcome run_and_print(const SweepArguments& arguments, const Experiment& experiment);
/// Prints the failures that belong to no cell, and which cells are not applicable. Returns the exit code.
int exit_code(const Outcome& outcome, bool allow_triangles);

}  // namespace delquad
