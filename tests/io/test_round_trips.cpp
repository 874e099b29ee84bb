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

/// As MSH files have it, where every entity is in a group.
Mesh named(Mesh mesh) {
  for (Entity& curve : mesh.curves)
    if (curve.names.empty()) curve.names = {"curve_" + std::to_string(curve.tag)};
  return mesh;
}

TEST(MshRoundTrip, KeepsEverything) {
  const TemporaryFolder folder;
  ASSERT_EQ(check_invariants(mixed()), std::vector<std::string>());
  Mesh lines = testing_support::grid_outline(1, 1, 1, 1);
  lines.regions.clear();
  for (const Mesh& mesh : {mixed(), quad_grid(5, 3), triangle_grid(3, 4), shaken(quad_grid(20, 20)), lines}) {
    for (const bool binary : {false, true}) {
      write_mesh(folder / "a.msh", mesh, {binary, MshCurves::kAll});
      const Mesh back = read_mesh(folder / "a.msh");
      expect_same(named(mesh), back);
      write_mesh(folder / "b.msh", back, {binary, MshCurves::kAll});
      EXPECT_EQ(read_text(folder / "a.msh"), read_text(folder / "b.msh"));
    }
  }
}

TEST(MshRoundTrip, GroupsThatAreNumbersKeepThem) {
  const TemporaryFolder folder;
  write_mesh(folder / "a.msh", mixed());
  const std::string text = read_text(folder / "a.msh");
  EXPECT_NE(text.find("\n2 17 \"17\"\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\n1 1 \"bord côté sud\"\n"), std::string::npos) << text;
}

TEST(MshWriter, IsTheDocumentedFormat) {
  const TemporaryFolder folder;
  write_mesh(folder / "a.msh", quad_grid(1, 1, 0.5, 2));
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

/// The lines of a section.
std::string section(const std::string& text, const std::string& name) {
  const size_t first = text.find('$' + name + '\n'), last = text.find("$End" + name);
  return first == std::string::npos ? "" : text.substr(first, last - first);
}

TEST(MshWriter, PutsEveryEntityIntoOneGroup) {
  const TemporaryFolder folder;
  Mesh mesh = quad_grid(1, 3);
  mesh.regions = {
      {1, {"product", "colour #FF0000", "hole"}}, {2, {"product", "colour #FF0000"}}, {3, {"product"}}};
  mesh.quad_region = {0, 1, 2};
  mesh.curves[1].names = {"curve_3"};
  mesh.curves[2].names = {};
  mesh.curves[3].names = {"say \"x\"", "two\nlines\x01"};
  write_mesh(folder / "a.msh", mesh);
  const std::string text = read_text(folder / "a.msh");
  EXPECT_EQ(
      section(text, "PhysicalNames"),
      "$PhysicalNames\n7\n1 1 \"south\"\n1 2 \"curve_3\"\n1 3 \"curve_3_2\"\n1 4 \"say 'x'\"\n2 5 \"hole\"\n"
      "2 6 \"colour #FF0000\"\n2 7 \"product\"\n")
      << "the name that tells most; names that a group has otherwise stay different";
  EXPECT_EQ(section(text, "MoreNames"),
            "$MoreNames\n4\n1 4 \"two lines \"\n2 1 \"product\"\n2 1 \"colour #FF0000\"\n2 2 \"product\"\n");
}

TEST(MshWriter, LeavesOutLinesInside) {
  const TemporaryFolder folder;
  const auto curves = [&](MshCurves which) {
    write_mesh(folder / "a.msh", mixed(), {false, which});
    std::vector<int> tags;
    for (const Entity& curve : read_mesh(folder / "a.msh").curves) tags.push_back(curve.tag);
    return tags;
  };
  EXPECT_EQ(curves(MshCurves::kAll), (std::vector<int>{1, 2, 3, 4, 40}));
  EXPECT_EQ(curves(MshCurves::kNamed), (std::vector<int>{1, 2, 3, 4}));
  Mesh named_inside = mixed();
  named_inside.curves[4].names = {"interface"};
  write_mesh(folder / "a.msh", named_inside, {false, MshCurves::kNamed});
  EXPECT_EQ(read_mesh(folder / "a.msh").curves.size(), 5u);
  write_mesh(folder / "a.msh", named_inside, {false, MshCurves::kBoundary});
  EXPECT_EQ(read_mesh(folder / "a.msh").curves.size(), 4u);
}

TEST(ObjRoundTrip, KeepsShapeAndNames) {
  const TemporaryFolder folder;
  const Mesh mesh = shaken(quad_grid(5, 3));
  write_mesh(folder / "a.obj", mesh);
  expect_same(mesh, read_mesh(folder / "a.obj", nullptr, Strays::kKept));
}

TEST(MeshFormats, AreToldByExtension) {
  const TemporaryFolder folder;
  for (const char* name : {"a.msh", "a.obj", "A.MSH", "A.Obj"}) {
    write_mesh(folder / name, quad_grid(3, 3));
    expect_same(quad_grid(3, 3), read_mesh(folder / name));
  }
  write_mesh(folder / "a.vtu", quad_grid(3, 3));
  EXPECT_NE(read_text(folder / "a.vtu").find("Name=\"eta\""), std::string::npos);
  expect_input_error(
      [&] { write_mesh(folder / "a.stl", quad_grid(1, 1)); },
      {"a.stl", "'.stl'",
       ".msh, .vtu, .obj, .inp, .mesh, .vtk, .e, .cgns, .med, .xdmf, .mfem, .su2, .bdf, .unv, .k, "
       ".2dm, .gr3, .nc, .ism, .abq, .re2, "
       ".specfem, .foam or .svg"});
  expect_input_error([&] { write_mesh(folder / "a.msh.gz", quad_grid(1, 1)); }, {"a.msh.gz", "'.gz'"});
  expect_input_error(
      [&] {
        write_mesh(folder / "a.obj", quad_grid(1, 1), {true, MshCurves::kAll});
      },
      {"a.obj", "binary", ".msh"});
  expect_input_error([&] { read_mesh(folder / "a.xyz"); },
                     {"a.xyz", ".msh, .vtu, .obj, .inp, .mesh, .mfem, .bdf, "});
  write_mesh(folder / "a.svg", quad_grid(3, 3));
  EXPECT_NE(read_text(folder / "a.svg").find("<svg"), std::string::npos);
}

}  // namespace
}  // namespace delquad
