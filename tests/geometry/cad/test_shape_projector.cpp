// SPDX-License-Identifier: GPL-3.0-or-later
#include <BRepFilletAPI_MakeFillet.hxx>
#include <GeomAPI_PointsToBSplineSurface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

/// The accuracy that read_cad promises, as a fraction of the diagonal.
constexpr double kAccuracy = 1e-9;

SurfaceModel read(const TopoDS_Shape& shape) {
  const TemporaryFolder folder;
  return read_shape(shape);
}

Vec3 centre(const Mesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return 1.0 / 3 * (mesh.points[a] + mesh.points[b] + mesh.points[c]);
}

/// Moves the center of each triangle off the surface by `lift` along the normal and back.
void expect_on_surface(const SurfaceModel& model, double lift,
                       const std::function<double(const Vec3&)>& distance) {
  for (std::size_t t = 0; t < model.fine.triangles.size(); ++t) {
    const auto& [a, b, c] = model.fine.triangles[t];
    const auto& p = model.fine.points;
    const Vec3 normal = cross(p[b] - p[a], p[c] - p[a]);
    const Vec3 x = centre(model.fine, t) + lift / norm(normal) * normal;
    const Vec3 y = model.projector->to_face(model.fine.triangle_region[t], x);
    EXPECT_NEAR(distance(y), 0, 10 * kAccuracy);
    EXPECT_LT(norm(y - x), std::abs(lift) + 0.02);
  }
}

TEST(ShapeProjector, MeetsElementarySurfaces) {
  const auto axis_distance = [](const Vec3& p) { return std::hypot(p.x, p.y); };
  expect_on_surface(read(BRepPrimAPI_MakeSphere(3)), 0.1, [](const Vec3& p) { return norm(p) - 3; });
  expect_on_surface(read(BRepPrimAPI_MakeTorus(5, 2)), -0.1,
                    [&](const Vec3& p) { return std::hypot(axis_distance(p) - 5, p.z) - 2; });
  expect_on_surface(read(BRepPrimAPI_MakeCylinder(2, 5)), 0.1, [&](const Vec3& p) {
    return std::min({std::abs(axis_distance(p) - 2), std::abs(p.z), std::abs(p.z - 5)});
  });
  expect_on_surface(read(BRepPrimAPI_MakeCone(3, 1, 4)), 0.1, [&](const Vec3& p) {
    return std::min({std::abs(axis_distance(p) - (3 - p.z / 2)), std::abs(p.z), std::abs(p.z - 4)});
  });
}

/// n x n points, point(i, j) with i and j from 0.
TColgp_Array2OfPnt grid(int n, const std::function<gp_Pnt(int, int)>& point) {
  TColgp_Array2OfPnt points(1, n, 1, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) points(i + 1, j + 1) = point(i, j);
  return points;
}

/// Over 0 < x < 11, 0 < y < 11.
Handle(Geom_BSplineSurface) wavy_sheet() {
  const auto wave = [](int i, int j) { return gp_Pnt(i, j, std::sin(i * 0.9) * std::cos(j * 0.7)); };
  return GeomAPI_PointsToBSplineSurface(grid(12, wave), 3, 5).Surface();
}

TEST(ShapeProjector, FindsFootPointsOfFreeFormSurfaces) {
  const Handle(Geom_BSplineSurface) sheet = wavy_sheet();
  const SurfaceModel model = read(BRepBuilderAPI_MakeFace(sheet, 1e-7));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> inside(0.06, 0.94), height(-0.2, 0.2);
  double u0, u1, v0, v1;
  sheet->Bounds(u0, u1, v0, v1);
  for (int i = 0; i < 5000; ++i) {
    gp_Pnt foot;
    gp_Vec du, dv;
    const double u = u0 + inside(random) * (u1 - u0), v = v0 + inside(random) * (v1 - v0);
    sheet->D1(u, v, foot, du, dv);
    // Heights below the least radius of curvature, which is less at the sides, so that the foot is the
    // nearest point.
    const gp_Pnt x = foot.Translated(height(random) * du.Crossed(dv).Normalized());
    const Vec3 y = model.projector->to_face(0, {x.X(), x.Y(), x.Z()});
    EXPECT_NEAR(foot.Distance({y.x, y.y, y.z}), 0, 16 * kAccuracy);
  }
}

TEST(ShapeProjector, StaysInsideFreeFormSurfaces) {
  const SurfaceModel model = read(BRepBuilderAPI_MakeFace(wavy_sheet(), 1e-7));
  const Vec3 y = model.projector->to_face(0, {20, 6, 0});
  EXPECT_NEAR(y.x, 11, 1e-9);
  const Vec3 corner = model.projector->to_face(0, {20, 30, 0});
  EXPECT_NEAR(corner.x, 11, 1e-9);
  EXPECT_NEAR(corner.y, 11, 1e-9);
}

TEST(ShapeProjector, PassesThePoleOfACollapsedPatch) {
  const auto fan = [](int i, int j) { return gp_Pnt(i, i * (j - 1), i == 1 ? 0.3 : 0); };
  const Handle(Geom_BezierSurface) patch = new Geom_BezierSurface(grid(3, fan));
  const SurfaceModel model = read(BRepBuilderAPI_MakeFace(patch, 1e-7));
  const Vec3 tip = model.projector->to_face(0, {-0.1, 0, 0});
  EXPECT_NEAR(norm(tip), 0, 1e-8);
  for (const double s : {1e-6, 1e-3, 0.1}) {
    const gp_Pnt on = patch->Value(s, 0.3);
    const Vec3 y = model.projector->to_face(0, {on.X(), on.Y(), on.Z()});
    EXPECT_NEAR(on.Distance({y.x, y.y, y.z}), 0, 3 * kAccuracy) << s;
  }
}

TEST(ShapeProjector, MeetsCurvesAndTheirEnds) {
  const SurfaceModel model = read(BRepPrimAPI_MakeCylinder(2, 5));
  for (std::size_t l = 0; l < model.fine.lines.size(); ++l) {
    const auto& [a, b] = model.fine.lines[l];
    const Vec3 x = 0.5 * (model.fine.points[a] + model.fine.points[b]);
    const Vec3 y = model.projector->to_curve(model.fine.line_curve[l], x);
    EXPECT_NEAR(std::hypot(y.x, y.y), 2, 10 * kAccuracy);
    EXPECT_NEAR(y.z, x.z, 10 * kAccuracy);
    EXPECT_NEAR(std::atan2(y.y, y.x), std::atan2(x.y, x.x), 10 * kAccuracy);
  }
  // On either side of the point where the circle begins and ends.
  for (const double angle : {-1e-3, 0.0, 1e-3}) {
    const Vec3 y = model.projector->to_curve(0, {3 * std::cos(angle), 3 * std::sin(angle), 5});
    EXPECT_NEAR(std::atan2(y.y, y.x), angle, kAccuracy);
  }
}

TEST(ShapeProjector, GivesTheSameFromSeveralThreads) {
  const SurfaceModel model = read(BRepBuilderAPI_MakeFace(wavy_sheet(), 1e-7));
  const auto project = [&](std::vector<Vec3>& to) {
    for (std::size_t t = 0; t < model.fine.triangles.size(); ++t)
      to.push_back(model.projector->to_face(0, centre(model.fine, t)));
  };
  std::vector<Vec3> alone;
  project(alone);
  std::vector<std::vector<Vec3>> together(4);
  std::vector<std::thread> threads;
  for (auto& to : together) threads.emplace_back([&] { project(to); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& to : together) EXPECT_EQ(to, alone);
}

/// Asks for the curvature at the center of every triangle, over what it should be there.
void expect_curvature(const SurfaceModel& model, const std::function<double(const Vec3&)>& exact) {
  for (std::size_t t = 0; t < model.fine.triangles.size(); ++t) {
    const int face = model.fine.triangle_region[t];
    const Vec3 x = model.projector->to_face(face, centre(model.fine, t));
    EXPECT_NEAR(model.projector->face_curvature(face, x), exact(x), 1e-3 * std::max(exact(x), 0.01));
  }
}

TEST(ShapeProjector, KnowsTheCurvatureOfElementarySurfaces) {
  expect_curvature(read(BRepPrimAPI_MakeSphere(3)), [](const Vec3&) { return 1.0 / 3; });
  expect_curvature(read(BRepPrimAPI_MakeTorus(5, 2)), [](const Vec3&) { return 1.0 / 2; });
  // A cylinder of radius 2 between two planes.
  expect_curvature(read(BRepPrimAPI_MakeCylinder(2, 5)), [](const Vec3& p) {
    return std::abs(std::hypot(p.x, p.y) - 2) < 1e-6 && p.z > 1e-6 && p.z < 5 - 1e-6 ? 1.0 / 2 : 0;
  });
}

TEST(ShapeProjector, KnowsTheCurvatureOfAFillet) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(4, 4, 4);
  BRepFilletAPI_MakeFillet fillet(box);
  fillet.Add(0.5, TopoDS::Edge(TopExp_Explorer(box, TopAbs_EDGE).Current()));
  const SurfaceModel model = read(fillet.Shape());
  double rounded = 0;
  for (std::size_t t = 0; t < model.fine.triangles.size(); ++t) {
    const auto& [a, b, c] = model.fine.triangles[t];
    const auto& p = model.fine.points;
    const double curvature =
        model.projector->face_curvature(model.fine.triangle_region[t], centre(model.fine, t));
    if (curvature < 1e-9) continue;
    EXPECT_NEAR(curvature, 2, 1e-6);
    rounded += norm(cross(p[b] - p[a], p[c] - p[a])) / 2;
  }
  EXPECT_NEAR(rounded, 4 * 0.5 * std::numbers::pi / 2, 0.02);
}

}  // namespace
}  // namespace delquad
