// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "algorithms/fields/background_mesh.h"
#include "algorithms/fields/fields.h"
#include "delquad/fields.h"

// This header makes cross fields that know the size. Features and fields use it.

namespace delquad {

/// A cross that a field is drawn to.
struct CrossPull {
  Cross cross;
  double strength;  ///< weight >= 0 of the squared difference, for the area of a quad
};
using CrossPullAt = std::function<CrossPull(Vec2 u, int& hint)>;

/// A patch of a surface, for a field on all patches.
struct FieldPatch {
  /// The background mesh of this patch alone. Its elements must be small against the length over which delta'
  /// varies.
  std::shared_ptr<const BackgroundMesh> background;
  const ParametricSize* size;
  std::shared_ptr<const CrossField> start;  ///< start of the iteration
  CrossPullAt pull = nullptr;               ///< null: no pull
};

/// A side of the boundaries of two patches, or at two places of one patch. The surface and the field are
/// smooth across it: crosses turn with the side.
struct FieldSeam {
  struct Side {
    int patch, triangle, opposite;  ///< the side opposite to this vertex (0 to 2) of the triangle
  };
  std::array<Side, 2> sides;  ///< sides in opposite directions
  double alignment;  ///< strength by which the side draws the field to its direction, see CrossDiffusion
};

/// Cross field (own) that is close to parallel in the metric |du|^2/delta'^2 and aligned to the boundary. So
/// grids of size delta' exist locally, wherever it is smooth. The harmonic field knows nothing of delta, so
/// rows of quads must end inside where delta varies.
///
/// Minimizes the energy of the covariant derivative of exp(4 i theta) by diffusion and normalization in turn.
/// The times fall from many to a few elements, so that the singularities find their places. Unknowns are on
/// edges as in HarmonicCrossField, and SizeConnection is the transport within each triangle. The stretch of
/// the patch's map is in delta', so the metric is the metric of the surface over delta^2, whatever the map.
/// The field of several patches is therefore one on the surface; [remacle2013, section 5] has a field on each
/// patch.
class SizeAwareCrossField final : public SolvedCrossField {
 public:
  /// Makes the field on one patch. If delta' varies too little for a single row of quads to end, the field is
  /// the start.
  SizeAwareCrossField(std::shared_ptr<const BackgroundMesh> background, const ParametricSize& size,
                      std::shared_ptr<const CrossField> start);
  /// Returns a cross of about unit length, but zero at singularities.
  Cross at(Vec2 u, int& hint) const override;

 private:
  struct Data;
  friend std::vector<std::shared_ptr<const SizeAwareCrossField>> make_size_aware_fields(
      const std::vector<FieldPatch>& patches, const std::vector<FieldSeam>& seams);
  explicit SizeAwareCrossField(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

  std::shared_ptr<const Data> data_;
};

/// Returns the field on each of the patches that seams join. Each has the sum of indices and the Euler
/// characteristic of the whole. Singularities are listed where they are inside of a patch.
std::vector<std::shared_ptr<const SizeAwareCrossField>> make_size_aware_fields(
    const std::vector<FieldPatch>& patches, const std::vector<FieldSeam>& seams);

/// Returns the expected number of places where a row of quads of size delta' along the field must end. It is
/// the integral of (|v . e1| + |v . e2|)/delta', v = grad theta - J grad log delta'. The background mesh must
/// resolve both fields.
double expected_dislocations(const BackgroundMesh& background, const CrossField& cross,
                             const ParametricSize& size);

}  // namespace delquad
