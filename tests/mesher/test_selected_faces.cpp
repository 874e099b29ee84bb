// SPDX-License-Identifier: GPL-3.0-or-later
#include <map>
#include <set>

#include "metrics/surface/surface_report.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

using Spot = std::array<double, 3>;
Spot spot(const Vec3& x) { return {x.x, x.y, x.z}; }

/// Places of nodes by curve.
std::map<int, std::set<Spot>> nodes_of_curves(const Mesh& mesh) {
  std::map<int, std::set<Spot>> nodes;
  for (std::size_t l = 0; l < mesh.lines.size(); ++l)
    for (const int v : mesh.lines[l]) nodes[mesh.curves[mesh.line_curve[l]].tag].insert(spot(mesh.points[v]));
  return nodes;
}

/// Both meshes as one, with one node at each place.
Mesh united(const Mesh& a, const Mesh& b) {
  Mesh all;
  std::map<Spot, int> node;
  for (const Mesh* part : {&a, &b})
    for (auto quad : part->quads) {
      for (int& v : quad) {
        const auto [at, is_new] = node.try_emplace(spot(part->points[v]), static_cast<int>(node.size()));
        if (is_new) all.points.push_back(part->points[v]);
        v = at->second;
      }
      all.quads.push_back(quad);
      all.quad_region.push_back(0);
    }
  all.regions = {{1, {}}};
  return all;
}

/// The faces with an odd number and the others, each meshed alone, fit node by node.
void expect_fit(MeshProblem problem, const std::string& quality) {
  std::vector<int> halves[2];
  const Prepared whole = prepare(problem);
  for (const Entity& face : whole.fine().regions) halves[face.tag % 2].push_back(face.tag);
  std::vector<MeshResult> made;
  for (const std::vector<int>& half : halves) {
    problem.surface.faces = {{.numbers = half}};
    made.push_back(mesh(problem, quality));
    std::set<int> tags;
    for (const int r : made.back().mesh.quad_region) tags.insert(made.back().mesh.regions[r].tag);
    EXPECT_EQ(std::vector<int>(tags.begin(), tags.end()), half);
    EXPECT_TRUE(made.back().mesh.triangles.empty());
    EXPECT_TRUE(made.back().failures.empty());
  }
  const auto nodes = nodes_of_curves(made[0].mesh), others = nodes_of_curves(made[1].mesh);
  int n_common = 0;
  for (const auto& [curve, places] : nodes)
    if (const auto at = others.find(curve); at != others.end()) {
      ++n_common;
      EXPECT_EQ(places, at->second) << quality << ", curve " << curve;
    }
  EXPECT_GT(n_common, 3);
  const Mesh all = united(made[0].mesh, made[1].mesh);
  EXPECT_EQ(check_invariants(all), std::vector<std::string>());
  EXPECT_TRUE(topology_of(all).watertight()) << quality;
}

TEST(SelectedFaces, FitTheOthersNodeByNode) {
  for (const char* quality : {"good", "best", "regular"}) {
    expect_fit(problem_of(ExampleModel{"bracket"}, 6), quality);
    expect_fit(problem_of(TriangleModel{box(4, 3, 2, 1), "block"}, 0.27), quality);
  }
}

/// Numbers of the faces of a block that are meshed.
std::set<int> meshed_by(const PartRule& rule) {
  Mesh block = box(2, 3, 2, 1);
  block.regions[2].names = {"side_low"};
  block.regions[3].names = {"side_high"};
  MeshProblem problem = problem_of(TriangleModel{std::move(block), "block"}, 0.5);
  problem.surface.faces = {rule};
  problem.surface.where = "m.toml:4";
  const Mesh made = mesh(problem, "DB").mesh;
  std::set<int> tags;
  for (const int r : made.quad_region) tags.insert(made.regions[r].tag);
  return tags;
}

TEST(SelectedFaces, AreFoundAsNamesAreGiven) {
  using Tags = std::set<int>;
  EXPECT_EQ(meshed_by({.like = "side_low"}), Tags{3});
  EXPECT_EQ(meshed_by({.like = "side_*"}), (Tags{3, 4}));
  EXPECT_EQ(meshed_by({.like = "region_5"}), Tags{5});
  EXPECT_EQ(meshed_by({.normal = Vec3{0, 0, 1}}), Tags{6});
  EXPECT_EQ(meshed_by({.box = {{Vec3{0, 0, 0}, Vec3{0, 2, 1}}}}), Tags{1});
  EXPECT_EQ(meshed_by({.at = Vec3{3.2, 1, 0.4}}), Tags{2});
  expect_input_error([] { meshed_by({.like = "side_lo"}); },
                     {"m.toml:4", "side_lo", "did you mean 'side_low'"});
  expect_input_error([] { meshed_by({.numbers = {7}}); }, {"m.toml:4", "no face 7"});
  expect_input_error(
      [] {
        meshed_by({.normal = Vec3{1, 1, 0}});
      },
      {"no face of the 6 fits the rule for 'faces'"});
}

}  // namespace
}  // namespace delquad
