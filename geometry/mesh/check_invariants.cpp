// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/check_invariants.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace delquad {

namespace {

using Report = std::vector<std::string>;

void check_entities(const std::vector<Entity>& entities, const char* kind, Report& wrong) {
  std::set<int> tags;
  for (const Entity& entity : entities) {
    if (entity.tag <= 0) wrong.push_back(fmt::format("{} tag {}: not positive", kind, entity.tag));
    if (!tags.insert(entity.tag).second)
      wrong.push_back(fmt::format("{} tag {}: used twice", kind, entity.tag));
  }
}

/// Checks the indices of vertices and entities of one kind of element. Returns whether the vertices are in
/// range.
template <size_t N>
bool check_indices(const std::vector<std::array<int, N>>& elements, const std::vector<int>& entity_of,
                   size_t n_points, size_t n_entities, const char* kind, Report& wrong) {
  bool in_range = true;
  for (size_t i = 0; i < elements.size(); ++i) {
    for (const int v : elements[i]) {
      if (v >= 0 && v < static_cast<int>(n_points)) continue;
      wrong.push_back(
          fmt::format("{} {}: vertex {} is out of range (0 to {})", kind, i, v, int(n_points) - 1));
      in_range = false;
    }
    auto sorted = elements[i];
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
      wrong.push_back(fmt::format("{} {}: a vertex is repeated", kind, i));
    }
  }
  if (entity_of.size() != elements.size()) {
    wrong.push_back(
        fmt::format("{}s: {} elements but {} entity indices", kind, elements.size(), entity_of.size()));
  }
  for (size_t i = 0; i < entity_of.size(); ++i) {
    if (entity_of[i] >= 0 && entity_of[i] < static_cast<int>(n_entities)) continue;
    wrong.push_back(fmt::format("{} {}: entity {} is out of range (0 to {})", kind, i, entity_of[i],
                                int(n_entities) - 1));
  }
  return in_range;
}

template <size_t N>
void check_no_duplicates(std::vector<std::array<int, N>> elements, const char* kind, Report& wrong) {
  for (auto& v : elements) std::sort(v.begin(), v.end());
  std::sort(elements.begin(), elements.end());
  for (auto it = std::adjacent_find(elements.begin(), elements.end()); it != elements.end();
       it = std::adjacent_find(it + 1, elements.end())) {
    wrong.push_back(fmt::format("two {}s on the vertices {}", kind, fmt::join(*it, ", ")));
  }
}

void check_edges(const Mesh& mesh, const std::vector<char>& branching, std::span<const HalfEdge> sides,
                 Report& wrong) {
  struct Line {
    std::array<int, 2> ends;
    bool branches;
  };
  std::vector<Line> lines;
  for (size_t i = 0; i < mesh.lines.size(); ++i) {
    const auto [a, b] = mesh.lines[i];
    const auto curve =
        i < mesh.line_curve.size() ? static_cast<size_t>(mesh.line_curve[i]) : branching.size();
    lines.push_back({{std::min(a, b), std::max(a, b)}, curve < branching.size() && branching[curve]});
  }
  std::sort(lines.begin(), lines.end(), [](const Line& s, const Line& t) { return s.ends < t.ends; });
  auto line = lines.begin();
  // Advances to the lines behind the edge. Returns whether a line on it may branch.
  const auto pass = [&](const std::array<int, 2>& edge) {
    for (; line != lines.end() && line->ends < edge; ++line) {
      wrong.push_back(fmt::format("line {}, {}: not an edge of any element", line->ends[0], line->ends[1]));
    }
    bool branches = false;
    for (; line != lines.end() && line->ends == edge; ++line) branches = branches || line->branches;
    return branches;
  };

  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    const HalfEdge& e = edge[0];
    if (pass({e.lo, e.hi})) return;
    if (edge.size() > 2) wrong.push_back(fmt::format("edge {}, {}: in {} elements", e.lo, e.hi, edge.size()));
    if (edge.size() == 2 && edge[0].forward == edge[1].forward) {
      wrong.push_back(fmt::format("edge {}, {}: elements {} and {} run along it the same way", e.lo, e.hi,
                                  edge[0].element, edge[1].element));
    }
  });
  const int past_the_end = static_cast<int>(mesh.points.size());
  pass({past_the_end, past_the_end});
}

void check_all_used(const Mesh& mesh, Report& wrong) {
  std::vector<char> used(mesh.points.size(), 0);
  for_each_element(mesh, [&](int, const auto& v) {
    for (const int i : v) used[i] = 1;
  });
  for (const auto& v : mesh.lines) used[v[0]] = used[v[1]] = 1;
  for (const auto* nodes : {&mesh.line_nodes, &mesh.quad_nodes})
    for (const int i : *nodes) used[i] = 1;
  for (size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) wrong.push_back(fmt::format("vertex {}: nothing uses it", i));
  }
}

/// Checks all that needs no index in range. Returns whether all indices are in range.
bool check_elements(const Mesh& mesh, Report& wrong) {
  check_entities(mesh.curves, "curve", wrong);
  check_entities(mesh.regions, "region", wrong);
  const size_t n = mesh.points.size();
  const bool lines = check_indices(mesh.lines, mesh.line_curve, n, mesh.curves.size(), "line", wrong);
  const bool triangles =
      check_indices(mesh.triangles, mesh.triangle_region, n, mesh.regions.size(), "triangle", wrong);
  const bool quads = check_indices(mesh.quads, mesh.quad_region, n, mesh.regions.size(), "quad", wrong);
  check_no_duplicates(mesh.lines, "line", wrong);
  check_no_duplicates(mesh.triangles, "triangle", wrong);
  check_no_duplicates(mesh.quads, "quad", wrong);
  return lines && triangles && quads;
}

void check_connections(const Mesh& mesh, const std::vector<char>& branching, std::span<const HalfEdge> sides,
                       Report& wrong) {
  if (!mesh.triangles.empty() || !mesh.quads.empty()) check_edges(mesh, branching, sides, wrong);
  check_all_used(mesh, wrong);
}

}  // namespace

std::vector<std::string> check_invariants(const Mesh& mesh) { return check_invariants(mesh, {}); }

std::vector<std::string> check_invariants(const Mesh& mesh, const std::vector<char>& branching) {
  Report wrong;
  if (check_elements(mesh, wrong)) check_connections(mesh, branching, sorted_half_edges(mesh), wrong);
  return wrong;
}

std::vector<std::string> check_invariants(const Mesh& mesh, const std::vector<char>& branching,
                                          std::span<const HalfEdge> sides) {
  Report wrong;
  check_elements(mesh, wrong);
  check_connections(mesh, branching, sides, wrong);
  return wrong;
}

bool has_finite_points(const Mesh& mesh) {
  return std::ranges::all_of(mesh.points, [](const Vec3& p) { return std::isfinite(p.x + p.y + p.z); });
}

}  // namespace delquad
