// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/sweep/experiment.h"

// This header copies the files of an experiment to its results. Experiments and `verify` use it.

namespace delquad {

/// Copies the files that an experiment was run from into the folder of its results, below experiment/<digest
/// of them all>/. These are its own file and the files that it names beside it, in the same places to each
/// other. Beside that folder <digest>.json lists them with their digests, also the files that are too large
/// to be copied. An experiment that has changed gets another copy, so that every record leads to its files.
/// Returns the copy of the experiment's file, as seen from `folder`. Throws InputError if something cannot be
/// written.
std::filesystem::path keep_experiment(const Experiment& experiment, const std::filesystem::path& folder);

/// Returns the errors in the copies in a folder of results, a line each.
std::vector<std::string> check_copies(const std::filesystem::path& folder);

}  // namespace delquad
