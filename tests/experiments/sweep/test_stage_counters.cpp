// SPDX-License-Identifier: GPL-3.0-or-later
#include "algorithms/finish/lift_bad_quads.h"
#include "algorithms/finish/separate_duplicates.h"
#include "algorithms/insertion/frontal_mesher.h"
#include "algorithms/insertion/linf_adaptation.h"
#include "algorithms/layout/joint_layouts.h"
#include "algorithms/recombination/recombine.h"
#include "algorithms/regularity/regularity.h"
#include "algorithms/treatment/treatment.h"
#include "experiments/sweep/record.h"
#include "geometry/mesh/quad_topology.h"
#include "geometry/surface/triangulated_model.h"
#include "mesher/prepare.h"
#include "mesher/runner.h"
#include "smoothing/cvt/smooth_points.h"
#include "smoothing/optimisation/track_optimisation.h"
#include "tests/support/analytic_fields.h"
#include "tests/support/files.h"
#include "tests/support/prepare_surface.h"
#include "tests/support/shapes.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

template <class... Summaries>
struct Types {};
/// The summaries of all steps.
using AllSummaries = Types<FrontalSummary, AdaptationSummary, RecombineSummary, SmoothingSummary,
                           TreatmentSummary, RegularitySummary, LayoutSummary, JointLayoutSummary,
                           OptimisationSummary, SeparationSummary, LiftingSummary, FailingRepairSummary>;

template <class Visit, class... All>
void for_each_summary(Types<All...>, Visit&& visit) {
  (visit(Counters<All>::step, All{}), ...);
}

/// A summary whose counters all differ: 1, 2, 3, ... times `scale`.
template <class Summary>
Summary numbered(int scale) {
  Summary summary;
  int next = 0;
  for_each_counter<Summary>([&](const auto& field) {
    auto& value = summary.*field.member;
    ++next;
    if constexpr (requires { value += 1; }) value = scale * next;
  });
  return summary;
}

TEST(StageCounters, AllOfThemAddUp) {
  for_each_summary(AllSummaries{}, [&]<class Summary>(const char* step, const Summary&) {
    StageLog log;
    const Summary one = numbered<Summary>(1), ten = numbered<Summary>(10);
    add_summary(log, one);
    add_summary(log, ten);
    double weight_one = 1, weight_ten = 1;
    if constexpr (requires { Counters<Summary>::weight(one); })
      weight_one = Counters<Summary>::weight(one), weight_ten = Counters<Summary>::weight(ten);
    int next = 0;
    for_each_counter<Summary>([&](const auto& field) {
      ++next;
      if constexpr (requires { one.*field.member + 1; }) {
        const double expected = field.over == Over::kSum    ? 11 * next
                                : field.over == Over::kMost ? 10 * next
                                : field.over == Over::kMean
                                    ? (weight_one + 10 * weight_ten) * next / (weight_one + weight_ten)
                                    : next;
        EXPECT_EQ(log.summaries.number(step, field.key), expected) << step << " " << field.key;
      }
    });
  });
}

TEST(StageCounters, OneStopMakesTheWholeStop) {
  StageLog log;
  FrontalSummary resolved, stopped;
  stopped.termination = FrontalTermination::kMaxPoints;
  for (const FrontalSummary& summary : {resolved, stopped, resolved}) {
    StageLog one;
    add_summary(one, summary);
    log.add(one);
  }
  EXPECT_EQ(log.summaries.get<std::string>("insertion", "termination"), "max_points");
}

TEST(StageCounters, EnergiesAreMeansOverCells) {
  Summaries all;
  SmoothingSummary small, large;
  small.cells = 10, small.final_energy = 1, small.samples = {{0, 2, true}, {0, NAN, false}, {1, 1, true}};
  large.cells = 30, large.final_energy = 3, large.termination = SmoothingTermination::kStuck;
  for (const SmoothingSummary& s : {small, large}) all.add("smoothing", fields_of(s));
  all.add("smoothing", fields_of(small));
  EXPECT_EQ(all.number("smoothing", "cells"), 50);
  EXPECT_DOUBLE_EQ(all.number("smoothing", "final_energy"), (10 * 1 + 30 * 3 + 10 * 1) / 50.0);
  using Tally = std::map<std::string, long long>;
  EXPECT_EQ((all.get<Tally>("smoothing", "termination")), (Tally{{"converged", 2}, {"stuck", 1}}));
  using Lists = std::vector<std::vector<double>>;
  EXPECT_EQ(all.get<Lists>("smoothing", "first_of_frames"), (Lists{{0, 2}, {}, {0, 2}}));
  EXPECT_EQ(all.get<Lists>("smoothing", "accepted_evaluations"), (Lists{{0, 2}, {}, {0, 2}}));
}

TEST(SummariesOfSteps, MistakesAreNamed) {
  Summaries all;
  all.add("own", {{"moved", 3}});
  EXPECT_THROW(all.add("own", {{"moved", 3.5}}), std::invalid_argument);
  EXPECT_THROW(all.number("own", "mvoed"), std::out_of_range);
  EXPECT_THROW(all.number("other", "moved"), std::out_of_range);
  all.add("own", {{"moved", 4}, {"late", 1.5}});
  EXPECT_EQ(all.number("own", "moved"), 7);
  EXPECT_EQ(all.number("own", "late"), 1.5);
}

TEST(StageCounters, DocumentationHasEveryOne) {
  const std::string text = read_text(fs::path(DELQUAD_EXPERIMENTS) / "../docs/results.md");
  const auto table = text.find("| step | counters |");
  ASSERT_NE(table, std::string::npos);
  for_each_summary(AllSummaries{}, [&](const char* step, const auto& summary) {
    const auto begin = text.find(std::string("| `") + step + "` | ", table);
    ASSERT_NE(begin, std::string::npos) << step;
    const std::string row = text.substr(begin, text.find('\n', begin) - begin);
    for (const SummaryField& field : fields_of(summary))
      EXPECT_TRUE(holds(row, "`" + field.key + "`")) << step << ": " << field.key;
  });
}

Json record_of(const MeshProblem& problem, const MeshingSetup& prepared, const char* word,
               MeshResult* result = nullptr) {
  const Prepared shared(std::make_shared<const MeshProblem>(problem),
                        std::make_shared<const MeshingSetup>(prepared));
  MeshResult made = mesh(shared, word);
  Case c;
  c.name = problem.name;
  c.options = problem.options;
  if (result != nullptr) *result = made;
  return Json::parse(run_record(c, parse_pipeline(word), made));
}

MeshProblem case_of(const char* name) {
  MeshProblem c;
  c.name = c.where = name;
  return c;
}

TEST(StageRecords, HaveEveryCounterOfEveryStep) {
  MeshProblem c = case_of("lens");
  c.criteria = *std::ranges::find(criteria_presets(), "batch", &Criteria::name);
  const MeshingSetup prepared = testing_support::prepare_surface(
      c, make_surface_model(testing_support::lens(64, 12, 0.45)), make_constant_size(0.3));
  MeshResult result;
  const Json record = record_of(c, prepared, "DBRCQO", &result);
  for_each_summary(AllSummaries{}, [&](const char* step, const auto& summary) {
    const bool was_made = step != std::string("adaptation") && step != std::string("smoothing");
    ASSERT_EQ(record.contains(step), was_made) << step;
    ASSERT_EQ(result.log.summaries.has(step), was_made) << step;
    if (!was_made) return;
    for (const SummaryField& field : fields_of(summary)) {
      ASSERT_TRUE(record[step].contains(field.key)) << step << " " << field.key;
      if (record[step][field.key].is_number()) {
        EXPECT_EQ(record[step][field.key], result.log.summaries.number(step, field.key))
            << step << " " << field.key;
      }
    }
  });
  for (const char* times : {"seconds", "cpu_seconds"})
    for (const char* step : {"parting", "lifting"})
      EXPECT_TRUE(record[times].contains(step)) << times << step;
  EXPECT_EQ(record["sound"], true);
  EXPECT_FALSE(record.contains("unsound"));
}

TEST(StageRecords, StepsThatAreSwitchedOffAreNotThere) {
  MeshProblem c = case_of("lens");
  c.options.set("repair.part_twins", false).set("repair.lift_bad_quads", false);
  const MeshingSetup prepared = testing_support::prepare_surface(
      c, make_surface_model(testing_support::lens(64, 12, 0.45)), make_constant_size(0.3));
  const Json record = record_of(c, prepared, "DB");
  EXPECT_FALSE(record.contains("part_twins"));
  EXPECT_FALSE(record.contains("lift_bad_quads"));
  EXPECT_EQ(record["problem"]["options"]["repair"]["part_twins"], false);
  EXPECT_EQ(record["problem"]["options"]["repair"]["lift_bad_quads"], false);
}

/// A tube cut open, four high and two around: its left side and its right side are the same curve.
class Tube : public testing::Test {
 protected:
  Tube() : boundary_(shapes::rectangle(2, 4, 2, 4)) {
    for (const auto& [left, right] : {std::pair(0, 2), {11, 3}, {10, 4}, {9, 5}, {8, 6}})
      boundary_.point_node[left] = right;
  }
  /// Goes on from where the patch is.
  void run(char letter) {
    const StageInput input{boundary_, cross_, size_, options_, 1000};
    std::ranges::find(stage_registry(), letter, &Stage::letter)->run(input, patch_, log_);
  }
  double counted(const char* step, const char* key) const { return log_.summaries.number(step, key); }
  void cut_open() { std::iota(boundary_.point_node.begin(), boundary_.point_node.end(), 0); }
  /// Eight quads, and two more in an edge that is open between the middle and the point below.
  void make_quads() {
    QuadPatch& mesh = patch_.quads;
    patch_.form = PatchForm::kQuads;
    mesh.points = boundary_.points;
    mesh.n_boundary = static_cast<int>(mesh.points.size());
    for (int y = 1; y < 4; ++y) mesh.points.push_back({1, double(y)});
    const std::array<std::array<int, 3>, 5> rows = {
        {{0, 1, 2}, {11, 12, 3}, {10, 13, 4}, {9, 14, 5}, {8, 7, 6}}};
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 2; ++x)
        mesh.quads.push_back({rows[y][x], rows[y][x + 1], rows[y + 1][x + 1], rows[y + 1][x]});
    QuadTopology topology(mesh);
    int edge = -1;
    topology.for_each_out(13, [&](int h) {
      if (topology.target(h) == 12) edge = h;
    });
    topology.open(edge, true);
    mesh = topology.to_patch();
  }

  PatchBoundary boundary_;
  testing_support::FunctionCross cross_{0};
  testing_support::FunctionSize size_{1};
  Options options_;
  PatchMesh patch_;
  StageLog log_;
};

/// The counters are of what the mesh is, not of what was tried.
TEST_F(Tube, ATreatmentThatIsTakenBackIsNotCountedAsDone) {
  run('D');
  run('B');
  EXPECT_EQ(counted("discarded", "treatments"), 1);
  EXPECT_EQ(counted("treatment", "rounds"), 0);
  cut_open();
  patch_ = {};
  log_ = {};
  run('D');
  run('B');
  EXPECT_EQ(counted("discarded", "treatments"), 0);
  EXPECT_GT(counted("treatment", "rounds"), 0);
}

TEST_F(Tube, ACleanUpThatIsTakenBackIsNotCountedAsDone) {
  make_quads();
  const auto before = patch_.quads.quads;
  run('C');
  EXPECT_EQ(counted("discarded", "cleanups"), 1);
  EXPECT_EQ(patch_.quads.quads, before);
  const double irregular = counted("cleanup", "irregular_before");
  EXPECT_GT(irregular, 0);
  EXPECT_EQ(counted("cleanup", "irregular_after"), irregular);
  EXPECT_EQ(counted("cleanup", "tried"), 0);

  cut_open();
  log_ = {};
  run('C');
  EXPECT_EQ(counted("discarded", "cleanups"), 0);
  EXPECT_LT(counted("cleanup", "irregular_after"), irregular);
  EXPECT_GT(counted("cleanup", "accepted"), 0);
  EXPECT_LT(patch_.quads.quads.size(), before.size());
}

TEST_F(Tube, FillsThatAreTakenBackAreNotCountedAsDone) {
  make_quads();
  const auto before = patch_.quads.quads;
  run('Q');
  EXPECT_EQ(counted("discarded", "cleanups"), 1);
  EXPECT_EQ(patch_.quads.quads, before);
  EXPECT_EQ(counted("regularity", "irregular_after"), counted("regularity", "irregular_before"));
  EXPECT_EQ(counted("regularity", "accepted"), 0);

  cut_open();
  log_ = {};
  run('Q');
  EXPECT_EQ(counted("discarded", "cleanups"), 0);
  EXPECT_GT(counted("regularity", "accepted"), 0);
  EXPECT_LT(patch_.quads.quads.size(), before.size());
}

TEST(StageRecords, SayWhatMadeTheSizeLess) {
  MeshProblem c = case_of("lens");
  c.size.curvature = 24;
  const MeshingSetup prepared = testing_support::prepare_surface(
      c, make_surface_model(testing_support::lens(64, 12, 0.45)), make_constant_size(0.5));
  const Json record = record_of(c, prepared, "DB");
  EXPECT_EQ(record["domain"]["size_adapted_to"], Json({"curvature"}));
  EXPECT_GT(record["metrics"]["tau"].get<double>(), record["metrics"]["tau_given"].get<double>() + 5);
}

}  // namespace
}  // namespace delquad
