// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/files.h"

namespace delquad {
namespace {

/// Two triangles, of areas 0.5 and 1, and a line with a point of its own; tags with gaps.
const std::string kTwoTriangles22 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$Nodes\n5\n3 0 0 0\n5 1 0 0\n6 0 1 0\n9 2 2 0\n20 5 5 0\n$EndNodes\n"
    "$Elements\n3\n7 1 2 0 1 9 20\n8 2 2 0 1 3 5 6\n4 2 2 0 1 5 9 6\n$EndElements\n";

std::string msh_view(const std::string& section, const std::string& name, int step, int components,
                     const Strings& rows) {
  std::string text = "$" + section + "\n1\n\"" + name + "\"\n1\n0.5\n3\n" + std::to_string(step) + "\n" +
                     std::to_string(components) + "\n" + std::to_string(rows.size()) + "\n";
  for (const std::string& row : rows) text += row + "\n";
  return text + "$End" + section + "\n";
}

std::vector<double> values_of_triangles(const NodalValues& field) {
  std::vector<double> values;
  for (const auto& triangle : field.mesh.triangles)
    for (const int v : triangle) values.push_back(field.values[v]);
  return values;
}

TEST(NodalValues, OfNodesInAnyOrder) {
  const Folder folder;
  const auto file = write_text(folder / "a.msh", kTwoTriangles22 + msh_view("NodeData", "wanted size", 0, 1,
                                                                            {"9 4", "5 2", "3 1", "6 3"}));
  for (const char* name : {"", "wanted size"})
    EXPECT_EQ(values_of_triangles(read_values(file, name)), (std::vector<double>{1, 2, 3, 2, 4, 3})) << name;
}

TEST(NodalValues, OfElementsAreMeansByArea) {
  const Folder folder;
  const auto file =
      write_text(folder / "a.msh", kTwoTriangles22 + msh_view("ElementData", "h", 0, 1, {"4 7", "8 1"}));
  const double mean = (0.5 * 1 + 1.5 * 7) / 2;
  EXPECT_EQ(values_of_triangles(read_values(file, "h")), (std::vector<double>{1, mean, mean, mean, 7, mean}));
}

TEST(NodalValues, TheLastStepCounts) {
  const Folder folder;
  const auto file =
      write_text(folder / "a.msh",
                 kTwoTriangles22 + msh_view("NodeData", "h", 0, 1, {"3 9", "5 9", "6 9", "9 9"}) +
                     msh_view("NodeData", "h", 1, 1, {"3 1", "5 1", "6 1", "9 1"}) +
                     msh_view("NodeData", "velocity", 0, 3, {"3 1 2 3", "5 1 2 3", "6 1 2 3", "9 1 2 3"}));
  EXPECT_EQ(values_of_triangles(read_values(file, "h")), (std::vector<double>(6, 1.0)));
  expect_input_error([&] { read_values(file, ""); },
                     {"a.msh: has the fields 'h', 'velocity': say which, as a.msh:NAME"});
  expect_input_error([&] { read_values(file, "velocity"); },
                     {"the field 'velocity' has 3 components: expected 1"});
  expect_input_error([&] { read_values(file, "H"); }, {"has no field 'H': expected 'h', 'velocity'"});
}

TEST(NodalValues, EveryPointOfAFaceNeedsOne) {
  const Folder folder;
  const auto file =
      write_text(folder / "a.msh", kTwoTriangles22 + msh_view("NodeData", "h", 0, 1, {"3 1", "5 1", "6 1"}));
  expect_input_error([&] { read_values(file, ""); }, {"a.msh: the field has no value at (2, 2, 0)"});
  const auto without = write_text(folder / "b.msh", kTwoTriangles22);
  expect_input_error([&] { read_values(without, ""); }, {"b.msh: has no field"});
}

TEST(NodalValues, DamagedViewsAreRefusedWithTheirLine) {
  const Folder folder;
  const std::string whole = kTwoTriangles22 + msh_view("NodeData", "h", 0, 1, {"3 1", "5 1", "6 1", "9 1"});
  const size_t first = kTwoTriangles22.size();
  // Anywhere but within the last word, whose end is the file's.
  for (size_t cut = first + 1; cut + 4 < whole.size(); ++cut) {
    const auto file = write_text(folder / "cut.msh", whole.substr(0, cut));
    EXPECT_THROW(read_values(file, "h"), InputError) << whole.substr(0, cut);
  }
}

std::string two_triangles_vtu(const std::string& data) {
  return R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="2">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0 2 2 0</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 1 3 2</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">3 6</DataArray>
<DataArray type="Int32" Name="types" format="ascii">5 5</DataArray></Cells>)" +
         data + "</Piece></UnstructuredGrid></VTKFile>";
}

TEST(NodalValues, OfVtuFiles) {
  const Folder folder;
  const auto file = write_text(
      folder / "a.vtu",
      two_triangles_vtu(
          R"(<PointData><DataArray type="Float64" Name="h" format="ascii">1 2 3 4</DataArray></PointData>
<CellData><DataArray type="Float64" Name="of cells" format="ascii">1 7</DataArray></CellData>)"));
  EXPECT_EQ(values_of_triangles(read_values(file, "h")), (std::vector<double>{1, 2, 3, 2, 4, 3}));
  const double mean = (0.5 * 1 + 1.5 * 7) / 2;
  EXPECT_EQ(values_of_triangles(read_values(file, "of cells")),
            (std::vector<double>{1, mean, mean, mean, 7, mean}));
  expect_input_error([&] { read_values(file, "g"); }, {"a.vtu: has no field 'g': expected 'h', 'of cells'"});
  const auto wrong = write_text(
      folder / "b.vtu",
      two_triangles_vtu(
          R"(<PointData><DataArray type="Float64" Name="h" format="ascii">1 2 3</DataArray></PointData>)"));
  expect_input_error([&] { read_values(wrong, ""); }, {"b.vtu: data array 'h': 3 values for 4 points"});
}

bool same(const MeshField& a, const MeshField& b) {
  return a.name == b.name && a.is_of_points == b.is_of_points && a.n_components == b.n_components &&
         a.values == b.values;
}

TEST(MeshFields, WhatIsWrittenIsRead) {
  const Folder folder;
  for (const int order : {1, 2}) {
    Mesh mesh = curved_grid(3, 2, order, false);
    if (order == 1) mesh.triangles = {{0, 1, 3}}, mesh.triangle_region = {0};
    const std::size_t n = mesh.triangles.size() + mesh.quads.size();
    std::vector<MeshField> fields{
        {"a b", false, 1, {}}, {"v", false, 3, {}}, {"a b", true, 1, {}}, {"w", true, 9, {}}};
    for (MeshField& field : fields)
      for (std::size_t i = 0; i < (field.is_of_points ? mesh.points.size() : n) * field.n_components; ++i)
        field.values.push_back(1.0 / (1.0 + static_cast<double>(i)));
    for (const auto& [name, binary] : {std::pair("a.msh", false), {"b.msh", true}, {"c.vtu", false}}) {
      write_fields(folder / name, mesh, fields, {.binary = binary});
      const MeshWithFields read = read_fields(folder / name);
      ASSERT_EQ(read.mesh.quads, mesh.quads) << name;
      EXPECT_EQ(read.mesh.order, order);
      EXPECT_TRUE(std::ranges::equal(read.fields, fields, same)) << name;
    }
  }
  expect_input_error([&] { write_fields(folder / "a.obj", quad_grid(1, 1), {}); }, {"a.obj", ".msh or .vtu"});
}

TEST(MeshFields, StepsGapsAndRefusals) {
  const Folder folder;
  const auto of_plane =
      write_text(folder / "a.msh", kTwoTriangles22 +
                                       msh_view("NodeData", "v", 0, 2, {"3 9 9", "5 9 9", "6 9 9", "9 9 9"}) +
                                       msh_view("NodeData", "v", 1, 2, {"3 1 2", "5 1 2", "6 4 5", "9 1 2"}) +
                                       msh_view("ElementData", "h", 0, 1, {"4 7", "8 nan"}));
  MeshWithFields read = read_fields(of_plane);
  ASSERT_EQ(read.fields.size(), 2u);
  EXPECT_TRUE(std::isnan(read.fields[0].values[0]) && read.fields[0].values[1] == 7);
  EXPECT_EQ(read.fields[1].values[4], 4);
  EXPECT_TRUE(std::isnan(read.fields[1].values[8]));  // the line's own point
  // Gmsh knows no vectors of two.
  write_fields(folder / "b.msh", read.mesh, {read.fields[1]});
  const MeshField vector = read_fields(folder / "b.msh").fields[0];
  EXPECT_EQ(vector.n_components, 3);
  EXPECT_EQ(std::vector(vector.values.begin(), vector.values.begin() + 3), (std::vector<double>{1, 2, 0}));
  const auto long_view =
      write_text(folder / "c.msh", kTwoTriangles22 + msh_view("NodeData", "t", 0, 1000, {}));
  expect_input_error([&] { read_fields(long_view); }, {"c.msh: the field 't' has 1000 components"});
  Mesh mesh = curved_grid(2, 2, 2, false);
  write_serendipity(folder / "d.vtu", mesh);
  expect_input_error([&] { read_fields(folder / "d.vtu"); }, {"d.vtu: fields on quads of 8 nodes"});
}

}  // namespace
}  // namespace delquad
