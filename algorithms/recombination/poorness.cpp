#include "algorithms/recombination/poorness.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace delquad {

namespace {

/// Weight of an element of eta 0. The sums over the others stay below: they hold some hundreds of corners.
constexpr double kFlatWeight = 1e4;

}  // namespace

double sine_of_eta(double eta) { return std::sin(eta * std::numbers::pi / 2); }

double Poorness::around(std::span<const int> vertices) {
  static const double poor = sine_of_eta(kPoorEta);
  ++seen_;
  seen_element_.resize(mesh_.element_slots(), 0);
  double sum = 0;
  for (const int v : vertices) {
    if (!mesh_.vertex_alive(v)) continue;
    mesh_.for_each_out(v, [&](int h) {
      const int e = QuadTopology::element(h);
      if (seen_element_[e] == seen_) return;
      seen_element_[e] = seen_;
      double least = 1;
      for (const double sine : corner_sines(mesh_, e)) {
        const double lack = std::max(0.0, 1 - sine / poor);
        sum += lack * lack * lack;
        least = std::min(least, sine);
      }
      if (least <= kFlatSine) sum += kFlatWeight;
    });
  }
  return sum;
}

}  // namespace delquad
