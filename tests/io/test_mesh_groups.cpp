// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cell_view.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

TEST(MeshGroups, HaveTheNodesOfTheirLines) {
  const Mesh mesh = curved_grid(2, 1, 2, false);
  const std::vector<MeshGroup> groups = mesh_groups(mesh, {one_line_label});
  const auto named = std::ranges::find(groups, "south", &MeshGroup::name);
  ASSERT_NE(named, groups.end());
  EXPECT_EQ(nodes_of_group(mesh, *named), (std::vector<int>{0, 1, 2, 3, 4}));
  const auto point = std::ranges::find(groups, 0, &MeshGroup::dim);
  ASSERT_NE(point, groups.end());
  EXPECT_EQ(nodes_of_group(mesh, *point), (std::vector<int>{4}));
}

TEST(MeshGroups, MoreNumbersThanAFormatHoldsAreRefused) {
  const Mesh mesh = quad_grid(2, 2);
  EXPECT_NO_THROW(require_numbers("a.bdf", "Nastran", mesh, 12));
  expect_input_error([&] { require_numbers("a.bdf", "Nastran", mesh, 11); },
                     {"a.bdf: Nastran holds no numbers above 11: there are 12 elements"});
  expect_input_error([&] { require_numbers("a.bdf", "Nastran", mesh, 8); }, {"there are 9 nodes"});
}

TEST(RenamedInFile, TellsWhatNoCommentTells) {
  Mesh mesh = quad_grid(1, 1);
  for (const char* name : {"a.msh", "a.cgns", "a.med", "a.e", "a.vtk"})
    EXPECT_EQ(renamed_in_file(name, mesh), Strings());
  mesh.curves[0].names = {"in/out"};
  mesh.curves[1].names = {"c\xc3\xb4t\xc3\xa9 sud"};
  EXPECT_EQ(renamed_in_file("a.cgns", mesh), Strings{"curve \"in/out\" is in_out"});
  EXPECT_EQ(renamed_in_file("a.med", mesh), Strings{"curve \"c\xc3\xb4t\xc3\xa9 sud\" is c__t__ sud"});
  EXPECT_EQ(renamed_in_file("a.e", mesh), Strings());
  EXPECT_EQ(renamed_in_file("a.vtk", mesh),
            Strings{"curve \"c\xc3\xb4t\xc3\xa9 sud\" is c\xc3\xb4t\xc3\xa9_sud"});
  EXPECT_EQ(renamed_in_file("a.su2", mesh), Strings()) << "its comments tell";
  mesh.regions[0].names = {"in/out"};
  EXPECT_EQ(renamed_in_file("a.msh", mesh), Strings{"region \"in/out\" is in/out_2"});
  mesh.regions[0].names = {std::string(90, 'x')};
  EXPECT_EQ(renamed_in_file("a.e", mesh),
            Strings{"region \"" + std::string(90, 'x') + "\" is " + std::string(70, 'x')});
}

TEST(VtkLegacy, CurvesOfOneNameAreOneArray) {
  const Folder folder;
  Mesh mesh = quad_grid(1, 1);
  mesh.curves[0].names = mesh.curves[2].names = {"a wall"};
  mesh.curves[1].names = {"a_wall"};
  write_mesh(folder / "a.vtk", mesh);
  const std::string text = read_text(folder / "a.vtk");
  EXPECT_TRUE(
      holds(text, "FIELD FieldData 4\n", "curve_a_wall_2 1 2 int\n1\n3\n", "curve_a_wall 1 1 int\n2\n"));
}

TEST(Xdmf, IsWrittenWithItsNumbersOrNotAtAll) {
  const Folder folder;
  fs::create_directory(folder / "a.xdmf");
  expect_input_error([&] { write_mesh(folder / "a.xdmf", quad_grid(1, 1)); }, {"a.xdmf"});
  EXPECT_EQ(folder.names(), Strings{"a.xdmf"});
}

}  // namespace
}  // namespace delquad
