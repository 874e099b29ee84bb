// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/compound_projector.h"

#include <algorithm>
#include <set>

#include "geometry/mesh/drop_unused_points.h"

namespace delquad {

namespace {

/// Renumbers `of`, and removes the entities that it does not have. Returns the former number of each.
EntityGroups keep_used(std::vector<Entity>& entities, std::vector<int>& of) {
  std::vector<int> number(entities.size(), -1);
  for (const int e : of) number[e] = 0;
  EntityGroups former;
  for (std::size_t e = 0; e < number.size(); ++e) {
    if (number[e] < 0) continue;
    number[e] = static_cast<int>(former.size());
    entities[former.size()] = entities[e];
    former.push_back({static_cast<int>(e)});
  }
  entities.resize(former.size());
  for (int& e : of) e = number[e];
  return former;
}

/// Triangles around a point that its edges connect.
struct Fan {
  std::vector<int> triangles;
  std::set<int> neighbours;  ///< neighbors of the point
};

std::vector<Fan> fans_at(const Mesh& mesh, int point, const std::vector<int>& triangles) {
  std::vector<Fan> fans;
  for (const int t : triangles) {
    Fan fan{{t}, {}};
    for (const int v : mesh.triangles[t])
      if (v != point) fan.neighbours.insert(v);
    std::erase_if(fans, [&](Fan& other) {
      const bool meets =
          std::ranges::any_of(fan.neighbours, [&](int v) { return other.neighbours.contains(v); });
      if (!meets) return false;
      fan.triangles.insert(fan.triangles.end(), other.triangles.begin(), other.triangles.end());
      fan.neighbours.merge(other.neighbours);
      return true;
    });
    fans.push_back(std::move(fan));
  }
  return fans;
}

/// Gives fans that touch at a point without a line own points, since no node of a mesh will join them.
void split_touching_fans(Mesh& mesh) {
  std::vector<std::vector<int>> triangles_at(mesh.points.size()), lines_to(mesh.points.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t]) triangles_at[v].push_back(static_cast<int>(t));
  for (const auto& [a, b] : mesh.lines) {
    lines_to[a].push_back(b);
    lines_to[b].push_back(a);
  }
  for (std::size_t p = 0; p < triangles_at.size(); ++p) {
    const int point = static_cast<int>(p);
    std::vector<Fan> fans = fans_at(mesh, point, triangles_at[p]);
    if (fans.size() < 2) continue;
    std::ranges::stable_partition(fans, [&](const Fan& fan) {
      return std::ranges::any_of(lines_to[p], [&](int v) { return fan.neighbours.contains(v); });
    });
    for (std::size_t f = 1; f < fans.size(); ++f) {
      const bool has_line =
          std::ranges::any_of(lines_to[p], [&](int v) { return fans[f].neighbours.contains(v); });
      if (has_line) continue;
      for (const int t : fans[f].triangles)
        std::ranges::replace(mesh.triangles[t], point, static_cast<int>(mesh.points.size()));
      mesh.points.push_back(mesh.points[p]);
    }
  }
}

}  // namespace

void tidy_model(SurfaceModel& model, const Mesh& former) {
  Mesh& mesh = model.fine;
  split_touching_fans(mesh);
  std::vector<char> on_line(mesh.points.size(), 0);
  for (const auto& [a, b] : mesh.lines) on_line[a] = on_line[b] = 1;
  std::erase_if(model.corners, [&](int p) { return !on_line[p]; });
  const std::vector<int> number = drop_unused_points(mesh);
  for (int& p : model.corners) p = number[p];
  const EntityGroups faces = keep_used(mesh.regions, mesh.triangle_region);
  regroup(model, former, faces, keep_used(mesh.curves, mesh.line_curve));
}

}  // namespace delquad
