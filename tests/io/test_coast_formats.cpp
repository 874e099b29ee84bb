// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/boundary_chains.h"
#include "io/mesh_formats.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

using Nodes = std::vector<int>;

/// Three by three cells, numbered by rows, without the middle one, whose sides have the name.
Mesh ring(const std::string& hole) {
  Mesh mesh = quad_grid(3, 3);
  mesh.quads.erase(mesh.quads.begin() + 4);
  mesh.quad_region.pop_back();
  for (const auto& line : {std::array{5, 6}, {6, 10}, {10, 9}, {9, 5}}) {
    mesh.lines.push_back(line);
    mesh.line_curve.push_back(4);
  }
  mesh.curves.push_back({5, {hole}});
  return mesh;
}

bool has_netcdf() {
  return std::ranges::any_of(mesh_formats(), [](const MeshFormat& format) {
    return format.extensions[0] == ".nc" && format.package.empty();
  });
}

TEST(JoinedEdges, EndWhereSeveralGoOn) {
  EXPECT_EQ(join_edges({{3, 1}, {1, 2}, {5, 3}}), (std::vector<Nodes>{{5, 3, 1, 2}}));
  EXPECT_EQ(join_edges({{2, 0}, {0, 1}, {1, 2}}), (std::vector<Nodes>{{0, 1, 2, 0}}));
  // Two rings that touch in 0.
  EXPECT_EQ(join_edges({{0, 1}, {1, 2}, {2, 0}, {0, 3}, {3, 4}, {4, 0}}),
            (std::vector<Nodes>{{0, 1, 2, 0}, {0, 3, 4, 0}}));
}

TEST(CoastPieces, OpenOnesComeFirstAndHolesAreIslands) {
  Mesh mesh = ring("rock");
  mesh.curves[1].names = {"Open sea"};
  mesh.curves[2].names = mesh.curves[3].names = {"shore"};
  const std::vector<CoastPiece> pieces = coast_pieces(mesh);
  ASSERT_EQ(pieces.size(), 4u);
  EXPECT_EQ(pieces[0].nodes, (Nodes{3, 7, 11, 15}));
  EXPECT_EQ(pieces[0].name, "Open sea");
  EXPECT_TRUE(pieces[0].open);
  EXPECT_EQ(pieces[1].nodes, (Nodes{0, 1, 2, 3}));
  EXPECT_EQ(pieces[2].nodes, (Nodes{15, 14, 13, 12, 8, 4, 0}));
  EXPECT_EQ(pieces[2].name, "shore");
  EXPECT_EQ(pieces[3].nodes, (Nodes{5, 9, 10, 6}));  // the mesh on the left
  EXPECT_TRUE(pieces[3].island && !pieces[3].open);
}

TEST(CoastPieces, ARingOfOneNameIsTwoPieces) {
  Mesh mesh = ring("opening");
  for (int k = 0; k < 4; ++k) mesh.curves[k].names = {"shore"};
  const std::vector<CoastPiece> pieces = coast_pieces(mesh);
  ASSERT_EQ(pieces.size(), 4u);
  EXPECT_EQ(pieces[0].nodes, (Nodes{5, 9, 10}));
  EXPECT_EQ(pieces[1].nodes, (Nodes{10, 6, 5}));
  EXPECT_TRUE(pieces[1].open && !pieces[1].island);
  EXPECT_EQ(pieces[2].nodes, (Nodes{0, 1, 2, 3, 7, 11, 15}));
  EXPECT_EQ(pieces[3].nodes, (Nodes{15, 14, 13, 12, 8, 4, 0}));
}

TEST(Gr3, IsTheDocumentedFormat) {
  const Folder folder;
  Mesh mesh = quad_grid(1, 1, 2, 0.5);
  mesh.curves[1].names = {"the open"};
  mesh.unit = "m";
  write_mesh(folder / "a.gr3", mesh);
  EXPECT_EQ(read_text(folder / "a.gr3"),
            "quad mesh by Delquad, lengths in m\n1 4\n1 0 0 0\n2 2 0 0\n3 0 0.5 0\n4 2 0.5 0\n1 4 1 2 4 3\n"
            "1 = number of open boundaries\n2 = total number of open boundary nodes\n"
            "2 = number of nodes of open boundary the open\n2\n4\n"
            "3 = number of land boundaries\n6 = total number of land boundary nodes\n"
            "2 0 = number of nodes of land boundary south\n1\n2\n"
            "2 0 = number of nodes of land boundary north\n4\n3\n"
            "2 0 = number of nodes of land boundary west\n3\n1\n");
}

/// Triangles around a barrier from (1, 1) to (3, 1), whose node (2, 1) is there twice.
Mesh barrier(const std::string& name) {
  Mesh mesh = triangle_grid(4, 2, 4, 2);
  const int other = static_cast<int>(mesh.points.size());
  mesh.points.push_back(mesh.points[7]);
  for (auto& triangle : mesh.triangles)
    if (mesh.points[triangle[0]].y + mesh.points[triangle[1]].y + mesh.points[triangle[2]].y > 3)
      std::ranges::replace(triangle, 7, other);
  for (const auto& line : {std::array{6, 7}, {7, 8}, {8, other}, {other, 6}}) {
    mesh.lines.push_back(line);
    mesh.line_curve.push_back(4);
  }
  mesh.curves.push_back({5, {name}});
  return mesh;
}

TEST(Gr3, BarriersInTheWaterAreIslands) {
  const Folder folder;
  for (const char* name : {"a.gr3", "a.14"}) {
    write_mesh(folder / name, barrier("mole"));
    const std::string text = read_text(folder / name);
    EXPECT_TRUE(
        holds(text, "\n4 1 = number of nodes of island boundary mole\n", "5 = number of land boundaries\n"));
  }
  write_mesh(folder / "a.2dm", barrier("mole"));
  const std::string text = read_text(folder / "a.2dm");
  EXPECT_TRUE(text.find("NS 7 16 9 8 -7 mole\n") != std::string::npos ||
              text.find("NS 7 8 9 16 -7 mole\n") != std::string::npos)
      << text;
}

TEST(Adcirc, WeirsArePairsOfNodes) {
  const Folder folder;
  write_mesh(folder / "a.14", barrier("dam_weir_-2.5"));
  const std::string text = read_text(folder / "a.14");
  EXPECT_TRUE(holds(text, "1 24 = number of pairs of nodes of weir dam_weir_-2.5\n"));
  EXPECT_TRUE(text.find("\n8 16 -2.5 1 1\n") != std::string::npos ||
              text.find("\n16 8 -2.5 1 1\n") != std::string::npos)
      << text;
  EXPECT_TRUE(holds(text, "18 = total number of land boundary nodes"));
  write_mesh(folder / "a.gr3", barrier("dam_weir_-2.5"));
  EXPECT_TRUE(holds(read_text(folder / "a.gr3"), "island boundary dam_weir"));
}

TEST(CoastFormats, HoldDepths) {
  const Folder folder;
  Mesh mesh = quad_grid(1, 1);
  mesh.points[3].z = -2.5;
  write_mesh(folder / "a.gr3", mesh);
  EXPECT_TRUE(holds(read_text(folder / "a.gr3"), "\n3 0 1 0\n4 1 1 2.5\n"));
  write_mesh(folder / "a.2dm", mesh);
  EXPECT_TRUE(holds(read_text(folder / "a.2dm"), "\nND 4 1 1 -2.5\n"));
  if (has_netcdf()) write_mesh(folder / "a.nc", mesh);
  EXPECT_NO_THROW(check_depths("b.nc"));
  expect_input_error([] { check_depths("b.msh"); }, {"b.msh: no depths", ".2dm, .gr3 or .nc"});
}

TEST(CoastFormats, MissDepthsAndOpenSides) {
  Mesh mesh = quad_grid(1, 1);
  const auto missing = [&](const char* path) { return missing_in_file(path, mesh); };
  ASSERT_EQ(missing("a.gr3").size(), 2u);
  EXPECT_TRUE(holds(missing("a.gr3")[0], "a.gr3: all depths are 0", "--depth"));
  EXPECT_TRUE(holds(missing("a.gr3")[1], "a.gr3: no side is open", "'open'"));
  EXPECT_EQ(missing("a.14").size(), 2u);
  EXPECT_EQ(missing("a.2dm").size(), 1u);
  EXPECT_EQ(missing("a.msh").size(), 0u);
  EXPECT_EQ(missing_in_file("a.2dm", mesh, true).size(), 0u);
  mesh.points[3].z = -2.5;
  EXPECT_EQ(missing("a.gr3").size(), 1u);
  mesh.curves[0].names = {"Open sea"};
  EXPECT_EQ(missing("a.gr3").size(), 0u);
}

TEST(Adcirc, TakesTrianglesOnly) {
  const Folder folder;
  write_mesh(folder / "fort.14", triangle_grid(2, 2));
  write_mesh(folder / "a.gr3", triangle_grid(2, 2));
  EXPECT_EQ(read_text(folder / "fort.14"), read_text(folder / "a.gr3"));
  expect_input_error([&] { write_mesh(folder / "fort.14", quad_grid(2, 2)); },
                     {"fort.14: '.14' has triangles only", "--triangles"});
  write_mesh(folder / "fort.14", quad_grid(2, 2), {.triangles = true});
  EXPECT_EQ(read_mesh(folder / "fort.14").triangles.size(), 8u);
}

TEST(Sms, NodeStringsOfOneNameHaveTheirOwn) {
  const Folder folder;
  Mesh mesh = quad_grid(1, 1);
  mesh.curves[0].names = mesh.curves[2].names = {"the shore"};
  write_mesh(folder / "a.2dm", mesh);
  EXPECT_EQ(read_text(folder / "a.2dm"),
            "MESH2D\nMESHNAME \"quad mesh by Delquad\"\nNUM_MATERIALS_PER_ELEM 1\nE4Q 1 1 2 4 3 1\n"
            "ND 1 0 0 0\nND 2 1 0 0\nND 3 0 1 0\nND 4 1 1 0\n"
            "NS 1 -2 the_shore\nNS 4 -3 the_shore_2\nNS 2 -4 east\nNS 3 -1 west\n"
            "BEGPARAMDEF\nMAT 1 \"inside\"\nENDPARAMDEF\n");
}

TEST(CoastFormats, DepthsAreLeftOutAndMistakesAreLocated) {
  const Folder folder;
  const Mesh mesh = read_mesh(write_text(
      folder / "a.2dm", "MESH2D\nE3T 1 7 8 9 5\nND 7 0 0 -3.5\nND 8 1 0 2\nND 9 0 1 1e3\nMAT 5 \"mud\"\n"));
  EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.regions[0].tag, 5);
  EXPECT_EQ(mesh.regions[0].names, Strings{"mud"});
  expect_input_error([&] { read_mesh(write_text(folder / "b.2dm", "MESH2D\nE3T 1 7 8 9 5\n")); },
                     {"b.2dm:2: there is no node 7"});
  expect_input_error([&] { read_mesh(write_text(folder / "c.2dm", "MESH2D\nE8Q 1 7 8 9 5\n")); },
                     {"c.2dm:2", "'E8Q'"});
  expect_input_error(
      [&] { read_mesh(write_text(folder / "a.gr3", "x\n1 3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n1 3 1 2 4\n")); },
      {"a.gr3:6: there is no node 4"});
  if (has_netcdf())
    expect_input_error([&] { read_mesh(write_text(folder / "b.nc", "CDF\1")); },
                       {"b.nc: the file cannot be read"});
}

TEST(PlanarFormats, RefuseSurfaces) {
  const Folder folder;
  Mesh mesh = quad_grid(1, 1);
  mesh.points[0].z = 1;
  std::ranges::reverse(mesh.quads[0]);
  for (const char* name : {"a.2dm", "a.gr3", "a.nc", "a.ism", "a.re2", "a.specfem", "a.foam"}) {
    const auto format = std::ranges::find_if(mesh_formats(), [&](const MeshFormat& one) {
      return one.extensions[0] == fs::path(name).extension();
    });
    if (format->package.empty())
      expect_input_error([&] { write_mesh(folder / name, mesh); }, {name, "looks down"});
  }
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace delquad
