// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrics/judgement/poor_quads.h"
#include "tests/features/layers/layered_model.h"

namespace delquad {
namespace {

using Polygon = std::vector<Vec2>;

/// A coast line: a ragged circle of so many points.
Polygon coast(int points, double radius) {
  Polygon line;
  for (int i = 0; i < points; ++i) {
    const double a = 2 * std::numbers::pi * i / points;
    const double r = radius * (1 + 0.15 * std::sin(7 * a) + 0.05 * std::cos(37 * a + 1));
    line.push_back({r * std::cos(a), r * std::sin(a)});
  }
  return line;
}

/// Two islands in a square, with so much between them.
std::vector<Polygon> islands(double gap) {
  return {rectangle({0, 0}, {20, 20}), rectangle({5, 8}, {8, 11}),
          rectangle({8 + gap, 8.5}, {11 + gap, 11.5})};
}

std::string poor_in(const MeshResult& result) {
  std::string all;
  for (const Warning& warning : result.warnings)
    if (warning.text.find(" poor (") != std::string::npos) all += warning.text + "\n";
  return all;
}

void expect_told(const std::string& text, std::initializer_list<std::string> parts) {
  for (const std::string& part : parts) EXPECT_TRUE(holds(text, part));
  EXPECT_EQ(std::ranges::count(text, '\n'), 1) << text;
}

TEST(PoorQuads, OfAnOutlineThatIsFinerThanTheSize) {
  const std::vector<Polygon> outline{coast(800, 5)};
  expect_told(poor_in(mesh(problem_of(polygons(outline), 1), "DBCO")),
              {"quads are poor", "a side below a tenth of the size", "where curves are finer than the size",
               "would help"});
  // What the message says.
  EXPECT_EQ(poor_in(mesh(problem_of(polygons(outline), 0.04), "DBCO")), "");
}

TEST(PoorQuads, OfAGapNarrowerThanTheSize) {
  const std::string text = poor_in(mesh(problem_of(polygons(islands(0.022)), 1), "DB"));
  expect_told(text, {"in places narrower than the size", "would help"});
  EXPECT_EQ(poor_in(mesh(problem_of(polygons(islands(3)), 1), "DB")), "");
}

TEST(PoorQuads, OfAHoleBesideAWall) {
  for (const double gap : {0.005, 0.01}) {
    const std::vector<Polygon> loops{rectangle({0, 0}, {3, 3}), rectangle({gap, 1}, {1, 2})};
    for (const char* word : {"DB", "DBCO"}) {
      const std::string text = poor_in(mesh(problem_of(polygons(loops), 0.1), word));
      expect_told(text, {"narrower than the size, " + fmt::format("{:.3g} in", gap)});
      for (const char* wrong : {"finer than the size", "without a known cause"})
        EXPECT_EQ(text.find(wrong), std::string::npos) << text;
    }
  }
}

TEST(PoorQuads, OptionsAreNamedWhereTheyHelp) {
  // A strip of a plate is a face of its own.
  const auto mesh_of = [](const std::vector<Polygon>& faces, double ignore_below) {
    Mesh plate;
    for (const Polygon& face : faces) {
      const int first = static_cast<int>(plate.points.size());
      for (const Vec2 x : face) plate.points.push_back({x.x, x.y, 0});
      plate.triangles.push_back({first, first + 1, first + 2});
      plate.triangles.push_back({first, first + 2, first + 3});
      for (int k = 0; k < 2; ++k) plate.triangle_region.push_back(static_cast<int>(plate.regions.size()));
      plate.regions.push_back({static_cast<int>(plate.regions.size()) + 1, {}});
    }
    MeshProblem problem = problem_of(TriangleModel{plate}, 1);
    problem.surface.ignore_below = ignore_below;
    return mesh(problem, "DB");
  };
  const auto poor_of = [&](const std::vector<Polygon>& faces, double ignore_below) {
    return poor_in(mesh_of(faces, ignore_below));
  };
  const std::vector<Polygon> strip{rectangle({0, 0}, {10, 5}), rectangle({0, 5}, {10, 5.02}),
                                   rectangle({0, 5.02}, {10, 10})};
  expect_told(poor_of(strip, 0), {"narrower than the size, 0.02", "--ignore-below 0.021 may help"});
  EXPECT_EQ(poor_of(strip, 0.021), "");
  const auto told = [](const MeshResult& result) {
    return std::ranges::count(result.warnings, "farthest nodes", &Warning::kind);
  };
  EXPECT_EQ(told(mesh_of(strip, 0)), 0);
  EXPECT_EQ(told(mesh_of(strip, 0.021)), 1) << "how far nodes lie from the triangles as they were read";
}

TEST(PoorQuads, OfACornerOfTheModel) {
  const MeshResult result = mesh(problem_of(polygons({{{0, 0}, {6, -0.05}, {6, 0.05}}}), 0.1), "DB");
  expect_told(poor_in(result), {"in sharp corners of the model", "0.955 degrees", "at (0."});
}

TEST(PoorQuads, LayersAreFlatOnPurpose) {
  ModelMaker model;
  model.rectangle({0, 0}, {4, 4}, {"wall", "out", "far", "in"});
  MeshProblem problem = model.problem(0.2, {layer_on({"wall"}, 1e-4, 20)});
  problem.options.set("limits.max_aspect", 10.0);
  const MeshResult result = mesh(problem, "DB");
  EXPECT_GT(result.metrics.values.at("aspect_max"), 100);
  EXPECT_EQ(poor_in(result), "");
  EXPECT_TRUE(result.soundness.accepted()) << result.soundness.complaint();
}

TEST(PoorQuads, OfAGivenMesh) {
  MeshProblem problem = problem_of(GivenMesh{mesh(problem_of(polygons(islands(0.022)), 1), "DB").mesh});
  expect_told(poor_in(mesh(problem, "CO")), {"in places narrower than the size"});
}

TEST(Limits, AreAnErrorWithPlaces) {
  MeshProblem problem = problem_of(polygons({{{0, 0}, {6, -0.5}, {6, 0.5}}}), 0.2);
  problem.options.set("limits.min_angle", 20.0);
  try {
    mesh(problem, "DB");
    FAIL() << "a corner of ten degrees passed";
  } catch (const UnsoundError& error) {
    const std::string text = error.what();
    EXPECT_TRUE(holds(text, "beyond the limits", "an angle below 20 degrees", "the least 9.5", "at ("));
    EXPECT_EQ(text.find("not sound"), std::string::npos) << text;
    ASSERT_TRUE(error.result);
    EXPECT_TRUE(error.result->soundness.sound());
  }
  problem.options.set("limits.min_angle", 5.0);
  EXPECT_TRUE(mesh(problem, "DB").soundness.accepted());
  problem.options.set("limits.max_aspect", 1.5);
  problem.allow_unsound = true;
  const MeshResult allowed = mesh(problem, "DB");
  const Soundness& beyond = allowed.soundness;
  EXPECT_TRUE(beyond.sound());
  EXPECT_EQ(allowed.warnings.back().text, beyond.complaint());
  ASSERT_EQ(beyond.beyond.size(), 1u);
  EXPECT_TRUE(holds(beyond.beyond[0], "an aspect above 1.5"));
}

TEST(Limits, LetPerfectSquaresThrough) {
  MeshProblem problem = problem_of(polygons({rectangle({0.1, 0.1}, {1.1, 1.1})}), 0.1);
  problem.options.set("limits.min_angle", 90.0).set("limits.max_aspect", 1.0);
  EXPECT_TRUE(mesh(problem, "DB").soundness.accepted());
  EXPECT_THROW(problem.options.set("limits.max_aspect", 0.5), InputError);
}

TEST(SinglePrecision, IsToldOfFarModels) {
  const auto far_away = [](double x) {
    return mesh(problem_of(polygons({rectangle({x, x}, {x + 1, x + 1})}), 0.1), "DB").warnings;
  };
  EXPECT_TRUE(far_away(0).empty());
  EXPECT_TRUE(far_away(1e3).empty());
  const auto warnings = far_away(4e6);  // numbers there are half a unit apart
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(holds(warnings[0].text, "single precision", "inverted or flat",
                    "origin near to (4000000.5, 4000000.5, 0)"));
}

}  // namespace
}  // namespace delquad
