#include "fields/size_envelope.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/cancel.h"

namespace delquad {

namespace {

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
  // What lies above the envelope is no part of it.
  std::vector<Sample> kept;
  for (const Sample& s : samples_) {
    check_cancelled();
    if (limit(s.at, s.delta) == s.delta) kept.push_back(s);
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

double SizeEnvelope::limit(Vec2 x, double delta) const {
  tree_.search(
      delta,
      [&](const BoxTree<Vec2>::Node& node) {
        const auto index = static_cast<std::size_t>(&node - tree_.nodes().data());
        return least_[index] + slope_ * std::sqrt(node.box.distance2(x));
      },
      [&](int i) { delta = std::min(delta, samples_[i].delta + slope_ * norm(x - samples_[i].at)); });
  return delta;
}

}  // namespace delquad
