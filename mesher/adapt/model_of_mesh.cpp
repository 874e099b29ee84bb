// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "base/located.h"
#include "base/text.h"
#include "features/given/given_surface.h"
#include "geometry/mesh/half_edges.h"
#include "geometry/surface/chart.h"
#include "geometry/surface/curve_chains.h"
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

/// Traces a mesh that is seen as a flat surface.
class MeshTracer {
 public:
  explicit MeshTracer(GivenMesh mesh)
      : surface_(make_flat_surface(mesh)), mesh_(std::move(mesh.mesh)), sides_at_(mesh_.points.size()) {}

  PlanarModel trace() {
    find_sides();
    refuse_cracks();
    mark_ends();
    for (const EdgeChain& chain : chain_edges(sides_, [&](int v) { return is_end_[v] != 0; })) add(chain);
    add_loops();
    return std::move(made_);
  }

 private:
  int at(int fine_point) const { return surface_.given_point[fine_point]; }
  Vec2 place(int v) const { return flat(mesh_.points[v]); }

  /// Sides that become edges again are lines of the surface, but not those beside single points and lines.
  void find_sides() {
    const SurfaceModel& model = surface_.model;
    std::set<int> helpers;
    for (const EmbeddedCurve& embedded : model.embedded)
      if (surface_.given_curve[embedded.curve] < 0) helpers.insert(embedded.curve);
    for (std::size_t l = 0; l < model.fine.lines.size(); ++l) {
      const auto [a, b] = model.fine.lines[l];
      const int curve = model.fine.line_curve[l], given = surface_.given_curve[curve];
      if (helpers.contains(curve)) continue;
      for (const int v : {at(a), at(b)}) sides_at_[v].push_back(static_cast<int>(sides_.size()));
      side_of_[std::minmax({at(a), at(b)})] = static_cast<int>(sides_.size());
      sides_.push_back({at(a), at(b)});
      name_.push_back(given < 0 ? static_cast<int>(mesh_.curves.size()) : given);
    }
  }

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

  int other_end(int side, int node) const {
    return sides_[side][0] == node ? sides_[side][1] : sides_[side][0];
  }

  /// Returns the turn at a node in radians; 0 at ends.
  double turn_at(int node) const {
    const auto& at = sides_at_[node];
    if (at.size() != 2) return 0;
    const Vec2 x = place(node);
    return std::abs(turn_between(x - place(other_end(at[0], node)), place(other_end(at[1], node)) - x));
  }

  void mark_ends() {
    is_end_.assign(mesh_.points.size(), 0);
    for (const NamedPoint& named : mesh_.named_points) is_end_[named.point] = 1;
    for (int v = 0; v < std::ssize(sides_at_); ++v) {
      const double turn = turn_at(v);
      if (sides_at_[v].size() == 2 && name_[sides_at_[v][0]] != name_[sides_at_[v][1]]) is_end_[v] = 1;
      const auto is_straight = [&](int side) {
        const int node = other_end(side, v);
        return sides_at_[node].size() == 2 && turn_at(node) < kStraight;
      };
      if (turn > kCornerTurn * std::numbers::pi / 180 ||
          (turn > kStraight && std::ranges::any_of(sides_at_[v], is_straight)))
        is_end_[v] = 1;
    }
  }

  void add(const EdgeChain& chain) {
    for (const int side : chain.edges) curve_of_[side] = static_cast<int>(made_.curves.size());
    const auto& v = chain.points;
    std::vector<Vec2> points;
    for (const int node : v) points.push_back(place(node));
    ModelCurve& made = made_.curves.emplace_back();
    made.where = fmt::format("the curve from {}", show_point(points[0]));
    made.name = std::to_string(name_[chain.edges[0]]);
    if (std::all_of(v.begin() + 1, v.end() - 1, [&](int node) { return turn_at(node) < kStraight; }))
      made.shape = make_segment(points.front(), points.back());
    else
      made.shape = std::make_shared<SmoothChain>(std::move(points), !is_end_[v[0]]);
  }

  /// Adds the loops around each part of a region, and the holes that no region fills.
  void add_loops() {
    Mesh& fine = surface_.model.fine;
    for (int& face : fine.triangle_region) face = surface_.given_region[face];
    fine.regions = mesh_.regions;
    const std::vector<HalfEdge> halves = sorted_half_edges(fine);
    std::vector<char> is_inside;  // lines with one region on both sides
    std::set<int> free;           // sides without
    for (const auto& [a, b] : fine.lines) {
      const auto beside = sides_of_edge(halves, a, b);
      is_inside.push_back(beside.size() == 2 &&
                          region_of(fine, beside[0].element) == region_of(fine, beside[1].element));
      if (beside.size() == 1) free.insert(side_of_.at(std::minmax({at(a), at(b)})));
    }
    for (const Chart& chart : extract_charts(fine, std::vector<char>(fine.triangles.size(), 1), is_inside))
      for (const auto& vertices : chart.loops) {
        ModelLoop loop;
        double area = 0;
        bool has_void = false;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
          const int a = at(chart.fine_node[vertices[i]]),
                    b = at(chart.fine_node[vertices[(i + 1) % vertices.size()]]);
          const int side = side_of_.at(std::minmax({a, b})), curve = curve_of_[side];
          area += cross(place(a), place(b)) / 2;
          has_void = has_void || free.contains(side);
          if (loop.curves.empty() || loop.curves.back() != curve) loop.curves.push_back(curve);
        }
        if (loop.curves.size() > 1 && loop.curves.back() == loop.curves.front()) loop.curves.pop_back();
        loop.where =
            fmt::format("the outline through {}", show_point(place(at(chart.fine_node[vertices[0]]))));
        if (area > 0) loop.region = std::to_string(chart.face);
        if (area > 0 || has_void) made_.loops.push_back(std::move(loop));
      }
  }

  GivenSurface surface_;
  Mesh mesh_;
  std::vector<std::array<int, 2>> sides_;
  std::vector<int> name_;  ///< curve of each side in the mesh; one more: it has no line
  std::map<std::pair<int, int>, int> side_of_;
  std::vector<std::vector<int>> sides_at_;
  std::vector<char> is_end_;
  std::map<int, int> curve_of_;  ///< curve of each side
  PlanarModel made_;
};

}  // namespace

PlanarModel trace_mesh(const Mesh& mesh) {
  constexpr const char* kSource = "the mesh of the solution";
  require_planar(mesh, kSource);
  PlanarModel made = MeshTracer({mesh, kSource}).trace();
  made.source = kSource;
  for (std::size_t i = 0; i < mesh.named_points.size(); ++i)
    made.points.push_back({flat(mesh.points[mesh.named_points[i].point]), std::to_string(i), ""});
  return made;
}

}  // namespace delquad
