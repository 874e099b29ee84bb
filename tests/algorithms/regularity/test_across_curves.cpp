// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/regularity/across_curves.h"
#include "algorithms/regularity/patterns.h"
#include "tests/algorithms/stages.h"

namespace delquad {
namespace {

constexpr double kHeight = 8;

/// Rectangles side by side, each in a plane of its own, with so many edges on the curves between them and at
/// both ends. `counts`[k] belongs to the k-th curve.
class Rectangles {
 public:
  Rectangles(const std::vector<double>& widths, const std::vector<int>& counts) : widths_(widths) {
    const int n = static_cast<int>(widths.size());
    for (const int edges : counts) add_curve(edges);
    for (int p = 0; p < n; ++p) {
      network.sides[p + 1] = p + 1 < n ? std::array{p, p + 1} : std::array{-1, -1};
      add_patch(p, counts[p], counts[p + 1]);
    }
    network.at = [this](int patch, int curve, double place) {
      return Vec2{curve == patch ? 0 : widths_[patch], place};
    };
  }
  Rectangles(const Rectangles&) = delete;

  int irregular() const {
    int sum = 0;
    for (const PatchAtCurves& patch : network.patches) sum += count_irregular(patch.mesh);
    return sum;
  }

  /// Patches are meshes that have the nodes of the network, both sides of each curve.
  void expect_conforming() const {
    for (std::size_t p = 0; p < network.patches.size(); ++p) {
      const PatchAtCurves& patch = network.patches[p];
      EXPECT_NO_THROW(QuadTopology{patch.mesh});
      ASSERT_EQ(patch.edges.size(), static_cast<std::size_t>(patch.mesh.n_boundary));
      for (std::size_t i = 0; i < patch.edges.size(); ++i) {
        const auto& [curve, index, forward] = patch.edges[i];
        if (curve > static_cast<int>(network.patches.size())) continue;  // at the bottom or the top
        const double place = network.nodes[curve].at(forward ? index : index + 1);
        EXPECT_EQ(patch.mesh.points[i], network.at(static_cast<int>(p), curve, place)) << p << " " << i;
      }
    }
  }

  CurveNetwork network;

 private:
  int add_curve(int edges) {
    auto& nodes = network.nodes.emplace_back();
    for (int i = 0; i <= edges; ++i) nodes.push_back(kHeight * i / edges);
    network.sides.push_back({-1, -1});
    return static_cast<int>(network.nodes.size()) - 1;
  }

  void add_patch(int p, int left, int right) {
    const double w = widths_[p];
    const int across = static_cast<int>(w);
    const std::array<Vec2, 4> corners{Vec2{0, 0}, {w, 0}, {w, kHeight}, {0, kHeight}};
    const std::array edges{across, right, across, left};
    const std::array curves{add_curve(across), p + 1, add_curve(across), p};
    Outline outline;
    PatchAtCurves patch;
    for (int side = 0; side < 4; ++side)
      for (int k = 0; k < edges[side]; ++k) {
        const double t = double(k) / edges[side];
        outline.places.push_back(side == 1   ? Vec2{w, network.nodes[p + 1][k]}
                                 : side == 3 ? Vec2{0, network.nodes[p][left - k]}
                                             : corners[side] + t * (corners[(side + 1) % 4] - corners[side]));
        outline.delta.push_back(1);
        outline.turn.push_back(k == 0 ? 1 : 0);
        patch.edges.push_back({curves[side], side == 3 ? left - 1 - k : k, side != 3});
      }
    const PatternMesh fill = mesh_pattern(outline, best_pattern(outline, 4).value());
    patch.mesh = {.points = outline.places, .quads = fill.quads, .triangles = {}, .n_boundary = 0};
    patch.mesh.n_boundary = static_cast<int>(outline.places.size());
    patch.mesh.points.insert(patch.mesh.points.end(), fill.inside.begin(), fill.inside.end());
    patch.size = &size_;
    network.patches.push_back(std::move(patch));
  }

  std::vector<double> widths_;
  FunctionSize size_{[](Vec2) { return 1.0; }};
};

TEST(AcrossCurves, TwoFacesGiveUpEdgesOfTheCurveBetweenThem) {
  Rectangles both({8, 8}, {8, 10, 8});
  ASSERT_EQ(both.irregular(), 4);
  const auto before = both.network.nodes;
  const AcrossCurvesSummary summary = make_regular_across_curves(both.network, {});
  EXPECT_EQ(summary.accepted, 1);
  EXPECT_EQ(summary.gained, 4);
  EXPECT_EQ(both.irregular(), 0);
  const auto& nodes = both.network.nodes[1];
  ASSERT_EQ(nodes.size(), 9u);
  EXPECT_TRUE(std::ranges::is_sorted(nodes));
  EXPECT_EQ(nodes.front(), 0);
  EXPECT_EQ(nodes.back(), kHeight);
  for (std::size_t c = 0; c < before.size(); ++c) {
    if (c == 1) continue;
    EXPECT_EQ(both.network.nodes[c], before[c]) << c;
  }
  both.expect_conforming();
}

TEST(AcrossCurves, AStripBetweenTwoFacesHandsItOn) {
  Rectangles three({8, 2, 8}, {8, 10, 10, 8});
  ASSERT_EQ(three.irregular(), 4);
  const AcrossCurvesSummary summary = make_regular_across_curves(three.network, {});
  EXPECT_EQ(summary.longest, 3);
  EXPECT_EQ(three.irregular(), 0);
  EXPECT_EQ(three.network.nodes[1].size(), 9u);
  EXPECT_EQ(three.network.nodes[2].size(), 9u);
  three.expect_conforming();
}

TEST(AcrossCurves, AnyNumberOfThreadsFillsTheSame) {
  // Each face takes part in what two curves ask for, so that visits at once are in each other's way.
  std::vector<int> counts;
  for (int k = 0; k <= 12; ++k) counts.push_back(k % 2 == 0 ? 8 : 10);
  on_threads({1, 3}, [&] {
    Rectangles many(std::vector<double>(12, 8), counts);
    EXPECT_EQ(many.irregular(), 24);
    const AcrossCurvesSummary summary = make_regular_across_curves(many.network, {});
    EXPECT_GE(summary.accepted, 6);
    EXPECT_EQ(many.irregular(), 0);
    many.expect_conforming();
    std::vector<std::pair<std::vector<Vec2>, std::vector<std::array<int, 4>>>> patches;
    for (const auto& patch : many.network.patches) patches.emplace_back(patch.mesh.points, patch.mesh.quads);
    return std::tuple(summary.tried, many.network.nodes, patches);
  });
}

TEST(AcrossCurves, NothingChangesWhereCurvesStay) {
  Rectangles both({8, 8}, {8, 10, 8});
  both.network.sides[1] = {-1, -1};
  const auto before = both.network;
  EXPECT_EQ(make_regular_across_curves(both.network, {}).accepted, 0);
  for (std::size_t p = 0; p < before.patches.size(); ++p) {
    EXPECT_EQ(both.network.patches[p].mesh.points, before.patches[p].mesh.points);
    EXPECT_EQ(both.network.patches[p].mesh.quads, before.patches[p].mesh.quads);
  }
}

TEST(AcrossCurves, EdgesStayNearTheirSize) {
  // Regular faces would need edges twice as long as wanted.
  Rectangles both({8, 8}, {4, 8, 4});
  EXPECT_EQ(make_regular_across_curves(both.network, {}).accepted, 0);
  EXPECT_EQ(both.network.nodes[1].size(), 9u);
}

}  // namespace
}  // namespace delquad
