// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "delquad/fields.h"
#include "geometry/planar/planar_model.h"

// This header makes sizes small at places. Sizes by name, by curvature and for repairs use it.

namespace delquad {

/// Where nothing else is said, sizes grow by so much per unit length.
inline constexpr double kSpotGradation = 0.3;

/// Around a segment or a triangle, up to `reach`, sizes are at most `size`; from there on they grow.
struct LocalSize {
  Vec3 a, b;
  double size, reach;
  double growth = kSpotGradation;
  std::optional<Vec3> c = {};  ///< of a triangle
};

/// Returns the field, and less around the spots.
std::shared_ptr<const SizeField> finer_near(std::shared_ptr<const SizeField> base,
                                            std::vector<LocalSize> spots);

/// Returns the field, and near the spots their sizes, larger ones too. Where spots disagree the smaller ones
/// count.
std::shared_ptr<const SizeField> as_near(std::shared_ptr<const SizeField> base,
                                         const std::vector<LocalSize>& spots);

/// Returns the edges that are much shorter than the size, because the curves between two nodes are. Each is a
/// spot of its own length, times `aspect`. Only of domains with junctions.
std::vector<LocalSize> short_edges(const PlanarDomain& domain, const SizeField& size, double aspect = 1);

}  // namespace delquad
