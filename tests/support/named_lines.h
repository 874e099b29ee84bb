// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include "delquad/mesh.h"

/// Parts of a mesh that lie on the curves with a name.
namespace delquad::testing_support {

inline std::vector<std::array<int, 2>> lines_named(const Mesh& mesh, const std::string& name) {
  std::vector<std::array<int, 2>> lines;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    if (std::ranges::count(mesh.curves[mesh.line_curve[l]].names, name) > 0) lines.push_back(mesh.lines[l]);
  return lines;
}

inline std::set<int> nodes_named(const Mesh& mesh, const std::string& name) {
  std::set<int> nodes;
  for (const auto& line : lines_named(mesh, name)) nodes.insert(line.begin(), line.end());
  return nodes;
}

inline double length_named(const Mesh& mesh, const std::string& name) {
  double sum = 0;
  for (const auto& [a, b] : lines_named(mesh, name)) sum += norm(mesh.points[b] - mesh.points[a]);
  return sum;
}

}  // namespace delquad::testing_support
