// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/recombination/recombine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include "base/cancel.h"

namespace delquad {

namespace {

constexpr int kNone = -1;
/// Least gain in the worst eta by a duplication over the swap, since it adds an irregular vertex.
constexpr double kLeastDuplicationGain = 0.05;
/// A quad; a triangle with kNone as fourth vertex; or four times kNone if removed.
using Element = std::array<int, 4>;

bool is_triangle(const Element& e) { return e[3] == kNone; }
bool contains(const Element& e, int v) { return std::find(e.begin(), e.end(), v) != e.end(); }
void replace(Element& e, int from, int to) { std::replace(e.begin(), e.end(), from, to); }

/// Returns the smallest angle over 60 degrees, negative if the triangle is inverted.
double triangle_quality(Vec2 a, Vec2 b, Vec2 c) {
  const auto angle = [](Vec2 u, Vec2 v) { return std::atan2(cross(u, v), dot(u, v)); };
  const double abc = angle(b - a, c - a), bca = angle(c - b, a - b), cab = angle(a - c, b - c);
  const double smallest = std::min({std::abs(abc), std::abs(bca), std::abs(cab)}) / (std::numbers::pi / 3);
  return abc > 0 ? smallest : -smallest;
}

double quality(const std::vector<Vec2>& points, const Element& e) {
  if (is_triangle(e)) return triangle_quality(points[e[0]], points[e[1]], points[e[2]]);
  return signed_eta(points[e[0]], points[e[1]], points[e[2]], points[e[3]]);
}

double worst_quality(const std::vector<Vec2>& points, std::span<const Element> elements) {
  double worst = std::numeric_limits<double>::infinity();
  for (const Element& e : elements) worst = std::min(worst, quality(points, e));
  return worst;
}

/// Returns the mean of the star of v without v.
Vec2 star_mean(const std::vector<Vec2>& points, int v, std::span<const Element> star) {
  Vec2 sum;
  int n = 0;
  for (const Element& e : star) {
    for (const int i : e) {
      if (i == v || i == kNone) continue;
      sum += points[i];
      ++n;
    }
  }
  return (1.0 / n) * sum;
}

/// Moves point v by a compass search, from its place and from the mean of its star, for the best worst
/// element. Returns the quality of that element.
double place(std::vector<Vec2>& points, int v, std::span<const Element> star) {
  constexpr double kDiagonal = std::numbers::sqrt2 / 2;
  constexpr Vec2 kDirections[] = {{1, 0},  {kDiagonal, kDiagonal},   {0, 1},  {-kDiagonal, kDiagonal},
                                  {-1, 0}, {-kDiagonal, -kDiagonal}, {0, -1}, {kDiagonal, -kDiagonal}};
  constexpr double kLastStep = 1e-3;  // part of the first step: positions matter less beyond
  constexpr int kMovesPerStep = 8;    // the star is four first steps wide; each later step is half as long
  const Vec2 start = points[v], mean = star_mean(points, v, star);
  double best = worst_quality(points, star);
  Vec2 at = start;
  const auto try_at = [&](Vec2 x) {
    points[v] = x;
    const double q = worst_quality(points, star);
    if (!(q > best)) return false;
    best = q;
    at = x;
    return true;
  };
  try_at(mean);
  double size = 0;
  for (const Element& e : star) {
    for (const int i : e) {
      if (i != kNone && i != v) size = std::max(size, norm(points[i] - mean));
    }
  }
  for (double step = size / 2; step > kLastStep * size; step /= 2) {
    bool moved = true;
    for (int moves = 0; moved && moves < kMovesPerStep; ++moves) {
      moved = false;
      const Vec2 centre = at;
      for (const Vec2 d : kDirections) moved = try_at(centre + step * d) || moved;
    }
  }
  points[v] = at;
  return best;
}

class Repairer {
 public:
  Repairer(QuadPatch& mesh, const std::vector<FanEnds>& pairs)
      : points_(mesh.points), elements_(mesh.quads), slot_(mesh.n_boundary, kNone) {
    elements_.reserve(elements_.size() + mesh.triangles.size() + 2 * pairs.size());
    for (const auto& t : mesh.triangles) elements_.push_back({t[0], t[1], t[2], kNone});
    first_end_ = elements_.size();
    for (const FanEnds& pair : pairs) {
      slot_[pair.first[0]] = static_cast<int>(around_.size());
      around_.emplace_back();
      elements_.push_back({pair.first[0], pair.first[1], pair.first[2], kNone});
      elements_.push_back({pair.last[0], pair.last[1], pair.last[2], kNone});
    }
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      for (const int v : elements_[e]) register_use(v, static_cast<int>(e));
    }
  }

  /// Repairs the k-th pair.
  void repair(std::size_t k) {
    const std::size_t first = first_end_ + 2 * k, last = first + 1;
    const int b = elements_[first][0];
    std::vector<int> between;
    for (const int e : around_[slot_[b]]) {
      if (e != static_cast<int>(first) && e != static_cast<int>(last) && contains(elements_[e], b)) {
        between.push_back(e);
      }
    }
    const std::vector<Element> star = duplicate(elements_[first], elements_[last], between);
    const double duplicated = place(points_, static_cast<int>(points_.size()) - 1, star);
    const auto swapped = swap(elements_[first], elements_[last], between);
    if (swapped && worst_quality(points_, *swapped) >= duplicated - kLeastDuplicationGain) {
      points_.pop_back();
      elements_[between[0]].fill(kNone);
      elements_[first] = (*swapped)[0];
      elements_[last] = (*swapped)[1];
      const int m = elements_[first][3];
      register_use(m, static_cast<int>(first));
      register_use(m, static_cast<int>(last));
      ++summary_.pentagon_swaps;
      return;
    }
    elements_[first] = star[0];
    elements_[last] = star[1];
    for (std::size_t i = 0; i < between.size(); ++i) elements_[between[i]] = star[i + 2];
    ++summary_.duplications;
  }

  /// Places the points from `first_new` on again after all repairs.
  void relax(std::size_t first_new) {
    constexpr int kSweeps = 3;  // adjacent new points are rare, so one sweep is nearly always enough
    std::vector<std::vector<Element>> stars(points_.size() - first_new);
    for (const Element& e : elements_) {
      for (const int v : e) {
        if (v >= static_cast<int>(first_new)) stars[v - first_new].push_back(e);
      }
    }
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      check_cancelled();
      for (std::size_t i = 0; i < stars.size(); ++i)
        place(points_, static_cast<int>(first_new + i), stars[i]);
    }
  }

  BoundaryRepairSummary summary() const { return summary_; }

 private:
  void register_use(int v, int element) {
    if (v >= 0 && v < static_cast<int>(slot_.size()) && slot_[v] != kNone)
      around_[slot_[v]].push_back(element);
  }

  /// Returns the two quads of the pentagon swap, if it exists.
  std::optional<std::array<Element, 2>> swap(const Element& first, const Element& last,
                                             const std::vector<int>& between) const {
    if (between.size() != 1 || is_triangle(elements_[between[0]])) return std::nullopt;
    Element quad = elements_[between[0]];
    std::rotate(quad.begin(), std::find(quad.begin(), quad.end(), first[0]), quad.end());
    const int m = quad[2];
    if (m == first[1] || m == last[2]) return std::nullopt;
    return std::array<Element, 2>{{{first[0], first[1], first[2], m}, {first[0], m, last[1], last[2]}}};
  }

  /// Adds a duplicate of the fan's point. Returns its star: first end, last end, elements between.
  std::vector<Element> duplicate(const Element& first, const Element& last, const std::vector<int>& between) {
    const int b = first[0], copy = static_cast<int>(points_.size());
    points_.push_back(points_[b]);
    std::vector<Element> star = {{b, first[1], first[2], copy}, {b, copy, last[1], last[2]}};
    for (const int e : between) {
      star.push_back(elements_[e]);
      replace(star.back(), b, copy);
    }
    return star;
  }

  std::vector<Vec2>& points_;
  std::vector<Element>& elements_;
  std::size_t first_end_ = 0;             // first element of the first pair
  std::vector<int> slot_;                 // by boundary point: its place in around_, or kNone
  std::vector<std::vector<int>> around_;  // elements that have or once had the point
  BoundaryRepairSummary summary_;
};

}  // namespace

BoundaryRepairSummary repair_fans(QuadPatch& mesh, const std::vector<FanEnds>& pairs) {
  if (pairs.empty()) return {};
  const std::size_t n_points = mesh.points.size();
  Repairer repairer(mesh, pairs);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    check_cancelled();
    repairer.repair(k);
  }
  repairer.relax(n_points);
  mesh.triangles.clear();
  std::erase_if(mesh.quads, [&](const Element& e) {
    if (is_triangle(e) && e[0] != kNone) mesh.triangles.push_back({e[0], e[1], e[2]});
    return is_triangle(e);
  });
  return repairer.summary();
}

}  // namespace delquad
