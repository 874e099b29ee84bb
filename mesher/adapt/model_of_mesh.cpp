// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "base/located.h"
#include "base/text.h"
#include "geometry/mesh/half_edges.h"
#include "mesher/adapt/adapt.h"
#include "mesher/adapt/elements.h"

namespace delquad {
namespace {

/// Largest turn of a straight line, radians, since coordinates in files are rounded.
constexpr double kStraight = 1e-6;
/// Largest turn of a smooth curve between nodes, radians. It is less than at a corner, so the curve stays
/// smooth when traced again.
constexpr double kMostTurn = 30 * std::numbers::pi / 180;

Vec2 flat(const Vec3& p) { return {p.x, p.y}; }
double turn_between(Vec2 in, Vec2 out) { return std::atan2(cross(in, out), dot(in, out)); }

/// Cubic between nodes, with tangents of circles through three nodes. Arcs stay arcs, to the sixth power of
/// their angle.
class SmoothChain final : public Curve {
 public:
  /// `is_closed` makes it smooth at its first point, where it ends.
  SmoothChain(std::vector<Vec2> points, bool is_closed) : points_(std::move(points)), at_{0} {
    const int n = static_cast<int>(points_.size());
    for (int i = 1; i < n; ++i) at_.push_back(at_.back() + norm(points_[i] - points_[i - 1]));
    const double length = at_.back();
    for (double& t : at_) t /= length;
    for (int i = 0; i < n; ++i) {
      if (is_closed && (i == 0 || i == n - 1)) {
        tangent_.push_back(tangent(points_[n - 2], points_[0], points_[1], 1));
        continue;
      }
      const int middle = std::clamp(i, 1, n - 2);
      tangent_.push_back(tangent(points_[middle - 1], points_[middle], points_[middle + 1], i - middle + 1));
    }
    double turned = 0;
    for (int i = 1; i < n - 1; ++i) {
      turned += std::abs(turn_between(tangent_[i - 1], tangent_[i]));
      if (turned + std::abs(turn_between(tangent_[i], tangent_[i + 1])) <= kMostTurn) continue;
      nodes_.push_back(at_[i]);
      turned = 0;
    }
  }

  Vec2 point(double t) const override {
    const auto after = std::upper_bound(at_.begin() + 1, at_.end() - 1, t);
    const auto k = static_cast<std::size_t>(after - at_.begin());
    const double x = std::clamp((t - at_[k - 1]) / (at_[k] - at_[k - 1]), 0.0, 1.0);
    if (x == 0) return points_[k - 1];
    if (x == 1) return points_[k];
    const Vec2 a = points_[k - 1], d = points_[k];
    // Control points of an arc.
    const double quarter = std::cos(turn_between(tangent_[k - 1], tangent_[k]) / 4);
    const double handle = norm(d - a) / (3 * quarter * quarter);
    const Vec2 b = a + handle * tangent_[k - 1], c = d - handle * tangent_[k];
    const double y = 1 - x;
    return (y * y * y) * a + (3 * x * y * y) * b + (3 * x * x * y) * c + (x * x * x) * d;
  }

  std::vector<double> fixed_parameters() const override { return nodes_; }

 private:
  /// Returns the tangent of the circle through three points at one of them.
  static Vec2 tangent(Vec2 a, Vec2 b, Vec2 c, int which) {
    const Vec2 in = b - a, out = c - b;
    // Chords and tangents enclose half of the arcs' angles.
    const double turn = turn_between(in, out), whole = norm(c - a);
    const double before = std::asin(std::clamp(std::sin(turn) * norm(in) / whole, -1.0, 1.0)),
                 after = turn - before;
    const Vec2 d = which == 2 ? out : in;
    const double angle = std::atan2(d.y, d.x) + (which == 0 ? -before : which == 1 ? before : after);
    return {std::cos(angle), std::sin(angle)};
  }

  std::vector<Vec2> points_;
  std::vector<double> at_;  ///< parameters of the points
  std::vector<Vec2> tangent_;
  std::vector<double> nodes_;  ///< parameters at which the mesh has nodes
};

/// A side that becomes an edge again.
struct Side {
  std::array<int, 2> nodes;
  int curve;                   ///< curve in the mesh; one more: it has no line
  std::array<int, 2> regions;  ///< regions of the elements left and right of it; -1: none
};

class MeshTracer {
 public:
  explicit MeshTracer(const Mesh& mesh) : mesh_(mesh), sides_at_(mesh.points.size()) {}

  PlanarModel trace() {
    find_sides();
    refuse_cracks();
    mark_ends();
    curve_of_.assign(sides_.size(), -1);
    for (int s = 0; s < std::ssize(sides_); ++s)
      for (const int v : sides_[s].nodes)
        if (is_end_[v] && curve_of_[s] < 0) follow(s, v);
    for (int s = 0; s < std::ssize(sides_); ++s)
      if (curve_of_[s] < 0) follow(s, sides_[s].nodes[0]);
    add_loops();
    for (const NamedPoint& named : mesh_.named_points)
      made_.points.push_back(
          {flat(mesh_.points[named.point]), std::to_string(&named - mesh_.named_points.data()), ""});
    return std::move(made_);
  }

 private:
  /// Refuses two points at the same place, since a curve would close the opening.
  void refuse_cracks() const {
    std::vector<std::array<double, 2>> places;
    for (std::size_t v = 0; v < sides_at_.size(); ++v)
      if (!sides_at_[v].empty()) places.push_back({mesh_.points[v].x, mesh_.points[v].y});
    std::ranges::sort(places);
    if (const auto twice = std::ranges::adjacent_find(places); twice != places.end())
      refuse("two points of the mesh lie at {}, as at a crack, which cannot be traced: expected a model",
             show_point(Vec2{(*twice)[0], (*twice)[1]}));
  }

  void find_sides() {
    std::map<std::pair<int, int>, int> curve_of;
    for (std::size_t l = 0; l < mesh_.lines.size(); ++l)
      curve_of[std::minmax(mesh_.lines[l][0], mesh_.lines[l][1])] = mesh_.line_curve[l];
    const auto n_curves = static_cast<int>(mesh_.curves.size());
    std::vector<char> is_clockwise;
    for_each_element(mesh_, [&](int, const auto& v) {
      const Vec2 a = flat(mesh_.points[v[0]]), c = flat(mesh_.points[v[2]]);
      is_clockwise.push_back(cross(c - a, flat(mesh_.points[v.back()] - mesh_.points[v[1]])) < 0);
    });
    for_each_edge(sorted_half_edges(mesh_), [&](std::span<const HalfEdge> edge) {
      if (edge.size() > 2)
        refuse("more than two elements meet at {}: expected a planar mesh",
               show_point(mesh_.points[edge[0].lo]));
      const int lo = edge[0].lo, hi = edge[0].hi;
      std::array<int, 2> regions{-1, -1};
      for (const HalfEdge& side : edge)
        regions[side.forward == (is_clockwise[side.element] == 0) ? 0 : 1] = region_of(mesh_, side.element);
      const auto line = curve_of.find({lo, hi});
      if (line == curve_of.end() && regions[0] == regions[1]) return;
      for (const int v : {lo, hi}) sides_at_[v].push_back(static_cast<int>(sides_.size()));
      sides_.push_back({{lo, hi}, line == curve_of.end() ? n_curves : line->second, regions});
    });
  }

  int other_end(int side, int node) const {
    return sides_[side].nodes[0] == node ? sides_[side].nodes[1] : sides_[side].nodes[0];
  }

  /// Returns the turn at a node in radians; 0 at ends.
  double turn_at(int node) const {
    const auto& at = sides_at_[node];
    if (at.size() != 2) return 0;
    const Vec2 x = flat(mesh_.points[node]);
    return std::abs(turn_between(x - flat(mesh_.points[other_end(at[0], node)]),
                                 flat(mesh_.points[other_end(at[1], node)]) - x));
  }

  void mark_ends() {
    is_end_.assign(mesh_.points.size(), 0);
    for (const NamedPoint& named : mesh_.named_points) is_end_[named.point] = 1;
    for (int v = 0; v < std::ssize(sides_at_); ++v) {
      const auto& at = sides_at_[v];
      if (at.size() != 2) {
        is_end_[v] = !at.empty();
        continue;
      }
      const Side &a = sides_[at[0]], &b = sides_[at[1]];
      if (a.curve != b.curve ||
          std::minmax(a.regions[0], a.regions[1]) != std::minmax(b.regions[0], b.regions[1]))
        is_end_[v] = 1;
      const double turn = turn_at(v);
      const auto is_straight = [&](int side) {
        const int node = other_end(side, v);
        return sides_at_[node].size() == 2 && turn_at(node) < kStraight;
      };
      if (turn > kCornerTurn * std::numbers::pi / 180 ||
          (turn > kStraight && (is_straight(at[0]) || is_straight(at[1]))))
        is_end_[v] = 1;
    }
  }

  /// Adds the curve that begins at a node with this side.
  void follow(int side, int from) {
    const int curve = static_cast<int>(made_.curves.size());
    std::vector<int> chain{from};
    for (;;) {
      curve_of_[side] = curve;
      chain.push_back(other_end(side, chain.back()));
      const int node = chain.back();
      if (is_end_[node] || node == from) break;
      side = sides_at_[node][sides_at_[node][0] == side ? 1 : 0];
    }
    std::vector<Vec2> points;
    for (const int v : chain) points.push_back(flat(mesh_.points[v]));
    const bool is_straight =
        std::all_of(chain.begin() + 1, chain.end() - 1, [&](int v) { return turn_at(v) < kStraight; });
    ModelCurve& made = made_.curves.emplace_back();
    made.shape = is_straight ? make_segment(points.front(), points.back())
                             : std::make_shared<SmoothChain>(std::move(points), !is_end_[from]);
    made.where = fmt::format("the curve from {}", show_point(flat(mesh_.points[from])));
    made.name = std::to_string(sides_[side].curve);
  }

  /// Adds the loops around each part of a region, which lies on their left.
  void add_loops() {
    std::set<std::pair<int, int>> left;  // side, and 0 if it runs from lo to hi
    for (int s = 0; s < std::ssize(sides_); ++s)
      for (const int k : {0, 1})
        if (sides_[s].regions[0] != sides_[s].regions[1] && sides_[s].regions[k] >= 0) left.insert({s, k});
    while (!left.empty()) {
      auto [side, way] = *left.begin();
      const int region = sides_[side].regions[way];
      ModelLoop loop;
      double area = 0;
      bool has_void = false;
      while (left.erase({side, way}) > 0) {
        const auto& [lo, hi] = sides_[side].nodes;
        const Vec2 a = flat(mesh_.points[way == 0 ? lo : hi]), b = flat(mesh_.points[way == 0 ? hi : lo]);
        area += cross(a, b) / 2;
        has_void = has_void || sides_[side].regions[1 - way] < 0;
        if (loop.curves.empty() || loop.curves.back() != curve_of_[side])
          loop.curves.push_back(curve_of_[side]);
        std::tie(side, way) = next_of(side, way, region);
      }
      if (loop.curves.size() > 1 && loop.curves.back() == loop.curves.front()) loop.curves.pop_back();
      loop.where =
          fmt::format("the outline through {}", show_point(flat(mesh_.points[sides_[side].nodes[0]])));
      if (area > 0) loop.region = std::to_string(region);
      if (area > 0 || has_void) made_.loops.push_back(std::move(loop));
    }
  }

  /// Returns the next side around a part of a region: the first one to the left.
  std::pair<int, int> next_of(int side, int way, int region) const {
    const int node = sides_[side].nodes[1 - way];
    const Vec2 in = flat(mesh_.points[node]) - flat(mesh_.points[sides_[side].nodes[way]]);
    std::pair<int, int> next{side, 1 - way};
    double best = -4;
    for (const int s : sides_at_[node])
      for (const int k : {0, 1}) {
        if (sides_[s].nodes[k] != node || sides_[s].regions[k] != region ||
            sides_[s].regions[1 - k] == region)
          continue;
        const double turn =
            turn_between(in, flat(mesh_.points[sides_[s].nodes[1 - k]]) - flat(mesh_.points[node]));
        if (turn > best) best = turn, next = {s, k};
      }
    return next;
  }

  const Mesh& mesh_;
  std::vector<Side> sides_;
  std::vector<std::vector<int>> sides_at_;
  std::vector<char> is_end_;
  std::vector<int> curve_of_;  ///< curve of each side
  PlanarModel made_;
};

}  // namespace

PlanarModel trace_mesh(const Mesh& mesh) {
  require_planar(mesh, "the mesh of the solution");
  PlanarModel made = MeshTracer(mesh).trace();
  made.source = "the mesh of the solution";
  return made;
}

}  // namespace delquad
