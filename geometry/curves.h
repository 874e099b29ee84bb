#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/planar_model.h"

// The curves a model can be made of. Each begins and ends exactly at the points it is given. All throw
// InputError for coordinates that are not finite and for curves without length; the message says which
// argument.

namespace delquad {

std::shared_ptr<const Curve> make_segment(Vec2 a, Vec2 b);

/// At least two points, none equal to the one before; the last may equal the first. Every corner gets a node.
std::shared_ptr<const Curve> make_polyline(std::vector<Vec2> points);

/// From angle0 to angle1 (radians), counterclockwise when angle1 > angle0; at most one turn. A full turn, to
/// rounding, ends at the very point where it began.
std::shared_ptr<const Curve> make_arc(Vec2 centre, double radius, double angle0, double angle1);

/// Counterclockwise from the point at angle 0.
std::shared_ptr<const Curve> make_circle(Vec2 centre, double radius);

/// (x(t), y(t)) for t from t0 to t1, either direction; the formulas know the variable t (see Expression).
std::shared_ptr<const Curve> make_expression_curve(const std::string& x_text, const std::string& y_text,
                                                   double t0, double t1);

}  // namespace delquad
