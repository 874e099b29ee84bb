#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "smoothing/cvt/blocks.h"
#include "smoothing/cvt/cell_minimiser.h"
#include "smoothing/cvt/cell_walk.h"
#include "smoothing/cvt/simplex_energy.h"

namespace delquad {
namespace {

/// The outline of an inner seed's cell, its edges in no order, in the seed's frame.
using Outline = std::vector<std::array<Vec2, 2>>;

/// Where the integral of |x - c|^p over the outline is least: by Newton's method, as the integral is convex.
double least_place(const Outline& outline, int p, bool across) {
  constexpr int kSteps = 40;
  constexpr double kTolerance = 1e-12;  // of the first step
  const auto along_x = [across](Vec2 v) { return across ? Vec2{v.y, -v.x} : v; };
  double c = 0, first_step = 0;
  for (int step = 0; step < kSteps; ++step) {
    double slope = 0, curvature = 0;
    for (const auto& [a, b] : outline) {
      const Vec2 first = along_x(a) - Vec2{c, 0}, second = along_x(b) - Vec2{c, 0};
      slope += simplex_moment(p - 1, first, second);
      curvature += (p - 1) * simplex_moment(p - 2, first, second);
    }
    const double way = slope / curvature;
    c += way;
    if (step == 0) first_step = std::abs(way);
    if (!(std::abs(way) > kTolerance * first_step)) break;
  }
  return c;
}

class LloydMinimiser final : public CellMinimiser {
 public:
  MinimiserOutcome minimise(CvtProblem& problem, const MinimiserOptions& options,
                            std::vector<EnergySample>& samples) const override {
    MinimiserOutcome outcome{MinimiserTermination::kIterations, 0, 0};
    std::vector<Vec2> seeds = problem.seeds();
    double energy = *problem.evaluate(seeds);
    samples.push_back({0, energy, true});
    while (outcome.iterations < options.iterations) {
      std::vector<Vec2> next = least_places(problem);
      const std::optional<double> moved = problem.evaluate(next);
      samples.push_back({0, moved.value_or(std::numeric_limits<double>::quiet_NaN()), moved.has_value()});
      if (!moved) {
        outcome.termination = MinimiserTermination::kStuck;
        problem.evaluate(seeds);
        break;
      }
      ++outcome.iterations;
      seeds = std::move(next);
      const double change = std::abs(energy - *moved);
      energy = *moved;
      outcome.gradient_norm = scaled_gradient_norm(problem);
      if (change <= options.function_tolerance * energy ||
          outcome.gradient_norm <= options.gradient_tolerance) {
        outcome.termination = MinimiserTermination::kConverged;
        break;
      }
    }
    outcome.gradient_norm = scaled_gradient_norm(problem);
    return outcome;
  }

 private:
  static std::vector<Vec2> least_places(const CvtProblem& problem) {
    const MovingDelaunay& delaunay = problem.delaunay();
    const int n_boundary = delaunay.n_boundary();
    auto pieces = problem.cells().pieces();
    std::ranges::stable_sort(pieces, {}, &BoundedVoronoi::Piece::seed);
    std::vector<Vec2> places = problem.seeds();
    parallel_blocks(places.size(), [&](std::size_t begin, std::size_t end) {
      Outline outline;
      for (std::size_t i = begin; i < end; ++i) {
        const int seed = n_boundary + static_cast<int>(i);
        const Vec2 axis = problem.frames().axis[seed], x = places[i];
        const auto in_frame = [&](Vec2 y) { return Vec2{dot(axis, y - x), cross(axis, y - x)}; };
        outline.clear();
        walk_cell(delaunay, problem.cells(), seed, [&](const CellEnd& a, const CellEnd& b) {
          outline.push_back({in_frame(a.at), in_frame(b.at)});
        });
        for (const auto& piece : std::ranges::equal_range(pieces, seed, {}, &BoundedVoronoi::Piece::seed))
          outline.push_back({in_frame(problem.cells().clips()[piece.from].at),
                             in_frame(problem.cells().clips()[piece.to].at)});
        const double along = least_place(outline, problem.p(), false);
        const double across = least_place(outline, problem.p(), true);
        places[i] = x + along * axis + across * perp(axis);
      }
    });
    return places;
  }
};

}  // namespace

std::unique_ptr<CellMinimiser> make_lloyd_minimiser() { return std::make_unique<LloydMinimiser>(); }

double scaled_gradient_norm(const CvtProblem& problem) {
  double largest = 0;
  const auto g = problem.gradient();
  for (std::size_t i = 0; i < g.size(); ++i) largest = std::max(largest, problem.lengths()[i] * norm(g[i]));
  return largest * problem.newton_scale();
}

}  // namespace delquad
