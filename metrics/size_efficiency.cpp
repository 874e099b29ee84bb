// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/size_efficiency.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "geometry/mesh/quad_corners.h"

namespace delquad {

namespace {

/// Largest relative difference of Simpson's rule and the trapezium at which Simpson's is taken. Its own error
/// is far smaller if delta is smooth, and of this order at a kink.
constexpr double kAgreement = 1e-3;
/// Limit of halvings of a panel: a jump of delta is found to 1e-6 of the edge.
constexpr int kMaxHalvings = 20;
/// Limit of values on an edge: a jump takes two for each halving, so ten jumps are found. Between overlapping
/// sheets delta may jump everywhere; then a mean of evenly spaced values counts.
constexpr int kMostValues = 512, kValuesOfMean = 256;

class EdgeIntegral {
 public:
  EdgeIntegral(const Vec3& a, const Vec3& b, const SizeField& size, int& hint)
      : a_(a), ab_(b - a), size_(size), hint_(hint) {}

  /// Returns the integral of 1/delta over [t0, t1], with values f0 and f1 at the ends.
  double panel(double t0, double f0, double t1, double f1, int halvings_left) {
    const double tm = (t0 + t1) / 2, fm = at(tm);
    const double simpson = (t1 - t0) * (f0 + 4 * fm + f1) / 6;
    const double trapezium = (t1 - t0) * (f0 + f1) / 2;
    if (halvings_left == 0 || values_ >= kMostValues || std::abs(simpson - trapezium) <= kAgreement * simpson)
      return simpson;
    return panel(t0, f0, tm, fm, halvings_left - 1) + panel(tm, fm, t1, f1, halvings_left - 1);
  }
  /// Takes at least two panels, so that delta symmetric about the middle does not look constant.
  double length(double f0, double f1) {
    const double fm = at(0.5);
    const double adaptive = panel(0, f0, 0.5, fm, kMaxHalvings) + panel(0.5, fm, 1, f1, kMaxHalvings);
    return norm(ab_) * (values_ < kMostValues ? adaptive : mean());
  }

 private:
  double at(double t) {
    ++values_;
    return 1 / size_.at(a_ + t * ab_, hint_);
  }
  double mean() {
    double sum = 0;
    for (int i = 0; i < kValuesOfMean; ++i) sum += at((i + 0.5) / kValuesOfMean);
    return sum / kValuesOfMean;
  }

  Vec3 a_, ab_;
  const SizeField& size_;
  int& hint_;
  int values_ = 0;
};

}  // namespace

double adimensional_length(const Vec3& a, const Vec3& b, const SizeField& size) {
  int hint = -1;
  const double f0 = 1 / size.at(a, hint), f1 = 1 / size.at(b, hint);
  return EdgeIntegral(a, b, size, hint).length(f0, f1);
}

SizeFit fit_to_size(const Mesh& mesh, std::span<const HalfEdge> sides, const SizeField& size) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (sides.empty()) return {kNone, kNone, kNone, kNone};
  std::vector<double> inverse_size(mesh.points.size());
  parallel_ranges(inverse_size.size(), [&](std::size_t begin, std::size_t end) {
    int hint = -1;
    for (std::size_t i = begin; i < end; ++i) inverse_size[i] = 1 / size.at(mesh.points[i], hint);
  });
  std::vector<std::array<int, 2>> edges;
  std::vector<char> inner;
  for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
    edges.push_back({edge[0].lo, edge[0].hi});
    inner.push_back(edge.size() == 2);
  });
  std::vector<double> lengths(edges.size());
  parallel_ranges(edges.size(), [&](std::size_t begin, std::size_t end) {
    int hint = -1;
    for (std::size_t i = begin; i < end; ++i) {
      const auto [lo, hi] = edges[i];
      lengths[i] = EdgeIntegral(mesh.points[lo], mesh.points[hi], size, hint)
                       .length(inverse_size[lo], inverse_size[hi]);
    }
  });
  double sum = 0;
  for (const double l : lengths) sum += l < 1 ? l - 1 : 1 / l - 1;
  std::vector<std::array<int, 2>> lines = mesh.lines;
  for (auto& line : lines) std::ranges::sort(line);
  std::ranges::sort(lines);
  int n_short = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    n_short += inner[i] && lengths[i] < kShortSide && !std::ranges::binary_search(lines, edges[i]);
  const auto [shortest, longest] = std::ranges::minmax_element(lengths);
  return {100 * std::exp(sum / static_cast<double>(edges.size())), *shortest, *longest,
          static_cast<double>(n_short)};
}

}  // namespace delquad
