// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/thin/gap_sizes.h"

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
/// No sizes below this part of the size: rows in a corner that closes would not end.
constexpr double kLeastPart = 0.05;

/// One patch, whose edges look inside.
class PatchGaps {
 public:
  explicit PatchGaps(const PatchBoundary& patch) : patch_(patch), along_(patch.edges.size()) {
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

  /// Returns the width of the gap before the middle of an edge, or `reach` if there is no gap.
  double width(std::size_t edge, double reach) const {
    const Vec2 x = 0.5 * (begin(edge) + end(edge)), d = end(edge) - begin(edge);
    double width = reach, limit2 = reach * reach;
    tree_.nearest(x, limit2, [&](int i) {
      const Vec2 a = begin(i), b = end(i), across = nearest_on_segment(x, a, b) - x;
      const double distance = norm(across);
      if (static_cast<std::size_t>(i) == edge || !(distance < width) || cross(d, across) <= 0) return;
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
  std::vector<std::pair<double, int>> along_;  ///< of each edge its loop, and where it begins there
  std::vector<double> length_;                 ///< of the loops
  std::size_t n_loops_ = 0;
  BoxTree<Vec2> tree_;
};

}  // namespace

std::vector<LocalSize> gap_spots(const PlanarDomain& domain, const SizeField& size, double rows) {
  std::vector<LocalSize> spots;
  int hint = -1;
  for (const PatchBoundary& patch : domain.patches) {
    const PatchGaps gaps(patch);
    for (std::size_t e = 0; e < patch.edges.size(); ++e) {
      const Vec2 a = patch.points[patch.edges[e][0]], b = patch.points[patch.edges[e][1]];
      const double wanted = size.at({(a.x + b.x) / 2, (a.y + b.y) / 2, 0}, hint);
      const double width = gaps.width(e, rows * wanted);
      if (width < rows * wanted)
        spots.push_back({{a.x, a.y, 0}, {b.x, b.y, 0}, std::max(width / rows, kLeastPart * wanted), width});
    }
  }
  return spots;
}

}  // namespace delquad
