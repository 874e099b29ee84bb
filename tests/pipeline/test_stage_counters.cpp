#include "pipeline/stage_counters.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>

#include "geometry/surface/triangulated_model.h"
#include "pipeline/prepare_surface.h"
#include "pipeline/record.h"
#include "pipeline/runner.h"
#include "smoothing/quad_topology.h"
#include "tests/support/analytic_fields.h"
#include "tests/support/shapes.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/triangulated_shapes.h"

namespace delquad {
namespace {

using Json = nlohmann::json;

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
  for_each_summary([&](const char* step, auto member) {
    using Summary = typename std::remove_reference_t<decltype(std::declval<StageLog>().*member)>::value_type;
    StageLog log, one, two;
    one.*member = numbered<Summary>(1);
    two.*member = numbered<Summary>(10);
    log.add(one);
    log.add(two);
    int next = 0;
    for_each_counter<Summary>([&](const auto& field) {
      ++next;
      const auto& value = (*(log.*member)).*field.member;
      if constexpr (requires { value + 1; }) {
        const int expected = field.over == Over::kSum    ? 11 * next
                             : field.over == Over::kMost ? 10 * next
                                                         : next;
        EXPECT_EQ(value, expected) << step << " " << field.key;
      }
    });
  });
}

TEST(StageCounters, OneStopMakesTheWholeStop) {
  StageLog log, one, two;
  one.insertion.emplace();
  two.insertion.emplace().termination = FrontalTermination::kMaxPoints;
  log.add(one);
  log.add(two);
  log.add(one);
  EXPECT_EQ(log.insertion->termination, FrontalTermination::kMaxPoints);
}

TEST(StageCounters, DocumentationHasEveryOne) {
  const std::string text =
      testing_support::read_text(std::filesystem::path(DELQUAD_EXPERIMENTS) / "../docs/experiments.md");
  const auto table = text.find("| step | counters |");
  ASSERT_NE(table, std::string::npos);
  for_each_summary([&](const char* step, auto member) {
    using Summary = typename std::remove_reference_t<decltype(std::declval<StageLog>().*member)>::value_type;
    const auto begin = text.find(std::string("| `") + step + "` | ", table);
    ASSERT_NE(begin, std::string::npos) << step;
    const std::string row = text.substr(begin, text.find('\n', begin) - begin);
    for_each_counter<Summary>([&](const auto& field) {
      const std::string key = field.key;
      EXPECT_NE(row.find("`" + key + "`"), std::string::npos) << step << ": " << key;
    });
  });
}

Json record_of(const Case& c, const PreparedCase& prepared, const char* word, RunResult* result = nullptr) {
  Progress progress;
  const RunResult made = run_word(c, prepared, parse_word(word), progress);
  if (result != nullptr) *result = made;
  return Json::parse(run_record(c, prepared, parse_word(word), made));
}

Case case_of(const char* name) {
  Case c;
  c.name = c.where = name;
  return c;
}

TEST(Records, HaveEveryCounterOfEveryStep) {
  const Case c = case_of("lens");
  const PreparedCase prepared = prepare_surface(c, make_surface_model(testing_support::lens(64, 12, 0.45)),
                                                make_constant_size(0.3), [](double) {});
  RunResult result;
  const Json record = record_of(c, prepared, "DBCO", &result);
  for_each_summary([&](const char* step, auto member) {
    using Summary = typename std::remove_reference_t<decltype(std::declval<StageLog>().*member)>::value_type;
    ASSERT_EQ(record.contains(step), (result.log.*member).has_value()) << step;
    EXPECT_EQ(record.contains(step), std::string(step) != "adaptation") << step;
    if (!record.contains(step)) return;
    for_each_counter<Summary>([&](const auto& field) {
      ASSERT_TRUE(record[step].contains(field.key)) << step << " " << field.key;
      const auto& value = (*(result.log.*member)).*field.member;
      if constexpr (requires { value + 1; }) {
        EXPECT_EQ(record[step][field.key], value) << step << " " << field.key;
      }
    });
  });
  for (const char* step : {"parting", "lifting"}) EXPECT_TRUE(record["seconds"].contains(step)) << step;
  EXPECT_EQ(record["sound"], true);
  EXPECT_FALSE(record.contains("unsound"));
}

TEST(Records, StepsThatAreSwitchedOffAreNotThere) {
  Case c = case_of("lens");
  const PreparedCase prepared = prepare_surface(c, make_surface_model(testing_support::lens(64, 12, 0.45)),
                                                make_constant_size(0.3), [](double) {});
  c.options.repair = {.part_twins = false, .lift_bad_quads = false};
  const Json record = record_of(c, prepared, "DB");
  EXPECT_FALSE(record.contains("part_twins"));
  EXPECT_FALSE(record.contains("lift_bad_quads"));
  EXPECT_EQ(record["options"]["repair"]["part_twins"], false);
  EXPECT_EQ(record["options"]["repair"]["lift_bad_quads"], false);
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
    const StageInput input{boundary_, cross_, size_, options_};
    std::ranges::find(stage_registry(), letter, &Stage::letter)->run(input, patch_, log_);
  }
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
  MeshingOptions options_;
  PatchMesh patch_;
  StageLog log_;
};

/// The counters are of what the mesh is, not of what was tried.
TEST_F(Tube, ATreatmentThatIsTakenBackIsNotCountedAsDone) {
  run('D');
  run('B');
  ASSERT_TRUE(log_.discarded && log_.treatment);
  EXPECT_EQ(log_.discarded->treatments, 1);
  EXPECT_EQ(log_.treatment->rounds, 0);
  cut_open();
  patch_ = {};
  log_ = {};
  run('D');
  run('B');
  EXPECT_EQ(log_.discarded->treatments, 0);
  EXPECT_GT(log_.treatment->rounds, 0);
}

TEST_F(Tube, ACleanUpThatIsTakenBackIsNotCountedAsDone) {
  make_quads();
  const auto before = patch_.quads.quads;
  run('C');
  EXPECT_EQ(log_.discarded->cleanups, 1);
  EXPECT_EQ(patch_.quads.quads, before);
  const CleanupSummary kept = *log_.cleanup;
  EXPECT_GT(kept.irregular_before, 0);
  EXPECT_EQ(kept.irregular_after, kept.irregular_before);
  EXPECT_EQ(kept.rotations + kept.diamonds + kept.doublets + kept.splits + kept.openings + kept.tried, 0);

  cut_open();
  log_ = {};
  run('C');
  EXPECT_EQ(log_.discarded->cleanups, 0);
  EXPECT_LT(log_.cleanup->irregular_after, kept.irregular_before);
  EXPECT_GT(log_.cleanup->diamonds, 0);
  EXPECT_LT(patch_.quads.quads.size(), before.size());
}

TEST(Records, SayWhatMadeTheSizeLess) {
  Case c = case_of("lens");
  c.size.curvature = 24;
  const PreparedCase prepared = prepare_surface(c, make_surface_model(testing_support::lens(64, 12, 0.45)),
                                                make_constant_size(0.5), [](double) {});
  const Json record = record_of(c, prepared, "DB");
  EXPECT_EQ(record["domain"]["size_adapted_to"], Json({"curvature"}));
  EXPECT_GT(record["metrics"]["tau"].get<double>(), record["metrics"]["tau_given"].get<double>() + 5);
}

}  // namespace
}  // namespace delquad
