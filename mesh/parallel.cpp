#include "mesh/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

namespace delquad {

namespace {

std::atomic<int>& threads() {
  static std::atomic<int> count = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return count;
}

std::vector<std::size_t> by_cost(std::size_t n, const std::function<double(std::size_t)>& cost) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!cost) return order;
  std::vector<double> costs;
  for (std::size_t i = 0; i < n; ++i) costs.push_back(cost(i));
  std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t i) { return costs[i]; });
  return order;
}

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

thread_local double surplus = 0;
std::atomic<bool> threads_started = false;

}  // namespace

double parallel_surplus() { return surplus; }

void set_thread_count(int count) {
  if (count < 1) throw std::invalid_argument("at least one thread is needed");
  // Without it oneTBB never starts more than there are cores.
  static std::optional<tbb::global_control> limit;
  limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  threads() = count;
}

void finish_threads() {
  if (!threads_started.exchange(false)) return;
  tbb::task_scheduler_handle handle{tbb::attach{}};
  tbb::finalize(handle);
}

int thread_count() { return threads(); }

void parallel_for(std::size_t n, const std::function<void(std::size_t)>& work,
                  const std::function<double(std::size_t)>& cost) {
  const int workers = static_cast<int>(std::min(n, static_cast<std::size_t>(thread_count())));
  const std::vector<std::size_t> order = by_cost(n, cost);
  std::vector<std::exception_ptr> errors(n);
  std::atomic<std::size_t> next = 0;
  const Clock::time_point begin = Clock::now();
  const double surplus_before = surplus;
  std::vector<double> worked(static_cast<std::size_t>(std::max(workers, 1)), 0);
  const auto run = [&](int worker) {
    const Clock::time_point start = Clock::now();
    const double before = surplus;
    for (std::size_t k = next++; k < n; k = next++) {
      try {
        work(order[k]);
      } catch (...) {
        errors[order[k]] = std::current_exception();
      }
    }
    worked[static_cast<std::size_t>(worker)] = seconds_since(start) + (surplus - before);
  };
  if (workers <= 1) {
    run(0);
  } else {
    threads_started = true;
    tbb::task_arena arena(workers);
    arena.execute([&] { tbb::parallel_for(0, workers, run, tbb::simple_partitioner()); });
  }
  surplus = surplus_before + std::accumulate(worked.begin(), worked.end(), 0.0) - seconds_since(begin);
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

void parallel_ranges(std::size_t n, const std::function<void(std::size_t begin, std::size_t end)>& work) {
  constexpr std::size_t kLength = 1024;
  parallel_for((n + kLength - 1) / kLength,
               [&](std::size_t i) { work(i * kLength, std::min(n, (i + 1) * kLength)); });
}

}  // namespace delquad
