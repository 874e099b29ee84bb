// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

// This header merges folders of results. The command `merge` uses it.

namespace delquad {

/// Puts results of one experiment, made in several folders, together in a new one, with its tables. Such
/// folders are shards from different machines, or have other values and cases. The result has the cases,
/// values and pipelines of all. A cell that several folders have must have the same model and mesh. A cell
/// that was done counts more than one that failed, and no damaged cell is taken. The folders stay as they
/// are. Throws InputError if a folder has no results, is of another experiment, or varies other keys. Throws
/// it, too, naming the cell, if a cell differs between two folders or is damaged in all of them. The last
/// reason is that `output` is there already or lies inside one of the folders.
void merge_results(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& output);

}  // namespace delquad
