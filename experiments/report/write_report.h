// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

// This header writes the page of an experiment. The program uses it.

namespace delquad {

/// Makes one HTML file, which needs no other and no network, from the records and meshes below a folder. The
/// folder is of one experiment, or holds several side by side. Drawings, values of cells and pictures of
/// meshes take up to 50 MB together: the page says which do not fit. Tables have all cells, sheets the first
/// 2000. It is written whole or not at all. Returns what could not be shown:
/// broken records and meshes, folders without results.
///
/// Throws InputError when there is nothing to show, or the file cannot be written.
std::vector<std::string> write_report(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace delquad
