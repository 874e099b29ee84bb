// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "algorithms/fields/surface/surface_size.h"
#include "features/sizes/named_parts.h"
#include "geometry/patches/meshing_setup.h"
#include "geometry/planar/planar_model.h"

// This header warns of sizes without effect and of coarse curves. The preparation uses it.

namespace delquad {

/// Curves with fewer edges per full turn get a warning. A hole of six edges has lost 17 % of its area, a hole
/// of twelve 5 %.
inline constexpr double kFewPerTurn = 12;

/// Warns of each size by name that is everywhere larger than the size there: smaller sizes win.
void warn_of_ineffective_sizes(const std::vector<NamedSize>& named, const NamedParts& parts,
                               const SizeField& size, std::vector<Warning>& warnings);

/// Warns if the size is larger than the model at all of its points.
void warn_of_large_size(const SizeField& size, const Mesh& model, std::vector<Warning>& warnings);

/// Warns of curves with few edges per full turn, with their number and a remedy.
void warn_of_coarse_turns(const PlanarModel& model, const PlanarDomain& domain, const SizeSpec& spec,
                          const SizeField& asked, std::vector<Warning>& warnings);

/// Does the same for the curves and faces of a CAD model.
void warn_of_coarse_turns(const WantedSize& wanted, const SurfaceSetup& surface,
                          std::vector<Warning>& warnings);

/// Warns of the narrowest gap outside of all regions, between curves that do not meet. It counts if it is
/// narrower than a hundredth of the edges there: such regions should probably touch.
void warn_of_gaps(const PlanarDomain& domain, std::vector<Warning>& warnings);

}  // namespace delquad
