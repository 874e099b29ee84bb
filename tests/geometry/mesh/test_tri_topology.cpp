// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/tri_topology.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

TriPatch random_patch(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Vec2> inside;
  for (int i = 0; i < 30; ++i)
    inside.push_back({0.1 + 0.8 * shapes::uniform(random), 0.1 + 0.8 * shapes::uniform(random)});
  return constrained_delaunay(shapes::rectangle(1, 1, 4, 4), inside);
}

/// Vertices that only have to be joined as they are: their places may make triangles that are turned over.
std::vector<std::string> wrong_links(TriPatch tri) {
  std::vector<std::string> wrong;
  for (const std::string& line : check_invariants(tri))
    if (line.find("clockwise") == std::string::npos) wrong.push_back(line);
  return wrong;
}

TEST(TriTopology, SplitsKeepTheLinksAndTheFirstEnds) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    TriPatch tri = random_patch(seed);
    std::mt19937_64 random(seed);
    for (int n = 0; n < 20; ++n) {
      const int t = static_cast<int>(random() % tri.triangles.size()), k = static_cast<int>(random() % 3);
      const int u = tri.neighbours[t][k], triangles = static_cast<int>(tri.triangles.size());
      if (u < 0) continue;
      const int from = tri.triangles[t][(k + 1) % 3], to = tri.triangles[t][(k + 2) % 3];
      split_side(tri, t, k, 0.5 * (tri.points[from] + tri.points[to]));
      EXPECT_EQ(check_invariants(tri), std::vector<std::string>{}) << seed;
      for (const int kept : {t, u}) EXPECT_EQ(std::ranges::count(tri.triangles[kept], from), 1) << seed;
      for (const int made : {triangles, triangles + 1})
        EXPECT_EQ(std::ranges::count(tri.triangles[made], to), 1) << seed;
      EXPECT_GE(facing_side(tri, t, triangles), 0);
      EXPECT_GE(facing_side(tri, u, triangles + 1), 0);
    }
  }
}

TEST(TriTopology, SwappingTwiceTurnsTheDiagonalBack) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    TriPatch tri = random_patch(seed);
    const TriPatch before = tri;
    for (int t = 0; t < static_cast<int>(tri.triangles.size()); ++t)
      for (int k = 0; k < 3; ++k) {
        const int u = tri.neighbours[t][k];
        if (u < 0) continue;
        swap_side(tri, t, k);
        EXPECT_EQ(wrong_links(tri), std::vector<std::string>{}) << seed;
        swap_side(tri, t, facing_side(tri, t, u));
        for (const int i : {t, u})
          EXPECT_TRUE(std::ranges::is_permutation(tri.triangles[i], before.triangles[i]) ||
                      std::ranges::is_permutation(tri.triangles[i], before.triangles[i == t ? u : t]))
              << seed;
        tri = before;
      }
  }
}

TEST(TriTopology, FindsEveryInnerEdgeAndNoOther) {
  const TriPatch tri = random_patch(1);
  const TriTopology topology(tri);
  const int n = static_cast<int>(tri.points.size());
  std::vector<std::vector<char>> inner(n, std::vector<char>(n, 0)), any = inner;
  for (std::size_t t = 0; t < tri.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = tri.triangles[t][(k + 1) % 3], b = tri.triangles[t][(k + 2) % 3];
      any[a][b] = any[b][a] = 1;
      if (tri.neighbours[t][k] >= 0) inner[a][b] = inner[b][a] = 1;
    }
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      if (a == b) continue;
      EXPECT_EQ(topology.adjacent(a, b), any[a][b] == 1) << a << " " << b;
      const auto [t, k] = topology.find_inner_edge(a, b);
      ASSERT_EQ(t >= 0, inner[a][b] == 1) << a << " " << b;
      if (t < 0) continue;
      EXPECT_TRUE(topology.vertex(t, k) != a && topology.vertex(t, k) != b);
      EXPECT_GE(topology.across(t, k), 0);
    }
}

TEST(TriTopology, CollapsesLeaveNothingDeadBehind) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const TriPatch tri = random_patch(seed);
    TriTopology topology(tri);
    std::vector<TriCorner> star;
    int collapsed = 0;
    for (int from = tri.n_boundary; from < topology.vertex_slots(); ++from) {
      if (!topology.vertex_alive(from)) continue;
      topology.star(from, star);
      const int to = topology.vertex(star[0].t, star[0].k + 1);
      int common = 0;
      for (const auto& [t, k] : star) common += topology.adjacent(topology.vertex(t, k + 1), to);
      if (star.size() < 4 || common != 2) continue;
      topology.collapse(from, to, star);
      ++collapsed;
    }
    EXPECT_GT(collapsed, 5);
    const TriPatch result = topology.to_patch();
    EXPECT_EQ(result.points.size(), tri.points.size() - collapsed);
    EXPECT_EQ(result.triangles.size(), tri.triangles.size() - 2 * static_cast<std::size_t>(collapsed));
    EXPECT_EQ(wrong_links(result), std::vector<std::string>{}) << seed;
  }
}

}  // namespace
}  // namespace delquad
