#include "experiments/console/activities.h"

namespace delquad {

namespace {

constexpr int kMostFaces = 2048;  // at a time: twice the most threads

/// Made before main(), so that signal handlers need not make it.
Activities all(kMostFaces);

}  // namespace

Activities& program_activities() { return all; }

}  // namespace delquad
