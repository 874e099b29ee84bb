#pragma once

#include "features/extrusion/section.h"

namespace delquad {

/// Throws InputError with the place where a quad touches or crosses the line through a point.
void require_beside_axis(const Section& section, const Vec3& point, const Vec3& axis);

}  // namespace delquad
