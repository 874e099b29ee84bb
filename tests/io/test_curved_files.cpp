// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/check_mesh.h"
#include "io/formats/vtu.h"
#include "io/mesh_formats.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

std::vector<Strings> names(const std::vector<Entity>& entities) {
  std::vector<Strings> all;
  for (const Entity& entity : entities) all.push_back(entity.names);
  return all;
}

/// A quad of eight nodes, whose map has its middle at (0.5 (2 + 0.3), ...).
const std::string kEightMsh =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n8\n1 0 0 0\n2 2 0 0\n3 2 2 0\n4 0 2 0\n5 1 0.4 0\n6 2 1 "
    "0\n"
    "7 1 2 0\n8 0 1 0\n$EndNodes\n$Elements\n1\n1 16 2 0 1 1 2 3 4 5 6 7 8\n$EndElements\n";
const std::string kEightVtu =
    R"(<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece><Points><DataArray type="Float32">)"
    R"(0 0 0 2 0 0 2 2 0 0 2 0 1 0.4 0 2 1 0 1 2 0 0 1 0</DataArray></Points><Cells>)"
    R"(<DataArray Name="connectivity">0 1 2 3 4 5 6 7</DataArray><DataArray Name="offsets">8</DataArray>)"
    R"(<DataArray Name="types">23</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>)";

TEST(CurvedFiles, QuadsOfEightNodesGetTheirMiddle) {
  const Folder folder;
  for (const Mesh& mesh : {read_mesh(write_text(folder / "a.msh", kEightMsh)),
                           read_mesh(write_text(folder / "a.vtu", kEightVtu))}) {
    EXPECT_EQ(mesh.order, 2);
    ASSERT_EQ(mesh.points.size(), 9u);
    EXPECT_EQ(mesh.quad_nodes, (std::vector<int>{4, 5, 6, 7, 8}));
    // By the shape functions of eight nodes at the middle: 1/2 for sides, -1/4 for corners.
    EXPECT_NEAR(mesh.points[8].x, 1, 1e-7);
    EXPECT_NEAR(mesh.points[8].y, 0.5 * 4.4 - 0.25 * 4, 1e-7);
  }
}

TEST(CurvedFiles, ElementsOfSeveralOrdersAreRefused) {
  const Folder folder;
  std::string text = kEightMsh;
  text.replace(text.find("\n1\n1 16"), 3, "\n2\n2 1 2 0 1 1 2\n");
  expect_input_error([&] { read_mesh(write_text(folder / "a.msh", text)); },
                     {"a.msh:18: ", "order 2 beside elements of order 1"});
  text = kEightVtu;
  text.replace(text.find("6 7<"), 3, "6 7 0 1");
  text.replace(text.find(">8<"), 2, ">8 10");
  text.replace(text.find(">23<"), 3, ">23 3");
  expect_input_error([&] { read_mesh(write_text(folder / "a.vtu", text)); },
                     {"a.vtu: ", "order 1 beside elements of order 2"});
}

TEST(CurvedFiles, CellsHaveAsManyPointsAsTheirTypeSays) {
  const Folder folder;
  for (const auto& [type, expected] : {std::pair{"28", "expected 9"},
                                       {"70", "expected 4, 9, 16 or 25"},
                                       {"21", "expected 3"},
                                       {"68", "expected 2 to 5"}}) {
    std::string text = kEightVtu;
    text.replace(text.find(">23<") + 1, 2, type);
    expect_input_error([&] { read_mesh(write_text(folder / "a.vtu", text)); },
                       {"a.vtu: ", "has 8 points", expected});
  }
}

TEST(CurvedFiles, FieldsOnCurvedElementsAreRefused) {
  const Folder folder;
  write_mesh(folder / "a.vtu", curved_grid(2, 2, 3, false));
  expect_input_error([&] { read_values(folder / "a.vtu", "eta"); }, {"a.vtu", "order 3", "expected order 1"});
  expect_input_error(
      [&] {
        read_values(
            write_text(folder / "a.msh",
                       kEightMsh + "$ElementData\n1\n\"h\"\n1\n0\n3\n0\n1\n1\n1 0.5\n$EndElementData\n"),
            "h");
      },
      {"a.msh", "quads of 8 nodes"});
}

/// Files of eight nodes have no others, and give the same places where the middle one is where eight have it.
TEST(Serendipity, FilesOfEightNodesComeBack) {
  const Folder folder;
  for (const bool in_space : {false, true}) {
    Mesh mesh = curved_grid(4, 3, 2, in_space);
    for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
      const std::vector<int> v = nodes_of_quad(mesh, q);
      const auto at = [&](int k) { return mesh.points[v[k]]; };
      mesh.points[v[4]] = middle_of_eight({at(0), at(2), at(8), at(6)}, {at(1), at(5), at(7), at(3)});
    }
    for (const auto& [name, binary] : {std::pair{"a.msh", false}, {"a.msh", true}, {"a.vtu", false}}) {
      write_serendipity(folder / name, mesh, {binary, MshCurves::kAll});
      const Mesh back = read_mesh(folder / name);
      ASSERT_EQ(back.order, 2);
      EXPECT_EQ(back.points.size(), mesh.points.size());
      EXPECT_EQ(back.line_nodes.size(), mesh.line_nodes.size());
      EXPECT_EQ(names(back.regions), names(mesh.regions));
      ASSERT_EQ(back.named_points.size(), 1u);
      EXPECT_EQ(back.points[back.named_points[0].point], mesh.points[mesh.named_points[0].point]);
      ASSERT_EQ(back.quads.size(), mesh.quads.size());
      for (std::size_t q = 0; q < mesh.quads.size(); ++q)
        for (int k = 0; k < 9; ++k)
          EXPECT_EQ(back.points[nodes_of_quad(back, q)[k]], mesh.points[nodes_of_quad(mesh, q)[k]]);
    }
    write_serendipity(folder / "a.msh", mesh);
    EXPECT_TRUE(holds(read_text(folder / "a.msh"), "\n2 1 16 "));
  }
}

TEST(Serendipity, IsRefusedElsewhere) {
  const Folder folder;
  expect_input_error([&] { write_serendipity(folder / "a.msh", curved_grid(1, 1, 3, false)); },
                     {"a.msh", "order 3", "--order 2"});
  expect_input_error([&] { write_serendipity(folder / "a.vtk", curved_grid(1, 1, 2, false)); },
                     {"a.vtk", "8 nodes", ".msh, .vtu, .inp or .bdf"});
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace delquad
