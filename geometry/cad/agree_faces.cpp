#include "geometry/cad/agree_faces.h"

#include <algorithm>
#include <set>
#include <utility>

#include "base/sort_unique.h"
#include "geometry/mesh/half_edges.h"

namespace delquad::cad {

namespace {

struct Neighbour {
  int face;
  bool agrees;
  friend auto operator<=>(const Neighbour&, const Neighbour&) = default;
};

std::vector<std::set<Neighbour>> neighbours(const Mesh& mesh) {
  std::vector<std::set<Neighbour>> of(mesh.regions.size());
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    if (edge.size() != 2) return;
    const int f = mesh.triangle_region[edge[0].element], g = mesh.triangle_region[edge[1].element];
    const bool agrees = edge[0].forward != edge[1].forward;
    if (f == g && agrees) return;
    of[f].insert({g, agrees});
    of[g].insert({f, agrees});
  });
  return of;
}

void turn(Mesh& mesh, const std::vector<char>& turned) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (turned[mesh.triangle_region[t]]) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
}

/// The triangles of each face.
std::vector<std::vector<int>> triangles_by_face(const Mesh& mesh) {
  std::vector<std::vector<int>> of(mesh.regions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    of[mesh.triangle_region[t]].push_back(static_cast<int>(t));
  return of;
}

/// Some triangles of a mesh, with the points that they use.
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

/// Six times the volume that closed triangles enclose; nothing when they are not closed.
double volume(const Mesh& part) {
  if (part.triangles.empty()) return 0;
  bool closed = true;
  const std::vector<HalfEdge> sides = sorted_half_edges(part);
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    closed = closed && edge.size() == 2 && edge[0].forward != edge[1].forward;
  });
  if (!closed) return 0;
  // Any origin serves; one on the model cancels least.
  const Vec3 origin = part.points.front();
  double sum = 0;
  for (const auto& [a, b, c] : part.triangles)
    sum += dot(part.points[a] - origin, cross(part.points[b] - origin, part.points[c] - origin));
  return sum;
}

}  // namespace

Agreement agree_faces(Mesh& mesh) {
  Agreement result;
  const auto of = neighbours(mesh);
  std::vector<char> known(of.size(), 0), turned(of.size(), 0);
  for (std::size_t seed = 0; seed < of.size(); ++seed) {
    if (known[seed]) continue;
    std::vector<int> component{static_cast<int>(seed)};
    known[seed] = 1;
    for (std::size_t i = 0; i < component.size(); ++i) {
      const int f = component[i];
      for (const auto& [g, agrees] : of[f]) {
        const char wanted = agrees ? turned[f] : !turned[f];
        if (!known[g]) {
          known[g] = 1;
          turned[g] = wanted;
          component.push_back(g);
        } else if (turned[g] != wanted) {
          result.orientable = false;
        }
      }
    }
    const auto n = std::ranges::count_if(component, [&](int f) { return turned[f] != 0; });
    const bool other_way = 2 * n > std::ssize(component);
    if (other_way)
      for (const int f : component) turned[f] = !turned[f];
    result.n_turned += static_cast<int>(other_way ? std::ssize(component) - n : n);
  }
  turn(mesh, turned);
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
