#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace delquad {

/// Makes one HTML file, which needs no other and no network, from the records and meshes below a folder: that
/// of one experiment, or one that holds several side by side. Pictures of meshes take up to 17 MB together,
/// drawings 3 MB: meshes that do not fit are shown by some of their elements, and so the page says. Tables
/// have all cells, sheets the first 2000. It is written whole or not at all. Returns what could not be shown:
/// broken records and meshes, folders without results.
///
/// Throws InputError when there is nothing to show, or the file cannot be written.
std::vector<std::string> write_report(const std::filesystem::path& folder, const std::filesystem::path& file);

/// How many bytes a picture may take so that all together stay within `budget`, given what each would take
/// whole.
double fair_share(std::vector<double> bytes, double budget);

}  // namespace delquad
