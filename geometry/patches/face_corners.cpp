// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/face_corners.h"

#include <algorithm>
#include <cmath>

namespace delquad {

namespace {

/// Returns at each point of a map the sum of the angles of its triangles in space (radians).
std::vector<double> angles_at(const Mesh& fine, const FlatPatch& map) {
  std::vector<double> angles(map.flat.points.size(), 0);
  for (const auto& v : map.flat.triangles)
    for (int k = 0; k < 3; ++k) {
      const auto point = [&](int i) { return fine.points[map.fine_node[v[i % 3]]]; };
      angles[v[k]] += angle_between(point(k + 1) - point(k), point(k + 2) - point(k));
    }
  return angles;
}

}  // namespace

std::vector<FaceCorner> face_corners(const Mesh& fine, const std::vector<CurveChain>& chains,
                                     const std::vector<FlatPatch>& maps,
                                     const std::vector<PatchOutline>& outlines) {
  std::vector<FaceCorner> corners;
  for (size_t p = 0; p < maps.size(); ++p) {
    const std::vector<double> angles = angles_at(fine, maps[p]);
    for (const auto& loop : outlines[p])
      for (size_t i = 0; i < loop.size(); ++i) {
        const CurveSide& side = loop[i];
        if (!side.begins(chains[side.chain])) continue;
        const CurveSide& last = loop[(i + loop.size() - 1) % loop.size()];
        corners.push_back(
            {static_cast<int>(p), last.chain, side.chain, last.forward, !side.forward, angles[side.from]});
      }
  }
  return corners;
}

double corner_eta_bound(double angle) {
  constexpr double kRight = std::numbers::pi / 2;
  double best = 0;
  for (int k = 1; k <= 4; ++k) best = std::max(best, 1 - std::abs(angle / k - kRight) / kRight);
  return best;
}

std::vector<SharpCorner> find_sharp_corners(const std::vector<FaceCorner>& corners,
                                            const std::vector<CurveChain>& chains,
                                            const std::vector<FlatPatch>& maps, const SurfaceNodes& nodes,
                                            double eta) {
  std::vector<SharpCorner> sharp;
  for (const FaceCorner& corner : corners) {
    if (corner.angle > kOneQuadAngle) continue;
    const auto& before = nodes.on_curve[corner.before];
    const auto& after = nodes.on_curve[corner.after];
    const int node = corner.after_ends ? after.back().node : after.front().node;
    const int out = corner.after_ends ? (after.end() - 2)->node : after[1].node;
    const int in = corner.before_ends ? (before.end() - 2)->node : before[1].node;
    const Vec3 at = nodes.points[node];
    double angle = angle_between(nodes.points[out] - at, nodes.points[in] - at);
    // The two quads at a tip have their sides on opposite generators of the cone.
    if (corner.is_tip()) angle = 2 * std::asin(corner.angle / (2 * std::numbers::pi));
    const double bound = corner_eta_bound(angle);
    if (bound < eta)
      sharp.push_back({maps[corner.patch].face,
                       node,
                       {chains[corner.before].curve, chains[corner.after].curve},
                       angle,
                       bound});
  }
  return sharp;
}

}  // namespace delquad
