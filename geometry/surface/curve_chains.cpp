// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/curve_chains.h"

#include <algorithm>
#include <map>
#include <utility>

#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/triangle_measures.h"

namespace delquad {

namespace {

using Edges = std::vector<std::array<int, 2>>;

/// Returns the edges at each point.
std::map<int, std::vector<int>> edges_at_points(const Edges& edges) {
  std::map<int, std::vector<int>> at;
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (const int p : edges[e]) at[p].push_back(static_cast<int>(e));
  return at;
}

/// Returns the number of triangles at each line.
std::vector<std::size_t> triangles_on_lines(const Mesh& mesh) {
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  std::vector<std::size_t> counts;
  for (const auto& [a, b] : mesh.lines) counts.push_back(sides_of_edge(sides, a, b).size());
  return counts;
}

int other_end(const std::array<int, 2>& line, int end) { return line[0] == end ? line[1] : line[0]; }

}  // namespace

double turn_angle(const Vec3& a, const Vec3& b, const Vec3& c) { return angle_between(b - a, c - b); }

void mark_turns(const Mesh& mesh, double angle, const std::vector<char>& among, std::vector<char>& corner) {
  for (const auto& [p, here] : edges_at_points(mesh.lines)) {
    if (!among[p] || here.size() != 2) continue;
    const int a = other_end(mesh.lines[here[0]], p), b = other_end(mesh.lines[here[1]], p);
    if (turn_angle(mesh.points[a], mesh.points[p], mesh.points[b]) > angle) corner[p] = 1;
  }
}

std::vector<EdgeChain> chain_edges(const Edges& edges, const std::function<bool(int)>& is_end) {
  const std::map<int, std::vector<int>> at = edges_at_points(edges);
  const auto ends = [&](int p) { return at.at(p).size() != 2 || is_end(p); };
  std::vector<EdgeChain> chains;
  std::vector<char> done(edges.size(), 0);
  const auto follow = [&](int from, int edge) {
    EdgeChain& chain = chains.emplace_back(EdgeChain{{from}, {}});
    while (!std::exchange(done[edge], 1)) {
      const int to = other_end(edges[edge], chain.points.back());
      chain.points.push_back(to);
      chain.edges.push_back(edge);
      if (ends(to)) break;
      const std::vector<int>& here = at.at(to);
      edge = here[0] == edge ? here[1] : here[0];
    }
  };
  for (const auto& [p, here] : at)
    for (const int edge : here)
      if (!done[edge] && ends(p)) follow(p, edge);
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (!done[e]) follow(edges[e][0], static_cast<int>(e));
  return chains;
}

std::vector<std::vector<int>> chain_lines(SurfaceModel& model, const std::vector<int>& line_kind,
                                          std::vector<char> corner) {
  Mesh& mesh = model.fine;
  const std::vector<std::size_t> triangles = triangles_on_lines(mesh);
  const auto continues = [&](int line, int other) {
    return line_kind[line] == line_kind[other] && triangles[line] == triangles[other];
  };
  model.corners.clear();
  for (const auto& [p, here] : edges_at_points(mesh.lines)) {
    if (here.size() != 2 || !continues(here[0], here[1])) corner[p] = 1;
    if (corner[p]) model.corners.push_back(p);
  }
  const std::vector<EdgeChain> chains = chain_edges(mesh.lines, [&](int p) { return corner[p] != 0; });
  mesh.lines.clear();
  mesh.line_curve.clear();
  std::vector<std::vector<int>> lines;
  for (const EdgeChain& chain : chains) {
    for (std::size_t i = 0; i < chain.edges.size(); ++i)
      mesh.lines.push_back({chain.points[i], chain.points[i + 1]});
    mesh.line_curve.resize(mesh.lines.size(), static_cast<int>(lines.size()));
    lines.push_back(chain.edges);
  }
  return lines;
}

std::vector<std::vector<int>> points_of_curves(const Mesh& mesh) {
  std::vector<std::vector<int>> points(mesh.curves.size());
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    std::vector<int>& chain = points[mesh.line_curve[l]];
    if (chain.empty()) chain.push_back(mesh.lines[l][0]);
    chain.push_back(mesh.lines[l][1]);
  }
  return points;
}

std::vector<double> lengths_of_curves(const Mesh& mesh) {
  std::vector<double> lengths(mesh.curves.size(), 0);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    lengths[mesh.line_curve[l]] += norm(mesh.points[mesh.lines[l][1]] - mesh.points[mesh.lines[l][0]]);
  return lengths;
}

std::vector<Entity> entities_of_pieces(const std::vector<Entity>& given,
                                       const std::vector<int>& given_of_piece) {
  int greatest = 0;
  for (const int g : given_of_piece) {
    if (g >= 0) greatest = std::max(greatest, given[g].tag);
  }
  std::vector<char> taken(given.size(), 0);
  std::vector<Entity> entities;
  for (const int g : given_of_piece) {
    entities.push_back(g >= 0 ? given[g] : Entity{});
    if (g < 0 || taken[g]) {
      entities.back().tag = ++greatest;
    } else {
      taken[g] = 1;
    }
  }
  return entities;
}

}  // namespace delquad
