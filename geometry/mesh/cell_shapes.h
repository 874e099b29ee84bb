// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "delquad/mesh.h"

// This header has the shapes of elements, and tables of the sides and edges of cells of volumes. Checks,
// measures, readers and writers use it.

namespace delquad {

enum class CellShape { kPoint, kLine, kTriangle, kQuad, kHexahedron, kPrism, kPyramid, kTetrahedron };
inline constexpr std::size_t kCellShapes = 8;

constexpr int dimension_of(CellShape shape) {
  return shape >= CellShape::kHexahedron ? 3 : shape >= CellShape::kTriangle ? 2 : static_cast<int>(shape);
}
constexpr int corners_of(CellShape shape) {
  constexpr std::array kCorners = {1, 2, 3, 4, 8, 6, 5, 4};
  return kCorners[static_cast<std::size_t>(shape)];
}

namespace cell_tables {
inline constexpr std::array<int, 4>
    kHexSides[] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}},
    kPrismSides[] = {{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}},
    kPyramidSides[] = {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}},
    kTetSides[] = {{0, 2, 1, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {2, 0, 3, -1}};
inline constexpr std::array<int, 2> kHexEdges[] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                                   {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}},
                                    kPrismEdges[] = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5},
                                                     {5, 3}, {0, 3}, {1, 4}, {2, 5}},
                                    kPyramidEdges[] = {{0, 1}, {1, 2}, {2, 3}, {3, 0},
                                                       {0, 4}, {1, 4}, {2, 4}, {3, 4}},
                                    kTetEdges[] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
}  // namespace cell_tables

/// A shape of cells of volumes. Corners are as in Mesh.
struct SolidShape {
  CellShape shape;
  const char *name, *plural;
  std::size_t n_corners;
  /// Counterclockwise seen from outside, S1, S2, ... of Abaqus. Triangles end with -1.
  std::span<const std::array<int, 4>> sides;
  std::span<const std::array<int, 2>> edges;  ///< in the order of the nodes on edges in Abaqus
};
/// In the order in which cells of a mesh are counted.
inline constexpr std::array<SolidShape, 4> kSolidShapes = {
    {{CellShape::kHexahedron, "hexahedron", "hexahedra", 8, cell_tables::kHexSides, cell_tables::kHexEdges},
     {CellShape::kPrism, "prism", "prisms", 6, cell_tables::kPrismSides, cell_tables::kPrismEdges},
     {CellShape::kPyramid, "pyramid", "pyramids", 5, cell_tables::kPyramidSides, cell_tables::kPyramidEdges},
     {CellShape::kTetrahedron, "tetrahedron", "tetrahedra", 4, cell_tables::kTetSides,
      cell_tables::kTetEdges}}};

inline const SolidShape& solid_shape(CellShape shape) {
  return kSolidShapes[static_cast<std::size_t>(shape) - static_cast<std::size_t>(CellShape::kHexahedron)];
}

/// Calls f(shape, cells, volumes of the cells) for each shape; the mesh may be const.
template <class AnyMesh, class F>
void for_each_shape(AnyMesh& mesh, const F& f) {
  f(kSolidShapes[0], mesh.hexahedra, mesh.hex_volume);
  f(kSolidShapes[1], mesh.prisms, mesh.prism_volume);
  f(kSolidShapes[2], mesh.pyramids, mesh.pyramid_volume);
  f(kSolidShapes[3], mesh.tetrahedra, mesh.tet_volume);
}

/// Returns the number of cells of all shapes.
inline std::size_t n_solids(const Mesh& mesh) {
  return mesh.hexahedra.size() + mesh.prisms.size() + mesh.pyramids.size() + mesh.tetrahedra.size();
}
inline bool is_solid(const Mesh& mesh) { return n_solids(mesh) > 0; }

/// A cell of a volume.
struct Solid {
  const SolidShape* shape;
  std::span<const int> nodes;
  int volume = 0;

  /// Returns the nodes of a side, counterclockwise seen from outside; -1 after three.
  std::array<int, 4> side(int number) const {
    std::array<int, 4> side = shape->sides[number];
    for (int& v : side)
      if (v >= 0) v = nodes[v];
    return side;
  }
};
/// Returns cell i of a mesh, counted over all shapes.
Solid solid_at(const Mesh& mesh, std::size_t i);

/// A side of an element, from 0. Side k of a triangle or quad lies between its corners k and k + 1. Sides of
/// cells are as in SolidShape.
struct CellSide {
  int element, side;
};
struct SolidSide {
  std::array<int, 4> nodes;  ///< ascending; -1 first for triangles
  CellSide side;
};
/// Returns the nodes of a triangle (with -1) or quad as in SolidSide.
std::array<int, 4> side_key(std::span<const int> nodes);
/// Returns the sides of all cells, by their nodes.
std::vector<SolidSide> sorted_sides(const Mesh& mesh);
/// Returns the place of the middle node of an edge: the one in Mesh::middle_nodes, or the middle of a
/// straight edge.
Vec3 middle_of_edge(const Mesh& mesh, int a, int b);
/// Returns whether two sides of the same nodes have them in the same cyclic order.
bool same_turn(const std::array<int, 4>& a, const std::array<int, 4>& b);

}  // namespace delquad
