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

/// A ball of radius `reach` in space, in which sizes are at most `size`; both are lengths.
struct SizeBall {
  Vec3 at;
  double reach = 0, size = 0;
};

/// The demands on sizes on a surface.
struct WantedSize {
  std::shared_ptr<const SizeField> base;            ///< in space; the largest size anywhere
  std::shared_ptr<const ModelCurvature> curvature;  ///< null: sizes do not follow curvature
  /// Elements of a full turn, > 0 if there is `curvature`. Then delta = 2 pi r / per_turn, with the smallest
  /// radius of curvature r of the face, or also of the curve on curves.
  double per_turn = 0;
  /// Own values of each face and curve; empty: none. A value of 0 stands for `per_turn`, kNoTurns for no
  /// curvature.
  static constexpr double kNoTurns = -1;
  std::vector<double> face_per_turn = {}, curve_per_turn = {};
  double min = 0;  ///< least size that curvature asks for; 0: a twentieth of the base
  /// Limit of |grad delta| along the surface. 0: no limit, and no curvature, whose sizes jump between faces.
  double gradation = 0;
  /// For each curve (index into Mesh::curves), the largest size on it; empty: as the base.
  std::vector<double> curve_limit;
  std::vector<SizeBall> spots = {};
  /// Largest turn of an edge along a curve, radians; 0: any. It changes no size inside of faces.
  double edge_turn = 0;
  /// Metric in place of lengths in space; null: none. With a metric, the size is 1 everywhere.
  std::shared_ptr<const SurfaceMetric> metric = nullptr;

  /// Returns the size without the limit of gradation.
  double in_face(int face, const Vec3& x) const;
  double on_curve(int curve, const Vec3& x) const;
  /// Returns whether sizes depend on the surface, beyond the place in space.
  bool depends_on_surface() const { return gradation > 0; }

 private:
  double of(const std::vector<double>& own, int entity) const;
  double at_most_by_spots(double size, const Vec3& x) const;
};

/// Sizes on a model's fine triangulation. They are the base or, with curvature or a limit of gradation,
/// linear on triangles and lines between values at fine points. The limit uses the distance along the
/// surface, found by fast marching [sethian1996], so that sheets close in space do not mix.
class SurfaceSize final : public SizeField {
 public:
  explicit SurfaceSize(std::shared_ptr<const SizeField> base);
  /// Takes a fine triangulation that refine_for_size() refined.
  SurfaceSize(const SurfaceModel& model, const WantedSize& wanted);

  /// Returns the size at the point x with these weights, of sum 1, of fine points. Meshing uses it.
  double on_fine(std::span<const int> nodes, std::span<const double> weights, const Vec3& x, int& hint) const;
  /// Returns the size at x = (1 - t) a + t b on a line between fine points; with a metric, a length in space.
  double along_line(int a, int b, double t, const Vec3& x, int& hint) const;
  /// Returns the expected number of quads in a fine triangle.
  double quads_in(const Mesh& fine, int triangle, int& hint) const;
  /// Returns the size at the point of the surface nearest to x, up to a tenth of the base away; else the
  /// base. Measures of meshes use it.
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

/// Returns the largest size on each curve that keeps edges beside short curves in proportion (own rule).
/// Edges beside a curve shorter than the size are at most four times as long as its own, but at least 1/50 of
/// the base. Empty if nothing is limited, or if the base varies.
std::vector<double> sizes_beside_short_curves(const Mesh& fine, const SizeField& base);

/// Refines the fine triangulation until sizes that are linear on it are within 25 % of the true sizes, or
/// sides as short as the size. Does nothing for sizes that are a function of space.
void refine_for_size(SurfaceModel& model, const WantedSize& wanted);

/// Lowers values at fine points until none exceeds another one by more than `slope` > 0 times the distance
/// along the surface, by fast marching [sethian1996].
void limit_slope(const Mesh& fine, double slope, std::vector<double>& values);

}  // namespace delquad
