#include "patches/corner_caps.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/box_tree.h"
#include "geometry/mesh/quad_corners.h"

namespace delquad {

namespace {

/// Corners below kLeastSharedAngle are cut off as far as they are narrower than this part of an edge.
constexpr double kNarrow = 0.25;
/// The least sine in a quad of a row: that of eta 0.4.
constexpr double kLeastSine = 0.588;
/// tan 30 degrees: the quad in the corner has three angles of about 120 degrees.
constexpr double kBeyond = 0.57735;

class CornerCap {
 public:
  CornerCap(std::vector<BoundaryLoop>& loops, size_t loop, size_t tip, const CapNodes& nodes)
      : loops_(loops), loop_(loops[loop]), tip_(tip), nodes_(nodes) {}

  std::optional<BoundaryCap> make() {
    if (!nodes_.may_be_cut(loop_[tip_].node) || !is_sharp()) return std::nullopt;
    normal_ = nodes_.normal(loop_[tip_].point);
    std::vector<Vec3> middles;
    while (const auto next = middle(middles)) middles.push_back(*next);
    if (middles.empty() || holds_others(middles.size())) return std::nullopt;
    BoundaryCap cap{loop_[tip_].node, 1, {}, {}, {}};
    std::vector<int> middle_nodes;
    for (const Vec3& x : middles) middle_nodes.push_back(nodes_.add(x));
    cap.quads.push_back({cap.tip, after(1).node, middle_nodes[0], before(1).node});
    for (size_t i = 1; i < middles.size(); ++i) {
      cap.quads.push_back({after(i).node, after(i + 1).node, middle_nodes[i], middle_nodes[i - 1]});
      cap.quads.push_back({middle_nodes[i - 1], middle_nodes[i], before(i + 1).node, before(i).node});
      cap.within.insert(cap.within.end(), {after(i).node, before(i).node});
    }
    replace(middles.size(), middle_nodes.back());
    return cap;
  }

 private:
  const LoopPoint& after(size_t i) const { return loop_[(tip_ + i) % loop_.size()]; }
  const LoopPoint& before(size_t i) const { return loop_[(tip_ + loop_.size() - i) % loop_.size()]; }
  Vec3 place(const LoopPoint& p) const { return nodes_.place(p.node); }

  bool is_sharp() const {
    const Vec2 out = after(1).point - loop_[tip_].point, in = before(1).point - loop_[tip_].point;
    if (!(cross(out, in) > 0 && dot(out, in) > 0)) return false;
    const Vec3 at = place(loop_[tip_]), a = place(after(1)) - at, b = place(before(1)) - at;
    return std::atan2(norm(cross(a, b)), dot(a, b)) < kLeastSharedAngle;
  }

  /// The place halfway between the next two opposite nodes; none where the cap ends.
  std::optional<Vec3> middle(const std::vector<Vec3>& found) const {
    const size_t i = found.size() + 1;
    // The rest is for a corner at the other end.
    if (4 * i >= loop_.size()) return std::nullopt;
    // Both nodes are inside their curves.
    if (after(i).curve != loop_[tip_].curve || before(i + 1).curve != before(1).curve) return std::nullopt;
    const Vec3 a = place(after(i)), b = place(before(i)), halfway = 0.5 * (a + b);
    const double width = norm(b - a);
    const double edge = std::min(norm(place(after(i + 1)) - a), norm(place(before(i + 1)) - b));
    if (after(i).node == before(i).node || width > kNarrow * edge) return std::nullopt;
    const Vec2 in_plane = 0.5 * (after(i).point + before(i).point);
    if (i > 1) {
      const Vec3 x = nodes_.to_face(halfway, in_plane), last = found.back();
      const bool good =
          is_good({place(after(i - 1)), a, x, last}, 0) && is_good({last, x, b, place(before(i - 1))}, 0);
      return good ? std::optional(x) : std::nullopt;
    }
    const Vec3 at = place(loop_[tip_]), along = halfway - at;
    const Vec3 x = nodes_.to_face(halfway + kBeyond / 2 * width / norm(along) * along,
                                  in_plane + kBeyond / 2 * perp(after(1).point - before(1).point));
    return is_good({at, a, x, b}, 1) ? std::optional(x) : std::nullopt;
  }

  /// Whether the corners from the given one on are.
  bool is_good(const std::array<Vec3, 4>& quad, int first) const {
    if (!(dot(quad_normal(quad[2] - quad[0], quad[3] - quad[1]), normal_) > 0)) return false;
    const auto sines = corner_sines<Vec3>(quad);
    return *std::min_element(sines.begin() + first, sines.end()) > kLeastSine;
  }

  /// Whether other points of the boundary are within what k rows cut off. Even-odd rule.
  bool holds_others(size_t k) const {
    std::vector<Vec2> outline{loop_[tip_].point};
    for (size_t i = 1; i <= k; ++i) outline.push_back(after(i).point);
    for (size_t i = k; i > 0; --i) outline.push_back(before(i).point);
    std::vector<Box<Vec2>> boxes;
    for (size_t i = 0; i < outline.size(); ++i)
      boxes.push_back(Box<Vec2>::around({outline[i], outline[(i + 1) % outline.size()]}));
    const BoxTree<Vec2> tree(boxes);
    const auto is_inside = [&](const LoopPoint& p) {
      const Vec2 x = p.point;
      bool inside = false, is_corner = false;
      // Sides at the height of x, and to its right.
      const auto gap = [&](const BoxTree<Vec2>::Node& node) {
        return node.box.low.y <= x.y && x.y <= node.box.high.y && x.x <= node.box.high.x ? 0 : 1;
      };
      tree.search(0.0, gap, [&](int i) {
        const Vec2 a = outline[(static_cast<size_t>(i) + 1) % outline.size()], b = outline[i];
        is_corner = is_corner || x == a || x == b;
        if ((a.y > x.y) != (b.y > x.y) && x.x < a.x + (x.y - a.y) / (b.y - a.y) * (b.x - a.x))
          inside = !inside;
      });
      return inside && !is_corner;
    };
    return std::ranges::any_of(loops_,
                               [&](const BoundaryLoop& l) { return std::ranges::any_of(l, is_inside); });
  }

  void replace(size_t k, int node) {
    const LoopPoint fresh{0.5 * (after(k).point + before(k).point), node, loop_[tip_].curve};
    cut_off_tip(loop_, tip_, k, std::span(&fresh, 1));
  }

  const std::vector<BoundaryLoop>& loops_;
  BoundaryLoop& loop_;
  size_t tip_;
  const CapNodes& nodes_;
  Vec3 normal_;
};

}  // namespace

std::vector<BoundaryCap> cap_corners(PatchBoundary& boundary, const CapNodes& nodes) {
  return cap_loops(boundary, [&](std::vector<BoundaryLoop>& loops, size_t l, size_t i) {
    return CornerCap(loops, l, i, nodes).make();
  });
}

}  // namespace delquad
