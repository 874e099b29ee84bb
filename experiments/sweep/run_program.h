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
  int error = 0;              ///< errno when the program could not be started, else 0
  int status = 0;             ///< as waitpid() gives it
  double seconds = 0;         ///< on the clock
  double cpu_seconds = 0;     ///< of the program and what it waited for
  long long peak_memory = 0;  ///< bytes, of the largest of these

  int exit_code() const;  ///< -1: it was ended by a signal
};

/// Returns how it ended, for "it ...": "ended with exit code 3"; empty: with 0, or one of `good`.
std::string how_it_ended(const ProgramRun& run, const std::vector<int>& good = {0});

/// Runs a program (words[0], looked for on the PATH unless it has a slash) in `folder`, without input. Its
/// output goes to the file `log`. Its stderr goes to the file `errors` instead, if there is one. Nothing that
/// it starts outlives its end, this process's end, or `seconds` (0: no limit). If the time is up, its status
/// is SIGKILL's.
ProgramRun run_program(const std::vector<std::string>& words, const std::filesystem::path& folder,
                       const std::filesystem::path& log, unsigned seconds = 0,
                       const std::filesystem::path& errors = {});

/// Returns the file beside the experiment, in `folder`, that the `i`-th word of a command stands for; empty:
/// none. A program without a slash is one of the PATH, whatever lies beside the experiment.
std::filesystem::path file_of_word(const std::filesystem::path& folder, const std::vector<std::string>& words,
                                   std::size_t i);

/// A placeholder, such as "{mesh}", and what stands for it.
using Filling = std::pair<const char*, std::function<std::string()>>;
/// Returns the words of a command with files in `folder`, where they name some, and fillings in place of
/// placeholders. A program with a slash counts from `folder`, too.
std::vector<std::string> filled_in(const std::filesystem::path& folder, const std::vector<std::string>& words,
                                   const std::vector<Filling>& fillings);

/// Returns the starts of the lines that a program printed to a file, without blank lines.
std::vector<std::string> lines_printed(const std::filesystem::path& file);
/// Returns the error that a program printed, for the end of a message. It is the first line with "error" in
/// it that is not indented, else the last line. Empty: it printed nothing.
std::string complaint(const std::filesystem::path& file);

/// Returns the words of a command that stand for files, with the digests of these.
std::map<std::string, std::string> command_files(const std::filesystem::path& folder,
                                                 const std::vector<std::string>& words);

}  // namespace delquad
