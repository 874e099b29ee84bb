// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/embedded/embedded_pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/box_tree.h"
#include "base/predicates.h"
#include "base/segment.h"
#include "delquad/error.h"

namespace delquad {

bool is_crack(const PlanarModel& model, const std::vector<int>& curves) {
  return std::ranges::any_of(curves, [&](int c) { return model.curves[c].is_crack; });
}

void add_dangling_edges(const PlanarModel& model, const SizeField& size,
                        const std::function<Vec2(Vec2, Vec2)>& fold, ModelChain& chain,
                        std::vector<CurvePiece>& pieces) {
  std::vector<char> has_piece(chain.nodes.size(), 0);
  for (const CurvePiece& p : pieces)
    for (const int v : p.ends) has_piece[v] = 1;
  std::vector<int> nodes, images;
  std::vector<Vec2> points;
  std::vector<double> sizes;
  std::vector<std::string> labels;
  int hint = -1;
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const int v = chain.point_nodes[i];
    if (has_piece[v]) continue;
    has_piece[v] = 1;
    const Vec2 at = chain.nodes[v];
    if (!(fold(at, at) == at)) {
      images.push_back(v);
      continue;
    }
    nodes.push_back(v);
    points.push_back(at);
    sizes.push_back(size.at({at.x, at.y, 0}, hint));
    labels.push_back(message_prefix(model) + point_label(model, static_cast<int>(i)));
  }
  if (nodes.empty()) return;
  std::vector<CurveSpan> curves;
  for (const CurvePiece& p : pieces) curves.emplace_back(*p.shape, p.from, p.to);
  const auto ends = dangling_ends(curves, points, sizes, labels);
  const auto add = [&](int node, Vec2 end) {
    pieces.push_back(
        {{}, {node, static_cast<int>(chain.nodes.size())}, make_segment(chain.nodes[node], end)});
    chain.nodes.push_back(end);
  };
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const Vec2 end : ends[i]) add(nodes[i], end);
  for (const int v : images) {
    const Vec2 at = chain.nodes[v], master = fold(at, at);
    const auto next = std::ranges::min_element(points, {}, [&](Vec2 p) { return norm(p - master); });
    for (const Vec2 end : ends[next - points.begin()]) add(v, fold(at, end));
  }
}

void check_embedded(const PlanarModel& model, const ModelChain& chain, const std::vector<CurvePiece>& pieces,
                    int first_axis, const Mesh& lines, const Arrangement& arrangement,
                    const FaceRegions& regions) {
  const auto loops = loops_of_model_curves(model, chain);
  const auto is_filled = [&](std::size_t side) {
    const int face = arrangement.face_of[side];
    return face >= 0 && regions.region[face] >= 0;
  };
  std::size_t line = 0;
  for (std::size_t i = 0; i < pieces.size(); line += pieces[i++].n) {
    const CurvePiece& piece = pieces[i];
    const Vec3 &a = lines.points[piece.ends[0]], &b = lines.points[piece.ends[1]];
    const bool is_inside = is_filled(2 * line) && is_filled(2 * line + 1);
    if (is_inside) continue;
    if (piece.curve < 0) {
      const auto at = std::ranges::find(chain.point_nodes, piece.ends[0]) - chain.point_nodes.begin();
      throw InputError(
          fmt::format("{}{} at ({:.10g}, {:.10g}) lies outside of every region [embedded-outside]",
                      message_prefix(model), point_label(model, static_cast<int>(at)), a.x, a.y));
    }
    const auto embedded =
        std::ranges::find_if(piece.curves, [&](int c) { return loops[c].empty() && c < first_axis; });
    const auto bounding = std::ranges::find_if(piece.curves, [&](int c) { return !loops[c].empty(); });
    if (embedded != piece.curves.end() && !is_filled(2 * line) && !is_filled(2 * line + 1))
      throw InputError(
          fmt::format("{}{} lies outside of every region from ({:.10g}, {:.10g}) to ({:.10g}, {:.10g}) "
                      "[embedded-outside]",
                      message_prefix(model), curve_label(model, *embedded), a.x, a.y, b.x, b.y));
    if (embedded == piece.curves.end() || bounding == piece.curves.end()) continue;
    if (const ModelCurve& curve = model.curves[*embedded]; !curve.name.empty() && !curve.is_crack) continue;
    throw InputError(fmt::format(
        "{}{} lies on the boundary, {}, between ({:.10g}, {:.10g}) and ({:.10g}, {:.10g}). Give it a name, "
        "which that part of the boundary gets, or move it into a region [embedded-on-a-boundary]",
        message_prefix(model), curve_label(model, *embedded), curve_label(model, *bounding), a.x, a.y, b.x,
        b.y));
  }
}

namespace {

constexpr int kDirections = 8;  // of a line
/// See Surroundings::is_clear().
constexpr double kClearance = 0.6, kAside = 0.4;
constexpr double kShorter = 0.7, kShortest = 1e-3;

/// Everything that a dangling curve must keep away from.
class Surroundings {
 public:
  Surroundings(const std::vector<CurveSpan>& curves, const std::vector<Vec2>& points)
      : curves_(curves), points_(points) {
    std::vector<Box<Vec2>> boxes;
    for (const CurveSpan& curve : curves) boxes.push_back(curve.box());
    for (const Vec2 p : points) boxes.push_back({p, p});
    tree_ = BoxTree<Vec2>(boxes);
  }

  struct Nearest {
    double distance;
    Vec2 at;
  };
  /// Returns the nearest piece or point to x, without one of the points.
  Nearest nearest(Vec2 x, std::size_t own) const {
    Nearest best{std::numeric_limits<double>::infinity(), x};
    double limit2 = best.distance;
    tree_.nearest(x, limit2, [&](int i) {
      const auto k = static_cast<std::size_t>(i);
      if (k == curves_.size() + own) return;
      const Vec2 at = k < curves_.size() ? curves_[k].nearest(x).at : points_[k - curves_.size()];
      if (norm(at - x) >= best.distance) return;
      best = {norm(at - x), at};
      limit2 = best.distance * best.distance;
    });
    return best;
  }

  /// Returns whether two edges from a point to both sides have room. Their ends keep away from all else by
  /// kClearance of their length, places nearer to the point by less. Other points lie well aside.
  bool is_clear(std::size_t point, Vec2 along) const {
    const Vec2 x = points_[point];
    constexpr int kPlaces = 4;
    for (int k = -kPlaces; k <= kPlaces; ++k) {
      const double s = static_cast<double>(k) / kPlaces;
      if (k != 0 && nearest(x + s * along, point).distance < kClearance * std::abs(s) * norm(along))
        return false;
    }
    const auto segment = make_segment(x - along, x + along);
    const CurveSpan span(*segment, 0, 1);
    const double aside = kAside * norm(along);
    const Box<Vec2> box{span.box().low - Vec2{aside, aside}, span.box().high + Vec2{aside, aside}};
    bool is_free = true;
    const double limit = 0;
    tree_.search(
        limit, [&](const auto& node) { return node.box.overlaps(box) ? 0.0 : 1.0; },
        [&](int i) {
          const auto k = static_cast<std::size_t>(i);
          if (k < curves_.size()) {
            is_free = is_free && span.crossings(curves_[k]).empty();
          } else if (const std::size_t other = k - curves_.size(); other != point) {
            const Vec2 p = points_[other];
            is_free = is_free &&
                      distance_to_segment(p, x - along, x + along) >= std::min(kAside * norm(p - x), aside);
          }
        });
    return is_free && std::ranges::none_of(taken_, [&](const auto& other) {
             return distance(x - along, x + along, other[0], other[1]) < kClearance * norm(along) / 2;
           });
  }
  void take(std::array<Vec2, 2> ends) { taken_.push_back(ends); }

 private:
  /// Returns the distance of two segments.
  static double distance(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    if (orient2d(a, b, c) * orient2d(a, b, d) < 0 && orient2d(c, d, a) * orient2d(c, d, b) < 0) return 0;
    return std::min({distance_to_segment(a, c, d), distance_to_segment(b, c, d), distance_to_segment(c, a, b),
                     distance_to_segment(d, a, b)});
  }

  const std::vector<CurveSpan>& curves_;
  const std::vector<Vec2>& points_;
  BoxTree<Vec2> tree_;
  std::vector<std::array<Vec2, 2>> taken_;
};

}  // namespace

std::vector<std::array<Vec2, 2>> dangling_ends(const std::vector<CurveSpan>& curves,
                                               const std::vector<Vec2>& points,
                                               const std::vector<double>& sizes,
                                               const std::vector<std::string>& labels) {
  Surroundings around(curves, points);
  std::vector<std::array<Vec2, 2>> ends;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [distance, nearest] = around.nearest(points[i], i);
    const Vec2 across = points[i] - nearest;
    const double first = std::atan2(across.y, across.x) + std::numbers::pi / 2;
    const double shortest = kShortest * sizes[i], longest = distance < shortest ? 0 : sizes[i];
    for (double length = longest; ends.size() == i && length >= shortest; length *= kShorter)
      for (int k = 0; ends.size() == i && k < kDirections; ++k) {
        const double angle = first + std::numbers::pi * k / kDirections;
        const Vec2 along = length * Vec2{std::cos(angle), std::sin(angle)};
        if (around.is_clear(i, along)) ends.push_back({points[i] + along, points[i] - along});
      }
    if (ends.size() == i)
      throw InputError(fmt::format(
          "{} at ({:.10g}, {:.10g}) is nearer than a thousandth of the size, {:g}, to a "
          "curve or another point: expected them farther apart, or at the same place [embedded-too-near]",
          labels[i], points[i].x, points[i].y, sizes[i]));
    around.take(ends.back());
  }
  return ends;
}

}  // namespace delquad
