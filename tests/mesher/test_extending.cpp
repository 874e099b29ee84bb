// SPDX-License-Identifier: GPL-3.0-or-later
#include <atomic>
#include "delquad/matching.h"
#include "geometry/planar/planar_model.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// A disc at size 0.2.
MeshProblem disc() { return ModelMaker().circle({0, 0}, 1).problem(0.2); }

MeshResult run(const MeshProblem& problem, const char* word) {
  return meshed(prepare_problem(problem), word);
}

std::string complaint(const MeshProblem& problem, const char* word) {
  try {
    run(problem, word);
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// The arguments of its last call.
std::function<void(const StageInput&, PatchMesh&, StageLog&)>& stage_work() {
  static std::function<void(const StageInput&, PatchMesh&, StageLog&)> work;
  return work;
}

class OwnStage : public testing::Test {
 protected:
  OwnStage() {
    if (std::ranges::find(stage_registry(), 'Y', &Stage::letter) == stage_registry().end())
      add_stage(
          {'Y', "a test's", PatchForm::kTriangles, PatchForm::kTriangles,
           [](const StageInput& in, PatchMesh& patch, StageLog& log) { stage_work()(in, patch, log); }});
  }
};

TEST_F(OwnStage, TellsWhatItDid) {
  stage_work() = [](const StageInput& in, PatchMesh& patch, StageLog& log) {
    log.summaries.add("own", {{"points", static_cast<long long>(patch.triangles.points.size())},
                              {"rejection", in.options.number("insertion.rejection"), Over::kMost}});
  };
  MeshProblem problem = disc();
  problem.options.set("insertion.rejection", 0.6);
  const MeshResult result = run(problem, "DYB");
  EXPECT_GT(result.log.summaries.number("own", "points"), 50);
  EXPECT_EQ(result.log.summaries.number("own", "rejection"), 0.6);
  EXPECT_TRUE(result.soundness.sound());
}

/// Whatever it leaves, the next stage does not crash on it.
TEST_F(OwnStage, WhatItLeavesIsChecked) {
  const auto left = [](std::function<void(PatchMesh&)> spoil) {
    stage_work() = [spoil = std::move(spoil)](const StageInput&, PatchMesh& patch, StageLog&) {
      spoil(patch);
    };
    return complaint(disc(), "DYB");
  };
  EXPECT_EQ(left([](PatchMesh&) {}), "");
  EXPECT_TRUE(has(left([](PatchMesh& p) { p.form = PatchForm::kQuads; }), "another form"));
  EXPECT_TRUE(has(left([](PatchMesh& p) { p.triangles = {}; }), "not the boundary's"));
  EXPECT_TRUE(has(left([](PatchMesh& p) { p.triangles.points[0].x += 1; }), "not the boundary's"));
  EXPECT_TRUE(has(left([](PatchMesh& p) { p.triangles.triangles[0][1] = 1 << 30; }), "no point"));
  EXPECT_TRUE(has(left([](PatchMesh& p) { p.triangles.triangles[0][1] = -1; }), "no point"));
  EXPECT_TRUE(has(left([](PatchMesh& p) { p.triangles.neighbours.clear(); }), "without neighbors"));
  EXPECT_TRUE(has(left([](PatchMesh& p) { p.triangles.neighbours[0][0] = -2; }), "without neighbors"));
  EXPECT_TRUE(has(left([](PatchMesh&) { throw std::runtime_error("out of ideas"); }), "out of ideas"));
}

/// Changes of all patches are checked in the same way.
TEST_F(OwnStage, WhatItDoesToAllPatchesIsChecked) {
  static std::function<void(PatchMesh&)> spoil;
  add_stage({'W', "a test's finish", PatchForm::kQuads, PatchForm::kQuads,
             [](const StageInput&, PatchMesh&, StageLog&) {},
             [](const AllPatches& all, StageLog&) { spoil(all.patches[0]); }});
  const auto left = [](std::function<void(PatchMesh&)> by) {
    spoil = std::move(by);
    return complaint(disc(), "DBW");
  };
  EXPECT_EQ(left([](PatchMesh&) {}), "");
  EXPECT_TRUE(has(left([](PatchMesh& p) { p.quads.quads[0][3] = 2'000'000'000; }), "no point"));
  EXPECT_TRUE(has(left([](PatchMesh& p) { p.quads.points.pop_back(); }), "no point"));
  EXPECT_TRUE(has(left([](PatchMesh& p) { p.inside.push_back({}); }), "places in space"));
}

/// A maker's field that is no number somewhere is refused there.
TEST(OwnCross, IsCheckedWhereItIsAsked) {
  class Hole final : public CrossField {
   public:
    Cross at(Vec2 u, int&) const override { return {u.x > 0.5 ? std::nan("") : 1, 0}; }
  };
  MeshProblem problem = disc();
  problem.cross.kind = CrossKind::kMade;
  problem.cross.maker = [](const PatchBoundary&, const ParametricSize&, const Options&) {
    return std::make_shared<Hole>();
  };
  EXPECT_TRUE(has(complaint(problem, "DB"), "nan"));
}

TEST_F(OwnStage, NeedsALetterAndWork) {
  EXPECT_THROW(add_stage({'Y', "another", PatchForm::kTriangles, PatchForm::kTriangles, stage_work()}),
               std::invalid_argument);
  EXPECT_THROW(add_stage({'Q', "nothing", PatchForm::kTriangles, PatchForm::kTriangles, {}}),
               std::invalid_argument);
}

/// A placement that sees the layers and the size elsewhere.
class Curious final : public PointPlacement {
 public:
  std::string name() const override { return "curious"; }
  double default_h_max() const override { return 1.4; }
  double triangle_size(const std::array<Vec2, 3>& t, Cross cross, double delta) const override {
    return linf_->triangle_size(t, cross, delta);
  }
  Candidates candidates(const FrontEdge& edge) const override {
    most_layers = std::max(most_layers, edge.layer);
    least_layer = std::min(least_layer, edge.layer);
    worst = std::max(worst, std::abs(edge.delta_at({0.5, 0}) - 0.3));
    return linf_->candidates(edge);
  }
  double length(Vec2 v, const Frame& frame) const override { return linf_->length(v, frame); }

  inline static int most_layers = 0, least_layer = 1000;
  inline static double worst = 0;

 private:
  std::unique_ptr<PointPlacement> linf_ = make_linf_delquad();
};

TEST(OwnPlacement, KnowsLayersAndTheSizeElsewhere) {
  if (std::ranges::find(stage_registry(), 'W', &Stage::letter) == stage_registry().end())
    add_stage(insertion_stage('W', "curious", [](const Options&) { return std::make_unique<Curious>(); }));
  MeshProblem problem = disc();
  problem.size.field = make_function_size([](const Vec3& x) { return 0.25 + 0.1 * x.x; }, "slope");
  const MeshResult result = run(problem, "W");
  EXPECT_EQ(Curious::least_layer, 1);
  EXPECT_EQ(Curious::most_layers, result.log.summaries.number("insertion", "layers"));
  EXPECT_GT(Curious::most_layers, 2);
  EXPECT_LT(Curious::worst, 1e-12);
}

/// Gives what the test wants.
struct Fake final : MatchingSolver {
  std::function<void(const MatchingGraph&, MatchingResult&)> spoil;
  explicit Fake(std::function<void(const MatchingGraph&, MatchingResult&)> spoil_)
      : spoil(std::move(spoil_)) {}
  std::string name() const override { return "fake"; }
  MatchingResult solve(const MatchingGraph& graph) const override {
    MatchingResult result = matching_solver("primal-dual")->solve(graph);
    if (result.status == MatchingStatus::kOptimal) spoil(graph, result);
    return result;
  }
};

std::function<void(const MatchingGraph&, MatchingResult&)>& solver_work() {
  static std::function<void(const MatchingGraph&, MatchingResult&)> work;
  return work;
}

class OwnSolver : public testing::Test {
 protected:
  OwnSolver() {
    if (std::ranges::count(matching_solver_names(), "fake") == 0)
      add_matching_solver("fake", [](const Options&) {
        return std::make_unique<Fake>([](const auto& graph, auto& result) { solver_work()(graph, result); });
      });
    problem_.options.set("recombination.solver", "fake");
  }
  std::string with(std::function<void(MatchingResult&)> spoil) {
    solver_work() = [spoil = std::move(spoil)](const MatchingGraph&, MatchingResult& result) {
      spoil(result);
    };
    return complaint(problem_, "DB");
  }
  MeshProblem problem_ = disc();
};

TEST_F(OwnSolver, IsChosenByItsOption) {
  solver_work() = [](const MatchingGraph& graph, MatchingResult& result) {
    result.fields = {{"nodes", static_cast<long long>(graph.n_nodes)}};
  };
  const MeshResult own = run(problem_, "DB"), usual = run(disc(), "DB");
  EXPECT_EQ(own.log.summaries.number("recombination", "nodes"),
            own.log.summaries.number("recombination", "triangles"));
  EXPECT_EQ(usual.log.summaries.find("recombination")->find("nodes"), nullptr);
  EXPECT_EQ(own.mesh.quads, usual.mesh.quads);
}

TEST_F(OwnSolver, ItsResultsAreChecked) {
  EXPECT_EQ(with([](MatchingResult&) {}), "");
  EXPECT_TRUE(has(with([](MatchingResult& r) { r.mate.pop_back(); }), "'fake': its result has"));
  EXPECT_TRUE(has(with([](MatchingResult& r) { std::ranges::reverse(r.mate); }), "no perfect matching"));
  EXPECT_TRUE(
      has(with([](MatchingResult& r) { r.mate.assign(r.mate.size(), 1 << 30); }), "no perfect matching"));
  EXPECT_TRUE(has(with([](MatchingResult& r) { ++r.cost; }), "it costs"));
  EXPECT_TRUE(has(with([](MatchingResult&) { throw std::runtime_error("no time"); }), "no time"));
}

TEST(Solvers, MistakesAreNamed) {
  expect_input_error([] { matching_solver("lemom"); },
                     {"'lemom'", "known: primal-dual, lemon", "did you mean 'lemon'?"});
  EXPECT_THROW(add_matching_solver("lemon", {}), std::invalid_argument);
  EXPECT_THROW(add_matching_solver("", {}), std::invalid_argument);
}

std::function<double(const MetricInput&)>& metric_work() {
  static std::function<double(const MetricInput&)> work;
  return work;
}

TEST(OwnMetrics, AreMeasuredWithTheOthers) {
  const auto measured = [](std::function<double(const MetricInput&)> work) {
    metric_work() = std::move(work);
    if (find_metric("own") == nullptr)
      add_metric({"own", "own", "", Better::kLower, 1, "a test"},
                 [](const MetricInput& in) { return metric_work()(in); });
    return run(disc(), "DB").metrics;
  };
  const MeshMetrics good = measured([](const MetricInput& in) {
    int hint = -1;
    return static_cast<double>(in.mesh.quads.size()) + in.size->at({0, 0, 0}, hint) +
           in.options.number("optimisation.size");
  });
  EXPECT_DOUBLE_EQ(good.values.at("own"), good.values.at("n_quads") + 0.2 + 0.4);
  EXPECT_TRUE(good.failures.empty());
  const MeshMetrics undefined = measured([](const MetricInput&) { return std::nan(""); });
  EXPECT_TRUE(std::isnan(undefined.values.at("own")) && undefined.failures.empty());
  const MeshMetrics thrown =
      measured([](const MetricInput&) -> double { throw std::runtime_error("no solution"); });
  EXPECT_TRUE(std::isnan(thrown.values.at("own")));
  EXPECT_EQ(thrown.failures.at("own"), "no solution");
  EXPECT_EQ(thrown.values.at("n_quads"), good.values.at("n_quads"));
  const MeshMetrics odd = measured([](const MetricInput&) -> double { throw 3; });
  EXPECT_TRUE(has(odd.failures.at("own"), "no std::exception"));
  const MeshMetrics infinite = measured([](const MetricInput&) { return INFINITY; });
  EXPECT_TRUE(std::isnan(infinite.values.at("own")));
  EXPECT_TRUE(has(infinite.failures.at("own"), "infinite"));
  EXPECT_THROW(measured([](const MetricInput&) -> double { throw Cancelled("stop"); }), Cancelled);
  metric_work() = [](const MetricInput&) { return 0.0; };
}

TEST(OwnMetrics, KnowProblemWordAndSurface) {
  metric_work() = [](const MetricInput& in) {
    EXPECT_EQ(in.pipeline, "DB");
    EXPECT_EQ(in.problem, "disc");
    return in.surface == nullptr ? 0.0 : static_cast<double>(in.surface->triangles.size());
  };
  if (find_metric("own") == nullptr)
    add_metric({"own", "own", "", Better::kLower, 1, "a test"},
               [](const MetricInput& in) { return metric_work()(in); });
  MeshProblem problem = disc();
  problem.name = "disc";
  const MeshResult plane = mesh(problem, "DB");
  EXPECT_EQ(plane.metrics.values.at("own"), 0);
  EXPECT_EQ(plane.prepared.metrics(plane.mesh, "DB").values.at("own"), 0);
  problem.model = ExampleModel{"bracket"};
  problem.size.field = make_constant_size(10);
  const MeshResult solid = mesh(problem, "DB");
  EXPECT_EQ(solid.metrics.values.at("own"), static_cast<double>(solid.prepared.fine().triangles.size()));
  metric_work() = [](const MetricInput&) { return 0.0; };
}

std::function<double(const MergedQuad&)>& cost_work() {
  static std::function<double(const MergedQuad&)> work;
  return work;
}

class OwnCost : public testing::Test {
 protected:
  OwnCost() {
    if (std::ranges::count(merge_cost_names(), "own") == 0)
      add_merge_cost("own", [](const Options&) {
        return [](std::span<const MergedQuad> quads, std::span<double> cost) {
          std::ranges::transform(quads, cost.begin(),
                                 [](const MergedQuad& quad) { return cost_work()(quad); });
        };
      });
    problem_.options.set("recombination.cost", "own");
  }
  MeshProblem problem_ = disc();
};

/// The place of the worst angle, in [0, 360) degrees.
double one_minus_eta(const MergedQuad& quad) {
  double worst = 0;
  for (int k = 0; k < 4; ++k) {
    const Vec2 at = quad.corners[k], u = quad.corners[(k + 1) % 4] - at, v = quad.corners[(k + 3) % 4] - at;
    const double angle = std::atan2(cross(u, v), dot(u, v)) / (std::numbers::pi / 2);
    worst = std::max(worst, std::abs((angle < 0 ? angle + 4 : angle) - 1));
  }
  return worst;
}

TEST_F(OwnCost, ThatOfTheProjectMakesTheSameMesh) {
  cost_work() = [](const MergedQuad& quad) {
    EXPECT_DOUBLE_EQ(quad.delta, 0.2);
    return std::floor(1e6 * one_minus_eta(quad)) / 1e6;
  };
  EXPECT_EQ(run(problem_, "DB").mesh.quads, run(disc(), "DB").mesh.quads);
}

TEST_F(OwnCost, AnotherMakesAnother) {
  cost_work() = [](const MergedQuad& quad) { return std::max(0.0, 1 - one_minus_eta(quad)); };
  problem_.options.set("recombination.treatment", "none");
  MeshProblem usual = disc();
  usual.options.set("recombination.treatment", "none");
  EXPECT_LT(run(problem_, "DB").metrics.values.at("eta_mean"),
            run(usual, "DB").metrics.values.at("eta_mean") - 0.05);
}

TEST_F(OwnCost, ItsValuesAreChecked) {
  for (const double bad : {-0.1, 3.1, std::nan("")}) {
    cost_work() = [bad](const MergedQuad&) { return bad; };
    EXPECT_TRUE(has(complaint(problem_, "DB"), "matching cost 'own'")) << bad;
  }
  EXPECT_THROW(add_merge_cost("eta", [](const Options&) { return MergeCost(); }), std::invalid_argument);
  EXPECT_THROW(add_merge_cost("3", [](const Options&) { return MergeCost(); }), std::invalid_argument);
}

TEST(OwnParts, LettersAndCandidatesAreChecked) {
  const auto nothing = [](const StageInput&, PatchMesh&, StageLog&) {};
  for (const char letter : {'z', '1', ' ', '\0'})
    EXPECT_THROW(add_stage({letter, "bad", PatchForm::kQuads, PatchForm::kQuads, nothing}),
                 std::invalid_argument);
  Candidates candidates;
  for (int k = 0; k < 3; ++k) candidates.add({});
  EXPECT_THROW(candidates.add({}), std::out_of_range);
}

TEST(OwnFields, ACrossMakerServesEveryPatch) {
  std::atomic<int> calls = 0;
  MeshProblem problem = disc();
  problem.cross.kind = CrossKind::kMade;
  expect_input_error([&] { prepare(problem); }, {"maker"});
  problem.cross.maker = [&](const PatchBoundary& boundary, const ParametricSize&, const Options&) {
    ++calls;
    EXPECT_FALSE(boundary.points.empty());
    return make_function_cross([](Vec2) { return 0.3; }, "constant");
  };
  const Prepared prepared = prepare(problem);
  EXPECT_EQ(calls, 1);
  EXPECT_TRUE(prepared->crosses.singularities.empty());
  Mesh somewhere;
  somewhere.points = {{0.1, 0.2, 0}};
  const Vec3 edge = wanted_at(prepared, somewhere).edges[0][0];
  EXPECT_NEAR(std::atan2(edge.y, edge.x), 0.3, 1e-12);
}

TEST(OwnMetrics, MistakesOfProgrammersAreNamed) {
  const auto measure = [](const MetricInput&) { return 0.0; };
  EXPECT_THROW(add_metric({"tau", "tau", "", Better::kHigher, 0, ""}, measure), std::invalid_argument);
  EXPECT_THROW(add_metric({"", "", "", Better::kHigher, 0, ""}, measure), std::invalid_argument);
  EXPECT_THROW(add_metric({"nothing", "", "", Better::kHigher, 0, ""}, {}), std::invalid_argument);
  EXPECT_EQ(find_metric("nothing"), nullptr);
}

}  // namespace
}  // namespace delquad
