#include "fields/size_envelope.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace delquad {

namespace {

constexpr int kLeafSize = 8;

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
    if (limit(s.at, s.delta) == s.delta) kept.push_back(s);
  }
  samples_ = std::move(kept);
  build();
}

void SizeEnvelope::build() {
  nodes_.clear();
  if (!samples_.empty()) build(0, static_cast<int>(samples_.size()));
}

int SizeEnvelope::build(int begin, int end) {
  const int index = static_cast<int>(nodes_.size());
  Node node{{INFINITY, INFINITY}, {-INFINITY, -INFINITY}, INFINITY, begin, end, -1};
  for (int i = begin; i < end; ++i) {
    const auto& [p, delta] = samples_[i];
    node.low = {std::min(node.low.x, p.x), std::min(node.low.y, p.y)};
    node.high = {std::max(node.high.x, p.x), std::max(node.high.y, p.y)};
    node.least = std::min(node.least, delta);
  }
  nodes_.push_back(node);
  if (end - begin <= kLeafSize) return index;

  const bool by_x = node.high.x - node.low.x > node.high.y - node.low.y;
  const int middle = begin + (end - begin) / 2;
  std::nth_element(samples_.begin() + begin, samples_.begin() + middle, samples_.begin() + end,
                   [by_x](const Sample& a, const Sample& b) {
                     return by_x ? by_place(a, b) : std::tie(a.at.y, a.at.x) < std::tie(b.at.y, b.at.x);
                   });
  build(begin, middle);
  const int right = build(middle, end);
  nodes_[index].right = right;
  return index;
}

double SizeEnvelope::bound(const Node& node, Vec2 x) const {
  const double dx = std::max({node.low.x - x.x, 0.0, x.x - node.high.x});
  const double dy = std::max({node.low.y - x.y, 0.0, x.y - node.high.y});
  return node.least + slope_ * norm(Vec2{dx, dy});
}

double SizeEnvelope::limit(Vec2 x, double delta) const {
  if (nodes_.empty()) return delta;
  std::vector<std::pair<double, int>> stack;
  const auto push = [&](int index) { stack.emplace_back(bound(nodes_[index], x), index); };
  push(0);
  while (!stack.empty()) {
    const auto [least, index] = stack.back();
    stack.pop_back();
    if (least >= delta) continue;
    const Node& node = nodes_[index];
    if (node.right >= 0) {
      push(node.right);
      push(index + 1);
      if (stack.back().first > stack[stack.size() - 2].first)
        std::swap(stack.back(), stack[stack.size() - 2]);
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      delta = std::min(delta, samples_[i].delta + slope_ * norm(x - samples_[i].at));
    }
  }
  return delta;
}

}  // namespace delquad
