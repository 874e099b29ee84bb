// SPDX-License-Identifier: GPL-3.0-or-later
#include <malloc.h>
#include <atomic>
#include "base/activity.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

/// The solver of Ceres may not be thrown through. It goes on with steps that fail at their first check until
/// it gives up. By its options these are at most 20 in a search, and a search anew. No more than this many
/// checks come after the one that finds the run cancelled.
constexpr int kMostChecksAfter = 100;

PlanarModel disc_with_hole() { return ModelMaker().circle({0, 0}, 1).circle({0.3, 0.1}, 0.2); }

PlanarModel square() { return ModelMaker().loop({make_polyline({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}})}); }

/// Small near one place, so that sizes vary.
std::shared_ptr<const SizeField> graded(double delta) {
  return make_function_size([delta](const Vec3& x) { return delta * (0.5 + std::hypot(x.x, x.y)); },
                            "graded");
}

MeshProblem planar_problem() {
  MeshProblem problem = problem_of(disc_with_hole());
  problem.size.field = graded(0.08);
  return problem;
}

MeshProblem size_aware_problem() {
  MeshProblem problem = planar_problem();
  problem.size.gradation = 0.5;
  problem.cross.kind = CrossKind::kSizeAware;
  return problem;
}

MeshProblem box_problem() { return problem_of(TriangleModel{box(4), "box"}, 0.11); }

MeshProblem lens_problem() {
  MeshProblem problem = problem_of(TriangleModel{lens(24, 6, 0.3), "lens"}, 0.1);
  problem.size.curvature = 30;
  return problem;
}

struct Row {
  const char *name, *word;
  MeshProblem (*problem)();
};
const Row kTable[] = {
    {"planarF", "FB", planar_problem},       {"planarBest", "DLBCO", planar_problem},
    {"planarPacked", "PBC", planar_problem}, {"planarGreedy", "DG", planar_problem},
    {"planarAdapted", "DT", planar_problem}, {"planarSizeAware", "DBCO", size_aware_problem},
    {"boxGood", "DBCO", box_problem},        {"lensBest", "DLBCO", lens_problem},
};

Mesh mesh_of(const Row& row) { return meshed(prepare_problem(row.problem()), row.word).mesh; }

bool same(const Mesh& a, const Mesh& b) {
  return a.points == b.points && a.quads == b.quads && a.triangles == b.triangles && a.lines == b.lines;
}

class Cancellation : public testing::TestWithParam<Row> {};

/// At any of the checks that a run makes: it ends there, nothing is left behind, and the next run is as ever.
TEST_P(Cancellation, AtAnyCheckEndsTheRun) {
  long long all = 0;
  const Mesh whole = [&] {
    const RunScope run({.threads = 1, .on_check = [&] { ++all; }});
    return mesh_of(GetParam());
  }();
  ASSERT_GT(all, 1000);
  std::mt19937 random(7);
  constexpr int kTrials = 15;
  for (int trial = 0; trial < kTrials; ++trial) {
    const long long at = trial == 0 ? 1 : trial == 1 ? all : 1 + static_cast<long long>(random() % all);
    SCOPED_TRACE(at);
    std::stop_source stop;
    long long checks = 0;
    const RunScope run({.threads = 1, .cancel = stop.get_token(), .on_check = [&] {
                          if (++checks == at) stop.request_stop();
                        }});
    try {
      mesh_of(GetParam());
      ADD_FAILURE() << "the run went on";
    } catch (const Cancelled& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("cancelled: ")) << error.what();
    }
    EXPECT_LE(checks - at, kMostChecksAfter);
    EXPECT_EQ(current_activities()->faces_text(), "");
  }
  const RunScope run({.threads = 1});
  EXPECT_TRUE(same(mesh_of(GetParam()), whole));
}

/// Cancels from another thread after a random time. The answer comes within so many checks of all threads, or
/// the mesh is the one that it would have been.
TEST_P(Cancellation, ByAnotherThreadIsHeard) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const Mesh whole = mesh_of(GetParam());
  const auto usual = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start).count();
  std::mt19937 random(3);
  constexpr int kTrials = 10, kThreads = 3;
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::chrono::microseconds pause(random() % static_cast<unsigned>(usual + 1));
    std::stop_source stop;
    std::atomic<long long> after = 0;
    std::jthread canceller([&] {
      std::this_thread::sleep_for(pause);
      stop.request_stop();
    });
    const RunScope run({.threads = kThreads, .cancel = stop.get_token(), .on_check = [&] {
                          if (stop.stop_requested()) ++after;
                        }});
    try {
      EXPECT_TRUE(same(mesh_of(GetParam()), whole));
    } catch (const Cancelled&) {
    }
    EXPECT_LE(after, kThreads * kMostChecksAfter);
  }
}

TEST_P(Cancellation, WhenTimeIsUpSaysAtWhat) {
  constexpr double kNoTime = 1e-6;
  const RunScope run({.threads = 2, .seconds = kNoTime});
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // coarser than any clock
  try {
    mesh_of(GetParam());
    ADD_FAILURE() << "the run went on";
  } catch (const TimeIsUp& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("stopped after 1e-06 s: ")) << error.what();
  }
}
INSTANTIATE_TEST_SUITE_P(Table, Cancellation, testing::ValuesIn(kTable),
                         [](const auto& row) { return std::string(row.param.name); });

/// Counts its evaluations, and cancels at one of them.
class StoppingSize final : public SizeField {
 public:
  StoppingSize(long long stop_at, std::stop_source stop) : stop_at_(stop_at), stop_(std::move(stop)) {}
  double at(const Vec3& x, int&) const override {
    if (++n_ == stop_at_) stop_.request_stop();
    return 0.05 * (0.5 + std::hypot(x.x, x.y));
  }
  long long evaluations() const { return n_; }

 private:
  long long stop_at_;
  mutable std::stop_source stop_;
  mutable std::atomic<long long> n_ = 0;
};

/// From one check to the next there is little work, counted in evaluations of the size.
TEST(CancellationBySize, IsHeardBeforeTheSizeIsAskedOftenAgain) {
  constexpr long long kMostEvaluations = 20000;  // at some tens of nanoseconds each: a millisecond
  const auto run = [](long long stop_at) {
    std::stop_source stop;
    const auto size = std::make_shared<StoppingSize>(stop_at, stop);
    MeshProblem problem = planar_problem();
    problem.size.field = size;
    const RunScope scope({.threads = 1, .cancel = stop.get_token()});
    try {
      meshed(prepare_problem(problem), "DLBCO");
    } catch (const Cancelled&) {
    }
    return size->evaluations();
  };
  const long long all = run(0);
  ASSERT_GT(all, 5 * kMostEvaluations);
  std::mt19937 random(11);
  constexpr int kTrials = 30;
  for (int trial = 0; trial < kTrials; ++trial) {
    const long long at = 1 + static_cast<long long>(random() % all);
    const long long after = run(at) - at;
    EXPECT_LE(after, kMostEvaluations) << at;
  }
}

/// Each with threads of its own.
TEST(MeshesAtOnce, AreAsOnesAlone) {
  const Row rows[] = {kTable[1], kTable[5], kTable[6], kTable[7]};
  std::vector<Mesh> alone, at_once(std::size(rows));
  for (const Row& row : rows) alone.push_back(mesh_of(row));
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < std::size(rows); ++i)
      threads.emplace_back([&, i] {
        const RunScope run({.threads = 1 + static_cast<int>(i) % 3});
        at_once[i] = mesh_of(rows[i]);
      });
  }
  for (std::size_t i = 0; i < std::size(rows); ++i) EXPECT_TRUE(same(at_once[i], alone[i])) << rows[i].name;
}

std::size_t bytes_in_use() {
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

/// Nothing is kept from one mesh to the next.
TEST(ManyMeshes, DoNotFillTheMemory) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer has an allocator of its own, and finds leaks itself";
#endif
  constexpr int kFirst = 100, kMeshes = 400;
  constexpr std::size_t kMostPerMesh = 256;  // bytes
  const auto mesh_once = [] {
    MeshProblem problem = problem_of(square(), 0.25);
    const RunScope run({.threads = 2});
    return meshed(prepare_problem(problem), "DLBCO").mesh.quads.size();
  };
  for (int i = 0; i < kFirst; ++i) ASSERT_GT(mesh_once(), 0u);
  malloc_trim(0);
  const std::size_t before = bytes_in_use();
  for (int i = 0; i < kMeshes; ++i) mesh_once();
  const std::size_t after = bytes_in_use();
  EXPECT_LT(after, before + kMeshes * kMostPerMesh);
}

/// Nor from those that are cancelled.
TEST(ManyMeshes, ThatAreCancelledDoNotFillTheMemory) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer has an allocator of its own, and finds leaks itself";
#endif
  constexpr int kFirst = 100, kMeshes = 300;
  constexpr std::size_t kMostPerMesh = 256;  // bytes
  std::mt19937 random(5);
  const auto cancel_once = [&] {
    MeshProblem problem = planar_problem();
    problem.size.field = make_constant_size(0.2);
    std::stop_source stop;
    long long checks = 0;
    const long long at = 1 + static_cast<long long>(random() % 3000);
    const RunScope run({.threads = 1, .cancel = stop.get_token(), .on_check = [&] {
                          if (++checks == at) stop.request_stop();
                        }});
    try {
      meshed(prepare_problem(problem), "DLBCO");
    } catch (const Cancelled&) {
    }
  };
  for (int i = 0; i < kFirst; ++i) cancel_once();
  malloc_trim(0);
  const std::size_t before = bytes_in_use();
  for (int i = 0; i < kMeshes; ++i) cancel_once();
  const std::size_t after = bytes_in_use();
  EXPECT_LT(after, before + kMeshes * kMostPerMesh);
}

}  // namespace
}  // namespace delquad
