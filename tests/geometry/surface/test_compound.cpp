// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surface/compound.h"
#include "tests/support/meshing.h"
#include "tests/support/surface_model_checks.h"

namespace delquad {
namespace {

const std::vector<std::string> kSound;

/// [0, n] x [0, 1] with one face a unit, bent about the sides between them by `bend` degrees each.
Mesh strip(int n, double bend) {
  Mesh mesh = triangle_grid(4 * n, 4, n, 1);
  mesh.lines.clear();
  mesh.line_curve.clear();
  mesh.curves.clear();
  mesh.regions.clear();
  for (int i = 0; i < n; ++i) mesh.regions.push_back({10 + i, {"part " + std::to_string(i), "strip"}});
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    double x = 0;
    for (const int v : mesh.triangles[t]) x += mesh.points[v].x / 3;
    mesh.triangle_region[t] = static_cast<int>(x);
  }
  for (Vec3& p : mesh.points) {
    Vec3 at{0, p.y, 0};
    double angle = 0, rest = p.x;
    for (; rest > 0; rest -= 1, angle += bend * std::numbers::pi / 180) {
      at = at + std::min(rest, 1.0) * Vec3{std::cos(angle), 0, std::sin(angle)};
    }
    p = at;
  }
  return mesh;
}

TEST(Compound, StripBecomesOneFaceWithFourSides) {
  const SurfaceModel parts = make_surface_model(strip(3, 10));
  expect_counts(parts, 3, 10, 8);
  const SurfaceModel whole = make_compound(parts, {{0, 1, 2}});
  expect_counts(whole, 1, 4, 4);
  EXPECT_EQ(whole.fine.regions[0].tag, 10);
  EXPECT_EQ(whole.fine.regions[0].names, (std::vector<std::string>{"part 0", "strip", "part 1", "part 2"}));
}

TEST(Compound, OtherFacesAndTheirCornersStay) {
  const SurfaceModel model = make_compound(make_surface_model(strip(4, 10)), {{2, 1}});
  expect_counts(model, 3, 10, 8);
  std::vector<int> tags;
  for (const Entity& face : model.fine.regions) tags.push_back(face.tag);
  EXPECT_EQ(tags, (std::vector<int>{10, 11, 13}));
}

TEST(Compound, SharpTurnsStayCorners) {
  const SurfaceModel parts = make_surface_model(strip(3, 60));
  expect_counts(make_compound(parts, {{0, 1, 2}}), 1, 8, 8);
  expect_counts(make_compound(parts, {{0, 1, 2}}, {.feature_angle = 70}), 1, 4, 4);
}

TEST(Compound, CurvesOfOtherNamesAreNotJoined) {
  SurfaceModel parts = make_surface_model(strip(2, 0));
  parts.fine.curves[0].names = {"hinge"};
  for (size_t c = 1; c < parts.fine.curves.size(); ++c) parts.fine.curves[c].names = {"rest"};
  // Whichever curve has the other name, one corner more stays unless it was the inner one.
  const SurfaceModel whole = make_compound(parts, {{0, 1}});
  EXPECT_EQ(violations(whole), kSound);
  const auto hinge = std::count_if(whole.fine.curves.begin(), whole.fine.curves.end(), [](const Entity& e) {
    return e.names == std::vector<std::string>{"hinge"};
  });
  EXPECT_EQ(hinge, 1);
}

TEST(Compound, AllSidesOfABoxHaveNoCurves) {
  const SurfaceModel model = make_surface_model(box(2));
  EXPECT_EQ(tangent_groups(model), std::vector<std::vector<int>>{});
  const auto all = tangent_groups(model, 180);
  EXPECT_EQ(all, (std::vector<std::vector<int>>{{0, 1, 2, 3, 4, 5}}));
  expect_counts(make_compound(model, all), 1, 0, 0);
}

TEST(Compound, SeamInsideAGroupVanishes) {
  Mesh mesh = can(12, 2);
  mesh.lines = {{mesh.triangles[0][0], mesh.triangles[1][2]}, {mesh.triangles[2][0], mesh.triangles[3][2]}};
  mesh.line_curve = {0, 0};
  mesh.curves = {{1, {}}};
  const SurfaceModel model = make_surface_model(mesh);
  expect_counts(model, 3, 3, 2);
  expect_counts(make_compound(model, {{0, 2}}), 2, 1, 1 - 1);
}

TEST(Compound, WrongGroupsAreRefused) {
  const SurfaceModel model = make_surface_model(strip(3, 10), {.source = "part.msh"});
  expect_input_error([&] { make_compound(model, {{0, 3}}); }, {"part.msh: compound 1", "index 3", "0 to 2"});
  expect_input_error([&] { make_compound(model, {{0, -1}}); }, {"part.msh: compound 1", "index -1"});
  expect_input_error([&] { make_compound(model, {{0, 1}, {1, 2}}); }, {"part.msh: face 11", "twice"});
  expect_input_error(
      [&] {
        make_compound(model, {{0, 2}});
      },
      {"part.msh: compound 1", "face 12", "face 10", "hang together"});
}

TEST(TangentGroups, JoinAcrossGentleBendsOnly) {
  EXPECT_EQ(tangent_groups(make_surface_model(strip(3, 4))), (std::vector<std::vector<int>>{{0, 1, 2}}));
  EXPECT_EQ(tangent_groups(make_surface_model(strip(3, 6))), std::vector<std::vector<int>>{});
  EXPECT_EQ(tangent_groups(make_surface_model(strip(3, 6)), 7), (std::vector<std::vector<int>>{{0, 1, 2}}));
}

/// Behind strip(2, 10): a plane, and beyond it an arc of which the second part is a chord, or that part
/// itself.
class PlaneAndArc final : public SurfaceProjector {
 public:
  explicit PlaneAndArc(bool is_bent) : is_bent_(is_bent) {}
  Vec3 to_face(int face, const Vec3& x) const override {
    if (face == 0) return {x.x, x.y, 0};
    if (is_bent_) return x;
    const double radius = 0.5 / std::sin(10 * std::numbers::pi / 180);
    const Vec3 axis{1, x.y, radius};
    return axis + (radius / norm(x - axis)) * (x - axis);
  }
  Vec3 to_curve(int, const Vec3& x) const override { return x; }

 private:
  bool is_bent_;
};

TEST(TangentGroups, AreThoseOfTheTrueSurfaces) {
  SurfaceModel model = make_surface_model(strip(2, 10));
  EXPECT_TRUE(tangent_groups(model).empty());
  model.projector = std::make_shared<PlaneAndArc>(true);
  EXPECT_TRUE(tangent_groups(model).empty());
  model.projector = std::make_shared<PlaneAndArc>(false);
  EXPECT_EQ(tangent_groups(model), (std::vector<std::vector<int>>{{0, 1}}));
}

TEST(TangentGroups, OneSharpPlaceKeepsFacesApart) {
  // The second half is twisted about the x axis: flat with the first in the middle only.
  Mesh mesh = strip(2, 0);
  for (Vec3& p : mesh.points) {
    if (p.x > 1) p.z = (p.x - 1) * 0.5 * (p.y - 0.5);
  }
  EXPECT_TRUE(tangent_groups(make_surface_model(mesh)).empty());
}

/// Planes x = 0, 1, ... as faces, lines z = 0, 1, ... as curves.
class Planes final : public SurfaceProjector {
 public:
  Vec3 to_face(int face, const Vec3& x) const override { return {double(face), x.y, x.z}; }
  Vec3 to_curve(int curve, const Vec3& x) const override { return {x.x, x.y, double(curve)}; }
};

TEST(Compound, ProjectsToTheNearestMember) {
  SurfaceModel model = make_surface_model(strip(3, 10));
  EXPECT_EQ(make_compound(model, {{0, 1}}).projector, nullptr);
  model.projector = std::make_shared<Planes>();
  const SurfaceModel whole = make_compound(model, {{0, 2, 1}});
  // The member whose triangles are nearest: the strip's faces meet at x = 1 and about x = 2.
  EXPECT_EQ(whole.projector->to_face(0, {1.9, 0.5, 0.2}), (Vec3{1, 0.5, 0.2}));
  EXPECT_EQ(whole.projector->to_face(0, {2.1, 0.5, 0.2}), (Vec3{2, 0.5, 0.2}));
  EXPECT_EQ(whole.projector->to_face(0, {0.6, 0.5, 0.2}), (Vec3{0, 0.5, 0.2}));
  const SurfaceModel pair = make_compound(model, {{1, 2}});
  EXPECT_EQ(pair.projector->to_face(0, {1.9, 0.5, 0.2}), (Vec3{0, 0.5, 0.2}));
  EXPECT_EQ(pair.projector->to_face(1, {0.1, 0.5, 0.2}), (Vec3{1, 0.5, 0.2}));

  // Each new curve goes to the former curves that lie under its lines.
  for (size_t c = 0; c < whole.fine.curves.size(); ++c) {
    for (size_t former = 0; former < model.fine.curves.size(); ++former) {
      const Vec3 on{0, 0, double(former)};
      const bool is_member = whole.projector->to_curve(static_cast<int>(c), on) == on;
      bool shares_line = false;
      for (size_t i = 0; i < model.fine.lines.size(); ++i) {
        for (size_t j = 0; j < whole.fine.lines.size(); ++j) {
          auto a = model.fine.lines[i], b = whole.fine.lines[j];
          std::sort(a.begin(), a.end());
          std::sort(b.begin(), b.end());
          shares_line |= a == b && model.fine.line_curve[i] == static_cast<int>(former) &&
                         whole.fine.line_curve[j] == static_cast<int>(c);
        }
      }
      EXPECT_EQ(is_member, shares_line) << c << " " << former;
    }
  }
}

/// A square whose lower side has a corner at x = 0.01, and at 0.5 where it turns by `bend` degrees.
SurfaceModel notched(double bend) {
  Mesh mesh = triangle_grid(4, 4);
  for (Vec3& p : mesh.points) {
    if (p.y == 0 && p.x == 0.25) p.x = 0.01;
    if (p.y == 0 && p.x == 0.75) p.y = -0.25 * std::tan(bend * std::numbers::pi / 180);
    if (p.y == -0.0 && p.x == 1 && bend != 0) p.y = -0.5 * std::tan(bend * std::numbers::pi / 180);
  }
  mesh.curves = {{1, {}}, {2, {}}, {3, {}}, {4, {}}, {5, {}}, {6, {}}};
  for (size_t i = 0; i < mesh.lines.size(); ++i) {
    if (mesh.line_curve[i] != 0) continue;
    if (mesh.lines[i][0] == 0) mesh.line_curve[i] = 4;
    if (mesh.lines[i][0] >= 2) mesh.line_curve[i] = 5;
  }
  return make_surface_model(mesh, {.feature_angle = 100});
}

TEST(MergeShortCurves, JoinsASliverToTheCurveThatItContinues) {
  const SurfaceModel model = notched(0);
  expect_counts(model, 1, 6, 6);
  expect_counts(merge_short_curves(model, 0.005), 1, 6, 6);
  const SurfaceModel merged = merge_short_curves(model, 0.05);
  expect_counts(merged, 1, 5, 5);
  EXPECT_EQ(merged.warnings.back().text, "curve 5, 0.01 long, became one with curve 1");
  EXPECT_EQ(merged.warnings.size(), model.warnings.size() + 1);
  EXPECT_TRUE(std::any_of(merged.fine.curves.begin(), merged.fine.curves.end(),
                          [](const Entity& e) { return e.tag == 1; }));
  EXPECT_TRUE(std::none_of(merged.fine.curves.begin(), merged.fine.curves.end(), [](const Entity& e) {
    return e.tag == 5;
  })) << "the lesser tag stays";
}

TEST(MergeShortCurves, JoinsBothCurvesThatAShortOneContinues) {
  // The corner at x = 0.01 goes to 0.49.
  SurfaceModel model = notched(0);
  for (Vec3& p : model.fine.points)
    if (p.y == 0 && p.x == 0.01) p.x = 0.49;
  expect_counts(merge_short_curves(model, 0.05), 1, 4, 4);
}

TEST(MergeShortCurves, LeavesWhatIsKept) {
  const SurfaceModel model = notched(0);
  for (const int tag : {1, 5}) {
    std::vector<char> kept;
    for (const Entity& curve : model.fine.curves) kept.push_back(curve.tag == tag ? 1 : 0);
    expect_counts(merge_short_curves(model, 0.05, {}, kept), 1, 6, 6);
  }
}

TEST(MergeShortCurves, LeavesSharpTurnsNamesAndMeetingPointsOfThreeCurves) {
  SurfaceModel named = notched(0);
  for (Entity& curve : named.fine.curves) curve.names = {"curve " + std::to_string(curve.tag)};
  const SurfaceModel kept = merge_short_curves(named, 0.05);
  expect_counts(kept, 1, 6, 6);
  EXPECT_EQ(kept.warnings.size(), named.warnings.size());
  // The sides of a strip are short for this length, but its corners are sharp and its inner curves end at
  // threes.
  const SurfaceModel parts = make_surface_model(strip(3, 10));
  expect_counts(merge_short_curves(parts, 100), 3, 10, 8);
  // All sides of the square are short: those that turn by 90 degrees stay apart.
  expect_counts(merge_short_curves(notched(0), 100), 1, 4, 4);
  expect_counts(merge_short_curves(notched(50), 100), 1, 5, 5);
}

}  // namespace
}  // namespace delquad
