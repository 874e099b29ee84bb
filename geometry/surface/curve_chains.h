// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "geometry/surface/surface_model.h"

// This header joins lines of a triangulation into curves. The pipeline, features, geometry and fields use
// it.

namespace delquad {

/// Returns the angle, in radians from 0 to pi, by which the path a, b, c turns at b.
double turn_angle(const Vec3& a, const Vec3& b, const Vec3& c);

/// Marks in `corner` the points where exactly two lines meet and turn by more than `angle` (radians). Only
/// points in `among` are examined.
void mark_turns(const Mesh& mesh, double angle, const std::vector<char>& among, std::vector<char>& corner);

/// A chain of edges.
struct EdgeChain {
  std::vector<int> points;  ///< points from end to end; of a closed chain the last is the first
  std::vector<int> edges;   ///< by index
};
/// Returns maximal chains, which end where is_end(point) is true, and where other than two edges meet.
std::vector<EdgeChain> chain_edges(const std::vector<std::array<int, 2>>& edges,
                                   const std::function<bool(int)>& is_end);

/// Joins the lines of model.fine into maximal chains. They end at the marked points and where other than two
/// lines meet. They also end where the kind of the lines or the number of triangles on them changes. Sorts
/// the lines, and sets line_curve and the model's corners, but not model.fine.curves. Returns for each chain
/// the former numbers of its lines.
std::vector<std::vector<int>> chain_lines(SurfaceModel& model, const std::vector<int>& line_kind,
                                          std::vector<char> corner);

/// Returns the points of each curve, whose lines must form one chain, from end to end; of a closed one the
/// last is the first.
std::vector<std::vector<int>> points_of_curves(const Mesh& mesh);

/// Returns the length of the lines of each curve.
std::vector<double> lengths_of_curves(const Mesh& mesh);

/// Returns an entity for each piece. The first piece of a `given` entity keeps its tag, others get new tags;
/// all keep its names. An entry of -1 in given_of_piece stands for no given entity.
std::vector<Entity> entities_of_pieces(const std::vector<Entity>& given,
                                       const std::vector<int>& given_of_piece);

}  // namespace delquad
