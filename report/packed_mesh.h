#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// A mesh in a few bytes, as page/packed_mesh.js takes it apart.
///
/// The text is that of packed_text(), of numbers of 7 bits a byte, lowest first, in this order: vertices of
/// triangles, of quads (each as its distance below the next new one; 0: that one, which is then used up), eta
/// of quads in 128ths (128: it fails), ends of lines (the same way), irregular vertices (number and valence),
/// pairs of them (two numbers each), steps from vertex to vertex in each direction, in units of `unit`, signs
/// in the lowest bit; with entities the regions of triangles and quads and the curves of lines, by index. A
/// curved quad is the polygon of the nodes on its sides, `order` for each side, and a curved line as many
/// pieces.
struct PackedMesh {
  std::size_t points = 0, triangles = 0, quads = 0, lines = 0, irregular = 0, pairs = 0;
  int dimension = 2, order = 1;
  std::array<double, 3> origin = {};
  double unit = 0;  ///< a 64th of the shortest edge, but not less than 2^-26 of the bounding box's diagonal
  std::string text;
};

/// Elements and vertices change their order. `failing`: quads that get a colour of their own.
PackedMesh pack_mesh(const Mesh& mesh, const std::vector<std::size_t>& failing = {},
                     bool with_entities = false);

/// Every `step`-th element along a curve that fills the space, blown up so that together they cover about as
/// much, each with vertices of its own; and the lines.
Mesh thinned(const Mesh& mesh, int step);

/// Bytes that a mesh takes when it is packed, roughly.
double packed_bytes(double triangles, double quads);

/// Base64 of the zlib-compressed bytes, as `inflate` of page/packed_mesh.js takes it apart.
std::string packed_text(std::string_view bytes);

}  // namespace delquad
