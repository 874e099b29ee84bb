#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <utility>

#include "base/box.h"
#include "base/cancel.h"
#include "fields/check_size.h"
#include "fields/fields.h"
#include "fields/sample_triangle.h"
#include "fields/size_envelope.h"

namespace delquad {

namespace {

// The domain is seen at this fraction of its diagonal at least.
constexpr double kCoarsestGrid = 1.0 / 64;
// Triangles are cut up where the base varies by more than this factor within one, down to half the size
// itself.
constexpr double kMostVariation = 1.1;
constexpr double kFinest = 0.5;
// Bounds the work; the widest triangles are cut first.
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

/// The base at corners and middles of triangles cut up as above. Points on shared sides come more than once.
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
    throw InputError(fmt::format("the gradation limit is {}; expected a slope > 0", slope));
  SizeEnvelope envelope(sample(*base, background->triangles()), slope);
  return std::make_unique<LimitedSize>(std::move(base), std::move(envelope));
}

}  // namespace delquad
