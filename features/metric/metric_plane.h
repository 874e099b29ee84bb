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
// conformally flat. So the domain is mapped to a plane in which the metric is a squared scalar times the
// identity, and meshed there like any other. Lengths over the size and shapes are about the same in both.

namespace delquad {

/// A domain and its flat image, as one triangulation with two places for each vertex.
struct MetricPlane {
  BackgroundMesh flat, plane;
  std::vector<Tensor2> metric;  ///< followed metric at the vertices
  std::vector<double> size;     ///< length in the flat plane of a unit length of the metric there
  struct Segment {
    std::shared_ptr<const Curve> shape;
    std::array<double, 2> t;
    std::array<int, 2> vertices;
  };
  std::vector<Segment> segments;  ///< segments of all curves
  BoxTree<Vec2> segment_tree;     ///< boxes of their flat images
  Rotation turn;                  ///< turn of the meshed plane against `flat`
  std::map<const Curve*, std::shared_ptr<const Curve>>
      true_curve;       ///< true curve of each curve of the flat model
  FlatQuality quality;  ///< distortion of the worst part

  /// Returns the place of the domain for a place of the turned flat plane, which may lie slightly outside.
  Vec2 to_plane(Vec2 u, int& hint) const;
  /// Returns the same for a node on a curve, on the true curve.
  Vec2 curve_to_plane(Vec2 u) const;
  /// Returns the place of the turned flat plane for a place of the domain.
  Vec2 to_flat(Vec2 x, int& hint) const;
  Vec3 to_plane(const Vec3& u) const;
  Vec3 to_flat(const Vec3& x) const;
  /// Returns the metric at a place of the domain, without its scale.
  Tensor2 metric_at(Vec2 x, int& hint) const;
  /// Returns the factor between a size of the turned flat plane and the size of the metric.
  double scale_of(const SizeField& other) const;
  /// Returns the pull of a field of the turned flat plane to the axes of the metric.
  CrossPull pull_at(Vec2 u, int& hint) const;
};

/// Returns the problem in the flat plane of its metric, in which the metric is a size. A metric without
/// directions becomes a size. Throws InputError for a metric that cannot be followed, see resolve_metric(),
/// and for a domain that cannot be flattened in one piece. Own method; maps are conformal [sawhney2017;
/// mullen2008].
MeshProblem in_metric_plane(MeshProblem problem, std::vector<Warning>& warnings);

/// Throws InputError for numbers out of range, and for settings that do not go with a metric.
void check_metric(const MeshProblem& problem);

/// Returns the pull to an axis of a metric that has the direction `along` in a flat plane; its strength grows
/// with log^2(h2 / h1). Own method.
CrossPull pull_to(Vec2 along, const MetricAxes& axes);

/// Returns the true curves behind the curves of the flat model; a curve made of several has none.
std::vector<std::vector<std::shared_ptr<const Curve>>> true_curves(
    const MetricPlane& plane, std::vector<std::vector<std::shared_ptr<const Curve>>> flat);

/// Moves a mesh from the flat plane to the domain, and its nodes on lines to the true curves.
void to_plane(const MetricPlane& plane, Mesh& mesh);

/// Returns the number of quads whose eta is below kBadEta in the metric, and adds a warning if there are any.
int count_bad_quads(const MetricAt& metric, const std::string& label, const Mesh& mesh,
                    std::vector<Warning>& warnings);

}  // namespace delquad
