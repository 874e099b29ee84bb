// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/sweep/experiment.h"

// This header copies the files of an experiment to its results. Experiments and `verify` use it.

namespace delquad {

/// Copies the files of an experiment into the folder of its results, below experiment/<digest of all>/. These
/// are its own file and the files that it names beside it, with the same relative paths. The file
/// <digest>.json beside that folder lists them with their digests, also files too large to copy. A changed
/// experiment gets another copy, so every record leads to its files. Returns the copy of the experiment's
/// file, relative to `folder`. Throws InputError if something cannot be written.
std::filesystem::path keep_experiment(const Experiment& experiment, const std::filesystem::path& folder);

/// Returns the errors in the copies in a folder of results, a line each.
std::vector<std::string> check_copies(const std::filesystem::path& folder);

}  // namespace delquad
