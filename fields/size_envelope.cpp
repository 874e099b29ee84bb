#include "fields/size_envelope.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/cancel.h"

namespace delquad {

namespace {

/// Sizes that grow at the slope of the envelope lie on it up to rounding; samples there would be looked at in
/// vain by every search.
constexpr double kTie = 1e-9;

bool by_place(const SizeEnvelope::Sample& a, const SizeEnvelope::Sample& b) {
  return std::tie(a.at.x, a.at.y, a.delta) < std::tie(b.at.x, b.at.y, b.delta);
}

}  // namespace

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

}  // namespace delquad
