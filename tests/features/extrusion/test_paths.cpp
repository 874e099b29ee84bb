// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/extrusion/layers.h"
#include "features/extrusion/section.h"
#include "tests/features/extrusion/hex_checks.h"

namespace delquad::testing_support {
namespace {

/// [0, 3]^2 without its middle third, in a plane at `offset` from the z axis.
Mesh holed_plate(double offset = 0) {
  Mesh mesh = quad_grid(3, 3, 3, 3);
  mesh.quads.erase(mesh.quads.begin() + 4);
  mesh.quad_region.pop_back();
  for (Vec3& p : mesh.points) p = {p.x + offset, 0, p.y};
  return mesh;
}

std::vector<Vec3> half_circle(double radius, int segments) {
  std::vector<Vec3> points;
  for (int i = 0; i <= segments; ++i) {
    const double a = kPi * i / segments;
    points.push_back({radius * std::cos(a), radius * std::sin(a), 0});
  }
  return points;
}

TEST(Extrude, AlongAVectorVolumeIsAreaTimesHeight) {
  for (const Vec3& shift : {Vec3{0, 2, 0}, Vec3{0, -2, 0}, Vec3{1.5, 2, -0.7}}) {
    const Mesh mesh = extrude(holed_plate(), AlongVector{shift}, {5});
    expect_sound(mesh);
    EXPECT_EQ(mesh.hexahedra.size(), 40u);
    EXPECT_EQ(mesh.points.size(), 96u);
    EXPECT_NEAR(measure(mesh).volume, 8 * 2, 1e-12);
  }
  EXPECT_NEAR(measure(extrude(quad_grid(2, 2), AlongVector{{0, 0, 3}}, {2})).least_jacobian, 1, 1e-15);
  const double slant = measure(extrude(quad_grid(2, 2), AlongVector{{1, 0, 1}}, {2})).least_jacobian;
  EXPECT_NEAR(slant, std::sqrt(0.5), 1e-12);
}

TEST(Extrude, LayersGrow) {
  for (const double growth : {1.0, 1.5, 0.25, 3.0}) {
    const Mesh mesh = extrude(quad_grid(1, 1), AlongVector{{0, 0, 7}}, {6, growth});
    double before = 0, last = 0;
    for (int layer = 0; layer < 6; ++layer) {
      const double height = mesh.points[4 * (layer + 1)].z - mesh.points[4 * layer].z;
      if (layer > 0) {
        EXPECT_NEAR(height / before, growth, 1e-12);
      }
      before = height;
      last = mesh.points[4 * (layer + 1)].z;
    }
    EXPECT_EQ(last, 7);
  }
  EXPECT_NEAR(layer_ends(3, 2)[1], 1.0 / 7, 1e-15);
  EXPECT_NEAR(layer_ends(3, 0.5)[1], 4.0 / 7, 1e-15);
  expect_input_error([] { layer_ends(2000, 2); }, {"growth of 2", "2000 layers"});
  expect_input_error([] { layer_ends(3, 0); }, {"growth of 0"});
}

/// Between sections that are turned by an angle lie hexahedra with straight edges. A ring of n parts has
/// sin(2 pi / n) n / (2 pi) of Pappus' volume.
TEST(Extrude, AroundAnAxisVolumeIsThatOfPappus) {
  const Mesh plate = holed_plate(4);
  const double pappus = 2 * kPi * (4 + 1.5) * 8;
  double error_before = 0;
  for (const int n : {8, 16, 32}) {
    const Mesh ring = extrude(plate, AroundAxis{{0, 0, -5}, {0, 0, 2}}, {n});
    expect_sound(ring);
    EXPECT_EQ(ring.points.size(), 16u * n);
    const double volume = measure(ring).volume;
    EXPECT_NEAR(volume, pappus * std::sin(2 * kPi / n) * n / (2 * kPi), 1e-10);
    const double error = pappus - volume;
    if (error_before > 0) {
      EXPECT_NEAR(error_before / error, 4, 0.3);
    }
    error_before = error;
    EXPECT_EQ(quads_by_name(ring),
              (std::map<std::string, int>{
                  {"south", 3 * n}, {"east", 3 * n}, {"north", 3 * n}, {"west", 3 * n}, {"curve_5", 4 * n}}));
    for (const double degrees : {90.0, -90.0}) {
      const Mesh part = extrude(plate, AroundAxis{{}, {0, 0, 1}, degrees}, {n / 4});
      expect_sound(part);
      EXPECT_NEAR(measure(part).volume, volume / 4, 1e-10);
      EXPECT_NEAR(part.points.back().x, 0, 1e-12);
      EXPECT_NEAR(part.points.back().y, std::copysign(7, degrees), 1e-12);
    }
  }
}

TEST(Extrude, SectionsMustLieBesideTheirAxis) {
  const auto around = [](const Vec3& point, const Vec3& axis, std::initializer_list<const char*> parts) {
    expect_not_extruded(quad_grid(4, 4), AroundAxis{point, axis}, {12}, parts);
  };
  around({}, {0, 1, 0}, {"node at (0, 0, 0)", "on the axis"});
  around({0.3, 0, 0}, {0, 1, 0}, {"crosses its axis between"});
  around({0.3, 0.3, 0}, {0, 0, 1}, {"axis goes through the quad at (0.25, 0.25, 0)"});
  around({2, 0, 0}, {0, 0, 1}, {"inverted or flat"});
  around({2, 0, 0}, {0, 0, 0}, {"direction that is not 0"});
  expect_not_extruded(quad_grid(1, 1), AroundAxis{{2, 0, 0}, {0, 1, 0}}, {2}, {"at least 3"});
  expect_not_extruded(quad_grid(1, 1), AroundAxis{{2, 0, 0}, {0, 1, 0}, 400}, {9}, {"at most 360"});
  expect_not_extruded(quad_grid(1, 1), AroundAxis{{2, 0, 0}, {0, 1, 0}, 270}, {1}, {"less than 180"});
}

TEST(Extrude, AlongACurveVolumeIsThatOfPappus) {
  // The section lies at the curve's start, at right angles to it.
  Mesh plate = holed_plate(4);
  for (const int n : {8, 16, 32}) {
    const Mesh mesh = extrude(plate, AlongCurve{half_circle(5, n)}, {});
    expect_sound(mesh);
    EXPECT_NEAR(measure(mesh).volume, kPi * 5.5 * 8 * std::sin(kPi / n) * n / kPi, 1e-10);
    // Ends as the turn by half a circle does.
    for (std::size_t i = 0; i < 16; ++i) {
      const Vec3 &from = mesh.points[i], &to = mesh.points[mesh.points.size() - 16 + i];
      EXPECT_NEAR(norm(to - Vec3{-from.x, -from.y, from.z}), 0, 1e-12);
    }
  }
  // Many short segments under few layers.
  const Mesh mesh = extrude(plate, AlongCurve{half_circle(5, 4000)}, {20});
  EXPECT_EQ(mesh.hexahedra.size(), 160u);
  EXPECT_NEAR(measure(mesh).volume, kPi * 5.5 * 8 * std::sin(kPi / 20) * 20 / kPi, 1e-3);
}

TEST(Extrude, AlongAStraightCurveIsAlongItsVector) {
  const Mesh by_curve = extrude(quad_grid(3, 2), AlongCurve{{{5, 5, 5}, {5.5, 5, 6}, {7, 5, 9}}}, {4, 1.3});
  const Mesh by_vector = extrude(quad_grid(3, 2), AlongVector{{2, 0, 4}}, {4, 1.3});
  ASSERT_EQ(by_curve.points.size(), by_vector.points.size());
  for (std::size_t i = 0; i < by_curve.points.size(); ++i)
    EXPECT_NEAR(norm(by_curve.points[i] - by_vector.points[i]), 0, 1e-12);
  EXPECT_EQ(by_curve.hexahedra, by_vector.hexahedra);
}

/// Along a helix the section turns back against the torsion: over a turn by 2 pi sin(slope).
TEST(Extrude, SectionsDoNotTurnAboutTheirCurve) {
  const int n = 4000;
  const double radius = 3, rise = 2;
  std::vector<Vec3> helix;
  for (int i = 0; i <= n; ++i) {
    const double a = 2 * kPi * i / n;
    helix.push_back({radius * std::cos(a), radius * std::sin(a), rise * i / n});
  }
  const MovingSection moving(helix);
  const Vec3 across{1, 0, 0};  // at right angles to the helix where it starts, and where it ends
  const double slope = std::atan2(rise, 2 * kPi * radius);
  const Vec3 tangent{0, std::cos(slope), std::sin(slope)};
  const Vec3 end = moving.place(helix[0] + across, n) - helix[n];
  EXPECT_NEAR(norm(end), 1, 1e-6);
  EXPECT_NEAR(dot(end, tangent), 0, 1e-3);
  const double turn = std::atan2(dot(cross(across, end), tangent), dot(across, end));
  EXPECT_NEAR(std::remainder(turn + 2 * kPi * std::sin(slope), 2 * kPi), 0, 1e-5);
}

/// Prisms between mitres: area times length of a line through the middle of the section.
TEST(Extrude, LegsKeepTheirProfile) {
  Mesh plate = holed_plate(-1.5);
  for (Vec3& p : plate.points) p.z -= 1.5;
  const Mesh pipe =
      extrude(plate, AlongCurve{{{0, 0, 0}, {0, 9, 0}, {20, 9, 0}, {25, 14, 0}, {25, 14, 30}}}, {});
  expect_sound(pipe);
  EXPECT_NEAR(measure(pipe).volume, 8 * (9 + 20 + std::sqrt(50) + 30), 1e-9);
  for (std::size_t i = 0; i < 16; ++i) {
    // The second leg runs along x.
    const Vec3 &a = pipe.points[16 + i], &b = pipe.points[32 + i];
    EXPECT_NEAR(norm(Vec3{0, a.y - b.y, a.z - b.z}), 0, 1e-12);
  }
  // Layers end at corners, wherever they would have been.
  const std::vector<Vec3> bent = {{0, 0, 0}, {0, 9, 0}, {20, 9, 0}, {25, 14, 0}, {25, 14, 30}};
  for (const int layers : {4, 5, 17}) {
    const Mesh mesh = extrude(plate, AlongCurve{bent}, {layers, 0.97});
    expect_sound(mesh);
    EXPECT_EQ(mesh.hexahedra.size(), 8u * layers);
    EXPECT_NEAR(measure(mesh).volume, measure(pipe).volume, 1e-9);
  }
  expect_not_extruded(plate, AlongCurve{bent}, {3}, {"3 layers are too few", "(25, 14, 0)"});
}

TEST(Extrude, BendsAndBadCurves) {
  const Mesh plate = holed_plate(4);
  std::vector<Vec3> tight = half_circle(1, 16);
  for (Vec3& p : tight) p.x += 5;
  expect_not_extruded(plate, AlongCurve{tight}, {}, {"inverted or flat", "'inside'", "layer"});
  expect_not_extruded(plate, AlongCurve{{{0, 0, 0}}}, {}, {"1 points"});
  expect_not_extruded(plate, AlongCurve{{{0, 0, 0}, {0, 1, 0}, {0, 1, 0}}}, {},
                      {"twice in a row", "(0, 1, 0)"});
  expect_not_extruded(plate, AlongCurve{{{0, 0, 0}, {0, 9, 0}, {0, 1, 0}}}, {}, {"turns back", "(0, 9, 0)"});
  expect_not_extruded(plate, AlongCurve{{{0, 0, 0}, {0, 9, 0}, {3, 1, 0}, {0, 0, 0}}}, {}, {"closes"});
  expect_not_extruded(plate, AlongCurve{{{0, 0, 0}, {0, 9, 0}}}, {0, 1.2}, {"number of layers"});
}

}  // namespace
}  // namespace delquad::testing_support
