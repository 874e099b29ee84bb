#pragma once

#include <string>
#include <tuple>

#include "io/cases/description.h"

namespace delquad {

// Shapes of curves as model files have them.

struct CircleShape {
  Vec2 centre;
  double radius;
};
struct ArcShape {
  CircleShape circle;
  double from, to;
};
struct ExpressionShape {
  std::string x, y;
  double from, to;
};

template <>
inline constexpr auto kFields<CircleShape> =
    std::tuple(field("centre", &CircleShape::centre, "[x, y]", {.required = true}),
               field("radius", &CircleShape::radius, "a length", {.above = 0, .required = true}));
template <>
inline constexpr auto kFields<ArcShape> =
    std::tuple(field("", &ArcShape::circle),
               field("from", &ArcShape::from, "degrees", {.form = Form::kDegrees, .required = true}),
               field("to", &ArcShape::to, "degrees; counterclockwise where it is more",
                     {.form = Form::kDegrees, .required = true}));
template <>
inline constexpr auto kFields<ExpressionShape> =
    std::tuple(field("x", &ExpressionShape::x, "formula in t", {.form = Form::kFormula, .required = true}),
               field("y", &ExpressionShape::y, "formula in t", {.form = Form::kFormula, .required = true}),
               field("from", &ExpressionShape::from, "first t", {.required = true}),
               field("to", &ExpressionShape::to, "last t", {.required = true}));

}  // namespace delquad
