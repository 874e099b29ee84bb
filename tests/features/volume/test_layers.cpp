// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "base/context.h"
#include "delquad/model.h"
#include "tests/features/volume/volume_checks.h"

namespace delquad::testing_support {
namespace {

constexpr VolumeCells kAroundLayers = VolumeCells::kPyramidsAndTets;

VolumeOptions layers(double first, int number, std::vector<std::string> on = {},
                     VolumeCells cells = VolumeCells::kHexDominant) {
  return {.cells = cells,
          .layers = LayerSpec{.on = std::move(on), .first = first, .growth = 1.5, .number = number}};
}

Mesh cube(int n) {
  return cube_surface(n, [](const Vec3& p) { return p; });
}

/// Gives the quads of each side of the box between (-1, -1, -1) and (1, 1, 1) a region: "x-", "x+", ...
Mesh with_sides(Mesh skin) {
  skin.regions.clear();
  for (const char* name : {"x-", "x+", "y-", "y+", "z-", "z+"})
    skin.regions.push_back({static_cast<int>(skin.regions.size()) + 1, {name}});
  for (std::size_t q = 0; q < skin.quads.size(); ++q)
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1})
        if (std::ranges::all_of(skin.quads[q], [&](int v) {
              return std::abs(coordinate(skin.points[v], axis) - side) < 1e-9;
            }))
          skin.quad_region[q] = 2 * axis + (side > 0 ? 1 : 0);
  return skin;
}

/// Fills a skin with layers; checks that it stays, and that all is sound and has this volume.
Mesh filled(const Mesh& skin, const VolumeOptions& options, double volume, ReadNotes* notes = nullptr) {
  const Mesh mesh = fill_skin(skin, options, notes);
  expect_sound_cells(mesh, volume);
  EXPECT_EQ(mesh.quads.size(), skin.quads.size());
  EXPECT_TRUE(std::equal(skin.points.begin(), skin.points.end(), mesh.points.begin()));
  return mesh;
}

/// The least and the largest distance from the skin's plane `axis` = -1 of hexahedra's points above quads.
std::array<double, 2> first_heights(const Mesh& mesh, std::size_t n_skin, const auto& height) {
  std::array<double, 2> range = {1e9, 0};
  for (const auto& hex : mesh.hexahedra)
    for (int k = 0; k < 4; ++k)
      if (std::ranges::all_of(hex.begin(), hex.begin() + 4,
                              [&](int v) { return v < static_cast<int>(n_skin); })) {
        const double h = height(mesh.points[hex[k + 4]]);
        range = {std::min(range[0], h), std::max(range[1], h)};
      }
  return range;
}

double depth_in_cube(const Vec3& p) { return 1 - std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

TEST(Layers, HaveTheirHeightsInACube) {
  const Mesh skin = cube(6);
  ReadNotes notes;
  const Mesh mesh = filled(skin, layers(0.02, 4, {}, kAroundLayers), 8, &notes);
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(mesh.hexahedra.size(), 4 * skin.quads.size());
  const auto [least, most] = first_heights(mesh, skin.points.size(), depth_in_cube);
  EXPECT_NEAR(least, 0.02, 1e-9);
  EXPECT_NEAR(most, 0.02, 1e-9);
}

TEST(Layers, EndByPrismsAtOtherFaces) {
  const Mesh skin = with_sides(cube(6));
  const Mesh mesh = filled(skin, layers(0.02, 3, {"z-"}), 8);
  EXPECT_EQ(mesh.prisms.size(), 3u * 4 * 4);
  EXPECT_GE(mesh.hexahedra.size(), 3u * 16);
  const Mesh two = filled(skin, layers(0.02, 3, {"z-", "x+"}, kAroundLayers), 8);
  EXPECT_EQ(two.hexahedra.size(), 3u * 2 * 4 * 5);
}

TEST(Layers, EndAroundSingleQuads) {
  Mesh skin = with_sides(cube(8));
  skin.regions.push_back({7, {"bare"}});
  for (std::size_t q = 0; q < skin.quads.size(); ++q) {
    Vec3 middle;
    for (const int v : skin.quads[q]) middle = middle + 0.25 * skin.points[v];
    for (const double at : {-0.375, 0.125})
      if (norm(middle - Vec3{at, at, -1}) < 1e-9) skin.quad_region[q] = 6;
  }
  VolumeOptions options = layers(0.02, 4, {"z-"}, kAroundLayers);
  options.layers->growth = 1;
  const Mesh mesh = filled(skin, options, 8);
  EXPECT_EQ(mesh.hexahedra.size(), 4u * (6 * 6 - 17));
  // Two at each rim, and where one corner is an end, on all layers but the first.
  EXPECT_EQ(mesh.prisms.size(), 4u * (24 + 8) + 3 * 6);
}

TEST(Layers, StandOnRowsOfOtherFaces) {
  // The sides have four rows of the layers' heights above z = -1.
  const double heights[] = {0.02, 0.05, 0.095, 0.1625};
  Mesh skin = with_sides(cube(8));
  for (Vec3& p : skin.points) {
    const double level = std::round((p.z + 1) * 4);
    p.z = level == 0 ? -1 : level <= 4 ? heights[int(level) - 1] - 1 : p.z * 0.8 + 0.2;
  }
  const Mesh mesh = filled(skin, layers(0.02, 4, {"z-"}, kAroundLayers), 8);
  EXPECT_EQ(mesh.hexahedra.size(), 4u * 64);
  EXPECT_TRUE(mesh.prisms.empty());
}

TEST(Layers, FollowACylinder) {
  const auto round = [](const Vec3& p) {
    const double u = std::max(std::abs(p.x), std::abs(p.y));
    if (u == 0) return p;
    const double angle = std::abs(p.x) >= std::abs(p.y)
                             ? std::atan(p.y / p.x) + (p.x < 0 ? std::numbers::pi : 0)
                             : std::numbers::pi / 2 - std::atan(p.x / p.y) + (p.y < 0 ? std::numbers::pi : 0);
    return Vec3{u * std::cos(angle), u * std::sin(angle), p.z};
  };
  const Mesh box = with_sides(cube(8));
  Mesh skin = box;
  for (Vec3& p : skin.points) p = round(p);
  double volume = measure(fill_skin(skin, {kAroundLayers})).volume;
  const Mesh mesh = filled(skin, layers(0.02, 4, {"x-", "x+", "y-", "y+"}), volume);
  double least = 1, most = 0;
  for (const auto& hex : mesh.hexahedra)
    for (int k = 0; k < 4; ++k) {
      const Vec3 &low = mesh.points[hex[k]], &high = mesh.points[hex[k + 4]];
      const double from = std::hypot(low.x, low.y);
      if (hex[k] >= static_cast<int>(skin.points.size()) || from < 1 - 1e-9 || std::abs(low.z) > 0.6)
        continue;
      least = std::min(least, from - std::hypot(high.x, high.y));
      most = std::max(most, from - std::hypot(high.x, high.y));
    }
  EXPECT_NEAR(least, 0.02, 2e-4);
  EXPECT_NEAR(most, 0.02, 2e-4);
}

TEST(Layers, TurnReentrantEdges) {
  const Mesh skin = skin_of_labels(6, [](int i, int j, int) { return i < 3 || j < 3; });
  const Mesh mesh = filled(skin, layers(0.1, 3, {}, kAroundLayers), 162);
  EXPECT_EQ(mesh.hexahedra.size(), 3 * skin.quads.size());
  filled(skin_of_labels(5, [](int i, int j, int k) { return i != 2 || j != 2 || k != 2; }), layers(0.1, 3),
         124);
}

TEST(Layers, ShrinkBetweenNearWalls) {
  const Mesh skin = cube_surface(8, [](const Vec3& p) { return Vec3{p.x, p.y, 0.1 * p.z}; });
  ReadNotes notes;
  const Mesh mesh = filled(skin, layers(0.05, 4, {}, kAroundLayers), 0.8, &notes);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("layers are lower"), std::string::npos) << notes[0];
  EXPECT_EQ(mesh.hexahedra.size(), 4 * skin.quads.size());
}

TEST(Layers, EndAtEdgesThatBodiesTouchAt) {
  const Mesh skin =
      skin_of_labels(4, [](int i, int j, int k) { return (i < 2) == (j < 2) || k < 2 ? 1 : 0; });
  ReadNotes notes;
  filled(skin, layers(0.1, 3), 48, &notes);
}

TEST(Layers, GrowInAllBodies) {
  const Mesh skin = skin_of_labels(4, [](int i, int, int) { return i < 2 ? 1 : 2; });
  const Mesh mesh = filled(skin, layers(0.05, 2, {}, kAroundLayers), 64);
  EXPECT_EQ(mesh.volumes.size(), 2u);
  EXPECT_EQ(mesh.hexahedra.size(), 2u * (skin.quads.size() + 16));
}

TEST(Layers, ShrinkToTheSameBytesOnAnyNumberOfThreads) {
  const Mesh skin = cube_surface(6, [](const Vec3& p) { return Vec3{p.x, p.y, 0.3 * p.z * (1.2 + p.x)}; });
  const auto by_threads = [&](int threads) {
    const RunScope run({.threads = threads});
    return fill_skin(skin, layers(0.05, 4));
  };
  const Mesh one = by_threads(1), two = by_threads(2);
  EXPECT_EQ(one.points, two.points);
  EXPECT_EQ(one.hexahedra, two.hexahedra);
  EXPECT_EQ(one.tetrahedra, two.tetrahedra);
}

TEST(Layers, AreRefused) {
  const auto refused = [](const VolumeOptions& options, std::initializer_list<const char*> parts) {
    expect_input_error([&] { fill_skin(with_sides(cube(3)), options); }, parts);
  };
  refused(layers(0.1, 2, {}, VolumeCells::kTets), {"layers have hexahedra", "hex-dominant"});
  refused(layers(0.1, 2, {"zz"}), {"zz"});
}

}  // namespace
}  // namespace delquad::testing_support
