// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/cad/shell_joints.h"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <gp_Ax2.hxx>
#include <gp_Ax3.hxx>
#include <gp_Circ.hxx>
#include <gp_Cylinder.hxx>
#include <numbers>
#include <utility>

namespace delquad::testing_support {

namespace {

using std::numbers::pi;

TopoDS_Face polygon(const std::vector<Vec3>& points) {
  BRepBuilderAPI_MakePolygon wire;
  for (const Vec3& p : points) wire.Add(gp_Pnt(p.x, p.y, p.z));
  wire.Close();
  return BRepBuilderAPI_MakeFace(wire.Wire(), /*OnlyPlane=*/true).Face();
}

TopoDS_Face parallelogram(const Vec3& o, const Vec3& u, const Vec3& v) {
  return polygon({o, o + u, o + u + v, o + v});
}

/// [0, 10] x [0, 6] at z = 0.
TopoDS_Face plate() { return parallelogram({0, 0, 0}, {10, 0, 0}, {0, 6, 0}); }

/// Stands on the line from a to b, 3 high.
TopoDS_Face web(const Vec3& a, const Vec3& b) { return parallelogram(a, b - a, {0, 0, 3}); }

TopoDS_Face cylinder(const gp_Ax3& axis, double radius, double from, double to, double height) {
  return BRepBuilderAPI_MakeFace(gp_Cylinder(axis, radius), from, to, 0, height).Face();
}

TopoDS_Face disc(const gp_Ax2& axis, double radius) {
  const TopoDS_Edge circle = BRepBuilderAPI_MakeEdge(gp_Circ(axis, radius)).Edge();
  return BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(circle).Wire()).Face();
}

double area_of(const TopoDS_Face& face) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  return properties.Mass();
}

}  // namespace

std::vector<ShellJoint> shell_joints() {
  const gp_Pnt o(0, 0, 0);
  const gp_Dir x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  std::vector<ShellJoint> all;
  const auto add = [&](const char* name, std::vector<TopoDS_Face> faces, int n_glued, bool is_flat = true,
                       double common = 0) {
    double area = -common;
    for (const TopoDS_Face& face : faces) area += area_of(face);
    all.push_back({name, std::move(faces), area, n_glued, is_flat});
  };
  add("web_across", {plate(), web({4, 0, 0}, {4, 6, 0})}, 3);
  add("web_inside", {plate(), web({4, 1, 0}, {4, 5, 0})}, 2);
  add("web_from_the_side", {plate(), web({4, 0, 0}, {4, 4, 0})}, 2);
  add("web_over_the_side", {plate(), web({4, -2, 0}, {4, 3, 0})}, 2);
  add("web_over_both_sides", {plate(), web({4, -2, 0}, {4, 8, 0})}, 3);
  add("web_aslant", {plate(), parallelogram({2, 1, 0}, {5, 3, 0}, {-1, 2, 3})}, 2);
  add("webs_crossing", {plate(), web({2, 3, 0}, {8, 3, 0}), web({5, 1, 0}, {5, 5, 0})}, 5);
  add("web_below_two_plates",
      {parallelogram({0, 0, 0}, {4, 0, 0}, {0, 6, 0}), parallelogram({4, 0, 0}, {4, 0, 0}, {0, 6, 0}),
       web({4, 1, -3}, {4, 5, -3})},
      3);
  add("web_below_ends_of_two_plates",
      {parallelogram({0, 0, 0}, {4, 0, 0}, {0, 4, 0}), parallelogram({4, 2, 0}, {4, 0, 0}, {0, 4, 0}),
       web({4, 0, -3}, {4, 6, -3})},
      3);
  add("arched_web", {plate(), cylinder(gp_Ax3(gp_Pnt(5, 1, 0), z, x), 3, 0.3, 2.2, 2)}, 2, false);
  add("fin_on_a_pipe",
      {cylinder(gp_Ax3(o, z, x), 3, -2, 2, 8), parallelogram({3, 0, 2}, {2, 0, 0}, {0, 0, 4})}, 2, false);
  add("wall_in_a_pipe", {cylinder(gp_Ax3(o, z, x), 3, 0, 2 * pi, 8), disc(gp_Ax2(gp_Pnt(0, 0, 4), z), 3)}, 3,
      false);
  add("plates_crossing", {plate(), parallelogram({4, 0, -3}, {0, 6, 0}, {0, 0, 6})}, 4);
  add("narrow_plate_crossing", {plate(), parallelogram({4, 2, -3}, {0, 2, 0}, {0, 0, 6})}, 3);
  add("plates_crossing_in_part", {plate(), parallelogram({4, 3, -3}, {0, 6, 0}, {0, 0, 6})}, 2);
  add("plates_crossing_aslant", {plate(), parallelogram({3, 1, -3}, {1, 4, 0}, {2, 0, 6})}, 3);
  add("three_plates_crossing",
      {parallelogram({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), parallelogram({-4, 0, -4}, {8, 0, 0}, {0, 0, 8}),
       parallelogram({0, -4, -4}, {0, 8, 0}, {0, 0, 8})},
      12);
  add("pipe_through_a_plate", {plate(), cylinder(gp_Ax3(gp_Pnt(5, 3, -2), z, x), 2, 0, 2 * pi, 5)}, 4, false);
  add("corner_of_unequal_plates", {plate(), web({0, 1, 0}, {0, 5, 0})}, 2);
  add("corner_of_shifted_plates", {plate(), web({0, 3, 0}, {0, 9, 0})}, 2);
  add("gusset", {plate(), web({0, 0, 0}, {0, 6, 0}), polygon({{0, 3, 0}, {3, 3, 0}, {0, 3, 2}})}, 3);
  add("hat_on_a_plate",
      {plate(), web({3, 0, 0}, {3, 6, 0}), web({7, 0, 0}, {7, 6, 0}),
       parallelogram({3, 0, 3}, {4, 0, 0}, {0, 6, 0})},
      6);
  add("doubler", {plate(), parallelogram({3, 2, 0}, {3, 0, 0}, {0, 2, 0})}, 2, true, 6);
  return all;
}

std::vector<PointContact> point_contacts() {
  const gp_Dir x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), aslant(1, 2, 3);
  const auto ball = [&](const Vec3& at, double radius, const gp_Dir& axis) -> TopoDS_Shape {
    return BRepPrimAPI_MakeSphere(gp_Ax2(gp_Pnt(at.x, at.y, at.z), axis), radius).Shape();
  };
  const auto pipe = [&](const Vec3& from, const gp_Dir& axis) -> TopoDS_Shape {
    return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(from.x, from.y, from.z), axis), 1, 9).Shape();
  };
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(8, 8, 8).Shape();
  const auto between = [](const Vec3& a, double radius, const Vec3& b) {
    return a + radius / norm(b - a) * (b - a);
  };
  const Vec3 here{1, 2, 3}, there{3, 4, 4};
  constexpr double kGap = 1e-8;
  return {{"balls", {ball(here, 1, z), ball(there, 2, z)}, between(here, 1, there)},
          {"ball_in_a_ball", {ball(here, 5, z), ball(there, 2, aslant)}, between(here, 5, there)},
          {"poles", {ball({0, 0, 0}, 1, z), ball({0, 0, 3}, 2, z)}, {0, 0, 1}},
          {"ball_on_a_plate", {plate(), ball({4, 3, 2}, 2, aslant)}, {4, 3, 0}},
          {"pole_on_a_plate", {plate(), ball({4, 3, 2}, 2, z)}, {4, 3, 0}},
          {"ball_off_a_plate", {plate(), ball({4, 3, 2 + kGap}, 2, z)}, {4, 3, 0}},
          {"ball_on_a_floor", {box, ball({4, 4, 2}, 2, z)}, {4, 4, 0}},
          {"ball_at_a_wall", {box, ball({2, 4, 4}, 2, z)}, {0, 4, 4}},
          {"pipes", {pipe({-4, 0, 0}, x), pipe({0.5, -4, 2}, y)}, {0.5, 0, 1}},
          {"rim_on_a_plate", {plate(), disc(gp_Ax2(gp_Pnt(4, 3, 2), aslant.Crossed(z)), 2)}, {4, 3, 0}},
          {"rims",
           {disc(gp_Ax2(gp_Pnt(1, 2, 0), z, x), 1), disc(gp_Ax2(gp_Pnt(4, 6, 0), z, x), 4)},
           {1.6, 2.8, 0}}};
}

std::vector<DoubleFaces> double_faces() {
  const auto reversed = [](const TopoDS_Face& face) { return TopoDS::Face(face.Reversed()); };
  const auto ring = [] { return disc(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 3); };
  const TopoDS_Face back = parallelogram({0, 6, 0}, {10, 0, 0}, {0, -6, 0});
  std::vector<TopoDS_Face> box;
  for (TopExp_Explorer at(BRepPrimAPI_MakeBox(10, 6, 2).Shape(), TopAbs_FACE); at.More(); at.Next())
    box.push_back(TopoDS::Face(at.Current()));
  box.push_back(plate());
  return {{"plates", {plate(), plate()}, 1, 60},
          {"plates_back_to_back", {plate(), back}, 1, 60},
          {"plate_reversed", {plate(), reversed(plate())}, 1, 60},
          {"three_plates", {plate(), back, plate()}, 1, 60},
          {"four_plates", {plate(), plate(), plate(), plate()}, 1, 60},
          {"discs", {ring(), ring()}, 1, 9 * pi},
          {"pipes", {cylinder(gp_Ax3(), 3, 0, 2 * pi, 8), cylinder(gp_Ax3(), 3, 0, 2 * pi, 8)}, 1, 48 * pi},
          {"box_with_two_lids", box, 6, 120 + 2 * 2 * 16}};
}

std::vector<TopoDS_Face> star_of_faces(int n) {
  std::vector<TopoDS_Face> faces;
  for (int i = 0; i < n; ++i)
    faces.push_back(
        parallelogram({0, 0, 0}, {0, 6, 0}, {4 * std::cos(2 * pi * i / n), 0, 4 * std::sin(2 * pi * i / n)}));
  return faces;
}

std::vector<TopoDS_Face> tip_on_a_plate() { return {plate(), polygon({{4, 3, 0}, {6, 3, 3}, {2, 3, 3}})}; }

std::vector<TopoDS_Face> gusset_from_a_corner() {
  return {plate(), web({10, 0, 0}, {10, 6, 0}), polygon({{10, 0, 0}, {10, 0, 3}, {6, 4, 0}})};
}

std::vector<std::vector<TopoDS_Face>> faces_apart() {
  constexpr double kGap = 1e-3;  // far below the deflection, far above what touches
  const gp_Ax3 axis(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1));
  return {{cylinder(axis, 3, 0, 2 * pi, 8), cylinder(axis, 3 - kGap, 0, 2 * pi, 8)},
          {cylinder(axis, 3, 0, 2 * pi, 8), disc(gp_Ax2(gp_Pnt(0, 0, 4), axis.Direction()), 3 - kGap)},
          {plate(), parallelogram({10 + kGap, 0, 0}, {4, 0, 0}, {0, 6, 0})},
          {plate(), web({10 + kGap, 0, 0}, {10 + kGap, 6, 0})},
          {plate(), parallelogram({2, 2, kGap}, {4, 0, 0}, {0, 2, 0})}};
}

}  // namespace delquad::testing_support
