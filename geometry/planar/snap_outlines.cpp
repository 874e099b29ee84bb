// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/snap_outlines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/box_tree.h"
#include "base/segment.h"
#include "base/text.h"
#include "geometry/planar/curve_pieces.h"
#include "geometry/planar/model_chain.h"
#include "geometry/planar/point_grid.h"

namespace delquad {
namespace {

/// Limit of rounds, since bent segments may come near other points.
constexpr int kMostRounds = 8;

class OutlineSnapper {
 public:
  OutlineSnapper(PlanarModel& model, double tolerance, bool all) : tolerance_(tolerance) {
    for (std::size_t c = 0; c < model.curves.size(); ++c) {
      const ModelCurve& curve = model.curves[c];
      if (curve.is_gone || !(all || curve.is_data)) continue;
      if (const auto points = polyline_of(*curve.shape)) add(static_cast<int>(c), *points);
    }
    for (int round = 0; round < kMostRounds && bend(); ++round) {
    }
    for (Outline& outline : outlines_)
      if (outline.is_changed) take(outline, model);
  }

  int moved() const { return moved_; }
  double farthest() const { return farthest_; }
  Vec2 where() const { return where_; }

 private:
  struct Outline {
    int curve;
    std::vector<int> points;  ///< points of all outlines
    bool is_changed = false;
  };

  void add(int curve, const std::vector<Vec2>& points) {
    Outline& outline = outlines_.emplace_back(Outline{curve, {}});
    for (const Vec2 x : points) {
      if (!grid_) grid_.emplace(x, tolerance_);
      int v = grid_->find(x, points_);
      if (v < 0) {
        v = static_cast<int>(points_.size());
        points_.push_back(x);
        grid_->add(x, v);
      }
      const bool is_next = !outline.points.empty() && outline.points.back() == v;
      outline.is_changed |= is_next;
      if (is_next) continue;
      note(points_[v], norm(points_[v] - x), outline);
      outline.points.push_back(v);
    }
  }

  void note(Vec2 at, double distance, Outline& outline) {
    if (!(distance > 0)) return;
    outline.is_changed = true;
    ++moved_;
    if (distance > farthest_) farthest_ = distance, where_ = at;
  }

  /// Bends segments to points within the tolerance. Returns whether there were any.
  bool bend() {
    std::vector<Box<Vec2>> boxes;
    for (const Vec2 x : points_) boxes.push_back({x, x});
    const BoxTree<Vec2> tree(boxes);
    bool any = false;
    for (Outline& outline : outlines_) {
      std::vector<int> bent;
      for (std::size_t i = 0; i < outline.points.size(); ++i) {
        const int a = outline.points[i];
        bent.push_back(a);
        if (i + 1 == outline.points.size()) break;
        const int b = outline.points[i + 1];
        std::vector<std::pair<double, int>> beside;
        tree.overlapping(Box<Vec2>::around({points_[a], points_[b]}).grown(tolerance_), [&](int v) {
          const double distance = distance_to_segment(points_[v], points_[a], points_[b]);
          if (v == a || v == b || distance > tolerance_) return;
          beside.emplace_back(nearest_part(points_[v], points_[a], points_[b]), v);
          note(points_[v], distance, outline);
        });
        std::ranges::sort(beside);
        any |= !beside.empty();
        outline.is_changed |= !beside.empty();
        for (const auto& [part, v] : beside) bent.push_back(v);
      }
      outline.points.clear();
      for (const int v : bent) {  // drops a segment that goes back along the last one
        if (outline.points.size() > 1 && outline.points[outline.points.size() - 2] == v)
          outline.points.pop_back();
        else
          outline.points.push_back(v);
      }
    }
    return any;
  }

  void take(const Outline& outline, PlanarModel& model) const {
    std::vector<Vec2> points;
    for (const int v : outline.points) points.push_back(points_[v]);
    // An outline without area stays, and is refused where it is used.
    if (points.size() > 3 || (points.size() > 1 && outline.points.front() != outline.points.back()))
      model.curves[outline.curve].shape = make_polyline(points);
  }

  double tolerance_;
  std::optional<PointGrid> grid_;
  std::vector<Vec2> points_;
  std::vector<Outline> outlines_;
  int moved_ = 0;
  double farthest_ = 0;
  Vec2 where_;
};

}  // namespace

/// Returns corners and ends, if the curve is straight between them.
std::optional<std::vector<Vec2>> polyline_of(const Curve& curve) {
  std::vector<double> t = curve.fixed_parameters();
  t.insert(t.begin(), 0);
  t.push_back(1);
  std::vector<Vec2> points{curve.point(0)};
  for (std::size_t i = 1; i < t.size(); ++i) {
    const Vec2 a = points.back(), b = curve.point(t[i]);
    for (const double s : {0.21, 0.5, 0.83}) {
      const Vec2 x = curve.point(t[i - 1] + s * (t[i] - t[i - 1])) - a;
      if (std::abs(cross(x, b - a)) > kJoinTolerance * dot(b - a, b - a)) return std::nullopt;
    }
    points.push_back(b);
  }
  return points;
}

PlanarModel snap_outlines(PlanarModel model, double tolerance, bool all, std::vector<Warning>& warnings) {
  const OutlineSnapper snapper(model, tolerance, all);
  if (snapper.farthest() > kJoinTolerance * norm(box_of(model, 1).size()))
    warnings.emplace_back(
        fmt::format("{}outlines that nearly touch were joined at {} places, up to {:.3g} apart, at {}: "
                    "--weld 0 keeps them",
                    message_prefix(model), snapper.moved(), snapper.farthest(), show_point(snapper.where())));
  return model;
}

}  // namespace delquad
