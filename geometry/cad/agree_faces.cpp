// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/agree_faces.h"

#include <algorithm>

#include "base/sort_unique.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/turn_to_agree.h"

namespace delquad::cad {

namespace {

std::vector<Neighbours> neighbours(const Mesh& mesh) {
  std::vector<Neighbours> found;
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2) return;
    const auto [f, g] =
        std::minmax({mesh.triangle_region[edge[0].element], mesh.triangle_region[edge[1].element]});
    const bool agree = edge[0].forward != edge[1].forward;
    if (f != g || !agree) found.push_back({f, g, agree});
  });
  sort_unique(found);
  return found;
}

void turn(Mesh& mesh, const std::vector<char>& turned) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (turned[mesh.triangle_region[t]]) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
}

/// Returns the triangles of each face.
std::vector<std::vector<int>> triangles_by_face(const Mesh& mesh) {
  std::vector<std::vector<int>> of(mesh.regions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    of[mesh.triangle_region[t]].push_back(static_cast<int>(t));
  return of;
}

/// Returns some triangles of a mesh, with their points.
Mesh part_of(const Mesh& mesh, const std::vector<int>& triangles) {
  Mesh part;
  std::vector<int> used;
  for (const int t : triangles) used.insert(used.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  sort_unique(used);
  for (const int v : used) part.points.push_back(mesh.points[v]);
  for (const int t : triangles) {
    auto& triangle = part.triangles.emplace_back(mesh.triangles[t]);
    for (int& v : triangle) v = static_cast<int>(std::ranges::lower_bound(used, v) - used.begin());
  }
  return part;
}

/// Returns six times the volume that triangles enclose; nothing if they are not closed.
double volume(const Mesh& part) {
  if (part.triangles.empty()) return 0;
  bool closed = true;
  const std::vector<HalfEdge> sides = sorted_half_edges(part);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    closed = closed && edge.size() == 2 && edge[0].forward != edge[1].forward;
  });
  if (!closed) return 0;
  // Any origin works; one on the model loses the fewest digits.
  const Vec3 origin = part.points.front();
  double sum = 0;
  for (const auto& [a, b, c] : part.triangles)
    sum += dot(part.points[a] - origin, cross(part.points[b] - origin, part.points[c] - origin));
  return sum;
}

}  // namespace

Agreement agree_faces(Mesh& mesh) {
  Agreement result;
  Turned turned = turn_to_agree(mesh.regions.size(), neighbours(mesh));
  result.orientable = turned.clash < 0;
  for (const std::vector<int>& piece : turned.pieces) {
    const auto n = std::ranges::count_if(piece, [&](int f) { return turned.is_turned[f] != 0; });
    const bool other_way = 2 * n > std::ssize(piece);
    if (other_way)
      for (const int f : piece) turned.is_turned[f] = !turned.is_turned[f];
    result.n_turned += static_cast<int>(other_way ? std::ssize(piece) - n : n);
  }
  turn(mesh, turned.is_turned);
  return result;
}

int turn_outwards(Mesh& mesh, const std::vector<std::vector<int>>& groups) {
  const std::vector<std::vector<int>> triangles_of = triangles_by_face(mesh);
  int n_turned = 0;
  for (const std::vector<int>& group : groups) {
    std::vector<int> triangles;
    for (const int f : group)
      triangles.insert(triangles.end(), triangles_of[f].begin(), triangles_of[f].end());
    if (!(volume(part_of(mesh, triangles)) < 0)) continue;
    for (const int t : triangles) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    ++n_turned;
  }
  return n_turned;
}

}  // namespace delquad::cad
