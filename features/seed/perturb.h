// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "delquad/fields.h"
#include "geometry/planar/planar_model.h"

// This header changes a domain a little by a seed. The preparation uses it.

namespace delquad {

/// Small changes of a domain by a seed. The change of the mesh shows which differences between pipelines mean
/// something.

/// Returns the size times 1 +- 3 %, smooth over distances of about a tenth of `diagonal` (a length), so that
/// curves get nodes at other places. Own method.
std::shared_ptr<const SizeField> jittered(std::shared_ptr<const SizeField> size, long long seed,
                                          double diagonal);

/// A turn of the plane about the origin.
struct Rotation {
  double c = 1, s = 0;
  static Rotation by_seed(long long seed);  ///< by any angle
  Vec2 operator()(Vec2 p) const { return {c * p.x - s * p.y, s * p.x + c * p.y}; }
  Vec2 back(Vec2 p) const { return {c * p.x + s * p.y, c * p.y - s * p.x}; }
};

/// Turns the domain with its curves.
void rotate(const Rotation& rotation, PlanarDomain& domain);
/// Returns the field, turned with the domain.
std::shared_ptr<const SizeField> rotated(std::shared_ptr<const SizeField> size, const Rotation& rotation);
std::shared_ptr<const CrossField> rotated(std::shared_ptr<const CrossField> cross, const Rotation& rotation);

}  // namespace delquad
