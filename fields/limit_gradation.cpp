#include <fmt/format.h>

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
  std::deque<Corners> queue;
  for (const auto& v : tri.triangles) queue.push_back(corners_of(tri, v));
  int hint = -1;
  while (!queue.empty()) {
    check_cancelled();
    const Corners corners = queue.front();
    queue.pop_front();
    const bool may_split = samples.size() + kPerTriangle * queue.size() < kMostGridSamples;
    double least = INFINITY, most = 0;
    for (const Corners& three : {corners, middles(corners)}) {
      for (const Vec2 x : three) {
        const double delta = base.at({x.x, x.y, 0}, hint);
        samples.push_back({x, delta});
        least = std::min(least, delta);
        most = std::max(most, delta);
      }
    }
    const double side = longest_side(corners);
    if (may_split && (side > longest || (most > kMostVariation * least && side > kFinest * least))) {
      samples.resize(samples.size() - kPerTriangle);
      for (const Corners& quarter : quarters(corners)) queue.push_back(quarter);
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
