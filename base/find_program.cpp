// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/find_program.h"

#include <fmt/format.h>

#include <cstdlib>
#include <system_error>
#include <vector>

#include "base/system.h"
#include "delquad/error.h"

namespace delquad {

namespace {

namespace fs = std::filesystem;

/// Returns a requested program, or refuses it; no other one replaces it.
fs::path required(const fs::path& path, const std::string& who, const std::string& reads) {
  if (can_be_run(path)) return path;
  throw InputError(
      fmt::format("{}: {} cannot be run: expected the program that reads {}", who, path.string(), reads));
}

/// Returns the folders to search: of the running program, of this code's program or library, and of the
/// installation as seen from both.
std::vector<fs::path> folders() {
  std::vector<fs::path> all;
  const fs::path program = running_program().parent_path();
  if (!program.empty()) {
    all.push_back(program);
    all.push_back((program / DELQUAD_LIBEXEC_FROM_BIN).lexically_normal());
  }
  if (const fs::path here = file_of(&folders); !here.empty()) {
    std::error_code unknown;
    all.push_back(fs::absolute(here, unknown).parent_path());
    all.push_back((all.back() / DELQUAD_LIBEXEC_FROM_LIB).lexically_normal());
  }
  all.emplace_back(DELQUAD_LIBEXEC);
  return all;
}

}  // namespace

fs::path find_program(const HelperProgram& program, const fs::path& chosen, const std::string& chooser) {
  const char* variable = std::getenv(program.variable.c_str());
  if (variable != nullptr && *variable != 0) return required(variable, program.variable, program.reads);
  if (!chosen.empty()) return required(chosen, chooser, program.reads);
  std::string places;
  for (const fs::path& folder : folders()) {
    if (can_be_run(folder / program.name)) return folder / program.name;
    places += (places.empty() ? "" : ", ") + folder.string();
  }
  throw InputError(fmt::format(
      "the program {}, which reads {}, was not found: expected it in one of {}, or its path in {} "
      "[no-helper-program]",
      program.name, program.reads, places, program.variable));
}

}  // namespace delquad
