// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_formats.h"
#include "metrics/cells.h"
#include "tests/support/cells.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

/// Names and places of all cells and faces, whatever their order, in millionths.
std::multiset<std::pair<std::string, std::set<std::array<long, 3>>>> contents(const Mesh& mesh) {
  std::multiset<std::pair<std::string, std::set<std::array<long, 3>>>> all;
  const auto add = [&](const auto& elements, const std::vector<int>& entity_of,
                       const std::vector<Entity>& entities) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      std::set<std::array<long, 3>> places;
      for (const int v : elements[i]) {
        const Vec3& p = mesh.points[v];
        places.insert({std::lround(1e6 * p.x), std::lround(1e6 * p.y), std::lround(1e6 * p.z)});
      }
      all.emplace(entities[entity_of[i]].names.at(0), std::move(places));
    }
  };
  for_each_shape(mesh, [&](const SolidShape&, const auto& cells, const auto& volumes) {
    add(cells, volumes, mesh.volumes);
  });
  add(mesh.triangles, mesh.triangle_region, mesh.regions);
  add(mesh.quads, mesh.quad_region, mesh.regions);
  return all;
}

void expect_same_cells(const Mesh& back, const Mesh& mesh) {
  EXPECT_EQ(contents(back), contents(mesh));
  EXPECT_EQ(defects_of_cells(back), Strings());
  EXPECT_NEAR(measure(back).volume, measure(mesh).volume, 1e-12);
}

bool is_missing(const std::string& kind) {
  return std::ranges::any_of(mesh_formats(), [&](const MeshFormat& format) {
    return format.extensions[0] == kind && !format.package.empty();
  });
}

TEST(CellFiles, AreReadFromEveryFormatThatIsRead) {
  const Folder folder;
  for (const char* name : {"a.msh", "a.msh2", "a.vtu", "a.e", "a.inp"})
    for (const bool binary : {false, true}) {
      const std::string kind = fs::path(name).extension();
      if ((binary && !kind.starts_with(".msh")) || is_missing(kind)) continue;
      SCOPED_TRACE(name);
      const Mesh mesh = mixed_solid(kind != ".inp");
      write_mesh(folder / name, mesh, {.binary = binary});
      const Mesh back = read_mesh(folder / name);
      expect_same_cells(back, mesh);
      write_mesh(folder / "b.vtu", back);
      expect_same_cells(read_mesh(folder / "b.vtu"), mesh);
    }
}

TEST(CellFiles, KeepFieldsOfCells) {
  const Folder folder;
  const Mesh mesh = mixed_solid();
  std::vector<double> values(n_solids(mesh));
  std::iota(values.begin(), values.end(), 1.0);
  for (const char* name : {"a.msh", "a.vtu"}) {
    write_fields(folder / name, mesh, {{"p", false, 1, values}});
    const MeshWithFields back = read_fields(folder / name);
    ASSERT_EQ(back.fields.size(), 1u);
    for (std::size_t i = 0; i < values.size(); ++i) {
      // The file may have another order, of volumes; the first node of a cell stays.
      const Vec3 at = back.mesh.points[solid_at(back.mesh, i).nodes.back()];
      const double value = back.fields[0].values[i];
      EXPECT_EQ(at, mesh.points[solid_at(mesh, static_cast<std::size_t>(value) - 1).nodes.back()]);
    }
  }
}

TEST(CellFiles, OfOtherProgramsGetTheFacesThatTheyLack) {
  const Folder folder;
  ReadNotes notes;
  // A tetrahedron of order 2 with a side, and a triangle that is none.
  write_text(
      folder / "a.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n11\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
      "5 .5 0 0\n6 .5 .5 0\n7 0 .5 0\n8 0 0 .5\n9 0 .5 .5\n10 .5 0 .5\n11 2 0 0\n$EndNodes\n$Elements\n"
      "3\n1 11 2 7 7 1 2 3 4 5 6 7 8 9 10\n2 2 2 1 1 1 2 11\n3 9 2 2 2 1 2 3 5 6 7\n$EndElements\n");
  const Mesh mesh = read_mesh(folder / "a.msh", &notes);
  EXPECT_EQ(mesh.tetrahedra.size(), 1u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(mesh.points.size(), 4u);
  EXPECT_EQ(defects_of_cells(mesh), Strings());
  EXPECT_EQ(notes, (Strings{"cells of order 2 are read as their corners",
                            "triangles and quads that are no sides of cells are left out: 1"}));
}

TEST(CellFiles, HaveTheVersionThatIsAsked) {
  const Folder folder;
  write_mesh(folder / "a.msh", mixed_solid(), {.is_msh22 = true});
  write_mesh(folder / "a.msh2", mixed_solid());
  EXPECT_EQ(read_text(folder / "a.msh"), read_text(folder / "a.msh2"));
  expect_input_error([&] { write_mesh(folder / "a.vtu", mixed_solid(), {.is_msh22 = true}); },
                     {"a.vtu: --msh-version is for .msh"});
}

TEST(CellFiles, OfAbaqusHaveMiddleNodesOfTheMesh) {
  const Folder folder;
  Mesh mesh = mixed_solid(false);
  const auto [a, b, c, d] = mesh.tetrahedra[0];
  mesh.middle_nodes = {{{std::min(a, b), std::max(a, b)}, {0.123, 0.456, 0.789}}};
  write_mesh(folder / "a.inp", mesh, {.element = "C3D10"});
  EXPECT_TRUE(holds(read_text(folder / "a.inp"), ", 0.123, 0.456, 0.789\n"));
}

TEST(CellFiles, OfAbaqusHaveNoPyramids) {
  const Folder folder;
  for (const char* name : {"a.inp", "a.unv"})
    expect_input_error(
        [&] { write_mesh(folder / name, mixed_solid()); },
        {name, "has no pyramids, and there are 5 (the first at (1.5, 0.5, 0.5))", ".msh, .vtu"});
  EXPECT_EQ(folder.names(), Strings());
}

TEST(CellFiles, OfAbaqusHaveOneOrder) {
  const Folder folder;
  const Mesh mesh = mixed_solid(false);
  for (const auto& [element, types] : {std::pair<std::string, Strings>{"", {"C3D8", "C3D6", "C3D4"}},
                                       {"C3D8I", {"C3D8I", "C3D6", "C3D4"}},
                                       {"C3D10", {"C3D20", "C3D15", "C3D10"}},
                                       {"C3D20R", {"C3D20R", "C3D15", "C3D10"}},
                                       {"DC3D4", {"DC3D8", "DC3D6", "DC3D4"}}}) {
    write_mesh(folder / "a.inp", mesh, {.element = element});
    const std::string text = read_text(folder / "a.inp");
    for (const std::string& type : types) EXPECT_TRUE(holds(text, "TYPE=" + type + ",")) << element;
    EXPECT_EQ(contents(read_mesh(folder / "a.inp")), contents(mesh));
  }
}

/// Cells of SU2, MFEM or UGRID by their number of nodes, in the order of Mesh, from lines of numbers.
double volume_of(const Mesh& mesh, const std::vector<int>& nodes, const std::string& order, int first) {
  std::vector<Vec3> at(nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k)
    at[order.empty() ? k : static_cast<std::size_t>(order[k] - '0')] = mesh.points[nodes[k] - first];
  EXPECT_TRUE(is_positive(at));
  return signed_volume(at);
}

std::vector<std::vector<double>> numbers_after(const std::string& text, const std::string& title) {
  std::istringstream lines(text.substr(text.find(title) + title.size()));
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::vector<double> row;
    for (double x = 0; words >> x;) row.push_back(x);
    if (!words.eof()) break;
    if (!row.empty()) rows.push_back(row);
  }
  return rows;
}

TEST(CellFiles, OfSu2AndMfemHaveTheirOrders) {
  const Folder folder;
  const Mesh mesh = mixed_solid();
  write_mesh(folder / "a.su2", mesh);
  write_mesh(folder / "a.mfem", mesh);
  const std::string su2 = read_text(folder / "a.su2"), mfem = read_text(folder / "a.mfem");
  double volume = 0;
  for (const auto& row : numbers_after(su2, "NELEM= 10\n")) {
    if (row.size() < 6) break;
    const std::vector<int> nodes(row.begin() + 1, row.end() - 1);
    volume += volume_of(mesh, nodes, row[0] == 13 ? "021354" : "", 0);  // VTK's wedge
  }
  EXPECT_NEAR(volume, 3, 1e-12);
  EXPECT_TRUE(holds(su2, "MARKER_TAG= floor\nMARKER_ELEMS= 2\n9 "));
  volume = 0;
  const std::map<int, std::size_t> corners = {{4, 4}, {5, 8}, {6, 6}, {7, 5}};
  for (const auto& row : numbers_after(mfem, "elements\n10\n")) {
    ASSERT_EQ(row.size(), 2 + corners.at(static_cast<int>(row[1])));
    volume += volume_of(mesh, {row.begin() + 2, row.end()}, "", 0);
  }
  EXPECT_NEAR(volume, 3, 1e-12);
  EXPECT_TRUE(holds(mfem, "dimension\n3\n"));
  EXPECT_EQ(numbers_after(mfem, "boundary\n").size(), 1 + mesh.triangles.size() + mesh.quads.size());
}

TEST(CellFiles, OfUgridHaveItsOrders) {
  const Folder folder;
  const Mesh mesh = mixed_solid();
  write_mesh(folder / "a.ugrid", mesh);
  const auto rows = numbers_after(read_text(folder / "a.ugrid"), "");
  const std::vector<double> head = {17, 6, 11, 2, 5, 2, 1};
  ASSERT_EQ(rows.at(0), head);
  double volume = 0, skin = 0;
  std::size_t at = 1 + mesh.points.size();
  for (std::size_t i = 0; i < 17; ++i, ++at) {
    std::vector<Vec3> p;
    for (const double v : rows.at(at)) p.push_back(mesh.points[static_cast<std::size_t>(v) - 1]);
    p.push_back({1, 0.5, 0.5});  // to which faces look
    skin += signed_volume(p);
  }
  EXPECT_NEAR(skin, 3, 1e-12);
  for (std::size_t i = 0; i < 17; ++i, ++at) EXPECT_EQ(rows.at(at).size(), 1u);
  for (; at < rows.size(); ++at)
    volume += volume_of(mesh, {rows[at].begin(), rows[at].end()}, rows[at].size() == 5 ? "10423" : "", 1);
  EXPECT_NEAR(volume, 3, 1e-12);
  EXPECT_EQ(read_text(folder / "a.mapbc"), "2\n1 0 rest\n2 0 floor\n");
  write_mesh(folder / "a.b8.ugrid", mesh);
  const std::string bytes = read_text(folder / "a.b8.ugrid");
  EXPECT_EQ(bytes.substr(0, 8), std::string("\0\0\0\x11\0\0\0\x06", 8));
  EXPECT_EQ(bytes.size(), 4 * 7 + 24 * 17 + 4 * (6 * 3 + 11 * 4 + 17 + 2 * 4 + 5 * 5 + 2 * 6 + 8));
  expect_input_error([&] { write_mesh(folder / "b.ugrid", quad_grid(2, 2)); }, {"b.ugrid", "volumes alone"});
}

TEST(CellFiles, AreWrittenInEveryFormatOfCells) {
  for (const MeshFormat& format : mesh_formats())
    if (format.has_cells && format.package.empty()) {
      const Folder own;  // OpenFOAM's lists lie beside the file
      write_mesh(own / ("a" + format.extensions[0]), mixed_solid(format.has_pyramids));
      std::uintmax_t bytes = 0;
      for (const auto& file : fs::recursive_directory_iterator(own.path()))
        bytes += file.is_regular_file() ? file.file_size() : 0;
      EXPECT_GT(bytes, 500u) << format.extensions[0];
    }
}

}  // namespace
}  // namespace delquad
