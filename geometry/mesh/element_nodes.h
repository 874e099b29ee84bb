// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "delquad/mesh.h"

// This header has the order of nodes in curved elements. Most modules use it.

namespace delquad {

/// Returns the nodes of a quad as a square of order + 1 rows, each of order + 1. Row j, column i is at (i /
/// order, j / order) of the quad. Its corners are at (0, 0), (1, 0), (1, 1) and (0, 1).
std::vector<int> nodes_of_quad(const Mesh& mesh, std::size_t quad);

/// Returns the nodes of a line from its first end to its second.
std::vector<int> nodes_of_line(const Mesh& mesh, std::size_t line);

/// Returns the nodes of a quad in the order of `places`, which one of the functions below returns.
std::vector<int> nodes_of_quad(const Mesh& mesh, std::size_t quad, const std::vector<int>& places);
/// Returns the nodes of a line, both ends first.
std::vector<int> nodes_ends_first(const Mesh& mesh, std::size_t line);

/// Returns the nodes on the sides of a quad, counterclockwise; for order 1 the corners.
std::vector<int> nodes_around(const Mesh& mesh, std::size_t quad);

/// Returns the point of a curved line at t in [0, 1], by its nodes from end to end.
Vec3 value_on_line(std::span<const Vec3> nodes, double t);

/// Returns the number of pieces in which each side of an element is drawn.
int drawn_pieces(const Mesh& mesh);
/// Returns a polygon along the sides of a quad, with drawn_pieces() for each side.
std::vector<Vec3> outline_of_quad(const Mesh& mesh, std::size_t quad);
/// Returns a polyline along a line, both ends included.
std::vector<Vec3> outline_of_line(const Mesh& mesh, std::size_t line);

/// Returns the places in the square of the nodes strictly inside of a side (0 to 3), in the direction of the
/// quad.
std::vector<int> side_places(int order, int side);

/// Returns the places in the square in the order of Gmsh: corners, sides, then the inside in the same way.
/// VTK, Exodus and CGNS have the same for order 2.
std::vector<int> gmsh_places(int order);
/// Returns the places in the order of VTK's Lagrange quads: opposite sides in the same direction, then rows
/// inside.
std::vector<int> vtk_places(int order);

/// Returns the places in the square of the nodes strictly inside of the quad, as Mesh::quad_nodes lists them.
std::vector<int> inner_places(int order);

/// Return the order of a line, or a quad, with so many nodes; 0: no order up to kMostOrder has. Quads of
/// eight nodes have order 2.
int order_of_line(std::size_t n_nodes);
int order_of_quad(std::size_t n_nodes);

/// Returns whether an element of this order may join the mesh, which takes the order of its first element.
bool takes_order(Mesh& mesh, int order);
/// Returns the message for an element of another order than the mesh.
std::string other_order(int order, int of_mesh);

/// Adds a line of the mesh's order by its nodes, both ends first.
void add_line(Mesh& mesh, std::span<const int> nodes, int curve);
/// Adds a quad of the mesh's order by its nodes in the order of `places`. If the middle node of nine is
/// missing, it becomes a new point at middle_of_eight(), which does not change the map.
void add_quad(Mesh& mesh, std::span<const int> nodes, const std::vector<int>& places, int region);
/// Returns the middle of a quad of eight nodes, by its corners and the middles of its sides.
Vec3 middle_of_eight(const std::array<Vec3, 4>& corners, const std::array<Vec3, 4>& sides);

}  // namespace delquad
