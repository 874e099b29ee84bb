// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/thin/gap_sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/box_tree.h"
#include "base/segment.h"
#include "geometry/planar/check_lines.h"

namespace delquad {
namespace {

/// Curves face each other where the line between them is within so much (sine) of both normals.
constexpr double kSlant = 0.6;
/// And where the way around the end of the gap is longer than so many times its width: else that is a corner.
constexpr double kRoundCorner = 6;
/// Rows in gaps that make so many times the quads are worth a warning.
constexpr double kManyMore = 5;
/// No sizes below this part of the size: rows in a corner that closes would not end.
constexpr double kLeastPart = 0.05;

/// One patch, whose edges look inside.
class PatchGaps {
 public:
  PatchGaps(const PatchBoundary& patch, const std::vector<int>& cut_face)
      : patch_(patch), cut_face_(cut_face), along_(patch.edges.size()) {
    for (const auto& loop : loops_of_edges(patch)) {
      double length = 0;
      for (const int e : loop)
        along_[e] = {length, static_cast<int>(n_loops_)}, length += norm(end(e) - begin(e));
      length_.push_back(length);
      ++n_loops_;
    }
    std::vector<Box<Vec2>> boxes;
    for (std::size_t e = 0; e < patch.edges.size(); ++e)
      boxes.push_back({lower(begin(e), end(e)), upper(begin(e), end(e))});
    tree_ = BoxTree<Vec2>(boxes);
  }

  /// Returns whether an edge is a part of a curve of the model.
  bool is_on_curve(std::size_t e) const {
    const int curve = patch_.edge_curve[e];
    return cut_face_.empty() || (curve >= 0 && cut_face_[curve] < 0);
  }

  /// Returns the width of the gap before the middle of an edge, or `reach` if there is no gap.
  double width(std::size_t edge, double reach) const {
    const Vec2 x = 0.5 * (begin(edge) + end(edge)), d = end(edge) - begin(edge);
    double width = reach, limit2 = reach * reach;
    tree_.nearest(x, limit2, [&](int i) {
      const Vec2 a = begin(i), b = end(i), across = nearest_on_segment(x, a, b) - x;
      const double distance = norm(across);
      if (static_cast<std::size_t>(i) == edge || !is_on_curve(i) || !(distance < width) ||
          cross(d, across) <= 0)
        return;
      if (std::abs(dot(d, across)) > kSlant * norm(d) * distance ||
          std::abs(dot(b - a, across)) > kSlant * norm(b - a) * distance || is_corner(edge, i, distance))
        return;
      width = distance;
      limit2 = width * width;
    });
    return width;
  }

 private:
  Vec2 begin(std::size_t e) const { return patch_.points[patch_.edges[e][0]]; }
  Vec2 end(std::size_t e) const { return patch_.points[patch_.edges[e][1]]; }
  bool is_corner(std::size_t e, std::size_t other, double distance) const {
    if (along_[e].second != along_[other].second) return false;
    const double way = std::abs(along_[e].first - along_[other].first);
    return std::min(way, length_[along_[e].second] - way) < kRoundCorner * distance;
  }

  const PatchBoundary& patch_;
  const std::vector<int>& cut_face_;
  std::vector<std::pair<double, int>> along_;  ///< of each edge its loop, and where it begins there
  std::vector<double> length_;                 ///< of the loops
  std::size_t n_loops_ = 0;
  BoxTree<Vec2> tree_;
};

/// `fewest`: rows that are enough by the size as it is now.
void add_spots(const PatchBoundary& patch, const std::vector<Vec3>& points, const std::vector<int>& cut_face,
               const SizeField& asked, const SizeField& now, int rows, double fewest,
               std::vector<LocalSize>& spots) {
  const PatchGaps gaps(patch, cut_face);
  int hint = -1, hint_now = -1;
  for (std::size_t e = 0; e < patch.edges.size(); ++e) {
    if (!gaps.is_on_curve(e)) continue;
    const auto [from, to] = patch.edges[e];
    const Vec3 a = points[patch.point_node[from]], b = points[patch.point_node[to]], x = 0.5 * (a + b);
    const double stretch = norm(patch.points[to] - patch.points[from]) / norm(b - a);
    const double least = kLeastPart * asked.at(x, hint), reach = fewest * now.at(x, hint_now);
    const double width = gaps.width(e, stretch * reach) / stretch;
    if (width < reach && least < reach / fewest)
      spots.push_back({a, b, std::max(width / rows, least), width});
  }
}

}  // namespace

std::vector<LocalSize> sizes_in_gaps(const std::shared_ptr<const SizeField>& size, int rows,
                                     const CurvesBySize& curves_by) {
  constexpr int kRounds = 4;
  constexpr double kEnough = 0.8;  // of the rows, once there are some
  std::vector<LocalSize> spots;
  for (int round = 0; round < kRounds; ++round) {
    const auto now = spots.empty() ? size : finer_near(size, spots);
    const double fewest = round == 0 ? rows : kEnough * rows;
    const std::size_t before = spots.size();
    curves_by(now, [&](const auto& patch, const auto& points, const auto& cut_face) {
      add_spots(patch, points, cut_face, *size, *now, rows, fewest, spots);
    });
    if (spots.size() == before) break;
  }
  return spots;
}

void warn_of_many_rows(const std::string& name, int rows, double before, double after,
                       std::vector<Warning>& warnings) {
  if (after > kManyMore * before)
    warnings.emplace_back(fmt::format(
        "{}: {} rows of quads in gaps make about {:.3g} quads, where {:.3g} would do for the size", name,
        rows, after, before));
}

}  // namespace delquad
