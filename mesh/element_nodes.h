#pragma once

#include <span>
#include <vector>

#include "delquad/mesh.h"

namespace delquad {

/// Nodes of a quad as a square of order + 1 rows, each of order + 1: row j, column i is at
/// (i / order, j / order) of the quad, whose corners are at (0, 0), (1, 0), (1, 1) and (0, 1).
std::vector<int> nodes_of_quad(const Mesh& mesh, std::size_t quad);

/// Nodes of a line from its first end to its second.
std::vector<int> nodes_of_line(const Mesh& mesh, std::size_t line);

/// Nodes of a quad, as `places` orders them, one of the functions below.
std::vector<int> nodes_of_quad(const Mesh& mesh, std::size_t quad, const std::vector<int>& places);
/// Nodes of a line, both ends first.
std::vector<int> nodes_ends_first(const Mesh& mesh, std::size_t line);

/// The point of a curved line at t in [0, 1], by its nodes.
Vec3 value_on_line(std::span<const Vec3> nodes, double t);

/// A polygon along the sides of a quad: its corners, of a curved one more points between them.
std::vector<Vec3> outline_of_quad(const Mesh& mesh, std::size_t quad);

/// Places in that square of the nodes strictly inside of a side, in the direction in which the quad runs
/// round.
std::vector<int> side_places(int order, int side);

/// Places in that square in the order of Gmsh: corners, sides, then what is inside in the same way. For order
/// 2 it is that of VTK, Exodus and CGNS, too.
std::vector<int> gmsh_places(int order);
/// The same of VTK's Lagrange quads: opposite sides run the same way, rows inside.
std::vector<int> vtk_places(int order);

/// Places in that square of the nodes that belong to the quad alone, as Mesh::quad_nodes lists them.
std::vector<int> inner_places(int order);

}  // namespace delquad
