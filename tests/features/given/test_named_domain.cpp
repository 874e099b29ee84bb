// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/given/named_domain.h"
#include "io/formats/msh.h"
#include "io/mesh_io.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

using Names = std::vector<std::string>;

/// A square [0, 4]^2 on the curve of tag 1, and a square [1, 3]^2 inside it on the curve of tag 2.
Mesh nested_squares() {
  Mesh mesh;
  for (const double r : {0.0, 1.0}) {
    const int first = static_cast<int>(mesh.points.size()), curve = static_cast<int>(mesh.curves.size());
    mesh.curves.push_back({curve + 1, {}});
    for (const Vec2 corner : {Vec2{r, r}, Vec2{4 - r, r}, Vec2{4 - r, 4 - r}, Vec2{r, 4 - r}})
      mesh.points.push_back({corner.x, corner.y, 0});
    for (int k = 0; k < 4; ++k) {
      mesh.lines.push_back({first + k, first + (k + 1) % 4});
      mesh.line_curve.push_back(curve);
    }
  }
  return mesh;
}

void add_quad(Mesh& mesh, std::array<int, 4> quad, const Names& names) {
  mesh.quad_region.push_back(static_cast<int>(mesh.regions.size()));
  mesh.quads.push_back(quad);
  mesh.regions.push_back({static_cast<int>(mesh.regions.size()) + 1, names});
}

TEST(NamedDomain, ElementsNameThePatchTheyFill) {
  Mesh mesh = nested_squares();
  add_quad(mesh, {4, 7, 6, 5}, {"core", "hot"});  // clockwise
  add_quad(mesh, {0, 1, 5, 4}, {"shell"});
  const PlanarDomain domain = make_named_domain(mesh, {}, "m.msh");
  ASSERT_EQ(domain.boundary.regions.size(), 2u);
  EXPECT_EQ(domain.boundary.regions[0].names, Names{"shell"});
  EXPECT_EQ(domain.boundary.regions[1].names, (Names{"core", "hot"}));
}

TEST(NamedDomain, LoopWithoutElementsIsAHoleAndDifferentOnesGiveNoName) {
  Mesh mesh = nested_squares();
  add_quad(mesh, {0, 1, 5, 4}, {"south"});
  EXPECT_EQ(make_named_domain(mesh, {}, "m.msh").boundary.regions[0].names, Names{"south"});
  add_quad(mesh, {1, 2, 6, 5}, {"east"});
  const PlanarDomain domain = make_named_domain(mesh, {}, "m.msh");
  ASSERT_EQ(domain.boundary.regions.size(), 1u);
  EXPECT_EQ(domain.boundary.regions[0].names, Names{"domain"});
}

TEST(NamedDomain, SurfacesAreKnownByTheirCurves) {
  const Mesh mesh = nested_squares();
  const DeclaredSurfaces both{{"shell", "core"}, {{{1, {"shell"}}, {1, 2}}, {{2, {"core"}}, {2}}}};
  const PlanarDomain filled = make_named_domain(mesh, both, "m.msh");
  ASSERT_EQ(filled.boundary.regions.size(), 2u);
  EXPECT_EQ(filled.boundary.regions[0].names, Names{"shell"});
  EXPECT_EQ(filled.boundary.regions[1].names, Names{"core"});
  const DeclaredSurfaces ring{{"shell"}, {{{1, {"shell"}}, {1, 2}}}};
  EXPECT_EQ(make_named_domain(mesh, ring, "m.msh").patches.size(), 1u);
  // Two that have the same curves say nothing.
  const DeclaredSurfaces twice{{"a", "b"}, {{{1, {"a"}}, {1, 2}}, {{2, {"b"}}, {1, 2}}}};
  EXPECT_EQ(make_named_domain(mesh, twice, "m.msh").boundary.regions[0].names, Names{"domain"});
}

/// A line ties a hole to the border: without a word on surfaces both are regions.
TEST(NamedDomain, FacesBesideAKnownOneAreHoles) {
  Mesh mesh = nested_squares();
  mesh.lines.push_back({0, 4});
  mesh.line_curve.push_back(2);
  mesh.curves.push_back({3, {"tie"}});
  EXPECT_EQ(make_named_domain(mesh, {}, "m.msh").patches.size(), 2u);
  const DeclaredSurfaces ring{{"shell"}, {{{1, {"shell"}}, {1, 2}}}};
  const PlanarDomain domain = make_named_domain(mesh, ring, "m.msh");
  ASSERT_EQ(domain.patches.size(), 1u);
  EXPECT_EQ(domain.boundary.regions[0].names, Names{"shell"});
  EXPECT_EQ(domain.patches[0].edges.size(), 10u);
}

TEST(NamedDomain, OnlyNamedGroupNamesTheOnlyPatch) {
  Mesh mesh = nested_squares();
  EXPECT_EQ(make_named_domain(mesh, {{"plate"}, {}}, "m.msh").boundary.regions[0].names, Names{"plate"});
  EXPECT_EQ(make_named_domain(mesh, {{"a", "b"}, {}}, "m.msh").boundary.regions[0].names, Names{"domain"});
  for (std::size_t v = 4; v < 8; ++v) mesh.points[v].x += 10;
  for (const Entity& region : make_named_domain(mesh, {{"plate"}, {}}, "m.msh").boundary.regions)
    EXPECT_NE(region.names, Names{"plate"}) << "which of the two?";
}

TEST(NamedDomain, ReaderTellsSurfacesWithoutElements) {
  const TemporaryFolder folder;
  const auto file =
      write_text(folder / "m.msh",
                 "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 5 \"rim\"\n2 20 \"my "
                 "plate\"\n$EndPhysicalNames\n"
                 "$Entities\n0 1 1 0\n3 0 0 0 1 1 0 1 5 0\n9 0 0 0 1 1 0 1 20 1 -3\n$EndEntities\n"
                 "$Nodes\n1 3 1 3\n1 3 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
                 "$Elements\n1 3 1 3\n1 3 1 3\n1 1 2\n2 2 3\n3 3 1\n$EndElements\n");
  DeclaredSurfaces surfaces;
  const Mesh mesh = read_msh(file, &surfaces);
  EXPECT_EQ(surfaces.group_names, Names{"my plate"});
  ASSERT_EQ(surfaces.surfaces.size(), 1u);
  EXPECT_EQ(surfaces.surfaces[0].curves, std::vector<int>{3});
  EXPECT_EQ(make_named_domain(mesh, surfaces, "m.msh").boundary.regions[0].names, Names{"my plate"});
}

}  // namespace
}  // namespace delquad
