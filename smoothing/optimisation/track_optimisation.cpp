// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/optimisation/track_optimisation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>

#include "base/cancel.h"
#include "base/option_table.h"
#include "base/parallel.h"
#include "base/sort_unique.h"
#include "geometry/mesh/element_blocks.h"
#include "geometry/mesh/quad_corners.h"
#include "smoothing/optimisation/quad_energy.h"
#include "smoothing/relocation/element_quality.h"

namespace delquad {

namespace {

/// Tracks of the vertices of one block; other vertices stay.
template <class Vec>
class BlockTracks final : public VertexTracks<Vec> {
 public:
  BlockTracks(VertexTracks<Vec>& whole, const std::vector<std::array<int, 4>>& quads,
              const ElementBlocks& blocks, std::size_t block)
      : whole_(whole), own_quads_(blocks[block]) {
    // Sorted, so that each vertex has an index.
    for (const int q : own_quads_) vertices_.insert(vertices_.end(), quads[q].begin(), quads[q].end());
    sort_unique(vertices_);
    for (const int v : vertices_)
      moves_.push_back(blocks.owner(v) == static_cast<int>(block) && blocks.is_near(v));
    for (const int q : own_quads_) {
      auto& quad = quads_.emplace_back(quads[q]);
      for (int& v : quad) v = static_cast<int>(std::ranges::lower_bound(vertices_, v) - vertices_.begin());
    }
  }

  const std::vector<std::array<int, 4>>& quads() const { return quads_; }
  std::vector<Vec> points(const std::vector<Vec>& all) const {
    std::vector<Vec> own;
    for (const int v : vertices_) own.push_back(all[v]);
    return own;
  }
  void store(const std::vector<Vec>& own, std::vector<Vec>& all) const {
    for (std::size_t v = 0; v < own.size(); ++v)
      if (moves_[v]) all[vertices_[v]] = own[v];
  }

  Vec2 position(int v) const override { return whole_.position(vertices_[v]); }
  Vec put(int v, Vec2 position) override { return whole_.put(vertices_[v], position); }
  std::array<Vec, 2> axes(int v) const override {
    return moves_[v] ? whole_.axes(vertices_[v]) : std::array<Vec, 2>{};
  }
  double delta(const Vec& place, TrackHint& hint) const override { return whole_.delta(place, hint); }
  Vec arm(int quad, int side, TrackHint& hint) const override {
    return whole_.arm(own_quads_[quad], side, hint);
  }

 private:
  VertexTracks<Vec>& whole_;
  std::span<const int> own_quads_;
  std::vector<int> vertices_;  ///< in the whole mesh, sorted
  std::vector<char> moves_;
  std::vector<std::array<int, 4>> quads_;
};

const OptionTable<OptimisationOptions>& table() {
  static const auto all =
      OptionTable<OptimisationOptions>("optimisation", "options of O")
          .add({.name = "passes", .help = "how often, at most", .least = 0, .most = 1000},
               &OptimisationOptions::passes)
          .add({.name = "iterations", .help = "iterations of L-BFGS in each pass", .least = 1, .most = 1e5},
               &OptimisationOptions::iterations)
          .add({.name = "size", .help = "weight of the edges' lengths", .least = 0},
               &OptimisationOptions::size)
          .add({.name = "alignment", .help = "weight of the edges' directions", .least = 0},
               &OptimisationOptions::alignment)
          .add({.name = "orthogonality",
                .help = "weight of quads whose corners lie on no circle: their links of flow are oblique",
                .least = 0},
               &OptimisationOptions::orthogonality);
  return all;
}

}  // namespace

OptionGroup optimisation_group() { return table().group(); }
OptimisationOptions optimisation_options(const Options& options) { return table().read(options); }

namespace {

/// A quad with a corner of at most this sine is flat or inverted, and its vertices stay.
constexpr double kHeldSine = 1e-3;
/// Part by which the least sine of a quad may fall.
constexpr double kRoom = 0.005;
/// Quads below kWorstEta are the worst. After the first pass, only vertices around quads below kSettledEta
/// move. Vertices in kRings rings around these quads move, too.
constexpr double kWorstEta = 0.6, kSettledEta = 0.9;
constexpr int kRings = 2;
/// No pass follows one with a smaller gain, as a part of the energy.
constexpr double kLeastTrackedGain = 0.1;
/// Weight and exponent for the worst quads: about the sixth power of |angle - 90 degrees|.
constexpr double kWorstWeight = 30;
constexpr int kWorstPower = 3;
/// Weight of walls for the worst quads, where angles come first.
constexpr double kWorstWall = 20;
/// Sum over corners of 1/sin alpha - 1 above which quads weigh less, so that hopeless ones do not drown the
/// others.
constexpr double kHopelessShape = 3;
/// Least length of an edge over its old length, or over delta if that is less.
constexpr double kShortest = 0.2;
/// The same for edges that are already beyond the wall.
constexpr double kShort = 0.5;
/// Sines of the angle between a side and the curve under it, which is half of the turn of the curve. Sides
/// below the first one may turn freely. Sides above the second one lie across the curve.
constexpr double kBent = 0.2, kAcross = 0.7;
/// Part by which that sine may grow.
constexpr double kMoreBent = 1.15;
/// A move that makes a quad bad is halved, and dropped below this part.
constexpr double kLeastPart = 0.2;

template <class Vec>
class TrackOptimisation {
 public:
  TrackOptimisation(std::vector<Vec>& points, const std::vector<std::array<int, 4>>& quads,
                    VertexTracks<Vec>& tracks, const OptimisationOptions& options)
      : points_(points), quads_(quads), tracks_(tracks), options_(options) {}

  /// Finds the vertices that may move. Must be called once, before all others.
  void find_free();
  OptimisationSummary run();
  /// Returns the least eta of movable quads.
  double worst() const { return std::max(0.0, eta_of_sine(least())); }
  const OptimisationSummary& summary() const { return summary_; }

 private:
  std::array<double, 4> movable_sines(std::size_t quad) const;
  double movable_sine(std::size_t quad) const;
  std::vector<double> least_sines() const;
  double least() const;
  void find_delta();
  bool beyond_walls(std::size_t quad) const;
  bool is_failing(std::size_t quad) const;
  std::vector<char> around_below(double eta) const;
  QuadEnergyMesh<Vec> energy_mesh(const std::vector<char>& free) const;
  void set_kept(const QuadEnergyWeights& weights, QuadEnergyMesh<Vec>& mesh);
  EnergyDescent descend(const std::vector<char>& free, const QuadEnergyWeights& weights);
  bool too_short(std::size_t quad) const;
  std::array<double, 4> bends(std::size_t quad) const;
  bool too_bent(std::size_t quad) const;
  void find_room();
  double crowding(std::size_t quad) const;
  std::vector<std::vector<int>> quads_around() const;
  std::vector<double> reaches(std::vector<double> delta) const;
  void settle(const std::vector<MovingVertex<Vec>>& moving, const std::vector<double>& x);

  std::vector<Vec>& points_;
  const std::vector<std::array<int, 4>>& quads_;
  VertexTracks<Vec>& tracks_;
  OptimisationOptions options_;
  const double short_wall_ = options_.limits.short_wall(), long_wall_ = options_.limits.long_wall();
  std::vector<char> free_;                            ///< by vertex
  std::vector<double> delta_;                         ///< by vertex
  std::vector<Vec> delta_at_;                         ///< place of the evaluation
  std::vector<std::array<double, 4>> least_lengths_;  ///< by quad and side
  std::vector<std::array<double, 4>> most_bent_;      ///< largest bends(), by quad and side
  std::vector<double> kept_;                          ///< least sine that each quad must keep in this pass
  std::vector<char> failed_;                          ///< by quad: is_failing() before this pass
  std::vector<char> inside_;                          ///< by vertex: on no curve
  std::vector<double> room_;      ///< by vertex: delta, or the shortest edge to other vertices on curves
  std::vector<char> narrow_;      ///< by vertex: on a curve in a narrow place
  std::vector<double> crowding_;  ///< allowed crowding of each quad
  OptimisationSummary summary_;
};

/// Returns the sines of the corners, with 1 for corners that cannot move.
template <class Vec>
std::array<double, 4> TrackOptimisation<Vec>::movable_sines(std::size_t quad) const {
  const auto& v = quads_[quad];
  auto sines = corner_sines(std::array{points_[v[0]], points_[v[1]], points_[v[2]], points_[v[3]]});
  for (int k = 0; k < 4; ++k)
    if (!free_[v[(k + 3) % 4]] && !free_[v[k]] && !free_[v[(k + 1) % 4]]) sines[k] = 1;
  return sines;
}

template <class Vec>
double TrackOptimisation<Vec>::movable_sine(std::size_t quad) const {
  const auto sines = movable_sines(quad);
  return std::min({sines[0], sines[1], sines[2], sines[3]});
}

/// Returns movable_sine() of each quad.
template <class Vec>
std::vector<double> TrackOptimisation<Vec>::least_sines() const {
  std::vector<double> sines(quads_.size());
  parallel_ranges(sines.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) sines[q] = movable_sine(q);
  });
  return sines;
}

template <class Vec>
double TrackOptimisation<Vec>::least() const {
  const std::vector<double> sines = least_sines();
  return std::accumulate(sines.begin(), sines.end(), 1.0, [](double a, double b) { return std::min(a, b); });
}

template <class Vec>
void TrackOptimisation<Vec>::find_free() {
  free_.assign(points_.size(), 0);
  for (const auto& quad : quads_)
    for (const int v : quad) free_[v] = 1;
  parallel_ranges(points_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (free_[v] && tracks_.axes(static_cast<int>(v)) == std::array<Vec, 2>{}) free_[v] = 0;
  });
  const std::vector<char> all = free_;
  std::vector<char> flat(quads_.size());
  parallel_ranges(flat.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      const auto& v = quads_[q];
      const auto sines = corner_sines(std::array{points_[v[0]], points_[v[1]], points_[v[2]], points_[v[3]]});
      flat[q] = std::min({sines[0], sines[1], sines[2], sines[3]}) <= kHeldSine;
    }
  });
  for (std::size_t q = 0; q < flat.size(); ++q)
    if (flat[q])
      for (const int i : quads_[q]) free_[i] = 0;
  for (std::size_t v = 0; v < free_.size(); ++v) summary_.held += all[v] && !free_[v];
}

/// Updates delta at moved vertices.
template <class Vec>
void TrackOptimisation<Vec>::find_delta() {
  const bool first = delta_.empty();
  delta_.resize(points_.size());
  delta_at_.resize(points_.size());
  parallel_ranges(points_.size(), [&](std::size_t begin, std::size_t end) {
    TrackHint hint;
    for (std::size_t v = begin; v < end; ++v) {
      if (!first && delta_at_[v] == points_[v]) continue;
      delta_at_[v] = points_[v];
      delta_[v] = tracks_.delta(points_[v], hint);
    }
  });
}

template <class Vec>
bool TrackOptimisation<Vec>::beyond_walls(std::size_t quad) const {
  const auto& v = quads_[quad];
  for (int k = 0; k < 4; ++k) {
    const int a = v[k], b = v[(k + 1) % 4];
    if (!free_[a] && !free_[b]) continue;
    const double part = 2 * norm(points_[b] - points_[a]) / (delta_[a] + delta_[b]);
    if (part < short_wall_ || part > long_wall_) return true;
  }
  return false;
}

template <class Vec>
bool TrackOptimisation<Vec>::is_failing(std::size_t quad) const {
  const auto& v = quads_[quad];
  double shortest = std::numeric_limits<double>::max(), longest = 0, least = shortest, most = 0;
  for (int k = 0; k < 4; ++k) {
    const int a = v[k], b = v[(k + 1) % 4];
    const double length = norm(points_[b] - points_[a]), part = 2 * length / (delta_[a] + delta_[b]);
    least = std::min(least, length), most = std::max(most, length);
    shortest = std::min(shortest, part), longest = std::max(longest, part);
  }
  return is_beyond(options_.limits, shortest, longest, most / std::max(least, kTinyLength),
                   movable_sine(quad));
}

/// Returns the movable vertices around quads below this eta or with sides beyond the walls.
template <class Vec>
std::vector<char> TrackOptimisation<Vec>::around_below(double eta) const {
  std::vector<char> near(points_.size(), 0);
  const std::vector<double> sines = least_sines();
  const double good = sine_of_eta(eta);
  for (std::size_t q = 0; q < quads_.size(); ++q)
    if (sines[q] < good || beyond_walls(q))
      for (const int v : quads_[q]) near[v] = 1;
  for (int ring = 0; ring < kRings; ++ring) {
    const std::vector<char> inner = near;
    for (const auto& quad : quads_)
      if (std::any_of(quad.begin(), quad.end(), [&](int v) { return inner[v]; }))
        for (const int v : quad) near[v] = 1;
  }
  for (std::size_t v = 0; v < near.size(); ++v) near[v] &= free_[v];
  return near;
}

/// Returns the shortest edge of each vertex, or delta if that is less.
template <class Vec>
std::vector<double> TrackOptimisation<Vec>::reaches(std::vector<double> delta) const {
  for (const auto& quad : quads_)
    for (int k = 0; k < 4; ++k) {
      const int a = quad[k], b = quad[(k + 1) % 4];
      const double length = norm(points_[b] - points_[a]);
      delta[a] = std::min(delta[a], length), delta[b] = std::min(delta[b], length);
    }
  return delta;
}

/// Makes the energy's mesh without kept sines and weights. A step of 1 is the reach of a vertex.
template <class Vec>
QuadEnergyMesh<Vec> TrackOptimisation<Vec>::energy_mesh(const std::vector<char>& free) const {
  QuadEnergyMesh<Vec> mesh;
  mesh.points = points_;
  mesh.quads = quads_;
  mesh.delta = delta_;
  mesh.least_lengths = least_lengths_;
  const std::vector<double> reach = reaches(mesh.delta);
  for (std::size_t v = 0; v < points_.size(); ++v)
    if (free[v]) mesh.moving.push_back({static_cast<int>(v), {}});
  parallel_ranges(mesh.moving.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      auto& [v, axes] = mesh.moving[i];
      axes = tracks_.axes(v);
      for (Vec& axis : axes)
        if (const double n = norm(axis); n > 0) axis = (reach[v] / n) * axis;
    }
  });
  mesh.arm = [this, hint = TrackHint()](int quad, int side) mutable { return tracks_.arm(quad, side, hint); };
  return mesh;
}

template <class Vec>
void TrackOptimisation<Vec>::set_kept(const QuadEnergyWeights& weights, QuadEnergyMesh<Vec>& mesh) {
  const double floor = sine_of_eta(kOptimisedFloorEta), worst = std::min(least(), floor);
  failed_.resize(quads_.size());
  for (auto* values : {&kept_, &mesh.kept_sine, &mesh.weight}) values->resize(quads_.size());
  parallel_ranges(quads_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) {
      const auto sines = movable_sines(q);
      const double bound = std::min({sines[0], sines[1], sines[2], sines[3], floor});
      kept_[q] = std::max((1 - kRoom) * bound, worst);
      failed_[q] = is_failing(q);
      mesh.kept_sine[q] = bound;
      double shape = 0;
      for (const double sine : sines) shape += 1 / std::max(sine, kHeldSine) - 1;
      mesh.weight[q] = 1 / (1 + std::pow(shape / kHopelessShape, weights.bad_power));
    }
  });
}

template <class Vec>
EnergyDescent TrackOptimisation<Vec>::descend(const std::vector<char>& free,
                                              const QuadEnergyWeights& weights) {
  if (std::ranges::find(free, 1) == free.end()) return {};
  find_delta();
  QuadEnergyMesh<Vec> mesh = energy_mesh(free);
  set_kept(weights, mesh);
  const std::vector<MovingVertex<Vec>> moving = mesh.moving;
  const QuadEnergy<Vec> energy(std::move(mesh), weights);
  EnergyDescent descent = minimise(energy, options_.iterations);
  summary_.iterations += descent.iterations;
  summary_.evaluations += descent.evaluations;
  settle(moving, descent.x);
  return descent;
}

template <class Vec>
bool TrackOptimisation<Vec>::too_short(std::size_t quad) const {
  const auto& v = quads_[quad];
  for (int k = 0; k < 4; ++k)
    if (norm(points_[v[(k + 1) % 4]] - points_[v[k]]) <= least_lengths_[quad][k]) return true;
  return false;
}

/// Returns the larger sine between each side and the curve at its ends; 0 for sides that are not on curves.
template <class Vec>
std::array<double, 4> TrackOptimisation<Vec>::bends(std::size_t quad) const {
  std::array<double, 4> sines{};
  for (int k = 0; k < 4; ++k) {
    const int a = quads_[quad][k], b = quads_[quad][(k + 1) % 4];
    if (inside_[a] || inside_[b]) continue;
    const Vec side = points_[b] - points_[a];
    for (const int v : {a, b})
      if (const Vec along = tracks_.axes(v)[0]; along != Vec{}) {
        const double cosine = dot(side, along) / std::max(norm(side) * norm(along), kTinyLength);
        sines[k] = std::max(sines[k], std::sqrt(std::max(0.0, 1 - cosine * cosine)));
      }
  }
  return sines;
}

template <class Vec>
bool TrackOptimisation<Vec>::too_bent(std::size_t quad) const {
  const auto now = bends(quad);
  for (int k = 0; k < 4; ++k)
    if (now[k] > most_bent_[quad][k]) return true;
  return false;
}

template <class Vec>
void TrackOptimisation<Vec>::find_room() {
  inside_.resize(points_.size());
  for (std::size_t v = 0; v < points_.size(); ++v) inside_[v] = tracks_.axes(static_cast<int>(v))[1] != Vec{};
  room_ = delta_;
  for (const auto& quad : quads_)
    for (int k = 0; k < 4; ++k) {
      const int a = quad[k], b = quad[(k + 1) % 4];
      if (inside_[a] || inside_[b]) continue;
      const double length = norm(points_[b] - points_[a]);
      room_[a] = std::min(room_[a], length), room_[b] = std::min(room_[b], length);
    }
  narrow_.resize(points_.size(), 0);
  for (const auto& quad : quads_) {
    const auto on_curve = [this](int v) { return !inside_[v]; };
    const bool across = (on_curve(quad[0]) && on_curve(quad[2])) || (on_curve(quad[1]) && on_curve(quad[3]));
    if (!across || std::ranges::count_if(quad, on_curve) == 3) continue;  // three: in a corner
    for (const int v : quad) narrow_[v] = on_curve(v);
  }
  most_bent_.resize(quads_.size());
  for (std::size_t q = 0; q < quads_.size(); ++q) {
    most_bent_[q] = bends(q);
    const bool is_narrow = std::ranges::any_of(quads_[q], [this](int v) { return narrow_[v] != 0; });
    for (double& sine : most_bent_[q])
      sine = is_narrow || sine > kAcross ? 1 : std::max(kBent, kMoreBent * sine);
  }
  crowding_.resize(quads_.size());
  for (std::size_t q = 0; q < quads_.size(); ++q) crowding_[q] = crowding(q);
}

/// Returns the crowding as in QuadRelocation, but 0 in narrow places, which only angles and sizes shape.
template <class Vec>
double TrackOptimisation<Vec>::crowding(std::size_t quad) const {
  const auto& v = quads_[quad];
  if (std::ranges::any_of(v, [this](int i) { return narrow_[i] != 0; })) return 0;
  std::array<double, 4> lengths;
  for (int k = 0; k < 4; ++k) lengths[k] = norm(points_[v[(k + 1) % 4]] - points_[v[k]]);
  const double longest = std::ranges::max(lengths);
  double sum = 0;
  for (int k = 0; k < 4; ++k) {
    const int a = v[k], b = v[(k + 1) % 4];
    if (inside_[a] || inside_[b]) sum += crowding_of(lengths[k], std::min(room_[a], room_[b]), longest);
  }
  return sum;
}

template <class Vec>
std::vector<std::vector<int>> TrackOptimisation<Vec>::quads_around() const {
  std::vector<std::vector<int>> around(points_.size());
  for (std::size_t q = 0; q < quads_.size(); ++q)
    for (const int v : quads_[q]) around[v].push_back(static_cast<int>(q));
  return around;
}

/// Puts the vertices on their tracks, as far as all quads keep their limits and lengths of sides.
template <class Vec>
void TrackOptimisation<Vec>::settle(const std::vector<MovingVertex<Vec>>& moving,
                                    const std::vector<double>& x) {
  struct Move {
    Vec2 from, by;
    double part = 0;
  };
  std::vector<Move> moves(points_.size());
  const auto put = [&](int v) { points_[v] = tracks_.put(v, moves[v].from + moves[v].part * moves[v].by); };
  parallel_ranges(moving.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [v, scaled] = moving[i];
      const auto axes = tracks_.axes(v);
      moves[v] = {tracks_.position(v), {}, 1};
      if (const double n = norm(axes[0]); n > 0) moves[v].by.x = x[2 * i] * norm(scaled[0]) / n;
      if (const double n = norm(axes[1]); n > 0) moves[v].by.y = x[2 * i + 1] * norm(scaled[1]) / n;
      put(v);
    }
  });
  // The loop ends: a vertex moves back by half, or at last to its start. Only quads around such vertices are
  // checked again.
  std::vector<std::vector<int>> quads_at;
  std::vector<int> looked_at(quads_.size());
  std::iota(looked_at.begin(), looked_at.end(), 0);
  while (!looked_at.empty()) {
    std::vector<int> changed;
    for (const int q : looked_at) {
      check_cancelled();
      const auto& quad = quads_[q];
      if (std::none_of(quad.begin(), quad.end(), [&](int v) { return moves[v].part > 0; })) continue;
      const bool is_good = movable_sine(q) >= kept_[q] && !too_short(q) && crowding(q) <= crowding_[q] &&
                           (failed_[q] || !is_failing(q));
      if (is_good && !too_bent(q)) continue;
      for (const int v : quad) {
        if (moves[v].part == 0 || (is_good && inside_[v])) continue;
        moves[v].part = moves[v].part > kLeastPart ? moves[v].part / 2 : 0;
        put(v);
        changed.push_back(v);
      }
    }
    looked_at.clear();
    if (quads_at.empty() && !changed.empty()) quads_at = quads_around();
    for (const int v : changed) looked_at.insert(looked_at.end(), quads_at[v].begin(), quads_at[v].end());
    sort_unique(looked_at);
  }
}

template <class Vec>
OptimisationSummary TrackOptimisation<Vec>::run() {
  find_delta();
  least_lengths_.resize(quads_.size());
  parallel_ranges(quads_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q)
      for (int k = 0; k < 4; ++k) {
        const int a = quads_[q][k], b = quads_[q][(k + 1) % 4];
        const double length = norm(points_[b] - points_[a]), delta = std::min(delta_[a], delta_[b]);
        least_lengths_[q][k] = (length < short_wall_ * delta ? kShort : kShortest) * std::min(length, delta);
      }
  });
  find_room();
  summary_.worst_before = worst();
  QuadEnergyWeights weights;
  weights.size = options_.size;
  weights.alignment = options_.alignment;
  weights.orthogonality = options_.orthogonality;
  weights.short_wall = short_wall_, weights.long_wall = long_wall_;
  QuadEnergyWeights for_worst = weights;
  for_worst.bad = kWorstWeight;
  for_worst.bad_power = kWorstPower;
  for_worst.wall = kWorstWall;
  for (int pass = 0; pass < options_.passes; ++pass) {
    descend(around_below(kWorstEta), for_worst);
    const EnergyDescent descent =
        descend(pass == 0 || options_.orthogonality > 0 ? free_ : around_below(kSettledEta), weights);
    if (pass == 0) {
      summary_.energy_before = descent.energy_before;
      summary_.energy_after = descent.energy_after;
    }
    if (descent.energy_before - descent.energy_after <= kLeastTrackedGain * std::abs(descent.energy_before))
      break;
  }
  summary_.worst_after = worst();
  return summary_;
}

std::vector<Vec2> in_a_plane(const std::vector<Vec2>& points) { return points; }

/// Projects along a direction that is rarely in a face.
std::vector<Vec2> in_a_plane(const std::vector<Vec3>& points) {
  std::vector<Vec2> places;
  places.reserve(points.size());
  for (const Vec3& p : points) places.push_back({p.x + 0.37 * p.z, p.y + 0.61 * p.z});
  return places;
}

}  // namespace

template <class Vec>
OptimisationSummary optimise_on_tracks(std::vector<Vec>& points, const std::vector<std::array<int, 4>>& quads,
                                       VertexTracks<Vec>& tracks, const OptimisationOptions& options) {
  TrackOptimisation<Vec> all(points, quads, tracks, options);
  all.find_free();
  ElementBlocks blocks;
  OptimisationSummary total;
  for (int pass = 0; blocks.next({quads}, in_a_plane(points)); ++pass) {
    if (blocks.is_whole()) return all.run();
    if (pass == 0) total = all.summary(), total.worst_before = all.worst();
    std::vector<OptimisationSummary> parts(blocks.size());
    parallel_for(blocks.size(), [&](std::size_t b) {
      BlockTracks<Vec> block(tracks, quads, blocks, b);
      std::vector<Vec> own = block.points(points);
      TrackOptimisation<Vec> part(own, block.quads(), block, options);
      part.find_free();
      parts[b] = part.run();
      block.store(own, points);
    });
    for (const OptimisationSummary& part : parts) {
      total.iterations += part.iterations;
      total.evaluations += part.evaluations;
      if (pass > 0) continue;
      total.energy_before += part.energy_before;
      total.energy_after += part.energy_after;
    }
  }
  total.worst_after = all.worst();
  return total;
}

template OptimisationSummary optimise_on_tracks(std::vector<Vec2>&, const std::vector<std::array<int, 4>>&,
                                                VertexTracks<Vec2>&, const OptimisationOptions&);
template OptimisationSummary optimise_on_tracks(std::vector<Vec3>&, const std::vector<std::array<int, 4>>&,
                                                VertexTracks<Vec3>&, const OptimisationOptions&);

}  // namespace delquad
