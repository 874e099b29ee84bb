// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/regularity.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// An L with a hole of three corners, meshed.
Mesh meshed_l() {
  MeshProblem problem;
  problem.model =
      polygons({{{0, 0}, {3, 0}, {3, 1}, {1, 2}, {1, 3}, {0, 3}}, {{0.3, 0.4}, {0.5, 0.9}, {0.8, 0.5}}});
  problem.size.field = make_constant_size(0.08);
  return mesh(problem, "DB").mesh;
}

/// The same with points, quads and the first corners of quads in another order.
Mesh shuffled(const Mesh& mesh) {
  std::mt19937 random(7);
  std::vector<int> place(mesh.points.size());
  std::iota(place.begin(), place.end(), 0);
  std::ranges::shuffle(place, random);
  Mesh result = mesh;
  for (std::size_t i = 0; i < place.size(); ++i) result.points[place[i]] = mesh.points[i];
  for (auto& line : result.lines)
    for (int& v : line) v = place[v];
  for (auto& quad : result.quads) {
    for (int& v : quad) v = place[v];
    std::ranges::rotate(quad, quad.begin() + random() % 4);
  }
  std::ranges::shuffle(result.quads, random);
  return result;
}

using Pair = std::tuple<double, double, double, double, int, int, int>;

std::multiset<Pair> places_of(const Mesh& mesh, const PairedVertices& paired) {
  std::multiset<Pair> places;
  for (const IrregularPair& p : paired.pairs) {
    const Vec3 few = mesh.points[p.few], many = mesh.points[p.many];
    places.insert({few.x, few.y, many.x, many.y, p.edges, p.burgers[0], p.burgers[1]});
  }
  return places;
}

TEST(RegularityOfMeshes, DoesNotDependOnNumbers) {
  const Mesh mesh = meshed_l(), other = shuffled(mesh);
  const PairedVertices paired = pair_irregular(mesh, sorted_half_edges(mesh));
  const PairedVertices again = pair_irregular(other, sorted_half_edges(other));
  ASSERT_GT(paired.pairs.size(), 10u);
  EXPECT_EQ(paired.necessary, again.necessary);
  EXPECT_EQ(paired.beyond, again.beyond);
  EXPECT_EQ(paired.unpaired, again.unpaired);
  EXPECT_EQ(places_of(mesh, paired), places_of(other, again));
}

TEST(RegularityOfMeshes, CornersAndHolesSayWhatIsNecessary) {
  const Mesh mesh = meshed_l();
  const PairedVertices paired = pair_irregular(mesh, sorted_half_edges(mesh));
  const int outer = 1 + 1 + 1 - 1 + 1 + 1, hole = -3, chi = 0;  // 2 - ideal quads of each corner
  EXPECT_EQ(paired.necessary, std::abs(4 * chi - outer - hole));
  EXPECT_EQ(paired.unpaired, paired.necessary);
  EXPECT_EQ(static_cast<std::size_t>(paired.beyond), 2 * paired.pairs.size());
  for (const IrregularPair& pair : paired.pairs) {
    EXPECT_EQ((pair.burgers[0] + pair.burgers[1]) % 2, 0);
    EXPECT_LE(pair.burgers[0], pair.edges);
    EXPECT_LE(pair.burgers[1], pair.burgers[0]);
  }
}

}  // namespace
}  // namespace delquad
