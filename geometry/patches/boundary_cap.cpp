// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/boundary_cap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "base/box_tree.h"
#include "geometry/mesh/quad_corners.h"
#include "geometry/mesh/triangle_measures.h"
#include "geometry/planar/check_lines.h"

namespace delquad {

PatchBoundary make_boundary(const std::vector<BoundaryLoop>& loops) {
  PatchBoundary boundary;
  for (const BoundaryLoop& loop : loops) {
    const int first = static_cast<int>(boundary.points.size()), n = static_cast<int>(loop.size());
    for (int i = 0; i < n; ++i) {
      boundary.points.push_back(loop[i].point);
      boundary.point_node.push_back(loop[i].node);
      boundary.edge_curve.push_back(loop[i].curve);
      boundary.edges.push_back({first + i, first + (i + 1) % n});
    }
  }
  return boundary;
}

namespace {

std::vector<BoundaryLoop> take_loops(const PatchBoundary& boundary) {
  std::vector<BoundaryLoop> loops;
  for (const std::vector<int>& edges : loops_of_edges(boundary)) {
    loops.emplace_back();
    for (const int e : edges) {
      const int v = boundary.edges[e][0];
      loops.back().push_back({boundary.points[v], boundary.point_node[v], boundary.edge_curve[e]});
    }
  }
  return loops;
}

/// Replaces the tip and the points fewer than k steps beside it by others.
void cut_off_tip(BoundaryLoop& loop, std::size_t tip, std::size_t k, std::span<const LoopPoint> fresh) {
  BoundaryLoop rest;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::size_t from_tip = (i + loop.size() - tip) % loop.size();
    if (from_tip == 0)
      rest.insert(rest.end(), fresh.begin(), fresh.end());
    else if (from_tip >= k && loop.size() - from_tip >= k)
      rest.push_back(loop[i]);
  }
  loop = std::move(rest);
}

/// Returns the caps of make(loops, loop, point), which changes the loop, for all points.
template <class Make>
std::vector<BoundaryCap> cap_loops(PatchBoundary& boundary, Make make) {
  std::vector<BoundaryCap> caps;
  std::vector<BoundaryLoop> loops = take_loops(boundary);
  for (std::size_t l = 0; l < loops.size(); ++l)
    for (std::size_t i = 0; i < loops[l].size(); ++i)
      if (std::optional<BoundaryCap> cap = make(loops, l, i)) {
        caps.push_back(std::move(*cap));
        i = static_cast<std::size_t>(-1);  // the loop has changed
      }
  if (!caps.empty()) boundary = make_boundary(loops);
  return caps;
}

/// Angle below which corners take at most two quads, and edges around the cone at which a cap ends.
constexpr double kTwoQuads = 200 * std::numbers::pi / 180, kAround = 5.5;
/// Largest angle of a cap's quads opposite to the tip.
constexpr double kFarAngle = 120 * std::numbers::pi / 180;

/// The points of a loop on both sides of one of them.
class LoopTip {
 protected:
  LoopTip(BoundaryLoop& loop, size_t tip) : loop_(loop), tip_(tip) {}
  const LoopPoint& after(size_t i) const { return loop_[(tip_ + i) % loop_.size()]; }
  const LoopPoint& before(size_t i) const { return loop_[(tip_ + loop_.size() - i) % loop_.size()]; }

  BoundaryLoop& loop_;
  size_t tip_;
};

class Cap : LoopTip {
 public:
  Cap(BoundaryLoop& loop, size_t tip, const std::function<int(Vec2)>& add_node)
      : LoopTip(loop, tip), add_node_(add_node) {}

  std::optional<BoundaryCap> make() {
    const size_t n = loop_.size();
    size_t most = 0;  // number of common nodes of both sides
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
  /// Returns the angle inside the patch, radians.
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

  const std::function<int(Vec2)>& add_node_;
};

}  // namespace

std::vector<BoundaryCap> cap_tips(PatchBoundary& boundary, const std::function<int(Vec2)>& add_node) {
  return cap_loops(boundary, [&](std::vector<BoundaryLoop>& loops, size_t l, size_t i) {
    return Cap(loops[l], i, add_node).make();
  });
}

namespace {

/// Least sine in a quad of a row, for an eta of 0.4.
constexpr double kLeastSine = 0.588;
/// tan 30 degrees: the quad in the corner has three angles of about 120 degrees.
constexpr double kBeyond = 0.57735;

class CornerCap : LoopTip {
 public:
  CornerCap(std::vector<BoundaryLoop>& loops, size_t loop, size_t tip, const CapNodes& nodes)
      : LoopTip(loops[loop], tip), loops_(loops), nodes_(nodes) {}

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
  Vec3 place(const LoopPoint& p) const { return nodes_.place(p.node); }

  bool is_sharp() const {
    const Vec2 out = after(1).point - loop_[tip_].point, in = before(1).point - loop_[tip_].point;
    if (!(cross(out, in) > 0 && dot(out, in) > 0)) return false;
    const Vec3 at = place(loop_[tip_]);
    return angle_between(place(after(1)) - at, place(before(1)) - at) < kLeastSharedAngle;
  }

  /// Returns the place halfway between the next two opposite nodes; nothing if the cap ends.
  std::optional<Vec3> middle(const std::vector<Vec3>& found) const {
    const size_t i = found.size() + 1;
    // The rest remains for a corner at the other end.
    if (nodes_.ends_with_curve ? 4 * i >= loop_.size() : 2 * i + 4 > loop_.size()) return std::nullopt;
    // Both nodes are inside their curves.
    if (nodes_.ends_with_curve &&
        (after(i).curve != loop_[tip_].curve || before(i + 1).curve != before(1).curve))
      return std::nullopt;
    const Vec3 a = place(after(i)), b = place(before(i)), halfway = 0.5 * (a + b);
    const double width = norm(b - a);
    const double edge = std::min(norm(place(after(i + 1)) - a), norm(place(before(i + 1)) - b));
    if (after(i).node == before(i).node || width > nodes_.narrow * edge) return std::nullopt;
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

  /// Returns whether the quad's corners from `first` on have enough sine.
  bool is_good(const std::array<Vec3, 4>& quad, int first) const {
    if (!(dot(quad_normal(quad[2] - quad[0], quad[3] - quad[1]), normal_) > 0)) return false;
    const auto sines = corner_sines<Vec3>(quad);
    return *std::min_element(sines.begin() + first, sines.end()) > kLeastSine;
  }

  /// Returns whether other points of the boundary lie in the part that k rows cut off, by the even-odd rule.
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
