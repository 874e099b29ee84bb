// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <vector>

// This header watches the work of the CAD kernel. Geometry uses it.

namespace delquad::cad {

/// Stages of the kernel's work, as they are told (see activity.h).
inline constexpr const char *kHealing = "healing", *kTriangulation = "triangulation";

struct KernelLimits {
  double face_seconds = 0;     ///< processor time for the triangulation of a face
  double healing_seconds = 0;  ///< processor time for checking and healing all of the shape
};

/// Watches what the run of this thread is at, which there must be, from a thread of its own for as long as it
/// lives.
class KernelWatch {
 public:
  /// Calls late_faces(numbers) once some faces take longer than they may, late_healing() when healing does.
  KernelWatch(const KernelLimits& limits, std::function<void(const std::vector<int>&)> late_faces,
              std::function<void()> late_healing);
  ~KernelWatch();
  KernelWatch(const KernelWatch&) = delete;
  KernelWatch& operator=(const KernelWatch&) = delete;

  /// While it lives, the shape is checked and healed.
  class Healing {
   public:
    explicit Healing(KernelWatch& watch);
    ~Healing();
    Healing(const Healing&) = delete;
    Healing& operator=(const Healing&) = delete;

   private:
    KernelWatch& watch_;
  };

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace delquad::cad
