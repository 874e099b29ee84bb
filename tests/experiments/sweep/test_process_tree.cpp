// SPDX-License-Identifier: GPL-3.0-or-later
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>
#include <atomic>
#include <new>

#include "base/context.h"
#include "base/parallel.h"
#include "experiments/sweep/process_tree.h"
#include "tests/support/files.h"

namespace delquad {
namespace {

using namespace std::chrono_literals;

/// State that all processes see.
struct Shared {
  std::atomic<int> done = 0, working = 0, most_working = 0;
};

class ProcessTree : public testing::Test {
 protected:
  ProcessTree()
      : shared_(*new (mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1,
                           0)) Shared) {}
  ~ProcessTree() override { munmap(&shared_, sizeof(Shared)); }

  Job job(std::function<void()> work) {
    return {std::move(work), {}, [this](const ProcessFailure& f) { failures_.push_back(f); }};
  }
  Job counting_job() {
    return job([this] {
      const int now = ++shared_.working;
      int most = shared_.most_working;
      while (now > most && !shared_.most_working.compare_exchange_weak(most, now)) {
      }
      std::this_thread::sleep_for(20ms);
      --shared_.working;
      ++shared_.done;
    });
  }
  void run(std::vector<Job> jobs, const ProcessLimits& limits = {}) {
    std::size_t k = 0;
    run_jobs([&] { return k < jobs.size() ? std::optional(std::move(jobs[k++])) : std::nullopt; }, limits);
  }

  Shared& shared_;
  std::vector<ProcessFailure> failures_;
};

TEST_F(ProcessTree, RunsEverythingWithinItsBounds) {
  for (const int jobs : {1, 3}) {
    shared_.done = shared_.most_working = 0;
    std::vector<Job> roots;
    for (int i = 0; i < 3; ++i) {
      roots.push_back(counting_job());
      roots.back().next = [this] {
        std::vector<Job> next;
        for (int k = 0; k < 3; ++k) {
          next.push_back(counting_job());
          next.back().next = [this] { return std::vector<Job>{counting_job(), counting_job()}; };
        }
        return next;
      };
    }
    run(std::move(roots), {jobs, 0, 0});
    EXPECT_EQ(shared_.done, 3 + 9 + 18);
    EXPECT_LE(shared_.most_working, jobs);
    EXPECT_TRUE(failures_.empty());
  }
}

TEST_F(ProcessTree, WhatFollowsSeesWhatWasDone) {
  auto value = std::make_shared<int>(1);
  Job root = job([value] { *value = 7; });
  root.next = [this, value] { return std::vector<Job>{job([this, value] { shared_.done += *value; })}; };
  run({std::move(root)});
  EXPECT_EQ(shared_.done, 7);
  EXPECT_EQ(*value, 1) << "the work was done in another process";
}

TEST_F(ProcessTree, FailuresHaveTheirReasonsAndTheRestGoesOn) {
  run({job([] { throw InputError("no such thing"); }), job([] { throw std::logic_error("broken"); }),
       job([] { raise(SIGKILL); }), job([] { _exit(9); }), counting_job()});
  ASSERT_EQ(failures_.size(), 4u);
  EXPECT_EQ(failures_[0].kind, "bad input");
  EXPECT_EQ(failures_[0].reason, "no such thing");
  EXPECT_EQ(failures_[1].kind, "internal error");
  EXPECT_EQ(failures_[2].kind, "crash");
  EXPECT_TRUE(holds(failures_[2].reason, "signal 9"));
  EXPECT_EQ(failures_[3].reason, "ended with exit code 9");
  EXPECT_EQ(shared_.done, 1);
}

TEST_F(ProcessTree, WhatHangsIsEnded) {
  const auto hang = [] {
    for (;;) std::this_thread::sleep_for(1s);
  };
  Job late = job([] { std::this_thread::sleep_for(100ms); });
  late.next = [this] { return std::vector<Job>{counting_job()}; };
  run({job(hang), std::move(late), counting_job()}, {1, 3, 0});
  ASSERT_EQ(failures_.size(), 1u);
  EXPECT_EQ(failures_[0].kind, "timeout");
  EXPECT_EQ(shared_.done, 2);
}

/// Its own time would be short enough.
TEST_F(ProcessTree, TimeCountsFromTheBeginningOfTheChain) {
  Job root = job([] { std::this_thread::sleep_for(1s); });
  root.next = [this] {
    Job long_one = job([] { std::this_thread::sleep_for(2500ms); });
    long_one.failed = [this](const ProcessFailure& f) { shared_.done += f.kind == "timeout"; };
    return std::vector<Job>{std::move(long_one)};
  };
  run({std::move(root)}, {1, 3, 0});
  EXPECT_EQ(shared_.done, 1);
}

TEST_F(ProcessTree, MemoryIsLimited) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer reserves more memory than any limit leaves";
#endif
  run({job([] {
         Strings hoard;
         for (;;) hoard.emplace_back(1 << 20, 'x');
       }),
       counting_job()},
      {1, 0, 300 << 20});
  ASSERT_EQ(failures_.size(), 1u);
  EXPECT_EQ(failures_[0].kind, "memory");
  EXPECT_TRUE(holds(failures_[0].reason, "0.293 GiB"));
  EXPECT_EQ(shared_.done, 1);
}

/// A process that has started threads forks, and both go on with threads of their own.
TEST_F(ProcessTree, ThreadsSurviveForks) {
  const RunScope scope({.threads = 2});
  const auto add = [this] {
    parallel_for(8, [this](std::size_t) {
      std::this_thread::sleep_for(2ms);
      ++shared_.done;
    });
  };
  Job root = job(add);
  root.next = [this, add] { return std::vector<Job>{job(add), job(add)}; };
  run({std::move(root)}, {2, 10, 0});
  add();
  EXPECT_EQ(shared_.done, 32);
  EXPECT_TRUE(failures_.empty());
}

}  // namespace
}  // namespace delquad
