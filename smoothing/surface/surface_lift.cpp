// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/surface/surface_lift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/cancel.h"
#include "base/parallel.h"
#include "base/sort_unique.h"
#include "geometry/mesh/quad_corners.h"

namespace delquad {

namespace {

/// Start of the search, as a part of the longest edge, and its number of steps.
constexpr double kReach = 0.25;
constexpr int kSteps = 14;
/// A quad lacks (1 - quality / kGoodQuality)^kPower if its quality is below kGoodQuality. So one bad quad
/// outweighs several poor ones.
constexpr double kGoodQuality = 0.35, kPower = 8;
/// Quality of a quad with warp w: this times 1 - w / 90 degrees. Lifting begins at 79 degrees, and leaves
/// slightly bent quads alone.
constexpr double kWarpFactor = 2.5;
/// Least gain of a move, as a part, and least lack that can justify one.
constexpr double kLeastGain = 0.01, kLeastDeficit = 1e-4;
/// Subtracted from the quality of an inverted quad.
constexpr double kInvertedPenalty = 2;
/// Least length of edges at a node over the shortest initial one around it, on a curve and inside. Angles
/// alone would let nodes run into each other.
constexpr double kShortestOnCurve = 0.5, kShortestInside = 0.2;

/// Repair of failing quads: costs of a failing quad and of its excess (as a logarithm, 1 at most), beside the
/// lack of eta. Smaller gains are ignored.
constexpr double kFailing = 100, kBeyond = 20, kLeastRepair = 0.02;
/// Allowed loss of eta, summed over the quads around, for each removed failing quad.
constexpr double kRepairPrice = 1;
/// Steps of a search, steps without gain that end it, and rounds for the vertices of a quad.
constexpr int kRepairSteps = 8, kMostIdleSteps = 3, kRepairRounds = 3;

/// Cost of a trial on CAD in trials on triangles, since it asks for the nearest point of a face.
constexpr long long kCostOnCad = 10;

constexpr double kDiagonal = std::numbers::sqrt2 / 2;
constexpr Vec2 kCompass[8] = {{1, 0},  {kDiagonal, kDiagonal},   {0, 1},  {-kDiagonal, kDiagonal},
                              {-1, 0}, {-kDiagonal, -kDiagonal}, {0, -1}, {kDiagonal, -kDiagonal}};

/// Limit of neighbors (each counted twice) for trials halfway between two of them, as pairs grow with the
/// square.
constexpr std::size_t kMostPaired = 24;

/// Moves vertices of some quads one by one to the least lack of the quads around them.
class SurfaceMoves {
 public:
  virtual ~SurfaceMoves() = default;

  /// Ends after max_sweeps, each of which works on every bad quad once, or when the trials are spent.
  int run(int max_sweeps) {
    bool again = true;
    for (int sweep = 0; sweep < max_sweeps && again; ++sweep) {
      again = false;
      for (const int q : bad_quads()) {
        check_cancelled();
        if (is_bad(q)) again = work_on(q) || again;
      }
    }
    return static_cast<int>(std::ranges::count_if(moved_, [](int when) { return when > 0; }));
  }

 protected:
  /// A search makes up to `steps`, and ends after `idle_steps` steps without gain.
  SurfaceMoves(SurfaceTracks& tracks, std::vector<Vec3>& places, Budget& trials, int steps, int idle_steps)
      : tracks_(tracks),
        quads_(tracks.quads()),
        places_(places),
        start_(places),
        outward_(tracks.normals()),
        tried_(places.size(), 0),
        moved_(places.size(), 0),
        trials_(trials),
        cost_(tracks.is_on_cad() ? kCostOnCad : 1),
        steps_(steps),
        idle_steps_(idle_steps) {
    find_corners();
  }

  virtual bool is_bad(int q) const = 0;
  /// Returns whether a vertex moved.
  virtual bool work_on(int q) = 0;
  virtual double deficit_around(int v) const = 0;
  virtual bool is_gain(double deficit, double before) const = 0;
  /// Returns the least length of edges at a vertex.
  virtual double least_edge(int v) const = 0;

  /// Returns 1 - |angle - 90 degrees| / 90 degrees, the least over corners but `skipped` (-1: none): eta if
  /// positive. A lower quality by warp counts instead, 0 for a folded quad. `warp`, if given, gets the warp
  /// in radians instead.
  double quality(int q, int skipped = -1, double* warp = nullptr) const {
    const auto& v = quads_[q];
    const Vec3& outward = outward_[q];
    Vec3 normal = cross(places_[v[2]] - places_[v[0]], places_[v[3]] - places_[v[1]]);
    const bool turned_over = !(dot(normal, outward) > 0);
    if (turned_over) normal = outward;
    std::array<Vec3, 4> corner_normal;
    double least = 1;
    for (int k = 0; k < 4; ++k) {
      const Vec3& at = places_[v[k]];
      const Vec3 out = places_[v[(k + 1) % 4]] - at, in = places_[v[(k + 3) % 4]] - at, c = cross(out, in);
      corner_normal[k] = c;
      if (k == skipped) continue;
      double angle = std::atan2(norm(c), dot(out, in));
      if (dot(c, normal) < 0) angle = 2 * std::numbers::pi - angle;
      least = std::min(least, 1 - std::abs(angle - std::numbers::pi / 2) * (2 / std::numbers::pi));
    }
    double most_warp = 0;
    for (int k = 0; k < 2; ++k) {
      const Vec3 &m = corner_normal[k], &n = corner_normal[k + 2];
      most_warp = std::max(most_warp, std::atan2(norm(cross(m, n)), dot(m, n)));
    }
    if (warp != nullptr) *warp = most_warp;
    if (warp == nullptr) least = std::min(least, kWarpFactor * (1 - most_warp * (2 / std::numbers::pi)));
    return turned_over ? least - kInvertedPenalty : least;
  }

  template <class F>
  void for_each_neighbour(int v, F&& f) const {
    for (int i = first_[v]; i < first_[v + 1]; ++i) {
      const auto& quad = quads_[corners_[i] / 4];
      f(quad[(corners_[i] + 1) % 4]);
      f(quad[(corners_[i] + 3) % 4]);
    }
  }

  double shortest_edge(int v, const std::vector<Vec3>& places) const {
    double shortest = std::numeric_limits<double>::max();
    for_each_neighbour(v, [&](int w) { shortest = std::min(shortest, norm(places[w] - places[v])); });
    return shortest;
  }

  /// Returns the axes of the search, one step long: along the longest edge, and across it as far as the edges
  /// reach. On a curve there is only the curve's direction.
  std::array<Vec3, 2> axes(int v, const std::array<Vec3, 2>& free) const {
    Vec3 along;
    for_each_neighbour(v, [&](int w) {
      const Vec3 edge = places_[w] - places_[v];
      if (norm(edge) > norm(along)) along = edge;
    });
    if (tracks_.is_on_curve(v)) return {kReach * norm(along) / norm(free[0]) * free[0], Vec3{}};
    const Vec3 normal = cross(free[0], free[1]);
    const Vec3 across = (1 / (norm(normal) * norm(along))) * cross(normal, along);
    double width = 0;
    for_each_neighbour(
        v, [&](int w) { width = std::max(width, std::abs(dot(across, places_[w] - places_[v]))); });
    return {kReach * along, kReach * width * across};
  }

  /// Tries the places halfway between two neighbors, then a compass search: eight directions with a shrinking
  /// step.
  bool improve(int v) {
    const auto free = tracks_.axes(v);
    if (norm(free[0]) == 0 || is_unchanged(v)) return false;
    tried_[v] = ++now_;
    const SurfaceTracks::TrackPlace start{tracks_.position(v), places_[v]};
    const double before = deficit_around(v);
    if (!is_gain(0, before)) return false;  // no place would gain enough
    const double shortest = least_edge(v);
    SurfaceTracks::TrackPlace at = start;
    double best = before;
    const auto try_at = [&](const SurfaceTracks::TrackPlace& from, const Vec3& x) {
      if (best == 0) return;
      trials_.spend(cost_);
      const SurfaceTracks::TrackPlace trial = tracks_.track_place_near(v, from, x);
      places_[v] = trial.place;
      if (shortest_edge(v, places_) < shortest) return;
      const double lacking = deficit_around(v);
      if (lacking < best) best = lacking, at = trial;
    };
    std::vector<Vec3> neighbours;
    for_each_neighbour(v, [&](int w) { neighbours.push_back(places_[w]); });
    for (std::size_t i = 0; neighbours.size() <= kMostPaired && i < neighbours.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) try_at(start, 0.5 * (neighbours[i] + neighbours[j]));
    places_[v] = at.place;
    auto [along, across] = axes(v, free);
    for (int step = 0, idle_steps = 0; step < steps_ && best > 0; ++step) {
      if (idle_steps == idle_steps_ && best == before) break;
      const SurfaceTracks::TrackPlace centre = at;
      const double last = best;
      for (const Vec2 d : kCompass) try_at(centre, centre.place + d.x * along + d.y * across);
      if (best == last) ++idle_steps, along = 0.5 * along, across = 0.5 * across;
    }
    const bool gained = is_gain(best, before);
    places_[v] = gained ? at.place : start.place;
    if (gained) tracks_.put(v, at), moved_[v] = ++now_;
    return gained;
  }

  SurfaceTracks& tracks_;
  const std::vector<std::array<int, 4>>& quads_;
  std::vector<Vec3>& places_;
  const std::vector<Vec3> start_;
  std::vector<int> first_, corners_;  ///< corners of each vertex: 4 quad + k
  const std::vector<Vec3> outward_;   ///< normals at the initial quads
  std::vector<int> tried_, moved_;    ///< time of the last trial and move of each vertex; 0: never
  int now_ = 0;
  Budget& trials_;
  const long long cost_;  ///< of a trial

 private:
  void find_corners() {
    first_.assign(places_.size() + 1, 0);
    for (const auto& quad : quads_)
      for (const int v : quad) ++first_[v + 1];
    for (std::size_t v = 0; v < places_.size(); ++v) first_[v + 1] += first_[v];
    corners_.resize(first_.back());
    std::vector<int> fill(first_.begin(), first_.end() - 1);
    for (std::size_t q = 0; q < quads_.size(); ++q)
      for (int k = 0; k < 4; ++k) corners_[fill[quads_[q][k]]++] = 4 * static_cast<int>(q) + k;
  }

  std::vector<int> bad_quads() const {
    std::vector<char> is_bad_one(quads_.size(), 0);
    parallel_ranges(quads_.size(), [&](std::size_t begin, std::size_t end) {
      for (int q = static_cast<int>(begin); q < static_cast<int>(end); ++q) is_bad_one[q] = is_bad(q);
    });
    std::vector<int> bad;
    for (std::size_t q = 0; q < is_bad_one.size(); ++q)
      if (is_bad_one[q]) bad.push_back(static_cast<int>(q));
    return bad;
  }

  /// Returns whether v was tried and nothing around it has moved since.
  bool is_unchanged(int v) const {
    for (int i = first_[v]; i < first_[v + 1]; ++i)
      for (const int w : quads_[corners_[i] / 4])
        if (w != v && moved_[w] > tried_[v]) return false;
    return tried_[v] > 0;
  }

  const int steps_, idle_steps_;
};

/// Lifts quads below an eta.
class PoorLift final : public SurfaceMoves {
 public:
  PoorLift(SurfaceTracks& tracks, std::vector<Vec3>& places, double eta, Budget& trials,
           const LiftedBall& ball)
      : SurfaceMoves(tracks, places, trials, kSteps, kSteps),
        ball_(ball),
        eta_(eta),
        steepest2_(std::pow(std::tan((1 - eta) * std::numbers::pi / 2), 2)),
        warp2_(std::pow(std::tan((1 - eta / kWarpFactor) * std::numbers::pi / 2), 2)) {}

 private:
  bool is_bad(int q) const override { return is_in_ball(q) && !is_clearly_good(q) && quality(q) < eta_; }

  bool work_on(int q) override {
    bool again = false;
    for (const int v : quads_[q]) again = (!trials_.is_spent() && improve(v)) || again;
    return again;
  }

  /// Sums up the lack of quads by corners that the place of v changes: all but the opposite one.
  double deficit_around(int v) const override {
    double sum = 0;
    for (int i = first_[v]; i < first_[v + 1]; ++i)
      sum += deficit(quality(corners_[i] / 4, (corners_[i] + 2) % 4));
    return sum;
  }
  static double deficit(double quality) {
    return std::pow(std::max(kGoodQuality - quality, 0.0) / kGoodQuality, kPower);
  }

  bool is_gain(double deficit, double before) const override {
    return deficit < before - std::max(kLeastGain * before, kLeastDeficit);
  }

  double least_edge(int v) const override {
    return (tracks_.is_on_curve(v) ? kShortestOnCurve : kShortestInside) * shortest_edge(v, start_);
  }

  bool is_in_ball(int q) const {
    return std::isinf(ball_.radius) || std::ranges::any_of(quads_[q], [&](int v) {
             return norm(start_[v] - ball_.centre) < ball_.radius;
           });
  }

  /// Returns whether quality() is certainly above the wanted eta. It is cheap, since most quads are.
  bool is_clearly_good(int q) const {
    constexpr double kMargin = 1 - 1e-9;
    const auto& v = quads_[q];
    const Vec3 normal = cross(places_[v[2]] - places_[v[0]], places_[v[3]] - places_[v[1]]);
    if (!(dot(normal, outward_[q]) > 0)) return false;
    std::array<Vec3, 4> corner_normal;
    for (int k = 0; k < 4; ++k) {
      const Vec3& at = places_[v[k]];
      const Vec3 out = places_[v[(k + 1) % 4]] - at, in = places_[v[(k + 3) % 4]] - at, c = cross(out, in);
      const double cosine = dot(out, in);  // both times the lengths of the sides
      if (!(dot(c, normal) > 0 && cosine * cosine < kMargin * steepest2_ * dot(c, c))) return false;
      corner_normal[k] = c;
    }
    for (int k = 0; k < 2; ++k) {
      const Vec3 &m = corner_normal[k], &n = corner_normal[k + 2];
      const Vec3 turn = cross(m, n);
      const double along = dot(m, n);
      if (!(along > 0 && dot(turn, turn) < kMargin * warp2_ * along * along)) return false;
    }
    return true;
  }

  const LiftedBall& ball_;
  double eta_;        ///< sufficient eta
  double steepest2_;  ///< square of the cotangent of the sharpest sufficient angle
  double warp2_;      ///< square of the tangent of the largest sufficient warp
};

/// Repairs quads that fail by limits.
class FailingRepair final : public SurfaceMoves {
 public:
  FailingRepair(SurfaceTracks& tracks, std::vector<Vec3>& places, const SpaceLimits& limits, Budget& trials)
      : SurfaceMoves(tracks, places, trials, kRepairSteps, kMostIdleSteps), limits_(limits) {
    find_limits();
  }

 private:
  bool is_bad(int q) const override { return beyond(q) > 0; }

  /// Moves the vertices of a quad. If fewer quads fail then at a small loss of eta, near vertices move to the
  /// best eta; otherwise all go back.
  bool work_on(int q) override {
    std::vector<int> around;
    for (const int v : quads_[q])
      for (int i = first_[v]; i < first_[v + 1]; ++i) around.push_back(corners_[i] / 4);
    sort_unique(around);
    const auto n_failing = [&] { return std::ranges::count_if(around, [&](int o) { return is_bad(o); }); };
    std::array<SurfaceTracks::TrackPlace, 4> spots;
    std::array<int, 4> moved;
    for (int k = 0; k < 4; ++k) {
      const int v = quads_[q][k];
      spots[k] = {tracks_.position(v), places_[v]}, moved[k] = moved_[v];
    }
    const auto deficit = [&] {
      return std::accumulate(around.begin(), around.end(), 0.0,
                             [&](double sum, int o) { return sum + 1 - std::min(quality(o), 1.0); });
    };
    const auto before = n_failing();
    const double lacked = deficit();
    bool again = true;
    for (int round = 0; round < kRepairRounds && again; ++round) {
      again = false;
      for (const int v : quads_[q]) again = (!trials_.is_spent() && improve(v)) || again;
      for (int k = 0; k < 4 && is_bad(q); ++k)
        again = (!trials_.is_spent() && shift({quads_[q][k], quads_[q][(k + 1) % 4]})) || again;
    }
    const auto fewer = before - n_failing();
    if (fewer > 0 && deficit() - lacked < kRepairPrice * static_cast<double>(fewer)) {
      std::vector<int> near;
      for (const int o : around) near.insert(near.end(), quads_[o].begin(), quads_[o].end());
      sort_unique(near);
      for (int round = 0; round < kRepairRounds; ++round)
        for (const int v : near)
          if (!trials_.is_spent()) improve(v);
      return true;
    }
    for (int k = 0; k < 4; ++k) {
      const int v = quads_[q][k];
      if (moved_[v] != moved[k]) tracks_.put(v, spots[k]), places_[v] = spots[k].place, moved_[v] = moved[k];
    }
    return false;
  }

  void find_limits() {
    delta_.resize(places_.size());
    least_.resize(quads_.size());
    parallel_ranges(places_.size(), [&](std::size_t begin, std::size_t end) {
      int hint = -1;
      for (std::size_t v = begin; v < end; ++v) delta_[v] = limits_.size.at(places_[v], hint);
    });
    parallel_ranges(quads_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t q = begin; q < end; ++q) least_[q] = quality(static_cast<int>(q));
    });
    double worst = 1, warp = 0;
    for (std::size_t q = 0; q < quads_.size(); ++q)
      if (least_[q] < worst) worst = std::min(worst, quality(static_cast<int>(q), -1, &warp));
    for (double& least : least_) least = std::min(least, std::max(worst, limits_.kept.eta));
  }

  double beyond(int q) const {
    const auto& [a, b, c, d] = quads_[q];
    return limits_.excess({places_[a], places_[b], places_[c], places_[d]},
                          (delta_[a] + delta_[b] + delta_[c] + delta_[d]) / 4);
  }

  double deficit_around(int v) const override {
    double sum = 0;
    for (int i = first_[v]; i < first_[v + 1]; ++i) {
      const int q = corners_[i] / 4;
      const double eta = quality(q), by = beyond(q);
      if (eta < least_[q]) return std::numeric_limits<double>::infinity();
      sum += 1 - std::min(eta, 1.0);
      if (by > 0) sum += kFailing + kBeyond * std::min(by, 1.0);
    }
    return sum;
  }

  bool is_gain(double deficit, double before) const override { return deficit < before - kLeastRepair; }

  /// Returns the least of the required and the initial length.
  double least_edge(int v) const override {
    return std::min(shortest_edge(v, start_), limits_.kept.shortest * delta_[v]);
  }

  /// Improves both ends of an edge by the same move, since a single end would warp quads more.
  bool shift(std::array<int, 2> ends) {
    std::array<SurfaceTracks::TrackPlace, 2> start, at;
    for (const int k : {0, 1}) {
      if (norm(tracks_.axes(ends[k])[0]) == 0) return false;
      start[k] = at[k] = {tracks_.position(ends[k]), places_[ends[k]]};
    }
    const std::array shortest{least_edge(ends[0]), least_edge(ends[1])};
    const auto deficit = [&] {
      for (const int k : {0, 1})
        if (shortest_edge(ends[k], places_) < shortest[k]) return std::numeric_limits<double>::infinity();
      return deficit_around(ends[0]) + deficit_around(ends[1]);
    };
    const double before = deficit_around(ends[0]) + deficit_around(ends[1]);
    double best = before;
    const int leader = ends[tracks_.is_on_curve(ends[0]) ? 1 : 0];
    auto [along, across] = axes(leader, tracks_.axes(leader));
    for (int step = 0, idle_steps = 0; step < kRepairSteps && idle_steps < kMostIdleSteps; ++step) {
      const std::array centre = at;
      const double last = best;
      for (const Vec2 d : kCompass) {
        trials_.spend(2 * cost_);
        std::array<SurfaceTracks::TrackPlace, 2> trial;
        for (const int k : {0, 1}) {
          trial[k] =
              tracks_.track_place_near(ends[k], centre[k], centre[k].place + d.x * along + d.y * across);
          places_[ends[k]] = trial[k].place;
        }
        if (const double lacking = deficit(); lacking < best) best = lacking, at = trial;
      }
      if (best == last) ++idle_steps, along = 0.5 * along, across = 0.5 * across;
    }
    const bool gained = is_gain(best, before);
    for (const int k : {0, 1}) {
      places_[ends[k]] = gained ? at[k].place : start[k].place;
      if (gained) tracks_.put(ends[k], at[k]), moved_[ends[k]] = ++now_;
    }
    return gained;
  }

  const SpaceLimits& limits_;
  std::vector<double> delta_;  ///< by vertex, at its initial place
  std::vector<double> least_;  ///< quality that each quad must keep
};

}  // namespace

int lift_worst_on_surface(SurfaceTracks& tracks, std::vector<Vec3>& places, double eta, int max_sweeps,
                          Budget& trials, const LiftedBall& ball) {
  return PoorLift(tracks, places, eta, trials, ball).run(max_sweeps);
}

int repair_failing_on_surface(SurfaceTracks& tracks, std::vector<Vec3>& places, const SpaceLimits& limits,
                              int max_sweeps, Budget& trials) {
  return FailingRepair(tracks, places, limits, trials).run(max_sweeps);
}

}  // namespace delquad
