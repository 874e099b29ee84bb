// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/symmetry/flat_model.h"

#include <limits>
#include <numbers>

#include "base/box_tree.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/planar/curve_span.h"
#include "geometry/surface/curve_chains.h"

namespace delquad {
namespace {

/// Where a planar curve turns by more, its point counts as a corner.
constexpr double kTurn = 30 * std::numbers::pi / 180;

class FlatProjector final : public SurfaceProjector {
 public:
  FlatProjector(const PlanarDomain& domain, const Mesh& fine)
      : triangles_(fine.points, fine.triangles), rounding_(1e-12 * diagonal(fine)), pieces_(domain.pieces) {
    std::vector<Box<Vec2>> boxes;
    for (const DomainPiece& piece : pieces_) {
      spans_.emplace_back(*piece.shape, piece.from, piece.to);
      boxes.push_back(spans_.back().box());
    }
    tree_ = BoxTree<Vec2>(boxes);
  }
  Vec3 to_face(int, const Vec3& x) const override {
    return triangles_.find(x).distance <= rounding_ ? x : to_curve(0, x);
  }
  Vec3 to_curve(int, const Vec3& x) const override {
    Vec2 at{x.x, x.y};
    double best2 = std::numeric_limits<double>::infinity();
    tree_.nearest(Vec2{x.x, x.y}, best2, [&](int i) {
      const CurveSpan::Place place = spans_[i].nearest({x.x, x.y});
      if (place.distance * place.distance < best2) best2 = place.distance * place.distance, at = place.at;
    });
    return {at.x, at.y, x.z};
  }

 private:
  NearestTriangle triangles_;
  double rounding_;
  std::vector<DomainPiece> pieces_;  ///< keep their shapes
  std::vector<CurveSpan> spans_;
  BoxTree<Vec2> tree_;
};

}  // namespace

SurfaceModel flat_model(const PlanarDomain& domain, const std::string& source) {
  SurfaceModel model;
  model.source = source;
  model.fine = domain.boundary;
  for (std::size_t p = 0; p < domain.patches.size(); ++p) {
    const auto& node = domain.patches[p].point_node;
    for (const auto& [a, b, c] : constrained_delaunay(domain.patches[p]).triangles) {
      if (node[a] == node[b] || node[b] == node[c] || node[c] == node[a]) continue;  // at openings
      model.fine.triangles.push_back({node[a], node[b], node[c]});
      model.fine.triangle_region.push_back(domain.patch_region[p]);
    }
  }
  const Mesh& mesh = model.fine;
  std::vector<char> corner(mesh.points.size(), 0);
  mark_turns(mesh, kTurn, std::vector<char>(mesh.points.size(), 1), corner);
  std::vector<int> curve_at(mesh.points.size(), -1);
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    for (const int v : mesh.lines[l]) {
      if (curve_at[v] >= 0 && curve_at[v] != mesh.line_curve[l]) corner[v] = 1;
      curve_at[v] = mesh.line_curve[l];
    }
  for (std::size_t v = 0; v < corner.size(); ++v)
    if (corner[v]) model.corners.push_back(static_cast<int>(v));
  return model;
}

std::shared_ptr<const SurfaceProjector> flat_projector(const PlanarDomain& domain, const Mesh& fine) {
  return std::make_shared<FlatProjector>(domain, fine);
}

}  // namespace delquad
