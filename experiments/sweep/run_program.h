// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

// This header runs other programs and watches them. The bench uses it.

namespace delquad {

struct ProgramRun {
  int error = 0;              ///< errno if the program could not be started, else 0
  int status = 0;             ///< as from waitpid()
  double seconds = 0;         ///< wall-clock time
  double cpu_seconds = 0;     ///< of the program and its awaited children
  long long peak_memory = 0;  ///< bytes, of the largest of these processes

  int exit_code() const;  ///< -1: a signal ended it
};

/// Returns the end of a message "it ...", such as "ended with exit code 3"; empty: 0, or one of `good`.
std::string how_it_ended(const ProgramRun& run, const std::vector<int>& good = {0});

/// Runs a program (words[0], sought on the PATH unless it has a slash) in `folder`, without input. Its output
/// goes to the file `log`, and stderr to `errors` if that is given. None of its processes outlives it, this
/// process, or `seconds` (0: no limit). After a timeout its status is SIGKILL's.
ProgramRun run_program(const std::vector<std::string>& words, const std::filesystem::path& folder,
                       const std::filesystem::path& log, unsigned seconds = 0,
                       const std::filesystem::path& errors = {});

/// Returns the file in `folder`, beside the experiment, of the i-th word in a command; empty: none. A program
/// without a slash is always from the PATH.
std::filesystem::path file_of_word(const std::filesystem::path& folder, const std::vector<std::string>& words,
                                   std::size_t i);

/// A placeholder, such as "{mesh}", and its replacement.
using Filling = std::pair<const char*, std::function<std::string()>>;
/// Returns the words of a command with names of files in `folder` and placeholders replaced. A program with a
/// slash is relative to `folder`, too.
std::vector<std::string> filled_in(const std::filesystem::path& folder, const std::vector<std::string>& words,
                                   const std::vector<Filling>& fillings);

/// Returns the beginnings of the lines in an output file, without blank lines.
std::vector<std::string> lines_printed(const std::filesystem::path& file);
/// Returns the error message in an output file, for the end of a message. It is the first line with "error"
/// that is not indented, else the last line; empty: no output.
std::string complaint(const std::filesystem::path& file);

/// Returns the words of a command that stand for files, with the digests of the files.
std::map<std::string, std::string> command_files(const std::filesystem::path& folder,
                                                 const std::vector<std::string>& words);

}  // namespace delquad
