// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

// This header writes the page of an experiment. The program uses it.

namespace delquad {

/// Writes one HTML file, which needs no other and no network, from the records and meshes below a folder. The
/// folder has one experiment, or several side by side. Drawings, values of cells and pictures of meshes take
/// up to 50 MB together; the page names the others. Tables have all cells, sheets the first 2000. The file is
/// written completely or not at all.
///
/// Returns parts that could not be shown: broken records and meshes, folders without results. Throws
/// InputError if there is nothing to show, or the file cannot be written.
std::vector<std::string> write_report(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace delquad
