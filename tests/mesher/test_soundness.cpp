// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh/check_invariants.h"
#include "io/cases/case_file.h"
#include "io/mesh_io.h"
#include "tests/support/meshing.h"
#include "tests/support/prepare_case.h"
#include "tests/support/shared_data.h"

namespace delquad {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

bool has(const Soundness& soundness, const std::string& part) {
  return std::ranges::any_of(
      soundness.reasons, [&](const std::string& reason) { return reason.find(part) != std::string::npos; });
}

/// Corners of 180 degrees passed here by rounding, with scaled Jacobians of 4e-14.
TEST(Margin, FlatCornersAreCured) {
  const auto file = shared_data("hard2/example-ro__gripper_motor_single_collision.STL");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "data not found: " << file;
  Case c = read_model_case(file);
  const Mesh model = read_mesh(file);
  c.size.text = std::to_string(diagonal(model) / 60);
  c.size.where = "test";
  c.cross.text = "size-aware";
  c.allow_unsound = true;
  for (const char* text : {"DB", "DBCO", "DBCQO"}) {
    const MeshResult result = mesh(prepare(c), text);
    EXPECT_TRUE(result.soundness.sound()) << text << result.soundness.text();
    EXPECT_GT(result.metrics.values.at("scaled_jacobian_min"), 1e-4) << text;
  }
}

/// A cube of side 1, meshed by 4 x 4 quads a side, which can then be spoilt.
class SoundCube : public testing::Test {
 protected:
  SoundCube() {
    prepared_ = prepare_surface({}, make_surface_model(box(8)), make_constant_size(0.25));
    mesh_ = meshed(prepared_, "DB").mesh;
  }
  Soundness check(const std::vector<char>& left_out = std::vector<char>(6, 0)) const {
    const SurfaceSetup& surface = *prepared_.surface;
    const SurfaceReport report =
        report_surface(surface.model, surface.cuts, left_out, mesh_, surface.size.get());
    return check_soundness(prepared_, mesh_, &report, sorted_half_edges(mesh_));
  }
  /// A quad on the lid, and one of its vertices, all of which are inside of it.
  int inner_quad() const {
    const auto is_inside = [&](int v) {
      const Vec3& p = mesh_.points[v];
      return p.z == 1 && std::max(std::abs(p.x - 0.5), std::abs(p.y - 0.5)) < 0.3;
    };
    for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
      if (std::ranges::all_of(mesh_.quads[q], is_inside)) return static_cast<int>(q);
    ADD_FAILURE() << "no quad inside of the lid";
    return 0;
  }
  Vec3& corner(int q, int k) { return mesh_.points[mesh_.quads[q][k]]; }
  std::string lid() const {
    return "face " + std::to_string(mesh_.regions[mesh_.quad_region[inner_quad()]].tag);
  }

  MeshingSetup prepared_;
  Mesh mesh_;
};

TEST_F(SoundCube, IsSound) {
  const Soundness soundness = check();
  EXPECT_TRUE(soundness.sound()) << soundness.text();
}

TEST_F(SoundCube, PointsMustBeFinite) {
  const std::string face = lid();
  for (const double bad : {kNaN, std::numeric_limits<double>::infinity()}) {
    corner(0, 0).y = bad;
    EXPECT_FALSE(has_finite_points(mesh_));
    const Soundness soundness = check_soundness(prepared_, mesh_, nullptr, sorted_half_edges(mesh_));
    EXPECT_TRUE(has(soundness, "1 point is not finite: face ")) << soundness.text();
  }
}

TEST_F(SoundCube, QuadsMustNotBeInverted) {
  const int q = inner_quad();
  const std::string face = lid();
  corner(q, 0) = corner(q, 2) + 0.5 * (corner(q, 2) - corner(q, 0));  // through the opposite corner
  const Soundness soundness = check();
  EXPECT_TRUE(has(soundness, "inverted or flat: " + face + " at (")) << soundness.text();
}

/// A corner that is flat but for a millionth would be nothing but rounding.
TEST_F(SoundCube, CornersOf180DegreesNeedAMargin) {
  const int q = inner_quad();
  const Vec3 a = corner(q, 0), b = corner(q, 1), c = corner(q, 2), d = corner(q, 3);
  const Vec3 middle = 0.5 * (a + c);
  for (const double part : {1e-15, 1e-9, 1e-6}) {
    corner(q, 3) = middle + part * (d - b);
    const Soundness soundness = check();
    EXPECT_TRUE(has(soundness, "1 quad is inverted or flat: face ")) << part << ": " << soundness.text();
  }
  corner(q, 3) = middle + 1e-2 * (d - b);
  EXPECT_TRUE(check().sound());
}

TEST_F(SoundCube, QuadsMustNotBeFolded) {
  const int q = inner_quad();
  const std::string face = lid();
  const Vec3 a = corner(q, 0), c = corner(q, 2);
  corner(q, 2) = a + 0.3 * (c - a) + Vec3{0, 0, 0.24};  // up, and back over the diagonal
  const Soundness soundness = check();
  EXPECT_TRUE(has(soundness, "folded by more than 90 degrees: " + face)) << soundness.text();
  EXPECT_FALSE(has(soundness, "off the model")) << soundness.text();
}

TEST_F(SoundCube, ElementsMustLookAsTheModel) {
  // Rows that change places: each quad between them is good by itself and conforming, but lies on its back.
  const std::string face = lid();
  for (Vec3& p : mesh_.points)
    if (p.z == 1 && p.x > 0 && p.x < 1 && (p.y == 0.25 || p.y == 0.5)) p.y = p.y == 0.25 ? 0.45 : 0.3;
  const Soundness soundness = check();
  EXPECT_TRUE(has(soundness, "face away from the model")) << soundness.text();
}

TEST_F(SoundCube, AMissingQuadAndOneTooMany) {
  const int q = inner_quad();
  mesh_.quads.erase(mesh_.quads.begin() + q);
  mesh_.quad_region.erase(mesh_.quad_region.begin() + q);
  Soundness soundness = check();
  EXPECT_TRUE(has(soundness, "4 edges are in more or fewer elements than the model asks for"));
  EXPECT_TRUE(has(soundness, "its Euler characteristic is 1, but the model has 2")) << soundness.text();
  EXPECT_TRUE(has(soundness, "4 open edges, the model none")) << soundness.text();
}

TEST_F(SoundCube, AQuadThatRunsTheOtherWay) {
  std::ranges::reverse(mesh_.quads[inner_quad()]);
  const Soundness soundness = check();
  EXPECT_TRUE(has(soundness, "1 element faces away from the model")) << soundness.text();
  EXPECT_TRUE(has(soundness, "the same way")) << soundness.text();
}

TEST_F(SoundCube, TornCurves) {
  // A node on a curve that the two faces do not share.
  const auto node = std::ranges::find(mesh_.points, Vec3{0.5, 0, 1}) - mesh_.points.begin();
  ASSERT_LT(node, static_cast<long>(mesh_.points.size()));
  mesh_.points.push_back(mesh_.points[node]);
  const int lid_face = mesh_.quad_region[inner_quad()];
  for (std::size_t q = 0; q < mesh_.quads.size(); ++q)
    if (mesh_.quad_region[q] == lid_face)
      std::ranges::replace(mesh_.quads[q], static_cast<int>(node), static_cast<int>(mesh_.points.size()) - 1);
  EXPECT_TRUE(has(check(), "edges are in more or fewer elements than the model asks for"));
}

TEST_F(SoundCube, DistancesBelowTheSizeAreExplainedAndOthersAreNot) {
  const Mesh whole = mesh_;
  const auto lower_lid = [&](double height) {
    mesh_ = whole;
    for (Vec3& p : mesh_.points) p.z *= height;
    return check();
  };
  EXPECT_TRUE(lower_lid(0.8).sound()) << lower_lid(0.8).text();
  const Soundness cut = lower_lid(0.4);
  EXPECT_TRUE(has(cut, "places of the model are lost, up to 2.4 sizes from the mesh: face ")) << cut.text();
  const Soundness grown = lower_lid(1.6);
  EXPECT_TRUE(has(grown, "places of the mesh are off the model, up to 2.4 sizes: face ")) << grown.text();
}

TEST_F(SoundCube, TheSizeAtThePlaceCounts) {
  // 0.2 is less than the size, but not than that at the lid.
  const auto local = [](const Vec3& x) { return x.z > 0.7 ? 0.1 : 0.25; };
  struct LocalSize : SizeField {
    double (*at_place)(const Vec3&);
    double at(const Vec3& x, int&) const override { return at_place(x); }
  } size;
  size.at_place = local;
  for (Vec3& p : mesh_.points)
    if (p.z == 1) p.z = 0.8;
  const SurfaceReport report =
      report_surface(prepared_.surface->model, {}, std::vector<char>(6, 0), mesh_, &size);
  EXPECT_NEAR(report.surface_to_mesh.max_in_sizes, 2, 1e-9);
  EXPECT_GT(report.surface_to_mesh.unexplained.count, 0);
}

TEST_F(SoundCube, FacesThatAreLeftOutAreNotMissed) {
  const int lid_face = mesh_.quad_region[inner_quad()];
  for (std::size_t q = mesh_.quads.size(); q-- > 0;) {
    if (mesh_.quad_region[q] != lid_face) continue;
    mesh_.quads.erase(mesh_.quads.begin() + static_cast<long>(q));
    mesh_.quad_region.erase(mesh_.quad_region.begin() + static_cast<long>(q));
  }
  std::vector<char> used(mesh_.points.size(), 0);
  for (const auto& v : mesh_.quads)
    for (const int i : v) used[i] = 1;
  EXPECT_TRUE(has(check(), "places of the model are lost")) << "unless they were left out";
  std::vector<char> left_out(6, 0);
  left_out[lid_face] = 1;
  const Soundness soundness = check(left_out);
  // Only the points inside of the lid, which are still there, are too many.
  EXPECT_EQ(soundness.reasons.size(), 1u) << soundness.text();
  EXPECT_TRUE(has(soundness, "nothing uses it")) << soundness.text();
}

/// A square of which a round hole and an inclusion are cut out.
class SoundDomain : public testing::Test {
 protected:
  SoundDomain() {
    c_ = read_model_case(write_text(
        folder_ / "domain.toml",
        "size = 0.1\nloop = [{ rectangle = [[0, 0], [2, 1]] }, { circle = { centre = [0.5, 0.5], radius = "
        "0.2 } },\n{ circle = { centre = [1.5, 0.5], radius = 0.3 }, region = \"core\" }]\n"));
    prepared_ = prepare_case(c_);
    result_ = meshed(prepared_, "DB");
    mesh_ = result_.mesh;
  }
  Soundness check() const { return check_soundness(prepared_, mesh_, nullptr, sorted_half_edges(mesh_)); }

  TemporaryFolder folder_;
  Case c_;
  MeshingSetup prepared_;
  MeshResult result_;
  Mesh mesh_;
};

TEST_F(SoundDomain, IsSound) {
  EXPECT_TRUE(check().sound()) << check().text();
  EXPECT_TRUE(result_.soundness.sound());
}

TEST_F(SoundDomain, IsSeenFromAbove) {
  for (auto& v : mesh_.quads) std::ranges::reverse(v);
  EXPECT_TRUE(has(check(), std::to_string(mesh_.quads.size()) + " quads are inverted")) << check().text();
}

TEST_F(SoundDomain, AHoleMustStayAndOthersMustNotCome) {
  mesh_.quads.pop_back();
  mesh_.quad_region.pop_back();
  EXPECT_TRUE(has(check(), "than the domain asks for")) << check().text();
  EXPECT_TRUE(has(check(), "its Euler characteristic is ")) << check().text();

  // A fan of triangles that fills the hole.
  mesh_ = result_.mesh;
  const int centre = static_cast<int>(mesh_.points.size());
  mesh_.points.push_back({0.5, 0.5, 0});
  for (const auto& [a, b] : result_.mesh.lines) {
    if (!(norm(0.5 * (mesh_.points[a] + mesh_.points[b]) - mesh_.points[centre]) < 0.21)) continue;
    const double side =
        cross(mesh_.points[a] - mesh_.points[centre], mesh_.points[b] - mesh_.points[centre]).z;
    mesh_.triangles.push_back(side > 0 ? std::array{a, b, centre} : std::array{b, a, centre});
    mesh_.triangle_region.push_back(0);
  }
  ASSERT_GT(mesh_.triangles.size(), 4u);
  EXPECT_TRUE(has(check(), "its Euler characteristic is 1, but the model has 0")) << check().text();
}

TEST_F(SoundDomain, WhatLiesOnAnInterfaceIsInTwoElements) {
  // The core alone is gone: its outline has one element an edge.
  for (std::size_t q = mesh_.quads.size(); q-- > 0;) {
    if (mesh_.regions[mesh_.quad_region[q]].names != std::vector<std::string>{"core"}) continue;
    mesh_.quads.erase(mesh_.quads.begin() + static_cast<long>(q));
    mesh_.quad_region.erase(mesh_.quad_region.begin() + static_cast<long>(q));
  }
  EXPECT_TRUE(has(check(), "edges are in more or fewer elements than the domain asks for"));
}

/// A flat face that looks down, as CAD has them, is as good as one that looks up.
TEST(SoundSurface, MayLookDown) {
  for (const bool down : {false, true}) {
    Mesh square;
    square.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    square.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (down)
      for (auto& v : square.triangles) std::ranges::reverse(v);
    square.triangle_region = {0, 0};
    square.regions = {{1, {}}};
    const MeshResult result = meshed(make_surface_model(square), 0.2, "DBCO");
    EXPECT_TRUE(result.soundness.sound()) << down << ": " << result.soundness.text();
    EXPECT_EQ(result.metrics.values.at("n_inverted"), 0);
    EXPECT_NEAR(result.metrics.values.at("eta_worst"), 1, 1e-6);
    const auto& v = result.mesh.quads[0];
    const Vec3 normal = cross(result.mesh.points[v[2]] - result.mesh.points[v[0]],
                              result.mesh.points[v[3]] - result.mesh.points[v[1]]);
    EXPECT_EQ(normal.z < 0, down);
  }
}

/// Twins that are not parted are found out.
TEST(SoundSurface, TwinsAreNot) {
  MeshingSetup prepared = prepare_surface({}, make_surface_model(lens(64, 12, 0.45)), make_constant_size(5));
  const MeshResult separated = meshed(prepared, "DB");
  EXPECT_FALSE(has(separated.soundness, "conforming")) << separated.soundness.text();
  const Summaries& done = separated.log.summaries;
  ASSERT_TRUE(done.has("part_twins"));
  EXPECT_GT(done.number("part_twins", "chords") + done.number("part_twins", "rings"), 0);
  prepared.settings.options.set("repair.part_twins", false);
  const MeshResult twins = meshed(prepared, "DB");
  EXPECT_FALSE(twins.log.summaries.has("part_twins"));
  EXPECT_TRUE(has(twins.soundness, "conforming") || has(twins.soundness, "more or fewer"))
      << twins.soundness.text();
  EXPECT_THROW(require_sound("lens DB", twins), UnsoundError);
}

}  // namespace
}  // namespace delquad
