#include <gtest/gtest.h>

#include "io/entity_names.h"
#include "io/mesh_io.h"
#include "tests/support/curved_grid.h"
#include "tests/support/expect_input_error.h"
#include "tests/support/temporary_folder.h"

namespace delquad {
namespace {

using testing_support::curved_grid;
using testing_support::quad_grid;
using testing_support::read_text;
using testing_support::TemporaryFolder;
using Names = std::vector<std::string>;

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
    EXPECT_EQ(renamed_in_file(name, mesh), Names());
  mesh.curves[0].names = {"in/out"};
  mesh.curves[1].names = {"c\xc3\xb4t\xc3\xa9 sud"};
  EXPECT_EQ(renamed_in_file("a.cgns", mesh), Names{"curve \"in/out\" is in_out"});
  EXPECT_EQ(renamed_in_file("a.med", mesh), Names{"curve \"c\xc3\xb4t\xc3\xa9 sud\" is c__t__ sud"});
  EXPECT_EQ(renamed_in_file("a.e", mesh), Names());
  EXPECT_EQ(renamed_in_file("a.vtk", mesh),
            Names{"curve \"c\xc3\xb4t\xc3\xa9 sud\" is c\xc3\xb4t\xc3\xa9_sud"});
  EXPECT_EQ(renamed_in_file("a.su2", mesh), Names()) << "its comments tell";
  mesh.regions[0].names = {"in/out"};
  EXPECT_EQ(renamed_in_file("a.msh", mesh), Names{"region \"in/out\" is in/out_2"});
  mesh.regions[0].names = {std::string(90, 'x')};
  EXPECT_EQ(renamed_in_file("a.e", mesh),
            Names{"region \"" + std::string(90, 'x') + "\" is " + std::string(70, 'x')});
}

TEST(VtkLegacy, CurvesOfOneNameAreOneArray) {
  const TemporaryFolder folder;
  Mesh mesh = quad_grid(1, 1);
  mesh.curves[0].names = mesh.curves[2].names = {"a wall"};
  mesh.curves[1].names = {"a_wall"};
  write_mesh(folder / "a.vtk", mesh);
  const std::string text = read_text(folder / "a.vtk");
  EXPECT_NE(text.find("FIELD FieldData 4\n"), std::string::npos) << text;
  EXPECT_NE(text.find("curve_a_wall_2 1 2 int\n1\n3\n"), std::string::npos) << text;
  EXPECT_NE(text.find("curve_a_wall 1 1 int\n2\n"), std::string::npos) << text;
}

TEST(Xdmf, IsWrittenWithItsNumbersOrNotAtAll) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "a.xdmf");
  expect_input_error([&] { write_mesh(folder / "a.xdmf", quad_grid(1, 1)); }, {"a.xdmf"});
  EXPECT_EQ(folder.names(), Names{"a.xdmf"});
}

}  // namespace
}  // namespace delquad
