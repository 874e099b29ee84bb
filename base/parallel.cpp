// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <numeric>
#include <vector>

#include "base/context.h"
#include "base/run.h"
#include "base/system.h"

namespace delquad {

namespace {

std::vector<std::size_t> by_cost(std::size_t n, const std::function<double(std::size_t)>& cost) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!cost) return order;
  std::vector<double> costs;
  for (std::size_t i = 0; i < n; ++i) costs.push_back(cost(i));
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) { return costs[i]; });
  return order;
}

/// Processor time of other threads for this thread, minus its own while it waited for them.
thread_local double cpu_of_others = 0;

double own_cpu() { return 1e-9 * static_cast<double>(nanoseconds_of_this_thread()); }

/// Whether the process has threads that finish_threads() must end.
std::atomic<bool> threads_started = false;

/// Calls run() for each worker on the threads of the run, or on its own arena outside of runs.
void run_workers(int workers, const std::function<void()>& run) {
  threads_started = true;
  const ThreadState state = this_thread();
  const auto all = [&] {
    tbb::parallel_for(
        0, workers,
        [&](int) {
          const WorkerScope works(state.run);
          this_thread().in_arena = true;
          run();
        },
        tbb::simple_partitioner());
  };
  // Isolated, so that a thread that waits for inner calls does not start an outer one.
  if (state.in_arena) {
    tbb::this_task_arena::isolate(all);
  } else if (state.run != nullptr) {
    state.run->arena().execute(all);
  } else {
    tbb::task_arena arena(workers);
    arena.execute(all);
  }
}

}  // namespace

TimeSpent time_spent() {
  return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
          own_cpu() + cpu_of_others};
}

void finish_threads() {
  if (!threads_started.exchange(false)) return;
  if (Run* run = current_run()) run->end_arenas();
  tbb::task_scheduler_handle handle{tbb::attach{}};
  tbb::finalize(handle);
}

int thread_count() {
  const Run* run = current_run();
  return run != nullptr ? run->settings.threads : core_count();
}

void parallel_for(std::size_t n, const std::function<void(std::size_t)>& work,
                  const std::function<double(std::size_t)>& cost) {
  const int workers = static_cast<int>(std::min(n, static_cast<std::size_t>(thread_count())));
  const std::vector<std::size_t> order = by_cost(n, cost);
  std::vector<std::exception_ptr> errors(n);
  std::atomic<std::size_t> next = 0;
  const auto run = [&] {
    for (std::size_t k = next++; k < n; k = next++) {
      try {
        check_cancelled();
        work(order[k]);
      } catch (...) {
        errors[order[k]] = std::current_exception();
        if (is_cancelled()) next = n;
      }
    }
  };
  if (workers <= 1) {
    run();
  } else {
    const double of_others = cpu_of_others, begin = own_cpu();
    std::mutex mutex;
    double spent = 0;
    run_workers(workers, [&] {
      const double before = own_cpu() + cpu_of_others;
      run();
      const std::scoped_lock lock(mutex);
      spent += own_cpu() + cpu_of_others - before;
    });
    cpu_of_others = of_others + spent - (own_cpu() - begin);
  }
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

void parallel_ranges(std::size_t n, const std::function<void(std::size_t begin, std::size_t end)>& work) {
  constexpr std::size_t kLength = 1024;
  parallel_for((n + kLength - 1) / kLength,
               [&](std::size_t i) { work(i * kLength, std::min(n, (i + 1) * kLength)); });
}

}  // namespace delquad
