// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/features/layers/layered_model.h"

namespace delquad {
namespace {

/// Every node of `to` is the image of just one of `from`.
void expect_pairs(const Mesh& mesh, const std::string& from, const std::string& to) {
  std::set<int> images, masters;
  for (const PeriodicNodes& pair : mesh.periodic)
    for (const auto& [node, master] : pair.nodes) {
      EXPECT_LT(norm(pair.motion(mesh.points[master]) - mesh.points[node]), 1e-13);
      EXPECT_TRUE(images.insert(node).second);
      EXPECT_TRUE(masters.insert(master).second);
    }
  EXPECT_EQ(images, nodes_named(mesh, to));
  EXPECT_EQ(masters, nodes_named(mesh, from));
}

/// A channel with a wavy floor, whose sides are periodic.
ModelMaker channel() {
  const auto floor = [](double t) { return Vec2{2 * t, 0.1 * std::sin(2 * std::numbers::pi * t)}; };
  return ModelMaker().loop({make_parametric_curve(floor, 0, 1), make_segment({2, 0}, {2, 1}),
                            make_segment({2, 1}, {0, 1}), make_segment({0, 1}, {0, 0})},
                           "", {"floor", "right", "roof", "left"});
}

TEST(LayersThatMeet, EndsOnPeriodicSidesMatch) {
  for (const bool are_two : {false, true})
    for (const long long seed : {0, 5}) {
      SCOPED_TRACE(are_two);
      std::vector<LayerSpec> layers = {layer_on({"floor"}, 1e-3, 11)};
      if (are_two) layers.push_back(layer_on({"roof"}, 2e-3, 6));
      MeshProblem problem = channel().problem(0.07, layers);
      problem.periodic = {{"left", "right", {{2, 0, 0}}, "p 1"}};
      problem.seed = seed;
      for (const char* word : {"DB", "DBCO"}) {
        const MeshResult result = mesh(problem, word);
        expect_good_quads(result);
        expect_pairs(result.mesh, "left", "right");
        EXPECT_EQ(count_of(result, "quads"), 11 * lines_on(result.mesh, {"floor"}) +
                                                 (are_two ? 6 : 0) * lines_on(result.mesh, {"roof"}));
      }
    }
}

TEST(LayersThatMeet, BladesBetweenPeriodicSides) {
  ModelMaker model = ModelMaker().rectangle({-1, -0.4}, {2, 0.4}, {"low", "out", "high", "in"});
  const auto blade = [](double t) {
    const double a = 2 * std::numbers::pi * t;
    return Vec2{0.5 + 0.5 * std::cos(a), 0.08 * std::sin(a) + 0.1 * std::cos(a)};
  };
  model.loop({make_parametric_curve(blade, 0, 1)}, "", {"blade"});
  MeshProblem problem = model.problem(0.05, {layer_on({"blade"}, 1e-4, 15)});
  problem.periodic = {{"low", "high", {{0, 0.8, 0}}, "p 1"}};
  const MeshResult result = mesh(problem, "DBCO");
  expect_layers(problem, result);
  expect_pairs(result.mesh, "low", "high");
}

TEST(LayersThatMeet, APeriodicSideWithoutThemIsAnError) {
  MeshProblem problem =
      ModelMaker()
          .polygon({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {0, 1}}, {"plate", "free", "right", "top", "left"})
          .problem(0.1, {layer_on({"plate"}, 1e-3, 5)});
  problem.periodic = {{"left", "right", {{2, 0, 0}}, "p 1"}};
  expect_refused(problem, "DB", {"layer", "'left'", "'right'", "periodic"});
  problem.layers = {layer_on({"plate"}, 1e-3, 5), layer_on({"free"}, 1e-3, 6)};
  problem.layers[1].where = "layer 2";
  expect_refused(problem, "DB", {"5 layers meet 6 of layer 2", "periodic"});
}

void expect_symmetric(const Mesh& mesh, const std::function<Vec3(Vec3)>& mirror) {
  const auto key = [](const Vec3& x) {
    return std::pair(std::llround(x.x * 1e11), std::llround(x.y * 1e11));
  };
  std::set<std::pair<long long, long long>> points;
  for (const Vec3& x : mesh.points) points.insert(key(x));
  for (const Vec3& x : mesh.points) EXPECT_TRUE(points.contains(key(mirror(x)))) << x.x << ' ' << x.y;
}

TEST(LayersThatMeet, SymmetricAirfoils) {
  for (const bool is_sharp : {true, false}) {
    SCOPED_TRACE(is_sharp);
    MeshProblem problem = naca0012(is_sharp, 1e-5);
    problem.symmetry.planes = {{{0, 0, 0}, {0, 1, 0}}};
    const MeshResult result = mesh(problem, "DBCO");
    expect_layers(problem, result);
    EXPECT_EQ(count_of(result, "fans"), 4);
    expect_symmetric(result.mesh, [](Vec3 x) { return Vec3{x.x, -x.y, x.z}; });
    for (const double h : first_heights(result.mesh, "airfoil")) EXPECT_LT(h, 1.2e-5);
  }
}

TEST(LayersThatMeet, TwoPlanesAndWallsThatHaveImages) {
  ModelMaker model = ModelMaker().rectangle({-2, -1}, {2, 1}, {"south", "east", "north", "west"});
  model.circle({0, 0}, 0.3, "hole");
  MeshProblem problem =
      model.problem(0.08, {layer_on({"hole"}, 1e-3, 9), layer_on({"south", "north"}, 1e-3, 7)});
  problem.symmetry.planes = {{{0, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {1, 0, 0}}};
  for (const char* word : {"DB", "DBCO"}) {
    const MeshResult result = mesh(problem, word);
    expect_good_quads(result);
    expect_symmetric(result.mesh, [](Vec3 x) { return Vec3{x.x, -x.y, x.z}; });
    expect_symmetric(result.mesh, [](Vec3 x) { return Vec3{-x.x, x.y, x.z}; });
    EXPECT_EQ(count_of(result, "quads"),
              9 * lines_on(result.mesh, {"hole"}) + 7 * lines_on(result.mesh, {"south", "north"}));
  }
  problem.layers = {layer_on({"south"}, 1e-3, 7)};
  expect_refused(problem, "DB", {"layer", "'south'", "'north'", "mirror images"});
}

/// A solid disc in a channel of fluid, cut in two halves.
ModelMaker disc_in_channel() {
  using std::numbers::pi;
  return ModelMaker()
      .rectangle({-2, -1}, {2, 1}, {"floor", "out", "roof", "in"}, "fluid")
      .curve(make_arc({0, 0}, 0.5, 0, pi), "skin")
      .curve(make_arc({0, 0}, 0.5, pi, 2 * pi), "skin")
      .curve(make_segment({-0.5, 0}, {0.5, 0}), "cut")
      .loop_of({4, 6}, "upper")
      .loop_of({5, 6}, "lower");
}

TEST(LayersThatMeet, InterfacesHaveThemOnBothSides) {
  for (const int number : {8, 9}) {
    const MeshProblem problem = disc_in_channel().problem(0.08, {layer_on({"skin"}, 1e-3, number)});
    for (const char* word : {"DB", "DBCO"}) {
      const MeshResult result = mesh(problem, word);
      expect_good_quads(result);
      EXPECT_EQ(count_of(result, "columns"), 2 * lines_on(result.mesh, {"skin"}));
      EXPECT_EQ(count_of(result, "quads"), 2 * number * lines_on(result.mesh, {"skin"}));
    }
  }
}

TEST(LayersThatMeet, IntoNamedRegionsOnly) {
  LayerSpec outside = layer_on({"skin"}, 1e-3, 8), inside = layer_on({"skin"}, 4e-3, 4, 1.5);
  outside.into = {"fluid"};
  const MeshProblem one = disc_in_channel().problem(0.08, {outside});
  const MeshResult result = mesh(one, "DBCO");
  expect_layers(one, result);
  std::map<std::string, long long> quads;
  for (const double h : first_heights(result.mesh, "skin")) quads[h < 1.5e-3 ? "layer" : "free"] += 1;
  EXPECT_EQ(quads["layer"], lines_on(result.mesh, {"skin"}));
  EXPECT_EQ(quads["free"], lines_on(result.mesh, {"skin"}));
  inside.into = {"upper", "lower"};
  const MeshResult both = mesh(disc_in_channel().problem(0.08, {outside, inside}), "DBCO");
  expect_good_quads(both);
  EXPECT_EQ(count_of(both, "quads"), (8 + 4) * lines_on(both.mesh, {"skin"}));
  outside.into = {"upper"};
  expect_refused(disc_in_channel().problem(0.08, {outside, inside}), "DB", {"'skin' has a layer already"});
  outside.on = {"roof"};
  expect_refused(disc_in_channel().problem(0.08, {outside}), "DB",
                 {"'roof' bounds none of the regions 'upper'"});
}

TEST(LayersThatMeet, WallsBetweenRegionsAreShared) {
  const ModelMaker model = ModelMaker()
                               .rectangle({0, 0}, {1, 1}, {"floor", "mid", "top", "west"}, "one")
                               .rectangle({1, 0}, {2.2, 1}, {"floor", "east", "top", "mid"}, "two");
  for (const int number : {7, 10}) {
    const MeshProblem problem = model.problem(0.09, {layer_on({"floor"}, 1e-3, number)});
    for (const char* word : {"DB", "DBCO"}) {
      const MeshResult result = mesh(problem, word);
      expect_layers(problem, result);
      EXPECT_EQ(result.mesh.regions.size(), 2u);
    }
  }
  // Beside a region without layers an odd number of them leaves the walls to make both even.
  LayerSpec left = layer_on({"floor"}, 1e-3, 7);
  left.into = {"one"};
  expect_good_quads(mesh(model.problem(0.09, {left}), "DBCO"));
}

TEST(LayersThatMeet, DifferentNumbersMeetInAStep) {
  for (const std::vector<Vec2>& corners : {std::vector<Vec2>{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
                                           std::vector<Vec2>{{0, 0}, {2, 0}, {2, 1.2}, {0, 1}},
                                           std::vector<Vec2>{{0, 0}, {1, 0}, {2, 0.1}, {2, 2}}}) {
    std::vector<std::string> names = {"a", "b"};
    const MeshProblem problem =
        ModelMaker()
            .polygon(corners, names)
            .problem(0.06, {layer_on({"a"}, 1e-3, 10, 1.3), layer_on({"b"}, 2e-3, 5, 1.4)});
    for (const char* word : {"DB", "DBCO"}) {
      const MeshResult result = mesh(problem, word);
      expect_good_quads(result);
      const long long fans = count_of(result, "fans");
      EXPECT_EQ(count_of(result, "quads"), 10 * lines_on(result.mesh, {"a"}) +
                                               5 * lines_on(result.mesh, {"b"}) + fans + 2 * fans * (10 - 1));
    }
  }
}

TEST(LayersThatMeet, GridsBesideThemStay) {
  const ModelMaker model = ModelMaker()
                               .rectangle({0, 0}, {1, 1}, {"s", "mid", "n", "w"}, "grid")
                               .rectangle({1, 0}, {2, 1}, {"s2", "e", "n2", "mid"}, "free");
  LayerSpec layer = layer_on({"mid"}, 1e-3, 6);
  layer.into = {"free"};
  MeshProblem problem = model.problem(0.1, {layer});
  problem.mapped.names = {"grid"};
  const MeshResult result = mesh(problem, "DBCO");
  expect_layers(problem, result);
  EXPECT_EQ(std::ranges::count_if(result.mesh.quad_region,
                                  [&](int r) { return result.mesh.regions[r].names[0] == "grid"; }),
            100);
  problem.layers[0].into = {};
  expect_refused(problem, "DB", {"layer", "grid 'grid'", "mapped"});
  problem.mapped = {{}, true};
  expect_good_quads(mesh(problem, "DBCO"));
}

TEST(LayersThatMeet, DividedWallsAreRefused) {
  MeshProblem problem = ModelMaker()
                            .rectangle({0, 0}, {2, 1}, {"south", "east", "north", "west"})
                            .problem(0.1, {layer_on({"south"}, 1e-3, 5)});
  problem.divisions = {{"east", 9}};
  expect_refused(problem, "DB", {"layer", "'east'", "divide"});
  problem.divisions = {{"south", 24}};
  const MeshResult result = mesh(problem, "DBCO");
  expect_layers(problem, result);
  EXPECT_EQ(lines_on(result.mesh, {"south"}), 24);
}

}  // namespace
}  // namespace delquad
