// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/cad/cad_files.h"

namespace delquad {
namespace {

using std::numbers::pi;

TopoDS_Shape box(double x, double y, double z, double dx, double dy, double dz) {
  return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), dx, dy, dz).Shape();
}

/// Points at the same place, beyond the first of each.
int coincident_points(const Mesh& mesh) {
  std::set<std::array<long long, 3>> places;
  constexpr double kPlaces = 1e6;
  for (const Vec3& p : mesh.points)
    places.insert({std::llround(p.x * kPlaces), std::llround(p.y * kPlaces), std::llround(p.z * kPlaces)});
  return static_cast<int>(mesh.points.size() - places.size());
}

class Glue : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::vector<TopoDS_Shape>& bodies) {
    return write_step(folder_ / "bodies.step", compound_of(bodies));
  }

  /// Apart, the bodies are said to lie on each other; glued, they do not, and have `n_common` faces in
  /// common. Returns the glued ones.
  SurfaceModel read_both_ways(const std::vector<TopoDS_Shape>& bodies, int n_common) {
    const auto file = write(bodies);
    const SurfaceModel apart = read_cad(file);
    EXPECT_TRUE(is_reported(apart.warnings, "share no nodes (--glue"));
    EXPECT_TRUE(is_reported(apart.warnings, " touches face "));
    SurfaceModel glued = read_cad(file, {.glue = true});
    EXPECT_FALSE(is_reported(glued.warnings, "share no nodes"));
    EXPECT_TRUE(is_reported(glued.warnings, "glued: " + std::to_string(bodies.size()) + " bodies have " +
                                                std::to_string(n_common) + " faces, "));
    EXPECT_EQ(coincident_points(glued.fine), 0);
    return glued;
  }

  TemporaryFolder folder_;
};

TEST_F(Glue, EqualFacesBecomeOne) {
  EXPECT_EQ(coincident_points(read_cad(write({box(0, 0, 0, 1, 1, 1), box(1, 0, 0, 2, 1, 1)})).fine), 4);
  const SurfaceModel model = read_both_ways({box(0, 0, 0, 1, 1, 1), box(1, 0, 0, 2, 1, 1)}, 1);
  EXPECT_EQ(model.fine.regions.size(), 11u);
  EXPECT_EQ(model.fine.curves.size(), 20u);
  EXPECT_NEAR(count(model.fine).area, 6 + 10 - 1, 1e-9);
  const auto n_with = [&](const std::vector<std::string>& names) {
    return std::ranges::count_if(model.fine.regions, [&](const Entity& face) { return face.names == names; });
  };
  EXPECT_EQ(n_with({"solid 1"}), 5);
  EXPECT_EQ(n_with({"solid 2"}), 5);
  EXPECT_EQ(n_with({"solid 1", "solid 2"}), 1);
}

TEST_F(Glue, LargerFacesAreCut) {
  const SurfaceModel model = read_both_ways({box(0, 0, 0, 4, 4, 1), box(1, 1, 1, 1, 1, 1)}, 1);
  EXPECT_EQ(model.fine.regions.size(), 12u);
  EXPECT_NEAR(count(model.fine).area, 48 + 6 - 1, 1e-9);
  EXPECT_TRUE(is_reported(model.warnings, "faces cut where others lie on them")) << "the top of the plate";
}

TEST_F(Glue, FacesThatOverlapInPart) {
  const SurfaceModel model = read_both_ways({box(0, 0, 0, 1, 1, 1), box(1, 0.5, 0.25, 1, 1, 1)}, 1);
  EXPECT_EQ(model.fine.regions.size(), 6u + 6 + 1);
  EXPECT_NEAR(count(model.fine).area, 12 - 0.5 * 0.75, 1e-9);
}

TEST_F(Glue, AnythingInAHole) {
  const TopoDS_Shape block = box(-2, -2, 0, 4, 4, 1), pin = BRepPrimAPI_MakeCylinder(1, 1);
  const SurfaceModel model = read_both_ways({BRepAlgoAPI_Cut(block, pin).Shape(), pin}, 1);
  EXPECT_NEAR(count(model.fine).area / (2 * 16 + 4 * 4 + 2 * pi), 1, 2e-3);
}

TEST_F(Glue, BodiesThatOverlapAreDivided) {
  const auto file = write({box(0, 0, 0, 2, 2, 2), box(1, 1, 1, 2, 2, 2)});
  const SurfaceModel model = read_cad(file, {.glue = true});
  EXPECT_TRUE(is_reported(model.warnings, "2 solids became 3"));
  EXPECT_NEAR(count(model.fine).area, 2 * 24, 1e-9);
}

TEST_F(Glue, BodiesWithACornerInCommonAreCounted) {
  const SurfaceModel model = read_cad(write({box(0, 0, 0, 1, 1, 1), box(1, 1, 1, 1, 1, 1)}), {.glue = true});
  EXPECT_TRUE(is_reported(model.warnings, "glued: 2 bodies have 0 faces, 0 edges and 1 vertices in common"));
  EXPECT_EQ(coincident_points(model.fine), 0);
}

TEST_F(Glue, ThreeBodiesAtAnEdge) {
  const SurfaceModel model =
      read_both_ways({box(0, 0, 0, 1, 1, 1), box(1, 0, 0, 1, 1, 1), box(0, 1, 0, 1, 1, 1)}, 2);
  EXPECT_EQ(model.fine.regions.size(), 16u);
}

TEST_F(Glue, MeshesShareTheirNodes) {
  MeshProblem problem = problem_of(CadModel{write({box(0, 0, 0, 4, 4, 1), box(1, 1, 1, 1, 1, 1)})}, 0.25);
  problem.surface.glue = true;
  const Mesh mesh = delquad::mesh(problem, "DB").mesh;
  EXPECT_TRUE(mesh.triangles.empty());
  EXPECT_EQ(coincident_points(mesh), 0);
  double area = 0;
  for (const auto& [a, b, c, d] : mesh.quads)
    area += norm(cross(mesh.points[c] - mesh.points[a], mesh.points[d] - mesh.points[b])) / 2;
  EXPECT_NEAR(area, 48 + 6 - 1, 1e-9);
}

TEST_F(Glue, OneBodyIsLeftAlone) {
  const SurfaceModel model = read_cad(write({box(0, 0, 0, 1, 1, 1)}), {.glue = true});
  EXPECT_TRUE(is_reported(model.warnings, "nothing to glue"));
  EXPECT_EQ(model.fine.regions.size(), 6u);
}

TEST_F(Glue, NeighboursInABodyAndBodiesApartAreNotSaidToTouch) {
  const auto file = write({box(0, 0, 0, 1, 1, 1), box(1.001, 0, 0, 1, 1, 1)});
  const SurfaceModel model = read_cad(file);
  EXPECT_FALSE(is_reported(model.warnings, "share no nodes"));
  EXPECT_TRUE(is_reported(
      model.warnings, "faces nearly touch at 1 place and stay apart: face 2 (solid 1) is 0.001 from face 7"));
  EXPECT_FALSE(
      is_reported(read_cad(file, {.size = [](const Vec3&) { return 0.009; }}).warnings, "nearly touch"));
}

TopoDS_Shape sheet(const gp_Pnt& at, const gp_Vec& u, const gp_Vec& v) {
  return BRepBuilderAPI_MakeFace(
      BRepBuilderAPI_MakePolygon(at, at.Translated(u), at.Translated(u + v), at.Translated(v), true).Wire());
}

TEST_F(Glue, SheetsThatNearlyTouch) {
  const TopoDS_Shape plate = sheet({0, 0, 0}, {40, 0, 0}, {0, 30, 0});
  const auto size = [](const Vec3&) { return 1.0; };
  for (const double gap : {1e-4, 1e-3, 1e-2, 0.09}) {
    SCOPED_TRACE(gap);
    const std::string told = fmt::format(" is {:.3g} from face ", gap);
    // A web above the plate; a plate beside it.
    for (const TopoDS_Shape& other :
         {sheet({0, 10, gap}, {40, 0, 0}, {0, 0, 6}), sheet({40 + gap, 0, 0}, {20, 0, 0}, {0, 30, 0})}) {
      const auto file = write({plate, other});
      EXPECT_TRUE(is_reported(read_cad(file, {.size = size}).warnings, told));
      const SurfaceModel glued = read_cad(file, {.glue = true, .size = size});
      EXPECT_TRUE(is_reported(glued.warnings, "2 parts hang apart"));
      EXPECT_TRUE(is_reported(glued.warnings, told));
      const SurfaceModel joined = read_cad(file, {.glue = true, .weld = 1.2 * gap / std::hypot(40, 30)});
      EXPECT_FALSE(is_reported(joined.warnings, "apart"));
      EXPECT_FALSE(is_reported(joined.warnings, "nearly touch"));
    }
  }
  EXPECT_FALSE(is_reported(
      read_cad(write({plate, sheet({0, 10, 0.11}, {40, 0, 0}, {0, 0, 6})}), {.size = size}).warnings,
      "nearly touch"));
}

TEST_F(Glue, BodiesThatTouchOtherwiseAreToldOnce) {
  const auto told = [&](const TopoDS_Shape& other, const std::string& text) {
    const auto file = write({box(0, 0, 0, 2, 2, 1), other});
    EXPECT_TRUE(is_reported(read_cad(file).warnings, text)) << text;
    EXPECT_FALSE(is_reported(read_cad(file, {.glue = true}).warnings, "share no nodes"));
  };
  told(box(2, 2, 0, 1, 1, 1),
       "faces touch at 1 place and share no nodes (--glue, surface.glue = true): face 2 "
       "(solid 1) touches face 7 (solid 2) at (2, 2, ");
  told(box(1, 1, 0.5, 2, 2, 2), " touches face ");
}

}  // namespace
}  // namespace delquad
