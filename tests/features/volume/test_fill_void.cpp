// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/volume/fill_steps.h"
#include "tests/features/volume/volume_checks.h"

namespace delquad::testing_support {
namespace {

/// Adds the unit cube at (i, j, k) as a hexahedron, whose new vertices are stretched from the center of the
/// skin.
void add_hexahedron(Mesh& body, int i, int j, int k, double stretch = 1) {
  const Vec3 centre{2.5, 2.5, 2.5};
  std::array<int, 8> cell;
  for (int n = 0; n < 8; ++n) {
    const int x = i + (n % 4 == 1 || n % 4 == 2), y = j + (n % 4 >= 2), z = k + (n >= 4);
    const bool on_skin = x % 5 == 0 || y % 5 == 0 || z % 5 == 0;
    const Vec3 at{double(x), double(y), double(z)}, to = on_skin ? at : centre + stretch * (at - centre);
    const auto found = std::ranges::find(body.points, to);
    cell[n] = static_cast<int>(found - body.points.begin());
    if (found == body.points.end()) body.points.push_back(to);
  }
  body.hexahedra.push_back(cell);
}

Mesh box() {
  return skin_of_labels(5, [](int, int, int) { return 1; });
}

void expect_full(Mesh body) {
  body.volumes = {{1, {}}};
  expect_sound_cells(body, 125);
}

TEST(FillAround, KeepsCellsInside) {
  Mesh body = box();
  for (const auto& [i, j, k] : {std::array{0, 0, 0}, {1, 0, 0}, {2, 2, 2}, {3, 2, 2}, {4, 2, 2}, {2, 4, 0}})
    add_hexahedron(body, i, j, k);
  EXPECT_TRUE(fill_around(body).empty());
  ASSERT_EQ(body.hexahedra.size(), 6u);
  expect_full(body);
}

TEST(FillAround, FillsNothingBetweenCells) {
  Mesh body = box();
  for (int n = 0; n < 125; ++n) add_hexahedron(body, n % 5, n / 5 % 5, n / 25);
  EXPECT_TRUE(fill_around(body).empty());
  EXPECT_EQ(body.hexahedra.size(), 125u);
  EXPECT_TRUE(body.pyramids.empty() && body.tetrahedra.empty());
}

TEST(FillAround, MakesRoomBetweenCells) {
  Mesh body = box();
  add_hexahedron(body, 2, 2, 0);
  // This one leaves too little space above the first.
  add_hexahedron(body, 2, 2, 2, 2.98);
  EXPECT_TRUE(fill_around(body).empty());
  EXPECT_GT(measure(body).least_jacobian, 0.1);
  expect_full(body);
}

TEST(FillAround, UsesTrianglesOfPrisms) {
  Mesh body = box();
  const auto at = [&](const Vec3& p) {
    const auto found = std::ranges::find(body.points, p);
    const int v = static_cast<int>(found - body.points.begin());
    if (found == body.points.end()) body.points.push_back(p);
    return v;
  };
  body.prisms.push_back(
      {at({2, 2, 0}), at({3, 2, 0}), at({2.5, 2.3, 1}), at({2, 3, 0}), at({3, 3, 0}), at({2.5, 2.7, 1})});
  std::swap(body.prisms[0][1], body.prisms[0][2]), std::swap(body.prisms[0][4], body.prisms[0][5]);
  EXPECT_TRUE(fill_around(body).empty());
  EXPECT_EQ(body.prisms.size(), 1u);
  expect_full(body);
}

}  // namespace
}  // namespace delquad::testing_support
