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

/// Returns the nodes of a quad, as `places` orders them, one of the functions below.
std::vector<int> nodes_of_quad(const Mesh& mesh, std::size_t quad, const std::vector<int>& places);
/// Returns the nodes of a line, both ends first.
std::vector<int> nodes_ends_first(const Mesh& mesh, std::size_t line);

/// Returns the nodes on the sides of a quad, as it runs round; corners alone of a straight one.
std::vector<int> nodes_around(const Mesh& mesh, std::size_t quad);

/// Returns the point of a curved line at t in [0, 1], by its nodes.
Vec3 value_on_line(std::span<const Vec3> nodes, double t);

/// Pieces of each side of elements that are drawn.
int drawn_pieces(const Mesh& mesh);
/// Returns a polygon along the sides of a quad: its corners, of a curved one more points between them, so
/// that each side has drawn_pieces().
std::vector<Vec3> outline_of_quad(const Mesh& mesh, std::size_t quad);
/// Returns the same of a line, both ends included.
std::vector<Vec3> outline_of_line(const Mesh& mesh, std::size_t line);

/// Places in that square of the nodes strictly inside of a side, in the direction in which the quad runs
/// round.
std::vector<int> side_places(int order, int side);

/// Places in that square in the order of Gmsh: corners, sides, then the inside in the same way. For order 2
/// it is the order of VTK, Exodus and CGNS, too.
std::vector<int> gmsh_places(int order);
/// Returns the same of VTK's Lagrange quads: opposite sides run the same way, rows inside.
std::vector<int> vtk_places(int order);

/// Places in that square of the nodes that belong to the quad alone, as Mesh::quad_nodes lists them.
std::vector<int> inner_places(int order);

/// Returns the order of the line, or of the quad, that has so many nodes; 0: none up to kMostOrder has. Quads
/// of eight nodes have order 2.
int order_of_line(std::size_t n_nodes);
int order_of_quad(std::size_t n_nodes);

/// Returns whether an element of this order fits to the elements of the mesh, which takes the order of the
/// first one.
bool takes_order(Mesh& mesh, int order);
/// Returns the message for an element that does not fit.
std::string other_order(int order, int of_mesh);

/// Adds a line of the mesh's order by its nodes, both ends first.
void add_line(Mesh& mesh, std::span<const int> nodes, int curve);
/// Adds a quad of the mesh's order by its nodes, as `places` orders them, one of the functions above. A
/// middle one of nine that is left out becomes a new point. Its place follows the map of eight nodes, so that
/// both maps are the same.
void add_quad(Mesh& mesh, std::span<const int> nodes, const std::vector<int>& places, int region);
/// Returns its place, by the places of corners and of middles of sides.
Vec3 middle_of_eight(const std::array<Vec3, 4>& corners, const std::array<Vec3, 4>& sides);

}  // namespace delquad
