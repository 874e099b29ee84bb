// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/symmetry/flat_model.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <numeric>
#include <set>
#include <utility>

#include "base/box_tree.h"
#include "delquad/error.h"
#include "geometry/mesh/constrained_delaunay.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/planar/curve_pieces.h"
#include "geometry/planar/curve_span.h"
#include "geometry/planar/domain_builder.h"

namespace delquad {
namespace {

Vec3 in_space(Vec2 x) { return {x.x, x.y, 0}; }

/// The true curves of a flat model. Faces end at them.
class FlatProjector final : public SurfaceProjector {
 public:
  FlatProjector(const std::vector<CurvePiece>& pieces, const Mesh& fine)
      : triangles_(fine.points, fine.triangles), rounding_(1e-12 * diagonal(fine)) {
    std::vector<Box<Vec2>> boxes;
    for (const CurvePiece& piece : pieces) {
      shapes_.push_back(piece.shape);
      spans_.emplace_back(*piece.shape, piece.from, piece.to);
      boxes.push_back(spans_.back().box());
    }
    tree_ = BoxTree<Vec2>(boxes);
  }
  Vec3 to_face(int, const Vec3& x) const override {
    if (triangles_.find(x).distance <= rounding_) return x;
    Vec2 at{x.x, x.y};
    double best2 = std::numeric_limits<double>::infinity();
    tree_.nearest(Vec2{x.x, x.y}, best2, [&](int i) {
      const CurveSpan::Place place = spans_[i].nearest({x.x, x.y});
      if (place.distance * place.distance < best2) best2 = place.distance * place.distance, at = place.at;
    });
    return in_space(at);
  }
  Vec3 to_curve(int curve, const Vec3& x) const override {
    return in_space(spans_[curve].nearest({x.x, x.y}).at);
  }

 private:
  std::vector<std::shared_ptr<const Curve>> shapes_;
  std::vector<CurveSpan> spans_;
  BoxTree<Vec2> tree_;
  NearestTriangle triangles_;
  double rounding_;
};

/// Returns the pieces as chords, line by line, each piece a curve. `parts`: of each chord of a CurveSpan.
Mesh chords_of(const PlanarModel& model, const ModelChain& chain, const std::vector<CurvePiece>& pieces,
               int parts) {
  Mesh lines;
  std::ranges::transform(chain.nodes, std::back_inserter(lines.points), in_space);
  const std::vector<Entity> curves = curve_entities(model);
  for (const CurvePiece& piece : pieces) {
    const std::vector<double> ends = CurveSpan(*piece.shape, piece.from, piece.to).ends();
    int last = piece.ends[0];
    const auto add = [&](int next) {
      lines.lines.push_back({std::exchange(last, next), next});
      lines.line_curve.push_back(static_cast<int>(lines.curves.size()));
    };
    for (std::size_t k = 1; k < ends.size(); ++k)
      for (int i = 1; i <= parts; ++i) {
        if (k + 1 == ends.size() && i == parts) break;
        lines.points.push_back(in_space(
            piece.shape->point(ends[k - 1] + static_cast<double>(i) / parts * (ends[k] - ends[k - 1]))));
        add(static_cast<int>(lines.points.size()) - 1);
      }
    add(piece.ends[1]);
    lines.curves.push_back(curves[piece.curves.front()]);
  }
  return lines;
}

/// Throws InputError if chords cross.
Mesh triangulate(const PlanarModel& model, const ModelChain& chain, const std::vector<CurvePiece>& pieces,
                 const std::vector<std::vector<int>>& loops, int parts) {
  Mesh lines = chords_of(model, chain, pieces, parts);
  const BoundaryNames names{
      model.source, [&](int c) { return curve_label(model, pieces[c].curves.front()); }, {}};
  const Arrangement arrangement = arrange_lines(lines, names);
  FaceRegions regions = regions_of_loops(lines, arrangement, chain.loops, loops, names);
  PlanarDomain domain =
      build_domain(std::move(lines), arrangement, std::move(regions), names, {.may_bound_nothing = true});
  for (std::size_t p = 0; p < domain.patches.size(); ++p)
    for (const auto& [a, b, c] : constrained_delaunay(domain.patches[p]).triangles) {
      const std::vector<int>& node = domain.patches[p].point_node;
      domain.boundary.triangles.push_back({node[a], node[b], node[c]});
      domain.boundary.triangle_region.push_back(domain.patch_region[p]);
    }
  return std::move(domain.boundary);
}

}  // namespace

SurfaceModel flat_model(const PlanarModel& model) {
  constexpr int kParts = 4, kMostParts = 64;
  const ModelChain chain = chain_model(model);
  const std::vector<CurvePiece> pieces = cut_curves(model, chain);
  const auto of_model = loops_of_model_curves(model, chain);
  std::vector<std::vector<int>> loops;
  for (const CurvePiece& piece : pieces) {
    auto& of_piece = loops.emplace_back();
    for (const int c : piece.curves) of_piece.insert(of_piece.end(), of_model[c].begin(), of_model[c].end());
  }
  SurfaceModel flat;
  flat.source = model.source;
  for (int parts = kParts; flat.fine.points.empty(); parts *= 4) try {
      flat.fine = triangulate(model, chain, pieces, loops, parts);
    } catch (const InputError&) {
      if (parts >= kMostParts) throw;
    }
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (loops[i].empty()) flat.embedded.push_back({static_cast<int>(i), 0});
  flat.projector = std::make_shared<FlatProjector>(pieces, flat.fine);
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    flat.fine.named_points.push_back(
        {static_cast<int>(flat.fine.points.size()), {0, {model.points[i].name}}});
    flat.fine.points.push_back(in_space(model.points[i].at));
  }
  std::set<int> ends;
  for (const CurvePiece& piece : pieces) ends.insert(piece.ends.begin(), piece.ends.end());
  flat.corners.resize(ends.size());  // the nodes come first
  std::iota(flat.corners.begin(), flat.corners.end(), 0);
  return flat;
}

}  // namespace delquad
