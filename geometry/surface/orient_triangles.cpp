// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/triangle_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/box.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/mesh/turn_to_agree.h"
#include "geometry/surface/triangle_sides.h"

namespace delquad {

namespace {

struct Component {
  std::vector<int> triangles;
  double volume = 0;  ///< enclosed volume, negative if its triangles face inwards
  Box<Vec3> box{};

  bool within_box_of(const Component& other) const {
    return box.low.x > other.box.low.x && box.low.y > other.box.low.y && box.low.z > other.box.low.z &&
           box.high.x < other.box.high.x && box.high.y < other.box.high.y && box.high.z < other.box.high.z;
  }
  double box_volume() const { return box.size().x * box.size().y * box.size().z; }
};

/// Returns whether two triangles disagree: they have the same direction along their common edge.
bool orientations_disagree(const Mesh& mesh, int side, int twin) {
  return side_start(mesh, side) == side_start(mesh, twin);
}

[[noreturn]] void refuse_one_sided(const Mesh& mesh, int side, const std::string& source) {
  throw InputError(
      fmt::format("{}: the surface has one side only, like a Moebius band (found at the edge from {} "
                  "to {}): expected two "
                  "sides [one-side]",
                  source, show_point(mesh.points[side_start(mesh, side)]),
                  show_point(mesh.points[side_end(mesh, side)])));
}

/// Returns the angle, radians, by which the surface would turn at an edge if its triangles agreed.
double turn_at(const Mesh& mesh, int side, int twin) {
  const double sign = orientations_disagree(mesh, side, twin) ? -1 : 1;
  return angle_between(area_vector(mesh, side / 3), sign * area_vector(mesh, twin / 3));
}

/// Known agreements and disagreements of triangles.
class Agreements {
 public:
  explicit Agreements(size_t n) : above_(n), against_(n, 0), size_(n, 1) {
    std::iota(above_.begin(), above_.end(), 0);
  }

  /// Joins two triangles. Returns false if the opposite is known already.
  bool join(int t, int u, bool against) {
    against ^= climb(t);
    against ^= climb(u);
    if (t == u) return !against;
    if (size_[t] < size_[u]) std::swap(t, u);
    above_[u] = t;
    against_[u] = against;
    size_[t] += size_[u];
    return true;
  }

 private:
  /// Replaces t by its root. Returns whether t disagrees with it.
  bool climb(int& t) const {
    bool against = false;
    for (; above_[t] != t; t = above_[t]) against ^= against_[t] != 0;
    return against;
  }

  std::vector<int> above_;
  std::vector<char> against_;  ///< whether each triangle disagrees with its parent
  std::vector<int> size_;
};

/// Separates neighbors that cannot agree at the sharpest edges between them, which are joints of sheets.
/// Throws InputError if the surface is smooth there.
void split_at_joints(const Mesh& mesh, const std::string& source, std::vector<int>& twin,
                     std::vector<Warning>& warnings) {
  constexpr double kJoint = 40 * std::numbers::pi / 180;  // turn at which faces end, see TriangulatedOptions
  std::vector<std::pair<double, int>> edges;
  for (int side = 0; side < static_cast<int>(twin.size()); ++side)
    if (twin[side] > side) edges.emplace_back(turn_at(mesh, side, twin[side]), side);
  std::ranges::sort(edges);
  Agreements agreements(mesh.triangles.size());
  int parted = 0, first = -1;
  for (const auto& [angle, side] : edges) {
    const int other = twin[side];
    if (agreements.join(side / 3, other / 3, orientations_disagree(mesh, side, other))) continue;
    if (!(angle > kJoint)) refuse_one_sided(mesh, side, source);
    if (parted++ == 0) first = side;
    twin[side] = twin[other] = -1;
  }
  warnings.push_back(
      fmt::format("the sides of the surface do not agree at {}, where sheets are taken to be joined (the "
                  "first from {} to {})",
                  counted(parted, "sharp edge"), show_point(mesh.points[side_start(mesh, first)]),
                  show_point(mesh.points[side_end(mesh, first)])));
}

/// Returns which triangles must be reversed so that neighbors agree. `edges` gets the common sides of
/// neighbors.
Turned turn_neighbors(const Mesh& mesh, const std::vector<int>& twin, std::vector<int>& edges) {
  std::vector<Neighbours> neighbors;
  edges.clear();
  for (int side = 0; side < static_cast<int>(twin.size()); ++side)
    if (twin[side] > side) {
      edges.push_back(side);
      neighbors.push_back({side / 3, twin[side] / 3, !orientations_disagree(mesh, side, twin[side])});
    }
  return turn_to_agree(mesh.triangles.size(), neighbors);
}

void measure(const Mesh& mesh, const std::vector<char>& turn, Component& component) {
  const Vec3 origin = mesh.points[mesh.triangles[component.triangles[0]][0]];
  component.box = {origin, origin};
  for (const int t : component.triangles) {
    std::array<Vec3, 3> p;
    for (int k = 0; k < 3; ++k) {
      p[k] = mesh.points[mesh.triangles[t][k]];
      component.box.add(p[k]);
    }
    const double volume = dot(p[0] - origin, cross(p[1] - origin, p[2] - origin)) / 6;
    component.volume += turn[t] ? -volume : volume;
  }
}

void turn_over(const Component& component, std::vector<char>& turn) {
  for (const int t : component.triangles) turn[t] = 1 - turn[t];
}

}  // namespace

void orient_triangles(Mesh& mesh, const std::string& source, std::vector<Warning>& warnings, bool may_part) {
  std::vector<int> twin = side_twins(mesh);
  std::vector<int> edges;
  Turned turned = turn_neighbors(mesh, twin, edges);
  if (turned.clash >= 0) {
    if (!may_part) refuse_one_sided(mesh, edges[turned.clash], source);
    split_at_joints(mesh, source, twin, warnings);
    turned = turn_neighbors(mesh, twin, edges);
  }
  std::vector<char>& turn = turned.is_turned;
  const auto is_turned = [&](int t) { return turn[t] == 1; };
  const auto has_open_side = [&](int t) { return std::count(&twin[3 * t], &twin[3 * t] + 3, -1) > 0; };
  std::vector<Component> closed;
  size_t largest = 0;
  int against = 0;
  Vec3 first;
  for (std::vector<int>& all : turned.pieces) {
    Component component{std::move(all)};
    if (2 * std::ranges::count_if(component.triangles, is_turned) > std::ssize(component.triangles))
      turn_over(component, turn);
    const auto odd = std::ranges::find_if(component.triangles, is_turned);
    if (odd != component.triangles.end() && against == 0) first = mesh.points[mesh.triangles[*odd][0]];
    against += static_cast<int>(std::ranges::count_if(component.triangles, is_turned));
    if (std::ranges::any_of(component.triangles, has_open_side)) continue;
    measure(mesh, turn, component);
    closed.push_back(std::move(component));
    if (closed.back().box_volume() > closed[largest].box_volume()) largest = closed.size() - 1;
  }
  int inwards = 0;
  for (const Component& component : closed) {
    if (component.volume >= 0 || component.within_box_of(closed[largest])) continue;
    turn_over(component, turn);
    ++inwards;
  }
  for (size_t t = 0; t < turn.size(); ++t) {
    if (turn[t] == 1) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  if (against > 0) {
    warnings.push_back(fmt::format("turned over {} against the orientation of neighbors (the first at {})",
                                   counted(against, "triangle"), show_point(first)));
  }
  if (inwards > 0) warnings.push_back("turned outwards " + counted(inwards, "closed surface"));
}

}  // namespace delquad
