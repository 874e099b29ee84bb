// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// This header has options of several commands. The program uses it.

namespace delquad {

inline constexpr const char* kSizeHelp =
    "wanted edge length: a number, an expression in x, y, z, 'boundary', or FILE[:FIELD], a field of an .msh "
    "or .vtu file";
inline constexpr const char* kUnsoundHelp =
    "write meshes that are not sound (inverted or folded quads, lost parts, ...), marked in the record";
inline constexpr const char* kAllowHelp = "exit with 0 although triangles are left among the quads";
inline constexpr int kMostThreads = 1024;

/// Accepts a whole number from 1, which may be written as 1e6.
extern const CLI::Validator kCount;
/// Accepts a finite number above 0.
extern const CLI::Validator kLength;

/// Adds `--size`; an empty text differs from none.
CLI::Option* add_size(CLI::App& command, std::optional<std::string>& size, const char* help);
void add_data(CLI::App& command, std::filesystem::path& data);
/// Adds `--criteria` and `--strict`.
void add_criteria(CLI::App& command, std::string& criteria, bool& strict);
/// Returns the numbers between commas. Throws InputError, with an example, unless `count` finite ones are
/// given.
std::vector<double> read_list(const std::string& option, const std::string& text, std::size_t count,
                              const char* example);
void add_threads(CLI::App& command, int& threads);
void add_max_elements(CLI::App& command, long long& most,
                      const char* help = "refuse sizes that ask for more quads than this");

/// Throws InputError for a file that cannot be written, before any work.
void check_output(const std::filesystem::path& path);

/// Throws InputError if two files, each with its role, are the same one under any names and links. Empty
/// paths are left out; devices may be repeated.
void check_distinct(const std::vector<std::pair<std::string, std::filesystem::path>>& files);

}  // namespace delquad
