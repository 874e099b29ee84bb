// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/sweep/machine.h"

#include <fmt/chrono.h>

#include <ctime>
#include <fstream>
#include <thread>

#include "build_info.h"
#include "delquad/error.h"
#include "delquad/mesher.h"
#include "experiments/sweep/run_program.h"
#include "geometry/cad/cad_reader.h"

namespace delquad {
namespace {

/// As the program that reads CAD says; where it does not, that which it was built with.
std::string ask_kernel_version() {
  constexpr unsigned kWait = 30;
  const std::filesystem::path reader = cad_program();
  if (reader.empty()) return kOcctVersion;
  try {
    const TemporaryFolder scratch;
    const std::filesystem::path printed = scratch.path() / "version";
    const ProgramRun run = run_program({reader.string(), "--version"}, scratch.path(), printed, kWait);
    std::ifstream in(printed);
    if (std::string line; how_it_ended(run).empty() && std::getline(in, line)) return line;
  } catch (const InputError&) {
  }
  return kOcctVersion;
}

}  // namespace

const Machine& this_machine() {
  static const Machine machine{system_names(), std::thread::hardware_concurrency()};
  return machine;
}

MachineState machine_state() {
  return {fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))), system_load()};
}

std::vector<std::pair<std::string, std::string>> own_versions() {
  return {{"delquad", version()}, {"commit", kCommit}, {"build", kBuildType}, {"compiler", kCompiler}};
}

std::vector<std::pair<std::string, std::string>> versions() {
  static const std::string kernel = ask_kernel_version();
  auto all = own_versions();
  all.insert(all.end(), {{"cgal", kCgalVersion},
                         {"eigen", kEigenVersion},
                         {"lemon", kLemonVersion},
                         {"fmt", kFmtVersion},
                         {"nlohmann_json", kJsonVersion},
                         {"muparser", kMuparserVersion},
                         {"ceres", kCeresVersion},
                         {"opencascade", kernel}});
  return all;
}

}  // namespace delquad
