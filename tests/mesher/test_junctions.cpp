// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"
#include "tests/support/named_lines.h"

namespace delquad {
namespace {

std::map<std::string, double> areas(const Mesh& mesh) {
  std::map<std::string, double> areas;
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    const auto& v = mesh.quads[q];
    for (int k = 0; k < 4; ++k)
      areas[mesh.regions[mesh.quad_region[q]].names.at(0)] +=
          cross(mesh.points[v[k]], mesh.points[v[(k + 1) % 4]]).z / 2;
  }
  return areas;
}

/// Whether the lines are one path between two places, without a branch.
void expect_path(const Mesh& mesh, const std::string& name, Vec2 from, Vec2 to) {
  SCOPED_TRACE(name);
  const auto lines = lines_named(mesh, name);
  std::map<int, int> ends;
  for (const auto& [a, b] : lines) ++ends[a], ++ends[b];
  ASSERT_EQ(ends.size(), lines.size() + 1);
  std::set<std::pair<double, double>> loose;
  for (const auto& [v, n] : ends) {
    ASSERT_LE(n, 2);
    if (n == 1) loose.insert({mesh.points[v].x, mesh.points[v].y});
  }
  EXPECT_EQ(loose, (std::set<std::pair<double, double>>{{from.x, from.y}, {to.x, to.y}}));
}

void expect_sound(const MeshResult& result) {
  EXPECT_TRUE(result.soundness.sound()) << result.soundness.text();
  EXPECT_TRUE(result.mesh.triangles.empty());
  EXPECT_EQ(check_invariants(result.mesh), std::vector<std::string>());
}

TEST(Junctions, RegionsSideBySideShareTheirNodes) {
  const MeshProblem problem = ModelMaker()
                                  .rectangle({0, 0}, {1, 1}, {"south", "mid", "north", "west"}, "left")
                                  .rectangle({1, 0}, {2, 1}, {"south", "east", "north", "mid"}, "right")
                                  .rectangle({0.3, 1}, {1.4, 1.5}, {""}, "roof")
                                  .problem(0.11);
  for (const char* word : {"DB", "DBCO", "FB", "PBCO", "DLB"}) {
    SCOPED_TRACE(word);
    const MeshResult result = mesh(problem, word);
    expect_sound(result);
    const auto area = areas(result.mesh);
    ASSERT_EQ(area.size(), 3u);
    EXPECT_NEAR(area.at("left"), 1, 1e-12);
    EXPECT_NEAR(area.at("right"), 1, 1e-12);
    EXPECT_NEAR(area.at("roof"), 0.55, 1e-12);
    expect_path(result.mesh, "mid", {1, 0}, {1, 1});
    EXPECT_NEAR(length_named(result.mesh, "south"), 2, 1e-12);
  }
}

TEST(Junctions, LoopsMayHaveCurvesInCommon) {
  const auto middle = make_segment({1, 0}, {1, 1});
  PlanarModel model{"test", {}, {}};
  model.curves = {{make_polyline({{1, 1}, {0, 1}, {0, 0}, {1, 0}}), "a", ""},
                  {middle, "mid", ""},
                  {make_polyline({{1, 0}, {2, 0}, {2, 1}, {1, 1}}), "b", ""}};
  model.loops = {{{0, 1}, "left", ""}, {{2, 1}, "right", ""}};
  MeshProblem problem = problem_of(model, 0.2);
  const MeshResult result = mesh(problem, "DBCO");
  expect_sound(result);
  EXPECT_NEAR(areas(result.mesh).at("right"), 1, 1e-12);
  expect_path(result.mesh, "mid", {1, 0}, {1, 1});
}

/// Slices of a disc, halves of which lie in a ring: arcs of one circle that begin elsewhere.
TEST(Junctions, ArcsThatLieOnEachOtherAreOne) {
  ModelMaker maker;
  for (int k = 0; k < 3; ++k) {
    const double a = 2 * std::numbers::pi * k / 3, b = 2 * std::numbers::pi * (k + 1) / 3;
    maker.loop({make_segment({0, 0}, {std::cos(a), std::sin(a)}), make_arc({0, 0}, 1, a, b),
                make_segment({std::cos(b), std::sin(b)}, {0, 0})},
               "slice " + std::to_string(k));
  }
  maker.loop({make_circle({0, 0}, 2)}, "ring");
  maker.loop({make_circle({0, 0}, 1)});
  const MeshResult result = mesh(maker.problem(0.2), "DBCO");
  expect_sound(result);
  const auto area = areas(result.mesh);
  ASSERT_EQ(area.size(), 4u);
  EXPECT_NEAR(area.at("ring"), 3 * std::numbers::pi, 0.1);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(area.at("slice " + std::to_string(k)), std::numbers::pi / 3, 0.03);
}

/// A rectangle cut into random ones: areas are exact, and every region has an even boundary.
TEST(Junctions, RandomPartsOfARectangle) {
  std::mt19937 engine(3);
  for (int round = 0; round < 30; ++round) {
    struct Part {
      Vec2 low, high;
    };
    std::vector<Part> parts{{{0, 0}, {1, 1}}};
    std::uniform_real_distribution<double> place(0.25, 0.75);
    const int n = 2 + round;
    while (static_cast<int>(parts.size()) < n) {
      const auto largest = std::ranges::max_element(
          parts, {}, [](const Part& p) { return (p.high.x - p.low.x) * (p.high.y - p.low.y); });
      Part half = *largest;
      if (half.high.x - half.low.x > half.high.y - half.low.y)
        largest->high.x = half.low.x = half.low.x + place(engine) * (half.high.x - half.low.x);
      else
        largest->high.y = half.low.y = half.low.y + place(engine) * (half.high.y - half.low.y);
      parts.push_back(half);
    }
    ModelMaker maker;
    for (std::size_t i = 0; i < parts.size(); ++i)
      maker.rectangle(parts[i].low, parts[i].high, {""}, "part " + std::to_string(i));
    const MeshResult result = mesh(maker.problem(0.06), round % 2 ? "DB" : "DBCO");
    SCOPED_TRACE(round);
    expect_sound(result);
    const auto area = areas(result.mesh);
    ASSERT_EQ(area.size(), parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i)
      EXPECT_NEAR(area.at("part " + std::to_string(i)),
                  (parts[i].high.x - parts[i].low.x) * (parts[i].high.y - parts[i].low.y), 1e-12);
  }
}

/// A hole that shares part of the border is a notch: nothing is left of that part.
TEST(Junctions, HolesAtTheBorderAreNotches) {
  const MeshResult result = mesh(ModelMaker()
                                     .rectangle({0, 0}, {1, 1}, {"south", "", "", ""}, "plate")
                                     .rectangle({0.25, 0}, {0.75, 0.5})
                                     .problem(0.1),
                                 "DBCO");
  expect_sound(result);
  EXPECT_NEAR(areas(result.mesh).at("plate"), 0.75, 1e-12);
  EXPECT_NEAR(length_named(result.mesh, "south"), 0.5, 1e-12);
}

TEST(Junctions, CurvesAndPointsInsideAreInTheMesh) {
  const MeshProblem problem = ModelMaker()
                                  .rectangle({0, 0}, {2, 1}, {""}, "plate")
                                  .curve(make_segment({0.2, 0.2}, {1.1, 0.8}), "one")
                                  .curve(make_segment({0.3, 0.9}, {1.2, 0.1}), "two")
                                  .curve(make_segment({1.5, 0.5}, {2, 0.7}), "to the wall")
                                  .curve(make_arc({1.5, 0.5}, 0.3, 1.7, 4.5), "bow")
                                  .point({0.1, 0.6}, "sensor")
                                  .point({0.65, 0.5}, "on one")
                                  .problem(0.06);
  for (const char* word : {"DB", "DBCO", "DLB", "FBCO"}) {
    SCOPED_TRACE(word);
    const MeshResult result = mesh(problem, word);
    expect_sound(result);
    expect_path(result.mesh, "one", {0.2, 0.2}, {1.1, 0.8});
    expect_path(result.mesh, "two", {0.3, 0.9}, {1.2, 0.1});
    expect_path(result.mesh, "to the wall", {1.5, 0.5}, {2, 0.7});
    EXPECT_NEAR(length_named(result.mesh, "bow"), 0.3 * 2.8, 0.01);
    ASSERT_EQ(result.mesh.named_points.size(), 2u);
    for (const auto& [point, entity] : result.mesh.named_points)
      EXPECT_EQ(result.mesh.points[point],
                entity.names[0] == "sensor" ? Vec3(0.1, 0.6, 0) : Vec3(0.65, 0.5, 0));
    EXPECT_NEAR(areas(result.mesh).at("plate"), 2, 1e-12);
  }
}

/// Segments and points anywhere, crossing each other and the border: each is a path, or a node.
TEST(Junctions, RandomSegmentsAndPoints) {
  for (int round = 0; round < 12; ++round) {
    std::mt19937 engine(static_cast<unsigned>(round));
    std::uniform_real_distribution<double> place(0.05, 0.95);
    ModelMaker maker;
    maker.rectangle({0, 0}, {1, 1}, {""}, "square");
    const int n = 5 + 3 * round;
    std::vector<std::pair<Vec2, Vec2>> segments;
    std::vector<Vec2> points;
    for (int i = 0; i < n; ++i) {
      const Vec2 a{place(engine), place(engine)}, b{place(engine), place(engine)};
      if (i % 3 == 2) {
        points.push_back(a);
        maker.point(a, "point");
        continue;
      }
      const double part = std::min(1.0, 0.4 / norm(b - a));
      segments.emplace_back(a, a + part * (b - a));
      maker.curve(make_segment(a, segments.back().second), "segment " + std::to_string(segments.size()));
    }
    SCOPED_TRACE(round);
    const MeshResult result = mesh(maker.problem(0.04), "DBCO");
    expect_sound(result);
    for (std::size_t i = 0; i < segments.size(); ++i)
      expect_path(result.mesh, "segment " + std::to_string(i + 1), segments[i].first, segments[i].second);
    ASSERT_EQ(result.mesh.named_points.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_EQ(result.mesh.points[result.mesh.named_points[i].point], Vec3(points[i].x, points[i].y, 0));
  }
}

/// Along a crack each lip has its own nodes; tips inside are shared, an end on the boundary is not.
TEST(Junctions, CracksComeApart) {
  ModelMaker maker;
  maker.rectangle({0, 0}, {2, 1}, {""}, "plate");
  const MeshResult whole =
      mesh(ModelMaker(maker).curve(make_segment({0, 0.5}, {0.7, 0.5}), "crack").problem(0.1), "DB");
  const MeshResult apart =
      mesh(ModelMaker(maker).curve(make_segment({0, 0.5}, {0.7, 0.5}), "crack", true).problem(0.1), "DB");
  expect_sound(apart);
  const auto joined = lines_named(whole.mesh, "crack"), lips = lines_named(apart.mesh, "crack");
  EXPECT_EQ(lips.size(), 2 * joined.size());
  EXPECT_EQ(apart.mesh.points.size(), whole.mesh.points.size() + joined.size());
  EXPECT_EQ(apart.mesh.quads.size(), whole.mesh.quads.size());
  // Nodes of both lips lie on each other, and only the tip is there once.
  std::map<std::pair<double, double>, int> at;
  for (const int v : nodes_named(apart.mesh, "crack")) ++at[{apart.mesh.points[v].x, apart.mesh.points[v].y}];
  for (const auto& [p, n] : at) EXPECT_EQ(n, p.first == 0.7 ? 1 : 2) << p.first;

  const MeshResult inside = mesh(ModelMaker(maker)
                                     .curve(make_polyline({{1.2, 0.3}, {1.5, 0.5}, {1.4, 0.8}}), "kink", true)
                                     .problem(0.06),
                                 "DBCO");
  expect_sound(inside);
  EXPECT_EQ(nodes_named(inside.mesh, "kink").size(), lines_named(inside.mesh, "kink").size())
      << "a closed chain";
}

/// One edge between two tips could not open, whatever else ends there.
TEST(Junctions, CracksShorterThanTheSizeComeApart) {
  const MeshResult result = mesh(ModelMaker()
                                     .rectangle({0, 0}, {1, 1}, {""}, "plate")
                                     .curve(make_segment({0.2, 0.5}, {0.5, 0.5}), "line")
                                     .curve(make_segment({0.5, 0.5}, {0.53, 0.54}), "crack", true)
                                     .problem(0.1),
                                 "DBCO");
  expect_sound(result);
  const auto lips = lines_named(result.mesh, "crack");
  EXPECT_GE(lips.size(), 4u);
  EXPECT_NEAR(length_named(result.mesh, "crack"), 2 * 0.05, 1e-12);
  EXPECT_NEAR(areas(result.mesh).at("plate"), 1, 1e-12);
}

/// Small corners and short pieces of curves: the mesh is finer there, and says so.
TEST(Junctions, SizesFollowShortPieces) {
  ModelMaker maker;
  maker.rectangle({0, 0}, {1, 1}, {""}, "square");
  maker.curve(make_segment({0.2, 0.5}, {0.8, 0.5}), "a");
  maker.curve(make_segment({0.5, 0.49}, {0.52, 0.9}), "b");
  const MeshResult result = mesh(maker.problem(0.1), "DBCO");
  expect_sound(result);
  expect_path(result.mesh, "b", {0.5, 0.49}, {0.52, 0.9});
  EXPECT_GT(result.mesh.quads.size(), 120u);
}

TEST(Junctions, RefusesWhatMakesNoSense) {
  ModelMaker square;
  square.rectangle({0, 0}, {1, 1}, {""}, "square");
  const auto meshing = [](const ModelMaker& maker) { return [maker] { mesh(maker.problem(0.1), "DB"); }; };
  expect_input_error(meshing(ModelMaker(square).curve(make_segment({0.5, 0.5}, {1.5, 0.5}), "out")),
                     {"'out'", "outside of every region", "(1.5, 0.5)"});
  expect_input_error(meshing(ModelMaker(square).curve(make_segment({2, 0.5}, {2.5, 0.5}), "away")),
                     {"'away'", "open"});
  expect_input_error(meshing(ModelMaker(square).point({1.5, 0.5}, "far")),
                     {"'far'", "outside of every region"});
  expect_input_error(meshing(ModelMaker(square).point({0.5, 0.5}, "p").point({0.50001, 0.5}, "q")),
                     {"'p'", "nearer than a thousandth", "(0.5, 0.5)"});
  expect_input_error(meshing(ModelMaker(square).point({0.5, 0.5}, "p").point({0.50009, 0.5}, "q")),
                     {"nearer than a thousandth"});
  expect_input_error(meshing(ModelMaker(square).curve(make_segment({0.2, 0}, {0.8, 0}), "")),
                     {"lies on the boundary, curve 1", "(0.2, 0) and (0.8, 0)"});
  ModelMaker hole = square;
  hole.rectangle({0.4, 0.4}, {0.6, 0.6});
  expect_input_error(meshing(hole.curve(make_segment({0.45, 0.5}, {0.55, 0.5}), "in the hole")),
                     {"'in the hole'", "outside of every region"});
  expect_input_error(meshing(ModelMaker(square).rectangle({0.53, 0.52}, {1.5, 1.5}, {""}, "over")),
                     {"cross at"});
  expect_input_error(
      meshing(
          ModelMaker(square).rectangle({0, 0}, {0.5, 1}, {""}, "a").rectangle({0.5, 0}, {1, 1}, {""}, "b")),
      {"'square'", "is empty"});
  expect_input_error(meshing(ModelMaker(square).rectangle({0, 0}, {1, 1}, {""}, "again")), {"same curves"});
}

TEST(Junctions, NamesPartOfBoundaries) {
  const MeshResult result = mesh(ModelMaker()
                                     .rectangle({0, 0}, {1, 1}, {"rim"}, "square")
                                     .curve(make_segment({0.2, 0}, {0.8, 0}), "gate")
                                     .problem(0.1),
                                 "DB");
  double length = 0;
  for (std::size_t i = 0; i < result.mesh.lines.size(); ++i) {
    const auto [a, b] = result.mesh.lines[i];
    if (result.mesh.curves[result.mesh.line_curve[i]].names.front() == "gate")
      length += norm(result.mesh.points[b] - result.mesh.points[a]);
  }
  EXPECT_NEAR(length, 0.6, 1e-12);
}

TEST(Junctions, PointsSurviveFiles) {
  const MeshResult result = mesh(
      ModelMaker().rectangle({0, 0}, {1, 1}, {""}, "square").point({0.4, 0.6}, "sensor").problem(0.2), "DB");
  const TemporaryFolder folder;
  for (const bool binary : {false, true}) {
    write_mesh(folder / "mesh.msh", result.mesh, {.binary = binary});
    const Mesh again = read_mesh(folder / "mesh.msh");
    ASSERT_EQ(again.named_points.size(), 1u);
    EXPECT_EQ(again.points[again.named_points[0].point], Vec3(0.4, 0.6, 0));
    EXPECT_EQ(again.named_points[0].entity.names, std::vector<std::string>{"sensor"});
  }
  write_mesh(folder / "mesh.inp", result.mesh);
  EXPECT_NE(read_text(folder / "mesh.inp").find("*NSET, NSET=sensor"), std::string::npos);
}

/// Lines and points of a file: what they divide, what stands in a region.
TEST(Junctions, OfLineMeshes) {
  Mesh lines;
  const auto chain = [&](std::vector<Vec2> corners, int n, const std::string& name) {
    lines.curves.push_back({static_cast<int>(lines.curves.size()) + 1, {name}});
    for (std::size_t i = 0; i + 1 < corners.size(); ++i)
      for (int k = 0; k < n; ++k) {
        int ends[2];
        for (int e = 0; e < 2; ++e) {
          const double t = double(k + e) / n;
          const Vec2 p = (1 - t) * corners[i] + t * corners[i + 1];
          const Vec3 x{p.x, p.y, 0};
          const auto known =
              std::ranges::find_if(lines.points, [&](const Vec3& q) { return norm(q - x) < 1e-9; });
          ends[e] = static_cast<int>(known - lines.points.begin());
          if (known == lines.points.end()) lines.points.push_back(x);
        }
        lines.lines.push_back({ends[0], ends[1]});
        lines.line_curve.push_back(static_cast<int>(lines.curves.size()) - 1);
      }
  };
  chain({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}, 10, "border");
  chain({{0, 0.5}, {1, 0.5}}, 10, "middle");
  chain({{0.5, 0.5}, {0.5, 0.8}}, 3, "stiffener");
  lines.named_points.push_back({static_cast<int>(lines.points.size()), {1, {"sensor"}}});
  lines.points.push_back({0.25, 0.25, 0});
  MeshProblem problem = problem_of(LineModel{lines});
  problem.size.from_boundary = true;
  const MeshResult result = mesh(problem, "DBCO");
  expect_sound(result);
  EXPECT_EQ(areas(result.mesh).size(), 2u);
  expect_path(result.mesh, "middle", {0, 0.5}, {1, 0.5});
  expect_path(result.mesh, "stiffener", {0.5, 0.5}, {0.5, 0.8});
  ASSERT_EQ(result.mesh.named_points.size(), 1u);
  EXPECT_EQ(result.mesh.points[result.mesh.named_points[0].point], Vec3(0.25, 0.25, 0));
}

}  // namespace
}  // namespace delquad
