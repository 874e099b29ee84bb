// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

// This header merges folders of results. The command `merge` uses it.

namespace delquad {

/// Merges results of one experiment from several folders into a new one, with its tables. Such folders are
/// shards from different machines, or have other values and cases. The result has the cases, values and
/// pipelines of all. A cell in several folders must have the same model and mesh. A finished cell wins over a
/// failed one, and no damaged cell is taken. The folders stay.
///
/// Throws InputError if a folder has no results, is of another experiment, or varies other keys. Also throws,
/// with the cell, if a cell differs between two folders or is damaged in all of them. The output must not
/// exist, or lie inside one of the folders.
void merge_results(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& output);

}  // namespace delquad
