// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/planar/models.h"

namespace delquad {
namespace {

double area(const PatchBoundary& patch) {
  double sum = 0;
  for (const auto& [v, w] : patch.edges) sum += 0.5 * cross(patch.points[v], patch.points[w]);
  return sum;
}

/// Three nested squares and a fourth beside them.
Mesh nested_squares() {
  return polygon_lines({square(0, 0, 10), square(1, 1, 8), square(2, 2, 6), square(20, 0, 3)});
}

TEST(LineDomain, TellsOuterLoopsHolesAndIslands) {
  const PlanarDomain domain = make_domain(nested_squares());
  ASSERT_EQ(domain.patches.size(), 3u);
  EXPECT_DOUBLE_EQ(area(domain.patches[0]), 100 - 64);
  EXPECT_DOUBLE_EQ(area(domain.patches[1]), 36);
  EXPECT_DOUBLE_EQ(area(domain.patches[2]), 9);
  EXPECT_EQ(domain.patch_region, (std::vector<int>{0, 1, 2}));
  ASSERT_EQ(domain.boundary.regions.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(domain.boundary.regions[i].tag, static_cast<int>(i) + 1);
    EXPECT_EQ(domain.boundary.regions[i].names, std::vector<std::string>{"domain_" + std::to_string(i + 1)});
  }
  EXPECT_EQ(domain.boundary.curves[1].names, std::vector<std::string>{"b"});
}

TEST(LineDomain, PatchBoundariesAreSound) {
  const PlanarDomain domain = make_domain(nested_squares());
  const Mesh& mesh = domain.boundary;
  for (const PatchBoundary& patch : domain.patches) {
    const std::size_t n = patch.points.size();
    ASSERT_EQ(patch.edges.size(), n);
    ASSERT_EQ(patch.edge_curve.size(), n);
    ASSERT_EQ(patch.point_node.size(), n);
    std::vector<int> in(n, 0), out(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      const auto [v, w] = patch.edges[i];
      EXPECT_EQ(v, static_cast<int>(i)) << "points stand in loop order";
      ++out[v];
      ++in[w];
      const Vec3& node = mesh.points[patch.point_node[i]];
      EXPECT_EQ(patch.points[i], (Vec2{node.x, node.y}));
      // The same edge is a line of the mesh, in the same direction and on the same curve.
      const std::array line{patch.point_node[v], patch.point_node[w]};
      const auto found = std::ranges::find(mesh.lines, line);
      ASSERT_NE(found, mesh.lines.end());
      EXPECT_EQ(mesh.line_curve[found - mesh.lines.begin()], patch.edge_curve[i]);
    }
    EXPECT_EQ(in, std::vector<int>(n, 1));
    EXPECT_EQ(out, std::vector<int>(n, 1));
  }
}

TEST(LineDomain, OrderAndOrientationOfLinesDoNotMatter) {
  const Mesh original = nested_squares();
  const PlanarDomain expected = make_domain(original);
  std::mt19937 engine(2);
  for (int round = 0; round < 40; ++round) {
    Mesh mesh = original;
    std::vector<std::size_t> order(mesh.lines.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::shuffle(order, engine);
    for (std::size_t i = 0; i < order.size(); ++i) {
      mesh.lines[i] = original.lines[order[i]];
      mesh.line_curve[i] = original.line_curve[order[i]];
      if (engine() % 2) std::swap(mesh.lines[i][0], mesh.lines[i][1]);
    }
    const PlanarDomain domain = make_domain(mesh);
    EXPECT_EQ(domain.boundary.points, expected.boundary.points);
    ASSERT_EQ(domain.patches.size(), expected.patches.size());
    for (std::size_t k = 0; k < domain.patches.size(); ++k) {
      EXPECT_EQ(domain.patches[k].points, expected.patches[k].points);
      EXPECT_EQ(domain.patches[k].edges, expected.patches[k].edges);
      EXPECT_EQ(domain.patches[k].edge_curve, expected.patches[k].edge_curve);
      EXPECT_EQ(domain.patches[k].point_node, expected.patches[k].point_node);
    }
    for (std::size_t i = 0; i < order.size(); ++i)
      EXPECT_EQ(domain.boundary.lines[i], expected.boundary.lines[order[i]]);
  }
}

TEST(LineDomain, OrderOfPointsDoesNotMatterEither) {
  const Mesh original = nested_squares();
  Mesh mesh = original;
  const int n = static_cast<int>(mesh.points.size());
  for (int v = 0; v < n; ++v) mesh.points[n - 1 - v] = original.points[v];
  for (auto& line : mesh.lines) line = {n - 1 - line[0], n - 1 - line[1]};
  const PlanarDomain a = make_domain(original), b = make_domain(mesh);
  for (std::size_t k = 0; k < a.patches.size(); ++k) EXPECT_EQ(a.patches[k].points, b.patches[k].points);
}

TEST(LineDomain, KeepsNodesAndDropsThoseWithoutLines) {
  Mesh mesh = polygon_lines({square(0, 0, 1)});
  mesh.points.insert(mesh.points.begin() + 1, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  mesh.points.push_back({0.5, 0.5, 7});
  for (auto& line : mesh.lines)
    for (int& v : line) v += v > 0;
  for (Vec3& p : mesh.points) p.z = 3;
  const PlanarDomain domain = make_domain(mesh);
  EXPECT_EQ(domain.boundary.points, (std::vector<Vec3>{{0, 0, 3}, {1, 0, 3}, {1, 1, 3}, {0, 1, 3}}));
  EXPECT_EQ(domain.boundary.regions.at(0).names, std::vector<std::string>{"domain"});
}

TEST(LineDomain, NestsTightNeighboursExactly) {
  // The gap is one unit in the last place.
  const double x = std::nextafter(1.0, 0.0);
  const PlanarDomain domain =
      make_domain(polygon_lines({square(0, 0, 1), {{0.5, 0.5}, {x, 0.5}, {0.5, 0.75}}}));
  ASSERT_EQ(domain.patches.size(), 1u);
  EXPECT_EQ(domain.patches[0].points.size(), 7u);
  expect_input_error(
      [] {
        make_domain(polygon_lines({square(0, 0, 1), {{0.5, 0.5}, {1, 0.5}, {0.5, 0.75}}}));
      },
      {"touches", "(1, 0.5)", "'a'", "'b'"});
}

void expect_rejected(const Mesh& mesh, std::initializer_list<const char*> parts) {
  expect_input_error([&] { make_domain(mesh, "plate.msh"); }, {"plate.msh: "});
  expect_input_error([&] { make_domain(mesh, "plate.msh"); }, parts);
}

TEST(LineDomain, RejectsMeetingLines) {
  expect_rejected(polygon_lines({square(0, 0, 2), square(1, 1, 2)}), {"'a'", "'b'", "cross at (1, 2)"});
  expect_rejected(polygon_lines({{{0, 0}, {2, 2}, {2, 0}, {0, 2}}}),
                  {"'a' and curve 'a'", "cross at (1, 1)"});
  expect_rejected(polygon_lines({square(0, 0, 2), {{2, 1}, {3, 0}, {3, 2}}}), {"touches", "(2, 1)", "'b'"});
  expect_rejected(polygon_lines({square(0, 0, 2), {{2, 0.5}, {3, 1}, {2, 1.5}}}), {"'a'", "'b'", "(2, 0.5)"});
  // A spike that returns along itself, at the first node of the sweep and elsewhere.
  expect_rejected(polygon_lines({{{0, 0}, {2, 0}, {3, 1}, {1, 0}}}), {"(1, 0)", "'a'"});
  expect_rejected(polygon_lines({{{0, 0}, {2, 0}, {1, 0}, {1, 1}}}), {"'a'", "(1, 0)"});
}

TEST(LineDomain, RejectsDuplicatesAndCoincidentNodes) {
  expect_rejected(polygon_lines({square(0, 0, 2), square(0, 0, 2)}),
                  {"two nodes coincide", "(0, 0)", "'a'", "'b'"});
  expect_rejected(polygon_lines({square(0, 0, 2), square(2, 2, 2)}), {"two nodes coincide", "(2, 2)"});
  Mesh twice = polygon_lines({square(0, 0, 2)});
  twice.lines.push_back({2, 1});
  twice.line_curve.push_back(0);
  expect_rejected(twice, {"(2, 0) to (2, 2)", "twice"});
}

TEST(LineDomain, RejectsOpenAndBranchedBoundaries) {
  Mesh open = polygon_lines({square(0, 0, 2), square(5, 0, 1)});
  open.lines.erase(open.lines.begin() + 2);
  open.line_curve.erase(open.line_curve.begin() + 2);
  expect_rejected(open, {"open", "2 loose ends", "(0, 2)", "(2, 2)", "'a'"});
  Mesh branched = polygon_lines({square(0, 0, 2), square(2, 0, 1)});
  for (auto& line : branched.lines)
    for (int& v : line) v = v == 4 ? 1 : v;
  expect_rejected(branched, {"overlap between (2, 0) and (2, 1)", "'a'", "'b'"});
}

TEST(LineDomain, RejectsDegenerateLinesAndNodes) {
  expect_rejected(Mesh{}, {"no lines"});
  expect_rejected(polygon_lines({{{0, 0}, {1, 0}}}), {"only 2 nodes", "three"});
  expect_rejected(polygon_lines({square(0, 0, 1), {{3, 0}, {4, 0}}}),
                  {"(3, 0)", "(4, 0)", "'b'", "only two nodes"});
  expect_rejected(polygon_lines({{{0, 0}, {1, 0}, {1, 0}, {0, 1}}}), {"no length", "(1, 0)"});
  Mesh self = polygon_lines({square(0, 0, 1)});
  self.lines[1] = {1, 1};
  expect_rejected(self, {"no length", "(1, 0)"});
  expect_rejected(polygon_lines({{{0, 0}, {1, 0}, {1, std::nan("")}}}),
                  {"a node of", "'a'", "nan", "finite"});
  expect_rejected(polygon_lines({{{0, 0}, {1, 0}, {1, INFINITY}}}), {"a node of", "inf"});
  Mesh bent = polygon_lines({square(0, 0, 1)});
  bent.points[2].z = 0.1;
  expect_rejected(bent, {"z goes from 0 to 0.1"});
  bent.points[2].z = 1e-14;
  EXPECT_EQ(make_domain(bent).boundary.points[2].z, 0);
  Mesh broken = polygon_lines({square(0, 0, 1)});
  broken.lines[1][0] = 99;
  expect_rejected(broken, {"line 2", "99"});
  broken = polygon_lines({square(0, 0, 1)});
  broken.line_curve[3] = -1;
  expect_rejected(broken, {"line 4", "-1"});
  broken.line_curve.pop_back();
  expect_rejected(broken, {"4 lines have 3 curves"});
}

TEST(LineDomain, ChainsAHundredThousandEdgesQuickly) {
  std::vector<std::vector<Vec2>> circles;
  for (int c = 0; c < 26; ++c) {
    circles.emplace_back();
    for (int i = 0; i < 4000; ++i) {
      const double t = 2 * std::numbers::pi * i / 4000, r = c < 25 ? 0.4 : 20;
      const Vec2 centre = c < 25 ? Vec2{double(c % 5), double(c / 5)} : Vec2{2, 2};
      circles.back().push_back(centre + r * Vec2{std::cos(t), std::sin(t)});
    }
  }
  const Mesh mesh = polygon_lines(circles);
  const auto start = std::chrono::steady_clock::now();
  const PlanarDomain domain = make_domain(mesh);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("seconds", std::to_string(seconds));
  EXPECT_LT(seconds, 20);  // quadratic time would be minutes; sanitised builds are slow
  ASSERT_EQ(domain.patches.size(), 1u);
  EXPECT_EQ(domain.patches[0].points.size(), 104000u);
}

}  // namespace
}  // namespace delquad
