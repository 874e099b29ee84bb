#include "patches/narrow_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/disjoint_sets.h"

namespace delquad {

namespace {

/// Distance between the places from which one looks, as a part of the size.
constexpr double kSpacing = 0.25;
constexpr int kMostPlaces = 400;  // on a fine line
/// Two curves make a strip when each faces the other along this part of its length, and their lengths differ
/// by this factor at most.
constexpr double kStripPart = 0.7, kStripRatio = 1.6;

/// A place from which the boundary on the other side is near.
struct Gap {
  int patch;
  int chain, facing;  ///< curves on this side and on the other
  double length;      ///< of the piece of boundary that it stands for
};

/// Looks across from places along all curves.
std::vector<Gap> collect_gaps(const Mesh& fine, const std::vector<CurveChain>& chains,
                              const AcrossView& across, const SizeOnLine& size) {
  std::vector<Gap> gaps;
  int hint = -1;
  for (size_t c = 0; c < chains.size(); ++c)
    for (size_t line = 0; line + 1 < chains[c].points.size(); ++line) {
      const int first = chains[c].points[line], last = chains[c].points[line + 1];
      const Vec3 a = fine.points[first], d = fine.points[last] - a;
      const double length = norm(d);
      const auto size_at = [&](double t) { return size(first, last, t, a + t * d, hint); };
      const double spacing = kSpacing * std::min({size_at(0), size_at(1), size_at(0.5)});
      const int n = static_cast<int>(std::clamp(std::ceil(length / spacing), 1.0, double(kMostPlaces)));
      for (int i = 0; i < n; ++i) {
        const double t = (i + 0.5) / n;
        for (const Opposite& o :
             across.look(static_cast<int>(c), static_cast<double>(line) + t, kReach * size_at(t)))
          gaps.push_back({o.patch, static_cast<int>(c), o.chain, length / n});
      }
    }
  return gaps;
}

double length_of(const Mesh& fine, const CurveChain& chain) {
  double sum = 0;
  for (size_t i = 0; i + 1 < chain.points.size(); ++i)
    sum += norm(fine.points[chain.points[i + 1]] - fine.points[chain.points[i]]);
  return sum;
}

}  // namespace

std::vector<int> group_facing_curves(const Mesh& fine, const std::vector<CurveChain>& chains,
                                     const AcrossView& across, const SizeOnLine& size) {
  const std::vector<Gap> gaps = collect_gaps(fine, chains, across, size);
  std::map<std::array<int, 3>, double> along;  // patch, curve, curve that it faces
  for (const Gap& g : gaps) along[{g.patch, g.chain, g.facing}] += g.length;
  DisjointSets groups(chains.size());
  for (const auto& [key, length] : along) {
    const auto [patch, a, b] = key;
    const auto back = along.find({patch, b, a});
    if (a >= b || back == along.end()) continue;
    const double length_a = length_of(fine, chains[a]), length_b = length_of(fine, chains[b]);
    if (length < kStripPart * length_a || back->second < kStripPart * length_b ||
        std::max(length_a, length_b) > kStripRatio * std::min(length_a, length_b))
      continue;
    groups.join(a, b);
  }
  return groups.roots();
}

}  // namespace delquad
