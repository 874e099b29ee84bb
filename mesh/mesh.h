#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/vec.h"

namespace delquad {

/// A named part of a model: a curve (dimension 1) or a region (dimension 2).
struct Entity {
  int tag = 0;                     ///< number in files, > 0
  std::vector<std::string> names;  ///< physical groups that hold it; may be empty
};

/// How the names begin that CAD faces have from their colours.
inline constexpr std::string_view kColourName = "colour #";

/// A mesh in space: line elements on curves, triangles and quads in regions. Planar meshes have z = 0.
struct Mesh {
  std::vector<Vec3> points;
  std::vector<std::array<int, 2>> lines;
  std::vector<int> line_curve;  ///< index into `curves` of each line
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> triangle_region;  ///< index into `regions` of each triangle
  std::vector<std::array<int, 4>> quads;
  std::vector<int> quad_region;
  std::vector<Entity> curves;
  std::vector<Entity> regions;
};

/// Length of the diagonal of the bounding box; 0 without points.
double diagonal(const Mesh& mesh);

/// What is wrong with the mesh, one line each; empty when it is sound: indices in range, no repeated vertex
/// in an element, each edge in at most two elements which run along it in opposite directions, no element
/// used twice, every line an edge of some element (when there are elements), no vertex that nothing uses.
std::vector<std::string> check_invariants(const Mesh& mesh);

}  // namespace delquad
