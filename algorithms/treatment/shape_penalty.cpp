#include "algorithms/treatment/shape_penalty.h"

#include <algorithm>

#include "geometry/mesh/quad_corners.h"

namespace delquad {

namespace {

/// Weight of an element of eta 0. The sums over the others stay below: they hold some hundreds of corners.
constexpr double kFlatWeight = 1e4;

}  // namespace

double ShapePenalty::around(std::span<const int> vertices) {
  static const double poor = sine_of_eta(kPoorEta);
  double sum = 0;
  elements_met_.begin(mesh_.element_slots());
  for_each_element_around(mesh_, vertices, elements_met_, [&](int e) {
    ++looks_;
    double least = 1;
    for (const double sine : corner_sines(mesh_, e)) {
      const double lack = std::max(0.0, 1 - sine / poor);
      sum += lack * lack * lack;
      least = std::min(least, sine);
    }
    if (least <= kFlatSine) sum += kFlatWeight;
  });
  return sum;
}

}  // namespace delquad
