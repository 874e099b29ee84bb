#include <gtest/gtest.h>

#include <random>

#include "io/mesh_io.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/grid_mesh.h"
#include "tests/support/shapes.h"
#include "tests/support/temporary_folder.h"

namespace delquad {
namespace {

using testing_support::quad_grid;
using testing_support::read_text;
using testing_support::TemporaryFolder;
using testing_support::triangle_grid;

bool same_entities(const std::vector<Entity>& a, const std::vector<Entity>& b) {
  const auto same = [](const Entity& x, const Entity& y) { return x.tag == y.tag && x.names == y.names; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.lines, b.lines);
  EXPECT_EQ(a.line_curve, b.line_curve);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.triangle_region, b.triangle_region);
  EXPECT_EQ(a.quads, b.quads);
  EXPECT_EQ(a.quad_region, b.quad_region);
  EXPECT_TRUE(same_entities(a.curves, b.curves));
  EXPECT_TRUE(same_entities(a.regions, b.regions));
}

/// Coordinates of every magnitude, with all their digits.
Mesh shaken(Mesh mesh) {
  std::mt19937_64 random(5);
  for (Vec3& p : mesh.points) {
    p = {std::ldexp(shapes::uniform(random) - 0.5, static_cast<int>(random() % 600) - 300),
         shapes::uniform(random), 0.1};
  }
  return mesh;
}

/// Two triangles and two quads in two regions, with an interface curve, names with blanks and accents, a
/// nameless curve.
Mesh mixed() {
  Mesh mesh = quad_grid(2, 2);
  mesh.quads.erase(mesh.quads.begin());
  mesh.quads.erase(mesh.quads.begin() + 1);
  mesh.quad_region = {1, 1};
  mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {3, 4, 7}, {3, 7, 6}};
  mesh.triangle_region = {0, 0, 0, 0};
  for (const int j : {0, 1}) {
    mesh.lines.push_back({3 * j + 1, 3 * j + 4});
    mesh.line_curve.push_back(4);
  }
  mesh.curves.push_back({40, {}});
  mesh.curves[0].names = {"bord côté sud", "tous"};
  mesh.curves[1].names = {"tous"};
  mesh.regions = {{9, {"left <half>"}}, {3, {"17"}}};
  return mesh;
}

TEST(MshRoundTrip, KeepsEverything) {
  const TemporaryFolder folder;
  ASSERT_EQ(check_invariants(mixed()), std::vector<std::string>());
  Mesh lines = testing_support::grid_outline(1, 1, 1, 1);
  lines.regions.clear();
  for (const Mesh& mesh : {mixed(), quad_grid(5, 3), triangle_grid(3, 4), shaken(quad_grid(20, 20)), lines}) {
    write_msh(folder / "a.msh", mesh);
    const Mesh back = read_msh(folder / "a.msh");
    expect_same(mesh, back);
    write_msh(folder / "b.msh", back);
    EXPECT_EQ(read_text(folder / "a.msh"), read_text(folder / "b.msh"));
  }
}

TEST(MshRoundTrip, GroupsThatAreNumbersKeepThem) {
  const TemporaryFolder folder;
  write_msh(folder / "a.msh", mixed());
  const std::string text = read_text(folder / "a.msh");
  EXPECT_NE(text.find("\n2 17 \"17\"\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\n1 1 \"bord côté sud\"\n"), std::string::npos) << text;
}

TEST(MshWriter, IsTheDocumentedFormat) {
  const TemporaryFolder folder;
  write_msh(folder / "a.msh", quad_grid(1, 1, 0.5, 2));
  EXPECT_EQ(read_text(folder / "a.msh"), R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
5
1 1 "south"
1 2 "east"
1 3 "north"
1 4 "west"
2 5 "inside"
$EndPhysicalNames
$Entities
0 4 1 0
1 0 0 0 0.5 0 0 1 1 0
2 0.5 0 0 0.5 2 0 1 2 0
3 0 2 0 0.5 2 0 1 3 0
4 0 0 0 0 2 0 1 4 0
1 0 0 0 0.5 2 0 1 5 0
$EndEntities
$Nodes
5 4 1 4
1 1 0 2
1
2
0 0 0
0.5 0 0
1 2 0 1
4
0.5 2 0
1 3 0 1
3
0 2 0
1 4 0 0
2 1 0 0
$EndNodes
$Elements
5 5 1 5
1 1 1 1
1 1 2
1 2 1 1
2 2 4
1 3 1 1
3 4 3
1 4 1 1
4 3 1
2 1 3 1
5 1 2 4 3
$EndElements
)");
}

TEST(MshWriter, RefusesNamesThatTheFormatCannotHold) {
  const TemporaryFolder folder;
  Mesh mesh = quad_grid(1, 1);
  mesh.regions[0].names = {"a \"quoted\" name"};
  expect_input_error([&] { write_msh(folder / "a.msh", mesh); }, {"quoted", "double quote"});
  EXPECT_TRUE(folder.names().empty());
}

TEST(ObjRoundTrip, KeepsShapeAndNames) {
  const TemporaryFolder folder;
  const Mesh mesh = shaken(quad_grid(5, 3));
  write_obj(folder / "a.obj", mesh);
  expect_same(mesh, read_obj(folder / "a.obj"));
}

TEST(MeshFormats, AreToldByExtension) {
  const TemporaryFolder folder;
  for (const char* name : {"a.msh", "a.obj", "A.MSH", "A.Obj"}) {
    write_mesh(folder / name, quad_grid(3, 3));
    expect_same(quad_grid(3, 3), read_mesh(folder / name));
  }
  write_mesh(folder / "a.vtu", quad_grid(3, 3));
  EXPECT_NE(read_text(folder / "a.vtu").find("Name=\"eta\""), std::string::npos);
  expect_input_error([&] { write_mesh(folder / "a.stl", quad_grid(1, 1)); },
                     {"a.stl", "'.stl'", ".msh, .vtu, .obj, .inp or .mesh"});
  expect_input_error([&] { read_mesh(folder / "a.vtu"); }, {"a.vtu", ".msh, .obj, .off or .stl"});
}

}  // namespace
}  // namespace delquad
