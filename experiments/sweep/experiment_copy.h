// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/sweep/experiment.h"

namespace delquad {

/// Keeps what an experiment was run from in the folder of its results: its file, and those that it names
/// beside it, in the same places to each other, below experiment/<digest of them all>/. Beside that folder
/// <digest>.json lists them with their digests, and those that are too large to be copied. An experiment that
/// has changed gets another copy, so that every record leads to what it was made from. Returns the copy of
/// the experiment's file, as seen from `folder`. Throws InputError when something cannot be written.
std::filesystem::path keep_experiment(const Experiment& experiment, const std::filesystem::path& folder);

/// Returns the errors in the copies in a folder of results, a line each.
std::vector<std::string> check_copies(const std::filesystem::path& folder);

}  // namespace delquad
