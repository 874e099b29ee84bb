// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/context.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>
#include <utility>

#include "base/run.h"
#include "base/system.h"
#include "delquad/error.h"

namespace delquad {

namespace {

RunSettings checked(RunSettings settings) {
  if (settings.threads < 0) throw std::invalid_argument("at least one thread is needed");
  if (!(settings.seconds >= 0) || !std::isfinite(settings.seconds))
    throw std::invalid_argument("a time limit must be a finite number of seconds, 0 for none");
  return settings;
}

int threads_of(const RunSettings& settings, const Run* around) {
  if (settings.threads > 0) return settings.threads;
  return around != nullptr ? around->settings.threads : core_count();
}

/// Returns the number of entries for faces, with some for nested scopes and their workers.
int most_faces(int threads) {
  constexpr int kFacesPerThread = 4;
  return kFacesPerThread * (threads + 1);
}

/// Returns the passed time limit, of the run or of an outer one.
double limit_passed(const Run* run) {
  while (run->around != nullptr && !(coarse_seconds() >= run->end)) run = run->around;
  return run->settings.seconds;
}

}  // namespace

int core_count() {
  static const int count = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return count;
}

ThreadState& this_thread() noexcept {
  static constinit thread_local ThreadState state;
  return state;
}

Run::Run(RunSettings settings_, Run* around_)
    : settings(checked(std::move(settings_))),
      around(around_),
      end(settings.seconds > 0 ? coarse_seconds() + settings.seconds
                               : std::numeric_limits<double>::infinity()),
      activities(settings.activities) {
  settings.threads = threads_of(settings, around);
  if (activities == nullptr && around != nullptr) activities = around->activities;
  if (activities == nullptr) activities = &own_activities.emplace(most_faces(settings.threads));
}

Run::State Run::state() const noexcept {
  for (const Run* run = this; run != nullptr; run = run->around) {
    if (run->settings.cancel.stop_requested()) return State::kCancelled;
    if (run->end < std::numeric_limits<double>::infinity() && coarse_seconds() >= run->end)
      return State::kTimeIsUp;
  }
  return State::kGoing;
}

tbb::task_arena& Run::arena() {
  // Without this, oneTBB starts at most as many threads as cores. The least limit counts, also of an
  // embedding program.
  if (settings.threads > core_count() && !more_than_cores_)
    more_than_cores_.emplace(tbb::global_control::max_allowed_parallelism,
                             static_cast<std::size_t>(settings.threads));
  if (!arena_) arena_.emplace(settings.threads);
  return *arena_;
}

void Run::end_arenas() {
  for (Run* run = this; run != nullptr; run = run->around) run->arena_.reset();
}

RunScope::RunScope(RunSettings settings) : run_(std::make_unique<Run>(std::move(settings), current_run())) {
  ThreadState& thread = this_thread();
  if (run_->own_activities || run_->settings.activities != nullptr)
    entry_before_ = std::exchange(thread.entry, -1);
  thread.run = run_.get();
  in_arena_before_ = std::exchange(thread.in_arena, false);
}

RunScope::~RunScope() {
  ThreadState& thread = this_thread();
  thread.run = run_->around;
  thread.in_arena = in_arena_before_;
  if (run_->own_activities || run_->settings.activities != nullptr) thread.entry = entry_before_;
}

Run* current_run() noexcept { return this_thread().run; }

Activities* current_activities() noexcept {
  const Run* run = current_run();
  return run != nullptr ? run->activities : nullptr;
}

WorkerScope::WorkerScope(Run* run) noexcept
    : run_before_(this_thread().run),
      entry_before_(this_thread().entry),
      in_arena_before_(this_thread().in_arena) {
  this_thread() = {run, run == run_before_ ? entry_before_ : -1, false};
}

WorkerScope::~WorkerScope() { this_thread() = {run_before_, entry_before_, in_arena_before_}; }

bool is_cancelled() noexcept {
  const Run* run = current_run();
  return run != nullptr && run->state() != Run::State::kGoing;
}

void check_cancelled() {
  const Run* run = current_run();
  if (run == nullptr) return;
  if (run->settings.on_check) run->settings.on_check();
  const Run::State state = run->state();
  if (state == Run::State::kGoing) return;
  const std::string at = run->activities->text();
  if (state == Run::State::kCancelled) throw Cancelled("cancelled: " + at);
  throw TimeIsUp(fmt::format("stopped after {:g} s: {} [time-limit]", limit_passed(run), at));
}

}  // namespace delquad
