// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/across_view.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"

namespace delquad {

namespace {

constexpr int kSweeps = 60;
/// Largest distance, in edges, between a node and the place across from its partner, also for counted
/// partners.
constexpr double kPairing = 0.75, kCountedPairing = 2;
/// Limits of the pull across, (size / width)^2, against the pull of neighbors on the curve.
constexpr double kLeastPull = 0.3, kMostPull = 200;
/// Least length of an edge over its initial length.
constexpr double kShortest = 0.4;
constexpr double kDone = 1e-3;
/// Cost of a look across a patch, in steps of agree_counts().
constexpr long long kStepsPerLook = 10;

class Facing {
 public:
  Facing(const Mesh& fine, const std::vector<CurveChain>& chains, const AcrossView& across,
         const std::vector<SizeIntegral>& integrals, const std::vector<int>& counts,
         const std::vector<int>& group, const SizeOnLine& size, Budget& steps)
      : fine_(fine),
        chains_(chains),
        across_(across),
        integrals_(integrals),
        group_(group),
        size_(size),
        steps_(steps),
        places_(equal_places(counts)) {
    sees_.resize(places_.size());
    for (size_t c = 0; c < places_.size(); ++c) sees_[c].resize(places_[c].size());
    for (const int count : counts) live_.push_back(count > 0);  // a curve of one point has no edges
  }

  CurvePlaces run() {
    for (int sweep = 0; sweep < kSweeps && !steps_.is_spent(); ++sweep) {
      look_all();
      if (sweep == 0) keep_narrow();
      if (relax() < kDone) break;
    }
    return std::move(places_);
  }

 private:
  struct Seen {
    int chain;
    double place, pull;
  };

  double total(size_t c) const { return static_cast<double>(places_[c].size() - 1); }

  /// Returns the place on the curve, as in CurveNode.
  double to_s(size_t c, double place) const { return integrals_[c].s_at(place / total(c)); }

  double size_at(size_t c, double s, int& hint) const {
    const auto& points = chains_[c].points;
    const size_t line = std::min(static_cast<size_t>(s), points.size() - 2);
    return size_(points[line], points[line + 1], s - static_cast<double>(line),
                 fine_point_at(fine_, chains_[c], s), hint);
  }

  void look_all() {
    for (size_t c = 0; c < places_.size(); ++c)
      if (live_[c]) steps_.spend(kStepsPerLook * static_cast<long long>(places_[c].size()));
    parallel_for(
        places_.size(),
        [&](size_t c) {
          if (live_[c]) look_from(c);
        },
        [&](size_t c) { return total(c); });
  }

  void look_from(size_t c) {
    int hint = -1;
    for (size_t i = 0; i < places_[c].size(); ++i) {
      auto& sees = sees_[c][i];
      sees.clear();
      const double s = to_s(c, places_[c][i]);
      const double delta = size_at(c, s, hint);
      for (const Opposite& o : across_.look(static_cast<int>(c), s, kReach * delta)) {
        const double ratio = delta / std::max(o.distance, 1e-3 * delta);
        sees.push_back({o.chain, integrals_[o.chain].part_at(o.s) * total(o.chain),
                        std::clamp(ratio * ratio, kLeastPull, kMostPull)});
      }
    }
  }

  /// Leaves out curves without near opposite places.
  void keep_narrow() {
    std::vector<char> live(places_.size(), 0);
    for (size_t c = 0; c < places_.size(); ++c)
      for (const auto& sees : sees_[c])
        for (const Seen& o : sees) live[c] = live[o.chain] = 1;
    live_ = live;
  }

  size_t nearest(size_t c, double place) const {
    const auto& p = places_[c];
    const size_t after = static_cast<size_t>(std::lower_bound(p.begin(), p.end(), place) - p.begin());
    if (after == 0) return 0;
    if (after == p.size()) return p.size() - 1;
    return p[after] - place < place - p[after - 1] ? after : after - 1;
  }

  /// Returns the node that shall be opposite to node i of a curve. On both sides of a strip, nodes are
  /// counted from the ends that face each other.
  std::optional<size_t> partner(size_t c, size_t i, const Seen& o) const {
    const auto& p = places_[o.chain];
    if (group_[c] == group_[o.chain] && places_[c].size() == p.size() && !chains_[c].closed()) {
      const size_t forwards = i, backwards = p.size() - 1 - i;
      const size_t j =
          std::abs(p[forwards] - o.place) < std::abs(p[backwards] - o.place) ? forwards : backwards;
      if (std::abs(p[j] - o.place) < kCountedPairing) return j;
    }
    const size_t j = nearest(o.chain, o.place);
    if (std::abs(p[j] - o.place) > kPairing) return std::nullopt;
    return j;
  }

  /// Moves all nodes by a step. Returns the longest step.
  double relax() {
    std::vector<std::vector<double>> pull(places_.size()), sum(places_.size());
    for (size_t c = 0; c < places_.size(); ++c)
      pull[c].assign(places_[c].size(), 0), sum[c].assign(places_[c].size(), 0);
    for (size_t c = 0; c < places_.size(); ++c)
      for (size_t i = 0; i < places_[c].size(); ++i)
        for (const Seen& o : sees_[c][i]) {
          const auto j = partner(c, i, o);
          if (!j) continue;
          // The other node is pulled to the place across from this one.
          pull[o.chain][*j] += o.pull;
          sum[o.chain][*j] += o.pull * o.place;
        }
    double longest = 0;
    for (size_t c = 0; c < places_.size(); ++c) {
      if (!live_[c]) continue;
      auto& p = places_[c];
      for (size_t i = 1; i + 1 < p.size(); ++i) {
        const double wanted = (0.5 * (p[i - 1] + p[i + 1]) * 2 + 0.5 * sum[c][i]) / (2 + 0.5 * pull[c][i]);
        const double low = p[i - 1] + kShortest, high = p[i + 1] - kShortest;
        if (low > high) continue;
        const double place = std::clamp(p[i] + 0.7 * (wanted - p[i]), low, high);
        longest = std::max(longest, std::abs(place - p[i]));
        p[i] = place;
      }
    }
    return longest;
  }

  const Mesh& fine_;
  const std::vector<CurveChain>& chains_;
  const AcrossView& across_;
  const std::vector<SizeIntegral>& integrals_;
  const std::vector<int>& group_;
  const SizeOnLine& size_;
  Budget& steps_;
  CurvePlaces places_;
  std::vector<std::vector<std::vector<Seen>>> sees_;
  std::vector<char> live_;
};

}  // namespace

CurvePlaces align_opposite_nodes(const Mesh& fine, const std::vector<CurveChain>& chains,
                                 const AcrossView& across, const std::vector<SizeIntegral>& integrals,
                                 const std::vector<int>& counts, const std::vector<int>& group,
                                 const SizeOnLine& size, Budget& steps) {
  return Facing(fine, chains, across, integrals, counts, group, size, steps).run();
}

}  // namespace delquad
