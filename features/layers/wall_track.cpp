#include "features/layers/wall_track.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace delquad {

WallTrack::WallTrack(std::vector<Vec2> points, std::shared_ptr<const Curve> curve, std::vector<double> params)
    : points_(std::move(points)), curve_(std::move(curve)), params_(std::move(params)) {
  Vec2 last = points_[0];
  for (int i = 1; i <= kSamples * n_edges(); ++i) {
    const Vec2 next = point(static_cast<double>(i) / kSamples);
    length_.push_back(length_.back() + norm(next - last));
    last = next;
  }
}

double WallTrack::place(double length) const {
  const auto above = std::upper_bound(length_.begin() + 1, length_.end() - 1, length);
  const auto i = above - length_.begin();
  const double part = (length - length_[i - 1]) / (length_[i] - length_[i - 1]);
  return (static_cast<double>(i - 1) + std::clamp(part, 0.0, 1.0)) / kSamples;
}

Vec2 WallTrack::point(double place) const {
  const auto edge = static_cast<std::size_t>(std::min(std::floor(place), n_edges() - 1.0));
  const double part = place - static_cast<double>(edge);
  if (part == 0) return points_[edge];
  if (part == 1) return points_[edge + 1];
  return curve_ ? curve_->point(param(place)) : (1 - part) * points_[edge] + part * points_[edge + 1];
}

double WallTrack::param(double place) const {
  const auto edge = static_cast<std::size_t>(std::min(std::floor(place), n_edges() - 1.0));
  return std::lerp(params_[edge], params_[edge + 1], place - static_cast<double>(edge));
}

}  // namespace delquad
