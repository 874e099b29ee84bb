// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/meshing.h"

namespace delquad {
namespace {

MeshProblem square_problem() { return problem_of(polygons({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}), 0.25); }

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

/// Returns the message of preparing the problem once it is changed.
std::string complaint(MeshProblem problem, const std::function<void(MeshProblem&)>& change) {
  change(problem);
  return message_of([&] { prepare_problem(problem); });
}

const SizeFunction kNothing = [](std::span<const Vec3>, std::span<double>) {};

TEST(CheckProblem, TakesWhatIsRight) {
  EXPECT_EQ(complaint(square_problem(), [](MeshProblem&) {}), "");
  EXPECT_EQ(complaint(surface(), [](MeshProblem&) {}), "");
}

struct Refusal {
  MeshProblem (*problem)();
  void (*change)(MeshProblem&);
  std::string says;  ///< the whole, or a part after "..."
};

TEST(CheckProblem, RefusesWhatMakesNoSense) {
  using P = MeshProblem;
  const std::vector<Refusal> refusals = {
      {square_problem, [](P& p) { p.model = PlanarModel{}; },
       "model: the model has no loops: nothing bounds a domain [empty-domain]"},
      {square_problem, [](P& p) { std::get<PlanarModel>(p.model).loops[0].curves = {1}; },
       "model: loop 1 has curve 1: there are 1, counted from 0"},
      {square_problem, [](P& p) { std::get<PlanarModel>(p.model).curves[0].shape = nullptr; },
       "model: curve 1 of the model has no shape"},
      {square_problem, [](P& p) { p.model = TriangleModel{}; },
       "triangles: holds neither triangles nor quads"},
      {square_problem, [](P& p) { p.model = LineModel{}; }, "...holds no line elements"},
      {square_problem, [](P& p) { p.model = CadModel{}; },
       "model: a CAD model has neither a file nor bytes: expected one of them"},
      {surface, [](P& p) { std::get<TriangleModel>(p.model).mesh.triangles[0][2] = 3; },
       "triangles: triangle 0 has point 3: there are 3, counted from 0"},
      {square_problem, [](P& p) { p.size.field = nullptr; }, "...expected a size"},
      {square_problem, [](P& p) { p.size.function = kNothing; }, "...expected one of them"},
      {square_problem, [](P& p) { p.size.gradation = NAN; },
       "size: 'gradation' is nan: expected a number above 0, or 0 for none"},
      {surface, [](P& p) { p.size.curvature = 1; },
       "size: 'curvature' is 1: expected at least 3, or 0 for none"},
      {surface, [](P& p) { p.size.min = 0.1; }, "...expected 'curvature' too"},
      {surface, [](P& p) { p.size.curvature = 12, p.size.min = 0.2, p.size.max = 0.1; },
       "...is larger than the largest"},
      {square_problem, [](P& p) { p.cross.kind = CrossKind::kField; }, "...have none"},
      {square_problem, [](P& p) { p.cross.field = make_function_cross([](Vec2) { return 0.0; }, "f"); },
       "...another kind asked for"},
      {surface, [](P& p) { p.surface.feature_angle = 181; },
       "model: 'surface.feature_angle' is 181: expected above 0 and at most 180"},
      {surface, [](P& p) { p.surface.weld_tolerance = NAN; }, "...'surface.weld_tolerance' is nan"},
      {surface, [](P& p) { p.surface.mirror = MirrorPlane{}; }, "...'surface.mirror.normal' has no length"},
      {square_problem, [](P& p) { p.max_elements = 0; }, "...'max_elements' is 0: expected at least 1"},
      {square_problem, [](P& p) { p.seed = -1; }, "...'seed' is -1"},
  };
  for (const auto& [problem, change, says] : refusals) {
    const std::string text = complaint(problem(), change);
    if (says.starts_with("...")) {
      EXPECT_TRUE(holds(text, says.substr(3)));
    } else {
      EXPECT_EQ(text, says);
    }
  }
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
    const MeshingSetup prepared = prepare_problem(problem);
    EXPECT_NEAR(prepared.size.expected_quads, 1 / 0.2 * (1 / 0.1 - 1 / 0.3), 0.5);
  }
  problem.seed = 0;
  const MeshingSetup prepared = prepare_problem(problem);
  int hint = -1;
  EXPECT_NEAR(prepared.patches[0].cross->at({0.3, 0.4}, hint).angle(), 0.3, 1e-12);
  EXPECT_EQ(complaint(problem, [](MeshProblem& p) { p.size.function = kNothing; }).substr(0, 34),
            "size: the size function is nan at ");
}

}  // namespace
}  // namespace delquad
