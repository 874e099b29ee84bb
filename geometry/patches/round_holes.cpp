// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "geometry/patches/even_counts.h"

namespace delquad {
namespace {

/// Range of lengths of holes, in sizes. Smaller holes have no own row, larger ones have more rows to adapt.
constexpr double kShortestHole = 5, kLongestHole = 16;
/// Least length of a round hole over its extent, and its largest turn at a point (radians).
constexpr double kRound = 3, kSmooth = 0.5;
/// Least distance of the next wall, in sizes.
constexpr double kRoom = 1.5;
/// Irregular vertices beyond the four for each missing edge, measured on CAD.
constexpr double kIrregularPerEdge = 1;
/// Edges of the square around a hole over edges by its length: 4 to pi.
constexpr double kSquare = 4 / std::numbers::pi;

class RoundHoles {
 public:
  RoundHoles(const Mesh& fine, const SurfaceCurves& curves, const AcrossView& across, double price,
             CurveDemands& wanted)
      : fine_(fine), curves_(curves), across_(across), price_(price), wanted_(wanted) {}

  void run() {
    std::vector<char> closes(curves_.maps.size(), 0);
    for (const ClosureSum& sum : closure_sums(curves_, wanted_)) {
      closes[sum.patch] = 1;
      if (sum.terms.size() == 2)
        for (const auto& [chain, times] : sum.terms) faces_one_.insert({chain, sum.patch});
    }
    std::set<int> chains;
    std::size_t corner = 0;
    for (std::size_t p = 0; p < curves_.maps.size(); ++p)
      for (const auto& loop : curves_.outlines[p]) {
        std::vector<int> around;
        bool is_smooth = true;
        for (const CurveSide& side : loop) {
          if (!side.begins(curves_.chains[side.chain])) continue;
          around.push_back(side.chain);
          is_smooth &= std::abs(curves_.corners[corner++].angle - std::numbers::pi) < kSmooth;
        }
        if (!closes[p] && is_smooth && is_hole(static_cast<int>(p), loop) &&
            pays(static_cast<int>(p), around))
          chains.insert(around.begin(), around.end());
      }
    for (const int c : chains) wanted_.demands[c].integral *= kSquare;
  }

 private:
  Vec3 place(int p, int v) const { return fine_.points[curves_.maps[p].fine_node[v]]; }

  bool is_hole(int p, const std::vector<CurveSide>& loop) const {
    double area = 0, length = 0, extent = 0;
    for (const CurveSide& side : loop) {
      area += cross(curves_.maps[p].flat.points[side.from] - curves_.maps[p].flat.points[loop[0].from],
                    curves_.maps[p].flat.points[side.to] - curves_.maps[p].flat.points[loop[0].from]);
      length += norm(place(p, side.to) - place(p, side.from));
      for (const CurveSide& other : loop)
        extent = std::max(extent, norm(place(p, other.from) - place(p, side.from)));
    }
    return area < 0 && length > kRound * extent;
  }

  /// Returns whether removed irregular vertices beside the hole are worth more than changed sizes behind it,
  /// half of which count at the other end. The rows there must lead to one curve, since more of them would
  /// end at several.
  bool pays(int p, const std::vector<int>& around) const {
    double length = 0, quads = 0;
    std::set<int> behind;
    for (const int c : around) {
      length += wanted_.demands[c].integral;
      for (const int q : wanted_.demands[c].patches) {
        if (q == p) continue;
        if (!faces_one_.contains({c, q})) return false;
        if (behind.insert(q).second) quads += wanted_.quads[q];
      }
    }
    return length > kShortestHole && length < kLongestHole &&
           kDeviationCost * quads / length / 2 < kIrregularPerEdge * price_ &&
           std::ranges::all_of(around, [&](int c) { return has_room(p, c); });
  }

  bool has_room(int p, int c) const {
    const std::vector<int>& points = curves_.chains[c].points;
    double length = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      length += norm(fine_.points[points[i + 1]] - fine_.points[points[i]]);
    const double room = kRoom * length / wanted_.integrals[c].total();
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      if (std::ranges::count(across_.look(c, static_cast<double>(i) + 0.5, room), p, &Opposite::patch) > 0)
        return false;
    return true;
  }

  const Mesh& fine_;
  const SurfaceCurves& curves_;
  const AcrossView& across_;
  double price_;
  CurveDemands& wanted_;
  std::set<std::pair<int, int>> faces_one_;  ///< chains with one opposite chain, and the patch
};

}  // namespace

void widen_round_holes(const Mesh& fine, const SurfaceCurves& curves, const AcrossView& across, double price,
                       CurveDemands& wanted) {
  RoundHoles(fine, curves, across, price, wanted).run();
}

}  // namespace delquad
