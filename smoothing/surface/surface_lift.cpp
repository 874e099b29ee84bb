#include "smoothing/surface/surface_lift.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/cancel.h"
#include "base/parallel.h"

namespace delquad {

namespace {

/// The search begins with this part of the longest edge, and ends after so many steps.
constexpr double kReach = 0.25;
constexpr int kSteps = 14;
/// What quads lack is (1 - quality / this)^power, of those that are worse: one bad one outweighs several poor
/// ones.
constexpr double kGood = 0.35, kPower = 8;
/// What a quad that is warped by w counts as: this times 1 - w / 90 degrees, so that lifting begins at 79
/// degrees, and leaves alone what is merely bent.
constexpr double kWarpFactor = 2.5;
/// A move that gains a smaller part is not made, nor where less is lacking.
constexpr double kLeastGain = 0.01, kLeastLack = 1e-4;
/// What a quad that is turned over has less.
constexpr double kTurnedOver = 2;
/// No edge at a node becomes shorter than this part of the shortest around it, on a curve and inside: angles
/// alone would let nodes run into each other.
constexpr double kShortestOnCurve = 0.5, kShortestInside = 0.2;

/// A trial on CAD costs so many on triangles, as it asks for the nearest point of a face.
constexpr long long kCostOnCad = 10;

/// Places halfway between two neighbours are tried for so many (each is there twice), as their pairs grow
/// with the square.
constexpr std::size_t kMostPaired = 24;

class SurfaceLift {
 public:
  SurfaceLift(SurfaceTracks& tracks, std::vector<Vec3>& places, double eta, Budget& trials,
              const LiftedBall& ball)
      : tracks_(tracks),
        quads_(tracks.quads()),
        places_(places),
        start_(places),
        trials_(trials),
        cost_(tracks.is_on_cad() ? kCostOnCad : 1),
        ball_(ball),
        eta_(eta),
        steepest2_(std::pow(std::tan((1 - eta) * std::numbers::pi / 2), 2)),
        warp2_(std::pow(std::tan((1 - eta / kWarpFactor) * std::numbers::pi / 2), 2)),
        tried_(places.size(), 0),
        moved_(places.size(), 0) {
    first_.assign(places.size() + 1, 0);
    for (const auto& quad : quads_)
      for (const int v : quad) ++first_[v + 1];
    for (std::size_t v = 0; v < places.size(); ++v) first_[v + 1] += first_[v];
    corners_.resize(first_.back());
    std::vector<int> fill(first_.begin(), first_.end() - 1);
    for (std::size_t q = 0; q < quads_.size(); ++q)
      for (int k = 0; k < 4; ++k) corners_[fill[quads_[q][k]]++] = 4 * static_cast<int>(q) + k;
  }

  /// Ends after max_sweeps; each tries every vertex of a bad quad once. Or once the trials are spent.
  int run(int max_sweeps) {
    outward_ = tracks_.normals();
    bool again = true;
    for (int sweep = 0; sweep < max_sweeps && again; ++sweep) {
      again = false;
      for (const int q : quads_below()) {
        check_cancelled();
        if (quality(q) >= eta_) continue;
        for (const int v : quads_[q]) again = (!trials_.is_spent() && improve(v)) || again;
      }
    }
    return static_cast<int>(std::ranges::count_if(moved_, [](int when) { return when > 0; }));
  }

 private:
  std::vector<int> quads_below() const {
    std::vector<char> is_below(quads_.size(), 0);
    parallel_ranges(quads_.size(), [&](std::size_t begin, std::size_t end) {
      for (int q = static_cast<int>(begin); q < static_cast<int>(end); ++q)
        is_below[q] = is_in_ball(q) && !is_clearly_good(q) && quality(q) < eta_;
    });
    std::vector<int> below;
    for (std::size_t q = 0; q < is_below.size(); ++q)
      if (is_below[q]) below.push_back(static_cast<int>(q));
    return below;
  }

  bool is_in_ball(int q) const {
    return std::isinf(ball_.radius) || std::ranges::any_of(quads_[q], [&](int v) {
             return norm(start_[v] - ball_.centre) < ball_.radius;
           });
  }

  /// 1 - |angle - 90 degrees| / 90 degrees, the least over the corners: eta where that is positive. Without
  /// the corner `skipped` (none: -1). Or what its warp counts as where that is less: 0 for a folded quad.
  double quality(int q, int skipped = -1) const {
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
    for (int k = 0; k < 2; ++k) {
      const Vec3 &m = corner_normal[k], &n = corner_normal[k + 2];
      const double warp = std::atan2(norm(cross(m, n)), dot(m, n));
      least = std::min(least, kWarpFactor * (1 - warp * (2 / std::numbers::pi)));
    }
    return turned_over ? least - kTurnedOver : least;
  }

  /// Whether quality() is above the wanted eta without doubt: as cheap as can be, for most quads are.
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

  /// What the quads around v lack, counting in each the corners that the place of v changes: all but the one
  /// opposite.
  double lack_around(int v) const {
    double sum = 0;
    for (int i = first_[v]; i < first_[v + 1]; ++i)
      sum += lack(quality(corners_[i] / 4, (corners_[i] + 2) % 4));
    return sum;
  }
  static double lack(double quality) { return std::pow(std::max(kGood - quality, 0.0) / kGood, kPower); }

  static bool is_gain(double lack, double before) {
    return lack < before - std::max(kLeastGain * before, kLeastLack);
  }

  /// Whether v has been tried and nothing around it has moved since.
  bool is_unchanged(int v) const {
    for (int i = first_[v]; i < first_[v + 1]; ++i)
      for (const int w : quads_[corners_[i] / 4])
        if (w != v && moved_[w] > tried_[v]) return false;
    return tried_[v] > 0;
  }

  /// Axes of the search, a step long: along the longest edge, and across it as far as the edges reach; on a
  /// curve along this only.
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

  /// The best of the places halfway between two neighbours, then a compass search: eight directions, a step
  /// that shrinks.
  bool improve(int v) {
    const auto free = tracks_.axes(v);
    if (norm(free[0]) == 0 || is_unchanged(v)) return false;
    tried_[v] = ++now_;
    const SurfaceTracks::Spot start{tracks_.position(v), places_[v]};
    const double before = lack_around(v);
    if (!is_gain(0, before)) return false;  // whatever would be found
    const double shortest =
        (tracks_.is_on_curve(v) ? kShortestOnCurve : kShortestInside) * shortest_edge(v, start_);
    SurfaceTracks::Spot at = start;
    double best = before;
    const auto try_at = [&](const SurfaceTracks::Spot& from, const Vec3& x) {
      if (best == 0) return;
      trials_.spend(cost_);
      const SurfaceTracks::Spot trial = tracks_.spot_near(v, from, x);
      places_[v] = trial.place;
      if (shortest_edge(v, places_) < shortest) return;
      const double lacking = lack_around(v);
      if (lacking < best) best = lacking, at = trial;
    };
    std::vector<Vec3> neighbours;
    for_each_neighbour(v, [&](int w) { neighbours.push_back(places_[w]); });
    for (std::size_t i = 0; neighbours.size() <= kMostPaired && i < neighbours.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) try_at(start, 0.5 * (neighbours[i] + neighbours[j]));
    places_[v] = at.place;
    auto [along, across] = axes(v, free);
    constexpr double kDiagonal = std::numbers::sqrt2 / 2;
    constexpr Vec2 kCompass[8] = {{1, 0},  {kDiagonal, kDiagonal},   {0, 1},  {-kDiagonal, kDiagonal},
                                  {-1, 0}, {-kDiagonal, -kDiagonal}, {0, -1}, {kDiagonal, -kDiagonal}};
    for (int step = 0; step < kSteps && best > 0; ++step) {
      const SurfaceTracks::Spot centre = at;
      const double last = best;
      for (const Vec2 d : kCompass) try_at(centre, centre.place + d.x * along + d.y * across);
      if (best == last) along = 0.5 * along, across = 0.5 * across;
    }
    const bool gained = is_gain(best, before);
    places_[v] = gained ? at.place : start.place;
    if (gained) tracks_.put(v, at), moved_[v] = ++now_;
    return gained;
  }

  SurfaceTracks& tracks_;
  const std::vector<std::array<int, 4>>& quads_;
  std::vector<Vec3>& places_;
  std::vector<Vec3> start_;
  Budget& trials_;
  long long cost_;  ///< of a trial
  const LiftedBall& ball_;
  double eta_;                        ///< that will do
  double steepest2_;                  ///< square of the cotangent of the sharpest angle that will do
  double warp2_;                      ///< square of the tangent of the largest warp that will do
  std::vector<int> first_, corners_;  ///< of each vertex, its corners: 4 quad + k
  std::vector<Vec3> outward_;         ///< normals at the quads where these were at first
  std::vector<int> tried_, moved_;    ///< of each vertex, when last; 0: never
  int now_ = 0;
};

}  // namespace

int lift_worst_on_surface(SurfaceTracks& tracks, std::vector<Vec3>& places, double eta, int max_sweeps,
                          Budget& trials, const LiftedBall& ball) {
  return SurfaceLift(tracks, places, eta, trials, ball).run(max_sweeps);
}

}  // namespace delquad
