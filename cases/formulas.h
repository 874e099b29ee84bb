#pragma once

#include <memory>
#include <string>

#include "delquad/fields.h"
#include "geometry/planar/planar_model.h"

// Fields and curves that are written as formulas, see Expression. All throw InputError with the position
// where a formula does not parse.

namespace delquad {

/// delta = a formula in x, y, z.
std::unique_ptr<SizeField> make_expression_size(const std::string& text);

/// theta = a formula in x, y, z (radians).
std::unique_ptr<CrossField> make_expression_cross(const std::string& text);

/// (x(t), y(t)) for t from t0 to t1, either direction.
std::shared_ptr<const Curve> make_expression_curve(const std::string& x_text, const std::string& y_text,
                                                   double t0, double t1);

}  // namespace delquad
