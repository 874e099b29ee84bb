// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/naming/name_parts.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

constexpr double kX = 3, kY = 2, kZ = 1;

MeshProblem block() {
  MeshProblem problem;
  Mesh mesh = box(2, kX, kY, kZ);
  mesh.regions[2].names = {"side_low"};
  mesh.regions[3].names = {"side_high"};
  problem.model = TriangleModel{std::move(mesh), "block"};
  problem.size.field = make_constant_size(0.5);
  return problem;
}

/// Numbers of the regions and curves of the mesh that have the name, ascending.
std::vector<int> named(const MeshProblem& problem, const std::string& name, bool curves = false) {
  std::vector<int> tags;
  const Mesh mesh = delquad::mesh(problem, "DB").mesh;
  for (const Entity& e : curves ? mesh.curves : mesh.regions)
    if (std::ranges::find(e.names, name) != e.names.end()) tags.push_back(e.tag);
  std::ranges::sort(tags);
  return tags;
}

std::vector<int> named_by(const NamedPart& part) {
  MeshProblem problem = block();
  problem.surface.names = {part};
  return named(problem, part.name, part.curves);
}

TEST(NamedParts, AreFoundInEveryWay) {
  using Tags = std::vector<int>;
  EXPECT_EQ(named_by({.name = "end", .rule = {.at = Vec3{3.2, 1, 0.4}}}), (Tags{2}));
  EXPECT_EQ(named_by({.name = "sides", .rule = {.like = "side_*"}}), (Tags{3, 4}));
  EXPECT_EQ(named_by({.name = "last", .rule = {.like = "*d*h*g*"}}), (Tags{4}));
  EXPECT_EQ(named_by({.name = "low", .rule = {.like = "side_l?w"}}), (Tags{3}));
  EXPECT_EQ(named_by({.name = "up", .rule = {.normal = Vec3{0.05, 0, 7}}}), (Tags{6}));
  EXPECT_EQ(named_by({.name = "ends", .rule = {.numbers = {1, 2}}}), (Tags{1, 2}));
  EXPECT_EQ(named_by({.name = "bottom", .rule = {.box = {{Vec3{3, 2, 0}, Vec3{0, 0, 0}}}}}), (Tags{5}));
  EXPECT_EQ(named_by({.name = "both fit", .rule = {.numbers = {1, 4, 6}, .normal = Vec3{0, 1, 0}}}),
            (Tags{4}));
  EXPECT_EQ(
      named_by({.name = "rim", .curves = true, .rule = {.box = {{Vec3{0, 0, 1}, Vec3{3, 2, 1}}}}}).size(),
      4U);
  EXPECT_EQ(named_by({.name = "edge", .curves = true, .rule = {.at = Vec3{1, -0.1, 1.1}}}).size(), 1U);
}

TEST(NamedParts, KeepNamesAndStandForSizesAndCompounds) {
  MeshProblem problem = block();
  problem.surface.names = {{.name = "wall", .rule = {.like = "side_low"}},
                           {.name = "end", .rule = {.at = Vec3{3.2, 1, 0.4}}},
                           {.name = "end_too", .rule = {.like = "end"}}};
  problem.size.named = {{.name = "end", .size = 0.1}};
  EXPECT_EQ(named(problem, "side_low"), std::vector<int>{3});
  EXPECT_EQ(named(problem, "wall"), std::vector<int>{3});
  EXPECT_EQ(named(problem, "end_too"), std::vector<int>{2});
  const Mesh mesh = delquad::mesh(problem, "DB").mesh;
  const auto in_end = std::ranges::count(mesh.quad_region, 1);
  EXPECT_NEAR(static_cast<double>(in_end), kY * kZ / (0.1 * 0.1), 40);
  problem.surface.compounds = Compounds::kGroups;
  problem.surface.groups = {{2, 3}};
  EXPECT_EQ(named(problem, "end").size(), 1U);
}

TEST(NamedParts, RefuseWhatDoesNotFit) {
  const auto refuses = [](NamedPart part, std::initializer_list<const char*> says) {
    part.where = "m.toml:4";
    expect_input_error([&] { named_by(part); }, says);
  };
  refuses({.name = "a", .rule = {.numbers = {7}}}, {"m.toml:4", "no face 7"});
  refuses({.name = "a", .rule = {.like = "inlet*"}}, {"no face of the 6 fits the rule for the name 'a'"});
  refuses({.name = "a", .rule = {.at = Vec3{3, 2, 0.5}}}, {"as near to"});
  refuses({.name = "a", .rule = {.at = Vec3{NAN, 2, 0.5}}}, {"not finite"});
  refuses({.name = "a"}, {"nothing says what the name 'a' is"});
  refuses({.name = "a", .curves = true, .rule = {.normal = Vec3{0, 0, 1}}}, {"curves have no normals"});
  refuses({.name = "a", .rule = {.normal = Vec3{0, 0, 0}}}, {"no length"});
  refuses({.name = "", .rule = {.numbers = {1}}}, {"m.toml:4", "'as' is empty"});
}

}  // namespace
}  // namespace delquad
