// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "delquad/mesh.h"
#include "io/cases/description.h"

// This header has the shapes that model files know. Readers and writers use it.

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
/// A curve by one of its members.
struct CurveShape {
  std::optional<std::array<Vec2, 2>> segment;
  std::vector<Vec3> polyline, spline;  ///< in the plane but for lines embedded in surfaces
  std::optional<ArcShape> arc;
  std::optional<CircleShape> circle;
  std::optional<ExpressionShape> expression;
};
struct NamedShape {
  std::string name, boundary;
  CurveShape shape;
};
struct EmbeddedShape {
  std::string name;
  bool is_crack;
  std::optional<Vec3> point;  ///< in place of a curve
  CurveShape shape;
};
/// A loop by one of the first three members, or by curves.
struct ClosedShape {
  std::optional<std::array<Vec2, 2>> rectangle;
  std::vector<Vec2> polygon;
  std::optional<CircleShape> circle;
  std::vector<std::string> boundary;
  std::string region;
  bool is_hole;
};
struct LoopShape {
  ClosedShape closed;
  std::vector<std::string> curves;
};
struct PatternShape {
  ClosedShape closed;
  std::array<int, 2> count;
  Vec2 step;
};

template <>
inline constexpr auto kFields<CircleShape> =
    std::tuple(field("centre", &CircleShape::centre, "[x, y]", {.required = true}),
               field("radius", &CircleShape::radius, "a length", {.above = 0, .required = true}));
template <>
inline constexpr auto kFields<ArcShape> =
    std::tuple(field("", &ArcShape::circle),
               field("from", &ArcShape::from, "degrees", {.form = Form::kDegrees, .required = true}),
               field("to", &ArcShape::to, "degrees; counterclockwise if it is larger",
                     {.form = Form::kDegrees, .required = true}));
template <>
inline constexpr auto kFields<ExpressionShape> =
    std::tuple(field("x", &ExpressionShape::x, "formula in t", {.form = Form::kFormula, .required = true}),
               field("y", &ExpressionShape::y, "formula in t", {.form = Form::kFormula, .required = true}),
               field("from", &ExpressionShape::from, "first t", {.required = true}),
               field("to", &ExpressionShape::to, "last t", {.required = true}));
template <>
inline constexpr auto kFields<CurveShape> = std::tuple(
    field("segment", &CurveShape::segment, "two points"),
    field("polyline", &CurveShape::polyline, "points, each of which gets a node, or a file of them",
          {.least = 2}),
    field("spline", &CurveShape::spline, "points that a smooth curve goes through, or a file", {.least = 2}),
    field("arc", &CurveShape::arc, "a part of a circle"), field("circle", &CurveShape::circle, "a circle"),
    field("expression", &CurveShape::expression, "formulas"));
template <>
inline constexpr auto kFields<NamedShape> = std::tuple(
    field("name", &NamedShape::name, "name of the curve for loops", {.form = Form::kGroup, .required = true}),
    field("boundary", &NamedShape::boundary, "its name in all but loops; else 'name'",
          {.form = Form::kGroup}),
    field("", &NamedShape::shape));
template <>
inline constexpr auto kFields<EmbeddedShape> = std::tuple(
    field("name", &EmbeddedShape::name, "its physical group", {.form = Form::kGroup}),
    field("crack", &EmbeddedShape::is_crack, "whether the mesh comes apart along it"),
    field("point", &EmbeddedShape::point, "a point that becomes a node"), field("", &EmbeddedShape::shape));
template <>
inline constexpr auto kFields<ClosedShape> = std::tuple(
    field("rectangle", &ClosedShape::rectangle, "two opposite corners"),
    field("polygon", &ClosedShape::polygon, "corners, in either direction", {.least = 3}),
    field("circle", &ClosedShape::circle, "a circle"),
    field("boundary", &ClosedShape::boundary,
          "name of its curves, or one for each; not with 'curves', which have names", {.form = Form::kGroup}),
    field("region", &ClosedShape::region, "name of the inside", {.form = Form::kGroup}),
    field("hole", &ClosedShape::is_hole, "whether it must be a hole"));
template <>
inline constexpr auto kFields<LoopShape> = std::tuple(field("", &LoopShape::closed),
                                                      field("curves", &LoopShape::curves,
                                                            "names of curves that close up", {.least = 1}));
template <>
inline constexpr auto kFields<PatternShape> =
    std::tuple(field("", &PatternShape::closed),
               field("count", &PatternShape::count, "how many, [nx, ny]", {.required = true}),
               field("step", &PatternShape::step, "from one to the next, [dx, dy]", {.required = true}));

}  // namespace delquad
