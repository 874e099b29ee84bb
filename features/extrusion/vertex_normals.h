#pragma once

#include <vector>

#include "features/extrusion/section.h"

namespace delquad {

/// For each point the way that it goes while all quads around move along their normals by 1: m with m . n = 1
/// for each normal n, solved exactly for up to two of them, else by least squares, in which directions that
/// hardly any normal has count as none. Throws InputError with the place where quads fold back on each other,
/// and where quads touch in a point only.
std::vector<Vec3> offset_directions(const Section& section);

}  // namespace delquad
