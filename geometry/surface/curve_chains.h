#pragma once

#include <vector>

#include "geometry/surface/surface_model.h"

namespace delquad {

/// Angle, in radians from 0 to pi, by which the way a, b, c turns at b.
double turn_angle(const Vec3& a, const Vec3& b, const Vec3& c);

/// Marks in `corner` the points where exactly two lines meet and turn by more than `angle` (radians).
/// `among`: the points that are looked at.
void mark_turns(const Mesh& mesh, double angle, const std::vector<char>& among, std::vector<char>& corner);

/// Joins the lines of model.fine into maximal chains, which end at the marked points, where other than two
/// lines meet and where the kind of the lines or the number of triangles on them changes. Sorts the lines and
/// sets line_curve and the model's corners; returns for each chain the numbers that its lines had before.
/// model.fine.curves is left to the caller.
std::vector<std::vector<int>> chain_lines(SurfaceModel& model, const std::vector<int>& line_kind,
                                          std::vector<char> corner);

/// An entity for each piece of the `given` ones: the first piece of one keeps its tag, others get new tags;
/// all keep its names. given_of_piece -1: a piece of none.
std::vector<Entity> entities_of_pieces(const std::vector<Entity>& given,
                                       const std::vector<int>& given_of_piece);

}  // namespace delquad
