#include <fmt/format.h>

#include <map>
#include <string>

#include "experiments/sweep/machine.h"
#include "program/commands.h"

namespace delquad {

void print_version(bool all) {
  const auto known = versions();
  std::map<std::string, std::string> of(known.begin(), known.end());
  fmt::print("delquad {} (commit {}, {}, {})\n", of["delquad"], of["commit"], of["compiler"], of["build"]);
  for (const char* own : {"delquad", "commit", "compiler", "build"}) of.erase(own);
  if (!all) return;
  for (const auto& [library, version] : known)
    if (of.contains(library)) fmt::print("  {:<14} {}\n", library, version);
}

}  // namespace delquad
