// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <vector>

#include "algorithms/fields/fields.h"
#include "algorithms/fields/sample_triangle.h"
#include "base/box.h"
#include "base/cancel.h"

namespace delquad {

namespace {

// Safety factor, since differences between rules are too small where delta jumps.
constexpr double kSafety = 0.25;
// Limit of evaluations, if delta has no finite integral or varies everywhere.
constexpr int kMostEvaluations = 2'000'000;

/// Symmetric rule of degree 4, six points [Dunavant 1985]: (b, b, 1 - 2 b) and the weight of its three
/// permutations.
struct Orbit {
  double b, weight;
};
constexpr Orbit kRule[] = {{0.445948490915965, 0.223381589678011}, {0.091576213509771, 0.109951743655322}};
constexpr int kRulePoints = 6;

/// Ratio of longest to shortest side of slivers.
constexpr double kSliver = 8;

/// Returns the quarters of a triangle, or both halves across a sliver. Quarters of slivers are as thin.
/// Beside a curve with many edges there would be far too many of them.
std::vector<Corners> parts_of(const Corners& c) {
  const auto side = [&](std::size_t k) { return norm(c[(k + 1) % 3] - c[k]); };
  const std::array lengths = {side(0), side(1), side(2)};
  const auto [least, most] = std::ranges::minmax_element(lengths);
  if (*most <= kSliver * *least) {
    const auto all = quarters(c);
    return {all.begin(), all.end()};
  }
  const auto k = static_cast<std::size_t>(most - lengths.begin());
  const Vec2 a = c[k], b = c[(k + 1) % 3], tip = c[(k + 2) % 3], middle = 0.5 * (a + b);
  return {{a, middle, tip}, {middle, b, tip}};
}

class Quadrature {
 public:
  explicit Quadrature(const SizeField& size) : size_(size) {}

  /// Adds a triangle, quartered until its sides are at most `longest`.
  void add(const Corners& corners, double longest) {
    check_cancelled();
    if (longest_side(corners) > longest && !exhausted()) {
      for (const Corners& part : parts_of(corners)) add(part, longest);
    } else {
      push(integrate(corners));
    }
  }

  /// Quarters the parts with the largest errors until their sum is small enough. Returns the integral.
  double refine(double relative_error) {
    while (std::isfinite(total_) && error_ > relative_error * total_ && !exhausted()) {
      check_cancelled();
      const Part worst = parts_.top();
      parts_.pop();
      total_ -= worst.integral;
      error_ -= worst.error;
      std::vector<Part> parts;
      double sum = 0;
      for (const Corners& corners : parts_of(worst.corners)) {
        parts.push_back(integrate(corners));
        sum += parts.back().integral;
      }
      for (Part& p : parts) {
        p.error = std::abs(sum - worst.integral) / static_cast<double>(parts.size());
        push(p);
      }
    }
    return total_;
  }

 private:
  struct Part {
    Corners corners;
    double integral;
    double error;
    friend bool operator<(const Part& a, const Part& b) { return a.error < b.error; }
  };

  bool exhausted() const { return evaluations_ > kMostEvaluations; }

  void push(const Part& part) {
    parts_.push(part);
    total_ += part.integral;
    error_ += part.error;
  }

  /// Returns the integral over a triangle, with the difference from the first orbit's rule as error.
  Part integrate(const Corners& c) {
    const double area = std::abs(cross(c[1] - c[0], c[2] - c[0])) / 2;
    double mean[2] = {0, 0};
    for (int i = 0; i < 2; ++i) {
      for (int k = 0; k < 3; ++k) {
        const Vec2 x = kRule[i].b * (c[(k + 1) % 3] + c[(k + 2) % 3]) + (1 - 2 * kRule[i].b) * c[k];
        const double delta = size_.at({x.x, x.y, 0}, hint_);
        mean[i] += 1 / (delta * delta) / 3;
      }
    }
    evaluations_ += kRulePoints;
    const double rule = 3 * (kRule[0].weight * mean[0] + kRule[1].weight * mean[1]);
    return {c, area * rule, area * std::abs(rule - mean[0])};
  }

  const SizeField& size_;
  int hint_ = -1;
  int evaluations_ = 0;
  double total_ = 0, error_ = 0;
  std::priority_queue<Part> parts_;
};

}  // namespace

double expected_quads(const TriPatch& triangulation, const SizeField& size, double relative_error,
                      double coarsest) {
  Quadrature quadrature(size);
  const double longest = coarsest * diagonal(triangulation.points);
  for (const auto& v : triangulation.triangles) quadrature.add(corners_of(triangulation, v), longest);
  return quadrature.refine(kSafety * relative_error);
}

}  // namespace delquad
