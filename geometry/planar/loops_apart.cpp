// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/planar/loops_apart.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "base/box_tree.h"
#include "base/cancel.h"
#include "base/predicates.h"
#include "base/segment.h"
#include "delquad/error.h"

namespace delquad {

namespace {

/// Largest distance of a curve from its chord, over the largest distance at three places.
constexpr double kSafety = 2;
/// Limit of halvings; the parts are then shorter than rounding.
constexpr int kMostHalvingsOfPairs = 60;

/// An edge or a part of one.
struct Part {
  const Curve* shape;
  double t0, t1;
  Vec2 a, b;
  double bulge = 0;  ///< bound for the distance of the curve from the chord

  static Part make(const Curve* shape, double t0, double t1, Vec2 a, Vec2 b) {
    Part part{shape, t0, t1, a, b};
    for (const double s : {0.25, 0.5, 0.75})
      part.bulge =
          std::max(part.bulge, kSafety * distance_to_segment(shape->point(t0 + s * (t1 - t0)), a, b));
    return part;
  }
  std::pair<Part, Part> halves() const {
    const double t = (t0 + t1) / 2;
    const Vec2 m = shape->point(t);
    return {make(shape, t0, t, a, m), make(shape, t, t1, m, b)};
  }
};

double distance_of_parts(const Part& p, const Part& q) {
  if (orient2d(p.a, p.b, q.a) * orient2d(p.a, p.b, q.b) < 0 &&
      orient2d(q.a, q.b, p.a) * orient2d(q.a, q.b, p.b) < 0)
    return 0;
  return std::min({distance_to_segment(p.a, q.a, q.b), distance_to_segment(p.b, q.a, q.b),
                   distance_to_segment(q.a, p.a, p.b), distance_to_segment(q.b, p.a, p.b)});
}

/// Returns a place where two curves are within the tolerance; nothing if there is none. The search halves the
/// part with the larger bulge, and ends if both bulges are below the tolerance.
std::optional<Vec2> meeting(const Part& p, const Part& q, double tolerance, int halvings = 0) {
  check_cancelled();
  if (distance_of_parts(p, q) - p.bulge - q.bulge > tolerance) return std::nullopt;
  if (p.bulge + q.bulge <= tolerance || halvings == kMostHalvingsOfPairs) {
    const Part& shorter = norm(p.b - p.a) < norm(q.b - q.a) ? p : q;
    return 0.5 * (shorter.a + shorter.b);
  }
  const bool first = p.bulge >= q.bulge;
  const auto [left, right] = (first ? p : q).halves();
  for (const Part& half : {left, right})
    if (const auto at =
            first ? meeting(half, q, tolerance, halvings + 1) : meeting(p, half, tolerance, halvings + 1))
      return at;
  return std::nullopt;
}

}  // namespace

void check_loops_apart(const std::vector<LoopEdge>& edges, const BoundaryNames& names) {
  if (edges.empty()) return;
  Box<Vec2> all = Box<Vec2>::around({edges[0].a});
  for (const LoopEdge& edge : edges) all.add(edge.a);
  const double tolerance = kTouch * norm(all.size());
  std::vector<Part> parts;
  std::vector<Box<Vec2>> boxes;
  for (const LoopEdge& e : edges) {
    parts.push_back(Part::make(e.shape, e.t0, e.t1, e.a, e.b));
    boxes.push_back(Box<Vec2>::around({e.a, e.b}).grown(parts.back().bulge + tolerance));
  }
  const BoxTree<Vec2> tree(boxes);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    tree.overlapping(boxes[i], [&](int j) {
      const LoopEdge &e = edges[i], &f = edges[j];
      if (f.loop <= e.loop || !boxes[i].overlaps(boxes[j])) return;
      const auto at = meeting(parts[i], parts[j], tolerance);
      if (!at) return;
      throw InputError(fmt::format(
          "{}the loops of {} and {} touch at ({:.4g}, {:.4g}): expected a common place, or more than "
          "{:.3g} between them [touching-curves]",
          names.prefix(), names.curve(e.curve), names.curve(f.curve), at->x, at->y, tolerance));
    });
  }
}

}  // namespace delquad
