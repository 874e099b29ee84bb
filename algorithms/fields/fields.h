// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "algorithms/fields/background_mesh.h"
#include "delquad/fields.h"
#include "delquad/mesh.h"

// This header has sizes and cross fields of simple kinds. Most modules use it.

namespace delquad {

// --- size fields
// -------------------------------------------------------------------------------------------------

/// Returns the smallest of the base (may be null when there is a source) and all sources.
std::unique_ptr<SizeField> make_source_size(std::shared_ptr<const SizeField> base,
                                            std::vector<SizeSource> sources);

/// Returns the base, but nowhere more than `most`.
std::unique_ptr<SizeField> make_capped_size(std::shared_ptr<const SizeField> base, double most);

/// Returns the boundary's own edge lengths, extended smoothly into the domain over the background mesh.
std::unique_ptr<SizeField> make_boundary_size(std::shared_ptr<const BackgroundMesh> background,
                                              const Mesh& boundary);

/// Returns the base made no steeper than |grad delta| <= slope: delta(x) = min over y of base(y) + slope |x -
/// y|. The sample points y are dense enough to see the base, and x itself is one.
std::unique_ptr<SizeField> limit_gradation(std::shared_ptr<const SizeField> base,
                                           std::shared_ptr<const BackgroundMesh> background, double slope);

// --- cross fields
// ------------------------------------------------------------------------------------------------

/// A singular point of a cross field; index in quarters (+1: valence 3 in a quad mesh, -1: valence 5).
struct Singularity {
  Vec2 at;
  int index;
};

/// The turning of a cross field known at the middles of a background mesh's sides.
struct FieldTopology {
  /// Inside the domain; neighboring opposite pairs, which are noise, left out.
  std::vector<Singularity> singularities;
  /// Sum of all indices, interior and at the boundary's corners, in quarters; equals 4 chi of the domain.
  int index_sum = 0;
  /// Euler characteristic of the domain (triangles - edges + vertices of the background mesh).
  int euler_characteristic = 0;
};

/// A cross field that has been solved for over a background mesh.
class SolvedCrossField : public CrossField {
 public:
  const std::vector<Singularity>& singularities() const { return topology_.singularities; }
  int index_sum() const { return topology_.index_sum; }
  int euler_characteristic() const { return topology_.euler_characteristic; }

 protected:
  FieldTopology topology_;
};

/// Cross field of the paper [section 3, equation (3)]: cos 4 theta and sin 4 theta harmonic,
/// boundary-aligned. The unknowns are on edges (Crouzeix-Raviart), so that corners of any angle carry none.
class HarmonicCrossField final : public SolvedCrossField {
 public:
  explicit HarmonicCrossField(std::shared_ptr<const BackgroundMesh> background);
  ~HarmonicCrossField() override;
  /// Returns the cross, zero at singularities and small far from the boundary: only its angle means anything.
  Cross at(Vec2 u, int& hint) const override;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Makes a field with theta = direction of grad delta, by central differences over `step` (a length; e.g.
/// 1e-6 of the domain's diagonal).
std::unique_ptr<CrossField> make_gradient_cross(std::shared_ptr<const SizeField> size, double step);

/// Returns the integral of dA/delta^2 over a triangulation: the expected number of quads. `relative_error` is
/// what the adaptive quadrature aims at. The domain is seen at `coarsest` of its diagonal at least; what is
/// smaller and appears in no sample is missed.
double expected_quads(const TriPatch& triangulation, const SizeField& size, double relative_error = 0.01,
                      double coarsest = 1.0 / 64);

/// Returns the least size that curvature may ask for if the size is else `base`: `min`, or a part of the base
/// if `min` is 0.
double least_by_curvature(double base, double min);
/// Returns the base, or less where it takes that to make `per_turn` elements of a full turn with the
/// curvature k (1/length); 0: as the base.
double size_by_curvature(double base, double k, double per_turn, double min);

/// Returns whether curvature is asked for overall or by name.
bool follows_curvature(const SizeSpec& size);

}  // namespace delquad
