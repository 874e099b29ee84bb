// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "delquad/fields.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/surface/model_curvature.h"
#include "geometry/surface/surface_model.h"

// This header has sizes on surfaces. Features, fields and patches use it.

namespace delquad {

class SurfaceMetric;

/// A ball in which sizes are at most `size`.
struct SizeBall {
  Vec3 at;
  double reach = 0, size = 0;
};

/// The demands on sizes on a surface.
struct WantedSize {
  std::shared_ptr<const SizeField> base;            ///< in space; the largest size anywhere
  std::shared_ptr<const ModelCurvature> curvature;  ///< null: sizes do not follow curvature
  /// Elements per full turn; > 0 where there is `curvature`. delta = 2 pi r / per_turn with the smallest
  /// radius of curvature r of the face. On curves the radius of the curve counts, too.
  double per_turn = 0;
  /// In place of it, of each face and curve; empty: none; 0 in them: as `per_turn`; kNoTurns: no curvature.
  static constexpr double kNoTurns = -1;
  std::vector<double> face_per_turn = {}, curve_per_turn = {};
  double min = 0;  ///< least size that curvature asks for; 0: a twentieth of the base
  /// The most |grad delta| along the surface; 0: no limit, and then no curvature either, whose sizes jump
  /// between faces.
  double gradation = 0;
  /// For each curve (index into Mesh::curves), the largest size on it; empty: as the base.
  std::vector<double> curve_limit;
  std::vector<SizeBall> spots = {};
  /// Edges of curves should turn by no more, in radians; 0: by any angle. It changes no size inside of faces.
  double edge_turn = 0;
  /// By which everything is measured in place of lengths in space; null: none. The base is 1 then, and all.
  std::shared_ptr<const SurfaceMetric> metric = nullptr;

  /// Returns the size without the limit of gradation.
  double in_face(int face, const Vec3& x) const;
  double on_curve(int curve, const Vec3& x) const;
  /// Returns whether it is more than a function of space.
  bool depends_on_surface() const { return gradation > 0; }

 private:
  double of(const std::vector<double>& own, int entity) const;
  double at_most_by_spots(double size, const Vec3& x) const;
};

/// Sizes on a model's fine triangulation: the base, and where sizes follow curvature or have a limit of
/// gradation, values at the fine points. These are linear on triangles and lines. The limit uses the distance
/// along the surface, found by fast marching [sethian1996], so that sheets close in space do not mix.
class SurfaceSize final : public SizeField {
 public:
  explicit SurfaceSize(std::shared_ptr<const SizeField> base);
  /// The fine triangulation should have been refined for it: see refine_for_size().
  SurfaceSize(const SurfaceModel& model, const WantedSize& wanted);

  /// Returns the size at the point x with these weights of points of the fine triangulation it was made from.
  /// This is what meshing uses.
  double on_fine(std::span<const int> nodes, std::span<const double> weights, const Vec3& x, int& hint) const;
  /// Returns the same along a line, in space.
  double along_line(int a, int b, double t, const Vec3& x, int& hint) const;
  /// Returns how many quads a fine triangle is.
  double quads_in(const Mesh& fine, int triangle, int& hint) const;
  /// Returns the size at the point of the surface nearest to x, in space, for measuring meshes.
  double at(const Vec3& x, int& hint) const override;
  double edge_turn() const { return edge_turn_; }
  bool has_metric() const { return metric_ != nullptr; }
  /// Returns the size by which maps are measured: `at`, or 1 if there is a metric.
  const SizeField& on_maps() const { return metric_ ? *base_ : static_cast<const SizeField&>(*this); }

 private:
  std::shared_ptr<const SizeField> base_;
  double edge_turn_ = 0;
  std::shared_ptr<const SurfaceMetric> metric_;
  std::map<std::pair<int, int>, double> line_stretch_;  ///< of a metric, by ends
  std::vector<double> delta_;                           ///< of each fine point; empty: the base is all
  std::optional<NearestTriangle> triangles_;            ///< where sizes are less than the base
};

/// Returns the largest size on each curve of a model that keeps edges beside short curves in proportion. If a
/// curve is shorter than the size, edges beside it are at most a few times as long as its own. Sizes do not
/// fall below a part of the base. Empty if nothing is limited, and for a base that varies, since it states
/// its own sizes.
std::vector<double> sizes_beside_short_curves(const Mesh& fine, const SizeField& base);

/// Refines the fine triangulation until sizes that are linear on it are within 25 % of the true sizes. It
/// stops where sides are as short as the size. Does nothing for sizes that are a function of space.
void refine_for_size(SurfaceModel& model, const WantedSize& wanted);

/// Lowers values at the points of a fine triangulation until none is more than `slope` times the distance
/// along the surface above another one.
void limit_slope(const Mesh& fine, double slope, std::vector<double>& values);

}  // namespace delquad
