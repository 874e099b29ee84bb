// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/feature_noise.h"

#include <algorithm>
#include <map>
#include <numbers>

#include "base/box.h"
#include "base/disjoint_sets.h"
#include "geometry/surface/triangle_sides.h"

namespace delquad {

namespace {

/// Longest network or border that may be noise, over the model's diagonal.
constexpr double kLongest = 0.1;
/// Angle (radians) below which surroundings are smooth; there even the smallest feature is intended.
constexpr double kSmooth = 3 * std::numbers::pi / 180;
/// Least sharpness of a feature over its surroundings. Loops in scans have 2 to 6, on machined parts 8 and
/// more.
constexpr double kStandsOut = 6;
/// Number of edges that may be noise, however sharp: those around a single vertex that sticks out.
constexpr std::size_t kFewEdges = 6;
/// Limit of passes, since joined faces may let others join.
constexpr int kMaxPasses = 20;

class NoiseFilter {
 public:
  NoiseFilter(const Mesh& mesh, const std::vector<int>& twin, const std::vector<double>& angle,
              std::vector<int>& cut)
      : mesh_(mesh),
        twin_(twin),
        angle_(angle),
        cut_(cut),
        longest_(kLongest * diagonal(mesh.points)),
        sides_at_(mesh.points.size()) {
    for (int s = 0; s < static_cast<int>(twin.size()); ++s)
      if (stands_for_edge(s))
        for (int v : {side_start(mesh, s), side_end(mesh, s)}) sides_at_[v].push_back(s);
  }

  DroppedFeatures run() {
    drop_networks();
    for (int pass = 0; pass < kMaxPasses && join_faces(); ++pass) {
    }
    return dropped_;
  }

 private:
  bool stands_for_edge(int side) const { return twin_[side] < side; }
  int face_of(int side) const { return face_[side / 3]; }

  /// Returns whether a side stays: free edges, given lines and borders of regions.
  bool stays(int side) const {
    const int t = twin_[side];
    return t < 0 || cut_[side] != kNewCut || mesh_.triangle_region[side / 3] != mesh_.triangle_region[t / 3];
  }

  /// Returns whether edges, each given by one side, are noise; none of them stays.
  bool is_noise(const std::vector<int>& edges) const {
    double length = 0, sharpness = 0, beside = 0;
    std::size_t n_beside = 0;
    for (int s : edges) {
      const int a = side_start(mesh_, s), b = side_end(mesh_, s);
      length += norm(mesh_.points[b] - mesh_.points[a]);
      if (length > longest_) return false;
      sharpness += angle_[s] / static_cast<double>(edges.size());
      for (int v : {a, b})
        for (int other : sides_at_[v])
          if (cut_[other] == kNoCut) {
            beside += angle_[other];
            ++n_beside;
          }
    }
    if (n_beside > 0) beside /= static_cast<double>(n_beside);
    return beside > kSmooth && (edges.size() <= kFewEdges || sharpness < kStandsOut * beside);
  }

  void drop(const std::vector<int>& edges) {
    if (edges.empty()) return;
    if (dropped_.islands++ == 0) dropped_.at = mesh_.points[side_start(mesh_, edges[0])];
    dropped_.edges += edges.size();
    for (int s : edges) cut_[s] = cut_[twin_[s]] = kNoCut;
  }

  /// Removes connected networks of cuts that are noise.
  void drop_networks() {
    std::vector<char> seen(cut_.size(), 0);
    for (int seed = 0; seed < static_cast<int>(cut_.size()); ++seed) {
      if (!stands_for_edge(seed) || cut_[seed] == kNoCut || seen[seed]) continue;
      std::vector<int> edges = {seed};
      seen[seed] = 1;
      for (std::size_t i = 0; i < edges.size(); ++i)
        for (int v : {side_start(mesh_, edges[i]), side_end(mesh_, edges[i])})
          for (int s : sides_at_[v])
            if (cut_[s] != kNoCut && !seen[s]) {
              seen[s] = 1;
              edges.push_back(s);
            }
      if (std::ranges::none_of(edges, [&](int s) { return stays(s); }) && is_noise(edges)) drop(edges);
    }
  }

  /// Joins small faces. Returns whether any was joined.
  bool join_faces() {
    face_ = parts_between_cuts(twin_, cut_);
    const int n_faces = 1 + std::ranges::max(face_);
    std::vector<std::vector<int>> borders(n_faces);  // border of each face, by its sides in the face
    for (int s = 0; s < static_cast<int>(cut_.size()); ++s)
      if (cut_[s] != kNoCut && !stays(s) && face_of(s) != face_of(twin_[s])) borders[face_of(s)].push_back(s);
    std::vector<char> changed(n_faces, 0);
    bool any = false;
    for (int f = 0; f < n_faces; ++f) {
      if (changed[f] || borders[f].empty() || !is_noise(borders[f])) continue;
      const int other = best_neighbour(borders[f]);
      if (changed[other]) continue;
      changed[f] = changed[other] = 1;
      std::erase_if(borders[f], [&](int s) { return face_of(twin_[s]) != other; });
      drop(borders[f]);
      any = true;
    }
    return any;
  }

  /// Returns the face with the longest part of the border.
  int best_neighbour(const std::vector<int>& border) const {
    std::map<int, double> shared;
    for (int s : border)
      shared[face_of(twin_[s])] +=
          norm(mesh_.points[side_end(mesh_, s)] - mesh_.points[side_start(mesh_, s)]);
    return std::ranges::max_element(shared, {}, [](const auto& entry) { return entry.second; })->first;
  }

  const Mesh& mesh_;
  const std::vector<int>& twin_;
  const std::vector<double>& angle_;
  std::vector<int>& cut_;
  double longest_;
  std::vector<std::vector<int>> sides_at_;  ///< one side of each edge
  std::vector<int> face_;                   ///< face of each triangle
  DroppedFeatures dropped_;
};

}  // namespace

std::vector<int> parts_between_cuts(const std::vector<int>& twin, const std::vector<int>& cut) {
  DisjointSets parts(twin.size() / 3);
  for (std::size_t s = 0; s < twin.size(); ++s)
    if (cut[s] == kNoCut) parts.join(static_cast<int>(s / 3), twin[s] / 3);
  return parts.places();
}

DroppedFeatures drop_noise(const Mesh& mesh, const std::vector<int>& twin, const std::vector<double>& angle,
                           std::vector<int>& cut) {
  return NoiseFilter(mesh, twin, angle, cut).run();
}

}  // namespace delquad
