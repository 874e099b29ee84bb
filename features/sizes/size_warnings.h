// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "algorithms/fields/surface/surface_size.h"
#include "features/sizes/named_parts.h"
#include "geometry/patches/meshing_setup.h"
#include "geometry/planar/planar_model.h"

// This header warns of sizes without effect and of coarse curves. The preparation uses it.

namespace delquad {

/// Fewer edges than this to a full turn of a circle or fillet get a warning. A hole of six edges has lost 17
/// % of its area, one of twelve 5 %.
inline constexpr double kFewPerTurn = 12;

/// Tells of each size that was asked for by name and is larger than the size at all of that: smaller ones
/// win.
void warn_of_ineffective_sizes(const std::vector<NamedSize>& named, const NamedParts& parts,
                               const SizeField& size, std::vector<Warning>& warnings);

/// Says so when the size is larger than the model at all of its points.
void warn_of_large_size(const SizeField& size, const Mesh& model, std::vector<Warning>& warnings);

/// Tells in one line how many curves of the model got few edges to a full turn, and what would help.
void warn_of_coarse_turns(const PlanarModel& model, const PlanarDomain& domain, const SizeSpec& spec,
                          const SizeField& asked, std::vector<Warning>& warnings);

/// Does the same for the curves and faces of a CAD model.
void warn_of_coarse_turns(const WantedSize& wanted, const SurfaceSetup& surface,
                          std::vector<Warning>& warnings);

/// Tells of the narrowest gap outside of all regions, between curves that do not meet. It counts if it is
/// narrower than a hundredth of the edges there: regions that were meant to lie side by side.
void warn_of_gaps(const PlanarDomain& domain, std::vector<Warning>& warnings);

}  // namespace delquad
