#pragma once

#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Three unit vectors at right angles.
struct Frame {
  Vec3 tangent, first, second;
  /// A vector's parts along them, and the vector of such parts.
  Vec3 parts(const Vec3& v) const { return {dot(v, tangent), dot(v, first), dot(v, second)}; }
  Vec3 turned(const Vec3& parts) const { return parts.x * tangent + parts.y * first + parts.z * second; }
};

/// One of length 1 at right angles to a vector that is not 0.
Vec3 unit_across(const Vec3& v);

/// Throws InputError unless a line has two points, no two of which in a row are the same, and does not close.
void check_open_line(const std::vector<Vec3>& line);

/// Points of a polyline at parts of its length, from 0 to 1.
std::vector<Vec3> points_at_lengths(const std::vector<Vec3>& line, const std::vector<double>& parts);

/// A frame at each point of a polyline, each turned from the one before by the least turn that takes one
/// tangent to the next. Throws InputError with the place where the line turns back.
std::vector<Frame> moving_frames(const std::vector<Vec3>& line);

}  // namespace delquad
