// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/patches/even_counts.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numbers>

namespace delquad {
namespace {

/// Edges of a loop by their direction in the grid, in right angles from the first one.
struct Loop {
  std::array<std::map<int, int>, 2> along;  ///< signed number of passages of each chain, by axis
  int turns = 0;
};

/// Returns the right angles by which a boundary turns to the left at a corner of this angle (radians).
int turn_at(double angle) {
  return 2 - std::max(1, static_cast<int>(std::lround(angle / (std::numbers::pi / 2))));
}

void add_edges(Loop& loop, int chain) {
  const int direction = (loop.turns % 4 + 4) % 4;
  loop.along[direction % 2][chain] += direction < 2 ? 1 : -1;
}

ClosureSum sum_of(int patch, const std::map<int, int>& terms) {
  ClosureSum sum{patch, {}};
  for (const auto& [chain, times] : terms)
    if (times != 0) sum.terms.emplace_back(chain, times);
  return sum;
}

/// Returns `terms` plus `other`, which is turned by so many right angles, by axis.
std::array<std::map<int, int>, 2> joined(std::array<std::map<int, int>, 2> terms, const Loop& other,
                                         int turned) {
  for (const int axis : {0, 1})
    for (const auto& [chain, times] : other.along[axis]) {
      const int direction = axis + turned;
      terms[direction % 2][chain] += direction % 4 < 2 ? times : -times;
    }
  return terms;
}

}  // namespace

std::vector<ClosureSum> closure_sums(const SurfaceCurves& curves, const CurveDemands& wanted) {
  std::vector<ClosureSum> sums;
  const auto amount = [&](const std::array<std::map<int, int>, 2>& along) {
    double total = 0;
    for (const auto& terms : along) {
      double sum = 0;
      for (const auto& [chain, times] : terms) sum += times * wanted.demands[chain].integral;
      total += std::abs(sum);
    }
    return total;
  };
  std::size_t corner = 0;
  for (std::size_t p = 0; p < curves.maps.size(); ++p) {
    std::vector<Loop> loops;
    bool has_tips = false;
    for (const auto& sides : curves.outlines[p]) {
      Loop& loop = loops.emplace_back();
      for (const CurveSide& side : sides) {
        if (!side.begins(curves.chains[side.chain])) continue;
        has_tips |= curves.corners[corner].is_tip();
        loop.turns += turn_at(curves.corners[corner++].angle);
        add_edges(loop, side.chain);
      }
    }
    if (has_tips) continue;
    const int patch = static_cast<int>(p);
    std::vector<const Loop*> rings;
    int outer = 0, inner = 0;
    for (const Loop& loop : loops) {
      outer += loop.turns == 4, inner += loop.turns == -4;
      if (loop.turns == 0) rings.push_back(&loop);
    }
    if (std::size(loops) - inner != (outer == 1 ? 1 : 2) || (outer == 0 && rings.size() != 2)) continue;
    for (const Loop& loop : loops)
      if (loop.turns != 0)
        for (const auto& terms : loop.along) sums.push_back(sum_of(patch, terms));
    if (rings.empty()) continue;
    std::array<std::map<int, int>, 2> best;
    double least = std::numeric_limits<double>::infinity();
    for (int turned = 0; turned < 4; ++turned) {
      auto both = joined(rings[0]->along, *rings[1], turned);
      if (const double off = amount(both); off < least) least = off, best = std::move(both);
    }
    for (const auto& terms : best) sums.push_back(sum_of(patch, terms));
  }
  std::erase_if(sums, [](const ClosureSum& sum) { return sum.terms.empty(); });
  return sums;
}

namespace {

/// Largest relative difference of sides that agree. If lengths differ more, rows end in any case.
constexpr double kWidestGap = 0.25;
/// Width of narrow rings, in sizes, and relative difference up to which their loops agree: one may have twice
/// the edges of the other. All rows of a ring agree or none, since ending fewer rows is no better.
constexpr double kNarrowRing = 2.5, kWidestGapOfRing = 0.7;
/// Irregular vertices for each edge by which sides differ, more if they are less than two quads apart, and
/// for sides that stay different. Next, irregular vertices for an edge that ends rows in a patch without
/// sums, and the number of rows that follow it. All are measured on CAD models.
constexpr double kIrregularPerRow = 0.5, kMoreInNarrow = 0.9, kIrregularPerFarRow = 0.3,
                 kIrregularPerFreeEdge = 0.6, kRowsThatFollow = 2;

/// Returns whether a sum has all curves around a patch between two loops.
bool is_of_ring(const SurfaceCurves& curves, const ClosureSum& sum) {
  std::size_t pieces = 0;
  for (const auto& loop : curves.outlines[sum.patch])
    for (const CurveSide& side : loop) pieces += side.begins(curves.chains[side.chain]);
  return curves.outlines[sum.patch].size() == 2 && sum.terms.size() == pieces;
}

}  // namespace

void agree_on_counts(const SurfaceCurves& curves, const CurveDemands& wanted, double price,
                     const std::set<int>& kept, Budget& steps, std::vector<int>& counts) {
  assert(wanted.demands.size() == curves.chains.size() && counts.size() == curves.chains.size());
  const std::vector<int> leader = leaders(curves);
  std::vector<AgreeingCurve> agreeing;
  for (const CurveDemand& d : joined_demands(wanted.demands, curves.images))
    agreeing.push_back({std::max(d.integral, 1e-3), d.minimum, d.exact == 0, 0, d.patches, d.most});
  for (const int c : kept) agreeing[leader[c]].is_free = false;

  std::vector<ClosureSum> sums = closure_sums(curves, wanted);
  std::vector<char> closes(curves.maps.size(), 0);
  for (ClosureSum& sum : sums) {
    double length = 0, gap = 0;
    for (const auto& [chain, times] : sum.terms) {
      length += std::abs(times) * wanted.demands[chain].integral / 2;
      gap += times * wanted.demands[chain].integral;
    }
    const double depth = std::max(1.0, wanted.quads[sum.patch] / std::max(length, 1.0));
    const bool may_close = std::abs(gap) <= kWidestGap * length;
    sum.price_of_pair = may_close ? price : 0;
    sum.price = price * (may_close ? kIrregularPerRow + kMoreInNarrow * std::min(1.0, 2 / depth)
                                   : kIrregularPerFarRow);
    if (!may_close && depth <= kNarrowRing && std::abs(gap) <= kWidestGapOfRing * length &&
        is_of_ring(curves, sum))
      sum.price_of_pair = price * std::abs(gap) * kMoreInNarrow;
    closes[sum.patch] = 1;
    for (auto& [chain, times] : sum.terms) {
      chain = leader[chain];
      agreeing[chain].weight += kDeviationCost * std::abs(times) * depth / 2;
    }
  }
  for (AgreeingCurve& curve : agreeing)
    for (const int p : curve.patches)
      if (!closes[p]) curve.weight += kDeviationCost * kRowsThatFollow + kIrregularPerFreeEdge * price;
  agree_counts(agreeing, static_cast<int>(curves.maps.size()), sums, steps, counts);
}

}  // namespace delquad
