// SPDX-License-Identifier: GPL-3.0-or-later
#include "delquad/hexahedra.h"
#include "io/mesh_formats.h"
#include "tests/support/files.h"
#include "tests/support/shapes.h"

namespace delquad {
namespace {

/// Two volumes with named faces and curves.
Mesh solid() {
  Mesh section = quad_grid(3, 2);
  section.regions = {{1, {"steel"}}, {2, {"copper"}}};
  section.quad_region = {0, 0, 1, 0, 0, 1};
  section.named_points = {{0, {1, {"tip"}}}};
  return extrude(section, AlongVector{{0.1, 0, 2}}, {2});
}

/// The places of the corners of an element, whatever their numbers are, in millionths.
template <std::size_t N>
std::set<std::array<long, 3>> places(const Mesh& mesh, const std::array<int, N>& nodes) {
  std::set<std::array<long, 3>> all;
  for (const int v : nodes) {
    const Vec3& p = mesh.points[v];
    all.insert({std::lround(1e6 * p.x), std::lround(1e6 * p.y), std::lround(1e6 * p.z)});
  }
  return all;
}

using Cells = std::multiset<std::pair<std::string, std::set<std::array<long, 3>>>>;

template <std::size_t N>
Cells cells(const Mesh& mesh, const std::vector<std::array<int, N>>& elements,
            const std::vector<int>& entity_of, const std::vector<Entity>& entities) {
  Cells all;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::vector<std::string>& names = entities[entity_of[i]].names;
    std::string name = names.empty() ? "" : names[0];
    std::ranges::replace(name, ' ', '_');  // as Abaqus needs it
    all.emplace(std::move(name), places(mesh, elements[i]));
  }
  return all;
}

void expect_same_solid(const Mesh& back, const Mesh& mesh) {
  EXPECT_EQ(back.points.size(), mesh.points.size());
  EXPECT_EQ(cells(back, back.hexahedra, back.hex_volume, back.volumes),
            cells(mesh, mesh.hexahedra, mesh.hex_volume, mesh.volumes));
  EXPECT_EQ(cells(back, back.quads, back.quad_region, back.regions),
            cells(mesh, mesh.quads, mesh.quad_region, mesh.regions));
  EXPECT_NEAR(measure(back).volume, measure(mesh).volume, 1e-9);
  EXPECT_EQ(measure(back).unproven, 0);
  // Faces look outwards: the normals of a closed body add up to nothing.
  Vec3 sum;
  for (const auto& [a, b, c, d] : back.quads)
    sum = sum + cross(back.points[c] - back.points[a], back.points[d] - back.points[b]);
  EXPECT_LT(norm(sum), 1e-9);
}

/// Whether hexahedra are read from files of this kind, whose library may be missing.
bool is_read(const std::string& kind) {
  constexpr std::array kKinds = {".msh", ".vtu", ".inp", ".e"};
  return std::ranges::any_of(mesh_formats(), [&](const MeshFormat& format) {
    return format.extensions[0] == kind && format.read != nullptr && std::ranges::count(kKinds, kind) > 0;
  });
}

TEST(HexahedraFiles, AreReadFromEveryFormatThatIsRead) {
  const Folder folder;
  const Mesh mesh = solid();
  int n_read = 0;
  for (const MeshFormat& format : mesh_formats()) {
    if (!is_read(format.extensions[0])) continue;
    SCOPED_TRACE(format.extensions[0]);
    ++n_read;
    for (const bool binary : {false, true}) {
      if (binary && !format.has_binary) continue;
      const fs::path file = folder / ("a" + format.extensions[0]),
                     again = folder / ("b" + format.extensions[0]);
      write_mesh(file, mesh, {.binary = binary});
      const Mesh back = read_mesh(file);
      expect_same_solid(back, mesh);
      write_mesh(again, back, {.binary = binary});
      expect_same_solid(read_mesh(again), mesh);
      if (format.extensions[0] == ".msh" || format.extensions[0] == ".vtu") {
        EXPECT_EQ(read_text(file), read_text(again));
      }
    }
  }
  EXPECT_GE(n_read, 3);
}

TEST(HexahedraFiles, AreConvertedFromEachToEach) {
  const Folder folder;
  Mesh mesh = solid();
  const Mesh first = mesh;
  for (const char* name : {"a.msh", "a.vtu", "a.inp", "b.vtu", "a.e", "b.inp", "c.msh"}) {
    SCOPED_TRACE(name);
    if (!is_read(fs::path(name).extension())) continue;
    write_mesh(folder / name, mesh);
    mesh = read_mesh(folder / name);
    expect_same_solid(mesh, first);
  }
}

/// Gmsh's file of two cubes, with a face of one of them that looks inwards, and no other.
std::string two_cubes(const std::string& more = "") {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 7 \"left\"\n3 9 "
         "\"body\"\n$EndPhysicalNames\n"
         "$Nodes\n12\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n9 2 0 0\n10 2 "
         "1 0\n"
         "11 2 0 1\n12 2 1 1\n$EndNodes\n$Elements\n" +
         std::string(more.empty() ? "3" : "4") +
         "\n1 3 2 7 1 1 4 8 5\n2 5 2 9 1 1 2 3 4 5 6 7 8\n3 5 2 9 1 2 9 10 3 6 11 12 7\n" + more +
         "$EndElements\n";
}

TEST(HexahedraFiles, GetTheFacesThatTheyLack) {
  const Folder folder;
  write_text(folder / "a.msh", two_cubes());
  const Mesh mesh = read_mesh(folder / "a.msh");
  EXPECT_EQ(mesh.hexahedra.size(), 2u);
  ASSERT_EQ(mesh.quads.size(), 10u);
  EXPECT_EQ(mesh.quads[0], (std::array{0, 4, 7, 3})) << "turned outwards";
  EXPECT_EQ(mesh.volumes[0].names, Strings{"body"});
  EXPECT_EQ(mesh.regions[0].names, Strings{"left"});
  EXPECT_EQ(mesh.regions[1].names, Strings());
  EXPECT_NEAR(measure(mesh).volume, 2, 1e-12);
}

TEST(HexahedraFiles, TellWhatIsLeftOut) {
  const Folder folder;
  ReadNotes notes;
  write_text(folder / "a.msh", two_cubes("4 3 2 7 1 1 2 12 11\n"));
  EXPECT_EQ(read_mesh(folder / "a.msh", &notes).quads.size(), 10u);
  EXPECT_EQ(notes, Strings{"triangles and quads that are no sides of cells are left out: 1"});
  write_text(folder / "b.msh", two_cubes("4 5 2 9 1 1 2 3 4 5 6 7 8\n"));
  expect_input_error([&] { read_mesh(folder / "b.msh"); }, {"b.msh", "expected two at most"});
  write_mesh(folder / "c.inp", read_mesh(folder / "a.msh"), {.element = "C3D20R"});
  notes.clear();
  const Mesh corners = read_mesh(folder / "c.inp", &notes);
  EXPECT_EQ(corners.points.size(), 12u);
  EXPECT_EQ(notes, Strings{"cells of order 2 are read as their corners"});
}

TEST(HexahedraFiles, KeepTheirFields) {
  const Folder folder;
  const Mesh mesh = solid();
  std::vector<double> of_cells(mesh.hexahedra.size()), of_points(mesh.points.size());
  std::iota(of_cells.begin(), of_cells.end(), 1.0);
  std::iota(of_points.begin(), of_points.end(), 1.0);
  for (const char* name : {"a.msh", "a.vtu"}) {
    write_fields(folder / name, mesh, {{"p", false, 1, of_cells}, {"t", true, 1, of_points}});
    const MeshWithFields back = read_fields(folder / name);
    ASSERT_EQ(back.fields.size(), 2u);
    std::map<std::set<std::array<long, 3>>, double> at;  // files may have another order
    for (std::size_t i = 0; i < of_cells.size(); ++i) at[places(mesh, mesh.hexahedra[i])] = of_cells[i];
    for (const MeshField& field : back.fields)
      for (std::size_t i = 0; i < field.values.size(); ++i)
        EXPECT_EQ(field.values[i],
                  field.is_of_points ? of_points[i] : at.at(places(back.mesh, back.mesh.hexahedra[i])));
  }
}

TEST(HexahedraFiles, AreNoModelsOfQuads) {
  const Folder folder;
  write_mesh(folder / "a.msh", solid());
  expect_input_error(
      [&] {
        extrude(read_mesh(folder / "a.msh"), AlongVector{{0, 0, 1}}, {1});
      },
      {"hexahedra"});
  expect_input_error([&] { write_mesh(folder / "a.obj", read_mesh(folder / "a.msh")); },
                     {"not written with cells"});
}

}  // namespace
}  // namespace delquad
