// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/extend.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <new>
#include <ranges>
#include <system_error>

#include "base/context.h"
#include "base/located.h"
#include "base/nearest_name.h"
#include "base/system.h"
#include "delquad/error.h"
#include "delquad/mesher.h"
#include "experiments/console/interrupt.h"
#include "experiments/console/progress.h"
#include "experiments/sweep/machine.h"
#include "program/commands.h"
#include "program/options.h"

namespace delquad {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0: done. 1: internal error, or time is up (--time-limit), or something got worse (compare,\n"
    "rerun), or cells or measures failed (run). 2: bad input. 3: triangles are left among the quads, and "
    "written.\n"
    "4: faces were left out (--keep-going). 5: the mesh is not sound. 130: interrupted (Ctrl-C). 143: "
    "terminated.\nA message that ends with [an-id] is explained in docs/troubleshooting.md#an-id.";

/// The common arguments of all commands.
struct CommonArguments {
  bool quiet = false, all = false, version = false, no_cache = false;
  double time_limit = 0;             ///< seconds; 0: none
  std::vector<std::string> help_of;  ///< command to explain
};

void add_common(CLI::App& app, CommonArguments& common) {
  // These may stand behind the command, too.
  app.fallthrough();
  CLI::Option* quiet = app.add_flag("-q,--quiet", common.quiet, "print nothing but errors");
  app.add_flag("-v,--verbose", common.all,
               "print all warnings, measures and times, not the worst and a summary")
      ->excludes(quiet);
  app.add_flag("--no-cache", common.no_cache, "read CAD files anew (experiments always do)");
  app.add_flag("--version", common.version, "print version, commit and compiler; with -v libraries, too");
  app.add_subcommand("help", "Explain the program or a command")
      ->add_option("command", common.help_of, "which one")
      ->expected(0, 1);
  app.footer(kExitCodes);
}

Commands add_commands(CLI::App& app, CommonArguments& common) {
  Commands commands;
  for (const auto add :
       {add_run, add_batch, add_results, add_lists, add_mesh, add_adapt, add_view, add_convert, add_metrics,
        add_extrude, add_volume, add_compare, add_info, add_example})
    add(app, commands);
  for (const Command& command : commands)
    if (command.has_time_limit)
      command.app
          ->add_option(
              "--time-limit", common.time_limit,
              "seconds after which the program ends with exit code 1, saying at what, and without a file")
          ->check(kLength);
  return commands;
}

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

/// " (did you mean '--size'?)": an option of the program or of the given command, or a command where none is
/// given. Empty where none is near.
std::string meant_by(const std::string& argument, const CLI::App& app) {
  const auto given = app.get_subcommands();
  std::vector<const CLI::App*> parsed(given.begin(), given.end());
  const std::string dashes = argument.starts_with("--") ? "--" : "";
  std::vector<std::string> known;
  if (argument == "suite" && parsed.empty())
    return " (the suite is files now: 'delquad run experiments/suite/planar.toml', see docs/suite.md)";
  if (dashes.empty() && parsed.empty()) known = names_of_commands(app);
  parsed.push_back(&app);
  if (!dashes.empty())
    for (const CLI::App* command : parsed)
      for (const CLI::Option* option : command->get_options())
        known.insert(known.end(), option->get_lnames().begin(), option->get_lnames().end());
  const auto near = nearest_name(argument.substr(0, argument.find('=')).substr(dashes.size()), known);
  return near ? " (did you mean '" + dashes + *near + "'?)" : "";
}

/// Why the command line cannot be read. Arguments without a meaning come first, in the order in which they
/// were typed: a slip in an option may be why another is missing.
std::string reason_of(const CLI::ParseError& error, const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> unknown = app.remaining(true);
  std::string all;
  // An option may have taken an equal argument before, so the last one counts.
  for (const std::string argument :
       std::span(argv, static_cast<std::size_t>(argc)).subspan(1) | std::views::reverse)
    if (const auto at = std::ranges::find(unknown, argument); at != unknown.end()) {
      unknown.erase(at);
      all = "'" + argument + "'" + meant_by(argument, app) + (all.empty() ? "" : ", ") + all;
    }
  return all.empty() ? error.what() : "not expected: " + all;
}

/// Version, commit and compiler; with `all` the libraries, too.
void print_version(bool all) {
  const auto known = all ? versions() : own_versions();
  std::map<std::string, std::string> of(known.begin(), known.end());
  fmt::print("delquad {} (commit {}, {}, {})\n", of["delquad"], of["commit"], of["compiler"], of["build"]);
  for (const char* own : {"delquad", "commit", "compiler", "build"}) of.erase(own);
  if (!all) return;
  for (const auto& [library, version] : known)
    if (of.contains(library)) fmt::print("  {:<14} {}\n", library, version);
}

/// Returns the user's folder for files that can be made again; empty: there is none.
std::filesystem::path cache_of_user() {
  const auto path_in = [](const char* name) {
    const char* path = std::getenv(name);
    return std::filesystem::path(path == nullptr ? "" : path);
  };
  if (const auto cache = path_in("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "delquad";
  if (const auto home = path_in("HOME"); home.is_absolute()) return home / ".cache" / "delquad";
  return {};
}

int run_command_line(int argc, char** argv);

/// As the program and its commands explain themselves.
int print_help(const CLI::App& app, char* program, std::vector<std::string> command) {
  const std::vector<std::string> known = names_of_commands(app);
  if (!command.empty() && std::ranges::find(known, command[0]) == known.end())
    refuse("help: there is no command '{}'; known: {}{}", command[0], fmt::join(known, ", "),
           suggestion(command[0], known));
  command.emplace_back("--help");
  std::vector<char*> words = {program};
  for (std::string& word : command) words.push_back(word.data());
  return run_command_line(static_cast<int>(words.size()), words.data());
}

/// The standard output goes nowhere, except from commands that do nothing but print.
void be_quiet(bool only_prints) {
  set_verbosity(Verbosity::kQuiet);
  if (only_prints) return;
  if (std::freopen("/dev/null", "w", stdout) == nullptr)
    throw InputError("-q: /dev/null cannot be opened: " + std::generic_category().message(errno));
}

int run_command_line(int argc, char** argv) {
  CLI::App app("Delquad: frontal Delaunay quad meshing in the L-infinity norm");
  app.require_subcommand(0, 1);
  CommonArguments common;
  add_common(app, common);
  const Commands commands = add_commands(app, common);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // help
    fmt::print(stderr, "error: {} ('delquad help' and 'delquad help COMMAND' list commands and options)\n",
               reason_of(error, app, argc, argv));
    return kBadInput;
  }
  if (common.version) {
    print_version(common.all);
    return kDone;
  }
  if (app.got_subcommand("help")) return print_help(app, argv[0], common.help_of);
  if (app.get_subcommands().empty()) {
    fmt::print(stderr, "error: expected a command; 'delquad help' lists them\n");
    return kBadInput;
  }
  if (common.all) set_verbosity(Verbosity::kAll);
  const Command& command = *std::ranges::find_if(commands, [](const Command& c) { return c.app->parsed(); });
  if (common.quiet) be_quiet(command.only_prints());
  if (command.has_time_limit && !common.no_cache) set_cad_cache(cache_of_user());
  const RunScope run_scope({.activities = &program_activities()});
  std::optional<TimeLimit> limit;
  if (common.time_limit > 0) limit.emplace(common.time_limit);
  return command.run();
}

/// The exit code, unless what was printed did not reach its reader.
int after_printing(int code) {
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return code;
  fmt::print(stderr, "error: the standard output cannot be written{}\n",
             errno != 0 ? ": " + std::generic_category().message(errno) : "");
  return code == kDone ? kBadInput : code;
}

}  // namespace

int run_program(int argc, char** argv) {
  exit_on_interrupt();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows beyond `ulimit -f` is an error like a full disk
  keep_freed_memory();
  try {
    return after_printing(run_command_line(argc, argv));
  } catch (const InputError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return kBadInput;
  } catch (const std::filesystem::filesystem_error& error) {  // disks and folders that take no more
    fmt::print(stderr, "error: {}: {}\n", (error.path2().empty() ? error.path1() : error.path2()).string(),
               error.code().message());
    return kBadInput;
  } catch (const UnsoundError& error) {
    fmt::print(stderr, "error: {}: nothing was written (--allow-unsound writes it)\n", error.what());
    return kUnsound;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "internal error: out of memory\n");
  } catch (const std::exception& error) {
    if (std::ferror(stdout)) return after_printing(kDone);
    fmt::print(stderr, "internal error: {}\n", error.what());
  }
  return kInternalError;
}

}  // namespace delquad
