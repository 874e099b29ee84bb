// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

// This header has the commands of the program. The program uses it.

namespace delquad {

/// Exit codes of the program, besides those in interrupt.h.
inline constexpr int kDone = 0, kInternalError = 1, kRegression = 1, kBadInput = 2, kTrianglesLeft = 3,
                     kFacesLeftOut = 4, kUnsound = 5;

/// A command of the program and its function, which returns the exit code.
struct Command {
  CLI::App* app;
  std::function<int()> run;
  std::function<bool()> only_prints = [] { return false; };  ///< prints even if the program is quiet
  bool has_time_limit = false;
};
using Commands = std::vector<Command>;

/// Adds a command that runs `run` with its arguments, and returns both for its options.
template <class Arguments>
std::pair<CLI::App*, Arguments&> add_command(CLI::App& app, Commands& commands, const char* name,
                                             const char* about, int (*run)(const Arguments&),
                                             bool has_time_limit = false) {
  const auto given = std::make_shared<Arguments>();
  commands.push_back({.app = app.add_subcommand(name, about),
                      .run = [given, run] { return run(*given); },
                      .has_time_limit = has_time_limit});
  return {commands.back().app, *given};
}

// Each adds a command, or several, with its options, in the order of the help.
void add_run(CLI::App& app, Commands& commands);
void add_batch(CLI::App& app, Commands& commands);
/// Adds tables, rerun, verify, merge and report.
void add_results(CLI::App& app, Commands& commands);
/// Adds schema and formats.
void add_lists(CLI::App& app, Commands& commands);
/// Adds mesh and improve.
void add_mesh(CLI::App& app, Commands& commands);
void add_view(CLI::App& app, Commands& commands);
void add_convert(CLI::App& app, Commands& commands);
void add_metrics(CLI::App& app, Commands& commands);
void add_adapt(CLI::App& app, Commands& commands);
void add_extrude(CLI::App& app, Commands& commands);
void add_volume(CLI::App& app, Commands& commands);
void add_compare(CLI::App& app, Commands& commands);
void add_info(CLI::App& app, Commands& commands);
void add_example(CLI::App& app, Commands& commands);

}  // namespace delquad
