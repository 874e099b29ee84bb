// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <tuple>
#include <utility>
#include <vector>

#include "algorithms/fields/check_size.h"
#include "algorithms/fields/fields.h"
#include "algorithms/fields/sample_triangle.h"
#include "base/box.h"
#include "base/box_tree.h"
#include "base/cancel.h"
#include "delquad/mesh.h"

namespace delquad {

namespace {

/// Lower envelope of sizes at points that grow with the distance at the same slope.
class SizeEnvelope {
 public:
  struct Sample {
    Vec2 at;
    double delta;
  };
  SizeEnvelope(std::vector<Sample> samples, double slope);

  /// Returns the smaller of delta and the envelope at x.
  double limit(Vec2 x, double delta) const;

 private:
  void build();
  /// Returns whether another sample makes the envelope as small there, so that s is no part of it.
  bool is_explained(const Sample& s) const;
  double bound(const BoxTree<Vec2>::Node& node, Vec2 x) const;

  double slope_;
  std::vector<Sample> samples_;
  BoxTree<Vec2> tree_;
  std::vector<double> least_;  ///< least size of the samples in each node of the tree
};

/// Relative difference that counts as a tie, since sizes that grow at the slope lie on the envelope up to
/// rounding.
constexpr double kTie = 1e-9;

bool by_place(const SizeEnvelope::Sample& a, const SizeEnvelope::Sample& b) {
  return std::tie(a.at.x, a.at.y, a.delta) < std::tie(b.at.x, b.at.y, b.delta);
}

SizeEnvelope::SizeEnvelope(std::vector<Sample> samples, double slope)
    : slope_(slope), samples_(std::move(samples)) {
  std::sort(samples_.begin(), samples_.end(), by_place);
  const auto same_place = [](const Sample& a, const Sample& b) { return a.at == b.at; };
  samples_.erase(std::unique(samples_.begin(), samples_.end(), same_place), samples_.end());
  build();
  std::vector<Sample> kept;
  for (const Sample& s : samples_) {
    check_cancelled();
    if (!is_explained(s)) kept.push_back(s);
  }
  samples_ = std::move(kept);
  build();
}

void SizeEnvelope::build() {
  std::vector<Box<Vec2>> boxes;
  boxes.reserve(samples_.size());
  for (const Sample& s : samples_) boxes.push_back({s.at, s.at});
  tree_ = BoxTree<Vec2>(boxes);
  least_.clear();
  for (const auto& node : tree_.nodes()) {
    least_.push_back(INFINITY);
    for (const int i : tree_.items(node)) least_.back() = std::min(least_.back(), samples_[i].delta);
  }
}

bool SizeEnvelope::is_explained(const Sample& s) const {
  double limit = (1 + kTie) * s.delta;
  tree_.search(
      limit, [&](const BoxTree<Vec2>::Node& node) { return bound(node, s.at); },
      [&](int i) {
        const Sample& other = samples_[i];
        if (other.delta < s.delta && other.delta + slope_ * norm(s.at - other.at) <= limit) limit = -INFINITY;
      });
  return limit < 0;
}

double SizeEnvelope::bound(const BoxTree<Vec2>::Node& node, Vec2 x) const {
  return least_[static_cast<std::size_t>(&node - tree_.nodes().data())] +
         slope_ * std::sqrt(node.box.distance2(x));
}

double SizeEnvelope::limit(Vec2 x, double delta) const {
  tree_.search(
      delta, [&](const BoxTree<Vec2>::Node& node) { return bound(node, x); },
      [&](int i) { delta = std::min(delta, samples_[i].delta + slope_ * norm(x - samples_[i].at)); });
  return delta;
}

// Largest distance of samples, over the diagonal of the domain.
constexpr double kCoarsestGrid = 1.0 / 64;
// Largest factor by which the base may vary in a triangle, unless its sides are half as long as the size.
constexpr double kMostVariation = 1.1;
constexpr double kFinest = 0.5;
// Limit of samples, and samples of a triangle; the widest triangles are cut first.
constexpr std::size_t kMostGridSamples = 1'000'000, kPerTriangle = 6;

class LimitedSize final : public SizeField {
 public:
  LimitedSize(std::shared_ptr<const SizeField> base, SizeEnvelope envelope)
      : base_(std::move(base)), envelope_(std::move(envelope)) {}
  double at(const Vec3& x, int& hint) const override {
    return envelope_.limit({x.x, x.y}, base_->at(x, hint));
  }

 private:
  std::shared_ptr<const SizeField> base_;
  SizeEnvelope envelope_;
};

/// Returns the base at corners and middles of triangles that are quartered by these limits. Points on shared
/// sides occur more than once.
std::vector<SizeEnvelope::Sample> sample(const SizeField& base, const TriPatch& tri) {
  const double longest = kCoarsestGrid * diagonal(tri.points);
  std::vector<SizeEnvelope::Sample> samples;
  int hint = -1;
  const auto sizes_at = [&](const Corners& at) {
    std::array<double, 3> delta;
    for (int k = 0; k < 3; ++k) delta[k] = base.at({at[k].x, at[k].y, 0}, hint);
    return delta;
  };
  std::deque<std::pair<Corners, std::array<double, 3>>> queue;
  for (const auto& v : tri.triangles) {
    const Corners corners = corners_of(tri, v);
    queue.emplace_back(corners, sizes_at(corners));
  }
  while (!queue.empty()) {
    check_cancelled();
    const auto [corners, delta] = queue.front();
    queue.pop_front();
    const Corners between = middles(corners);
    const std::array<double, 3> m = sizes_at(between);
    const bool may_split = samples.size() + kPerTriangle * queue.size() < kMostGridSamples;
    for (int k = 0; k < 3; ++k) {
      samples.push_back({corners[k], delta[k]});
      samples.push_back({between[k], m[k]});
    }
    const auto [least, most] = std::minmax({delta[0], delta[1], delta[2], m[0], m[1], m[2]});
    const double side = longest_side(corners);
    if (may_split && (side > longest || (most > kMostVariation * least && side > kFinest * least))) {
      samples.resize(samples.size() - kPerTriangle);
      const std::array<double, 3> sizes[] = {
          {delta[0], m[2], m[1]}, {m[2], delta[1], m[0]}, {m[1], m[0], delta[2]}, m};
      const auto parts = quarters(corners);
      for (int k = 0; k < 4; ++k) queue.emplace_back(parts[k], sizes[k]);
    }
  }
  return samples;
}

}  // namespace

std::unique_ptr<SizeField> limit_gradation(std::shared_ptr<const SizeField> base,
                                           std::shared_ptr<const BackgroundMesh> background, double slope) {
  if (!is_size(slope))
    throw InputError(fmt::format("the gradation limit is {}: expected a slope > 0", slope));
  SizeEnvelope envelope(sample(*base, background->triangles()), slope);
  return std::make_unique<LimitedSize>(std::move(base), std::move(envelope));
}

}  // namespace delquad
