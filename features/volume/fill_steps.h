// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "delquad/mesh.h"
#include "features/volume/body_parts.h"

// This header has the steps that fill a skin with cells, in their order. Volume meshes use it.

namespace delquad {

/// A side of a quad in the boundary of a body.
struct BodySide {
  int quad;
  bool is_reversed;  ///< seen from outside of the body, the quad runs clockwise
};
using Body = std::vector<BodySide>;

/// Returns the bodies: spaces enclosed by quads, with shells of cavities. A space inside another body is a
/// cavity if the normals of its quads point into it, which `notes` tells. Throws InputError with the place of
/// an open edge.
std::vector<Body> find_bodies(const Mesh& skin, ReadNotes* notes);

/// Tells where layers are lower or end.
struct GrownLayers {
  double least = 1;  ///< least part of the height that has room where layers stand
  Vec3 least_at;
  int n_bare = 0;  ///< quads without layers, of those that should have them
  Vec3 bare_at;    ///< of one of them
};

/// Fills a body, whose quads are its closed skin and look outwards, with layers on the quads with
/// `has_layers` and other cells. `heights`: of the layers' ends above the quads, ascending. `place` puts
/// cells into the smaller body inside, and fill_around() fills what is left; `improve` is for it. Returns the
/// quads at which that fails; empty: the body is full.
/// * Layers grow in the direction that all quads of layers at a point see best. They have their heights above
///   planes that meet in up to three directions.
/// * At quads without layers they end on rows of quads, as layers of the plane leave them. These have similar
///   proportions, and at most twice the height.
/// * Elsewhere heights fall to zero there, by prisms, and at corners by pyramids and tetrahedra.
/// * Heights shrink, with a bounded slope, where fronts meet or cells are not proven positive. Layers end
///   where nothing is left. Own method.
std::vector<int> fill_with_layers(Mesh& body, const std::vector<char>& has_layers,
                                  std::span<const double> heights, const std::function<void(Mesh&)>& place,
                                  bool improve, GrownLayers& grown);

/// Adds points and hexahedra inside of a closed skin; `volume` has its points and quads, counterclockwise
/// seen from outside. Two cells share nothing, a vertex, an edge or a side, and do not overlap; none crosses
/// the skin. Pyramids and tetrahedra can fill the rest. The points of the skin keep their places. `strategy`
/// is as check_strategy() wants it.
void place_hexahedra(Mesh& volume, const std::string& strategy);

/// Adds a prism between each three quads of the skin or of hexahedra that enclose one, with a scaled Jacobian
/// of 0.2 at least. The triangles of prisms cross no other face (exact). `volume`: as from place_hexahedra().
/// Own method.
void place_prisms(Mesh& volume);

/// Turns quads until their triangles by the diagonals from the first corners neither cross each other nor
/// coincide. `triangles` stay as they are. Returns the faces, quads first, that still do, and where the first
/// does.
std::vector<int> untangle(const std::vector<Vec3>& points, std::vector<Quad>& quads,
                          const std::vector<Triangle>& triangles, Vec3* where = nullptr);

/// Returns all given points, then new points off the triangles, and a constrained Delaunay tetrahedralization
/// by TetGen, in a separate process. All regions that triangles enclose are filled, also cavities; `holes`
/// are points of regions to leave out. The triangles should be faces of tetrahedra, but TetGen may lose some.
/// Returns nothing if TetGen refuses the triangles, crashes or exceeds its time. Source: [si2015].
std::optional<Mesh> tetrahedralise(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
                                   const std::vector<Vec3>& holes);

/// Adds pyramids and tetrahedra to a body. Its quads and triangles are the closed skin and look outwards; its
/// hexahedra and prisms lie inside and may use quads as faces. They go where the filling fails, and
/// move or are divided where it has poor cells. Without `improve` cells stay as made, at any positive
/// quality. All cells are of volume 0. Returns the faces of the skin, quads first, at which the filling
/// fails; empty: the body is full.
std::vector<int> fill_around(Mesh& body, bool improve = true);

/// Fills a closed skin by the steps above, in thin bodies also inside of one layer on all quads. Keeps what
/// has more volume in hexahedra, by 2 %. The layer has 0.4 of the sides as height, or less where there is no
/// room. Own method.
std::vector<int> fill_with_hexahedra(Mesh& body, const std::string& strategy, bool improve);

/// Fills Mesh::middle_nodes of tetrahedra from the nodes of quads of order 2: middle nodes of sides lie on
/// sides, middle nodes of quads on diagonals. `number` has the point of the tetrahedra for each corner of the
/// skin; their triangles are the halves of its quads, in order. Where a Jacobian is not proven to keep a part
/// of the straight tetrahedron's, nodes move towards straight edges; `notes`, which may be null, tell where.
void place_middle_nodes(Mesh& cells, const Mesh& skin, const std::vector<int>& number, ReadNotes* notes);

}  // namespace delquad
