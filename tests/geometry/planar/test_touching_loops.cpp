// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/curves/mesh_planar_curves.h"
#include "geometry/planar/planar_model.h"
#include "tests/geometry/planar/models.h"

namespace delquad {
namespace {

using Polygon = std::vector<Vec2>;

PlanarModel model_of(const std::vector<Polygon>& loops) {
  ModelMaker builder;
  for (const Polygon& loop : loops) {
    std::vector<ModelMaker::Shape> sides;
    for (std::size_t i = 0; i < loop.size(); ++i)
      sides.push_back(make_segment(loop[i], loop[(i + 1) % loop.size()]));
    builder.loop(sides);
  }
  return builder;
}

double area(const PlanarDomain& domain) {
  double sum = 0;
  for (const PatchBoundary& patch : domain.patches)
    for (const auto& [v, w] : patch.edges) sum += 0.5 * cross(patch.points[v], patch.points[w]);
  return sum;
}

/// Corners that are opened lose a millionth of an edge.
constexpr double kOpened = 1e-4;

struct Touching {
  std::string name;
  std::vector<Polygon> loops;
  double area;
  std::size_t patches;
};

void PrintTo(const Touching& touching, std::ostream* out) { *out << touching.name; }

const Polygon kSquare{{0, 0}, {4, 0}, {4, 4}, {0, 4}};

class TouchingLoops : public ::testing::TestWithParam<Touching> {};

TEST_P(TouchingLoops, AreMeshed) {
  const PlanarDomain domain = make_domain(model_of(GetParam().loops), constant(0.3));
  EXPECT_NEAR(area(domain), GetParam().area, kOpened);
  EXPECT_EQ(domain.patches.size(), GetParam().patches);
  EXPECT_EQ(domain.boundary.regions.size(), 1u);
  for (const PatchBoundary& patch : domain.patches) EXPECT_EQ(patch.edges.size() % 2, 0u);
  std::set<std::pair<double, double>> places;
  for (const Vec3& x : domain.boundary.points)
    EXPECT_TRUE(places.insert({x.x, x.y}).second) << x.x << " " << x.y;
}

INSTANTIATE_TEST_SUITE_P(
    All, TouchingLoops,
    ::testing::Values(
        Touching{"BowTie", {{{0, 0}, {2, 1}, {4, 0}, {4, 2}, {2, 1}, {0, 2}}}, 4, 2},
        Touching{
            "FigureOfTwoSquares", {{{0, 0}, {2, 0}, {2, 2}, {4, 2}, {4, 4}, {2, 4}, {2, 2}, {0, 2}}}, 8, 2},
        Touching{"HoleAtACorner", {kSquare, {{0, 0}, {2, 1}, {1, 2}}}, 14.5, 1},
        Touching{"HoleOnASide", {kSquare, {{0, 2}, {1, 3}, {2, 2}, {1, 1}}}, 14, 1},
        Touching{"HoleAlongASide", {kSquare, {{0, 1}, {1, 1}, {1, 2}, {0, 2}}}, 15, 1},
        Touching{"HolesWithACorner", {kSquare, square(1, 1, 1), square(2, 2, 1)}, 14, 1},
        Touching{"HolesWithASide", {kSquare, square(1, 1, 1), square(2, 1, 1)}, 14, 1},
        Touching{"CornerOnAnOwnSide", {{{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}}, 8, 2},
        Touching{"Seam",
                 {{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}},
                 12,
                 1},
        Touching{"Slit", {{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}}}, 16, 1}),
    [](const auto& touching) { return touching.param.name; });

TEST(CrossingLoops, AreRefusedWithThePlace) {
  const auto refused = [](const Polygon& loop, const char* word) {
    expect_input_error([&] { make_domain(model_of({loop}), constant(0.3)); }, {word});
  };
  refused({{0, 0}, {4, 4}, {4, 0}, {0, 4}}, "cross at (2, 2)");
  // Six edges on each diagonal: both have a node there.
  expect_input_error(
      [&] {
        make_domain(model_of({{{0, 0}, {4, 4}, {4, 0}, {0, 4}}}), constant(1.42));
      },
      {"lines of", "cross at (2, 2)"});
  Polygon twice = kSquare;
  twice.insert(twice.end(), kSquare.begin(), kSquare.end());
  refused(twice, "the loops enclose nothing");
}

TEST(OpenLoops, DoNotLeaveAPointAsOftenAsTheyArrive) {
  PlanarModel model = model_of({{{0, 0}, {2, 0}, {2, 2}}});
  model.loops[0].curves.push_back(3);
  model.curves.push_back({make_segment({0, 0}, {1, 1}), "", ""});
  expect_input_error([&] { make_domain(model, constant(0.3)); },
                     {"3 ends of curves meet at (0, 0)", "one that arrives and one that leaves"});
}

}  // namespace
}  // namespace delquad
