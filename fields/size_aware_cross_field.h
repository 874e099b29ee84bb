#pragma once

#include <memory>
#include <vector>

#include "delquad/fields.h"
#include "fields/background_mesh.h"
#include "fields/fields.h"

namespace delquad {

/// Cross field for which grids of size delta' exist locally, wherever it is smooth: close to parallel in the
/// metric |du|^2/delta'^2, boundary-aligned. The harmonic field knows nothing of delta, so that where delta
/// varies rows of quads have to end inside the mesh.
///
/// Minimises the energy of the covariant derivative of exp(4 i theta) by diffusion and normalisation in turn,
/// over times that fall from many to a few elements, so that the singularities find their places; unknowns on
/// edges as in HarmonicCrossField, transport within each triangle by SizeConnection.
class SizeAwareCrossField final : public SolvedCrossField {
 public:
  /// `background`: one patch; its elements must be small against the length over which delta' varies.
  /// `start`: what the iteration starts from and what the field is, exactly, where delta' hardly varies: by
  /// too little over the whole patch for a single row of quads to end.
  SizeAwareCrossField(std::shared_ptr<const BackgroundMesh> background, const ParametricSize& size,
                      std::shared_ptr<const CrossField> start);
  ~SizeAwareCrossField() override;
  /// Of about unit length, but zero at singularities.
  Cross at(Vec2 u, int& hint) const override;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Number of places where a row of quads of size delta' along the field has to end, in the mean: the integral
/// of (|v . e1| + |v . e2|)/delta', v = grad theta - J grad log delta', over the background mesh, which must
/// resolve both.
double expected_dislocations(const BackgroundMesh& background, const CrossField& cross,
                             const ParametricSize& size);

}  // namespace delquad
