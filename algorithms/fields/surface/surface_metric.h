// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "algorithms/fields/surface/surface_size.h"
#include "algorithms/fields/tangent_metric.h"
#include "delquad/fields.h"
#include "geometry/mesh/nearest_triangle.h"
#include "geometry/surface/model_curvature.h"
#include "geometry/surface/surface_model.h"

// This header has metrics on surfaces. Features and fields use it.

namespace delquad {

/// A requested metric on a surface.
struct WantedMetric {
  MetricSpec spec;
  std::shared_ptr<const ModelCurvature> curvature;  ///< curvature of the model as it was read
  std::vector<SizeBall> spots = {};                 ///< balls in which lengths are at most their sizes
};

/// Metrics in the tangent planes of a model's faces. Each point of the fine triangulation has one for each
/// face there, with linear logarithms between points [arsigny2006]. They keep their limits and are graded
/// along each face [alauzet2010]. All faces beside a curve agree on its lengths.
class SurfaceMetric final : public SizeField {
 public:
  /// Throws InputError, with place and tensor, for values that are no metric.
  SurfaceMetric(const SurfaceModel& model, const WantedMetric& wanted);

  /// Returns the metric at the point of a face nearest to x.
  TangentMetric in_face(int face, const Vec3& x) const;
  /// Returns the metric at a point of the fine triangulation, or at a point that a cut added.
  TangentMetric at_node(const Mesh& fine, int face, int node) const;
  /// Returns the length, in the metric, of a side of a triangle of the face.
  double length(const Mesh& fine, int face, int a, int b) const;
  /// Returns the area of a triangle in the metric.
  double area(const Mesh& fine, int triangle) const;
  /// Returns the length of each line in the metric over its length in space, the largest over its faces. Keys
  /// are its ends, the lower first.
  std::map<std::pair<int, int>, double> stretches_of_lines(const Mesh& fine) const;
  /// Returns the geometric mean of both wanted lengths, in space, at the surface's point nearest to x.
  double at(const Vec3& x, int& hint) const override;

 private:
  friend class MetricRule;
  friend std::shared_ptr<const SurfaceMetric> refine_for_metric(SurfaceModel&, const WantedMetric&);
  struct Site {
    int face, node;
    TangentMetric given, metric;
  };
  struct Piece {
    NearestTriangle triangles;
    std::vector<int> sites;  ///< of its points
  };

  const Site* find(int face, int node) const;
  int add(int face, int node, const Vec3& x, const Vec3& normal);
  Tensor2 given_at(int face, const Vec3& x, const TangentMetric& frame) const;
  Tensor2 within_limits(const Tensor2& given, const Vec3& x) const;
  double length_for(double curvature) const;
  bool compose(const SurfaceModel& model);
  void follow_curves(const SurfaceModel& model, std::vector<char>& is_less);
  void grade(const Mesh& fine, std::vector<char> is_new);
  void make_pieces(const Mesh& fine);
  bool shorten_along(Site& site, const Vec3& direction, double most) const;

  WantedMetric wanted_;
  double scale_ = 1;       ///< factor of lengths that gives the wanted complexity
  double complexity_ = 0;  ///< of the metric as composed; 0: not known
  std::vector<Site> sites_;
  std::vector<std::vector<int>> sites_at_;  ///< of each fine point
  std::vector<std::optional<Piece>> pieces_;
  std::optional<NearestTriangle> all_;
  std::vector<int> face_of_;  ///< of the triangles of `all_`
};

/// Refines the fine triangulation until its sides are short in the metric, or the metric hardly changes along
/// them. Then flips sides until it is Delaunay in the metric (own method). Returns the metric there. Throws
/// InputError, with place and tensor, for values that are no metric.
std::shared_ptr<const SurfaceMetric> refine_for_metric(SurfaceModel& model, const WantedMetric& wanted);

}  // namespace delquad
