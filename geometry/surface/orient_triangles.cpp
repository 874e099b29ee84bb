#include "geometry/surface/triangle_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/box.h"
#include "base/text.h"
#include "delquad/error.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/surface/triangle_sides.h"

namespace delquad {

namespace {

struct Component {
  std::vector<int> triangles;
  bool closed = true;
  double volume = 0;  ///< that it encloses, negative when its triangles face inwards
  Box<Vec3> box;

  bool within_box_of(const Component& other) const {
    return box.low.x > other.box.low.x && box.low.y > other.box.low.y && box.low.z > other.box.low.z &&
           box.high.x < other.box.high.x && box.high.y < other.box.high.y && box.high.z < other.box.high.z;
  }
  double box_volume() const { return box.size().x * box.size().y * box.size().z; }
};

/// Whether two triangles run the same way along the edge that they share, so that they disagree.
bool run_alike(const Mesh& mesh, int side, int twin) {
  return side_start(mesh, side) == side_start(mesh, twin);
}

[[noreturn]] void refuse_one_sided(const Mesh& mesh, int side, const std::string& source) {
  throw InputError(
      fmt::format("{}: the surface has one side only, like a Moebius band (found at the edge from {} "
                  "to {}): expected two "
                  "sides",
                  source, show_point(mesh.points[side_start(mesh, side)]),
                  show_point(mesh.points[side_end(mesh, side)])));
}

/// Collects the component of triangle `seed`; `turn` says for each of its triangles (-1 before) whether it
/// runs against the seed. `clash`: a side where that cannot be.
Component collect(const Mesh& mesh, const std::vector<int>& twin, int seed, std::vector<signed char>& turn,
                  int& clash) {
  Component component;
  turn[seed] = 0;
  component.triangles = {seed};
  for (size_t i = 0; i < component.triangles.size(); ++i) {
    const int t = component.triangles[i];
    for (int side = 3 * t; side < 3 * t + 3; ++side) {
      if (twin[side] < 0) {
        component.closed = false;
        continue;
      }
      const int u = twin[side] / 3;
      const signed char wanted = run_alike(mesh, side, twin[side]) ? 1 - turn[t] : turn[t];
      if (turn[u] < 0) {
        turn[u] = wanted;
        component.triangles.push_back(u);
      } else if (turn[u] != wanted) {
        clash = side;
      }
    }
  }
  return component;
}

/// Radians by which the surface turns at an edge, were its triangles to agree.
double turn_at(const Mesh& mesh, int side, int twin) {
  const double sign = run_alike(mesh, side, twin) ? -1 : 1;
  return angle_between(area_vector(mesh, side / 3), sign * area_vector(mesh, twin / 3));
}

/// Triangles that are known to agree, or to disagree, with others.
class Agreements {
 public:
  explicit Agreements(size_t n) : above_(n), against_(n, 0), size_(n, 1) {
    std::iota(above_.begin(), above_.end(), 0);
  }

  /// Joins them; false where it is known that they are the other way.
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
  /// Goes to the top; whether t is against it.
  bool climb(int& t) const {
    bool against = false;
    for (; above_[t] != t; t = above_[t]) against ^= against_[t] != 0;
    return against;
  }

  std::vector<int> above_;
  std::vector<char> against_;  ///< the one above
  std::vector<int> size_;
};

/// Parts neighbours that cannot agree at the sharpest edges on the way from one to the other: joints of
/// sheets, which bound faces anyway. Refuses a surface that is smooth there.
void part_at_joints(const Mesh& mesh, const std::string& source, std::vector<int>& twin,
                    std::vector<Warning>& warnings) {
  constexpr double kJoint = 40 * std::numbers::pi / 180;  // where faces end, see TriangulatedOptions
  std::vector<std::pair<double, int>> edges;
  for (int side = 0; side < static_cast<int>(twin.size()); ++side)
    if (twin[side] > side) edges.emplace_back(turn_at(mesh, side, twin[side]), side);
  std::ranges::sort(edges);
  Agreements agreements(mesh.triangles.size());
  int parted = 0, first = -1;
  for (const auto& [angle, side] : edges) {
    const int other = twin[side];
    if (agreements.join(side / 3, other / 3, run_alike(mesh, side, other))) continue;
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

std::vector<Component> collect_all(const Mesh& mesh, const std::vector<int>& twin,
                                   std::vector<signed char>& turn, int& clash) {
  turn.assign(mesh.triangles.size(), -1);
  std::vector<Component> components;
  for (size_t seed = 0; seed < turn.size(); ++seed)
    if (turn[seed] < 0) components.push_back(collect(mesh, twin, static_cast<int>(seed), turn, clash));
  return components;
}

void measure(const Mesh& mesh, const std::vector<signed char>& turn, Component& component) {
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

void turn_over(const Component& component, std::vector<signed char>& turn) {
  for (const int t : component.triangles) turn[t] = 1 - turn[t];
}

}  // namespace

void orient_triangles(Mesh& mesh, const std::string& source, std::vector<Warning>& warnings, bool may_part) {
  std::vector<int> twin = side_twins(mesh);
  std::vector<signed char> turn;
  int clash = -1;
  std::vector<Component> components = collect_all(mesh, twin, turn, clash);
  if (clash >= 0) {
    if (!may_part) refuse_one_sided(mesh, clash, source);
    part_at_joints(mesh, source, twin, warnings);
    components = collect_all(mesh, twin, turn, clash);
  }
  std::vector<Component> closed;
  size_t largest = 0;
  int against = 0;
  Vec3 first;
  for (Component& component : components) {
    const auto turned = [&](int t) { return turn[t] == 1; };
    const auto& all = component.triangles;
    if (2 * std::count_if(all.begin(), all.end(), turned) > static_cast<long>(all.size())) {
      turn_over(component, turn);
    }
    const auto odd = std::find_if(all.begin(), all.end(), turned);
    if (odd != all.end() && against == 0) first = mesh.points[mesh.triangles[*odd][0]];
    against += static_cast<int>(std::count_if(all.begin(), all.end(), turned));
    if (!component.closed) continue;
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
    warnings.push_back(fmt::format("turned over {} against the neighbours' orientation (the first at {})",
                                   counted(against, "triangle"), show_point(first)));
  }
  if (inwards > 0) warnings.push_back("turned outwards " + counted(inwards, "closed surface"));
}

}  // namespace delquad
