// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/check_mesh.h"
#include "io/mesh_formats.h"
#include "tests/support/files.h"
#include "tests/support/shapes.h"

namespace delquad {
namespace {

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

/// The places of nodes that items of two meshes have.
template <class Nodes>
void expect_same_places(const Mesh& a, const Mesh& b, std::size_t n, double rounding, Nodes nodes) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::vector<int> of_a = nodes(a, i), of_b = nodes(b, i);
    ASSERT_EQ(of_a.size(), of_b.size());
    for (std::size_t k = 0; k < of_a.size(); ++k)
      EXPECT_LE(norm(a.points[of_a[k]] - b.points[of_b[k]]), rounding) << i << " " << k;
  }
}

Strings names_of_items(const std::vector<int>& entity_of, const std::vector<Entity>& entities) {
  Strings names;
  for (const int i : entity_of) names.push_back(entities[i].names.empty() ? "" : entities[i].names[0]);
  return names;
}

std::map<std::string, int> names_of_points(const Mesh& mesh) {
  std::map<std::string, int> points;
  for (const NamedPoint& named : mesh.named_points) points[named.entity.names.at(0)] = named.point;
  return points;
}

/// Two triangles and a quad in two regions, with named points.
Mesh two_kinds(bool has_blanks) {
  Mesh mesh = quad_grid(2, 1, 1.0 / 3, 0.1);
  mesh.quads.erase(mesh.quads.begin());
  mesh.quad_region = {1};
  mesh.triangles = {{0, 1, 4}, {0, 4, 3}};
  mesh.triangle_region = {0, 0};
  mesh.curves[0].names = {has_blanks ? "bottom side" : "bottom"};
  mesh.regions = {{1, {has_blanks ? "steel: 5" : "steel"}}, {2, {"air"}}};
  mesh.named_points = {{2, {1, {"tip"}}}, {4, {2, {has_blanks ? "Sensor 1" : "Sensor"}}}};
  return mesh;
}

/// With middles of quads where eight other nodes have them.
Mesh of_eight_nodes(Mesh mesh) {
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const std::vector<int> v = nodes_of_quad(mesh, q);
    const auto at = [&](int k) { return mesh.points[v[k]]; };
    mesh.points[v[4]] = middle_of_eight({at(0), at(2), at(8), at(6)}, {at(1), at(5), at(7), at(3)});
  }
  return mesh;
}

/// A format keeps this of a mesh beside elements.
struct Kept {
  double rounding = 0;
  bool has_lines = true, has_blanks = true, has_numbers = true, has_names = true;
};
const std::map<std::string, Kept> kKept = {
    {".obj", {.has_blanks = false}},
    {".inp", {.rounding = 1e-12, .has_blanks = false}},
    {".bdf", {.rounding = 1e-9, .has_lines = false, .has_numbers = false}},
    {".mfem", {.has_numbers = false}},
    {".2dm", {.has_lines = false, .has_blanks = false}},
    {".gr3", {.has_lines = false, .has_blanks = false}},
    {".nc", {.has_lines = false, .has_names = false}},
    {".off", {.has_lines = false}},
    {".ply", {.has_lines = false}},
    {".stl", {.has_lines = false, .has_numbers = false}}};

void expect_same_in(const MeshFormat& format, const fs::path& file, const Mesh& mesh,
                    const MshOptions& options) {
  const auto found = kKept.find(format.extensions[0]);
  const Kept kept = found == kKept.end() ? Kept{} : found->second;
  write_mesh(file, mesh, options);
  const Mesh back = read_mesh(file);
  require_readable(back, "read");
  EXPECT_EQ(check_invariants(back), Strings());
  EXPECT_EQ(back.order, mesh.order);
  EXPECT_EQ(back.points.size(), mesh.points.size());
  ASSERT_EQ(back.triangles.size(), mesh.triangles.size());
  ASSERT_EQ(back.quads.size(), mesh.quads.size());
  ASSERT_EQ(back.lines.size(), kept.has_lines ? mesh.lines.size() : 0u);
  if (kept.has_numbers && mesh.order == 1) {
    EXPECT_EQ(back.quads, mesh.quads);
    EXPECT_EQ(back.triangles, mesh.triangles);
  }
  expect_same_places(mesh, back, mesh.triangles.size(), kept.rounding, [](const Mesh& of, std::size_t i) {
    return std::vector<int>(of.triangles[i].begin(), of.triangles[i].end());
  });
  expect_same_places(mesh, back, mesh.quads.size(), kept.rounding,
                     [](const Mesh& of, std::size_t i) { return nodes_of_quad(of, i); });
  if (kept.has_names && format.names & kRegionNames) {
    EXPECT_EQ(names_of_items(back.triangle_region, back.regions),
              names_of_items(mesh.triangle_region, mesh.regions));
    EXPECT_EQ(names_of_items(back.quad_region, back.regions), names_of_items(mesh.quad_region, mesh.regions));
  }
  if (kept.has_lines && format.extensions[0] != ".inp") {  // which has surfaces, by name
    expect_same_places(mesh, back, mesh.lines.size(), kept.rounding,
                       [](const Mesh& of, std::size_t i) { return nodes_of_line(of, i); });
    EXPECT_EQ(names_of_items(back.line_curve, back.curves), names_of_items(mesh.line_curve, mesh.curves));
  }
  if (kept.has_names && format.names & kPointNames && (mesh.order > 1 || format.extensions[0] != ".inp")) {
    EXPECT_EQ(std::ranges::equal(names_of_points(back), names_of_points(mesh),
                                 [&](const auto& a, const auto& b) {
                                   return a.first == b.first && norm(back.points[a.second] -
                                                                     mesh.points[b.second]) <= kept.rounding;
                                 }),
              true);
  }
}

/// Each format holds elements up to the order that `delquad formats` prints.
TEST(RoundTrips, OfEveryFormat) {
  const Folder folder;
  for (const MeshFormat& format : mesh_formats())
    for (const std::string& extension : format.extensions) {
      const bool has_quads = std::ranges::count(format.of_triangles, extension) == 0;
      if (!can_write(format) || !format.package.empty() || !format.has_faces) continue;
      const fs::path file = folder / ("a" + extension);
      for (int order = 1; order <= kMostOrder; ++order)
        for (const bool in_space : {false, true}) {
          SCOPED_TRACE(fmt::format("{} {} {}", extension, order, in_space));
          Mesh mesh = curved_grid(4, 3, order, in_space);
          if (order > format.most_order) {
            expect_input_error([&] { write_mesh(file, mesh); }, {extension.c_str(), "no elements of order"});
            continue;
          }
          if (!has_quads) {
            expect_input_error([&] { write_mesh(file, mesh); }, {extension.c_str(), "triangles only"});
            mesh = triangle_grid(3, 2);
          }
          if (order == 1 && in_space && format.most_order == 1) continue;  // of the plane
          if (order == 2 && format.eight_nodes == EightNodes::kAlways) mesh = of_eight_nodes(mesh);
          if (format.read == nullptr && in_space) continue;
          if (format.read == nullptr) {
            write_mesh(file, mesh);
            expect_input_error([&] { read_mesh(file); }, {"unknown kind"});
            continue;
          }
          expect_same_in(format, file, mesh, {});
          if (format.has_binary) expect_same_in(format, file, mesh, {.binary = true});
        }
      if (format.read == nullptr || !has_quads) continue;
      SCOPED_TRACE(extension);
      const auto kept = kKept.find(format.extensions[0]);
      expect_same_in(format, file, two_kinds(kept == kKept.end() || kept->second.has_blanks), {});
    }
}

TEST(MshRoundTrip, KeepsEverything) {
  const Folder folder;
  ASSERT_EQ(check_invariants(mixed()), Strings());
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
  const Folder folder;
  write_mesh(folder / "a.msh", mixed());
  const std::string text = read_text(folder / "a.msh");
  EXPECT_TRUE(holds(text, "\n2 17 \"17\"\n", "\n1 1 \"bord côté sud\"\n"));
}

TEST(MshWriter, IsTheDocumentedFormat) {
  const Folder folder;
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
  const Folder folder;
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
  const Folder folder;
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
  const Folder folder;
  const Mesh mesh = shaken(quad_grid(5, 3));
  write_mesh(folder / "a.obj", mesh);
  expect_same(mesh, read_mesh(folder / "a.obj", nullptr, Strays::kKept));
}

TEST(MeshFormats, AreToldByExtension) {
  const Folder folder;
  for (const char* name : {"a.msh", "a.obj", "A.MSH", "A.Obj"}) {
    write_mesh(folder / name, quad_grid(3, 3));
    expect_same(quad_grid(3, 3), read_mesh(folder / name));
  }
  write_mesh(folder / "a.vtu", quad_grid(3, 3));
  EXPECT_TRUE(holds(read_text(folder / "a.vtu"), "Name=\"eta\""));
  expect_input_error(
      [&] { write_mesh(folder / "a.dxf", quad_grid(1, 1)); },
      {"a.dxf", "'.dxf'",
       ".msh, .vtu, .obj, .inp, .mesh, .vtk, .e, .cgns, .med, .xdmf, .mfem, .su2, .bdf, .unv, "
       ".k, .2dm, .gr3, .nc, .ugrid, .ism, .abq, .re2, .specfem, .foam, .off, .stl, .ply or .svg"});
  expect_input_error([&] { write_mesh(folder / "a.msh.gz", quad_grid(1, 1)); }, {"a.msh.gz", "'.gz'"});
  expect_input_error(
      [&] {
        write_mesh(folder / "a.obj", quad_grid(1, 1), {true, MshCurves::kAll});
      },
      {"a.obj", "binary", ".msh"});
  expect_input_error([&] { read_mesh(folder / "a.xyz"); },
                     {"a.xyz", ".msh, .vtu, .obj, .inp, .mesh, .e, .mfem, .bdf, "});
  write_mesh(folder / "a.svg", quad_grid(3, 3));
  EXPECT_TRUE(holds(read_text(folder / "a.svg"), "<svg"));
}

}  // namespace
}  // namespace delquad
