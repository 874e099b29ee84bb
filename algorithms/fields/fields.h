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

/// Returns the smallest of the base (may be null if there is a source) and all sources. Throws InputError for
/// sizes, radii or points out of range, or without any size.
std::unique_ptr<SizeField> make_source_size(std::shared_ptr<const SizeField> base,
                                            std::vector<SizeSource> sources);

/// Returns the base, but nowhere more than the length `most`. Throws InputError unless `most` is finite and
/// positive.
std::unique_ptr<SizeField> make_capped_size(std::shared_ptr<const SizeField> base, double most);

/// Returns the mean edge lengths at boundary nodes, with logarithms extended harmonically over the background
/// mesh. Throws InputError for a node without a length.
std::unique_ptr<SizeField> make_boundary_size(std::shared_ptr<const BackgroundMesh> background,
                                              const Mesh& boundary);

/// Returns the base with |grad delta| <= slope: delta(x) = min over y of base(y) + slope |x - y|. The sample
/// points y, at most a million, resolve the base to a factor of 1.1. Throws InputError unless slope > 0.
std::unique_ptr<SizeField> limit_gradation(std::shared_ptr<const SizeField> base,
                                           std::shared_ptr<const BackgroundMesh> background, double slope);

// --- cross fields
// ------------------------------------------------------------------------------------------------

/// A singular point of a cross field; index in quarters (+1: valence 3 in a quad mesh, -1: valence 5).
struct Singularity {
  Vec2 at;
  int index;
};

/// Topology of a cross field that is known at the middles of a background mesh's sides.
struct FieldTopology {
  /// Singularities inside of the domain, without neighboring opposite pairs, which are noise.
  std::vector<Singularity> singularities;
  /// Sum of all indices, inside and at corners of the boundary, in quarters; 4 chi if the field is aligned.
  int index_sum = 0;
  /// Euler characteristic of the domain (triangles - edges + vertices of the background mesh).
  int euler_characteristic = 0;
};

/// A cross field computed on a background mesh.
class SolvedCrossField : public CrossField {
 public:
  const std::vector<Singularity>& singularities() const { return topology_.singularities; }
  int index_sum() const { return topology_.index_sum; }
  int euler_characteristic() const { return topology_.euler_characteristic; }

 protected:
  FieldTopology topology_;
};

/// Cross field of [remacle2013, section 3, equation (3)]: cos 4 theta and sin 4 theta harmonic,
/// boundary-aligned. The unknowns are on edges (Crouzeix-Raviart), so that corners of any angle carry none.
class HarmonicCrossField final : public SolvedCrossField {
 public:
  /// Throws Error if rounding makes the matrix singular.
  explicit HarmonicCrossField(std::shared_ptr<const BackgroundMesh> background);
  ~HarmonicCrossField() override;
  /// Returns the cross, zero at singularities and small far from the boundary: only its angle means anything.
  Cross at(Vec2 u, int& hint) const override;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Returns a field with theta = direction of grad delta, by central differences. `step` is a length such as
/// 1e-6 of the domain's diagonal. Throws InputError unless it is positive.
std::unique_ptr<CrossField> make_gradient_cross(std::shared_ptr<const SizeField> size, double step);

/// Returns the integral of dA/delta^2 over a triangulation: the expected number of quads. `relative_error` is
/// the aim of the adaptive quadrature [own, with rules of Dunavant 1985]. Samples are at most `coarsest` of
/// the diagonal apart, so smaller features may be missed.
double expected_quads(const TriPatch& triangulation, const SizeField& size, double relative_error = 0.01,
                      double coarsest = 1.0 / 64);

/// Returns the least size that curvature may ask for if the size is else `base`: `min`, or a part of the base
/// if `min` is 0.
double least_by_curvature(double base, double min);
/// Returns the size for `per_turn` elements on a full turn of curvature k (1/length): 2 pi / (k per_turn),
/// between least_by_curvature() and the base. It is the base if k or `per_turn` is not positive.
double size_by_curvature(double base, double k, double per_turn, double min);

/// Returns whether the size follows curvature overall or on named parts.
bool follows_curvature(const SizeSpec& size);

}  // namespace delquad
