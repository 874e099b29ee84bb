// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "algorithms/fields/background_mesh.h"
#include "algorithms/fields/size_aware_cross_field.h"
#include "base/box_tree.h"
#include "delquad/fields.h"
#include "delquad/mesher.h"
#include "features/metric/metric_mesh.h"
#include "features/seed/perturb.h"
#include "metrics/anisotropic_measures.h"

// This header maps a plane with a metric to a plane with sizes. A plane with a metric is a surface, and
// conformally flat. The domain is laid into a plane in which the metric is the square of a scalar times the
// identity. It is meshed there as any other. Values near 1 there are near 1 in the metric: lengths over the
// size, and all measures of shapes.

namespace delquad {

/// How a domain and its flat image hang together: one triangulation in both.
struct MetricPlane {
  BackgroundMesh flat, plane;
  std::vector<Tensor2> metric;  ///< at the vertices, as the mesh follows it
  std::vector<double> size;     ///< the lengths of 1 there, in the flat plane
  struct Segment {
    std::shared_ptr<const Curve> shape;
    std::array<double, 2> t;
    std::array<int, 2> vertices;
  };
  std::vector<Segment> segments;                                    ///< of all curves
  BoxTree<Vec2> segment_tree;                                       ///< of their flat images
  Rotation turn;                                                    ///< of what is meshed, against `flat`
  std::map<const Curve*, std::shared_ptr<const Curve>> true_curve;  ///< of each of the flat model
  FlatQuality quality;                                              ///< of the worst part

  /// Returns the place of the domain that lies at a place of the turned flat one, which may be a little
  /// outside.
  Vec2 to_plane(Vec2 u, int& hint) const;
  /// Returns the same of a node on a curve, on the true one.
  Vec2 curve_to_plane(Vec2 u) const;
  /// Returns the other way round.
  Vec2 to_flat(Vec2 x, int& hint) const;
  Vec3 to_plane(const Vec3& u) const;
  Vec3 to_flat(const Vec3& x) const;
  Tensor2 metric_at(Vec2 x, int& hint) const;
  /// Returns by which factor a size of the turned flat plane is larger than the metric's own.
  double scale_of(const SizeField& other) const;
  /// Returns how much a field of the turned flat plane is drawn to the metric's axes.
  CrossPull pull_at(Vec2 u, int& hint) const;
};

/// Returns the problem in the flat plane of its metric, which is its size then. Where the metric has no
/// directions, it is a size. Throws InputError for a metric that cannot be followed, see resolve_metric(),
/// and for a domain that cannot be laid flat in one piece. So it does for settings that do not go with a
/// metric.
MeshProblem in_metric_plane(MeshProblem problem, std::vector<Warning>& warnings);

/// Refuses numbers out of range and what does not go with a metric, in an InputError.
void check_metric(const MeshProblem& problem);

/// Returns the pull to an axis of a metric that has this direction in a flat plane.
CrossPull pull_to(Vec2 along, const MetricAxes& axes);

/// Returns the true curves behind the curves of the flat model; a curve that was made of several has none.
std::vector<std::vector<std::shared_ptr<const Curve>>> true_curves(
    const MetricPlane& plane, std::vector<std::vector<std::shared_ptr<const Curve>>> flat);

/// Brings a mesh of the flat plane to the domain's own, its nodes on lines to the true curves.
void to_plane(const MetricPlane& plane, Mesh& mesh);

/// Returns the number of quads of a mesh of the domain whose eta is below kBadEta in the metric, with a
/// warning.
int count_bad_quads(const MetricAt& metric, const std::string& label, const Mesh& mesh,
                    std::vector<Warning>& warnings);

}  // namespace delquad
