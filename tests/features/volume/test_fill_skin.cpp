// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/fill_steps.h"
#include "geometry/mesh/cell_shapes.h"
#include "geometry/mesh/half_edges.h"
#include "tests/features/volume/volume_checks.h"

namespace delquad::testing_support {
namespace {

constexpr VolumeOptions kTets{VolumeCells::kTets}, kPyramids{VolumeCells::kPyramidsAndTets};

/// Fills a skin by all kinds of cells; `volume`: the expected one.
void expect_filled(const Mesh& skin, double volume, std::size_t bodies = 1) {
  expect_sound_cells(fill_skin(skin), volume);
  const Mesh mesh = fill_skin(skin, kPyramids);
  EXPECT_TRUE(mesh.hexahedra.empty());
  expect_sound_cells(mesh, volume);
  EXPECT_EQ(mesh.volumes.size(), bodies);
  ASSERT_EQ(mesh.quads.size(), skin.quads.size());
  EXPECT_TRUE(std::equal(skin.points.begin(), skin.points.end(), mesh.points.begin()));
  const Mesh tets = fill_skin(skin, kTets);
  EXPECT_TRUE(tets.pyramids.empty() && tets.quads.empty());
  EXPECT_EQ(tets.triangles.size(), 2 * skin.quads.size());
  expect_sound_cells(tets, measure(tets).volume);
  EXPECT_NEAR(measure(tets).volume, volume, 0.01 * volume);
}

double volume_of(const Mesh& skin) {
  double sum = 0;
  for (const auto& [a, b, c, d] : skin.quads) {
    const auto& p = skin.points;
    const Vec3 middle = 0.25 * (p[a] + p[b] + (p[c] + p[d]));
    sum += dot(cross(p[c] - p[a], p[d] - p[b]), middle) / 6;
  }
  return sum;
}

TEST(FillSkin, FillsBoxesAndBalls) {
  const auto cube = [](const Vec3& p) { return p; };
  expect_filled(cube_surface(1, cube), 8);
  expect_filled(cube_surface(5, cube), 8);
  expect_filled(cube_surface(6, [](const Vec3& p) { return Vec3{p.x, p.y, 0.02 * p.z}; }), 0.16);
  const auto cylinder = [](const Vec3& p) {
    return Vec3{p.x * std::sqrt(1 - p.y * p.y / 2), p.y * std::sqrt(1 - p.x * p.x / 2), p.z};
  };
  const Mesh round = cube_surface(6, cylinder), ball = sphere(5, 2);
  expect_filled(round, volume_of(round));
  expect_filled(ball, volume_of(ball));
}

TEST(FillSkin, FillsConcaveBodies) {
  expect_filled(skin_of_labels(4, [](int i, int j, int) { return i < 2 || j < 2; }), 48);
  expect_filled(skin_of_labels(3, [](int i, int j, int k) { return (i + j + k) % 3 != 2 || k == 1; }), 21);
}

TEST(FillSkin, PutsALayerIntoThinBodies) {
  MeshProblem problem = problem_of(ExampleModel{"elbow"});  // quads outside do not lie over quads inside
  problem.quads = 800;
  const Mesh skin = mesh(problem, "DBQO").mesh;
  Mesh plain = skin;
  place_hexahedra(plain, "DBC");
  const Mesh filled = fill_skin(skin);
  expect_sound_cells(filled, volume_of(skin));
  EXPECT_GT(measure(filled).shapes[0].volume, 1.05 * measure(plain).volume);
}

TEST(FillSkin, LeavesCavitiesOut) {
  ReadNotes notes;
  const Mesh skin = skin_of_labels(5, [](int i, int j, int k) { return i != j || j != k || i % 2 == 0; });
  expect_filled(skin, 123);
  fill_skin(skin, {}, &notes);
  EXPECT_EQ(notes.size(), 2u);
}

TEST(FillSkin, FillsBodiesThatShareQuads) {
  const Mesh skin = skin_of_labels(4, [](int i, int, int k) { return k == 3 && i > 0 ? 0 : i < 2 ? 1 : 2; });
  expect_filled(skin, 52, 2);
  const Mesh mesh = fill_skin(skin, kPyramids);
  EXPECT_EQ(mesh.volumes[mesh.tet_volume[0]].names.size(), 1u);
  EXPECT_NE(mesh.volumes[0].names, mesh.volumes[1].names);
  const Mesh inclusion = skin_of_labels(3, [](int i, int j, int k) { return i * j * k == 1 ? 2 : 1; });
  expect_filled(inclusion, 27, 2);
  const Mesh both = fill_skin(inclusion);
  EXPECT_EQ(both.volumes[both.hex_volume[0]].names, std::vector<std::string>{"body 1"});
  EXPECT_EQ(both.volumes[0].names.size() + both.volumes[1].names.size(), 2u);
  EXPECT_NE(both.volumes[0].names, both.volumes[1].names);
}

TEST(FillSkin, TurnsQuadsOutwards) {
  Mesh skin = cube_surface(3, [](const Vec3& p) { return p; });
  const Mesh mesh = fill_skin(skin);
  EXPECT_EQ(mesh.quads, skin.quads);
  for (std::size_t i = 0; i < skin.quads.size(); i += 2) std::swap(skin.quads[i][1], skin.quads[i][3]);
  EXPECT_EQ(fill_skin(skin).quads, mesh.quads);
}

TEST(FillSkin, TakesAllStrategies) {
  const Mesh ball = sphere(6, 2);
  for (const char* strategy : {"FB", "FBCO", "DB", "DBC", "DBO"})
    expect_sound_cells(fill_skin(ball, {.strategy = strategy}), volume_of(ball));
  for (const char* wrong : {"", "B", "D", "FD", "DO", "DFB", "DBCCO", "DBX", "DBOC"})
    expect_input_error([&] { fill_skin(ball, {.strategy = wrong}); }, {"strategy '", "F or D"});
}

/// The quads at order 2; `place` moves the middles of sides and quads.
template <class Place>
Mesh curved(Mesh mesh, const Place& place) {
  mesh.order = 2;
  std::map<std::vector<int>, int> known;
  const auto add_node = [&](std::vector<int> corners) {
    std::ranges::sort(corners);
    const auto [at, is_new] = known.try_emplace(corners, static_cast<int>(mesh.points.size()));
    mesh.quad_nodes.push_back(at->second);
    if (!is_new) return;
    Vec3 sum;
    for (const int v : corners) sum = sum + 1.0 / static_cast<double>(corners.size()) * mesh.points[v];
    mesh.points.push_back(place(sum));
  };
  for (const auto& q : mesh.quads) {
    for (int k = 0; k < 4; ++k) add_node({q[k], q[(k + 1) % 4]});
    add_node({q.begin(), q.end()});
  }
  return mesh;
}
Mesh curved_ball() {
  return curved(sphere(5, 1), [](const Vec3& p) { return 1 / norm(p) * p; });
}

TEST(FillSkin, TakesMiddleNodesOfCurvedQuads) {
  ReadNotes notes;
  const Mesh cells = fill_skin(curved_ball(), kTets, &notes);
  EXPECT_EQ(notes, ReadNotes());
  expect_sound_cells(cells, measure(cells).volume);
  EXPECT_EQ(2 * cells.middle_nodes.size(), 3 * cells.triangles.size());
  for (const auto& [a, b, c] : cells.triangles)
    for (const auto& [i, j] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
      EXPECT_NEAR(norm(middle_of_edge(cells, i, j)), 1, 1e-12);
  expect_input_error([] { fill_skin(curved_ball()); }, {"skin", "order 2"});
}

TEST(FillSkin, MovesMiddleNodesWhereCellsWouldFold) {
  const Mesh cube = cube_surface(1, [](const Vec3& p) { return p; });
  const auto dent = [](const Vec3& p) { return p == Vec3{0, 0, 1} ? Vec3{0, 0, -2} : p; };
  ReadNotes notes;
  const Mesh cells = fill_skin(curved(cube, dent), kTets, &notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("off the model: 1 middle node, the first at (0, 0, "), std::string::npos)
      << notes[0];
  for (const MiddleNode& middle : cells.middle_nodes) EXPECT_GT(middle.at.z, -1.5);
}

TEST(FillSkin, RefusesOtherSkins) {
  const auto refused = [](const Mesh& skin, std::initializer_list<const char*> parts,
                          const VolumeOptions& options = {}) {
    expect_input_error([&] { fill_skin(skin, options); }, parts);
  };
  const Mesh cube = cube_surface(3, [](const Vec3& p) { return p; });
  refused(Mesh{}, {"no quads"});
  refused(cube, {"54 quads", "--max-elements"}, {.max_elements = 50});
  refused(cube, {"cells are needed", "--max-elements"}, {VolumeCells::kTets, 60});
  Mesh open = cube;
  open.quads.pop_back(), open.quad_region.pop_back();
  refused(open, {"open at the edge from (", "closed skin"});
  Mesh odd = cube;
  odd.triangles.push_back({0, 1, 2}), odd.triangle_region.push_back(0);
  refused(odd, {"1 triangles", "quads alone"});
  Mesh crossing = cube;
  const int n = static_cast<int>(cube.points.size());
  for (const Vec3& p : cube.points) crossing.points.push_back(p + Vec3{0.9, 0.8, 0.7});
  for (const auto& [a, b, c, d] : cube.quads) crossing.quads.push_back({a + n, b + n, c + n, d + n});
  crossing.quad_region.resize(crossing.quads.size(), 0);
  refused(crossing, {"crosses itself at ("});
}

}  // namespace
}  // namespace delquad::testing_support
