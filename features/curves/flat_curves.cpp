// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curves/flat_curves.h"

#include <cmath>
#include <utility>

#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/planar/domain_builder.h"

namespace delquad {
namespace {

FlatPatch flat_patch(const PatchBoundary& boundary, int region) {
  FlatPatch map;
  map.face = region;
  map.flat = constrained_delaunay(boundary);
  map.fine_node = boundary.point_node;
  map.method = "plane";
  for (const std::vector<int>& edges : loops_of_edges(boundary)) {
    auto& loop = map.loops.emplace_back();
    for (const int e : edges) loop.push_back(boundary.edges[e][0]);
  }
  return map;
}

/// The points of each piece. `fine` has the same lines as `lines`, some of them turned.
std::vector<CurveChain> chains_of(const Mesh& fine, const Mesh& lines,
                                  const std::vector<CurvePiece>& pieces) {
  std::vector<CurveChain> chains;
  std::size_t line = 0;
  for (const CurvePiece& piece : pieces) {
    CurveChain& chain = chains.emplace_back(CurveChain{fine.line_curve[line], {}});
    for (int k = 0; k < piece.n; ++k, ++line) {
      auto [a, b] = fine.lines[line];
      const Vec3 &from = lines.points[lines.lines[line][0]], &x = fine.points[a];
      if (x.x != from.x || x.y != from.y) std::swap(a, b);
      if (k == 0) chain.points.push_back(a);
      chain.points.push_back(b);
    }
  }
  return chains;
}

/// From the first vector counterclockwise to the second, in radians from -pi to pi.
double turn(Vec2 from, Vec2 to) { return std::atan2(cross(from, to), dot(from, to)); }

/// Angles between curves in place of those between their first edges.
void correct_angles(const Mesh& fine, const std::vector<CurvePiece>& pieces, SurfaceCurves& curves) {
  const auto by_edge = [&](int c, bool from_end) {
    const std::vector<int>& points = curves.chains[c].points;
    const std::size_t n = points.size();
    const Vec3 edge = from_end ? fine.points[points[n - 2]] - fine.points[points[n - 1]]
                               : fine.points[points[1]] - fine.points[points[0]];
    return Vec2{edge.x, edge.y};
  };
  for (FaceCorner& corner : curves.corners) {
    const Vec2 out = pieces[corner.after].leaving(corner.after_ends),
               back = pieces[corner.before].leaving(corner.before_ends);
    corner.angle += turn(out, by_edge(corner.after, corner.after_ends)) +
                    turn(by_edge(corner.before, corner.before_ends), back);
  }
}

}  // namespace

FlatCurves flat_curves(const Mesh& lines, const Arrangement& arrangement, const FaceRegions& regions,
                       const BoundaryNames& names, const std::vector<CurvePiece>& pieces) {
  SpecialCurves special;
  special.may_bound_nothing = true;
  PlanarDomain domain = build_domain(lines, arrangement, regions, names, special);
  FlatCurves flat;
  flat.fine = std::move(domain.boundary);
  SurfaceCurves& curves = flat.curves;
  for (std::size_t p = 0; p < domain.patches.size(); ++p)
    curves.maps.push_back(flat_patch(domain.patches[p], domain.patch_region[p]));
  curves.chains = chains_of(flat.fine, lines, pieces);
  curves.cut_face.assign(flat.fine.curves.size(), -1);
  curves.is_embedded.assign(flat.fine.curves.size(), 0);
  const LineIndex index(curves.chains);
  for (const FlatPatch& map : curves.maps)
    curves.outlines.push_back(index.outline(map, curves.chains, "a region"));
  curves.corners = face_corners(flat.fine, curves.chains, curves.maps, curves.outlines);
  correct_angles(flat.fine, pieces, curves);
  curves.tube_sizes.resize(curves.maps.size());
  return flat;
}

}  // namespace delquad
