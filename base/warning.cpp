// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/warning.h"

#include <fmt/format.h>

#include <cstddef>
#include <map>

namespace delquad {

std::vector<std::string> summaries(const std::vector<Warning>& warnings) {
  struct Kind {
    const Warning* worst;
    int n;
  };
  std::vector<Kind> kinds;
  std::map<std::string, std::size_t> known;
  for (const Warning& warning : warnings) {
    const auto [at, is_new] = known.try_emplace(warning.kind, kinds.size());
    if (warning.kind.empty() || is_new) {
      kinds.push_back({&warning, 1});
      continue;
    }
    Kind& kind = kinds[at->second];
    ++kind.n;
    if (warning.severity > kind.worst->severity) kind.worst = &warning;
  }
  std::vector<std::string> lines;
  for (const Kind& kind : kinds)
    lines.push_back(kind.n == 1
                        ? kind.worst->text
                        : fmt::format("{} {}; the worst: {}", kind.n, kind.worst->kind, kind.worst->text));
  return lines;
}

std::vector<std::string> texts(const std::vector<Warning>& warnings) {
  std::vector<std::string> all;
  for (const Warning& warning : warnings) all.push_back(warning.text);
  return all;
}

}  // namespace delquad
