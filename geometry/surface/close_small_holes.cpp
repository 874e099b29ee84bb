// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/ignore_small.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>

#include "base/box.h"
#include "base/disjoint_sets.h"
#include "base/text.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/mesh/keep_elements.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/compound_projector.h"

namespace delquad {

namespace {

/// Largest area of a tube over girth times extent, since ends and bends add to it.
constexpr double kTubeArea = 1.5;

/// A closed chain of lines on the boundary of a face.
struct Loop {
  int face = -1, other = -1;  ///< face on the other side; -1: none, -2: several
  double length = 0;
  std::vector<std::array<int, 2>> sides;  ///< sides in their direction around the face
  bool simple = true;                     ///< whether every point has one incoming and one outgoing side
  bool named = false;                     ///< whether one of its curves has a kept name
};

/// Returns the loops of all faces, by face.
std::vector<std::vector<Loop>> find_loops(const Mesh& mesh, const KeptNames& keep) {
  struct HoleSide {
    std::array<int, 2> ends;
    int other;
    bool named;
  };
  std::vector<std::vector<HoleSide>> of_face(mesh.regions.size());
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l) {
    const auto [a, b] = mesh.lines[l];
    const bool named = keep.any_of(mesh.curves[mesh.line_curve[l]]);
    const auto edge = sides_of_edge(std::span(sides), a, b);
    for (const HalfEdge& side : edge) {
      const int face = mesh.triangle_region[side.element];
      const int other = edge.size() == 1   ? -1
                        : edge.size() == 2 ? mesh.triangle_region[edge[&side == &edge[0]].element]
                                           : -2;
      if (other == face) continue;  // a seam
      of_face[face].push_back({side.run(), other, named});
    }
  }
  std::vector<std::vector<Loop>> loops(mesh.regions.size());
  for (std::size_t face = 0; face < of_face.size(); ++face) {
    std::map<int, int> number;  // numbers of points
    for (const HoleSide& side : of_face[face])
      for (const int p : side.ends) number.try_emplace(p, static_cast<int>(number.size()));
    DisjointSets sets(number.size());
    for (const HoleSide& side : of_face[face]) sets.join_to(number.at(side.ends[1]), number.at(side.ends[0]));
    std::map<int, Loop> by_set;
    for (const HoleSide& side : of_face[face]) {
      Loop& loop = by_set[sets.root(number.at(side.ends[0]))];
      if (loop.face >= 0 && loop.other != side.other) loop.other = -2;
      if (loop.face < 0) loop.other = side.other;
      loop.face = static_cast<int>(face);
      loop.length += norm(mesh.points[side.ends[1]] - mesh.points[side.ends[0]]);
      loop.sides.push_back(side.ends);
      loop.named |= side.named;
    }
    for (auto& [set, loop] : by_set) {
      std::map<int, std::array<int, 2>> passes;
      for (const auto& [from, to] : loop.sides) ++passes[from][0], ++passes[to][1];
      loop.simple = std::ranges::all_of(passes, [](const auto& p) { return p.second == std::array{1, 1}; });
      loops[face].push_back(std::move(loop));
    }
  }
  return loops;
}

class SmallHoles {
 public:
  SmallHoles(SurfaceModel& model, const NarrowOptions& narrow)
      : model_(model),
        mesh_(model.fine),
        length_(narrow.length),
        keep_(narrow.keep),
        loops_(find_loops(mesh_, narrow.keep)),
        tube_(mesh_.regions.size(), 0) {}

  /// Closes holes. Returns whether any was closed.
  bool close() {
    find_tubes();
    std::set<int> kept;  // tubes with an end that cannot be closed
    for (const auto& loops : loops_)
      for (const Loop& loop : loops)
        if (is_end(loop) && loop.other != -1 && !(loop.other >= 0 && closable(counterpart(loop))))
          kept.insert(tube_[loop.face]);
    for (int& tube : tube_)
      if (kept.contains(tube)) tube = 0;
    std::vector<const Loop*> holes;
    for (const auto& loops : loops_)
      for (const Loop& loop : loops)
        if (closable(loop) &&
            (loop.other == -1 ? !is_small_face(loop.face) : loop.other >= 0 && tube_[loop.other] > 0))
          holes.push_back(&loop);
    for (const Loop* hole : holes) fill(*hole);
    if (holes.empty()) return false;
    drop_tubes();
    return true;
  }

 private:
  bool is_short(const Loop& loop) const { return loop.length < length_; }
  bool is_end(const Loop& loop) const {
    return tube_[loop.face] > 0 && (loop.other < 0 || tube_[loop.other] != tube_[loop.face]);
  }
  bool closable(const Loop& loop) const {
    return is_short(loop) && loop.simple && loop.sides.size() > 2 && tube_[loop.face] == 0 &&
           !loses_name(loop);
  }
  /// Returns whether a kept name, of a curve of the hole or a face behind it, would be lost.
  bool loses_name(const Loop& loop) const {
    if (loop.named) return true;
    for (std::size_t face = 0; face < tube_.size() && loop.other >= 0; ++face) {
      if (tube_[face] == 0 || tube_[face] != tube_[loop.other]) continue;
      if (!has_names_of(mesh_.regions[loop.face], mesh_.regions[face], keep_) ||
          std::ranges::any_of(loops_[face], &Loop::named))
        return true;
    }
    return false;
  }
  /// Returns the same loop of the face on the other side, or a loop that cannot be closed if that has more
  /// sides.
  Loop counterpart(const Loop& loop) const {
    for (const Loop& other : loops_[loop.other]) {
      const auto [from, to] = loop.sides[0];
      const bool shares = std::ranges::any_of(other.sides, [&](const auto& s) {
        return (s[0] == to && s[1] == from) || (s[0] == from && s[1] == to);
      });
      if (shares && other.sides.size() == loop.sides.size() && other.other == loop.face) return other;
    }
    return {};
  }
  bool all_short(int face) const {
    return !loops_[face].empty() &&
           std::ranges::all_of(loops_[face], [&](const Loop& loop) { return is_short(loop); });
  }
  /// Returns whether a face is small and has no other outline, so that its outline is no hole.
  bool is_small_face(int face) const { return all_short(face) && area_of({face}) < length_ * length_; }

  double area_of(const std::set<int>& faces) const {
    double area = 0;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (faces.contains(mesh_.triangle_region[t])) area += norm(area_vector(mesh_, t)) / 2;
    return area;
  }

  double extent_of(const std::set<int>& faces) const {
    std::vector<Vec3> points;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (faces.contains(mesh_.triangle_region[t]))
        for (const int v : mesh_.triangles[t]) points.push_back(mesh_.points[v]);
    return diagonal(points);
  }

  /// Numbers the tubes from 1 in `tube_`.
  void find_tubes() {
    DisjointSets sets(loops_.size());
    for (const auto& loops : loops_)
      for (const Loop& loop : loops)
        if (loop.other >= 0 && all_short(loop.face) && all_short(loop.other))
          sets.join(loop.face, loop.other);
    std::map<int, std::set<int>> groups;
    for (int face = 0; face < static_cast<int>(loops_.size()); ++face)
      if (all_short(face)) groups[sets.root(face)].insert(face);
    int n = 0;
    for (const auto& [first, faces] : groups) {
      bool has_end = false;
      for (const int face : faces)
        for (const Loop& loop : loops_[face]) has_end |= loop.other >= 0 && !faces.contains(loop.other);
      if (!has_end || area_of(faces) > kTubeArea * length_ * extent_of(faces)) continue;
      ++n;
      for (const int face : faces) tube_[face] = n;
    }
  }

  /// Closes a hole by triangles around its middle.
  void fill(const Loop& hole) {
    Vec3 middle;
    for (const auto& side : hole.sides)
      middle = middle + (1.0 / static_cast<double>(hole.sides.size())) * mesh_.points[side[0]];
    if (model_.projector) middle = model_.projector->to_face(hole.face, middle);
    const int node = static_cast<int>(mesh_.points.size());
    mesh_.points.push_back(middle);
    std::set<std::array<int, 2>> gone;
    for (const auto& [from, to] : hole.sides) {
      mesh_.triangles.push_back({to, from, node});
      mesh_.triangle_region.push_back(hole.face);
      gone.insert({std::min(from, to), std::max(from, to)});
    }
    const Entity& face = mesh_.regions[hole.face];
    model_.warnings.push_back({"small holes that were closed", 1 / hole.length,
                               fmt::format("face {}: closed a hole of {:.3g} around at {}", face.tag,
                                           hole.length, show_point(middle))});
    keep_lines(mesh_, [&](std::size_t i) {
      const auto [a, b] = mesh_.lines[i];
      return !gone.contains({std::min(a, b), std::max(a, b)});
    });
  }

  void drop_tubes() {
    keep_triangles(mesh_, [&](std::size_t t) { return tube_[mesh_.triangle_region[t]] <= 0; });
    drop_stray_lines(mesh_, sorted_half_edges(mesh_));
    for (std::size_t face = 0; face < tube_.size(); ++face)
      if (tube_[face] > 0)
        model_.warnings.push_back(
            {"faces of small holes that went", 0,
             fmt::format("face {} went with the hole that it lines", mesh_.regions[face].tag)});
  }

  SurfaceModel& model_;
  Mesh& mesh_;
  double length_;
  const KeptNames& keep_;
  std::vector<std::vector<Loop>> loops_;
  std::vector<int> tube_;  ///< tube of each face, from 1; 0: none
};

}  // namespace

SurfaceModel close_small_holes(SurfaceModel model, const NarrowOptions& narrow) {
  const Mesh former = model.fine;
  if (!SmallHoles(model, narrow).close()) return model;
  tidy_model(model, former);
  return model;
}

}  // namespace delquad
