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
  int threads = 0;  ///< for each process; 0: all cores, divided among the processes
  SweepOptions options;
};
/// Adds the options of these arguments.
void add_sweep(CLI::App& command, SweepArguments& arguments);
/// Returns the threads of each process, at least 1.
int threads_of(const SweepArguments& arguments);

/// Runs the experiment and prints its tables. Throws InputError as run_experiment().
Outcome run_and_print(const SweepArguments& arguments, const Experiment& experiment);
/// Prints failures without a cell, and cells that are not applicable. Returns the exit code.
int exit_code(const Outcome& outcome, bool allow_triangles);

}  // namespace delquad
