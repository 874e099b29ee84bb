#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "mesher/prepare.h"

namespace delquad {
namespace {

MeshProblem square_problem() {
  MeshProblem problem;
  problem.model = polygons({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  problem.size.field = make_constant_size(0.25);
  return problem;
}

MeshProblem surface() {
  MeshProblem problem = square_problem();
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.triangle_region = {0};
  mesh.regions = {{1, {}}};
  problem.model = TriangleModel{mesh};
  return problem;
}

/// What preparing says of the problem once it is changed.
std::string complaint(MeshProblem problem, const std::function<void(MeshProblem&)>& change) {
  change(problem);
  try {
    prepare_problem(problem);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

const SizeFunction kNothing = [](std::span<const Vec3>, std::span<double>) {};

TEST(CheckProblem, TakesWhatIsRight) {
  EXPECT_EQ(complaint(square_problem(), [](MeshProblem&) {}), "");
  EXPECT_EQ(complaint(surface(), [](MeshProblem&) {}), "");
}

TEST(CheckProblem, RefusesModelsThatMakeNoSense) {
  const auto planar = [](MeshProblem& p) -> PlanarModel& { return std::get<PlanarModel>(p.model); };
  EXPECT_EQ(complaint(square_problem(), [](MeshProblem& p) { p.model = PlanarModel{}; }),
            "model: the model has no loops: nothing bounds a domain");
  EXPECT_EQ(complaint(square_problem(), [&](MeshProblem& p) { planar(p).loops[0].curves = {1}; }),
            "model: loop 1 has curve 1: there are 1, counted from 0");
  EXPECT_EQ(complaint(square_problem(), [&](MeshProblem& p) { planar(p).curves[0].shape = nullptr; }),
            "model: curve 1 of the model has no shape");
  EXPECT_EQ(complaint(square_problem(), [](MeshProblem& p) { p.model = TriangleModel{}; }),
            "triangles: holds neither triangles nor quads");
  EXPECT_NE(complaint(square_problem(), [](MeshProblem& p) { p.model = LineModel{}; })
                .find("holds no line elements"),
            std::string::npos);
  EXPECT_EQ(complaint(square_problem(), [](MeshProblem& p) { p.model = CadModel{}; }),
            "model: a CAD model needs a file or bytes, and has neither");
  EXPECT_EQ(
      complaint(surface(), [](MeshProblem& p) { std::get<TriangleModel>(p.model).mesh.triangles[0][2] = 3; }),
      "triangles: triangle 0 has point 3: there are 3, counted from 0");
}

TEST(CheckProblem, RefusesSizesThatMakeNoSense) {
  EXPECT_NE(
      complaint(square_problem(), [](MeshProblem& p) { p.size.field = nullptr; }).find("expected a size"),
      std::string::npos);
  EXPECT_NE(complaint(square_problem(), [](MeshProblem& p) { p.size.function = kNothing; })
                .find("expected one of them"),
            std::string::npos);
  EXPECT_EQ(complaint(square_problem(), [](MeshProblem& p) { p.size.gradation = NAN; }),
            "size: 'gradation' is nan: expected a number above 0, or 0 for none");
  EXPECT_EQ(complaint(surface(), [](MeshProblem& p) { p.size.curvature = 1; }),
            "size: 'curvature' is 1: expected at least 3, or 0 for none");
  EXPECT_NE(complaint(surface(), [](MeshProblem& p) { p.size.min = 0.1; }).find("expected 'curvature' too"),
            std::string::npos);
  EXPECT_NE(complaint(surface(),
                      [](MeshProblem& p) {
                        p.size.curvature = 12;
                        p.size.min = 0.2;
                        p.size.max = 0.1;
                      })
                .find("is larger than the largest"),
            std::string::npos);
}

TEST(CheckProblem, RefusesCrossesAndSurfacesThatMakeNoSense) {
  EXPECT_NE(
      complaint(square_problem(), [](MeshProblem& p) { p.cross.kind = CrossKind::kField; }).find("have none"),
      std::string::npos);
  EXPECT_NE(
      complaint(square_problem(),
                [](MeshProblem& p) { p.cross.field = make_function_cross([](Vec2) { return 0.0; }, "f"); })
          .find("another kind asked for"),
      std::string::npos);
  EXPECT_EQ(complaint(surface(), [](MeshProblem& p) { p.surface.feature_angle = 181; }),
            "model: 'surface.feature_angle' is 181: expected above 0 and at most 180");
  EXPECT_NE(complaint(surface(), [](MeshProblem& p) { p.surface.weld_tolerance = NAN; })
                .find("'surface.weld_tolerance' is nan"),
            std::string::npos);
  EXPECT_NE(complaint(surface(), [](MeshProblem& p) { p.surface.mirror = MirrorPlane{}; })
                .find("'surface.mirror.normal' has no length"),
            std::string::npos);
  EXPECT_NE(complaint(square_problem(), [](MeshProblem& p) { p.max_elements = 0; })
                .find("'max_elements' is 0: expected at least 1"),
            std::string::npos);
  EXPECT_NE(complaint(square_problem(), [](MeshProblem& p) { p.seed = -1; }).find("'seed' is -1"),
            std::string::npos);
}

TEST(CheckProblem, FunctionsAreSampledOnTheModel) {
  MeshProblem problem = square_problem();
  problem.size.field = nullptr;
  problem.size.function = [](std::span<const Vec3> x, std::span<double> delta) {
    for (std::size_t i = 0; i < x.size(); ++i) delta[i] = 0.1 + 0.2 * x[i].x;
  };
  problem.cross.kind = CrossKind::kField;
  problem.cross.function = [](std::span<const Vec2>, std::span<double> theta) {
    std::ranges::fill(theta, 0.3);
  };
  for (const long long seed : {0, 1}) {
    problem.seed = seed;
    const PreparedProblem prepared = prepare_problem(problem);
    EXPECT_NEAR(prepared.size.expected_quads, 1 / 0.2 * (1 / 0.1 - 1 / 0.3), 0.5);
  }
  problem.seed = 0;
  const PreparedProblem prepared = prepare_problem(problem);
  int hint = -1;
  EXPECT_NEAR(prepared.patches[0].cross->at({0.3, 0.4}, hint).angle(), 0.3, 1e-12);
  EXPECT_EQ(complaint(problem, [](MeshProblem& p) { p.size.function = kNothing; }).substr(0, 34),
            "size: the size function is nan at ");
}

}  // namespace
}  // namespace delquad
