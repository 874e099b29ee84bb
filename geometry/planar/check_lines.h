#pragma once

#include <functional>
#include <string>

#include "delquad/mesh.h"
#include "geometry/planar/arrangement.h"

namespace delquad {

/// How messages call what they are about.
struct BoundaryNames {
  std::string source;                     ///< file; may be empty
  std::function<std::string(int)> curve;  ///< name of a curve, by index into Mesh::curves
  std::string crossing_hint;              ///< added where lines meet; may be empty
  int whiskers = -1;                      ///< a curve whose lines may be anywhere
};

/// Curves by their groups, or by their tags.
BoundaryNames names_of_curves(const Mesh& lines, const std::string& source);

/// What the lines of a mesh enclose. Throws InputError, naming curves and coordinates, for lines that cross,
/// touch or overlap, without length or there twice, coincident nodes, coordinates that are not finite, z not
/// constant; and where a line has no bounded face on either side: there the boundary is open.
Arrangement arrange_lines(const Mesh& lines, const BoundaryNames& names);

}  // namespace delquad
