// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace delquad {

/// Puts results of one experiment, made in several folders (shards on different machines, or with other
/// values and cases), together in a new one, with its tables: cases, values and pipelines are those of all. A
/// cell that several have must have the same model and mesh; where one of them was done, it is taken, and
/// none that is damaged. The folders stay as they are. Throws InputError when one is no folder of results, is
/// of another experiment, or varies other keys; when a cell is not the same in two, or damaged in all that
/// have it, naming it; and when `output` is there already or inside one of them.
void merge_results(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& output);

}  // namespace delquad
