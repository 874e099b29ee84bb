// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "delquad/fields.h"
#include "geometry/planar/planar_model.h"

// This header makes sizes small at places. Sizes by name, by curvature and for repairs use it.

namespace delquad {

/// Default growth of sizes per unit length.
inline constexpr double kSpotGradation = 0.3;

/// A segment or triangle around which sizes are at most `size` up to the distance `reach`, and grow beyond.
struct LocalSize {
  Vec3 a, b;
  double size, reach;
  double growth = kSpotGradation;
  std::optional<Vec3> c = {};  ///< third corner of a triangle
};

/// Returns the smaller of the field and the sizes of the spots.
std::shared_ptr<const SizeField> finer_near(std::shared_ptr<const SizeField> base,
                                            std::vector<LocalSize> spots);

/// Returns the field, and near the spots their sizes, also if these are larger. The smallest spot wins.
std::shared_ptr<const SizeField> as_near(std::shared_ptr<const SizeField> base,
                                         const std::vector<LocalSize>& spots);

/// Returns edges shorter than 0.6 sizes, because the curves between two nodes are. Each is a spot of its own
/// length times `aspect`. Domains without junctions have none. Own method.
std::vector<LocalSize> short_edges(const PlanarDomain& domain, const SizeField& size, double aspect = 1);

}  // namespace delquad
