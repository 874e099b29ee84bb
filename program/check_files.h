#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace delquad {

/// Throws InputError for a file that cannot be written, before any work.
void check_output(const std::filesystem::path& path);

/// Throws InputError when two of the files, each with what it is for the program, are the same one, by
/// whatever names and links. Empty paths are left out; devices may serve twice.
void check_distinct(const std::vector<std::pair<std::string, std::filesystem::path>>& files);

}  // namespace delquad
