// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/nearest_name.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace delquad {
namespace {

/// Returns the optimal string alignment: insertions, deletions, substitutions and swaps of neighbors cost 1
/// each.
int edit_distance(const std::string& a, const std::string& b) {
  const int n = static_cast<int>(a.size()), m = static_cast<int>(b.size());
  std::vector<std::vector<int>> d(n + 1, std::vector<int>(m + 1));
  for (int i = 0; i <= n; ++i) d[i][0] = i;
  for (int j = 0; j <= m; ++j) d[0][j] = j;
  for (int i = 1; i <= n; ++i)
    for (int j = 1; j <= m; ++j) {
      const int substitution = d[i - 1][j - 1] + (a[i - 1] != b[j - 1] ? 1 : 0);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[n][m];
}

/// Returns our name of an unnamed entity, from the names in other programs: "face_3", "edge_3" or "3".
std::optional<std::string> numbered_entity(const std::string& given, const std::vector<std::string>& known) {
  constexpr std::array<std::pair<const char*, const char*>, 6> kOthers = {{{"face_", "region_"},
                                                                           {"surface_", "region_"},
                                                                           {"edge_", "curve_"},
                                                                           {"line_", "curve_"},
                                                                           {"", "region_"},
                                                                           {"", "curve_"}}};
  for (const auto& [other, ours] : kOthers) {
    if (!given.starts_with(other)) continue;
    const std::string name = ours + given.substr(std::strlen(other));
    if (std::ranges::find(known, name) != known.end()) return name;
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> nearest_name(const std::string& given, const std::vector<std::string>& known) {
  constexpr std::size_t kLongestName = 64;  // no key is longer
  if (given.size() > kLongestName) return std::nullopt;
  std::optional<std::string> best = numbered_entity(given, known);
  if (best) return best;
  int best_distance = 0;
  for (const std::string& name : known) {
    const int distance = edit_distance(given, name);
    if (distance <= std::max<int>(1, static_cast<int>(name.size()) / 2) &&
        (!best || distance < best_distance)) {
      best = name;
      best_distance = distance;
    }
  }
  return best;
}

std::string suggestion(const std::string& given, const std::vector<std::string>& known) {
  const auto near = nearest_name(given, known);
  return near ? "; did you mean '" + *near + "'?" : "";
}

std::string suggestion_or_all(const std::string& given, std::vector<std::string> known) {
  std::ranges::sort(known);
  const auto doubles = std::ranges::unique(known);
  known.erase(doubles.begin(), doubles.end());
  std::erase(known, "");
  if (const std::string near = suggestion(given, known); !near.empty() || known.empty()) return near;
  constexpr std::size_t kMostShown = 12;
  const std::size_t shown = std::min(known.size(), kMostShown);
  const std::string more =
      known.size() > shown ? " and " + std::to_string(known.size() - shown) + " more" : "";
  std::string all = "; there are ";
  for (std::size_t i = 0; i < shown; ++i) all += (i > 0 ? ", '" : "'") + known[i] + "'";
  return all + more;
}

}  // namespace delquad
