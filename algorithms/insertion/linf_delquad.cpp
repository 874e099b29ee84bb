// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "algorithms/insertion/linf_geometry.h"
#include "delquad/extend.h"

namespace delquad {

namespace {

/// Largest slope |beta| / alpha of edges that count as aligned with the cross. Their new point lies straight
/// above an end. The bisector of an aligned edge is a region [remacle2013, Figure 9]. On nearly aligned edges
/// it would lean by |rho - e| if sizes change.
constexpr double kAlignedSlope = 0.25;
/// Shortest leg over the edge, if sizes shrink faster than the front can follow.
constexpr double kShortestLeg = 0.79;

/// Insertion in the L-infinity norm of the cross [remacle2013, section 5], stage D. The ideal triangle is
/// half a square of side delta'.
///
/// It differs from the paper. The point is B(rho), with rho = delta' clamped by the rho of the circumsquares
/// instead of the printed t, whose min and max are exchanged. There is no lower clamp, and nearly aligned
/// edges keep their right angle.
class LinfDelquad final : public PointPlacement {
 public:
  std::string name() const override { return "L-infinity Delquad"; }
  double default_h_max() const override { return 1.4; }

  double triangle_size(const std::array<Vec2, 3>& t, Cross cross, double delta) const override {
    return linf_extent(t, Frame::from_cross(cross)) / delta;
  }

  Candidates candidates(const FrontEdge& edge) const override {
    const CanonicalEdge e(edge.p, edge.q, edge.frame);
    const Vec2 apex = e.to_local(edge.apex);
    Candidates points;
    if (std::abs(e.beta) > kAlignedSlope * e.alpha) {
      points.add(e.to_global(bisector_point(e, distance(e, apex, edge.delta))));
      return points;
    }
    // The points above P and Q are the ends of the tilted branch of the bisector, for either sign of beta.
    bool above_p = e.beta > 0;
    if (std::abs(e.beta) < kAlignedNoise * e.alpha) {
      above_p = !edge.resolved_apex || e.to_local(*edge.resolved_apex).x <= 0;
    }
    for (const bool at_p : {above_p, !above_p}) {
      CanonicalEdge side = e;
      side.beta = std::copysign(e.beta, at_p ? 1.0 : -1.0);
      const double rho = distance(side, apex, edge.delta);
      const double x = std::min(e.alpha, rho - e.alpha);
      if (x < 0) continue;
      points.add(e.to_global({at_p ? -x : x, rho + (at_p ? -e.beta : e.beta)}));
    }
    if (points.count == 0) points.add(flat_centre(e, apex));
    return points;
  }

  double length(Vec2 v, const Frame& frame) const override { return linf_norm(frame.to_local(v)); }

 private:
  static constexpr double kAlignedNoise = 1e-9;

  static double distance(const CanonicalEdge& e, Vec2 apex, double delta) {
    return std::min(std::max(delta, kShortestLeg * e.length()), circumradius_on_branch(e, apex));
  }

  /// Returns the circumcenter of a very flat active triangle, on the straight part of the bisector.
  static Vec2 flat_centre(const CanonicalEdge& e, Vec2 apex) {
    const double slack = e.alpha - std::abs(e.beta);
    return e.to_global({0, std::clamp(apex.y - e.alpha, -slack, slack)});
  }
};

}  // namespace

std::unique_ptr<PointPlacement> make_linf_delquad() { return std::make_unique<LinfDelquad>(); }

}  // namespace delquad
