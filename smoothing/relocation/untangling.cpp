// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/relocation/untangling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/box.h"
#include "base/cancel.h"
#include "base/sort_unique.h"

namespace delquad {

namespace {

constexpr int kMostSweeps = 100;
/// Sweeps without a better least area before giving up.
constexpr int kPatience = 25;
/// Sweeps that equalize the areas once all are positive.
constexpr int kFinalSweeps = 5;
/// e as a part of the least area's absolute value, or of the mean area if the least is positive.
constexpr double kSoftness = 0.5, kLeastSoftness = 1e-6;

/// Corner of an element: local indices of its vertex, the next and the previous one.
struct Corner {
  int at, next, before;
};

class Untangling {
 public:
  Untangling(QuadTopology& mesh, std::span<const int> vertices)
      : mesh_(mesh), n_free_(static_cast<int>(vertices.size())), vertex_(vertices.begin(), vertices.end()) {
    std::vector<int> elements;
    for (const int v : vertices)
      mesh.for_each_out(v, [&](int h) { elements.push_back(QuadTopology::element(h)); });
    sort_unique(elements);
    // The fixed vertices follow the free ones.
    std::vector<int> free(vertices.begin(), vertices.end()), fixed;
    std::sort(free.begin(), free.end());
    for (const int e : elements)
      for (int k = 0; k < (mesh.is_quad(e) ? 4 : 3); ++k)
        if (const int v = mesh.corner(e, k); !std::binary_search(free.begin(), free.end(), v))
          fixed.push_back(v);
    sort_unique(fixed);
    vertex_.insert(vertex_.end(), fixed.begin(), fixed.end());
    number_.resize(vertex_.size());
    for (std::size_t i = 0; i < vertex_.size(); ++i) number_[i] = static_cast<int>(i);
    std::sort(number_.begin(), number_.end(), [&](int a, int b) { return vertex_[a] < vertex_[b]; });
    for (const int i : number_) by_number_.push_back(vertex_[i]);
    for (const int v : vertex_) points_.push_back(mesh.point(v));
    box_ = {points_.back(), points_.back()};
    for (std::size_t i = n_free_; i < points_.size(); ++i) box_.add(points_[i]);
    for (int i = 0; i < n_free_; ++i) points_[i] = lower(upper(points_[i], box_.low), box_.high);

    first_.assign(n_free_ + 1, 0);
    for (const int e : elements)
      for (int k = 0; k < (mesh.is_quad(e) ? 4 : 3); ++k) {
        const int h = 4 * e + k;
        const Corner c{local(mesh.origin(h)), local(mesh.target(h)), local(mesh.origin(mesh.prev(h)))};
        if (is_free(c.at) || is_free(c.next) || is_free(c.before)) corners_.push_back(c);
      }
    for (const Corner& c : corners_)
      for (const int i : {c.at, c.next, c.before})
        if (is_free(i)) ++first_[i + 1];
    for (int i = 0; i < n_free_; ++i) first_[i + 1] += first_[i];
    around_.resize(first_[n_free_]);
    std::vector<int> fill(first_.begin(), first_.end() - 1);
    for (std::size_t k = 0; k < corners_.size(); ++k)
      for (const int i : {corners_[k].at, corners_[k].next, corners_[k].before})
        if (is_free(i)) around_[fill[i]++] = static_cast<int>(k);
  }

  bool run() {
    double mean = 0;
    for (const Corner& c : corners_) mean += std::abs(area(c)) / static_cast<double>(corners_.size());
    double least = least_area(), best = least;
    if (least > 0) return true;
    std::vector<Vec2> places(points_.begin(), points_.begin() + n_free_);
    for (int sweep = 0, stale = 0, left = kFinalSweeps; sweep < kMostSweeps && stale < kPatience && left > 0;
         ++sweep) {
      const double softness = std::max(kLeastSoftness * mean, least < 0 ? -kSoftness * least : 0);
      softness2_ = softness * softness;
      for (int i = 0; i < n_free_; ++i) {
        check_cancelled();
        step(i);
      }
      least = least_area();
      if (least > 0) --left;
      ++stale;
      if (least > best || least > 0) {
        best = least, stale = 0;
        std::copy_n(points_.begin(), n_free_, places.begin());
      }
    }
    for (int i = 0; i < n_free_; ++i) mesh_.move(vertex_[i], places[i]);
    return best > 0;
  }

 private:
  int local(int v) {
    return number_[std::lower_bound(by_number_.begin(), by_number_.end(), v) - by_number_.begin()];
  }

  bool is_free(int i) const { return i < n_free_; }
  double area(const Corner& c) const {
    return cross(points_[c.next] - points_[c.at], points_[c.before] - points_[c.at]);
  }

  double least_area() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Corner& c : corners_) least = std::min(least, area(c));
    return least;
  }

  bool within(Vec2 p) const { return box_.overlaps({p, p}); }

  double energy(int i) const {
    double sum = 0;
    for (int k = first_[i]; k < first_[i + 1]; ++k) {
      const Corner& c = corners_[around_[k]];
      const Vec2 a = points_[c.next] - points_[c.at], b = points_[c.before] - points_[c.at];
      const double d = cross(a, b), root = std::sqrt(d * d + softness2_);
      const double chi = d > 0 ? (d + root) / 2 : softness2_ / (2 * (root - d));
      sum += (dot(a, a) + dot(b, b)) / chi;
    }
    return sum;
  }

  /// Takes a Newton step with the positive part of the second derivatives. The term |a|^2 / chi is convex in
  /// a and chi together, so only the curvature of chi is left out.
  void step(int i) {
    double gx = 0, gy = 0, hxx = 0, hxy = 0, hyy = 0, before = 0;
    for (int k = first_[i]; k < first_[i + 1]; ++k) {
      const Corner& c = corners_[around_[k]];
      const Vec2 a = points_[c.next] - points_[c.at], b = points_[c.before] - points_[c.at];
      const double d = cross(a, b), root = std::sqrt(d * d + softness2_);
      const double chi = d > 0 ? (d + root) / 2 : softness2_ / (2 * (root - d));
      const double sides = dot(a, a) + dot(b, b), slope = chi / root;  // of chi by d
      Vec2 dd, ds;  // gradients of d and of the squared sides
      double second = 2;
      if (c.at == i)
        dd = perp(b - a), ds = -2 * (a + b), second = 4;
      else if (c.next == i)
        dd = -perp(b), ds = 2 * a;
      else
        dd = perp(a), ds = 2 * b;
      const double p = 1 / chi, q = slope * p * p, r = 2 * sides * slope * q * p;
      before += sides * p;
      gx += p * ds.x - sides * q * dd.x;
      gy += p * ds.y - sides * q * dd.y;
      hxx += second * p - 2 * q * ds.x * dd.x + r * dd.x * dd.x;
      hxy += -q * (ds.x * dd.y + ds.y * dd.x) + r * dd.x * dd.y;
      hyy += second * p - 2 * q * ds.y * dd.y + r * dd.y * dd.y;
    }
    const double determinant = hxx * hyy - hxy * hxy;
    if (!(determinant > 0)) return;
    Vec2 move = (-1 / determinant) * Vec2{hyy * gx - hxy * gy, hxx * gy - hxy * gx};
    const Vec2 start = points_[i];
    for (int halving = 0; halving < 8; ++halving, move = 0.5 * move) {
      points_[i] = start + move;
      if (within(points_[i]) && energy(i) < before) return;
    }
    points_[i] = start;
  }

  QuadTopology& mesh_;
  int n_free_;
  std::vector<int> vertex_, by_number_, number_;  // of the mesh; then sorted, with local indices
  std::vector<Vec2> points_;
  Box<Vec2> box_;  ///< around the fixed vertices; it contains all places in their polygon
  std::vector<Corner> corners_;
  std::vector<int> first_, around_;  // corners of each free vertex
  double softness2_ = 0;
};

}  // namespace

bool untangle(QuadTopology& mesh, std::span<const int> vertices) {
  return !vertices.empty() && Untangling(mesh, vertices).run();
}

}  // namespace delquad
