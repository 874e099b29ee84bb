// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/sizes/fine_spots.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/box_tree.h"
#include "base/segment.h"
#include "geometry/mesh/nearest_triangle.h"

namespace delquad {
namespace {

/// Edges below this part of the size are short. Halves are what rounding leaves of whole numbers of edges.
constexpr double kShort = 0.6;
/// Sizes do not follow edges that are shorter than this part of the size.
constexpr double kShortest = 0.05;
/// Beside edges longer than the size it falls by so much per unit length: what was asked holds an edge or two
/// away.
constexpr double kRaisedGradation = 0.7;

/// From a spot to x.
double distance_to(const LocalSize& s, const Vec3& x) {
  if (s.c) {
    const auto w = nearest_weights(s.a, s.b, *s.c, x);
    return norm(w[0] * s.a + w[1] * s.b + w[2] * *s.c - x);
  }
  return norm(x - s.a - nearest_part(x, s.a, s.b) * (s.b - s.a));
}

class SizeWithLocal final : public SizeField {
 public:
  SizeWithLocal(std::shared_ptr<const SizeField> base, std::vector<LocalSize> spots)
      : base_(std::move(base)), spots_(std::move(spots)) {
    std::vector<Box<Vec3>> boxes;
    for (const LocalSize& s : spots_) {
      const Vec3 margin{s.reach, s.reach, s.reach};
      const Vec3 c = s.c.value_or(s.b);
      boxes.push_back({lower(lower(s.a, s.b), c) - margin, upper(upper(s.a, s.b), c) + margin});
      least_growth_ = std::min(least_growth_, s.growth);
    }
    tree_ = BoxTree<Vec3>(boxes);
    for (const auto& node : tree_.nodes()) {
      double& least = least_.emplace_back(std::numeric_limits<double>::infinity());
      for (const int i : tree_.items(node)) least = std::min(least, spots_[static_cast<std::size_t>(i)].size);
    }
  }

  double at(const Vec3& x, int& hint) const override {
    double delta = base_->at(x, hint);
    tree_.search(
        delta,
        [&](const auto& node) {
          return least_[static_cast<std::size_t>(&node - tree_.nodes().data())] +
                 least_growth_ * std::sqrt(node.box.distance2(x));
        },
        [&](int i) { delta = std::min(delta, by(spots_[static_cast<std::size_t>(i)], x)); });
    return delta;
  }

 private:
  static double by(const LocalSize& s, const Vec3& x) {
    return s.size + s.growth * std::max(distance_to(s, x) - s.reach, 0.0);
  }

  std::shared_ptr<const SizeField> base_;
  std::vector<LocalSize> spots_;
  std::vector<double> least_;  ///< size, by node of the tree
  double least_growth_ = std::numeric_limits<double>::infinity();
  BoxTree<Vec3> tree_;
};

/// The field, and more around spots whose sizes are larger: less from there on by their growth.
class RaisedSize final : public SizeField {
 public:
  RaisedSize(std::shared_ptr<const SizeField> base, std::vector<LocalSize> spots)
      : base_(std::move(base)), spots_(std::move(spots)) {
    std::vector<Box<Vec3>> boxes;
    for (const LocalSize& s : spots_) {
      boxes.push_back({lower(s.a, s.b), upper(s.a, s.b)});
      most_ = std::max(most_, s.size);
    }
    tree_ = BoxTree<Vec3>(boxes);
  }

  double at(const Vec3& x, int& hint) const override {
    double less = -base_->at(x, hint);
    tree_.search(
        less, [&](const auto& node) { return kRaisedGradation * std::sqrt(node.box.distance2(x)) - most_; },
        [&](int i) {
          const LocalSize& s = spots_[static_cast<std::size_t>(i)];
          less = std::min(less, kRaisedGradation * distance_to(s, x) - s.size);
        });
    return -less;
  }

 private:
  std::shared_ptr<const SizeField> base_;
  std::vector<LocalSize> spots_;
  double most_ = 0;
  BoxTree<Vec3> tree_;
};

}  // namespace

std::shared_ptr<const SizeField> as_near(std::shared_ptr<const SizeField> base,
                                         const std::vector<LocalSize>& spots) {
  std::vector<LocalSize> finer, coarser;
  int hint = -1;
  for (const LocalSize& s : spots)
    (s.size < base->at(0.5 * (s.a + s.b), hint) ? finer : coarser).push_back(s);
  if (!coarser.empty()) base = std::make_shared<RaisedSize>(std::move(base), std::move(coarser));
  return finer_near(std::move(base), std::move(finer));
}

std::shared_ptr<const SizeField> finer_near(std::shared_ptr<const SizeField> base,
                                            std::vector<LocalSize> spots) {
  if (spots.empty()) return base;
  return std::make_shared<SizeWithLocal>(std::move(base), std::move(spots));
}

std::vector<LocalSize> short_edges(const PlanarDomain& domain, const SizeField& size, double aspect) {
  std::vector<LocalSize> spots;
  if (!domain.has_junctions) return spots;
  int hint = -1;
  for (const auto& [v, w] : domain.boundary.lines) {
    const Vec3 &a = domain.boundary.points[v], &b = domain.boundary.points[w];
    const double length = norm(b - a), wanted = size.at(0.5 * (a + b), hint);
    if (aspect * length < kShort * wanted)
      spots.push_back({a, b, aspect * std::max(length, kShortest * wanted), length});
  }
  return spots;
}

}  // namespace delquad
