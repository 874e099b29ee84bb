// SPDX-License-Identifier: GPL-3.0-or-later
#include "features/extrusion/layers.h"
#include "tests/features/extrusion/hex_checks.h"

namespace delquad::testing_support {
namespace {

double power3(double x) { return x * x * x; }

TEST(Normals, BoxesGetWallsOfTheThickness) {
  const Mesh box = cube_surface(4, [](const Vec3& p) { return p; });
  for (const double t : {0.3, -0.3}) {
    const Mesh mesh = extrude(box, AlongNormals{t}, {2});
    expect_sound(mesh);
    EXPECT_NEAR(measure(mesh).volume, std::abs(power3(2 + 2 * t) - 8), 1e-12);
    EXPECT_EQ(quads_by_name(mesh),
              (std::map<std::string, int>{{"region_1 start", 96}, {"region_1 end", 96}}));
  }
  const Mesh mesh = extrude(box, AlongNormals{0.3, true}, {2});
  EXPECT_NEAR(measure(mesh).volume, power3(2.3) - power3(1.7), 1e-12);
  // Through the middle: more than the distance to the opposite side.
  expect_not_extruded(box, AlongNormals{-2.5}, {1}, {"inverted or flat"});
}

TEST(Normals, SphereShellsConverge) {
  const double radius = 2, t = 0.5;
  double before = 0;
  for (const int n : {4, 8, 16}) {
    for (const double thickness : {t, -t}) {
      const Mesh mesh = extrude(sphere(n, radius), AlongNormals{thickness}, {3, 1.2});
      expect_sound(mesh);
      const double exact = 4 * kPi / 3 * std::abs(power3(radius + thickness) - power3(radius));
      const double error = std::abs(measure(mesh).volume - exact) / exact;
      EXPECT_LT(error, 0.8 / (n * n)) << n;
      if (thickness < 0) continue;
      if (before > 0) {
        EXPECT_NEAR(before / error, 4, 0.8) << n;
      }
      before = error;
    }
  }
}

TEST(Normals, ThicknessBeyondTheRadiusIsRefused) {
  for (const int layers : {1, 2, 7})
    for (const double part : {1.0, 1.2, 1.5, 2.5})
      expect_not_extruded(sphere(6, 2), AlongNormals{-part * 2}, {layers}, {"inverted or flat", "region_1"});
  EXPECT_NO_THROW(extrude(sphere(6, 2), AlongNormals{-0.7 * 2}, {1}));
}

/// Two planes that meet at any angle, with one quad on one side and two on the other.
TEST(Normals, EachPlaneMovesByTheThickness) {
  for (const double degrees : {1.0, 5.0, 20.0, 60.0, 120.0, 170.0, -30.0, -90.0}) {
    const double a = degrees * kPi / 180;
    Mesh mesh;
    add_patch(mesh, 2, 2, [](double s, double t) { return Vec3{s - 1, t < 0.4 ? 0 : t < 0.6 ? 0.3 : 1, 0}; });
    add_patch(mesh, 1, 2, [&](double s, double t) {
      const double y = t < 0.4 ? 0 : t < 0.6 ? 0.3 : 1;
      return Vec3{s * std::cos(a), y, -s * std::sin(a)};
    });
    const double thickness = 0.01;
    const Mesh shell = extrude(mesh, AlongNormals{thickness}, {1});
    const std::size_t n = mesh.points.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 step = shell.points[n + i] - shell.points[i];
      if (mesh.points[i].x <= 0 && mesh.points[i].z == 0) {
        EXPECT_NEAR(step.z, thickness, 1e-13) << degrees;
      }
      if (std::abs(mesh.points[i].x * std::sin(a) + mesh.points[i].z * std::cos(a)) < 1e-12) {
        EXPECT_NEAR(dot(step, {std::sin(a), 0, std::cos(a)}), thickness, 1e-13) << degrees;
      }
      EXPECT_NEAR(step.y, 0, 1e-13);
    }
  }
}

/// Quads so warped that flat triangles in their place cross the triangles of the other side: no reason to
/// refuse.
TEST(Normals, CoarseMeshesOfRoundBodiesGetThinWalls) {
  std::mt19937_64 random(3);
  const auto noise = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 - 0.5; };
  int swept = 0;
  for (int k = 0; k < 100; ++k) {
    Mesh torus;
    add_patch(torus, 9, 4, [](double s, double t) {
      const double a = 2 * kPi * s, b = 2 * kPi * t;
      return Vec3{(20 + 8 * std::cos(b)) * std::cos(a), (20 + 8 * std::cos(b)) * std::sin(a),
                  8 * std::sin(b)};
    });
    for (Vec3& p : torus.points) p = p + 5 * Vec3{noise(), noise(), noise()};
    const std::string message = message_of([&] { expect_sound(extrude(torus, AlongNormals{1e-6}, {2})); });
    swept += message.empty();
    if (!message.empty()) {
      EXPECT_TRUE(holds(message, "inverted"));
    }
  }
  EXPECT_GT(swept, 30);
}

/// Quads of a noisy roof: the ridge must not run away along itself.
TEST(Normals, NoiseDoesNotMatterAtEdges) {
  Mesh mesh;
  const auto noise = [](double s, double t) { return 1e-4 * std::sin(40 * s + 70 * t); };
  add_patch(mesh, 4, 9, [&](double s, double t) { return Vec3{s - 1, t, noise(s, t)}; });
  add_patch(mesh, 4, 9, [&](double s, double t) {
    return Vec3{s == 0 ? 0 : noise(s, t), t, s == 0 ? noise(1, t) : -s};
  });
  Section section = make_section(mesh, false, nullptr);
  const std::vector<Vec3> directions = offset_directions(section);
  for (std::size_t i = 0; i < directions.size(); ++i)
    if (norm(Vec3{section.mesh.points[i].x, 0, section.mesh.points[i].z}) < 1e-3) {
      EXPECT_NEAR(norm(directions[i] - Vec3{1, 0, 1}), 0, 0.02);
    }
}

TEST(Normals, WhereThereAreNone) {
  Mesh pinched;  // two quads that share a point
  pinched.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, -1, 0}, {0, -1, 0}};
  pinched.quads = {{0, 1, 2, 3}, {0, 4, 5, 6}};
  pinched.quad_region = {0, 0};
  pinched.regions = {{1, {}}};
  expect_not_extruded(pinched, AlongNormals{0.1}, {1}, {"touch at (0, 0, 0)"});
  EXPECT_EQ(extrude(pinched, AlongVector{{0, 0, 1}}, {2}).hexahedra.size(), 4u);
  Mesh folded;
  add_patch(folded, 1, 1, [](double s, double t) { return Vec3{s - 1, t, 0}; });
  add_patch(folded, 1, 1, [](double s, double t) { return Vec3{-s, t, -0.001 * s}; });
  expect_not_extruded(folded, AlongNormals{0.1}, {1}, {"folds back"});
  expect_not_extruded(quad_grid(1, 1), AlongNormals{0}, {1}, {"thickness of 0"});
}

/// Plates of a length of 3 along y that leave the origin at these angles (degrees), `n` quads along y.
Mesh star(const std::vector<double>& degrees, int n = 3) {
  Mesh mesh;
  for (std::size_t k = 0; k < degrees.size(); ++k)
    add_patch(
        mesh, 4, n,
        [&](double s, double t) {
          const double a = degrees[k] * kPi / 180;
          return Vec3{2 * s * std::cos(a), 3 * t, 2 * s * std::sin(a)};
        },
        static_cast<int>(k));
  return mesh;
}

TEST(Joints, OfPlatesHaveTheVolumeOfTheirUnion) {
  const double t = 0.4;
  for (const int layers : {2, 4, 6}) {
    const Mesh tee = extrude(star({0, 90, 180}), AlongNormals{t, true}, {layers});
    expect_sound(tee);
    EXPECT_NEAR(measure(tee).volume, 3 * (4 * t + (2 - t / 2) * t), 1e-12);
    EXPECT_EQ(tee.hexahedra.size(), 36u * layers + 9 * layers * layers / 4);
    const Mesh cross = extrude(star({0, 90, 180, 270}), AlongNormals{-t, true}, {layers});
    expect_sound(cross);
    EXPECT_NEAR(measure(cross).volume, 3 * (8 * t - t * t), 1e-12);
  }
  // Three plates at equal angles: their middles overlap in a triangle of height 1.5 t.
  const Mesh star_of_three = extrude(star({30, 150, 270}), AlongNormals{t, true}, {2});
  expect_sound(star_of_three);
  EXPECT_NEAR(measure(star_of_three).volume,
              3 * (3 * (2 - t / std::sqrt(12.0)) * t + std::sqrt(3.0) / 4 * t * t), 1e-12);
  EXPECT_GT(measure(star_of_three).least_jacobian, 0.8);
  // Quads that run either way round, and lines on the joint and at its end.
  Mesh mixed = star({0, 70, 180});
  for (std::size_t q = 0; q < mixed.quads.size(); q += 3) std::swap(mixed.quads[q][1], mixed.quads[q][3]);
  mixed.curves = {{1, {"weld"}}, {2, {"front"}}};
  mixed.lines = {{0, 5}, {0, 1}};
  mixed.line_curve = {0, 1};
  ReadNotes notes;
  const Mesh leaning = extrude(mixed, AlongNormals{0.3, true}, {2, 1.5}, &notes);
  expect_sound(leaning);
  EXPECT_EQ(notes, ReadNotes{"1 lines on joints of plates were left out"});
  EXPECT_EQ(quads_by_name(leaning).at("front"), 2 + 3);
}

/// A pipe through a plate, and a box with a wall inside: the joint is a closed curve, smooth or with corners.
TEST(Joints, MayClose) {
  Mesh mesh;
  const auto ring = [](double s, double r, double z) {
    return Vec3{r * std::cos(2 * kPi * s), r * std::sin(2 * kPi * s), z};
  };
  add_patch(mesh, 24, 6, [&](double s, double t) { return ring(s, 5, 6 * t - 3); });
  add_patch(mesh, 24, 3, [&](double s, double t) { return ring(s, 5 + 4 * t, 0); });
  const Mesh swept = extrude(mesh, AlongNormals{0.5, true}, {2});
  expect_sound(swept);
  EXPECT_NEAR(measure(swept).volume, kPi * (6 * 5 + (81 - 5.25 * 5.25) * 0.5), 2);
  Mesh box = cube_surface(4, [](const Vec3& p) { return p; });
  add_patch(
      box, 4, 4,
      [](double s, double t) {
        return Vec3{0, 2 * s - 1, 2 * t - 1};
      },
      1);
  const double t = 0.2;
  const Mesh walls = extrude(box, AlongNormals{t, true}, {4});
  expect_sound(walls);
  EXPECT_NEAR(measure(walls).volume, power3(2 + t) - 2 * (1 - t) * (2 - t) * (2 - t), 1e-12);
}

TEST(Joints, Refused) {
  const Mesh tee = star({0, 90, 180});
  expect_not_extruded(tee, AlongNormals{0.1}, {2}, {"3 quads share the edge", "--both-sides"});
  expect_not_extruded(tee, AlongNormals{0.1, true}, {3}, {"3 layers", "even number", "(0, 0, 0)"});
  expect_not_extruded(tee, AlongNormals{5, true}, {2}, {"inverted or flat"});
  Mesh ends_inside;
  add_patch(ends_inside, 4, 4, [](double s, double t) { return Vec3{s - 0.5, t, 0}; });
  add_patch(ends_inside, 2, 2, [](double s, double t) { return Vec3{0, t / 2, s}; });
  expect_not_extruded(ends_inside, AlongNormals{0.1, true}, {2}, {"ends at (0, 0.5, 0) inside of a plate"});
  add_patch(ends_inside, 2, 2, [](double s, double t) { return Vec3{0, 0.5 + t / 2, s}; });
  add_patch(ends_inside, 2, 2, [](double s, double t) { return Vec3{t / 2, 0.5, s}; });
  expect_not_extruded(ends_inside, AlongNormals{0.1, true}, {2}, {"4 joints of plates meet at (0, 0.5, 0)"});
}

}  // namespace
}  // namespace delquad::testing_support
