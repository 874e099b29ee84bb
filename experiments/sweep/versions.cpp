#include "experiments/sweep/versions.h"

#include <fstream>

#include "build_info.h"
#include "delquad/error.h"
#include "delquad/mesher.h"
#include "experiments/sweep/run_program.h"
#include "experiments/sweep/scratch_folder.h"
#include "geometry/cad/cad_reader.h"

namespace delquad {
namespace {

/// As the program that reads CAD says; where it does not, that which it was built with.
std::string ask_kernel_version() {
  constexpr unsigned kWait = 30;
  const std::filesystem::path reader = cad_program();
  if (reader.empty()) return kOcctVersion;
  try {
    const ScratchFolder scratch;
    const std::filesystem::path printed = scratch.path() / "version";
    const ProgramRun run = run_program({reader.string(), "--version"}, scratch.path(), printed, kWait);
    std::ifstream in(printed);
    if (std::string line; how_it_ended(run).empty() && std::getline(in, line)) return line;
  } catch (const InputError&) {
  }
  return kOcctVersion;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> versions() {
  static const std::string kernel = ask_kernel_version();
  return {{"delquad", version()},         {"commit", kCommit},      {"build", kBuildType},
          {"compiler", kCompiler},        {"cgal", kCgalVersion},   {"eigen", kEigenVersion},
          {"lemon", kLemonVersion},       {"fmt", kFmtVersion},     {"nlohmann_json", kJsonVersion},
          {"muparser", kMuparserVersion}, {"ceres", kCeresVersion}, {"opencascade", kernel}};
}

}  // namespace delquad
