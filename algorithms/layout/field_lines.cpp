// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/layout/field_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/predicates.h"
#include "base/segment.h"
#include "delquad/extend.h"

namespace delquad {

namespace {

/// Length of a step, in wanted edges.
constexpr double kStep = 0.3;
/// A line ends at a rim within kReach wanted edges, once it is kFree away from its start.
constexpr double kReach = 0.35, kFree = 0.75;
/// Longest line, in edges for each edge of the rims.
constexpr double kLongest = 0.75;
/// Cost of an offset of one edge from the field, spread over the edges of the line. Cost of a right angle
/// between the line and the direction that the quads at its end want.
constexpr double kOffset = 4, kTurn = 4;

Vec2 turned(Vec2 v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

double angle_between(Vec2 from, Vec2 to) {
  const double angle = std::atan2(cross(from, to), dot(from, to));
  return angle < 0 ? angle + 2 * std::numbers::pi : angle;
}

bool meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  return orient2d(a, b, c) * orient2d(a, b, d) <= 0 && orient2d(c, d, a) * orient2d(c, d, b) <= 0;
}

}  // namespace

FieldLines::FieldLines(const CrossField& cross, const ParametricSize& size, const LayoutVertices& vertices,
                       std::span<const Rim> rims)
    : cross_(cross), size_(size), vertices_(vertices), rims_(rims.begin(), rims.end()) {
  std::vector<Box<Vec2>> boxes;
  for (int r = 0; r < static_cast<int>(rims_.size()); ++r)
    for (int i = 0; i < static_cast<int>(rims_[r].size()); ++i) {
      edges_.push_back({{r, i}, next({r, i})});
      boxes.push_back(Box<Vec2>::around({place(edges_.back().from), place(edges_.back().to)}));
    }
  tree_ = BoxTree<Vec2>(boxes);
}

FieldLines::Corner FieldLines::corner(RimPlace p) const {
  const Vec2 out = place(next(p)) - place(p);
  const double angle = angle_between(out, place(before(p)) - place(p));
  // At both sides of a cut the angle is a full turn.
  return {(1 / norm(out)) * out, angle > 0 ? angle : 2 * std::numbers::pi};
}

Vec2 FieldLines::arm(Vec2 at, Vec2 direction) {
  const Frame frame = Frame::from_cross(cross_.at(at, cross_hint_));
  const Vec2 local = frame.to_local(direction);
  return std::abs(local.x) > std::abs(local.y) ? std::copysign(1, local.x) * frame.e1
                                               : std::copysign(1, local.y) * frame.e2;
}

void FieldLines::trace(RimPlace from, std::vector<FieldLine>& lines) {
  for (int along = 1; along < entry(from).quads; ++along) trace(from, along, lines);
}

void FieldLines::trace(RimPlace from, int along, std::vector<FieldLine>& lines) {
  const Corner start = corner(from);
  Vec2 x = place(from), direction = turned(start.out, start.angle * along / entry(from).quads);
  const Vec2 asked = arm(x, direction);
  const double astray = std::atan2(std::abs(cross(direction, asked)), dot(direction, asked));
  FieldLine line{from, from, along, 0, {x}, {0}, kTurn * std::pow(astray * 2 / std::numbers::pi, 2)};
  const double longest = kLongest * static_cast<double>(edges_.size());
  while (line.edges.back() < longest) {
    const double delta = size_.at(x, size_hint_), step = kStep * delta;
    if (line.path.size() > 1) direction = arm(x + (step / 2) * arm(x, direction), direction);
    const Vec2 y = x + step * direction;
    const bool may_reach = line.edges.back() + kStep > kFree;
    // Finds the first crossed edge, or the nearest one within reach.
    int hit = -1;
    double at = 2;
    Vec2 hit_at;
    tree_.overlapping(Box<Vec2>::around({x, y}).grown(kReach * delta), [&](int e) {
      const auto& [a, b] = edges_[e];
      const int own = entry(from).vertex;
      if (entry(a).vertex == own || entry(b).vertex == own) return;
      const Vec2 p = place(a), q = place(b);
      double when = 2;
      Vec2 where = y;
      if (meet(x, y, p, q)) {
        const double here = std::abs(cross(q - p, x - p)), there = std::abs(cross(q - p, y - p));
        when = here > 0 ? here / (here + there) : 0;
        where = x + when * (y - x);
      } else if (may_reach) {
        where = nearest_on_segment(y, p, q);
        if (const double distance = norm(where - y) / delta; distance < kReach) when = 1 + distance;
      }
      if (when < at || (when == at && when < 2 && e < hit)) at = when, hit = e, hit_at = where;
    });
    const Vec2 to = hit < 0 ? y : hit_at;
    line.path.push_back(to);
    line.edges.push_back(line.edges.back() + norm(to - x) / delta);
    if (hit >= 0) {
      end(line, to, edges_[hit].from, lines);
      end(line, to, edges_[hit].to, lines);
      return;
    }
    x = y;
  }
}

void FieldLines::end(FieldLine line, Vec2 hit, RimPlace to, std::vector<FieldLine>& lines) const {
  const RimVertex& last = entry(to);
  if (last.quads < 2 || last.vertex == entry(line.from).vertex) return;
  line.to = to;
  const Vec2 place_to = place(to), offset = place_to - hit;
  const double edges = line.edges.back();
  if (edges < 0.3) return;
  for (std::size_t i = 0; i < line.path.size(); ++i)
    line.path[i] = line.path[i] + (line.edges[i] / edges) * offset;
  // Measures the direction at the end over about the last edge.
  std::size_t i = line.path.size() - 2;
  while (i > 0 && edges - line.edges[i] < kFree) --i;
  const Corner at = corner(to);
  const double quad = at.angle / last.quads, angle = angle_between(at.out, line.path[i] - place_to);
  if (angle >= at.angle) return;
  const int before = std::clamp(static_cast<int>(std::lround(angle / quad)), 1, last.quads - 1);
  line.back = last.quads - before;
  const double off = norm(offset) / vertices_.delta[last.vertex];
  line.misfit += kOffset * off * off / std::max(edges, 1.0) +
                 kTurn * std::pow((angle - before * quad) * 2 / std::numbers::pi, 2);
  lines.push_back(std::move(line));
}

bool FieldLines::is_free(RimPlace from, RimPlace to, std::span<const Vec2> row) const {
  for (std::size_t i = 0; i + 1 < row.size(); ++i) {
    bool free = true;
    tree_.overlapping(Box<Vec2>::around({row[i], row[i + 1]}), [&](int e) {
      const auto& [a, b] = edges_[e];
      const auto is_end = [&](RimPlace p) {
        return (i == 0 && entry(p).vertex == entry(from).vertex) ||
               (i + 2 == row.size() && entry(p).vertex == entry(to).vertex);
      };
      if (!is_end(a) && !is_end(b) && meet(row[i], row[i + 1], place(a), place(b))) free = false;
    });
    if (!free) return false;
  }
  return true;
}

}  // namespace delquad
