#include "patches/tip_caps.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace delquad {

namespace {

/// Corners below this angle take two quads at most; a cap ends where this many edges go around the cone.
constexpr double kTwoQuads = 200 * std::numbers::pi / 180, kAround = 5.5;
/// The largest angle of a cap's quads opposite to the tip.
constexpr double kFarAngle = 120 * std::numbers::pi / 180;

class Cap {
 public:
  Cap(BoundaryLoop& loop, size_t tip, const std::function<int(Vec2)>& add_node)
      : loop_(loop), tip_(tip), add_node_(add_node) {}

  std::optional<BoundaryCap> make() {
    const size_t n = loop_.size();
    size_t most = 0;  // nodes that both sides have
    while (2 * (most + 1) + 1 < n && after(most + 1).node == before(most + 1).node) ++most;
    if (most < 2 || angle() >= kTwoQuads) return std::nullopt;
    size_t k = 1;
    while (k + 1 < most &&
           norm(after(k).point - before(k).point) < kAround * norm(after(k + 1).point - after(k).point))
      ++k;
    BoundaryCap cap{loop_[tip_].node, 3, {}, {}, {}};
    for (size_t i = 1; i < k; ++i) cap.dropped.push_back(after(i).node);
    replace(k, cap);
    return cap;
  }

 private:
  const LoopPoint& after(size_t i) const { return loop_[(tip_ + i) % loop_.size()]; }
  const LoopPoint& before(size_t i) const { return loop_[(tip_ + loop_.size() - i) % loop_.size()]; }

  /// Inside the patch; radians.
  double angle() const {
    const Vec2 out = after(1).point - loop_[tip_].point, in = before(1).point - loop_[tip_].point;
    const double a = std::atan2(cross(out, in), dot(out, in));
    return a > 0 ? a : a + 2 * std::numbers::pi;
  }

  /// Puts three new vertices between the k-th on both sides of the tip.
  void replace(size_t k, BoundaryCap& cap) {
    const Vec2 at = loop_[tip_].point, side = after(k).point - at;
    const double part = angle() / 4;
    const auto turned = [&](int parts, double scale) {
      const double c = scale * std::cos(parts * part), s = scale * std::sin(parts * part);
      return at + Vec2{c * side.x - s * side.y, s * side.x + c * side.y};
    };
    const double far_angle = std::min(kFarAngle, std::numbers::pi - 2 * part);
    const double far = std::cos(part) + std::sin(part) / std::tan(far_angle / 2);
    LoopPoint fresh[3];
    for (int i = 0; i < 3; ++i) {
      const Vec2 x = turned(3 - i, i == 1 ? 1 : far);
      fresh[i] = {x, add_node_(x), after(0).curve};
    }
    const int tip = loop_[tip_].node, foot = after(k).node;
    cap.quads = {{tip, foot, fresh[2].node, fresh[1].node}, {tip, fresh[1].node, fresh[0].node, foot}};
    cut_off_tip(loop_, tip_, k, fresh);
  }

  BoundaryLoop& loop_;
  size_t tip_;
  const std::function<int(Vec2)>& add_node_;
};

}  // namespace

std::vector<BoundaryCap> cap_tips(PatchBoundary& boundary, const std::function<int(Vec2)>& add_node) {
  return cap_loops(boundary, [&](std::vector<BoundaryLoop>& loops, size_t l, size_t i) {
    return Cap(loops[l], i, add_node).make();
  });
}

}  // namespace delquad
