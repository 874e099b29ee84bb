// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cad/watch_kernel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <ctime>
#include <mutex>
#include <thread>
#include <utility>

#include "base/activity.h"
#include "base/context.h"

namespace delquad::cad {

namespace {

constexpr auto kPause = std::chrono::milliseconds(10);
constexpr double kInactive = -1;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::vector<int> faces_above(double seconds, const Activities& activities) {
  std::vector<int> late;
  for (const ActiveFace& face : activities.faces())
    if (face.stage == kTriangulation && face.cpu_seconds > seconds) late.push_back(face.tag);
  std::ranges::sort(late);
  return late;
}

}  // namespace

struct KernelWatch::State {
  std::mutex mutex;
  std::condition_variable over;
  bool is_over = false;
  std::atomic<double> healing_since = kInactive;  ///< of processor_seconds()
  std::thread thread;
};

KernelWatch::KernelWatch(const KernelLimits& limits, std::function<void(const std::vector<int>&)> late_faces,
                         std::function<void()> late_healing)
    : state_(std::make_unique<State>()) {
  state_->thread = std::thread([state = state_.get(), activities = current_activities(), limits,
                                faces = std::move(late_faces), healing = std::move(late_healing)] {
    std::unique_lock lock(state->mutex);
    while (!state->over.wait_for(lock, kPause, [&] { return state->is_over; })) {
      if (const auto late = faces_above(limits.face_seconds, *activities); !late.empty()) faces(late);
      const double since = state->healing_since;
      if (since >= 0 && processor_seconds() - since > limits.healing_seconds) healing();
    }
  });
}

KernelWatch::~KernelWatch() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->is_over = true;
  }
  state_->over.notify_one();
  state_->thread.join();
}

KernelWatch::Healing::Healing(KernelWatch& watch) : watch_(watch) {
  watch_.state_->healing_since = processor_seconds();
}
KernelWatch::Healing::~Healing() { watch_.state_->healing_since = kInactive; }

}  // namespace delquad::cad
