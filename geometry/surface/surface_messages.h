#pragma once

#include <string>
#include <string_view>

#include "delquad/mesh.h"

/// Parts of messages about surfaces.
namespace delquad {

/// "(x, y, z)"
std::string show_point(const Vec3& p);
/// "1 triangle", "2 triangles"
std::string counted(long long n, std::string_view what);

}  // namespace delquad
