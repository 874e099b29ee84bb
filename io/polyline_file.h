#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Points of a line: "points.txt" has x, y and z of one on each line, and comments behind '#'; of a mesh file
/// it is the chain of its lines, or of those on the curves of a name ("mesh.msh:NAME"), from the end that is
/// nearer to a point. Throws InputError with file and line, and for lines that make no single open chain.
std::vector<Vec3> read_polyline(const std::string& text, const Vec3& start_near);

}  // namespace delquad
